"""Damage of eight hidden rigs, found by data sets that were adapted to them from healthy recordings.

    python python/validation/hidden_rigs.py [NUMBER …]     # numbers from 0 to 7; some minutes each on two cores

The user knows teeth, module, face, speed, load and grade. Structure, path, grade, mounting and coloured noise of each rig are drawn, by half beyond
the ranges of `unknown-rig`. The rig's recordings are a run-up and 16 s at one speed, healthy. Asked are 240 recordings of the same wheels: 80
healthy, 40 of each of four kinds of damage. For comparison trees learn from 480 labelled recordings of the rig with 24 other pairs of wheels. It needs
scikit-learn.
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

RATE_HZ, KEPT_HZ = 50e3, 25e3
WHEELS = 5
SEVERITIES = {"tooth-breakage": (0.3, 0.9), "pits": (0.1, 0.6), "root-crack": (0.5, 1.0), "wear": (0.4, 0.9)}
KNOWN = mt.Scenario(
    module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=30, brake_torque_nm=60, iso_class=5,
    sampling_rate_hz=RATE_HZ, settle_tolerance=1e-3, sensors=[mt.Sensor(name="housing", at="gear-support")],
)
Recorded = tuple[np.ndarray, float, mt.ShaftPhase]


class HiddenRig:
    """A rig that its user does not know."""

    def __init__(self, number: int) -> None:
        draws = np.random.default_rng(1000 + number)

        def factor(most: float) -> float:
            return float(np.exp(draws.uniform(-1, 1) * np.log(most)))

        hz = np.arange(0.0, RATE_HZ / 2 + 1, 10.0)
        response = (50 + 1j * hz) / draws.uniform(1000, 4000)
        for _ in range(draws.integers(2, 7)):
            resonance_hz, damping_ratio = np.exp(draws.uniform(np.log([600, 0.02]), np.log([10_000, 0.06])))
            ratio = hz / resonance_hz
            response *= 1 + draws.uniform(0.1, 0.45) * draws.choice([-1, 1]) * ratio**2 / (1 - ratio**2 + 2j * damping_ratio * ratio)
        path = {"frequency_hz": hz, "magnitude": np.abs(response), "phase_deg": np.degrees(np.angle(response))}
        self.scenario = KNOWN.copy(
            support={"mass_kg": 2 * factor(2.2), "base_hz": 450 * factor(2.2), "differential_hz": 2200 * factor(2.2), "damping_ratio": 0.04 * factor(3.7)},
            bearing_stiffness_n_per_m=2e8 * factor(2.2), mesh_damping_ratio=0.1 * factor(2), misalignment_um=draws.uniform(-15, 15),
            eccentricity_mm=draws.uniform(0, 0.03), iso_class=int(draws.choice([4, 5, 6])),
            sensors=[mt.Sensor(name="housing", at="gear-support", frequency_response=path)],
        )
        self.snr_db, self.colour, self.hum_hz, self.hum = draws.uniform([9, 0.3, 1500, 0.5], [24, 1.5, 9000, 2]).tolist()
        self.draws = draws

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
        profile = {"speed_profile_hz": {"time_s": [0, seconds], "value": speeds_hz}, "settle_fraction": 1 / 9} if speeds_hz[0] != speeds_hz[1] else {}
        simulated = mt.simulate(self.scenario.copy(seed=WHEELS, duration_s=seconds, **profile))
        values, rate_hz = simulated.sensors["housing"], simulated.sampling_rate_hz
        return self.noisy(values, rate_hz, snr_db), rate_hz, mt.ShaftPhase.from_speed_profile([0, seconds], speeds_hz, rate_hz, values.size)

    def asked(self) -> tuple[list[Recorded], np.ndarray]:
        """Recordings of the wheels of the healthy ones, and what they are of."""
        labels = ["healthy"] * 80 + [kind for kind in SEVERITIES for _ in range(40)]
        scenarios = []
        for label in labels:
            fault: dict[str, Any] = {} if label == "healthy" else {"fault": {"kind": label, "severity": self.draws.uniform(*SEVERITIES[label])}}
            seed, speed_hz, torque_nm = self.draws.integers(1, 1 << 30), self.draws.uniform(29.4, 30.6), self.draws.uniform(57, 63)
            operation = {"pinion_speed_hz": speed_hz, "brake_torque_nm": torque_nm, "duration_s": 1.4}
            scenarios.append(self.scenario.copy(seed=int(seed), wheels_seed=WHEELS, **operation, **fault))
        recorded = []
        for scenario, signals in zip(scenarios, mt.simulate_many(scenarios, channels=["housing_g"], target_rate_hz=KEPT_HZ), strict=True):
            values = self.noisy(np.asarray(signals["housing_g"], float), KEPT_HZ, self.snr_db + self.draws.uniform(-3, 3))
            recorded.append((values, KEPT_HZ, mt.ShaftPhase.constant(scenario.pinion_speed_hz, KEPT_HZ, values.size)))
        return recorded, np.array(labels)

    def labelled(self, folder: Path) -> mt.Dataset:
        """Labelled recordings of the rig with other wheels."""
        np.savez(folder / "noise.npz", noise=self.noise(int(12 * RATE_HZ), RATE_HZ), sampling_rate_hz=RATE_HZ)
        (folder / "rig.toml").write_text(self.scenario.to_toml(), "utf-8")
        plan = f'scenario = "rig.toml"\nbackground = "noise.npz"\nunits = 24\nvariation = "known-rig"\n[[class]]\nlabel = "healthy"\ncount = 160\n'
        for kind, severities in SEVERITIES.items():
            plan += f'[[class]]\nlabel = "{kind}"\ncount = 80\nfault = {{ kind = "{kind}", severity = 0.5 }}\n'
            plan += f'[[class.vary]]\nkey = "fault.severity"\nuniform = {list(severities)}\n'
        plan += f'[[vary]]\nkey = "noise.snr_db"\nuniform = {[self.snr_db - 3, self.snr_db + 3]}\n[keep]\naverage = false\ndifference = false\n'
        (folder / "labelled.toml").write_text(plan, "utf-8")
        return mt.generate_dataset(folder / "labelled.toml", folder / "labelled", progress=False)


def indicators(records: mt.Dataset, columns: list[str]) -> np.ndarray:
    """Indicators span decades, and some are negative."""
    return np.arcsinh(100.0 * records.matrix(columns))


def beside_others(values: np.ndarray, healthy: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Values, and what they exceed the medians of the other healthy records of their unit by."""
    others = [np.flatnonzero((units == unit) & healthy & (np.arange(len(units)) != row)) for row, unit in enumerate(units)]
    return np.hstack([values, values - [np.median(values[of], axis=0) for of in others]])


