"""The page of ``mt.explore``: from Python, and in a browser where one is installed."""

from __future__ import annotations

import gzip
import io
import json
import os
import random
import shutil
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.io import loadmat, wavfile

import meshtone as mt

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

FORMATS = Path(__file__).parents[2] / "crates" / "meshtone-io" / "tests" / "recordings" / "formats"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
CHANGES = int(os.environ.get("MESHTONE_EXPLORE_CHANGES", "60"))
"""Random changes of the long test; ``MESHTONE_EXPLORE_CHANGES=1000 python -m pytest python/tests/test_explore.py`` for many."""
PATIENCE_S = 120


def fast() -> mt.Scenario:
    """A scenario that takes milliseconds."""
    return mt.Scenario(
        module_mm=3, pinion_teeth=20, gear_teeth=40, face_width_mm=15, pinion_speed_hz=40, brake_torque_nm=200, sampling_rate_hz=1e4
    )


def ask(explorer: mt.Explorer, path: str, question: dict[str, Any], **headers: str) -> bytes:
    """What the page's server answers."""
    assert explorer.url is not None
    origin = "/".join(explorer.url.split("/")[:3])
    data = json.dumps(question).encode()
    request = urllib.request.Request(explorer.url + path, data=data, headers={"Origin": origin, **headers})
    with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
        return bytes(response.read())


@pytest.fixture
def explorer() -> Iterator[mt.Explorer]:
    """A page that opens no browser."""
    with mt.explore(fast(), open_browser=False) as explorer:
        yield explorer


def test_what_is_set_on_the_page_comes_back(explorer: mt.Explorer) -> None:
    assert explorer.scenario == fast()
    other = fast().copy(pinion_speed_hz=35, fault=mt.RootCrack(severity=0.5))
    ask(explorer, "answer", {"page": "test", "number": 1, "detail": "full", "toml": other.to_toml()})
    assert explorer.scenario == other
    explorer.close()
    assert explorer.url is None
    assert explorer.scenario == other
    assert "closed" in explorer._repr_html_()


def test_only_the_page_itself_may_ask(explorer: mt.Explorer) -> None:
    with pytest.raises(urllib.error.HTTPError, match="403"):
        ask(explorer, "answer", {}, Origin="http://elsewhere.example")
    assert explorer.url is not None
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen("/".join(explorer.url.split("/")[:3]) + "/")


def test_a_notebook_shows_the_page(explorer: mt.Explorer) -> None:
    assert f'<iframe src="{explorer.url}"' in explorer._repr_html_()


def test_a_port_that_is_taken_is_reported(explorer: mt.Explorer) -> None:
    assert explorer.url is not None
    port = int(explorer.url.split(":")[2].split("/")[0])
    with pytest.raises(OSError, match=f"port = {port}: cannot serve"):
        mt.explore(fast(), port=port, open_browser=False)


@pytest.mark.parametrize("name", sorted(mt.examples.all()))
def test_python_of_the_page_makes_the_scenario(explorer: mt.Explorer, name: str) -> None:
    scenario = mt.examples.all()[name].copy(model="linear", flank_relief={"length_mm": 1, "amount_um": 20}, seed=3, wheels_seed=5)
    text = ask(explorer, "export/python", {"page": name, "number": 1, "toml": scenario.to_toml()}).decode()
    made: dict[str, Any] = {}
    exec(text.split("\nsimulation")[0], made)
    assert made["scenario"] == scenario


# In a browser.


def changes_words(page: Chrome) -> str:
    """What the page says is wrong; empty where nothing is."""
    shown: str = page.execute_script("const p = document.getElementById('problem'); return p.hidden ? '' : p.textContent")
    return shown


class Page:
    """The page in a browser."""

    def __init__(self, browser: Chrome, url: str) -> None:
        self.browser = browser
        self.browser.get("about:blank")
        self.browser.get(url)
        self.wait(lambda: self.run("return window.meshtone?.drawn > 0"), "the first picture")

    def run(self, script: str, *arguments: object) -> Any:
        """What a script returns."""
        return self.browser.execute_script(script, *arguments)

    def wait(self, holds: Callable[[], object], what: str) -> None:
        """Wait until something holds."""
        until = time.monotonic() + PATIENCE_S
        while not holds():
            assert time.monotonic() < until, f"waited in vain for {what}; the page says: {changes_words(self.browser)}"
            time.sleep(0.02)

    def settled(self, change: Callable[[], object], what: str) -> str:
        """Do something and wait for the picture or the refusal that follows; what is wrong."""
        self.run("document.getElementById('status').textContent = ''; window.before = window.meshtone.drawn")
        change()
        done = "return meshtone.drawn > before || document.getElementById('status').textContent === 'not computed'"
        self.wait(lambda: self.run(done), what)
        return changes_words(self.browser)

    def enter(self, key: str, value: str) -> str:
        """Type a value at a key; what is wrong with it."""
        script = """
            const field = document.getElementById('key-' + arguments[0]);
            field.value = arguments[1];
            field.dispatchEvent(new Event('change', { bubbles: true }));
        """
        return self.settled(lambda: self.run(script, key, value), f"{key} = {value}")

    def described(self, plot: str) -> str:
        """What is said of a plot."""
        return self.run("return document.getElementById(arguments[0]).getAttribute('aria-label') ?? ''", plot) or ""

    def drop(self, name: str, content: bytes) -> None:
        """Drop a file on the page."""
        script = """
            const files = new DataTransfer();
            files.items.add(new File([new Uint8Array(arguments[1])], arguments[0]));
            document.dispatchEvent(new DragEvent('drop', { dataTransfer: files, bubbles: true }));
        """
        self.run(script, name, list(content))

    def errors(self) -> list[str]:
        """What the console holds of errors; a refusal's status is none."""
        entries = self.browser.get_log("browser")  # type: ignore[no-untyped-call]
        refused = ("status of 422", "status of 409")
        return [
            entry["message"]
            for entry in entries
            if entry["level"] == "SEVERE" and not any(words in entry["message"] for words in refused)
        ]


