"""Damage of eight hidden rigs, and of eight hidden gearboxes, found by data sets that were adapted to them from healthy recordings.

    python python/validation/hidden_rigs.py pair|gearbox [NUMBER …]     # numbers from 0 to 7; some minutes each on two cores

The user knows teeth, module, face, speed, load and grade; of the gearbox its shafts and bearings, too. Structure, path, grade, mounting and coloured
noise of each machine are drawn, by half beyond the ranges of `unknown-rig`. Its recordings are a run-up and 16 s at one speed, healthy. Asked are
recordings of the same wheels: 80 healthy and 40 of each of four kinds of damage, of a gearbox half as many. For comparison trees learn from labelled
recordings of the machine with other wheels: 480 and 360. It needs scikit-learn.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.metrics import balanced_accuracy_score, recall_score, roc_auc_score

import meshtone as mt
from meshtone.signal import Bearing, cepstral_prewhitening, defect_lines, squared_envelope_spectrum

RATE_HZ, KEPT_HZ = 50e3, 25e3
WHEELS = 5
PARTS = ("outer race", "inner race", "rolling element")
Recorded = tuple[np.ndarray, float, mt.ShaftPhase]


class HiddenPair:
    """A rig of one pair that its user does not know."""

    known = mt.Scenario(
        module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=30, brake_torque_nm=60, iso_class=5,
        sampling_rate_hz=RATE_HZ, settle_tolerance=1e-3, sensors=[mt.Sensor(name="housing", at="gear-support")],
    )
    severities = {"tooth-breakage": (0.3, 0.9), "pits": (0.1, 0.6), "root-crack": (0.5, 1.0), "wear": (0.4, 0.9)}
    channel, torque_nm, asked_healthy, asked_of_kind, units = "housing_g", 60, 80, 40, 24
    tried: str | float = "sqrt"  # Features that a split of the trees for comparison draws from; of gearboxes more are better.

    def __init__(self, number: int) -> None:
        self.draws = np.random.default_rng(1000 + number)
        self.scenario = self.drawn(self.path())
        self.snr_db, self.colour, self.hum_hz, self.hum = self.draws.uniform([9, 0.3, 1500, 0.5], [24, 1.5, 9000, 2]).tolist()

    def factor(self, most: float) -> float:
        """A factor, as likely below 1 as above it."""
        return float(np.exp(self.draws.uniform(-1, 1) * np.log(most)))

    def path(self) -> dict[str, np.ndarray]:
        """The frequency response from the seat to the sensor."""
        hz = np.arange(0.0, RATE_HZ / 2 + 1, 10.0)
        response = (50 + 1j * hz) / self.draws.uniform(1000, 4000)
        for _ in range(self.draws.integers(2, 7)):
            resonance_hz, damping_ratio = np.exp(self.draws.uniform(np.log([600, 0.02]), np.log([10_000, 0.06])))
            ratio = hz / resonance_hz
            response *= 1 + self.draws.uniform(0.1, 0.45) * self.draws.choice([-1, 1]) * ratio**2 / (1 - ratio**2 + 2j * damping_ratio * ratio)
        return {"frequency_hz": hz, "magnitude": np.abs(response), "phase_deg": np.degrees(np.angle(response))}

    def drawn(self, path: dict[str, np.ndarray]) -> mt.Scenario:
        """What the user does not know of it."""
        factor, draws = self.factor, self.draws
        return self.known.copy(
            support={"mass_kg": 2 * factor(2.2), "base_hz": 450 * factor(2.2), "differential_hz": 2200 * factor(2.2), "damping_ratio": 0.04 * factor(3.7)},
            bearing_stiffness_n_per_m=2e8 * factor(2.2), mesh_damping_ratio=0.1 * factor(2), misalignment_um=draws.uniform(-15, 15),
            eccentricity_mm=draws.uniform(0, 0.03), iso_class=int(draws.choice([4, 5, 6])),
            sensors=[mt.Sensor(name="housing", at="gear-support", frequency_response=path)],
        )

    def turning(self, seed: int, wheels_seed: int, speed_hz: float | list[float], torque_nm: float, duration_s: float) -> dict[str, Any]:
        """The keys of one run, at a speed or from one speed to another."""
        keys = {"seed": seed, "wheels_seed": wheels_seed, "brake_torque_nm": torque_nm, "duration_s": duration_s}
        if isinstance(speed_hz, float):
            return {**keys, "pinion_speed_hz": speed_hz}
        return {**keys, "speed_profile_hz": {"time_s": [0, duration_s], "value": speed_hz}, "settle_fraction": 1 / 9}

    def fault(self, kind: str) -> dict[str, Any]:
        """A fault of a kind, as plans have it."""
        return {"kind": kind}

    def damage(self, kind: str, severity: float) -> dict[str, Any]:
        """What changes in the scenario with damage of a kind."""
        return {"faults": [{**self.fault(kind), "severity": severity}]}

    def noise(self, samples: int, rate_hz: float) -> np.ndarray:
        """Noise of the surroundings, which falls with the frequency, and a band of it that stands out."""
        hz = np.fft.rfftfreq(samples, 1 / rate_hz)
        shape = (1 + hz / 1000) ** -self.colour + self.hum * np.exp(-(((hz - self.hum_hz) / 600) ** 2))
        noise = np.fft.irfft(np.fft.rfft(self.draws.standard_normal(samples)) * shape, samples)
        return np.asarray(noise / noise.std())

    def noisy(self, values: np.ndarray, rate_hz: float, snr_db: float) -> np.ndarray:
        """Values with noise."""
        return np.asarray(values + values.std() * 10 ** (-snr_db / 20) * self.noise(values.size, rate_hz))

    def healthy(self, seconds: float, speeds_hz: list[float], snr_db: float) -> Recorded:
        """A healthy recording, at one speed or of a run-up."""
        is_steady = speeds_hz[0] == speeds_hz[1]
        run = self.turning(WHEELS, WHEELS, float(speeds_hz[0]) if is_steady else speeds_hz, self.torque_nm, seconds)
        simulated = mt.simulate(self.scenario.copy(**run))
        values, rate_hz = simulated.sensors[self.channel.removesuffix("_g")], simulated.sampling_rate_hz
        return self.noisy(values, rate_hz, snr_db), rate_hz, mt.ShaftPhase.from_speed_profile([0, seconds], speeds_hz, rate_hz, values.size)

    def asked(self) -> tuple[list[Recorded], np.ndarray]:
        """Recordings of the wheels of the healthy ones, and what they are of."""
        labels = ["healthy"] * self.asked_healthy + [kind for kind in self.severities for _ in range(self.asked_of_kind)]
        scenarios, speeds_hz = [], []
        for label in labels:
            fault = {} if label == "healthy" else self.damage(label, self.draws.uniform(*self.severities[label]))
            seed, speed_hz, torque_nm = self.draws.integers(1, 1 << 30), self.draws.uniform(29.4, 30.6), self.torque_nm * self.draws.uniform(0.95, 1.05)
            speeds_hz.append(speed_hz)
            scenarios.append(self.scenario.copy(**self.turning(int(seed), WHEELS, speed_hz, torque_nm, 1.4), **fault))
        recorded = []
        for speed_hz, signals in zip(speeds_hz, mt.simulate_many(scenarios, channels=[self.channel], target_rate_hz=KEPT_HZ), strict=True):
            values = self.noisy(np.asarray(signals[self.channel], float), KEPT_HZ, self.snr_db + self.draws.uniform(-3, 3))
            recorded.append((values, KEPT_HZ, mt.ShaftPhase.constant(speed_hz, KEPT_HZ, values.size)))
        return recorded, np.array(labels)

    def labelled(self, folder: Path) -> mt.Dataset:
        """Labelled recordings of the machine with other wheels."""
        np.savez(folder / "noise.npz", noise=self.noise(int(12 * RATE_HZ), RATE_HZ), sampling_rate_hz=RATE_HZ)
        (folder / "rig.toml").write_text(self.scenario.to_toml(), "utf-8")
        of_kind = 80 * self.units // 24
        plan = f'scenario = "rig.toml"\nbackground = "noise.npz"\nunits = {self.units}\nvariation = "known-rig"\n[[class]]\nlabel = "healthy"\ncount = {2 * of_kind}\n'
        for kind, severities in self.severities.items():
            fault = ", ".join(f"{key} = {value!r}" for key, value in {**self.fault(kind), "severity": 0.5}.items())
            plan += f'[[class]]\nlabel = "{kind}"\ncount = {of_kind}\nfault = {{ {fault} }}\n'
            plan += f'[[class.vary]]\nkey = "fault.severity"\nuniform = {list(severities)}\n'
        plan += f'[[vary]]\nkey = "noise.snr_db"\nuniform = {[self.snr_db - 3, self.snr_db + 3]}\n[keep]\naverage = false\ndifference = false\n'
        (folder / "labelled.toml").write_text(plan, "utf-8")
        return mt.generate_dataset(folder / "labelled.toml", folder / "labelled", progress=False)


class HiddenGearbox(HiddenPair):
    """A gearbox of one stage on ball bearings that its user does not know."""

    known = mt.Gearbox(
        shafts=[{"name": "input", "length_mm": 160, "radius_mm": 12.5, "couples_to": "motor"}, {"name": "output", "length_mm": 160, "radius_mm": 17.5, "couples_to": "brake"}],
        wheels=[{"name": "z1", "shaft": "input", "at": 0.5, "teeth": 23, "face_width_mm": 20, "iso_class": 5}, {"name": "z2", "shaft": "output", "at": 0.5, "teeth": 57, "face_width_mm": 20, "iso_class": 5}],
        meshes=[{"wheels": ["z1", "z2"], "module_mm": 2.5}],
        bearings=[
            {"shaft": "input", "at": 0.0, "kind": "ball", "name": "6205"}, {"shaft": "input", "at": 1.0, "kind": "ball", "name": "6205"},
            {"shaft": "output", "at": 0.0}, {"shaft": "output", "at": 1.0},
        ],
        housing={"mass_kg": 25},
        operation={"input_speed_hz": 30, "brake_torque_nm": 80},
        sensors=[{"name": "seat", "at": "input:0"}],
        solver={"sampling_rate_hz": RATE_HZ, "duration_s": 1.0},
    )
    severities = {"tooth-breakage@z2": (0.3, 0.9), "pits@z1": (0.1, 0.6), "outer@input:0": (0.2, 0.9), "inner@input:0": (0.2, 0.9)}
    channel, torque_nm, asked_healthy, asked_of_kind, units = "seat_g", 80, 40, 20, 18
    tried = 0.3

    def drawn(self, path: dict[str, np.ndarray]) -> mt.Scenario:
        factor, draws, known = self.factor, self.draws, self.known.sections
        damping_ratio = 0.05 * factor(3.7)
        seats = [factor(2.2) for _ in known["bearing"]]
        bearings = [
            {**bearing, "damping_ratio": damping_ratio, "seat": {**bearing["seat"], "mass_kg": bearing["seat"]["mass_kg"] * seat, "stiffness_n_per_m": bearing["seat"]["stiffness_n_per_m"] * factor(4.8)}}
            for bearing, seat in zip(known["bearing"], seats, strict=True)
        ]
        for bearing in bearings:
            if bearing["kind"] == "ball":
                bearing["clearance_um"] = 3 * factor(2.8)
            else:
                bearing["stiffness_n_per_m"] *= factor(2.2)
        meshes = [{**mesh, "friction": 0.05 * factor(2.5), "random_force": 0.055 * factor(4.8), "damping_ratio": mesh["damping_ratio"] * factor(2)} for mesh in known["mesh"]]
        grade = int(draws.choice([4, 5, 6]))
        modes = {"per_khz": 4 * factor(2.5), "first_hz": 350 * factor(2.5), "damping_ratio": 0.03 * factor(2), "seed": int(draws.integers(1, 1 << 30))}
        return self.known.copy(
            wheels=[{**wheel, "iso_class": grade} for wheel in known["wheel"]], meshes=meshes, bearings=bearings,
            housing={"mass_kg": 25 * factor(2.2), "modes": modes}, sensors=[{"name": "seat", "at": "input:0", "frequency_response": path}],
        )

    def turning(self, seed: int, wheels_seed: int, speed_hz: float | list[float], torque_nm: float, duration_s: float) -> dict[str, Any]:
        operation: dict[str, Any] = {"brake_torque_nm": torque_nm}
        if isinstance(speed_hz, float):
            operation["input_speed_hz"] = speed_hz
        else:
            operation["speed_profile_hz"] = {"time_s": [0, duration_s], "value": speed_hz}
        return {"seed": seed, "wheels_seed": wheels_seed, "operation": operation, "solver": {"duration_s": duration_s}}

    def fault(self, kind: str) -> dict[str, Any]:
        kind, place = kind.split("@")
        return {"bearing": place, "race": kind} if kind in ("outer", "inner") else {"wheel": place, "kind": kind}

    def damage(self, kind: str, severity: float) -> dict[str, Any]:
        fault = {**self.fault(kind), "severity": severity}
        if "wheel" in fault:
            return {"faults": [fault]}
        bearings = self.scenario.sections["bearing"]
        bearings[0]["defect"] = [{"race": fault["race"], "severity": severity}]
        return {"bearings": bearings}


def lines_of_bearing(signal: np.ndarray, input_hz: float) -> list[float]:
    """Logarithms of the lines of each part over the medians beside them, the mean of the harmonics, in three bands of the whitened signal."""
    found, white = [], cepstral_prewhitening(np.asarray(signal, float))
    for band_hz in [(500, 3000), (3000, 6000), (6000, 10_000)]:
        spectrum = squared_envelope_spectrum(white, KEPT_HZ, band_hz)
        lines = defect_lines(spectrum, Bearing.named("6205"), input_hz)
        found += [float(np.mean([np.log(line.over_median) for line in lines if line.part == part])) for part in PARTS]
    return found


def features(rig: HiddenPair, records: mt.Dataset, columns: list[str]) -> np.ndarray:
    """Indicators, which span decades, and some are negative; of a gearbox lines of its bearing, too."""
    values = np.arcsinh(100.0 * records.matrix(columns))
    if not isinstance(rig, HiddenGearbox):
        return values
    speeds_hz = records["input_speed_hz"]
    return np.hstack([values, [lines_of_bearing(signal, float(hz)) for signal, hz in zip(records[rig.channel], speeds_hz, strict=True)]])


def beside_others(values: np.ndarray, healthy: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Values, and what they exceed the medians of the other healthy records of their unit by."""
    others = [np.flatnonzero((units == unit) & healthy & (np.arange(len(units)) != row)) for row, unit in enumerate(units)]
    return np.hstack([values, values - [np.median(values[of], axis=0) for of in others]])


