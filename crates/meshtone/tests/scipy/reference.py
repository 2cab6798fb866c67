"""Inputs and what SciPy makes of them, for tests/all/signal_scipy.rs.

Usage: python reference.py OUTPUT.npz

`cargo xtask test` runs this in a virtual environment of its own; nothing of it is stored in the project. Every array's name
is `case/name`. Numbers are drawn from a fixed seed.
"""

import sys

import numpy as np
from scipy import fft, integrate, interpolate, signal, stats

RATIOS = [(3, 2), (2, 5), (1, 7), (64, 15), (125, 1292)]
EDGES = {"zero": "constant", "reflect": "reflect", "periodic": "wrap"}


def resampling(out, random):
    """Polyphase resampling with SciPy's default filter, and that filter."""
    for up, down in RATIOS:
        # Longer than the filter, which is 10 samples of the lower rate on each side, so that edges fold once only.
        x = random.standard_normal(max(301, 24 * down // up + 5))
        case = f"resample_{up}_{down}"
        out[f"{case}/signal"] = x
        rate = max(up, down)
        out[f"{case}/taps"] = up * signal.firwin(20 * rate + 1, 1 / rate, window=("kaiser", 5.0))
        for edge, padtype in EDGES.items():
            out[f"{case}/{edge}"] = signal.resample_poly(x, up, down, padtype=padtype)


def interpolation(out, random):
    """PCHIP over samples, and through pulses at uneven times."""
    x = random.standard_normal(200)
    places = np.sort(random.uniform(0, 199, 1000))
    out["pchip/signal"], out["pchip/places"] = x, places
    out["pchip/values"] = interpolate.PchipInterpolator(np.arange(200), x)(places)

    times = 0.0123 + np.cumsum(random.uniform(0.04, 0.06, 60))
    rate, samples = 1000.0, 2500
    first, last = int(np.ceil(times[0] * rate)), min(int(np.floor(times[-1] * rate)), samples - 1)
    curve = interpolate.PchipInterpolator(times, np.arange(60) / 2)
    out["pulses/times"] = times
    out["pulses/revolutions"] = curve(np.arange(first, last + 1) / rate)


def speed(out, random):
    """Integration of a speed that is known at every sample."""
    hz = 20 + random.uniform(-1, 1, 3000)
    out["speed/hz"] = hz
    out["speed/revolutions"] = integrate.cumulative_trapezoid(hz, dx=1 / 1000.0, initial=0)


def spectra(out, random):
    """Analytic signal, envelope and amplitude spectra, of an even and an odd number of values."""
    for n in (1024, 999):
        x = random.standard_normal(n) + 0.3
        analytic = signal.hilbert(x)
        envelope = np.abs(analytic)
        out[f"spectra_{n}/signal"] = x
        out[f"spectra_{n}/hilbert"] = analytic.imag
        out[f"spectra_{n}/envelope"] = envelope
        for name, values in (("spectrum", x), ("envelope_spectrum", envelope)):
            # Power of a sine is half its amplitude squared; the mean and the Nyquist frequency have no mirror image.
            _, power = signal.periodogram(values, window="boxcar", detrend=False, scaling="spectrum")
            images = np.full(len(power), 2.0)
            images[0] = 1
            if n % 2 == 0:
                images[-1] = 1
            out[f"spectra_{n}/{name}"] = np.sqrt(images * power)


def separation(out, random):
    """Separation of an average of a wheel with 19 teeth by masks over its spectrum."""
    x = random.standard_normal(512)
    order = np.arange(257)
    shaft = (order >= 1) & (order <= 7)
    mesh = (order % 19 == 0) & (order > 0)
    near = np.zeros(257, bool)
    for harmonic in order[mesh]:
        near |= np.abs(order - harmonic) <= 2
    part = lambda chosen: fft.irfft(np.where(chosen, fft.rfft(x), 0), 512)
    out["separation/average"] = x
    out["separation/regular"] = part(shaft | near)
    out["separation/residual"] = part(~(shaft | mesh))
    out["separation/difference"] = part(~(shaft | near))


def moments(out, random):
    """Moments of a skewed distribution."""
    x = random.gamma(2.0, 1.5, 5000) - 1
    variance = stats.moment(x, 2)
    out["moments/signal"] = x
    out["moments/values"] = np.array(
        [
            np.sqrt(np.mean(x**2)),
            np.ptp(x),
            np.max(np.abs(x)) / np.sqrt(np.mean(x**2)),
            stats.skew(x),
            stats.kurtosis(x, fisher=False),
            stats.moment(x, 6) / variance**3,
            stats.moment(x, 8) / variance**4,
            np.std(x),
        ]
    )
    records = random.standard_normal((5, 400)) * np.arange(1, 6)[:, None]
    so_far = np.cumsum(stats.moment(records, 2, axis=1)) / np.arange(1, 6)
    out["na4/records"] = records.ravel()
    out["na4/values"] = stats.moment(records, 4, axis=1) / so_far**2


def main():
    out = {}
    random = np.random.default_rng(20240501)
    for case in (resampling, interpolation, speed, spectra, separation, moments):
        case(out, random)
    # The names of files in a zip: no folders needed.
    np.savez(sys.argv[1], **{name.replace("/", "."): values for name, values in out.items()})


if __name__ == "__main__":
    main()