@pytest.fixture(scope="module")
def browser() -> Iterator[Chrome]:
    """A browser without a window."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    driver = shutil.which("chromedriver")
    if program is None or driver is None:
        pytest.skip("no browser: install chromium and chromedriver to try the page in one")
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = program
    # The wheels stand still where nobody asks that they turn.
    more = ("--disable-gpu", "--force-prefers-reduced-motion")
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1400,1000", *more):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    # The path of a socket there may be no longer than some 100 letters.
    browser = webdriver.Chrome(options=options, service=Service(driver, env={**os.environ, "TMPDIR": "/tmp"}))
    yield browser
    browser.quit()


@pytest.fixture
def page(browser: Chrome, explorer: mt.Explorer) -> Iterator[Page]:
    """The page in the browser."""
    yield from shown(browser, explorer)


def shown(browser: Chrome, explorer: mt.Explorer) -> Iterator[Page]:
    """A page in the browser, at whose end the console holds no error."""
    assert explorer.url is not None
    page = Page(browser, explorer.url)
    yield page
    errors = page.errors()
    # It asks no more of a server that is about to end.
    browser.get("about:blank")
    assert errors == []


def test_every_control_can_be_moved(page: Page, explorer: mt.Explorer) -> None:
    add = "const add = document.getElementById('add-fault'); add.previousSibling.value = 'root-crack'; add.click()"
    page.settled(lambda: page.run(add), "a crack")
    moved = """
        const control = [...document.querySelectorAll('#controls .control')][arguments[0]];
        const slider = control.querySelector('input[type=range]:not([hidden])');
        const choice = control.querySelector('select');
        const field = slider ?? choice ?? control.querySelector('input');
        if (slider) slider.value = Number(slider.value) + (Number(slider.max) - Number(slider.min)) * 0.02;
        if (choice) choice.selectedIndex = (choice.selectedIndex + 1) % choice.options.length;
        field.dispatchEvent(new Event('input', { bubbles: true }));
        field.dispatchEvent(new Event('change', { bubbles: true }));
        return control.dataset.key;
    """
    count = page.run("return document.querySelectorAll('#controls .control').length")
    assert count > 80
    start = page.run("return document.querySelector('#text textarea').value")
    keys = set()

    def move(index: int) -> None:
        keys.add(page.run(moved, index))

    step = 1 if CHANGES >= 1000 else 6
    for index in range(0, count, step):
        page.settled(partial(move, index), f"control {index}")
        if index % (5 * step) == 0:
            # From the start again, so that what is set together can be.
            page.settled(lambda: page.drop("start.toml", start.encode()), "the start")
            page.wait(lambda: page.run("return !document.querySelector('#controls [aria-invalid]')"), "the start")
    assert len(keys) >= count // step
    assert explorer.scenario.pinion_teeth == 20
    # A key that is held down moves; let go, it releases.
    held = """
        window.slider = document.querySelector('[data-key="operation.pinion_speed_hz"] input[type=range]');
        slider.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', repeat: true }));
        slider.value = 42;
        slider.dispatchEvent(new Event('change', { bubbles: true }));
        window.coarse = meshtone.coarse;
    """
    page.run(held)
    page.wait(lambda: page.run("return meshtone.coarse > coarse"), "a coarse picture")
    assert explorer.scenario.pinion_speed_hz != 42
    page.settled(lambda: page.run("slider.dispatchEvent(new KeyboardEvent('keyup', { key: 'ArrowRight' }))"), "the release")
    assert explorer.scenario.pinion_speed_hz == 42


def test_wrong_values_are_reported_at_their_key(page: Page, explorer: mt.Explorer) -> None:
    assert page.enter("gears.module_mm", "-3") == "gears.module_mm = -3: must be more than 0 mm"
    shown = page.run("return document.getElementById('key-gears.module_mm-problem').textContent")
    assert shown == "must be more than 0 mm"
    assert page.run("return document.getElementById('key-gears.module_mm').getAttribute('aria-invalid')") == "true"
    assert page.enter("gears.module_mm", "three") == 'gears.module_mm = "three": must be a number, not text'
    assert explorer.scenario == fast()
    assert page.enter("gears.module_mm", "2.5") == ""
    assert explorer.scenario.module_mm == 2.5
    assert not page.run("return document.querySelector('#controls [aria-invalid]')")


def test_speed_over_time_is_a_table(page: Page, explorer: mt.Explorer) -> None:
    page.settled(lambda: page.run("document.getElementById('key-operation.speed_profile_hz').click()"), "a profile")
    insert = "document.querySelector('[aria-label=\"Insert a point after point 1\"]').click()"
    page.settled(lambda: page.run(insert), "a point")
    profile = explorer.scenario.speed_profile_hz
    assert profile is not None
    end_s = profile["time_s"][-1]
    assert profile == {"time_s": [0.0, end_s / 2, end_s], "value": [40.0] * 3}
    name = "speed profile, point 2: value in Hz"
    script = """
        const field = document.querySelector(`[aria-label="${arguments[0]}"]`);
        field.value = arguments[1];
        field.dispatchEvent(new Event('change'));
    """
    shown = page.settled(lambda: page.run(script, name, "-4"), "a wrong speed")
    assert shown == "operation.speed_profile_hz.value[1] = -4: must be more than 0 rev/s"
    assert page.run("return document.querySelector('#controls [aria-invalid]').getAttribute('aria-label')") == name
    assert page.settled(lambda: page.run(script, name, "41"), "a speed") == ""
    assert explorer.scenario.speed_profile_hz == {**profile, "value": [40.0, 41.0, 40.0]}
    page.settled(lambda: page.run("document.querySelector('[aria-label=\"Remove point 2\"]').click()"), "two points")
    page.settled(lambda: page.run("document.getElementById('key-operation.speed_profile_hz').click()"), "no profile")
    assert explorer.scenario == fast()


def test_values_under_the_pointer_follow(page: Page) -> None:
    """A new answer neither takes them away nor leaves those of the last one."""
    shown = "return document.querySelector('#waveform .values').textContent"
    assert page.run(shown) == ""
    page.run("document.getElementById('waveform').dispatchEvent(new KeyboardEvent('keydown', { key: '+' }))")
    place, value = page.run(shown).split(": ")
    assert page.enter("operation.brake_torque_nm", "100") == ""
    assert page.run(shown).split(": ")[0] == place and page.run(shown).split(": ")[1] != value


def test_a_preset_its_damage_and_severity(page: Page, explorer: mt.Explorer) -> None:
    script = "const p = document.getElementById('preset'); p.value = 'tooth_breakage'; p.dispatchEvent(new Event('change'))"
    page.settled(lambda: page.run(script), "the preset")
    assert explorer.scenario.fault == mt.examples.tooth_breakage().fault
    page.wait(lambda: page.run("return document.querySelectorAll('#indicators tbody tr').length === 86"), "indicators")
    page.wait(lambda: "The line marks" in page.run("return document.getElementById('severity-note').textContent"), "severities")
    # Those that moved most, with the chosen one; all where they are wanted.
    seen = "return [...document.querySelectorAll('#indicators tbody tr')].filter((row) => !row.hidden).map((row) => row.cells[0].textContent)"
    page.wait(lambda: 10 <= len(page.run(seen)) <= 11, "those that moved")
    assert "difference kurtosis" in page.run(seen) and "average skewness" not in page.run(seen)
    page.run("document.getElementById('all-indicators').click()")
    assert len(page.run(seen)) == 86
    page.run("document.getElementById('all-indicators').click()")
    page.enter("fault[0].severity", "0.3")
    fault = explorer.scenario.fault
    assert fault is not None
    assert (fault.severity, explorer.scenario.fault_severities) == (0.3, [0.3])
    # A size takes the severity's place, and the others stay as it made them.
    page.enter("fault[0].chip_width_mm", "9")
    fault = explorer.scenario.fault
    assert isinstance(fault, mt.ToothBreakage)
    assert (fault.severity, fault.chip_width_mm) == (None, 9.0)
    assert fault.chip_height_mm is not None and fault.chip_height_mm > 0


def test_exported_reopened_held_and_linked(page: Page, explorer: mt.Explorer) -> None:
    page.enter("operation.pinion_speed_hz", "33")
    page.run("document.getElementById('hold').click()")
    wanted = explorer.scenario
    toml = ask(explorer, "export/toml", {"page": "x", "number": 1, "toml": wanted.to_toml()})
    page.enter("operation.pinion_speed_hz", "37")
    page.wait(lambda: "held" in page.described("average"), "what is held")
    page.settled(lambda: page.drop("mine.toml", toml), "the file")
    assert explorer.scenario == wanted
    page.run("document.getElementById('link').click()")
    page.wait(lambda: page.run("return location.hash.length > 100"), "the link")
    link = page.run("return location.href")
    page.enter("operation.pinion_speed_hz", "38")
    Page(page.browser, link)
    assert explorer.scenario == wanted
    for form in ("toml", "python", "svg", "parquet"):
        page.run(f"document.getElementById('status').textContent = ''; document.querySelector('[data-export={form}]').click()")
        page.wait(lambda: page.run("return document.getElementById('status').textContent.includes('saved')"), form)


def test_a_recording_is_dropped(page: Page) -> None:
    times = np.arange(8000) / 8000
    samples = np.sin(2 * np.pi * 800 * times) + 0.1 * np.random.default_rng(1).normal(size=8000)
    csv = "time_s,bearing [g]\n" + "\n".join(f"{t:.6f},{x:.5f}" for t, x in zip(times, samples))
    page.drop("rig.csv", csv.replace("time_s", "first").encode())
    page.wait(lambda: "in the field Sampling rate" in text_of(page, "desk"), "what the file does not say")
    page.run("""
        const rate = document.querySelector('#desk [data-field=sampling_rate_hz]');
        rate.value = 8000;
        rate.dispatchEvent(new Event('change', { bubbles: true }));
    """)
    page.wait(lambda: "8000 S/s" in text_of(page, "desk"), "the desk")
    page.run("document.getElementById('desk-cancel').click()")
    assert text_of(page, "desk") == ""
    open_recording(page, "rig.csv", csv.encode())
    page.wait(lambda: "recording" in page.described("average"), "its average")
    table = "const s = document.querySelector('.scroll'); return s.textContent.includes('recording') && s.scrollWidth <= s.clientWidth"
    page.wait(lambda: page.run(table), "a table of which nothing is cut off")
    page.drop("rig.wav", b"no sound")
    page.wait(lambda: "rig.wav" in changes_words(page.browser), "the refusal")


def every_kind() -> dict[str, bytes]:
    """One recording of 400 pulses/s as a file of every kind, each with its unit and rate as far as the kind has them."""
    recorded = loadmat(FORMATS / "version4.mat", squeeze_me=True)
    acc, tacho = recorded["acc"], recorded["tacho"]
    rows = "".join(f"{n / 25_600:.8f}\t{a}\t{t}\n" for n, (a, t) in enumerate(zip(acc, tacho)))
    end = "***End_of_Header***\n"
    lvm = f"LabVIEW Measurement\nSeparator\tTab\n{end}Channels\t2\nY_Unit_Label\tg\tV\nDelta_X\t3.90625E-5\t3.90625E-5\n{end}X_Value\tacc\ttacho\n"
    csv = ("time [s]\tacc [g]\ttacho [V]\n" + rows).replace("\t", ",").encode()
    npz, table, wav = io.BytesIO(), io.BytesIO(), io.BytesIO()
    np.savez(npz, acc=acc, tacho=tacho, fs=25_600.0)
    parquet.write_table(pa.table({"time_s": np.arange(len(acc)) / 25_600, "acc": acc, "tacho": tacho}), table)
    wavfile.write(wav, 25_600, np.column_stack([acc, tacho]).astype(np.float32))
    files = {"run.csv": csv, "run.csv.gz": gzip.compress(csv), "run.lvm": (lvm + rows).encode()}
    files |= {"run.npz": npz.getvalue(), "run.parquet": table.getvalue(), "run.wav": wav.getvalue()}
    written = ("plain.tdms", "plain.mf4", "plain.xlsx", "version4.mat", "half.h5", "text.uff")
    return files | {name: (FORMATS / name).read_bytes() for name in written}


def field(page: Page, name: str) -> str:
    """What stands in a field of the desk."""
    stands: str = page.run("return document.querySelector(`#desk [data-field=${arguments[0]}]`).value", name)
    return stands


def test_a_recording_of_every_kind_ends_at_indicators(page: Page) -> None:
    rig = fast().copy(gear_teeth=20, pinion_speed_hz=400, sampling_rate_hz=1e5).to_toml()
    page.settled(lambda: page.drop("rig.toml", rig.encode()), "the rig")
    row = "return [...document.querySelector('#indicators tbody tr').cells].at(-1).textContent"
    seen = {}
    for name, content in every_kind().items():
        page.drop(name, content)
        page.wait(lambda name=name: f"{name}: is this right?" in text_of(page, "desk"), name)  # type: ignore[misc]
        assert "2 channels, 0.01 s at 25600 S/s by" in text_of(page, "desk"), name
        assert "gives 400 pulses/s, so that the input turns at 400 Hz, and in the scenario at 400 Hz" in text_of(page, "desk"), name
        assert field(page, "channel").startswith("channel 1" if name == "run.wav" else "acc"), name
        assert field(page, "tachometer").startswith("channel 2" if name == "run.wav" else "tacho"), name
        page.run("document.getElementById('desk-use').click()")
        page.wait(lambda name=name: f"{name}, by tachometer" in text_of(page, "recording"), name)  # type: ignore[misc]
        head = "return [...document.querySelectorAll('#indicators thead th')].at(-1).textContent"
        page.wait(lambda: page.run(head) == "recording", "the recording's indicators")
        seen[name] = page.run(row)
        page.run("[...document.querySelectorAll('#recording button')].at(-1).click()")
        page.wait(lambda: page.run(head) != "recording", "the removal")
    assert float(seen["run.csv"]) > 0.1
    assert set(seen.values()) == {seen["run.csv"]}, seen


RIG = fast().copy(model="linear", din_grade=6, sampling_rate_hz=8000)
"""A rig whose simulations take milliseconds."""


@pytest.fixture
def rig_explorer(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Iterator[mt.Explorer]:
    """A page of the rig, which keeps its simulations in a folder of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
    with mt.explore(RIG, open_browser=False) as explorer:
        yield explorer


