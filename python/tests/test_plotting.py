"""Figures: what they show, and that axes of one's own are used."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

import meshtone
from meshtone import plotting


def legend(ax: Axes) -> list[str]:
    """The legend's texts."""
    shown = ax.get_legend()
    assert shown is not None
    return [text.get_text() for text in shown.get_texts()]


def test_axes_of_ones_own(broken: meshtone.Simulation) -> None:
    figure, ax = plt.subplots()
    assert broken.plot_signal("horizontal_g", revolutions=1, ax=ax) is ax
    [line] = ax.lines
    assert np.size(line.get_xdata()) == 5624
    assert ax.get_ylabel() == "Horizontal acceleration (g)"
    plt.close(figure)


def test_each_figure(broken: meshtone.Simulation) -> None:
    stiffness = broken.plot_mesh_stiffness()
    assert stiffness.get_ylabel() == "Mesh stiffness (N/µm)"
    spectrum = broken.plot_spectrum()
    assert "680 Hz" in legend(spectrum)[1]
    tooth = broken.plot_tooth()
    assert "chip 5 mm high, 12 mm wide" in legend(tooth)[0]
    assert broken.plot_tooth("pinion").get_legend() is None
    panel = broken.plot()
    assert len(panel.axes) == 6
    record = broken.process().plot()
    assert len(record.axes) == 3
    assert plotting.png(panel).startswith(b"\x89PNG")
    plt.close("all")
    with pytest.raises(ValueError, match="channel = 'sideways'"):
        broken.plot_signal("sideways")
    with pytest.raises(ValueError, match="channel = 'sideways'"):
        broken.plot_spectrum("sideways")


def test_indicators() -> None:
    table = {"mm": [3, 1, 2, 1], "rms": [3.0, 1.0, 2.0, 5.0], "kurtosis": [9.0, 1.0, 4.0, 2.0], "kind": ["a", "a", "a", "b"]}
    figure = plotting.plot_indicators(table, x="mm", by="kind")
    first = figure.axes[0]
    assert [np.asarray(line.get_xdata()).tolist() for line in first.lines] == [[1, 2, 3], [1]]
    assert [ax.get_ylabel() for ax in figure.axes] == ["rms", "kurtosis"]
    # Several of one place are points beside the line through their medians; what was drawn is points alone.
    [points, medians] = plotting.plot_indicators({"mm": [1, 2, 1, 2], "rms": [1.0, 2.0, 3.0, 6.0]}, x="mm").axes[0].lines
    assert points.get_linestyle() == "None" and np.asarray(medians.get_ydata()).tolist() == [2, 4]
    drawn = np.random.default_rng(1).uniform(size=50)
    [points] = plotting.plot_indicators({"mm": drawn, "rms": drawn}, x="mm").axes[0].lines
    assert points.get_linestyle() == "None"
    # Of all of a record's indicators those that say most.
    record = meshtone.simulate(meshtone.examples.healthy().copy(sampling_rate_hz=1e4)).process()
    rows = {"mm": [1, 2], **{name: [value] * 2 for name, value in record.indicators.items()}}
    assert len(plotting.plot_indicators(rows, x="mm").axes) == 6
    plt.close("all")
    with pytest.raises(ValueError, match="no column 'severity'"):
        plotting.plot_indicators(table, x="severity")
    with pytest.raises(ValueError, match="no numeric column beside 'mm'"):
        plotting.plot_indicators({"mm": [1]}, x="mm")


def test_a_run_up_is_not_drawn_as_a_constant_speed() -> None:
    scenario = meshtone.examples.healthy().copy(speed_profile_hz={"time_s": [0, 1], "value": [20, 60]})
    run_up = meshtone.simulate(scenario)
    assert legend(run_up.plot_spectrum()) == ["spectrum"]
    [line] = run_up.plot_signal(revolutions=1).lines
    # At 20 rev/s of the pinion, and not at the nominal 40.
    assert np.ptp(np.asarray(line.get_xdata())) == pytest.approx(38 / 17 / 20, rel=0.1)
    assert "20 to 60 rev/s" in run_up.plot().get_suptitle()
    plt.close("all")
    with pytest.raises(ValueError, match="revolutions = 0"):
        run_up.plot_signal(revolutions=0)


def test_an_order_map_over_time_and_speed() -> None:
    rate_hz = 4000.0
    phase = meshtone.ShaftPhase.from_speed_profile([0, 4], [5, 15], rate_hz, 16_000)
    order_map = meshtone.signal.order_map(np.cos(2 * np.pi * 19 * phase.revolutions), phase, rate_hz)
    assert order_map.plot().get_ylabel() == "Time (s)"
    over_speed = order_map.plot(19, over="speed")
    assert over_speed.get_xticks().tolist() == [0, 19, 38, 57, 76, 95, 114] and over_speed.get_xlim()[1] < 7 * 19
    with pytest.raises(ValueError, match="over = 'angle'"):
        order_map.plot(over="angle")
    wobbling = meshtone.ShaftPhase.from_speed_profile([0, 2, 4], [5, 15, 5], rate_hz, 16_000)
    rises_and_falls = meshtone.signal.order_map(np.cos(2 * np.pi * 19 * wobbling.revolutions), wobbling, rate_hz)
    with pytest.raises(ValueError, match="must rise or fall throughout"):
        rises_and_falls.plot(over="speed")
    steady = meshtone.ShaftPhase.constant(10, rate_hz, 16_000)
    at_constant_speed = meshtone.signal.order_map(np.cos(2 * np.pi * 19 * steady.revolutions), steady, rate_hz)
    with pytest.raises(ValueError, match="must rise or fall throughout"):
        at_constant_speed.plot(over="speed")
    one_part = meshtone.signal.order_map(np.cos(2 * np.pi * 19 * steady.revolutions), steady, rate_hz, revolutions=39)
    with pytest.raises(ValueError, match="has one part"):
        one_part.plot()
    plt.close("all")