def learnt_from_labels(rig: HiddenPair, asked: list[Recorded], healthy: Recorded, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Probabilities of damage, and classes, by trees that learnt from labelled recordings."""
    known = rig.labelled(folder)
    columns = [name for name in known.indicator_columns if name not in known.empty_columns]
    labels = known["label"].astype(str)
    trees = ExtraTreesClassifier(200, max_features=rig.tried, min_samples_leaf=2, class_weight="balanced", random_state=0)
    trees.fit(beside_others(features(rig, known, columns), labels == "healthy", known["unit"]), labels)
    recorded = known.like([values for values, _, _ in asked], [phase for _, _, phase in asked], rig.known, KEPT_HZ)
    first = np.unique(recorded["unit"], return_index=True)[1]
    values = features(rig, recorded, columns)[first]
    before = np.median(features(rig, known.like([healthy[0]], [healthy[2]], rig.known, healthy[1]), columns), axis=0)
    probabilities = trees.predict_proba(np.hstack([values, values - before]))
    return 1 - probabilities[:, list(trees.classes_).index("healthy")], trees.classes_[probabilities.argmax(axis=1)]


def main() -> None:
    """Print a line for each rig and way to learn."""
    warnings.simplefilter("ignore", mt.MeshtoneWarning)
    print("rig, learnt from: area under the curve, balanced accuracy of detection, false alarms, mean recall of the classes")
    kinds = {"pair": HiddenPair, "gearbox": HiddenGearbox}
    kind, *numbers = sys.argv[1:]
    of_kind = kinds[kind]
    for number in [int(text) for text in numbers] or range(8):
        rig, folder = of_kind(number), Path(tempfile.mkdtemp())
        run_up, steady = rig.healthy(8, [15, 45], rig.snr_db), rig.healthy(16, [30, 30], rig.snr_db)
        noisy = [rig.healthy(8, [15, 45], 10), rig.healthy(16, [30, 30], 10)]
        asked, labels = rig.asked()
        damaged = labels != "healthy"
        scores, classes = learnt_from_labels(rig, asked, steady, folder)
        print(f"{number}, labels: {roc_auc_score(damaged, scores):.3f}, {recall_score(labels, classes, average='macro'):.3f}", flush=True)
        ways: dict[str, list[Any]] = {"run-up and steady": [run_up, steady], "steady": [steady], "the first at 10 dB": noisy}
        for name, healthy in ways.items():
            try:
                adapted = mt.adapt(healthy, rig.known, folder / name, classes=list(rig.severities))
            except ValueError as error:
                print(f"{number}, {name}: refused: {error}", flush=True)
                continue
            probabilities = np.array([adapted.probabilities(recorded)[0] for recorded in asked])
            scores, classes = 1 - probabilities[:, 0], np.array(adapted.classes)[probabilities.argmax(axis=1)]
            found = scores > adapted.threshold
            area, recall = roc_auc_score(damaged, scores), recall_score(labels, classes, average="macro")
            print(f"{number}, {name}: {area:.3f}, {balanced_accuracy_score(damaged, found):.3f}, {found[~damaged].mean():.3f}, {recall:.3f}", flush=True)


if __name__ == "__main__":
    main()