@pytest.fixture
def rig_page(browser: Chrome, rig_explorer: mt.Explorer) -> Iterator[Page]:
    """The same in the browser."""
    yield from shown(browser, rig_explorer)


def text_of(page: Page, name: str) -> str:
    """What an element that is in sight says; empty where there is none."""
    shown: str = page.run("const e = document.getElementById(arguments[0]); return e?.offsetParent ? e.innerText : ''", name)
    return shown


def open_recording(page: Page, name: str, content: bytes) -> None:
    """Drop a recording, and wait until it is read."""
    page.drop(name, content)
    page.wait(lambda: name in text_of(page, "desk") or name in text_of(page, "recording"), f"{name} on the desk")
    page.run("if (!document.getElementById('desk').hidden) document.getElementById('desk-use').click()")
    page.wait(lambda: name in text_of(page, "recording"), f"{name} to be read")


def signals_of(explorer: mt.Explorer, scenario: mt.Scenario) -> bytes:
    """The file of a simulation."""
    return ask(explorer, "export/parquet", {"page": "files", "number": 1, "toml": scenario.to_toml()})


def test_a_recording_is_diagnosed(rig_page: Page, rig_explorer: mt.Explorer, tmp_path: Path) -> None:
    page = rig_page
    assert text_of(page, "diagnosis") == ""
    sound = tmp_path / "sound.parquet"
    sound.write_bytes(signals_of(rig_explorer, RIG.copy(seed=5)))
    broken = signals_of(rig_explorer, RIG.copy(fault=mt.MissingTooth(tooth=8), seed=5))
    open_recording(page, "broken.parquet", broken)
    page.browser.find_element("id", "healthy-file").send_keys(str(sound))
    page.wait(lambda: "sound.parquet, as healthy" in text_of(page, "diagnosis"), "the healthy recording")
    diagnose = """
        window.progress = [];
        new MutationObserver(() => progress.push(document.getElementById('diagnosis-status').textContent))
          .observe(document.getElementById('diagnosis-status'), { childList: true });
        document.getElementById('records').value = arguments[0];
        document.getElementById('diagnose').click();
    """
    page.run(diagnose, 1024)
    page.wait(lambda: text_of(page, "kinds"), "the table of kinds")
    found = text_of(page, "found")
    assert found.startswith("The gear is damaged") and "tooth 8" in found.partition("\n")[0]
    assert "damaged with a probability of" in found and "severity (90 %)" in found
    assert "1024 of 1024 simulations" in page.run("return progress")
    assert text_of(page, "seen") == ""
    # Of another rig it is no answer, of other damage it is.
    page.enter("operation.brake_torque_nm", "210")
    assert "has been changed" in text_of(page, "diagnosis")
    page.enter("operation.brake_torque_nm", "200")
    assert "has been changed" not in text_of(page, "diagnosis")

    # What no simulation is like has no probabilities; that is said at once.
    noise = np.random.default_rng(1).normal(size=16_000)
    rows = [f"{n / 8000:.6f},{x:.5f},{int(n % 200 < 20)}" for n, x in enumerate(noise)]
    open_recording(page, "noise.csv", "\n".join(["time_s,bearing [g],tacho", *rows]).encode())
    # The desk saw the pulses.
    assert "by tachometer" in text_of(page, "recording")
    assert text_of(page, "found") == ""
    page.run(diagnose, 1024)
    page.wait(lambda: "unlike" in text_of(page, "found"), "the answer")
    assert text_of(page, "kinds") == "" and "probability" not in text_of(page, "found")
    seen = text_of(page, "seen")
    assert "no signal is synchronous" in seen


