"""The chain on signals with known answers."""

from __future__ import annotations

import copy
import pickle
import re

import numpy as np
import numpy.typing as npt
import pytest

import meshtone
from meshtone import ShaftPhase, signal

RATE_HZ, SHAFT_HZ, TEETH = 10_000.0, 20.0, 19
Array = npt.NDArray[np.float64]


def vibration(samples: int = 40_000) -> Array:
    time_s = np.arange(samples) / RATE_HZ
    return np.cos(2 * np.pi * SHAFT_HZ * TEETH * time_s) + 0.1 * np.cos(2 * np.pi * 253 * time_s)


def test_phases_agree() -> None:
    tone = vibration()
    constant = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size)
    pulses = ShaftPhase.from_pulses(np.arange(0, 4, 0.05), 1, RATE_HZ, tone.size, stated_speed_hz=SHAFT_HZ)
    profile = ShaftPhase.from_speed_profile([0, 4], [SHAFT_HZ, SHAFT_HZ], RATE_HZ, tone.size)
    speeds = ShaftPhase.from_speed_samples(np.full(tone.size, SHAFT_HZ), RATE_HZ)
    mesh = ShaftPhase.from_mesh_tone(tone, RATE_HZ, TEETH, 20.2)
    for phase in (constant, pulses, profile, speeds, mesh):
        assert phase.mean_speed_hz(RATE_HZ) == pytest.approx(SHAFT_HZ, rel=1e-5)
        assert phase.warnings == [] or phase is mesh
    assert np.diff(constant.of_mate(19, 38).revolutions).mean() == pytest.approx(SHAFT_HZ / RATE_HZ / 2)
    same = ShaftPhase(constant.revolutions)
    assert np.array_equal(same.revolutions, constant.revolutions)
    assert "80.00 revolutions" in repr(ShaftPhase(np.arange(40_001) / 500))


def test_an_order_map_of_a_run_up() -> None:
    """Against a Fourier sum of one of its parts."""
    phase = ShaftPhase.from_speed_profile([0, 5], [5, 25], RATE_HZ, 50_000)
    signal_g = 2 * np.cos(2 * np.pi * TEETH * phase.revolutions) + 0.5 * np.cos(2 * np.pi * (TEETH + 2) * phase.revolutions)
    order_map = signal.order_map(signal_g, phase, RATE_HZ, revolutions=4, highest_order=40)
    assert order_map.amplitude.shape == (order_map.time_s.size, order_map.orders.size) == (order_map.speed_hz.size, 161)
    assert order_map.orders[76] == TEETH and order_map.revolutions == 4
    assert order_map.amplitude[:, 76] == pytest.approx(2, abs=1e-3) and order_map.amplitude[:, 84] == pytest.approx(0.5, abs=1e-3)
    assert np.delete(order_map.amplitude, [75, 76, 77, 83, 84, 85], axis=1).max() < 1e-3
    middles_rev = 5 * order_map.time_s + 2 * order_map.time_s**2
    from_s, until_s = ((np.sqrt(25 + 8 * (middles_rev + by)) - 5) / 4 for by in (-2, 2))
    assert order_map.speed_hz == pytest.approx(4 / (until_s - from_s), rel=1e-4)
    middle = np.interp(order_map.time_s[7], np.arange(50_000) / RATE_HZ, phase.revolutions)
    turned = middle - 2 + np.arange(2048) / 512
    values = np.interp(turned, phase.revolutions, signal_g) * np.hanning(2049)[:-1]
    line = 4 * np.abs(np.sum(values * np.exp(-2j * np.pi * 19.25 * turned))) / 2048
    assert order_map.amplitude[7, 77] == pytest.approx(line, rel=0.01)
    with pytest.raises(ValueError, match="revolutions"):
        signal.order_map(signal_g, phase, RATE_HZ, revolutions=1000)
    with pytest.raises(ValueError, match="highest_order = 0"):
        signal.order_map(signal_g, phase, RATE_HZ, highest_order=0)


