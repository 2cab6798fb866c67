"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "",
    "laws-1": "",
    "lives-1": "",
    "pairs-1": "",
    "rigs-1": "",
}