def test_a_diagnosis_is_stopped(rig_page: Page, rig_explorer: mt.Explorer) -> None:
    page = rig_page
    open_recording(page, "sound.parquet", signals_of(rig_explorer, RIG))
    status = "diagnosis-status"
    page.run("document.getElementById('records').value = 20480; document.getElementById('diagnose').click()")
    page.wait(lambda: " of 20480 simulations" in text_of(page, status), "progress")
    assert "when it was healthy" in text_of(page, "seen") and text_of(page, "diagnose") == ""
    page.wait(lambda: int(text_of(page, status).split()[0]) > 512, "a batch")
    # The scenario is simulated meanwhile.
    page.enter("operation.brake_torque_nm", "210")
    page.run("document.getElementById('stop').click()")
    assert "stopped" in text_of(page, status) and text_of(page, "diagnose") == "Diagnose"
    page.enter("operation.brake_torque_nm", "200")
    # It goes on with what is kept.
    page.run("document.getElementById('records').value = 1024; document.getElementById('diagnose').click()")
    page.wait(lambda: text_of(page, "kinds"), "the answer")
    page.run("document.getElementById('records').value = 1; document.getElementById('diagnose').click()")
    page.wait(lambda: "from 512 to 20480" in text_of(page, "found"), "the refusal")


