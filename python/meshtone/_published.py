"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "benchmark-1": "46dd7f3a4b7ed36b26c74d620cc91eccb39d76ef06bf243251c8d32976c38390",
}
