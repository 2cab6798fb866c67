"""What the program does with wrong input, when it is killed, when two of it meet, and when what it wrote has changed on disk.

Every trial runs the program itself and looks at its exit code, its words, its time, its memory and the folder that it leaves:

* scenarios and plans of which one thing is spoilt: carried out, or refused with a word on what is wrong and nothing written;
* recordings of every format with bytes changed, cut off or repeated: likewise;
* the program ended at a moment drawn by chance, by SIGKILL, SIGTERM or SIGINT: the same command again gives every byte that it
  gives undisturbed, and nothing else stays behind; the latter two leave nothing behind themselves;
* two programs that write to one folder at once: all is as one of them makes it alone, or one of them ends with an error;
* data sets of which a file is changed, cut, lost, swapped or added: `dataset verify` says so, and the plan run again mends it.

Also, from Python, scenarios drawn at random that are valid: they simulate, all numbers are finite, and the mean mesh force is that of
the torque.

Prints the table of the book's chapter Validation, the defects first; takes some twenty minutes on two processors:

    cargo build --release
    python python/validation/nothing_unseen.py target/release/meshtone

A share of it, with other draws: `--share 0.1 --seed 7`. One part: `--only recordings`.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from random import Random
from typing import Literal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io

import meshtone as mt

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

LONGEST_S = 60.0
"""(s) A trial that takes longer is ended: a plan may have become one of very many records."""
LARGEST_MB = 1500.0
"""(MB) More memory is a defect: no trial asks for much."""
MISSING = "missing"
"""What a data set says that lacks the records that cannot be simulated; its exit code is 2."""


@dataclass
class Ended:
    """How a program ended."""

    code: int
    words: str
    is_at_work: bool
    """Whether it had not come to its end after the longest time."""
    memory_mb: float


@dataclass
class TriedGroup:
    """A row of the table: what was tried, how often, and what happened."""

    tried: str
    outcomes: Counter[str] = field(default_factory=Counter)
    defects: list[str] = field(default_factory=list)

    def add(self, outcome: str, defect: str | None) -> None:
        self.outcomes[outcome] += 1
        if defect is not None:
            self.defects.append(defect)


def run(command: list[str], folder: Path) -> Ended:
    """Runs a program to its end."""
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=words, stderr=words)
        expiry = time.monotonic() + LONGEST_S
        is_at_work = False
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > expiry:
                is_at_work = True
                process.kill()
                _, status, usage = os.wait4(process.pid, 0)
                break
            time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        text = words.read().decode(errors="replace")
    return Ended(process.returncode, text, is_at_work, usage.ru_maxrss / 1024)


def contents(folder: Path) -> dict[str, str]:
    """A hash of every file below a folder, by its name."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def judged(ended: Ended, left: set[str], place: str) -> tuple[str, str | None]:
    """What happened, and what is wrong with that.

    Parameters
    ----------
    ended
        How the program ended.
    left
        Files that it left and that were not there before.
    place
        What an error must name: a regular expression.
    """
    if ended.memory_mb > LARGEST_MB:
        return "took much memory", f"took {ended.memory_mb:.0f} MB: {ended.words[-300:]}"
    if ended.is_at_work:
        return f"at work after {LONGEST_S:.0f} s", None
    refused = ended.code in (1, 2) and "error" in ended.words.lower()
    if refused and MISSING in ended.words and any(name.endswith("manifest.json") for name in left):
        return "made but for records that are named", None
    outcome = "carried out" if ended.code == 0 else "refused" if refused else f"ended with {ended.code}"
    if ended.code == 0 and "warning" in ended.words.lower():
        outcome = "carried out with a warning"
    temporary = [name for name in left if ".tmp" in name or Path(name).name.startswith(".")]
    if not (ended.code == 0 or refused) or "panicked" in ended.words:
        return outcome, f"ended with {ended.code}: {ended.words[-300:]}"
    if refused and left:
        return outcome, f"refused, and left {sorted(left)[:4]}"
    if temporary:
        return outcome, f"left {temporary[:4]}"
    if refused and not re.search(place, ended.words):
        return outcome, f"names no place: {ended.words[-300:]}"
    return outcome, None