def test_many_random_changes_leave_no_error(page: Page, explorer: mt.Explorer) -> None:
    """Sliders, typed values, damage added and removed, channels and wheels, faster than answers come."""
    draw = random.Random(7)
    script = """
        const [pick, place] = arguments;
        const controls = [...document.querySelectorAll('#controls .control')];
        const control = controls[Math.floor(pick * controls.length)];
        const slider = control.querySelector('input[type=range]:not([hidden])');
        const kind = Math.floor(place * 1000) % 12;
        if (kind === 0) document.getElementById('add-fault').click();
        else if (kind === 1) document.querySelector('#controls button[aria-label^="Remove"]')?.click();
        else if (kind === 2) document.getElementById('hold').click();
        else if (kind === 3) {
          const choice = document.getElementById(pick < 0.5 ? 'wheel' : 'channel');
          choice.selectedIndex = Math.floor(place * choice.options.length);
          choice.dispatchEvent(new Event('change', { bubbles: true }));
        } else if (slider && !/sampling_rate|teeth$/.test(control.dataset.key)) {
          for (const way of [0.4 * place, 0.7 * place, place]) {
            slider.value = Number(slider.min) + (Number(slider.max) - Number(slider.min)) * way;
            slider.dispatchEvent(new Event('input', { bubbles: true }));
          }
          slider.dispatchEvent(new Event('change', { bubbles: true }));
        }
    """
    for number in range(CHANGES):
        page.run(script, draw.random(), draw.random())
        if number % 20 == 19:
            preset = draw.randrange(1, 12)
            choose = "const p = document.getElementById('preset'); p.selectedIndex = arguments[0]; p.dispatchEvent(new Event('change'))"
            page.run(choose, preset)
            time.sleep(0.2)
    page.settled(lambda: page.drop("end.toml", fast().to_toml().encode()), "the end")
    page.wait(lambda: explorer.scenario == fast(), "the last scenario")
    assert changes_words(page.browser) == ""