def test_tachometer() -> None:
    time_s = np.arange(20_000) / RATE_HZ
    waveform = np.where((time_s * SHAFT_HZ) % 1 < 0.2, 5.0, 0.0)
    rising = signal.tachometer_pulses(waveform, RATE_HZ)
    falling = signal.tachometer_pulses(waveform, RATE_HZ, threshold=2.5, hysteresis=1.0, edge="falling")
    assert np.allclose(np.diff(rising), 0.05, atol=1e-9)
    assert falling[0] == pytest.approx(0.01, abs=1e-4)
    with_gap = np.delete(rising, 7)
    mended, warnings = signal.repair_pulses(with_gap)
    assert mended.size == rising.size and len(warnings) == 1
    with pytest.raises(ValueError, match="edge = 'up'"):
        signal.tachometer_pulses(waveform, RATE_HZ, edge="up")  # type: ignore[arg-type]


def test_steps_are_the_chain() -> None:
    tone = vibration()
    phase = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size)
    record = signal.process_channel(tone, phase, TEETH, name="bearing")
    angular = signal.angular_resample(tone, phase)
    average = signal.synchronous_average(angular)
    parts = signal.separate(average, TEETH)
    assert np.allclose(average, record.average)
    assert np.allclose(parts.regular, record.regular)
    assert np.allclose(parts.residual, record.residual)
    assert np.allclose(parts.difference, record.difference)
    assert np.allclose(signal.envelope(parts.difference), record.envelope)
    assert np.allclose(signal.order_spectrum(average), record.order_spectrum)
    assert np.allclose(signal.envelope_spectrum(parts.difference), record.envelope_spectrum, atol=1e-12)
    assert record.indicators["fm0"] == pytest.approx(signal.fm0(average, TEETH))
    assert record.indicators["energy_ratio"] == pytest.approx(signal.energy_ratio(parts.difference, parts.regular))
    assert record.indicators["sideband_level_factor"] == pytest.approx(signal.sideband_level_factor(average, TEETH))
    assert record.nyquist_order > TEETH and record.warnings == []
    assert "bearing" in repr(record)


def test_moments_against_numpy() -> None:
    values = np.random.default_rng(1).gamma(2.0, size=5000)
    centred = values - values.mean()
    second = np.mean(centred**2)
    for ours, order in ((signal.fm4, 4), (signal.m6a, 6), (signal.m8a, 8)):
        assert ours(values) == pytest.approx(np.mean(centred**order) / second ** (order / 2), rel=1e-10)
    statistics = signal.statistics(values)
    assert statistics["rms"] == pytest.approx(np.sqrt(np.mean(values**2)))
    assert statistics["peak_to_peak"] == pytest.approx(np.ptp(values))
    assert statistics["skewness"] == pytest.approx(np.mean(centred**3) / second**1.5)
    assert statistics["kurtosis"] == pytest.approx(np.mean(centred**4) / second**2)


def test_na4_golden() -> None:
    rng = np.random.default_rng(2)
    residuals = [rng.normal(size=1000) * (1 + k / 3) for k in range(4)]
    expected = []
    for k in range(4):
        so_far = np.mean([np.var(residual) for residual in residuals[: k + 1]])
        centred = residuals[k] - residuals[k].mean()
        expected.append(np.mean(centred**4) / so_far**2)
    assert signal.na4(residuals) == pytest.approx(expected, rel=1e-10)
    phases = [ShaftPhase.constant(SHAFT_HZ, RATE_HZ, 40_000)] * 2
    first, second = signal.process_series([vibration(), 2 * vibration()], phases, TEETH)
    assert second.indicators["na4"] != pytest.approx(first.indicators["na4"])


def test_resample() -> None:
    time_s = np.arange(10_000) / RATE_HZ
    tone = np.cos(2 * np.pi * 50 * time_s)
    half = signal.resample(tone, RATE_HZ, RATE_HZ / 2, edge="periodic")
    assert half.size == 5000
    assert np.allclose(half, tone[::2], atol=2e-3)
    with pytest.raises(ValueError, match="sample 7 is nan; 1 of 10000 samples are not finite numbers"):
        signal.resample(np.where(np.arange(10_000) == 7, np.nan, tone), RATE_HZ, 5000)
    with pytest.raises(ValueError, match="edge = 'mirror'"):
        signal.resample(tone, RATE_HZ, 5000, edge="mirror")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.full(20_000, np.nan), "sample 0"),
        (np.ones(20_000), "constant"),
        (vibration(700), "revolution"),
        (np.ones((3, 4)), r"shape \(3, 4\)"),
    ],
)
def test_signals_that_are_refused(values: Array, message: str) -> None:
    phase = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, values.size)
    with pytest.raises(ValueError, match=message):
        signal.process_channel(values, phase, TEETH)


