"""The published model's numbers, as in the Rust tests: one scenario for each fault, and more."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Published

import meshtone


def largest(ours: object, theirs: object) -> float:
    """Largest difference over the largest value."""
    ours, theirs = np.asarray(ours, float), np.asarray(theirs, float)
    assert ours.shape == theirs.shape
    scale = np.abs(theirs).max()
    return float(np.abs(ours - theirs).max() / (scale if scale > 0 else 1.0))


def test_trace_has_the_published_numbers(published: Published) -> None:
    trace = meshtone.trace(published.scenario)
    tolerance = 1e-5 if published.name == "partial_din0" else 1e-6
    for name in ("natural_frequencies_hz", "mass_diagonal", "damping_matrix", "contact_ratio", "sampling_rate_hz"):
        assert largest(trace[name], published.fields[name]) < 1e-7, name
    for name in ("pair_stiffness_healthy_n_per_mm", "mesh_stiffness_n_per_mm", "rms_g_horizontal_vertical_axial"):
        assert largest(trace[name], published.fields[name]) < tolerance, name
    # Each coordinate by its own rms, where it moves at all.
    theirs = published.fields["acceleration"]
    rms = np.sqrt((theirs**2).mean(axis=0))
    moves = rms > 1e-9 * rms.max()
    worst = (np.abs(trace["acceleration"] - theirs).max(axis=0)[moves] / rms[moves]).max()
    assert worst < 10 * tolerance


def test_signals_have_the_published_rms(published: Published) -> None:
    simulation = meshtone.simulate(published.scenario)
    rms = [np.sqrt(np.mean(getattr(simulation, name) ** 2)) for name in ("horizontal_g", "vertical_g", "axial_g")]
    assert largest(rms, published.fields["rms_g_horizontal_vertical_axial"]) < 1e-5
    assert simulation.vertical_g.size == published.fields["kept_samples"]
    assert simulation.natural_frequencies_hz == pytest.approx(published.fields["natural_frequencies_hz"], rel=1e-8, abs=1e-3)


def test_attributes_are_the_traces_fields(published: Published) -> None:
    simulation = meshtone.simulate(published.scenario)
    trace = meshtone.trace(published.scenario)
    for name in simulation.fields:
        assert np.array_equal(getattr(simulation, name), trace[name]), name
