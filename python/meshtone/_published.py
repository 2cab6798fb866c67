"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "b93d316dafba2cac5ce8fbb6ae57bafd542f303f9ecd0c9eecce2e1b5f1101f5",
    "laws-1": "27f05a64a5825777083d6a31346319cb6343ff06c33219d132244ca4262cc96e",
    "lives-1": "0df67bfe9f0df1db695e65154fc22a5ef7992ee63768db73c27e3a55c4b9a44b",
    "pairs-1": "82b8333381a4b78a8b683872898b51be94e8ee225db49b9d1fe054fc2226ccae",
    "rigs-1": "5460c9c2e7658bb50ba69e5a0de1e26ea56aae7752a344be29426812233499b9",
}