def all_of(row: TriedGroup, trials: Iterator[Callable[[], tuple[str, str | None]]]) -> TriedGroup:
    """Makes trials, as many at a time as there are processors."""
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        # Some at a time: every trial holds what it will write.
        while some := list(itertools.islice(trials, 64)):
            for outcome, defect in pool.map(lambda trial: trial(), some):
                row.add(outcome, defect)
                line = f"\r{row.tried}: {row.outcomes.total()}, {len(row.defects)} defects "
                print(line, end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return row


# Scenarios and plans

NUMBERS = ["0", "-1", "1e-12", "1e9", "1e300", "nan", "inf", "-inf", "2.5", "99999999999999999999"]
VALUES = [*NUMBERS, '"x"', '""', "[]", "[1, 2]", "true", "{}"]
"""What takes the place of a value."""


def spoilt_text(text: str, draw: Random) -> str:
    """A text of which one thing is spoilt, once in a while two."""
    lines = text.splitlines()
    for _ in range(draw.choice([1, 1, 1, 2])):
        pairs = [i for i, line in enumerate(lines) if re.match(r"^#?[a-z_.]+\s*=", line)]
        headers = [i for i, line in enumerate(lines) if line.startswith("[")]
        i = draw.choice(pairs)
        key, value = (part.strip() for part in lines[i].lstrip("#").split("=", 1))
        match draw.choice(["value"] * 6 + ["number"] * 3 + ["key", "line", "twice", "header", "bytes", "cut"]):
            case "value":
                lines[i] = f"{key} = {draw.choice(VALUES)}"
            case "number":
                factor = draw.choice([-1.0, 0.01, 0.1, 0.5, 2.0, 10.0, 1000.0])
                lines[i] = f"{key} = " + re.sub(r"\d+(\.\d+)?", lambda found: f"{float(found[0]) * factor:g}", value)
            case "key":
                at = draw.randrange(len(key))
                lines[i] = f"{key[:at]}{key[at + 1 :]} = {value}"
            case "line":
                del lines[i]
            case "twice":
                lines.insert(draw.choice(pairs), f"{key} = {value}")
            case "header" if headers:
                lines[draw.choice(headers)] = draw.choice(["", "[gear]", "[[fault]]", "[solver]", "[fault", "[[sensor]]"])
            case "bytes":
                at = draw.randrange(max(1, len(lines[i])))
                lines[i] = lines[i][:at] + draw.choice("\0\t\"'[]{}=#é\u202e") + lines[i][at + 1 :]
            case _:
                lines = "\n".join(lines)[: draw.randrange(len("\n".join(lines)))].splitlines() or [""]
        if not any(re.match(r"^#?[a-z_.]+\s*=", line) for line in lines):
            break
    return "\n".join(lines) + "\n"


def written_trial(command: list[str], text: str, name: str, companions: list[Path]) -> Callable[[], tuple[str, str | None]]:
    """A trial of a file of text in a folder of its own."""

    def trial() -> tuple[str, str | None]:
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            for companion in companions:
                shutil.copy(companion, folder)
            (folder / name).write_text(text, encoding="utf-8")
            before = set(contents(folder))
            ended = run(command, folder)
            outcome, defect = judged(ended, set(contents(folder)) - before if ended.code else leftovers(folder), r"\.toml|\.csv|--")
            if defect is not None:
                defect += f"\n{text}"
            return outcome, defect

    return trial


def leftovers(folder: Path) -> set[str]:
    """Temporary files in a folder."""
    return {name for name in contents(folder) if Path(name).name.startswith(".") or ".tmp" in name}


KINDS = [
    "healthy",
    "missing-tooth",
    "tooth-breakage",
    "root-crack",
    "partial-face",
    "through-face",
    "pits",
    "tooth-destruction",
    "wear",
]


def scenarios(program: str, number: int, seed: int) -> TriedGroup:
    """Spoilt scenarios."""
    texts = [path.read_text() for path in sorted(EXAMPLES.glob("*.toml"))]
    texts += [mt.template(kind) for kind in KINDS]
    draw = Random(f"scenarios {seed}")
    companions = [EXAMPLES / "sensors_housing.csv"]

    def trials() -> Iterator[Callable[[], tuple[str, str | None]]]:
        for _ in range(number):
            text = spoilt_text(draw.choice(texts), draw)
            yield written_trial([program, "simulate", "s.toml", "-o", "out", "--no-panel", "-q"], text, "s.toml", companions)

    return all_of(TriedGroup("scenarios with one thing spoilt"), trials())


SMALL_PLAN = """
records = 12
units = 2
seed = 5
scenario = "machine.toml"

[keep]
duration_s = 0.2

[[class]]
label = "healthy"

[[class]]
label = "tooth-breakage"
fault = { kind = "tooth-breakage", chip_height_mm = 5.0, chip_width_mm = 12.0, tip_loss_mm = 2.0 }
severity = { measure = "fault.tip_loss_mm", breaks = [1.0, 2.0, 3.0] }

[[class.vary]]
key = "fault.tip_loss_mm"
uniform = [0.0, 3.0]

[[vary]]
key = "operation.pinion_speed_hz"
uniform = [20.0, 50.0]

[[vary]]
keys = ["gears.pinion_teeth", "gears.gear_teeth"]
choice = [[17, 38], [18, 36]]

[split]
train = 0.5
test = 0.5
"""


def plans(program: str, number: int, seed: int) -> TriedGroup:
    """Spoilt plans."""
    draw = Random(f"plans {seed}")
    companions = [EXAMPLES / "datasets" / "machine.toml"]

    def trials() -> Iterator[Callable[[], tuple[str, str | None]]]:
        for _ in range(number):
            text = spoilt_text(SMALL_PLAN, draw)
            yield written_trial([program, "dataset", "plan.toml", "-o", "out", "-q"], text, "plan.toml", companions)

    return all_of(TriedGroup("plans with one thing spoilt"), trials())


# Recordings


def recordings_of_each_format(program: str, folder: Path) -> list[Path]:
    """The same recording in every format that is read: 0.8 s of a bearing's acceleration and a tachometer, 20 kS/s."""
    draws = np.random.default_rng(3)
    time_s = np.arange(16_000) / 20_000
    mesh = 2 * np.pi * 380 * time_s
    bearing_g = np.sin(mesh) + 0.4 * np.sin(2 * mesh) + 0.2 * draws.standard_normal(time_s.size)
    tacho_v = (np.sin(2 * np.pi * 10 * time_s) > 0.9).astype(float)
    columns = {"time_s": time_s, "bearing": bearing_g, "tacho": tacho_v}
    table = np.column_stack(list(columns.values()))
    lines = [",".join(columns)] + [",".join(f"{value:.7g}" for value in row) for row in table]
    (folder / "run.csv").write_text("\n".join(lines) + "\n")
    (folder / "german.csv").write_text("\n".join(line.replace(",", ";").replace(".", ",") for line in lines) + "\n")
    pq.write_table(pa.table(columns), folder / "run.parquet")
    pq.write_table(pa.table(columns), folder / "snappy.parquet", compression="snappy", row_group_size=3000)
    np.save(folder / "run.npy", table[:, 1:])
    np.savez(folder / "run.npz", allow_pickle=False, **columns)
    np.savez_compressed(folder / "small.npz", allow_pickle=False, **columns)
    scipy.io.savemat(folder / "run.mat", columns)
    scipy.io.savemat(folder / "small.mat", {"run": {"sensors": columns}}, do_compression=True)
    scipy.io.wavfile.write(folder / "run.wav", 20_000, (table[:, 1:] * 3000).astype(np.int16))
    scipy.io.wavfile.write(folder / "float.wav", 20_000, table[:, 1:].astype(np.float32))
    return sorted(folder.iterdir())


def spoilt_bytes(whole: bytes, draw: Random, others: list[bytes]) -> bytes:
    """Bytes of which some are changed."""
    data = bytearray(whole)
    # Half of all changes are made where formats say what follows.
    edge = min(len(data), 600)
    ranges = [range(edge), range(len(data) - edge, len(data)), range(len(data)), range(len(data))]
    for _ in range(draw.choice([1, 1, 2, 5, 50])):
        at = draw.choice(draw.choice(ranges))
        match draw.choice(["bit", "bit", "byte", "number", "cut", "hole", "twice", "splice", "text"]):
            case "bit":
                data[at] ^= 1 << draw.randrange(8)
            case "byte":
                data[at] = draw.choice([0, 255, 0x7F, 0x80, 10, 13, 34, 44])
            case "number":
                data[at : at + 4] = draw.choice([b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\0", b"\0\0\0\x80"])
            case "cut":
                del data[at:]
            case "hole":
                del data[at : at + draw.choice([1, 2, 8, 64, 4096])]
            case "twice":
                data[at:at] = data[at : at + draw.choice([1, 16, 512])]
            case "splice":
                other = draw.choice(others)
                data[at:] = other[min(at, len(other)) :]
            case _:
                data[at : at + 3] = draw.choice([b"nan", b"inf", b"1e9", b",,,", b"\n\n\n", b'"a,', b"\xff\xfe\0", b"0x1"])
        if len(data) < 2:
            break
        edge = min(len(data), 600)
        ranges = [range(edge), range(len(data) - edge, len(data)), range(len(data)), range(len(data))]
    return bytes(data)


def recordings(program: str, number: int, seed: int) -> TriedGroup:
    """Spoilt recordings."""
    draw = Random(f"recordings {seed}")
    with tempfile.TemporaryDirectory() as place:
        files = recordings_of_each_format(program, Path(place))
        whole = {path.name: path.read_bytes() for path in files}
    channel = {"npy": "1", "wav": "1"}
    variable = {"small.mat": ["--variable", "run.sensors"]}

    def command(name: str) -> list[str]:
        own = channel.get(name.split(".")[1], "bearing")
        rate = [] if name.endswith((".wav", ".csv", ".parquet", ".npz", ".mat")) else ["--sampling-rate-hz", "20000"]
        stated = ["--channel", own, "--teeth", "38", "--shaft-hz", "10", *rate, *variable.get(name, [])]
        return [program, "indicators", name, *stated, "--no-figure", "-q", "-o", "out"]

    def trial_of(name: str, data: bytes) -> Callable[[], tuple[str, str | None]]:
        def trial() -> tuple[str, str | None]:
            with tempfile.TemporaryDirectory() as place:
                folder = Path(place)
                (folder / name).write_bytes(data)
                ended = run(command(name), folder)
                left = set(contents(folder)) - {name} if ended.code else leftovers(folder)
                outcome, defect = judged(ended, left, re.escape(name))
                if defect is not None:
                    kept = Path(tempfile.gettempdir()) / f"spoilt_{hashlib.sha256(data).hexdigest()[:8]}_{name}"
                    kept.write_bytes(data)
                    defect += f"\n{kept}"
                return outcome, defect

        return trial

    for name, data in whole.items():
        outcome, defect = trial_of(name, data)()
        if not outcome.startswith("carried out"):
            raise SystemExit(f"{name}: the recording itself is {outcome}: {defect}")

    def trials() -> Iterator[Callable[[], tuple[str, str | None]]]:
        for _ in range(number):
            name = draw.choice(sorted(whole))
            yield trial_of(name, spoilt_bytes(whole[name], draw, list(whole.values())))

    return all_of(TriedGroup("recordings with bytes changed, of eleven files in six formats"), trials())


# Ends


def undisturbed(command: list[str], inputs: dict[str, bytes]) -> tuple[dict[str, str], float]:
    """What a command makes, and how long it takes (s)."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name, data in inputs.items():
            (folder / name).write_bytes(data)
        started = time.monotonic()
        ended = run(command, folder)
        if ended.code != 0:
            raise SystemExit(f"{command}: {ended.words}")
        return comparable(folder), time.monotonic() - started


def comparable(folder: Path) -> dict[str, str]:
    """What must be equal in two runs: all but summaries, which say how long a run took."""
    return {name: value for name, value in contents(folder).items() if not name.endswith("summary.json")}


def commands_to_end(program: str) -> list[tuple[list[str], dict[str, bytes]]]:
    """Commands and what they read."""
    machine = (EXAMPLES / "datasets" / "machine.toml").read_bytes()
    plan = SMALL_PLAN.replace("records = 12", "records = 48").replace("[keep]", "[keep]\nrecords_per_shard = 8").encode()
    recording_folder = tempfile.TemporaryDirectory()
    recordings_of_each_format(program, Path(recording_folder.name))
    csv = (Path(recording_folder.name) / "run.csv").read_bytes()
    recording_folder.cleanup()
    healthy = (EXAMPLES / "healthy.toml").read_bytes()
    stated = ["--channel", "bearing", "--teeth", "38", "--shaft-hz", "10"]
    return [
        ([program, "dataset", "plan.toml", "-o", "out", "-q"], {"plan.toml": plan, "machine.toml": machine}),
        ([program, "simulate", "healthy.toml", "-o", "out", "-q"], {"healthy.toml": healthy}),
        ([program, "indicators", "run.csv", *stated, "-o", "out", "-q"], {"run.csv": csv}),
        ([program, "wheels", "healthy.toml", "-o", "wheels.npz"], {"healthy.toml": healthy}),
    ]


def ends(program: str, number: int, seed: int) -> TriedGroup:
    """Programs that are ended at some moment."""
    draw = Random(f"ends {seed}")
    made = [(command, inputs, *undisturbed(command, inputs)) for command, inputs in commands_to_end(program)]

    def trial_of(which: int, share: float, by: signal.Signals) -> Callable[[], tuple[str, str | None]]:
        command, inputs, whole, duration_s = made[which]

        def trial() -> tuple[str, str | None]:
            with tempfile.TemporaryDirectory() as place:
                folder = Path(place)
                for name, data in inputs.items():
                    (folder / name).write_bytes(data)
                process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(share * duration_s)
                process.send_signal(by)
                code = process.wait(LONGEST_S)
                finished = code == 0
                outcome = "finished before" if finished else f"ended by {by.name}, made whole by the next run"
                if by is not signal.SIGKILL and leftovers(folder):
                    return outcome, f"{by.name} left {leftovers(folder)}: {command[1]}"
                broken = {name for name, value in comparable(folder).items() if name in whole and value != whole[name]}
                unfinished = {name for name in broken if "manifest" not in name and "card" not in name.lower()}
                if unfinished - leftovers(folder):
                    return outcome, f"{by.name} left {sorted(unfinished)} other than whole: {command[1]}"
                again = run(command, folder)
                if again.code != 0:
                    return outcome, f"after {by.name}: {again.words[-300:]}"
                if comparable(folder) != whole:
                    different = set(comparable(folder).items()) ^ set(whole.items())
                    return outcome, f"after {by.name} and again: {sorted({name for name, _ in different})}: {command[1]}"
                return outcome, None

        return trial

    def trials() -> Iterator[Callable[[], tuple[str, str | None]]]:
        for _ in range(number):
            which = draw.choice([0, 0, 0, 1, 2, 3])
            yield trial_of(which, draw.uniform(0, 1.0), draw.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))

    return all_of(TriedGroup("data sets, simulations, indicators and wheels ended at any moment"), trials())


def together(program: str, number: int, seed: int) -> TriedGroup:
    """Two programs that write to one folder at once."""
    made = [(command, inputs, *undisturbed(command, inputs)) for command, inputs in commands_to_end(program)]

    def trial(number: int) -> tuple[str, str | None]:
        draw = Random(f"together {seed} {number}")
        command, inputs, whole, duration_s = made[draw.choice([0, 0, 1, 2, 3])]
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            for name, data in inputs.items():
                (folder / name).write_bytes(data)
            delay_s = draw.uniform(0, 0.7) * duration_s
            with ThreadPoolExecutor(1) as pool:
                first = pool.submit(run, command, folder)
                time.sleep(delay_s)
                second = run(command, folder)
                ended = [first.result(), second]
            failed = [one for one in ended if one.code != 0]
            outcome = "both made the same" if not failed else "the second ended with an error"
            if any(one.code not in (0, 1, 2) or "error" not in one.words.lower() for one in failed):
                return outcome, f"{failed}"
            if len(failed) == 2:
                return outcome, f"both failed: {failed}"
            if comparable(folder) != whole:
                return outcome, f"{command[1]}: {set(comparable(folder).items()) ^ set(whole.items())}"
            return outcome, None

    return all_of(TriedGroup("two programs in one folder"), (partial(trial, i) for i in range(number)))


# Data sets that have changed


def spoil_folder(folder: Path, draw: Random) -> str:
    """Changes one thing in a data set's folder, and says what."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != "preview.png")
    shards = [path for path in files if path.suffix == ".parquet"]
    path = draw.choice(files)
    match draw.choice(["bit"] * 6 + ["cut", "lost", "swapped", "added", "empty"]):
        case "bit":
            changed = bytearray(path.read_bytes())
            changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
            path.write_bytes(bytes(changed))
            return f"a bit of {path.name}"
        case "cut":
            data = path.read_bytes()
            path.write_bytes(data[: draw.randrange(len(data))])
            return f"the end of {path.name}"
        case "lost":
            path.unlink()
            return f"{path.name} lost"
        case "swapped":
            one, other = draw.sample(shards, 2)
            data = one.read_bytes()
            one.write_bytes(other.read_bytes())
            other.write_bytes(data)
            return f"{one.name} and {other.name} swapped"
        case "added":
            one = draw.choice(shards)
            shutil.copy(one, one.with_name(one.name.replace("0", "7", 1) if "0" in one.name else "x" + one.name))
            return "a shard added"
        case _:
            path.write_bytes(b"")
            return f"{path.name} emptied"


def rot(program: str, number: int, seed: int) -> TriedGroup:
    """Data sets of which something is changed."""
    draw = Random(f"rot {seed}")
    command, inputs = commands_to_end(program)[0]
    with tempfile.TemporaryDirectory() as place:
        source = Path(place)
        for name, data in inputs.items():
            (source / name).write_bytes(data)
        if (ended := run(command, source)).code != 0:
            raise SystemExit(ended.words)
        whole = contents(source)

        def trial_of(own: Random) -> Callable[[], tuple[str, str | None]]:
            def trial() -> tuple[str, str | None]:
                with tempfile.TemporaryDirectory() as copied:
                    folder = Path(copied)
                    shutil.copytree(source, folder, dirs_exist_ok=True)
                    what = spoil_folder(folder / "out", own)
                    verified = run([program, "dataset", "verify", "out"], folder)
                    if contents(folder) == whole:
                        return "changed nothing", None
                    if verified.code == 0:
                        return "not seen", f"{what}: not seen"
                    if verified.code not in (1, 2):
                        return "crash", f"{what}: {verified.words[-300:]}"
                    again = run(command, folder)
                    if again.code == 0 and contents(folder) == whole:
                        return "seen, and made again by its plan", None
                    if again.code in (1, 2) and "error" in again.words.lower():
                        return "seen, and the plan says what to do", None
                    return "not mended", f"{what}: {again.words[-300:]}"

            return trial

        return all_of(TriedGroup("data sets with a file changed"), (trial_of(Random(f"{seed} {i}")) for i in range(number)))


# Valid scenarios


def drawn_fault(draw: Random, teeth: int) -> mt.Fault:
    """A fault within its limits for any of the wheels drawn here."""
    wheel: Literal["pinion", "gear"] = draw.choice(["pinion", "gear"])
    tooth = draw.randint(1, teeth)
    severity = draw.uniform(0.05, 0.9)
    match draw.randrange(4):
        case 0:
            return mt.ToothBreakage(wheel=wheel, tooth=tooth, severity=severity)
        case 1:
            return mt.RootCrack(wheel=wheel, tooth=tooth, severity=severity)
        case 2:
            return mt.Wear(wheel=wheel, severity=severity)
        case _:
            return mt.MissingTooth(wheel=wheel, tooth=tooth)


def drawn_scenario(draw: Random) -> mt.Scenario:
    """A gear pair as it is built, under 2 to 120 N of load per mm of its face."""
    module = draw.choice([2.0, 2.5, 3.0, 4.0, 5.0, 6.0])
    pinion, gear = draw.randint(14, 60), draw.randint(18, 90)
    width = round(module * draw.uniform(5, 14), 3)
    radius_m = 0.5e-3 * module * gear
    scenario = mt.Scenario(
        module_mm=module,
        pinion_teeth=pinion,
        gear_teeth=gear,
        face_width_mm=width,
        pinion_speed_hz=round(draw.uniform(3, 60), 3),
        brake_torque_nm=round(draw.uniform(2, 120) * width * radius_m, 4),
        din_grade=draw.randint(4, 10),
        model=draw.choice(["contact", "contact", "linear"]),
    )
    return scenario if draw.random() < 0.3 else scenario.copy(fault=drawn_fault(draw, min(pinion, gear)))


def simulated_trial(draw: Random) -> tuple[str, str | None]:
    """Simulates a scenario that is valid."""
    try:
        scenario = drawn_scenario(draw)
    except ValueError as refusal:
        return "refused with a reason", None if "must" in str(refusal) else f"refused without a reason: {refusal}"
    try:
        simulation = mt.simulate(scenario)
    except ValueError as refusal:
        return "refused with a reason", f"accepted, and not simulated: {refusal}\n{scenario}"
    signals = [np.asarray(signal) for signal in (simulation.vertical_g, simulation.horizontal_g, simulation.mesh_force_n)]
    outcome = "carried out with a warning" if simulation.warnings else "carried out"
    if not all(signal.size and np.isfinite(signal).all() for signal in signals):
        return outcome, f"not finite\n{scenario}"
    radius_m = 0.5e-3 * scenario.module_mm * scenario.gear_teeth * np.cos(np.radians(20))
    force = signals[2].mean() * radius_m / scenario.brake_torque_nm
    if abs(force - 1) > 0.05:
        return outcome, f"{force:.3f} of the torque's force\n{scenario}"
    largest = max(np.abs(signal).max() for signal in signals[:2])
    if largest > 2000 and not simulation.warnings:
        return outcome, f"{largest:.0f} g without a warning\n{scenario}"
    return outcome, None


def valid(_program: str, number: int, seed: int) -> TriedGroup:
    """Scenarios drawn at random from what engineers build."""
    draws = (Random(f"valid {seed} {i}") for i in range(number))
    return all_of(TriedGroup("valid scenarios drawn at random"), (partial(simulated_trial, draw) for draw in draws))


PARTS: dict[str, tuple[Callable[[str, int, int], TriedGroup], int]] = {
    "scenarios": (scenarios, 4000),
    "plans": (plans, 1000),
    "recordings": (recordings, 9200),
    "valid": (valid, 2600),
    "ends": (ends, 200),
    "together": (together, 60),
    "rot": (rot, 600),
}
"""Each part and its number of trials."""


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("program", help="the program `meshtone`, as it was built")
    parser.add_argument("--only", choices=PARTS, action="append", help="one part; may be given several times")
    parser.add_argument("--share", type=float, default=1.0, help="share of the trials to make")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--defects", type=int, default=5, help="defects to show of each part")
    asked = parser.parse_args()
    # In the background of a script Control-C is ignored, and what is started there ignores it too.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    program = str(Path(asked.program).resolve())
    rows = []
    for name in asked.only or PARTS:
        part, number = PARTS[name]
        rows.append(part(program, max(1, round(number * asked.share)), asked.seed))
    for row in rows:
        for defect in row.defects[: asked.defects]:
            print(f"DEFECT: {row.tried}: {defect}\n")
    print("| tried | trials | what happened | defects |")
    print("|---|---|---|---|")
    for row in rows:
        happened = ", ".join(f"{outcome} {count}" for outcome, count in row.outcomes.most_common())
        print(f"| {row.tried} | {row.outcomes.total()} | {happened} | {len(row.defects)} |")
    return 1 if any(row.defects for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
