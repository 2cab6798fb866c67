"""What a diagnosis says of damage on structures that its prior does not have.

    python python/validation/kinds_elsewhere.py [NUMBER …]     # rigs, by default 8 to 11; some minutes each on two cores

The rigs are those of `hidden_rigs.py`, with other numbers. Each is asked with one healthy recording of the same wheels and the scenario that its user
knows: two recordings of the gear's damage of every kind and each of two severities, and eight healthy ones.
"""

from __future__ import annotations

import sys
import warnings
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import numpy as np

import meshtone as mt

sys.path.insert(0, str(Path(__file__).parent))
from hidden_rigs import KEPT_HZ, WHEELS, HiddenPair  # noqa: E402

KINDS = ["missing-tooth", "tooth-breakage", "tooth-destruction", "through-face", "partial-face", "pits", "root-crack", "wear"]
SEVERITIES = (0.5, 0.8)


def asked(rig: HiddenPair) -> list[tuple[str, Any]]:
    """Recordings, each with what it is of."""
    labels = ["healthy"] * 8 + [kind for kind in KINDS for _ in range(2 * len(SEVERITIES))]
    scenarios = []
    for number, label in enumerate(labels):
        severity = {} if label == "missing-tooth" else {"severity": SEVERITIES[number % len(SEVERITIES)]}
        fault: dict[str, Any] = {} if label == "healthy" else {"fault": {"kind": label, **severity}}
        operation = {"pinion_speed_hz": rig.draws.uniform(29.4, 30.6), "brake_torque_nm": rig.draws.uniform(57, 63), "duration_s": 4.0}
        scenarios.append(rig.scenario.copy(seed=int(rig.draws.integers(1, 1 << 30)), wheels_seed=WHEELS, **operation, **fault))
    recorded = []
    signals = mt.simulate_many(scenarios, channels=["housing_g"], target_rate_hz=KEPT_HZ)
    for scenario, channels, label in zip(scenarios, signals, labels, strict=True):
        values = rig.noisy(np.asarray(channels["housing_g"], float), KEPT_HZ, rig.snr_db + rig.draws.uniform(-3, 3))
        recorded.append((label, (values, KEPT_HZ, mt.ShaftPhase.constant(scenario.pinion_speed_hz, KEPT_HZ, values.size))))
    return recorded


def main() -> None:
    """Print how often each kind is named, of all rigs together."""
    warnings.simplefilter("ignore", mt.MeshtoneWarning)
    named: dict[str, Counter[str]] = defaultdict(Counter)
    squares: list[float] = []
    missing: list[float] = []
    for number in [int(text) for text in sys.argv[1:]] or range(8, 12):
        rig = HiddenPair(number)
        healthy = rig.healthy(16, [30, 30], rig.snr_db)
        for label, recording in asked(rig):
            answer = mt.diagnose(recording, rig.known, healthy, records=2560)
            squares.append((answer.damaged - (label != "healthy")) ** 2)
            kind = "refused" if answer.is_outside else max(answer.kinds, key=lambda kind: answer.kinds[kind]["probability"])
            named[label][kind] += 1
            if not answer.is_outside and label not in ("healthy", "missing-tooth"):
                missing.append(answer.kinds["missing-tooth"]["probability"])
        print(f"rig {number} done", file=sys.stderr, flush=True)
    columns = ["refused", "healthy", *KINDS, "several-damages"]
    print("of \\ named".ljust(18), *(column[:9].rjust(9) for column in columns))
    for label in ["healthy", *KINDS]:
        print(label.ljust(18), *(str(named[label][column]).rjust(9) for column in columns))
    right = sum(named[kind][kind] for kind in KINDS)
    answered = sum(sum(named[kind].values()) - named[kind]["refused"] for kind in KINDS)
    print(f"kinds: {right} of {answered} answered right; Brier score of damage {np.mean(squares):.3f}; mean probability of a missing tooth, of other damage {np.mean(missing):.3f}")


if __name__ == "__main__":
    main()
