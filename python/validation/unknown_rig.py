"""What a data set that is made for a rig adds, step by step, on recordings of that rig.

The rig is another scenario than the one that its user has: other stiffnesses, dampings and wheels, a hidden path to the sensor and coloured
noise. 200 of its recordings, 40 of each state, are diagnosed by gradient boosting that was trained on simulations alone, whose data set has
with every step more of what healthy recordings of the rig tell; once by the indicators as they are, once relative to those of healthy records
of the same wheels. A detector that was trained on 40 healthy recordings stands beside it.

Prints the table of the book's chapter Validation; takes some minutes on two processors:

    pip install '.[datasets]' scikit-learn && python python/validation/unknown_rig.py
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np
import numpy.typing as npt
from sklearn.ensemble import HistGradientBoostingClassifier, IsolationForest
from sklearn.metrics import balanced_accuracy_score

import meshtone as mt

KINDS = ["healthy", "tooth-breakage", "pits", "root-crack", "wear"]
SEVERITIES = {"tooth-breakage": (0.3, 0.9), "pits": (0.1, 0.5), "root-crack": (0.5, 1.0), "wear": (0.4, 0.9)}
OF_EACH = 40
TRAINED = int(sys.argv[1]) if len(sys.argv) > 1 else 900

Matrix = npt.NDArray[np.float64]


def classes(healthy: int, damaged: int) -> str:
    text = f'[[class]]\nlabel = "healthy"\ncount = {healthy}\n'
    for kind, (least, most) in SEVERITIES.items():
        text += f'[[class]]\nlabel = "{kind}"\ncount = {damaged}\nfault = {{ kind = "{kind}", severity = 0.5 }}\n'
        text += f'[[class.vary]]\nkey = "fault.severity"\nuniform = [{least}, {most}]\n'
    return text


NOISE = '[[vary]]\nkey = "noise.snr_db"\nuniform = [10.0, 20.0]\n'
KEEP = '[keep]\nchannels = [{channels}]\naverage = false\ndifference = false\n'


def made(folder: Path, name: str, head: str, scenario: mt.Scenario, tail: str) -> mt.Dataset:
    (folder / f"{name}_scenario.toml").write_text(scenario.to_toml(), "utf-8")
    (folder / f"{name}.toml").write_text(f'scenario = "{name}_scenario.toml"\n{head}\n{tail}', "utf-8")
    return mt.generate_dataset(folder / f"{name}.toml", folder / name)


def features(records: mt.Dataset, columns: list[str]) -> Matrix:
    """Indicators, which span decades and may be negative."""
    values: Matrix = np.arcsinh(100.0 * records.matrix(columns))
    return values


def hidden_path() -> dict[str, Matrix]:
    hz = np.arange(0.0, 25_001.0, 10.0)
    response = (50 + 1j * hz) / 2000
    for resonance_hz, damping_ratio, share in [(1300, 0.04, 0.3), (3400, 0.03, 0.3), (7200, 0.03, -0.3)]:
        ratio = hz / resonance_hz
        response *= 1 + share * ratio**2 / (1 - ratio**2 + 2j * damping_ratio * ratio)
    return {"frequency_hz": hz, "magnitude": np.abs(response), "phase_deg": np.degrees(np.angle(response))}


def coloured_noise(samples: int, rate_hz: float) -> Matrix:
    """Noise that falls with the frequency, and a band of it that stands out."""
    lines = np.fft.rfft(np.random.default_rng(11).standard_normal(samples))
    hz = np.fft.rfftfreq(samples, 1 / rate_hz)
    lines *= 1 / (1 + hz / 1000) + 1.5 * np.exp(-(((hz - 5000) / 600) ** 2))
    noise: Matrix = np.fft.irfft(lines, samples)
    noise /= noise.std()
    return noise


def relative(values: Matrix, healthy: npt.NDArray[np.bool_], groups: npt.NDArray[np.int64]) -> Matrix:
    """Features over those of the healthy records of the same wheels."""
    out = np.empty_like(values)
    for group in np.unique(groups):
        of_group = groups == group
        out[of_group] = values[of_group] - np.nanmedian(values[of_group & healthy], axis=0)
    return out


def scores(train: Matrix, labels: npt.NDArray[np.str_], test: Matrix, truth: npt.NDArray[np.str_]) -> tuple[float, float]:
    """Balanced accuracies of detection and of the diagnosis among five states."""
    model = HistGradientBoostingClassifier(max_iter=150, class_weight="balanced", random_state=0, early_stopping=False)
    named = model.fit(train, labels).predict(test)
    return balanced_accuracy_score(truth != "healthy", named != "healthy"), balanced_accuracy_score(truth, named)


def main() -> None:
    warnings.simplefilter("ignore", mt.MeshtoneWarning)
    known = mt.Scenario(
        module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=30, brake_torque_nm=60, iso_class=5,
        sampling_rate_hz=50e3, settle_tolerance=1e-3, sensors=[mt.Sensor(name="housing", at="gear-support")],
    )  # fmt: skip
    hidden = known.copy(
        support={"mass_kg": 2.8, "base_hz": 520.0, "differential_hz": 2500.0, "damping_ratio": 0.04}, bearing_stiffness_n_per_m=2.4e8,
        mesh_damping_ratio=0.11, misalignment_um=6.0, eccentricity_mm=0.01,
        sensors=[mt.Sensor(name="housing", at="gear-support", frequency_response=hidden_path())],
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        rate_hz = 50e3
        noise = coloured_noise(int(12 * rate_hz), rate_hz)
        np.savez(folder / "noise.npz", noise=noise, sampling_rate_hz=rate_hz)
        # The rig: other wheels, one mounting; 40 healthy recordings are known as such, the others are diagnosed.
        operation = '[[vary]]\nkey = "operation.pinion_speed_hz"\nuniform = [29.4, 30.6]\n[[vary]]\nkey = "operation.brake_torque_nm"\nuniform = [57.0, 63.0]\n'
        rig = made(
            folder, "rig", 'seed = 77\nunits = 1\nbackground = "noise.npz"', hidden,
            classes(2 * OF_EACH, OF_EACH) + operation + NOISE + KEEP.format(channels='"housing_g"') + "[split]\ntest = 1.0\n",
        )  # fmt: skip
        truth = rig.column("label").astype(str)
        reference = np.isin(np.arange(len(rig)), np.flatnonzero(truth == "healthy")[:OF_EACH])
        # What the rig's owner records of the healthy machine: a run-up for the path, one speed for the noise.
        run_up = hidden.copy(seed=5, speed_profile_hz={"time_s": [1, 9], "value": [15, 45]}, duration_s=8, settle_fraction=1 / 9)
        path = mt.estimate_path(mt.simulate(run_up), known)
        steady = mt.simulate(hidden.copy(seed=5, duration_s=8))
        vibration = steady.sensors["housing"]
        np.savez(folder / "healthy.npz", housing=vibration + 0.18 * vibration.std() * noise[: vibration.size], sampling_rate_hz=steady.sampling_rate_hz)
        with_path = known.copy(sensors=[mt.Sensor(name="housing", at="gear-support", frequency_response=path.frequency_response)])
        steps = [
            ("zero-shot: `unknown-rig`", "unknown-rig", known, ""),
            ("`known-rig`, no path", "known-rig", known, ""),
            ("`known-rig-unknown-path`", "known-rig-unknown-path", known, ""),
            ("`known-rig` with the estimated path", "known-rig", with_path, ""),
            ("the same, with the rig's background", "known-rig", with_path, 'background = "healthy.npz"'),
        ]
        each = TRAINED // 6
        rows = []
        for number, (name, variation, scenario, background) in enumerate(steps):
            train = made(
                folder, f"train{number}", f'units = {each // 5}\nvariation = "{variation}"\n{background}', scenario,
                classes(2 * each, each) + NOISE + KEEP.format(channels="") + "[split]\ntrain = 1.0\n",
            )  # fmt: skip
            skipped = {"fault_severity", *train.condition_columns}
            columns = [
                column for column in train.scalar_columns
                if train.units.get(column) in ("g", "-") and column not in train.empty_columns and column not in skipped
                and (train.arrow.schema.field(column).metadata or {}).get(b"description", b"").startswith(b"indicator")
            ]  # fmt: skip
            signals = rig.signals("housing_g")
            phases = [mt.ShaftPhase.constant(hz, 25e3, signal.size) for hz, signal in zip(rig.column("pinion_speed_hz"), signals, strict=True)]
            recorded = train.like(signals, phases, known, 25e3)
            measured, simulated = features(recorded, columns), features(train, columns)
            labels = train.column("label").astype(str)
            own = relative(simulated, labels == "healthy", train.column("unit"))
            of_rig = relative(measured, reference, np.zeros(len(truth), dtype=np.int64))
            rows.append((
                name,
                *scores(simulated, labels, measured[~reference], truth[~reference]),
                *scores(own, labels, of_rig[~reference], truth[~reference]),
            ))  # fmt: skip
            print(*rows[-1], sep=", ", file=sys.stderr, flush=True)
        forest = IsolationForest(random_state=0, contamination=0.05).fit(np.nan_to_num(measured[reference]))
        named = forest.predict(np.nan_to_num(measured[~reference])) < 0
        print("| trained on | detection | diagnosis | relative: detection | diagnosis |\n|---|---:|---:|---:|---:|")
        for name, *accuracies in rows:
            print(f"| {name} | {' | '.join(f'{accuracy:.2f}' for accuracy in accuracies)} |")
        alone = balanced_accuracy_score(truth[~reference] != "healthy", named)
        print(f"| 40 healthy recordings alone, isolation forest | {alone:.2f} | – | – | – |")


if __name__ == "__main__":
    main()