def test_what_is_seen_has_names(page: Page) -> None:
    """Every field has a label, every plot a description, on a narrow screen too; the wheels turn when they are asked to."""
    turned = "return document.getElementById('turn').value"
    before = page.run(turned)
    page.run("document.getElementById('play').click()")
    page.wait(lambda: page.run(turned) != before, "the wheels to turn")
    page.run("document.getElementById('play').click()")
    page.browser.set_window_size(420, 900)
    nameless = """
        return [...document.querySelectorAll('input, select, textarea, button')].filter((field) => {
          const text = field.labels?.[0]?.textContent ?? field.getAttribute('aria-label') ?? field.textContent;
          return !text.trim();
        }).map((field) => field.outerHTML);
    """
    assert page.run(nameless) == []
    described = "return [...document.querySelectorAll('.plot')].every((plot) => plot.getAttribute('aria-label')?.length > 10)"
    page.wait(lambda: page.run(described), "descriptions")
    assert page.run("return document.documentElement.scrollWidth <= innerWidth")
    page.browser.set_window_size(1400, 1000)




# A gearbox, in a browser.


@pytest.fixture
def train() -> Iterator[mt.Explorer]:
    """The page of a gearbox."""
    text = mt.gearbox_template().replace("sampling_rate_hz = 100000.0", "sampling_rate_hz = 20000.0")
    with mt.explore(mt.Scenario.from_toml(text), open_browser=False) as explorer:
        yield explorer


@pytest.fixture
def train_page(browser: Chrome, train: mt.Explorer) -> Iterator[Page]:
    """The page of a gearbox in the browser, at whose end the console holds no error."""
    assert train.url is not None
    page = Page(browser, train.url)
    yield page
    errors = page.errors()
    browser.get("about:blank")
    assert errors == []


