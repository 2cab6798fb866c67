"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "2583c11af68a90030ef2670ac8da5b34c6f64d2d1601ca1baf43ef9b994566de",
    "laws-1": "e754ce64867f3fb0c98a29e993ab22a1dfeffe3a083e64c6a05d584bfdd1efd2",
    "lives-1": "ad333a6069f58f6ad2d4892ed4d16bde9c0d274f829dfaeccaeee4ed6b221cda",
    "pairs-1": "5eef6bd2735a7df5ee092e1c60f91ff57c91b8a40cea42f98dcb364a554f2248",
    "rigs-1": "9ae2a454a100952de9790c5a04df15e7c91148544167e9ce55d77f85066490f7",
}
