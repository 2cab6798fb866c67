"""What notebooks show: light pages and pictures, one bar of progress."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from IPython.core.completer import IPCompleter, provisionalcompleter

import meshtone as mt
from meshtone import _display, _progress

LARGEST_BYTES = 30_000


def pictures(page: str) -> list[ElementTree.Element]:
    return [ElementTree.fromstring(svg) for svg in re.findall("<svg.*?</svg>", page, re.DOTALL)]


def test_pages_are_light() -> None:
    scenario = mt.examples.tooth_breakage()
    simulation = mt.simulate(scenario)
    [signals] = mt.simulate_many([scenario])
    assert isinstance(signals, mt.Signals)
    for shown in (simulation, simulation.process(), signals, scenario):
        page = shown._repr_html_()
        assert len(page.encode()) < LARGEST_BYTES
        ElementTree.fromstring(page)
        assert len(pictures(page)) == (0 if shown is scenario else 2)
    page = simulation._repr_html_()
    assert "tooth-breakage" in page
    # What has a unit shows it, also what the channel's name does not state the unit of.
    assert re.search(r"difference_rms</td><td[^>]*>[\d.]+ g<", page) and re.search(r"difference_kurtosis</td><td[^>]*>[\d.]+<", page)
    assert re.search(r"average_rms</td><td[^>]*>[\d.]+ g<", simulation.process()._repr_html_())
    bearing = mt.process_channel(simulation.vertical_g, mt.ShaftPhase.constant(40, simulation.sampling_rate_hz, 95608), 17, name="bearing")
    assert re.search(r"average_rms</td><td[^>]*>[\d.]+<", bearing._repr_html_()) and "(g)" not in bearing._repr_html_()


def test_pages_need_no_matplotlib() -> None:
    program = "import sys, meshtone as mt; mt.simulate(mt.examples.healthy())._repr_html_(); sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_a_curve_keeps_its_extremes() -> None:
    values = np.zeros(100_000)
    values[31_234], values[70_001] = 3.0, -5.0
    [svg] = pictures(_display.curve(values, span=(0, 2), over="Time (s)", label="Force (N)"))
    assert svg.attrib["aria-label"] == "Force (N) over Time (s)"
    path = [element.attrib["d"] for element in svg.iter("path") if element.attrib.get("stroke") == _display.BLUE][0]
    heights = [float(y) for y in re.findall(r"[ML][\d.]+ ([\d.]+)", path)]
    assert min(heights) == _display.TOP
    assert max(heights) == _display.HEIGHT - _display.BOTTOM
    words = [element.text for element in svg.iter("text")]
    assert {"Time (s)", "Force (N)", "0", "2", "-4"} <= set(words)


def test_gaps_and_constants() -> None:
    with_gap = np.array([1.0, 1.0, np.nan, 1.0])
    [svg] = pictures(_display.curve(with_gap, span=(0, 1), over="x", label="<&>"))
    path = [element.attrib["d"] for element in svg.iter("path") if element.attrib.get("stroke") == _display.BLUE][0]
    assert path.count("M") == 2
    assert [element.text for element in svg.iter("text")][-1] == "<&>"


def test_progress_in_a_file_is_its_end_alone(capsys: pytest.CaptureFixture[str]) -> None:
    report = _progress.shown("records")
    for finished in range(1, 5):
        report(finished, 4)
    written = capsys.readouterr().err
    assert written.startswith("4 of 4 records") and written.count("\n") == 1 and "\r" not in written


def test_progress_on_the_terminal(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    report = _progress.shown("records")
    report(1, 2)
    report(2, 2)
    report(2, 2)
    written = capsys.readouterr().err
    assert written.count("\r") == 2
    assert written.endswith("\n")


def test_names_and_keys_are_completed() -> None:
    scenario = mt.examples.healthy().copy(sampling_rate_hz=1e4, sensors=[mt.Sensor(name="casing")])
    simulation = mt.simulate(scenario)
    record = simulation.process()
    names = {
        "mt": mt,
        "scenario": scenario,
        "simulation": simulation,
        "signals": simulation.signals(),
        "record": record,
        "indicators": record.indicators,
        "recording": mt.Recording(10.0, 0.0, {"bearing": np.zeros(3)}, {}, None),
    }
    wanted = {
        "mt.Scenario(din": "din_grade=",
        "mt.Scenario(faul": "faults=",
        "mt.MissingTooth(too": "tooth=",
        "mt.simulate_many([scenario], on": "on_error=",
        "scenario.": "module_mm",
        "scenario.copy(din": "din_grade=",
        "simulation.": "vertical_g",
        "simulation.gear_rad": "gear_radii_mm",
        "signals.cas": "casing_g",
        'indicators["': "fm4",
        'record.indicators["difference_k': "difference_kurtosis",
        'recording["': "bearing",
    }
    completer = IPCompleter(namespace=names)
    for typed, expected in wanted.items():
        with provisionalcompleter():
            offered = [completion.text.lstrip(".") for completion in completer.completions(typed, len(typed))]
        assert expected in offered, typed
