"""Prints how far records at several sampling rates are from those at 2 MS/s: the table of the chapter "Validation"."""

import meshtone as mt
import numpy as np

RATES_HZ = (50e3, 75e3, 100e3, 200e3)
FINE_HZ = 2e6
HIGHEST_HZ = 10e3

DAMAGES = {
    "healthy": None,
    "chipped": mt.ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=3),
    "missing tooth": mt.MissingTooth(),
}
# Teeth of pinion and gear, torque in N m, speed in Hz.
PAIRS = (
    (17, 38, 10, 40),
    (18, 35, 10, 40),
    (20, 40, 10, 40),
    (21, 33, 10, 40),
    (30, 31, 10, 25),
    (17, 38, 100, 40),
    (17, 38, 1, 40),
)


def lines(signal: np.ndarray, rate_hz: float) -> np.ndarray:
    """Lines of the spectrum below 10 kHz: kept signals are whole periods, so that the lines are the same at every rate."""
    return np.fft.rfft(signal)[1 : int(HIGHEST_HZ * len(signal) / rate_hz)] / len(signal)


def spectra(scenario: mt.Scenario, rate_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Spectra of the vertical acceleration and of the mesh force."""
    simulation = mt.simulate(scenario.copy(sampling_rate_hz=rate_hz))
    rate_hz = simulation.sampling_rate_hz
    return lines(simulation.vertical_g, rate_hz), lines(simulation.mesh_force_n, rate_hz)


def error_percent(coarse: np.ndarray, fine: np.ndarray) -> float:
    """Rms of the difference over the rms, in per cent."""
    count = min(len(coarse), len(fine))
    return float(100 * np.linalg.norm(coarse[:count] - fine[:count]) / np.linalg.norm(fine[:count]))


for pinion_teeth, gear_teeth, torque_nm, speed_hz in PAIRS:
    for name, damage in DAMAGES.items():
        scenario = mt.Scenario(
            module_mm=3,
            pinion_teeth=pinion_teeth,
            gear_teeth=gear_teeth,
            face_width_mm=15,
            pinion_speed_hz=speed_hz,
            brake_torque_nm=torque_nm,
            din_grade=7,
            fault=damage,
        )
        fine = spectra(scenario, FINE_HZ)
        errors = (map(error_percent, spectra(scenario, rate_hz), fine) for rate_hz in RATES_HZ)
        cells = " | ".join(" / ".join(f"{error:.2g}" for error in pair) for pair in errors)
        print(f"| {pinion_teeth}/{gear_teeth}, {torque_nm} N m, {speed_hz} Hz, {name} | {cells} |")
