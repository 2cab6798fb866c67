"""The model of contact: what it reports beside its signals."""

import numpy as np
import pytest
from meshtone import ContactFigures, MissingTooth, Sensor, examples, simulate

CONTACT = examples.healthy().copy(model="contact", sampling_rate_hz=2e4)


def test_figures_are_those_of_the_mesh_force() -> None:
    simulation = simulate(CONTACT.copy(din_grade=9, backlash_mm=0.001))
    figures, force_n = simulation.contact_figures, simulation.mesh_force_n
    assert isinstance(figures, ContactFigures)
    assert figures.apart_fraction == np.mean(force_n == 0)
    assert figures.back_flank_fraction == np.mean(force_n < 0) == simulation.tension_fraction
    assert figures.back_flank_hits == np.sum((force_n[1:] < 0) & (force_n[:-1] >= 0)) + (force_n[0] < 0)
    assert figures.largest_force_n == np.abs(force_n).max()
    assert figures.back_flank_hits > 0
    assert all("the step shifts a resonance" in warning for warning in simulation.warnings)
    assert simulate(CONTACT.copy(model="linear")).contact_figures is None


def test_supports_have_coordinates_of_their_own() -> None:
    simulation = simulate(CONTACT)
    stiffness, mass, shapes = simulation.stiffness_matrix_mean, simulation.mass_diagonal, simulation.mode_shapes
    assert stiffness.shape == shapes.shape == (17, 17)
    omega = 2 * np.pi * simulation.natural_frequencies_hz
    assert np.allclose(shapes.T @ (mass[:, None] * shapes), np.eye(17), atol=1e-9)
    assert np.allclose(np.diag(shapes.T @ stiffness @ shapes), omega**2, rtol=1e-9, atol=1e-3)


def test_sides_that_are_alike_cancel_and_are_warned_of() -> None:
    mean_of_supports = Sensor(at="support")
    alike = CONTACT.copy(pinion_teeth=20, gear_teeth=20, sensors=[mean_of_supports])
    simulation = simulate(alike)
    assert any(warning.startswith("gears.gear_teeth: both wheels have the same mass, shafts") for warning in simulation.warnings)
    assert simulation.sensors["support_vertical"].std() < 1e-9 < simulation.vertical_g.std()
    shaft = {"length_mm": 600.0, "radius_mm": 10.0, "bearing_span_mm": 150.0}
    simulation = simulate(alike.copy(gear_shaft=shaft))
    assert not any(warning.startswith("gears.gear_teeth") for warning in simulation.warnings)
    assert simulation.sensors["support_vertical"].std() > 0.01


def test_pairs_share_a_force_at_rest() -> None:
    simulation = simulate(CONTACT.copy(fault=MissingTooth()))
    at_rest = simulation.static_mesh(500, pitches=(36, 40), points_per_pitch=100)
    assert at_rest.pitch[0] == 36 and at_rest.pitch.size == at_rest.transmission_error_um.size == 400
    assert at_rest.pair_force_n.shape == (at_rest.pairs.size, 400)
    assert np.allclose(at_rest.pair_force_n.sum(axis=0), 500)
    assert not at_rest.pair_force_n[at_rest.pairs == 38].any()
    assert at_rest.peak_to_peak_um > simulate(CONTACT).static_mesh(500).peak_to_peak_um > 0
    brake = simulation.static_mesh().pair_force_n.sum(axis=0)
    assert np.allclose(brake, 10 / (0.057 * np.cos(np.radians(20))))


def test_what_cannot_be_asked_is_refused() -> None:
    with pytest.raises(ValueError, match="force_n = -1"):
        simulate(CONTACT).static_mesh(-1)
    with pytest.raises(ValueError, match="the published model has no pairs that share a force: set model = 'contact'"):
        simulate(CONTACT.copy(model="published")).static_mesh()


def test_wheels_that_were_drawn_can_be_given() -> None:
    drawn = simulate(CONTACT.copy(din_grade=7, helix_share=0.5))
    errors = drawn.profile_errors_mm()
    assert errors is not None
    wheels = {"pinion_profile_errors_mm": errors[0], "gear_profile_errors_mm": errors[1], **drawn.wheel_deviations()}
    given = CONTACT.copy(din_grade=0, **wheels)
    assert np.array_equal(simulate(given).vertical_g, drawn.vertical_g)
    assert not np.array_equal(simulate(given.copy(gear_run_out_um=0.0)).vertical_g, drawn.vertical_g)
    pitches = np.zeros(given.pinion_teeth)
    assert np.array_equal(simulate(given.copy(pinion_cumulative_pitch_um=pitches)).vertical_g, drawn.vertical_g)
    assert any("quality.run_out_share: is ignored" in warning for warning in given.copy(run_out_share=0.1).warnings)