def test_arguments_that_are_refused() -> None:
    tone = vibration()
    phase = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size)
    with pytest.raises(TypeError, match="phase: must be a ShaftPhase, not float"):
        signal.process_channel(tone, SHAFT_HZ, TEETH)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a list of one ShaftPhase for each signal"):
        signal.process_series([tone], phase, TEETH)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a signal is real"):
        signal.process_channel(tone * 1j, phase, TEETH)
    with pytest.raises(TypeError, match=r"teeth = 19\.5: must be a whole number"):
        signal.process_channel(tone, phase, 19.5)  # type: ignore[arg-type]
    # Whole numbers that were computed are whole numbers.
    assert signal.process_channel(tone, phase, np.float64(19), sidebands=2.0).teeth == 19  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="sidebands = -1: must be at least 0"):
        signal.process_channel(tone, phase, TEETH, sidebands=-1)
    with pytest.raises(ValueError, match="samples = -5: must be at least 0"):
        ShaftPhase.constant(SHAFT_HZ, RATE_HZ, -5)
    with pytest.raises(ValueError, match="one dimension"):
        signal.na4(tone)  # type: ignore[arg-type]


def test_settings() -> None:
    tone = vibration()
    phase = ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size)
    assert signal.process_channel(tone.astype(np.float32), phase, TEETH, sidebands=1, shaft_orders=[1]).revolutions == 79
    with pytest.raises(ValueError, match="interpolation = 'linear'"):
        signal.angular_resample(tone, phase, interpolation="linear")  # type: ignore[arg-type]
    assert signal.angular_resample(tone, phase, points_per_revolution=256).points_per_revolution == 256


def test_recording_is_processed_like_the_simulation(tmp_path: object, broken: meshtone.Simulation) -> None:
    phase = ShaftPhase(broken.process().revolutions * np.linspace(0, 1, broken.vertical_g.size + 1)[:-1])
    record = signal.process_channel(broken.vertical_g, phase, 38)
    ours = broken.process()
    assert record.indicators["average_rms"] == pytest.approx(ours.indicators["average_rms"], rel=0.05)


def test_average_and_difference_at_once_are_those_of_the_chain() -> None:
    time_s = np.arange(20_000) / 1e4
    vibration = np.cos(2 * np.pi * 20 * TEETH * time_s) + 0.1 * np.cos(2 * np.pi * 20 * 7.5 * time_s)
    pulses_s = np.arange(0, 2, 1 / 40)
    phase = signal.ShaftPhase.from_pulses(pulses_s, 2, 1e4, vibration.size)
    record = signal.process_channel(vibration, phase, TEETH)
    assert np.array_equal(signal.tsa(vibration, 1e4, pulses_s, 2), record.average)
    with pytest.raises(TypeError, match=r"pulses_s = 17.9: must be times .* np.arange\(0, \d+ / 10000, 1 / 17.9\)"):
        signal.tsa(vibration, 1e4, 17.9)
    assert np.array_equal(signal.difference(vibration, 1e4, pulses_s, TEETH, 2), record.difference)
    with pytest.raises(ValueError, match="a signal has no masked values"):
        signal.tsa(np.ma.masked_greater(vibration, 0.9), 1e4, pulses_s, 2)


def test_records_and_phases_pickle_and_cannot_be_written_to() -> None:
    time_s = np.arange(20_000) / 1e4
    pulses_s = np.delete(np.arange(0, 2, 1 / 20), 7)
    with pytest.warns(meshtone.MeshtoneWarning, match="missing"):
        phase = signal.ShaftPhase.from_pulses(pulses_s, 1, 1e4, time_s.size)
    record = signal.process_channel(np.cos(2 * np.pi * 20 * TEETH * time_s) + 0.1 * np.cos(900 * time_s), phase, TEETH, name="a")
    for again in (pickle.loads(pickle.dumps(record)), copy.deepcopy(record)):
        assert (again.teeth, again.name, again.revolutions, again.warnings) == (TEETH, "a", record.revolutions, record.warnings)
        assert np.array_equal(again.difference, record.difference)
        np.testing.assert_equal(dict(again.indicators), dict(record.indicators))
        assert repr(again) == repr(record)
    for again in (pickle.loads(pickle.dumps(phase)), copy.deepcopy(phase)):
        assert np.array_equal(again.revolutions, phase.revolutions)
        assert (again.first_sample, again.warnings) == (phase.first_sample, phase.warnings)
        assert len(again.warnings) == 1
    for values in (record.average, record.envelope_spectrum, phase.revolutions):
        with pytest.raises(ValueError, match="read-only"):
            values *= 2


