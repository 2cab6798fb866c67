"""The Python in the guide and in the README runs as it is pasted."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from conftest import ROOT

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def repository(folder: Path) -> None:
    """What a reader's working folder has: the examples, of which the tuned ones are made short, and what others computed."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copytree(ROOT / "python/tests/references", folder / "python/tests/references")
    for experiment in folder.glob("examples/experiments/*.toml"):
        text = experiment.read_text(encoding="utf-8")
        experiment.write_text(text.replace("candidates = 160", "candidates = 4"), encoding="utf-8")


@pytest.mark.parametrize("page", ["README.md", "docs/src/guide/python.md", "docs/src/guide/matlab-users.md"])
def test_blocks_run_in_order(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    repository(tmp_path)
    monkeypatch.chdir(tmp_path)
    # A picture that is shown would wait for somebody to close it.
    monkeypatch.setattr(plt, "show", lambda: None)
    blocks = list(BLOCK.finditer(text))
    assert blocks
    names: dict[str, object] = {"__name__": "__main__"}
    for block in blocks:
        # Blank lines before it, so that an error names the page's line.
        code = "\n" * text[: block.start(1)].count("\n") + block.group(1)
        exec(compile(code, page, "exec"), names)
    plt.close("all")


def test_error_texts_of_the_guide(capsys: pytest.CaptureFixture[str]) -> None:
    """The guide shows what its block of errors prints."""
    text = (ROOT / "docs/src/guide/python.md").read_text(encoding="utf-8")
    chapter = text[text.index("## If something is wrong") :]
    block = BLOCK.search(chapter)
    shown = re.search(r"^```text\n(.*?)^```$", chapter, re.MULTILINE | re.DOTALL)
    assert block is not None and shown is not None
    exec("import meshtone as mt\nhealthy = mt.examples.healthy()\n" + block.group(1), {})
    assert capsys.readouterr().out == shown.group(1)


SCRIPTS = sorted((ROOT / "python/gallery").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_gallery_includes_its_scripts(script: Path) -> None:
    """The checks of the book see to it that every included file exists."""
    page = (ROOT / "docs/src/gallery/gallery.md").read_text(encoding="utf-8")
    assert f"```python\n{{{{#include ../../../python/gallery/{script.name}}}}}\n```\n" in page
    assert f"](python_{script.stem}.png)" in page


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_gallery_scripts_draw(script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repository(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [str(script), str(tmp_path)])
    exec(compile(script.read_text(encoding="utf-8"), script, "exec"), {"__name__": "__main__"})
    plt.close("all")
    assert (tmp_path / f"python_{script.stem}.png").read_bytes().startswith(b"\x89PNG")
