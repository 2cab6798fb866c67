"""Pack a complete data set as one archive to publish: FOLDER.zip, with the data card, the licence and the SHA-256 of every file.

usage: python publish.py FOLDER [--published FILE]

The same data set gives the same archive. `meshtone.datasets.load(NAME, "FOLDER.zip")` compares it with the SHA-256 that the Python package
has for its name; --published names the file of the package that must have it.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import zipfile
from pathlib import Path

LICENCE = """\
{title}

The data are licensed under {licence}: {url}
Cite them as the data card, {name}/README.md, says.
"""


def sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def main() -> int:
    parser = argparse.ArgumentParser(description="Pack a complete data set as one archive to publish.")
    parser.add_argument("folder", type=Path, help="the data set, whose name is that of the archive")
    parser.add_argument("--published", type=Path, help="file of the package that must have the set's SHA-256")
    arguments = parser.parse_args()
    folder: Path = arguments.folder
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    if manifest["complete"] is not True:
        print(f"error: {folder} is not complete", file=sys.stderr)
        return 1
    names = [*(file["name"] for key in ("documents", "files") for file in manifest[key]), "manifest.json"]
    licence = manifest["licence"]
    url = f"https://spdx.org/licenses/{licence}.html" if " " not in licence else licence
    files = {f"{folder.name}/{name}": folder / name for name in sorted(names)}
    texts = {"LICENSE": LICENCE.format(title=manifest["title"], licence=licence, url=url, name=folder.name)}
    texts["SHA256SUMS"] = "".join(f"{sha256(file.read_bytes())}  {name}\n" for name, file in files.items())
    archive = folder.with_name(folder.name + ".zip")
    # Parquet is compressed already; and no dates and modes of files nor the system, so that the bytes are the same on every machine.
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for name, content in [*texts.items(), *files.items()]:
            member = zipfile.ZipInfo(name)
            member.create_system, member.external_attr = 3, 0o644 << 16
            packed.writestr(member, content.encode() if isinstance(content, str) else content.read_bytes())
    archive.with_suffix(".zip.sha256").write_text(f"{sha256(archive.read_bytes())}  {archive.name}\n", "utf-8")
    line = f'"{folder.name}": "{sha256((folder / "manifest.json").read_bytes())}"'
    print(f"{archive}: {archive.stat().st_size / 1e6:.1f} MB, {len(names)} files; {line}")
    if arguments.published and line not in arguments.published.read_text("utf-8"):
        print(f"error: {arguments.published} has another SHA-256; write there\n    {line},", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
