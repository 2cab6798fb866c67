"""What half the step changes under the model of contact, by indicator.

The healthy example and damages of its gear, sixteen draws of the wheels each, at a step of 1/258400 s and at half of it. For
every indicator of the gear's difference signal, and for the mesh force: the change of the mean over the draws, and in brackets the largest
change of a draw, in per cent. Before that, how a motion's sensitivity shows: two simulations whose loads differ by 1e-9. Last, such a
motion: no step repeats it, and what can be compared are means over many draws, and the draws' scatter beside that of the 1e-9.

Prints the figures of the book's chapter Validation, case by case; takes some minutes:

    python python/validation/convergence.py
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import meshtone as mt

DRAWS = range(1, 17)
RATES = (2.584e5, 5.168e5)
"""(S/s) 380 and 760 samples in a tooth pitch."""

INDICATORS = {
    "rms": "difference_rms",
    "kurtosis, FM4": "difference_kurtosis",
    "crest factor": "difference_crest_factor",
    "M6A": "m6a",
    "M8A": "m8a",
    "NA4": "na4",
    "FM0": "fm0",
    "energy ratio": "energy_ratio",
    "sideband level factor": "sideband_level_factor",
    "kurtosis of the envelope": "envelope_kurtosis",
}
OF_THE_MESH = ("fluctuation of the mesh force", "largest mesh force", "time without contact")

HEALTHY = mt.examples.healthy().copy(model="contact")


def lost_tip(tip_loss_mm: float) -> mt.ToothBreakage:
    """A tip that has broken off, beside a chip."""
    return mt.ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=tip_loss_mm)


# The ground flank is the third case of the destruction experiment, 46 µm deep. With the fourth, 181 µm, the tooth touches nothing here
# and gives the numbers of the missing one.
CASES = {
    "healthy": HEALTHY,
    "tip less 3 mm": HEALTHY.copy(fault=lost_tip(3)),
    "4 mm": HEALTHY.copy(fault=lost_tip(4)),
    "5 mm": HEALTHY.copy(fault=lost_tip(5)),
    "missing tooth": HEALTHY.copy(fault=mt.MissingTooth()),
    "flank ground by 46 µm": HEALTHY.copy(fault=mt.ToothDestruction(start=0.25, end=0.871429)),
}

SENSITIVE = CASES["missing tooth"].copy(brake_torque_nm=1)
MANY_DRAWS = range(1, 129)


def measured(scenario: mt.Scenario) -> npt.NDArray[np.float64]:
    """Every indicator of one simulation."""
    simulation = mt.simulate(scenario)
    figures, indicators = simulation.contact_figures, simulation.process("vertical_g", "gear").indicators
    if figures is None:
        raise ValueError("another model than contact")
    force = [float(simulation.mesh_force_n.std()), figures.largest_force_n, figures.apart_fraction]
    return np.array([*(indicators[name] for name in INDICATORS.values()), *force])


def grown(scenario: mt.Scenario) -> float:
    """Rms of the difference of two simulations, over the rms of one, after a relative change of the load by 1e-9."""
    loads = (scenario.brake_torque_nm, scenario.brake_torque_nm * (1 + 1e-9))
    one, other = (mt.simulate(scenario.copy(brake_torque_nm=load)).vertical_g for load in loads)
    return float(np.std(one - other) / np.std(one))


def row(*cells: str) -> str:
    """A row of a table in Markdown."""
    return f"| {' | '.join(cells)} |"


def print_sensitivity() -> None:
    """How far 1e-9 of the load has grown, for each load."""
    loads_nm = (10, 5, 2, 1, 0.5, 0.2)
    print(row("", *(f"{load:g} N m" for load in loads_nm)))
    print(row(*["---"] * (len(loads_nm) + 1)))
    for name in ("healthy", "missing tooth"):
        cells = []
        for load in loads_nm:
            differences = [grown(CASES[name].copy(brake_torque_nm=load, seed=seed)) for seed in DRAWS]
            sensitive = sum(difference > 1e-3 for difference in differences)
            cells.append(f"{sensitive} of {len(differences)}; {np.median(differences):.0e}")
        print(row(name, *cells))


def print_convergence() -> None:
    """What half the step changes."""
    changes = {}
    for name, scenario in CASES.items():
        # Draw, step, indicator.
        values = np.array([[measured(scenario.copy(seed=seed, sampling_rate_hz=rate)) for rate in RATES] for seed in DRAWS])
        means = values.mean(axis=0)
        changes[name] = (means[1] / means[0] - 1, np.abs(values[:, 1] / values[:, 0] - 1).max(axis=0))
        kurtosis = np.log10(values[:, :, 1])
        print(f"{name}: log10 of the kurtosis changes by at most {np.abs(kurtosis[:, 1] - kurtosis[:, 0]).max():.4f}")
    print(row("", *CASES))
    print(row(*["---"] * (len(CASES) + 1)))
    for n, indicator in enumerate([*INDICATORS, *OF_THE_MESH]):
        print(row(indicator, *(f"{100 * of_mean[n]:+.2f} ({100 * largest[n]:.2f})" for of_mean, largest in changes.values())))


def print_statistics() -> None:
    """What half the step, and 1e-9 of the load, change in a motion that is sensitive to both."""
    others = {
        "half the step": SENSITIVE.copy(sampling_rate_hz=RATES[1]),
        "1e-9 more load": SENSITIVE.copy(brake_torque_nm=SENSITIVE.brake_torque_nm * (1 + 1e-9)),
    }
    before = np.array([measured(SENSITIVE.copy(seed=seed)) for seed in MANY_DRAWS])
    changes = []
    for scenario in others.values():
        after = np.array([measured(scenario.copy(seed=seed)) for seed in MANY_DRAWS])
        changes.append(100 * (after - before) / before.mean(axis=0))
    print(row("", *(f"{name}: mean over {len(MANY_DRAWS)} draws | scatter of a draw" for name in others)))
    print(row(*["---"] * (1 + 2 * len(others))))
    for n, indicator in enumerate([*INDICATORS, *OF_THE_MESH]):
        cells = []
        for change in changes:
            scatter = change[:, n].std(ddof=1)
            cells += [f"{change[:, n].mean():+.2f} ± {scatter / np.sqrt(len(change)):.2f}", f"{scatter:.1f}"]
        print(row(indicator, *cells))


if __name__ == "__main__":
    print_sensitivity()
    print_convergence()
    print_statistics()
