"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "534edcf407e8c4fde4c9b04076a20758905d6dfa083eef83fae9509e0c6a04bd",
    "laws-1": "df7f10a5dd660e8e863904ba277b6fac93c315c5ceb149d8fddff95e7a5b6621",
    "lives-1": "2e8e6b895dc3b2973b2de612e05c8cc65430e33b3d2415fccaf8a7ebd34545ee",
    "pairs-1": "bd223612e0661b55fc643f2c950dc38ec8d27223200ace19f253b2d8f0b07bdc",
    "rigs-1": "b52584b7bb0e01df5e9553774d294feb71dd94b9a1e769f0cc74520a33037c17",
}
