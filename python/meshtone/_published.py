"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "6faae8ad33bf0eccd485e4cea9431876f4f24380f0668ab15d75f6c70a171ed6",
    "laws-1": "c965be95019a0fb24e91dd73dd2a61d365531da7a22e7de9c3824bcf2d99f004",
    "lives-1": "abc975c91b4791eb571d143fedae0b84053677a864776b4cdae01debff1de2e6",
    "pairs-1": "ca006b1524d406e60658da625c4122aed4238f39adcef76adbf66552feb3a177",
    "rigs-1": "dc8d27b9122ef7c818ed1e683544a46b8ec32140cc111e5cacc45c2203b15020",
}
