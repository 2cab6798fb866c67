"""How far the lines of a bearing's defect stand out of recordings, by size of the bursts and by what is removed first.

Recordings of 10 s at 20 kS/s of a 6205 on a shaft at 30 Hz: white noise, a mesh of 17 teeth with sidebands, 20 times as strong as the noise, and bursts of a
resonance at 4.3 kHz of a given size whenever a ball passes a place of the outer race, each later than the one before by a distance that varies by 1 %.
Prints the table of the book's chapter Validation.

    python python/validation/bearing_lines.py
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from meshtone import ShaftPhase, signal

RATE_HZ, SHAFT_HZ, SECONDS, TRIALS = 20_000.0, 30.0, 10, 50
BEARING = signal.Bearing.named("6205")
FIRST = ["BPFO", "BPFI", "2 BSF"]


def recording(size: float, seed: int, phase: ShaftPhase) -> npt.NDArray[np.float64]:
    """Noise of rms 1, a mesh of rms 20, and bursts of a size."""
    random = np.random.default_rng(seed)
    angle = phase.revolutions
    passes = BEARING.defect_orders.outer_race
    times_s = np.cumsum(1 + 0.01 * random.standard_normal(int(angle[-1] * passes) - 9)) / passes / SHAFT_HZ
    bursts = np.zeros(angle.size)
    bursts[(times_s * RATE_HZ).astype(int)] = size
    since_s = np.arange(200) / RATE_HZ
    ringing = np.convolve(bursts, np.exp(-900 * since_s) * np.sin(2 * np.pi * 4300 * since_s))[: angle.size]
    mesh = 28 * np.cos(2 * np.pi * 17 * angle) * (1 + 0.3 * np.cos(2 * np.pi * angle))
    return ringing + mesh + random.standard_normal(angle.size)


def over_median(remaining: npt.NDArray[np.float64], phase: ShaftPhase) -> list[float]:
    """The first lines of BPFO, BPFI and 2 BSF in the band that the kurtogram chooses."""
    band_hz = signal.kurtogram(remaining, RATE_HZ).best(3 * SHAFT_HZ * BEARING.defect_orders.inner_race).band_hz
    spectrum = signal.squared_envelope_order_spectrum(remaining, RATE_HZ, phase, band_hz)
    lines = {line.line: line.over_median for line in signal.defect_lines(spectrum, BEARING)}
    return [lines[name] for name in FIRST]


def main() -> None:
    phase = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, int(SECONDS * RATE_HZ))
    inside = slice(1500, -1500)
    short = ShaftPhase(phase.revolutions[inside])
    print("| bursts | averages | discrete-random | prewhitening | none | other lines, averages, largest |")
    print("|---|---|---|---|---|---|")
    for size in (0.0, 0.5, 1.0, 2.0, 4.0):
        found = []
        for seed in range(TRIALS):
            raw = recording(size, seed, phase)
            random_part = signal.discrete_random_separation(raw, 3000).random[inside]
            found.append(
                [
                    over_median(signal.synchronous_residual(raw, [phase]).values, phase),
                    over_median(random_part, short),
                    over_median(signal.cepstral_prewhitening(raw), phase),
                    over_median(raw, phase),
                ]
            )
        outer = np.median(np.array(found)[:, :, 0], axis=0)
        others = np.array(found)[:, 0, 1:].max()
        print(f"| {size:g} | " + " | ".join(f"{value:.1f}" for value in outer) + f" | {others:.1f} |")


if __name__ == "__main__":
    main()
