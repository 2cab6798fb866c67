"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "benchmark-1": "7800e388107af283c6016a238290d93845f2097ec2e1845f74c21179c5280e74",
}