def test_a_transformer_of_scikit_learn() -> None:
    pytest.importorskip("sklearn")
    from sklearn.base import clone
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from meshtone.sklearn import IndicatorTransformer

    time_s = np.arange(10_000) / 1e4
    records = np.cos(2 * np.pi * 20 * TEETH * time_s) + 0.1 * np.random.default_rng(1).standard_normal((4, time_s.size))
    chain = clone(IndicatorTransformer(1e4, 20, TEETH))
    table = chain.fit(records).transform(records)
    phase = signal.ShaftPhase.constant(20, 1e4, time_s.size)
    defined = {name: value for name, value in signal.process_channel(records[0], phase, TEETH).indicators.items() if np.isfinite(value)}
    assert table[0].tolist() == list(defined.values()) and len(defined) > 60
    assert list(chain.get_feature_names_out()) == list(defined)
    pipeline = make_pipeline(IndicatorTransformer(1e4, 20, TEETH, indicators=["fm4"]), StandardScaler())
    assert pipeline.fit_transform(records).shape == (4, 1)
    with pytest.raises(ValueError, match="there is no 'fm5'"):
        chain.set_params(indicators=["fm5"]).fit(records)
    with pytest.raises(ValueError, match="Expected 2D array, got 1D array"):
        chain.fit(records[0])
    with pytest.raises(ValueError, match="X has 5000 features, but IndicatorTransformer is expecting 10000"):
        pipeline.transform(records[:, :5000])


def test_conventions_of_scikit_learn() -> None:
    pytest.importorskip("sklearn")
    from sklearn.utils.estimator_checks import check_estimator

    from meshtone.sklearn import IndicatorTransformer

    checks = check_estimator(IndicatorTransformer(1e4, 20, TEETH), on_fail=None, on_skip=None)
    failed = [check for check in checks if check["status"] == "failed"]
    # Most checks give records of a few samples, of which there are no indicators.
    causes = [(str(check["exception"]), str(check["exception"].__cause__)) for check in failed]
    short = re.compile("at least 2 are needed|samples with a phase: there are 1|1 sample|when passing negative input")
    assert [cause for cause in causes if not any(map(short.search, cause))] == [] and len(checks) - len(failed) >= 20


def test_an_indicator_that_there_is_not() -> None:
    tone = vibration()
    record = signal.process_channel(tone, ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size), TEETH)
    assert isinstance(record.indicators, signal.Indicators) and len(record.indicators) == 86
    with pytest.raises(KeyError, match="there is no indicator 'FM4'; did you mean 'fm4'[?] There are average_rms, .*sideband_level_factor"):
        _ = record.indicators["FM4"]
    with pytest.raises(KeyError, match="did you mean 'average_kurtosis' or .* or 'envelope_kurtosis'"):
        _ = record.indicators["kurtosis"]
    with pytest.raises(KeyError, match="there is no indicator 'xyz'; there are average_rms"):
        _ = record.indicators["xyz"]
    assert record.indicators.get("FM4") is None
    np.testing.assert_equal(dict(pickle.loads(pickle.dumps(record)).indicators), dict(record.indicators))


def test_every_indicator_is_documented() -> None:
    """With its unit, what it refuses, and where it is from; of octaves, harmonics and sidebands one of each name."""

    def without_numbers(text: str) -> str:
        return re.sub(r"(octave|harmonic|minus|plus)_(\d+|half)", r"\1", text)

    of_gears = (signal.fm0, signal.fm4, signal.m6a, signal.m8a, signal.na4, signal.energy_ratio, signal.sideband_level_factor)
    text = without_numbers(signal.Indicators.__doc__ or "")
    tone = vibration()
    record = signal.process_channel(tone, ShaftPhase.constant(SHAFT_HZ, RATE_HZ, tone.size), TEETH)
    for name in map(without_numbers, record.indicators):
        part, _, shape = name.partition("_")
        assert f"``{name}``" in text or (f"``{part}``" in text and f"``…_{shape}``" in text), name
    functions = (*of_gears, signal.statistics, signal.envelope, signal.envelope_spectrum, signal.separate, signal.tsa)
    for function in functions:
        documented = function.__doc__ or ""
        assert all(heading in documented for heading in ("unit", "shape", "Returns", "Raises", "Notes", "Examples")), function.__name__


