"""How rms and kurtosis of the difference signal grow with a broken tooth.

The gear's first tooth loses its tip over the whole width, up to 4 mm, beside a chip of one corner: a line for each width of the
chip, all on the same wheels. Up to 2 mm the fault hides behind the deviations; then contact is lost.
"""

import sys
from pathlib import Path

import numpy as np

import meshtone as mt
from meshtone.plotting import plot_indicators

healthy = mt.examples.healthy()
cases = [
    mt.ToothBreakage(chip_height_mm=5, chip_width_mm=chip_width_mm, tip_loss_mm=tip_loss_mm)
    for chip_width_mm in (3.0, 6.0, 9.0, 12.0)
    for tip_loss_mm in np.linspace(0, 4, 17).tolist()
]
results = mt.simulate_many([healthy.copy(fault=case) for case in cases], channels=["vertical_g"])

gear_hz = healthy.pinion_speed_hz * healthy.pinion_teeth / healthy.gear_teeth
table: dict[str, list[float]] = {"tip loss (mm)": [], "chip width (mm)": [], "rms (g)": [], "kurtosis (-)": []}
for case, result in zip(cases, results):
    phase = mt.ShaftPhase.constant(gear_hz, result.sampling_rate_hz, result.vertical_g.size)
    indicators = mt.process_channel(result.vertical_g, phase, healthy.gear_teeth).indicators
    table["tip loss (mm)"].append(case.tip_loss_mm or 0.0)
    table["chip width (mm)"].append(case.chip_width_mm or 0.0)
    table["rms (g)"].append(indicators["difference_rms"])
    table["kurtosis (-)"].append(indicators["difference_kurtosis"])

figure = plot_indicators(table, x="tip loss (mm)", by="chip width (mm)")
figure.suptitle("Difference signal of the gear, vertical")
figure.savefig(Path(*sys.argv[1:2], "python_severity.png"), dpi=100)