def test_what_is_lost_is_stated_in_the_tooth() -> None:
    crack = meshtone.simulate(meshtone.examples.root_crack()).plot_tooth()
    (line,) = crack.get_lines()
    assert line.get_label() == "crack 3 mm deep, over the whole face"
    assert np.allclose(line.get_xydata(), [[3.0109, 53.478], [3.0109 - 3 / 2**0.5, 53.478 - 3 / 2**0.5]], atol=1e-3)
    part = meshtone.simulate(meshtone.examples.partial_face()).plot_tooth()
    assert legend(part) == ["pit 2 mm wide, 3.17 mm long"]
    broken = meshtone.simulate(meshtone.examples.tooth_breakage()).plot_tooth()
    assert legend(broken) == ["chip 5 mm high, 12 mm wide", "tip loss 3 mm"]
    plt.close("all")


def test_damage_is_drawn_wherever_it_is() -> None:
    scenario = meshtone.examples.partial_face().copy(sampling_rate_hz=1e4)
    pit = meshtone.PartialFace(width_mm=2, start=0.2, end=0.8, depth=0.5, wheel="pinion", tooth=7)
    simulation = meshtone.simulate(scenario.copy(faults=[pit, meshtone.MissingTooth(tooth=12)]))
    pinion, gear = simulation.plot_tooth("pinion"), simulation.plot_tooth("gear")
    assert (pinion.get_title(), legend(pinion)) == ("Tooth 7 of the pinion", ["pit 2 mm wide, 2.94 mm long"])
    assert (gear.get_title(), legend(gear)) == ("Tooth 12 of the gear", ["tooth missing"])
    assert simulation.plot_mesh_stiffness().get_xlim() == (5, 13)
    assert "partial-face of pinion tooth 7, missing-tooth of gear tooth 12" in simulation.plot().get_suptitle()
    plt.close("all")


def tinted(ax: Axes) -> list[list[float]]:
    """From and to of the tinted parts."""
    spans = [patch for patch in ax.patches if isinstance(patch, Rectangle)]
    return rounded([[span.get_x(), span.get_x() + span.get_width()] for span in spans])


def rounded(spans: list[list[float]]) -> list[list[float]]:
    return [[round(place, 6) for place in span] for span in spans]


def test_all_damaged_teeth_are_marked_where_they_mesh() -> None:
    faults = [
        meshtone.ToothBreakage(chip_height_mm=3, chip_width_mm=8, wheel="pinion", tooth=3),
        meshtone.ToothBreakage(chip_height_mm=3, chip_width_mm=8, tooth=2),
        meshtone.MissingTooth(tooth=38),
    ]
    scenario = meshtone.examples.healthy().copy(sampling_rate_hz=1e4, faults=faults)
    simulation = meshtone.simulate(scenario)
    panel = simulation.plot()
    axes = {ax.get_title().replace("\n", " "): ax for ax in panel.axes}
    assert "Tooth 3 of the pinion" in axes and "Tooth 2 of the gear (also damaged: tooth 38)" in axes
    contact = float(simulation.contact_ratio)
    for part in ("Average", "Difference"):
        assert tinted(axes[f"{part}, pinion shaft"]) == rounded([[2, 2 + contact]])
        assert legend(axes[f"{part}, pinion shaft"]) == ["in contact: pinion tooth 3"]
        # The last tooth is still in contact when the first one enters.
        assert tinted(axes[f"{part}, gear shaft"]) == rounded([[0, contact - 1], [1, 1 + contact], [37, 38]])
        assert legend(axes[f"{part}, gear shaft"]) == ["in contact: gear teeth 2 and 38"]
    [stiffness] = [ax for ax in panel.axes if ax.get_ylabel() == "Mesh stiffness (N/µm)"]
    # The pinion's tooth comes round in every 17th pair, and from the gear's 2nd tooth to the pinion's 3rd it is one part.
    assert stiffness.get_xlim() == (0, 38)
    assert tinted(stiffness) == rounded([[0, contact - 1], [1, 2 + contact], [19, 19 + contact], [36, 38]])
    assert legend(stiffness) == ["in contact: pinion tooth 3 and gear teeth 2 and 38"]
    plt.close("all")


def test_a_sound_pair_has_no_marks() -> None:
    panel = meshtone.simulate(meshtone.examples.healthy().copy(sampling_rate_hz=1e4)).plot()
    assert [tinted(ax) for ax in panel.axes if ax.get_xlabel().startswith("Angle")] == [[], [], []]
    plt.close("all")


def test_any_tooth_and_any_pitches(broken: meshtone.Simulation) -> None:
    sound = broken.plot_tooth("gear", tooth=5)
    assert sound.get_title() == "Tooth 5 of the gear\n(also damaged: tooth 1)" and sound.get_legend() is None
    assert broken.plot_mesh_stiffness(pitches=(3, 41)).get_xlim() == (3, 41)
    plt.close("all")
    with pytest.raises(ValueError, match="tooth = 39: must be from 1 to 38"):
        broken.plot_tooth(tooth=39)
    with pytest.raises(ValueError, match=r"pitches = \(4, 4\)"):
        broken.plot_mesh_stiffness(pitches=(4, 4))
