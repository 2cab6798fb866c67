"""Damage of eight hidden rigs, found by data sets that were adapted to them from healthy recordings.

    python python/validation/hidden_rigs.py [NUMBER …]     # numbers from 0 to 7; some minutes each on two cores

The user knows teeth, module, face, speed, load and grade. Structure, path, grade, mounting and coloured noise of each rig are drawn, by half beyond
the ranges of `unknown-rig`. The rig's recordings are a run-up and 16 s at one speed, healthy. Asked are 240 recordings of the same wheels: 80
healthy, 40 of each of four kinds of damage. For comparison the same trees learn from 400 labelled recordings of the rig with other wheels. It needs scikit-learn.
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
        self.snr_db, self.colour, self.hum_hz, self.hum = draws.uniform([9, 0.3, 1500, 0.5], [24, 1.5, 9000, 2])
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
        simulated = mt.simulate(self.scenario.copy(seed=5, duration_s=seconds, **profile))
        values, rate_hz = simulated.sensors["housing"], simulated.sampling_rate_hz
        return self.noisy(values, rate_hz, snr_db), rate_hz, mt.ShaftPhase.from_speed_profile([0, seconds], speeds_hz, rate_hz, values.size)

    def recordings(self, of_each: int, own_wheels: bool) -> tuple[list[Recorded], np.ndarray]:
        """Labelled recordings: twice as many healthy ones as of each kind; of the wheels of the healthy recordings, or each of others."""
        labels = ["healthy"] * 2 * of_each + [kind for kind in SEVERITIES for _ in range(of_each)]
        scenarios = []
        for label in labels:
            fault: dict[str, Any] = {} if label == "healthy" else {"fault": {"kind": label, "severity": self.draws.uniform(*SEVERITIES[label])}}
            seed, speed_hz, torque_nm = self.draws.integers(1, 1 << 30), self.draws.uniform(29.4, 30.6), self.draws.uniform(57, 63)
            wheels = {"wheels_seed": 5} if own_wheels else {}
            scenarios.append(self.scenario.copy(seed=int(seed), pinion_speed_hz=speed_hz, brake_torque_nm=torque_nm, duration_s=1.4, **wheels, **fault))
        simulated = mt.simulate_many(scenarios, channels=["housing_g"], target_rate_hz=KEPT_HZ)
        recorded = []
        for scenario, signals in zip(scenarios, simulated, strict=True):
            values = self.noisy(np.asarray(signals["housing_g"], float), KEPT_HZ, self.snr_db + self.draws.uniform(-3, 3))
            recorded.append((values, KEPT_HZ, mt.ShaftPhase.constant(scenario.pinion_speed_hz, KEPT_HZ, values.size)))
        return recorded, np.array(labels)


