"""Figures draw the frame's numbers, in the units that their axes name."""

import numpy
import pandas

from slidercrank.plots import histogram, orbit, phase

RUN = pandas.DataFrame({
    "joint.B.eccentricity.x": [1e-6, 2e-6],
    "joint.B.eccentricity.y": [-3e-6, 5e-6],
    "slider.x": [0.1, 0.2],
    "slider.v": [7.0, -7.0],
})


def test_an_orbit_is_in_micrometres_within_its_circle():
    axes = orbit(RUN, "B", clearance=4e-6)
    path, circle = axes.get_lines()
    assert numpy.allclose(path.get_xydata(), [[1, -3], [2, 5]])
    assert numpy.allclose(numpy.hypot(*circle.get_data()), 4.0)
    assert axes.get_aspect() == 1.0 and "µm" in axes.get_xlabel()


def test_a_phase_portrait_is_velocity_over_position():
    axes = phase(RUN)
    assert axes.get_lines()[0].get_xydata().tolist() == [[0.1, 7.0], [0.2, -7.0]]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("slider.x", "slider.v")


def test_a_histogram_counts_runs_that_did_not_fail():
    study = pandas.DataFrame({"force": [1.0, 1.1, 9.0, numpy.nan], "status": ["ok"] * 3 + ["why"]})
    axes = histogram(study, "force", bins=2)
    assert [bar.get_height() for bar in axes.patches] == [2, 1]
    assert axes.get_title() == "3 of 4 runs"