def learnt_from_labels(rig: HiddenRig, asked: list[Recorded], healthy: Recorded, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Probabilities of damage, and classes, by trees that learnt from labelled recordings."""
    known = rig.labelled(folder)
    columns = [name for name in known.indicator_columns if name not in known.empty_columns]
    labels = known["label"].astype(str)
    trees = ExtraTreesClassifier(200, min_samples_leaf=2, class_weight="balanced", random_state=0)
    trees.fit(beside_others(indicators(known, columns), labels == "healthy", known["unit"]), labels)
    recorded = known.like([values for values, _, _ in asked], [phase for _, _, phase in asked], KNOWN, KEPT_HZ)
    first = np.unique(recorded["unit"], return_index=True)[1]
    values = indicators(recorded, columns)[first]
    before = np.median(indicators(known.like([healthy[0]], [healthy[2]], KNOWN, healthy[1]), columns), axis=0)
    probabilities = trees.predict_proba(np.hstack([values, values - before]))
    return 1 - probabilities[:, list(trees.classes_).index("healthy")], trees.classes_[probabilities.argmax(axis=1)]


def main() -> None:
    """Print a line for each rig and way to learn."""
    warnings.simplefilter("ignore", mt.MeshtoneWarning)
    print("rig, learnt from: area under the curve, balanced accuracy of detection, false alarms, mean recall of the classes")
    for number in [int(text) for text in sys.argv[1:]] or range(8):
        rig, folder = HiddenRig(number), Path(tempfile.mkdtemp())
        run_up, steady = rig.healthy(8, [15, 45], rig.snr_db), rig.healthy(16, [30, 30], rig.snr_db)
        noisy = [rig.healthy(8, [15, 45], 10), rig.healthy(16, [30, 30], 10)]
        asked, labels = rig.asked()
        damaged = labels != "healthy"
        scores, classes = learnt_from_labels(rig, asked, steady, folder)
        print(f"{number}, labels: {roc_auc_score(damaged, scores):.3f}, {recall_score(labels, classes, average='macro'):.3f}", flush=True)
        ways: dict[str, list[Any]] = {"run-up and steady": [run_up, steady], "steady": [steady], "the first at 10 dB": noisy}
        for name, healthy in ways.items():
            try:
                adapted = mt.adapt(healthy, KNOWN, folder / name, classes=list(SEVERITIES))
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
