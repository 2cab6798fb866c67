"""Published data sets: the SHA-256 of each one's ``manifest.json``, which has that of every file."""

PUBLISHED = {
    "gearbox-1": "3abdf4c4f57c82275bb9e255f08ca4db5eb374f74698112a7dd86d97f928e3dc",
    "laws-1": "b661acc74bb1c35d135f00e22433bd0fbb51aee88b34b235023a03494d28269a",
    "lives-1": "faf067840bdf9bfb0c928726ebe63ac8d4ce8c3ad7adfdb433361c0abfba6c5e",
    "pairs-1": "26537ebbd54d052304cbe2231bdc16fb0408651fb48646a5e0faf3cf29dfcce3",
    "rigs-1": "4648e25645e8e478d952b4cb72af935cb755797fcbdab11f28c7edcbb6f54a1d",
}