def ringing(bearing: signal.Bearing, phase: ShaftPhase, rate_hz: float) -> Array:
    """A resonance at 4.3 kHz that rings whenever a ball passes a place of the outer race, where balls slip."""
    random = np.random.default_rng(1)
    count = int(phase.revolutions[-1] * bearing.defect_orders.outer_race)
    angles = np.cumsum(1 + 0.01 * random.standard_normal(count)) / bearing.defect_orders.outer_race
    starts_s = np.interp(angles, phase.revolutions, np.arange(phase.revolutions.size) / rate_hz)
    since_s = np.arange(200) / rate_hz
    bursts = np.zeros(phase.revolutions.size)
    np.add.at(bursts, (starts_s * rate_hz).astype(int), 1.0)
    return np.convolve(bursts, np.exp(-900 * since_s) * np.sin(2 * np.pi * 4300 * since_s))[: bursts.size]


def test_a_bearing_behind_a_mesh() -> None:
    rate_hz, bearing = 20_000.0, signal.Bearing(9, 7.94, 39.04)
    assert bearing == signal.NAMED_BEARINGS["6205"] and "Case Western" in str(signal.NAMED_BEARINGS["6205"].source)
    assert bearing.defect_orders.element_spin == pytest.approx(2.35675, abs=1e-5)
    phase = ShaftPhase.from_speed_profile([0, 5], [28, 32], rate_hz, 100_000)
    noise = np.random.default_rng(2).standard_normal(phase.revolutions.size)
    vibration = ringing(bearing, phase, rate_hz) + 5 * np.cos(2 * np.pi * 17 * phase.revolutions) + 0.1 * noise
    residual = signal.synchronous_residual(vibration, [phase])
    assert residual.first_sample == 0 and residual.values.std() < 0.1 * vibration.std()
    kurtogram = signal.kurtogram(residual.values, rate_hz)
    assert [level.size for level in kurtogram.levels[:6]] == [1, 2, 3, 4, 6, 8]
    best = kurtogram.best(500)
    assert best.band_hz[0] < 4300 < best.band_hz[1] and best.kurtosis > 1
    assert kurtogram.best(1e9).band_hz == (0, 10_000)
    spectrum = signal.squared_envelope_order_spectrum(residual.values, rate_hz, phase, best.band_hz)
    lines = {line.line: line for line in signal.defect_lines(spectrum, bearing)}
    assert lines["BPFO"].over_median > 30 > 6 > lines["BPFI"].over_median
    assert lines["BPFO"].found_order == pytest.approx(3.585, rel=0.01) and lines["BPFO"].part == "outer race"
    squares = signal.squared_envelope(residual.values, rate_hz, best.band_hz)
    over_hz = signal.squared_envelope_spectrum(residual.values, rate_hz, best.band_hz)
    assert squares.min() >= 0 and over_hz.places[-1] == pytest.approx(rate_hz / 2)
    constant = signal.defect_lines(over_hz, bearing, shaft=30.0)
    assert [line.line for line in constant] == list(lines)


