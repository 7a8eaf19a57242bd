"""Cycles are counted as the standard counts them, and strokes are turns."""

import math

import numpy
import pandas
import pytest

from conftest import fmu
from slidercrank import simulate
from slidercrank.durability import cycles, equivalent, force, spectrum, strokes


def series(values):
    return pandas.Series(values, index=numpy.arange(len(values)) * 0.1)


def test_the_standard_s_example_is_counted_as_the_standard_does():
    """ASTM E 1049-85, figure 6."""
    counted = cycles(series([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]))
    by_range = counted.groupby("range")["count"].sum().to_dict()
    assert by_range == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
    whole = counted[counted["count"] == 1.0]
    assert whole[["range", "mean", "from", "to"]].to_numpy().tolist() == [[4.0, 1.0, 0.4, 0.5]]


def test_equal_cycles_are_equivalent_to_themselves():
    wave = series([0.0, *([10.0, 0.0] * 50)])
    counted = cycles(wave)
    assert counted["count"].sum() == pytest.approx(50.0)
    assert equivalent(counted, 3.0, repetitions=50.0) == pytest.approx(10.0)
    assert equivalent(counted, 3.0) == pytest.approx(10.0 * 50.0 ** (1 / 3))
    assert equivalent(counted, 400.0) == pytest.approx(10.0 * 50.0 ** (1 / 400))
    for exponent in (0.0, math.inf, math.nan):
        with pytest.raises(ValueError, match=f"exponent {exponent}"):
            equivalent(counted, exponent)


def test_a_spectrum_has_every_cycle_once():
    time = numpy.linspace(0.0, 1.0, 1201)
    run = pandas.DataFrame({"joint.C.force.x": 3.0 * numpy.sin(2 * math.pi * 20 * time), "joint.C.force.y": 0.0}, index=time)
    counted = cycles(force(run, "C"))
    table = spectrum(run, ["C"], classes=8)
    assert table["C"].sum() == pytest.approx(counted["count"].sum())
    assert table["C.exceeding"].iloc[0] == pytest.approx(counted["count"].sum())
    # |sin| has two cycles a period, all but the first and last half of the full range.
    assert table.index[-1] == pytest.approx(3.0, rel=1e-3) and table["C"].iloc[-1] == pytest.approx(39.5, abs=1.0)


def test_strokes_of_the_worn_pin_have_its_extremes():
    outputs = ["crank.angle", "joint.C.force.x", "joint.C.force.y", "joint.C.force.peak", "slider.x"]
    settings = {"joint.C.peak.audit": True}
    run = simulate(fmu("wornpin"), stop=0.0361, step=1e-5, settings=settings, outputs=outputs)
    run["force"] = force(run, "C")
    table = strokes(run, ["slider.x", "force", "joint.C.force.peak"])
    assert list(table.index) == [0, 1, 2]  # 5000 rpm: 12 ms a turn
    assert table["slider.x", "max"].to_numpy() == pytest.approx(0.17, abs=1e-3)
    # What is found within the steps is never below what is seen at communication points.
    assert (table["joint.C.force.peak", "max"] >= table["force", "max"]).all()
    assert (table["force", "max"] > 0.99 * table["joint.C.force.peak", "max"]).all()


def test_a_run_of_whole_turns_has_all_its_strokes():
    # The sum of 200 steps a turn misses the end of most turns by rounding.
    for turns in range(1, 31):
        angle = math.pi + math.tau * 5.0 * (0.001 * numpy.arange(200 * turns + 1))
        run = pandas.DataFrame({"crank.angle": angle, "slider.x": numpy.cos(angle)})
        assert list(strokes(run, ["slider.x"]).index) == list(range(turns))
    assert strokes(run, "slider.x").equals(strokes(run, ["slider.x"]))


def test_forces_that_do_not_change_have_no_cycles_and_gaps_are_refused():
    run = pandas.DataFrame({"joint.C.force.x": [0.0] * 5, "joint.C.force.y": [0.0] * 5}, index=numpy.arange(5.0))
    assert spectrum(run, ["C"], classes=4)["C"].tolist() == [0.0] * 4
    run.loc[2.0, "joint.C.force.x"] = math.nan
    with pytest.raises(ValueError, match="joint.C.force has values that are not finite"):
        spectrum(run, ["C"])
