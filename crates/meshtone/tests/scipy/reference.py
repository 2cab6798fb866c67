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


def bearings(out, random):
    """Squared envelope of a band, its spectrum, spectral kurtosis and prewhitening, of an even and an odd number of values."""
    for n in (1000, 999):
        x = random.standard_normal(n) + 0.3
        hz = fft.rfftfreq(n, 1 / 1000.0)
        squares = np.abs(signal.hilbert(fft.irfft(np.where((hz >= 100) & (hz <= 300), fft.rfft(x), 0), n))) ** 2
        _, power = signal.periodogram(squares, window="hann", detrend="constant", scaling="spectrum")
        blocks = signal.spectrogram(x, window="hann", nperseg=64, noverlap=48, detrend=False, mode="complex")[2]
        # Of a real Gaussian value the fourth moment is 3 times the squared second one, of a complex one 2 times.
        kurtosis = np.mean(np.abs(blocks) ** 4, axis=1) / np.mean(np.abs(blocks) ** 2, axis=1) ** 2 - 2
        kurtosis[[0, -1]] -= 1
        white = fft.irfft(np.exp(1j * np.angle(fft.rfft(x))), n)
        case = f"bearing_{n}"
        out[f"{case}/signal"], out[f"{case}/squares"], out[f"{case}/kurtosis"] = x, squares, kurtosis
        # Power of a sine is half its amplitude squared; frequency 0 and the Nyquist frequency have no mirror image, and count as if they had.
        images = np.full(len(power), 2.0)
        images[0] = 4
        if n % 2 == 0:
            images[-1] = 4
        out[f"{case}/spectrum"] = np.sqrt(images * power)
        out[f"{case}/white"] = white / np.sqrt(np.mean(white**2))


def kurtogram(out, random):
    """Kurtosis of the complex envelope at the rate of its band, in bands with flanks of a cosine."""
    n = 4800
    x = random.standard_normal(n) * (1 + 4 * (np.arange(n) % 400 < 40))
    lines = fft.rfft(x)
    lines[0] = 0
    values = []
    for bands in (1, 2, 3, 4, 6, 8):
        width = n / 2 / bands
        length = int(1.25 * width) + 2
        while length % 2 or fft.next_fast_len(length, real=True) != length:
            length += 1
        for band in range(bands):
            place = np.arange(n // 2 + 1) / width - band
            gain = np.sin(np.pi / 4 * (1 + np.clip(place / 0.125, -1, 1))) if band > 0 else 1.0
            gain = gain * (np.sin(np.pi / 4 * (1 + np.clip((1 - place) / 0.125, -1, 1))) if band + 1 < bands else 1.0)
            inside = (place >= -0.125) & (place <= 1.125)
            square = np.abs(fft.ifft((lines * gain)[inside], length)) ** 2
            values.append(np.mean(square**2) / np.mean(square) ** 2 - 2)
    out["kurtogram/signal"], out["kurtogram/kurtosis"] = x, np.array(values)


def random_part(out, random):
    """Discrete-random separation by cross spectra of a signal and itself a delay earlier."""
    n, block, delay = 6000, 256, 300
    x = random.standard_normal(n) + 2 * np.sin(0.3 * np.arange(n)) + np.sin(1.7 * np.arange(n))
    shared = dict(window="hann", nperseg=block, noverlap=block // 2, detrend=False)
    _, cross = signal.csd(x[:-delay], x[delay:], **shared)
    _, power = signal.welch(x[:-delay], **shared)
    gain = np.minimum(np.abs(cross) / power, 1)
    response = fft.irfft(gain, block)
    # Lags from -127 to 128.
    taps = np.roll(response, block // 2 - 1)
    discrete = signal.oaconvolve(x, taps)[block // 2 - 1 : block // 2 - 1 + n]
    out["random/signal"], out["random/discrete"], out["random/random"] = x, discrete, x - discrete


def velocity(out, random):
    """Rms of the velocity from 10 to 1000 Hz, by Welch's method."""
    x = random.standard_normal(60_000)
    hz, density = signal.welch(x, 4000.0, window="hann", nperseg=16_000, noverlap=8_000, detrend="constant")
    inside = (hz >= 10) & (hz <= 1000)
    square = np.sum(density[inside] / (2 * np.pi * hz[inside]) ** 2) * hz[1]
    out["velocity/signal"], out["velocity/rms"] = x, np.array([1000 * np.sqrt(square)])


def main():
    out = {}
    random = np.random.default_rng(20240501)
    for case in (resampling, interpolation, speed, spectra, separation, moments, bearings, kurtogram, random_part, velocity):
        case(out, random)
    # The names of files in a zip: no folders needed.
    np.savez(sys.argv[1], **{name.replace("/", "."): values for name, values in out.items()})


if __name__ == "__main__":
    main()