def test_bearings_on_the_shafts_of_a_gearbox() -> None:
    gearbox = meshtone.Scenario.from_toml(meshtone.gearbox_template())
    phase = ShaftPhase.constant(30.0, 20_000.0, 60_000)
    bearing = signal.Bearing.named("ER-10K")
    output = phase.revolutions / 5  # 32/96 and 48/80 teeth
    since_s = (output * bearing.defect_orders.outer_race % 1) / (6 * bearing.defect_orders.outer_race)
    ringing = np.exp(-800 * since_s) * np.sin(2 * np.pi * 4000 * since_s)
    tone = np.cos(2 * np.pi * 32 * phase.revolutions)
    recording = signal.TrainRecording(ringing + tone, phase, 20_000.0, gearbox)
    found = recording.bearings([(bearing, "output"), bearing], separation="none", band_hz=(3000, 5000))
    assert found.band_hz == (3000, 5000) and found.kurtosis is None and found.warnings == []
    # The line of the input is at the fifth harmonic of that of the output.
    strength = [{line.line: line.amplitude for line in lines}["BPFO"] for lines in found.lines]
    assert strength[0] > strength[1] > 0
    assert recording.bearings([bearing], band_hz="kurtogram").kurtosis is not None
    # The output turns 18 times, which is enough; in one second it is not.
    assert recording.bearings([bearing]).warnings == []
    short = ShaftPhase.constant(30.0, 20_000.0, 20_000)
    with pytest.warns(meshtone.MeshtoneWarning, match=r"6\.0 revolutions of shaft output, and an average needs at least 8: its average is not removed"):
        [warning] = signal.TrainRecording((ringing + tone)[:20_000], short, 20_000.0, gearbox).bearings([bearing]).warnings
    assert warning.code == "not-averaged" and warning.values["needed"] == 8
    with pytest.raises(ValueError, match="shaft = 'shaft7': must be one of input, middle, output"):
        recording.bearings([(bearing, "shaft7")])
    with pytest.raises(ValueError, match="separation = 'all': must be one of averages"):
        recording.bearings([bearing], separation="all")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="bearings: missing, and the machine has no rolling bearing"):
        recording.bearings()
    place = 'shaft = "output"\nat = 1.0\n'
    machine = meshtone.Scenario.from_toml(meshtone.gearbox_template().replace(place, f'{place}kind = "ball"\nname = "ER-10K"\n'))
    assert machine != gearbox
    found = signal.TrainRecording(ringing + tone, phase, 20_000.0, machine).bearings(separation="none", band_hz=(3000, 5000))
    assert found.bearings == [(bearing, "output")]


def test_verdicts_name_the_race_or_what_does_not_fit() -> None:
    phase = ShaftPhase.constant(30.0, 20_000.0, 80_000)
    bearing = signal.Bearing.named("6205")
    since_s = (phase.revolutions * bearing.defect_orders.outer_race % 1) / (30 * bearing.defect_orders.outer_race)
    noise = np.random.default_rng(1).standard_normal(since_s.size)
    ringing = 2 * np.exp(-800 * since_s) * np.sin(2 * np.pi * 4000 * since_s) + noise
    judged = signal.TrainRecording(ringing, phase, 20_000.0).bearings([bearing])
    [of] = judged.verdicts
    assert of.verdict == of.races[0].race == "outer race" and "false alarm below 1 in 100" in of.in_words
    assert of.races[0].is_detected and of.races[0].false_alarm_probability == 0.01 and abs(of.races[0].slip) < 0.01
    assert judged.band_hz == of.races[0].band_hz and judged.kurtosis is None and of.unexplained is None
    other = signal.TrainRecording(ringing, phase, 20_000.0).bearings([signal.Bearing(8, 6.747, 28.5)]).verdicts[0]
    assert other.unexplained is not None and other.unexplained.order == pytest.approx(bearing.defect_orders.outer_race, rel=0.01)
    assert signal.TrainRecording(noise, phase, 20_000.0).bearings([bearing]).verdicts[0].verdict == "nothing"


def test_tones_noise_and_velocity() -> None:
    noise = np.random.default_rng(3).standard_normal(100_000)
    tone = 3 * np.cos(0.7 * np.arange(noise.size))
    parts = signal.discrete_random_separation(tone + noise, 512)
    assert parts.discrete + parts.random == pytest.approx(tone + noise)
    assert np.std(parts.discrete[600:-600] - tone[600:-600]) < 0.2
    assert np.sqrt(np.mean(signal.cepstral_prewhitening(tone + noise) ** 2)) == pytest.approx(1)
    assert signal.spectral_kurtosis(tone + noise, 64)[1:-1].max() < 0.5
    assert signal.velocity_rms(tone, 8_000) == pytest.approx(3000 / 5600 / np.sqrt(2), rel=1e-3)


def test_wrong_bearings_and_bands_are_refused() -> None:
    with pytest.raises(ValueError, match="element_mm is 39.04"):
        signal.Bearing(9, 39.04, 7.94)
    with pytest.raises(KeyError, match="6203, 6205, ER-10K"):
        signal.Bearing.named("6206")
    with pytest.raises(ValueError, match="half the sampling rate"):
        signal.squared_envelope(vibration(), RATE_HZ, (1000.0, 6000.0))
    with pytest.raises(ValueError, match="block_samples = 8"):
        signal.discrete_random_separation(vibration(), 8)
    with pytest.raises(ValueError, match="phases of shafts"):
        signal.synchronous_residual(vibration(), [])
    with pytest.raises(ValueError, match="more than 2000"):
        signal.velocity_rms(vibration(), 1500.0)
