"""How fast the page of `meshtone explore` answers, in a browser without a window: the table of the book.

    python python/benchmarks/explore_latency.py target/release/meshtone

Times are from the release of a slider to the frame after the new picture, as the browser's own clock has them; processor time is what
the system counts for all processes, while the wheels stand still, and of the browser alone while they turn and nothing else happens. It
needs Linux, selenium, chromium and chromedriver.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import time
import urllib.request
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

SCENARIOS = ("healthy", "tooth_breakage")
RELEASES = 200
RELEASES_AT_REST = 40
TURNING_S = 4.0
MOVING_S = 5.0
CHANGES = 10_000
PATIENCE_S = 60
KEY = "operation.pinion_speed_hz"
PAUSE_S = 0.3
"""Between releases: what takes longer is answered too."""

RELEASE = """
    const [key, value, done] = arguments;
    const slider = document.querySelector(`[data-key="${key}"] input[type=range]`);
    const start = performance.now();
    const drawn = ({ detail }) => {
      if (detail !== 'full') return;
      document.removeEventListener('drawn', drawn);
      requestAnimationFrame(() => setTimeout(() => done(performance.now() - start)));
    };
    document.addEventListener('drawn', drawn);
    slider.value = Number(slider.min) + (Number(slider.max) - Number(slider.min)) * value;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
"""
MOVE = """
    const [key, duration, done] = arguments;
    const slider = document.querySelector(`[data-key="${key}"] input[type=range]`);
    const [start, before] = [performance.now(), meshtone.coarse];
    const step = () => {
      const passed = performance.now() - start;
      if (passed > duration) return done((1000 * (meshtone.coarse - before)) / passed);
      slider.value = Number(slider.min) + (Number(slider.max) - Number(slider.min)) * (0.4 + 0.2 * Math.sin(passed / 300));
      slider.dispatchEvent(new Event('input', { bubbles: true }));
      requestAnimationFrame(step);
    };
    step();
"""


def open_page(url: str) -> webdriver.Chrome:
    """The page in a browser, once it has drawn."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or sys.exit("chromium is not installed")
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1400,1000"):
        options.add_argument(argument)
    browser = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    browser.set_script_timeout(PATIENCE_S)
    browser.get(url)
    until = time.monotonic() + PATIENCE_S
    while not browser.execute_script("return window.meshtone?.drawn"):
        if time.monotonic() > until:
            sys.exit("the page has drawn nothing")
        time.sleep(0.05)
    return browser


def processor_s(pid: int) -> float:
    """(s) Processor time of a process and of all that it started."""
    children: dict[int, list[int]] = {}
    used_s = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            # What follows the name, which may hold anything: state, parent, …
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        children.setdefault(int(fields[1]), []).append(int(stat.parent.name))
        used_s[int(stat.parent.name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    family = [pid]
    for member in family:
        family += children.get(member, [])
    return sum(used_s.get(member, 0.0) for member in family)


def processor_ms_of_release(browser: webdriver.Chrome, program: int) -> tuple[float, float, float]:
    """(ms) Processor time of a release: of the program and of the browser; (ms/s) of the browser while the wheels turn."""
    pid = browser.service.process.pid
    start_s = processor_s(pid)
    time.sleep(TURNING_S)
    turning = 1000 * (processor_s(pid) - start_s) / TURNING_S
    browser.execute_script("document.getElementById('play').click()")
    before_s = [processor_s(program), processor_s(pid)]
    for release in range(RELEASES_AT_REST):
        browser.execute_async_script(RELEASE, KEY, place(release))
        time.sleep(PAUSE_S)
    after_s = [processor_s(program), processor_s(pid)]
    of_program, of_browser = (1000 * (after - before) / RELEASES_AT_REST for before, after in zip(before_s, after_s))
    return of_program, of_browser, turning


def place(release: int) -> float:
    """Where the slider is released, from 0 to 1."""
    return 0.3 + 0.3 * (release * 0.618 % 1)


def resident_mib(pid: int) -> float:
    """(MiB) Memory of a process."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024


def memory_over_changes(url: str, pid: int) -> list[tuple[int, float]]:
    """(MiB) The program's memory after numbers of changes, each answered coarsely."""
    start = json.loads(urllib.request.urlopen(url + "start").read())
    scenario: dict[str, Any] = start["scenario"]
    seen = []
    for change in range(1, CHANGES + 1):
        scenario["operation"]["pinion_speed_hz"] = 30.0 + change % 200 / 10
        body = json.dumps({"page": "memory", "number": change, "detail": "coarse", "scenario": scenario}).encode()
        origin = "/".join(url.split("/")[:3])
        urllib.request.urlopen(urllib.request.Request(url + "answer", data=body, headers={"Origin": origin})).read()
        if change in (100, 1000, CHANGES):
            seen.append((change, resident_mib(pid)))
    return seen


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program meshtone")
    parser.add_argument("--no-memory", action="store_true", help="leave the changes out that take minutes")
    arguments = parser.parse_args()
    examples = Path(__file__).parents[2] / "examples"
    print("| scenario | release to picture, median (ms) | least | 95th percentile | pictures a second while it moves | "
          "processor time of a release: program (ms) | browser (ms) | of the turning wheels (ms/s) |")
    print("|---|---|---|---|---|---|---|---|")
    for name in SCENARIOS:
        command = [arguments.program, "explore", str(examples / f"{name}.toml"), "--no-open"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
            assert program.stdout is not None
            url = program.stdout.readline().strip()
            browser = open_page(url)
            # The first few warm the browser up.
            times = []
            for release in range(RELEASES + 5):
                times.append(browser.execute_async_script(RELEASE, KEY, place(release)))
                time.sleep(PAUSE_S)
            rate = browser.execute_async_script(MOVE, KEY, 1000 * MOVING_S)
            of_program, of_browser, turning = processor_ms_of_release(browser, program.pid)
            times = sorted(times[5:])
            p95 = times[int(0.95 * len(times))]
            shown = [statistics.median(times), times[0], p95, rate, of_program, of_browser, turning]
            print(f"| `{name}` | " + " | ".join(f"{number:.0f}" for number in shown) + " |", flush=True)
            browser.quit()
            if name == SCENARIOS[0] and not arguments.no_memory:
                memory = memory_over_changes(url, program.pid)
            program.terminate()
    if not arguments.no_memory:
        print("memory of the program: " + ", ".join(f"{mib:.0f} MiB after {changes} changes" for changes, mib in memory))


if __name__ == "__main__":
    main()