def test_a_wheel_and_a_mesh_are_chosen_in_the_train(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    named = "return [...document.querySelectorAll('#front g[role=button]')].map((group) => group.getAttribute('aria-label'))"
    assert set(page.run(named)) == {
        "wheel z1, 32 teeth", "wheel z2, 96 teeth", "wheel z3, 48 teeth", "wheel z4, 80 teeth", "mesh z1-z2, 960 Hz", "mesh z3-z4, 480 Hz"
    }
    click = "document.querySelector(`#front [aria-label^='${arguments[0]}']`).dispatchEvent(new MouseEvent('click', { bubbles: true }))"
    page.settled(lambda: page.run(click, "wheel z4"), "a wheel")
    assert page.run("return document.getElementById('wheel-title').textContent") == "Over a revolution of z4, 80 teeth"
    assert page.run("return document.querySelector('#above .chosen').getAttribute('aria-label')") == "wheel z4 from above, 80 teeth"
    page.settled(lambda: page.run(click, "mesh z3"), "a mesh")
    assert page.run("return document.getElementById('mesh-title').textContent") == "Force of mesh z3-z4"
    key = "document.querySelector('#above [aria-label^=\"wheel z1\"]').dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }))"
    page.settled(lambda: page.run(key), "a wheel by the keyboard")
    assert page.run("return document.getElementById('wheel').value") == "z1"
    page.wait(lambda: "z3-z4" in page.described("force"), "the words of the mesh's force")
    assert train.scenario.channels[0] == "input_0_vertical_g"


def test_any_number_of_a_gearbox_is_changed(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    assert page.enter("operation.input_speed_hz", "33") == ""
    assert page.enter("wheel[2].face_width_mm", "15") == ""
    assert page.enter("bearing[0].damping_ratio", "0.03") == ""
    assert page.enter("housing.mass_kg", "25") == ""
    text = train.scenario.to_toml()
    assert all(words in text for words in ("input_speed_hz = 33", "face_width_mm = 15", "damping_ratio = 0.03", "mass_kg = 25"))
    assert page.run("return document.querySelectorAll('#controls .control').length") > 120
    assert page.enter("mesh[1].module_mm", "-1") == "mesh[1].module_mm = -1 (the 2nd mesh): must be more than 0 mm"
    assert page.run("return document.getElementById('key-mesh[1].module_mm').getAttribute('aria-invalid')") == "true"
    assert train.scenario.to_toml() == text
    assert page.enter("mesh[1].module_mm", "1.5875") == ""
    assert not page.run("return document.querySelector('#controls [aria-invalid]')")


def test_every_line_of_a_gearboxs_spectrum_has_a_name(train_page: Page) -> None:
    page = train_page
    rows = page.run("return [...document.querySelectorAll('#lines tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent))")
    assert len(rows) == 24
    speeds = {"input": 30.0, "middle": 10.0, "output": 6.0}
    meshes = {"z1-z2": 960.0, "z3-z4": 480.0}
    for name, frequency, _ in rows:
        for one in name.split(", "):
            if not one[0].isdigit():
                continue
            # What the words say is the line's frequency.
            signs = one.replace("−", "+ -").split(" + ")
            said = 0.0
            for term in signs:
                count, what = term.replace("- ", "-").split(" × ")
                kind, of = what.strip().split(" ")
                said += float(count) * (meshes if kind == "mesh" else speeds)[of]
            assert abs(said - float(frequency)) <= 1.0, (name, frequency)
    assert any("mesh z1-z2" in name for name, *_ in rows)
    strengths = [float(amplitude) for *_, amplitude in rows]
    assert strengths == sorted(strengths, reverse=True)


def test_a_gearbox_is_held_exported_and_linked(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    rows = "return [...document.querySelectorAll('#indicators tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent))"
    before = {name: value for name, value in page.run(rows)}
    assert float(before["difference rms, g"]) > 0
    page.run("document.getElementById('hold').click()")
    assert page.enter("operation.input_speed_hz", "33") == ""
    after = {name: (value, held) for name, value, held in page.run(rows)}
    assert {name: held for name, (_, held) in after.items()} == before
    assert after["difference rms, g"][0] != before["difference rms, g"]
    page.run("document.getElementById('link').click()")
    page.wait(lambda: page.run("return location.hash.length > 100"), "the link")
    linked = train.scenario
    assert page.enter("operation.input_speed_hz", "20") == ""
    Page(page.browser, page.run("return location.href"))
    assert train.scenario == linked
    text = ask(train, "export/python", {"page": "gearbox", "number": 1, "toml": linked.to_toml()}).decode()
    made: dict[str, Any] = {}
    exec(text.split("\nsimulation")[0], made)
    assert made["scenario"] == linked
    assert b"<svg" in ask(train, "export/svg", {"page": "gearbox", "number": 2, "toml": linked.to_toml()})[:400]


def test_a_gearbox_begins_with_a_rig(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    choose = "const box = document.getElementById('preset'); box.value = 'tecnalia'; box.dispatchEvent(new Event('change'))"
    assert page.settled(lambda: page.run(choose), "a rig") == ""
    assert train.scenario == mt.Scenario.from_toml(mt.gearbox_template("tecnalia"))


def test_damage_is_added_to_a_wheel_and_a_file_opened(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    start = train.scenario
    page.settled(lambda: page.run("const w = document.getElementById('wheel'); w.value = 'z3'; w.dispatchEvent(new Event('change'))"), "z3")
    add = "const add = document.getElementById('add-fault'); add.previousSibling.value = 'tooth-breakage'; add.click()"
    assert page.settled(lambda: page.run(add), "damage") == ""
    assert 'wheel = "z3"' in train.scenario.to_toml()
    # The tooth has a colour, and the wheel's outline where no teeth are seen.
    teeth = "return [...document.querySelectorAll('#front .tooth')].map((tooth) => tooth.closest('.wheel').getAttribute('aria-label'))"
    assert page.run(teeth) == ["wheel z3, 48 teeth, damaged"]
    assert page.run("return document.querySelector('#above .damaged').getAttribute('aria-label')") == "wheel z3 from above, 48 teeth"
    assert page.enter("fault[0].severity", "0.9") == ""
    assert "severity = 0.9" in train.scenario.to_toml()
    page.settled(lambda: page.drop("start.toml", start.to_toml().encode()), "the file")
    assert train.scenario == start
    page.drop("pair.toml", fast().to_toml().encode())
    page.wait(lambda: "pair.toml" in changes_words(page.browser), "the refusal of a pair")


def test_a_recording_of_a_gearbox_is_dropped(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    open_recording(page, "box.parquet", signals_of(train, train.scenario))
    assert "by scenario" in text_of(page, "recording") and text_of(page, "diagnose") == "Diagnose"
    head = "return [...document.querySelectorAll('#indicators thead th')].map((cell) => cell.textContent)"
    page.wait(lambda: page.run(head) == ["indicator", "now", "recording"], "the recording's indicators")
    for plot in ("waveform", "spectrum", "average"):
        page.wait(lambda plot=plot: "recording" in page.described(plot), plot)  # type: ignore[misc]
    page.run("[...document.querySelectorAll('#recording button')].at(-1).click()")
    page.wait(lambda: page.run(head) == ["indicator", "now"], "the removal")
    assert text_of(page, "diagnosis") == ""


def test_a_foreign_recording_of_a_gearbox_and_a_bearing_is_dropped(train_page: Page, train: mt.Explorer) -> None:
    page = train_page
    assert page.enter("bearing[0].kind", "ball") == ""
    times = np.arange(16_000) / 8000
    samples = np.sin(2 * np.pi * 960 * times) + 0.1 * np.random.default_rng(1).normal(size=len(times))
    rows = "".join(f"{t:.6f},{x:.5f},{int(t * 60 % 1 < 0.1)}\n" for t, x in zip(times, samples))
    page.drop("box.csv", f"t_s,housing [g],pulses\n{rows}".encode())
    page.wait(lambda: "box.csv: is this right?" in text_of(page, "desk"), "the desk")
    assert (field(page, "channel"), field(page, "tachometer"), field(page, "pulses_per_revolution")) == ("housing", "pulses", "2")
    page.run("document.getElementById('desk-use').click()")
    page.wait(lambda: "Of the recording" in text_of(page, "bearing-verdict"), "the verdict about the bearing")
    for plot in ("waveform", "spectrum", "average"):
        page.wait(lambda plot=plot: "recording" in page.described(plot), plot)  # type: ignore[misc]


def test_a_bearing_becomes_a_rolling_one_with_a_defect(train_page: Page, train: mt.Explorer) -> None:
    page = train_page

    def bearing() -> str:
        """The section of the first bearing."""
        return train.scenario.to_toml().split("[[bearing]]")[1]

    hidden = "return document.getElementById('bearing-card').hidden"
    click = "document.querySelector(`#controls [aria-label^='${arguments[0]}']`).click()"
    assert page.run(hidden)
    assert page.enter("bearing[0].stiffness_n_per_m", "2e8") == ""
    assert page.enter("bearing[0].kind", "ball") == ""
    assert not page.run(hidden)
    # The stiffness of a rolling bearing follows from its elements.
    assert 'kind = "ball"' in bearing() and 'name = "6203"' in bearing() and "stiffness_n_per_m = 2" not in bearing()
    assert page.enter("bearing[0].name", "ER-10K") == ""
    assert page.settled(lambda: page.run(click, "Add a defect"), "a defect") == ""
    assert 'race = "outer"' in bearing() and "width_mm = 1" in bearing()
    assert page.enter("bearing[0].defect[0].width_mm", "9").endswith("must be at most 7.9375 mm, the diameter of an element")
    assert page.run("return document.getElementById('key-bearing[0].defect[0].width_mm').getAttribute('aria-invalid')") == "true"
    assert page.enter("bearing[0].defect[0].severity", "0.2") == ""
    assert "severity = 0.2" in bearing() and "width_mm = 1" not in bearing()
    assert page.enter("bearing[0].defect[0].race", "inner") == ""
    lines = page.run("return [...document.querySelectorAll('#defect-lines tbody th')].map((cell) => cell.textContent)")
    assert {"FTF", "BPFO", "2 BPFO", "BPFI", "2 BSF"} <= set(lines)
    assert page.run("return document.querySelectorAll('#above .rolling.damaged').length") == 1
    assert page.settled(lambda: page.run(click, "Remove defect 1"), "no defect") == ""
    assert "defect" not in bearing()
    # Rollers have the sizes of the balls before them, since none is known by name.
    assert page.enter("bearing[0].kind", "roller") == ""
    assert "elements = 8" in bearing() and "element_mm = 7.9375" in bearing() and "name" not in bearing()
    assert page.enter("bearing[0].kind", "linear") == ""
    assert page.run(hidden)
    assert "element" not in bearing()


def test_a_planetary_set_turns_and_is_looked_at_wheel_by_wheel(browser: Chrome) -> None:
    """Planets turn about the axis, teeth are seen by averages of windows, and lines are named after set and carrier."""
    text = mt.gearbox_template("planetary-lab").replace("sampling_rate_hz = 100_000.0", "sampling_rate_hz = 50000.0")
    with mt.explore(mt.Scenario.from_toml(text), open_browser=False) as explorer:
        assert explorer.url is not None
        page = Page(browser, explorer.url)
        carried = "return document.querySelector('#front [aria-label^=\"wheel p.planet2\"]').getAttribute('transform')"
        start = page.run(carried)
        page.run("document.getElementById('turn').click()")
        page.wait(lambda: page.run(carried) != start, "the planets to turn")
        page.run("document.getElementById('turn').click()")
        assert page.run("return document.getElementById('turn').getAttribute('aria-pressed')") == "false"
        look = "const box = document.getElementById('wheel'); box.value = arguments[0]; box.dispatchEvent(new Event('change'))"
        indicators = "return document.querySelectorAll('#indicators tbody tr').length"
        for wheel in ("p.planet2", "p.sun", "p.ring"):
            page.settled(lambda wheel=wheel: page.run(look, wheel), wheel)  # type: ignore[misc]
            page.wait(lambda: page.run(indicators) > 5, f"the indicators of {wheel}")
        lines = page.run("return [...document.querySelectorAll('#lines tbody th')].map((cell) => cell.textContent)")
        assert any("mesh p" in line and "shaft output" in line for line in lines), lines
        assert not any("p.planet2-p.ring" in line for line in lines)
        signal = mt.simulate(explorer.scenario)["ring_p_90_radial_g"][::5]
        rows = "".join(f"{number / 1e4:.4f},{value:.4g}\n" for number, value in enumerate(signal))
        open_recording(page, "set.csv", f"time_s,vibration_g\n{rows}".encode())
        head = "return [...document.querySelectorAll('#indicators thead th')].map((cell) => cell.textContent)"
        page.wait(lambda: page.run(head) == ["indicator", "now", "recording"], "the recording's indicators")
        assert page.enter("solver.duration_s", "1.0") == ""
        page.settled(lambda: page.run(look, "p.planet1"), "a planet of a short signal")
        page.wait(lambda: "revolutions" in text_of(page, "wheel-note"), "the reason why there is no average")
        assert page.enter("planetary[0].pin.stiffness_n_per_m", "2e8") == ""
        assert page.errors() == []
        browser.get("about:blank")
