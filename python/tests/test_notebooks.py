"""The notebooks of the book: they run, and the page of each is what it gives.

Outputs are not kept in a notebook; its page has them. ``MESHTONE_GENERATE=1 python -m pytest python/tests/test_notebooks.py`` writes the pages and
their pictures anew: look at them.
"""

from __future__ import annotations

import base64
import os
import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbclient
import nbformat
import numpy as np
import pytest
from conftest import ROOT

FOLDER = ROOT / "docs" / "src" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
OUTPUT = re.compile(r"^```text\n(.*?)^```\n", re.MULTILINE | re.DOTALL)


def outputs(cell: Any, widgets: dict[str, Any]) -> list[Any]:
    """What a cell shows; what its sliders show stands in the state of their widgets."""
    found = []
    for output in cell.outputs:
        view = output.get("data", {}).get("application/vnd.jupyter.widget-view+json")
        if view is None:
            found.append(output)
            continue
        children = [child.removeprefix("IPY_MODEL_") for child in widgets[view["model_id"]]["state"]["children"]]
        found += [nbformat.from_dict(inner) for child in children for inner in widgets[child]["state"].get("outputs", ())]
    assert all(output.output_type != "error" for output in found), found
    return found


def page(name: str, content: Any) -> tuple[str, list[bytes]]:
    """The page of a notebook that has run, and its pictures.

    Of an output with a picture this is shown, otherwise its text. A picture is described by the comment in its cell's first line. The code of a cell
    with Jupyter Book's tag `hide-input` is in the notebook alone.
    """
    widgets = content.metadata.get("widgets", {}).get("application/vnd.jupyter.widget-state+json", {}).get("state", {})
    parts: list[str] = []
    pictures: list[bytes] = []
    for cell in content.cells:
        if "hide-input" not in cell.metadata.get("tags", ()):
            parts.append(cell.source if cell.cell_type == "markdown" else f"```python\n{cell.source}\n```")
        for output in outputs(cell, widgets) if cell.cell_type == "code" else ():
            data = output.get("data", {})
            if "image/png" in data:
                pictures.append(base64.b64decode(data["image/png"]))
                words = cell.source.splitlines()[0]
                assert words.startswith("# "), f"{name}: a cell that draws begins with a comment that says what"
                parts.append(f"![{words[2:]}]({name}_{len(pictures)}.png)")
            elif output.output_type != "display_data":
                shown = output.get("text", data.get("text/plain", ""))
                parts.append(f"```text\n{shown.rstrip()}\n```")
    title, *rest = parts[0].splitlines()
    parts[0] = "\n".join([title, *rest, "", f"[Download this notebook]({name}.ipynb) to run it."])
    return "\n\n".join(parts) + "\n", pictures


@cache
def executed(notebook: Path) -> Any:
    """The notebook with its outputs, run in a folder of its own."""
    content = nbformat.read(notebook, as_version=4)
    assert all(not cell.get("outputs") for cell in content.cells), "outputs are not kept: its page has them"
    with TemporaryDirectory() as folder:
        return nbclient.NotebookClient(content, timeout=120, coalesce_streams=True, resources={"metadata": {"path": folder}}).execute()


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_page_is_what_the_notebook_gives(notebook: Path) -> None:
    """Words and code exactly, printed numbers to 1 %, as many pictures."""
    content = executed(notebook)
    text, pictures = page(notebook.stem, content)
    place = notebook.with_suffix(".md")
    drawn = [FOLDER / f"{notebook.stem}_{number}.png" for number in range(1, len(pictures) + 1)]
    if "MESHTONE_GENERATE" in os.environ:
        place.write_text(text, "utf-8")
        for path, picture in zip(drawn, pictures, strict=True):
            path.write_bytes(picture)
    written = place.read_text("utf-8")
    assert OUTPUT.sub("", written) == OUTPUT.sub("", text)
    for old, new in zip(OUTPUT.findall(written), OUTPUT.findall(text), strict=True):
        assert NUMBER.sub("0", old) == NUMBER.sub("0", new)
        np.testing.assert_allclose([float(number) for number in NUMBER.findall(old)], [float(number) for number in NUMBER.findall(new)], rtol=0.01)
    assert sorted(FOLDER.glob(f"{notebook.stem}_*.png")) == sorted(drawn)


def test_a_notebook_shows_light_pages_and_one_bar() -> None:
    content = executed(FOLDER / "simulate_and_see.ipynb")
    pages = [output["data"]["text/html"] for cell in content.cells for output in cell.get("outputs", ()) if "text/html" in output.get("data", {})]
    assert sum("<svg" in page for page in pages) >= 2
    # One bar, which was moved: not one for each message.
    assert sum("<progress" in page for page in pages) == 1
