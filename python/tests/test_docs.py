"""The Python in the guide and in the README runs as it is pasted."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import matplotlib.pyplot as plt
import meshtone as mt
import pytest
from conftest import ROOT

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def repository(folder: Path) -> None:
    """What a reader's working folder has: the examples, of which the tuned ones are made short, and what others computed."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copytree(ROOT / "python/tests/references", folder / "python/tests/references")
    for experiment in folder.glob("examples/experiments/*.toml"):
        text = experiment.read_text(encoding="utf-8")
        experiment.write_text(text.replace("candidates = 160", "candidates = 1"), encoding="utf-8")
    first_look = folder / "examples/datasets/first_look.toml"
    first_look.write_text(first_look.read_text(encoding="utf-8").replace("records = 200", "records = 100"), encoding="utf-8")
    for rig in folder.glob("examples/experiments/rig_*.toml"):
        text = rig.read_text(encoding="utf-8")
        rig.write_text(text if "[solver]" in text else f"{text}\n[solver]\nduration_s = 0.3\n", encoding="utf-8")
    # As `meshtone simulate broken.toml -o broken` leaves it.
    simulation = mt.simulate(mt.examples.tooth_breakage().copy(duration_s=0.3))
    (folder / "broken").mkdir()
    simulation.save(folder / "broken/signals.parquet")


GUIDE = sorted(page.relative_to(ROOT).as_posix() for page in (ROOT / "docs/src/guide").glob("*.md") if BLOCK.search(page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("page", ["README.md", *GUIDE])
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


SHORTER = {
    "fault_severity": [("mt.examples.healthy().copy(din_grade=grade)", "mt.examples.healthy().copy(din_grade=grade, duration_s=0.3)")],
    "campbell": [("np.linspace(10, 60, 101)", "np.linspace(10, 60, 21)")],
    "root_crack": [("np.linspace(0, 4.25, 18)", "np.linspace(0, 4.25, 6)")],
    "sensor_path": [
        ('"time_s": [0, 10], "value": [20, 60]}, settle_fraction=1 / 11', '"time_s": [0, 2], "value": [20, 60]}, settle_fraction=1 / 3'),
        ("duration_s=5)", "duration_s=1)"),
        ("mt.simulate(recorded), rig)", "mt.simulate(recorded), rig, draws=8)"),
    ],
}
"""What is made short in scripts that take long, beside the experiments."""


def draw(script: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, shorter: list[tuple[str, str]]) -> None:
    code = script.read_text(encoding="utf-8")
    for written, instead in shorter:
        assert code.count(written) == 1, written
        code = code.replace(written, instead)
    repository(folder)
    monkeypatch.chdir(folder)
    monkeypatch.setattr("sys.argv", [str(script), str(folder)])
    exec(compile(code, script, "exec"), {"__name__": "__main__"})
    plt.close("all")
    assert (folder / f"python_{script.stem}.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_gallery_scripts_draw(script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that take long are made short; the measurement below runs these as they are."""
    draw(script, tmp_path, monkeypatch, SHORTER.get(script.stem, []))


@pytest.mark.measurement
@pytest.mark.parametrize("name", SHORTER)
def test_gallery_scripts_that_take_long_draw(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    draw(ROOT / "python" / "gallery" / f"{name}.py", tmp_path, monkeypatch, [])
