"""Reductions by their definitions, and sums in the order of the values."""

import math

import numpy
import pytest

from slidercrank.quantity import ANGLE, REDUCTIONS, TIME, Quantity, QuantityError, passages, total

TURNS = numpy.arange(41) / 10
COLUMNS = {TIME: TURNS, ANGLE: math.tau * TURNS, "v": TURNS * TURNS, "f.x": 3 * TURNS, "f.y": -4 * TURNS}


def value(of, reduce, at=None, transient=0.0):
    return Quantity(of, reduce, at).value(COLUMNS, transient)


def test_values_are_reduced_after_the_transient():
    for reduce, wanted in [("min", 9.0), ("max", 16.0), ("range", 7.0), ("last", 16.0), ("peak", 16.0)]:
        assert value("v", reduce, None, 3.0) == wanted
    reduced = lambda name, *values: REDUCTIONS[name](numpy.array(values))
    assert reduced("mean", 1.0, 2.0, 6.0) == 3.0
    assert reduced("deviation", 1.0, 2.0, 6.0) == math.sqrt(7)
    assert reduced("rms", 1.0, -7.0) == 5.0
    assert reduced("peak", -3.0, 2.0) == 3.0


def test_a_sum_runs_from_the_first_to_the_last():
    values = numpy.array([1e16, 1.0, 1.0, -1e16] * 40)
    wanted = 0.0
    for value in values:
        wanted += value
    assert total(values) == wanted != math.fsum(values)


def test_over_whole_turns_a_sine_has_the_moments_of_its_integrals():
    # Eight points of a turn, both ends of three turns among them; then one more, nearer to its neighbour.
    turns = numpy.arange(25) / 8
    columns = {TIME: turns, ANGLE: math.tau * turns, "sine": 2.0 + numpy.cos(math.tau * turns)}
    for reduce, known in [("mean", 2.0), ("rms", math.sqrt(4.5)), ("deviation", math.sqrt(0.5))]:
        assert Quantity("sine", reduce).value(columns, 1.0) == pytest.approx(known, rel=1e-14)
    columns = {name: numpy.append(column, last) for (name, column), last in zip(columns.items(), [3.01, math.tau * 3.01, 3.0])}
    assert Quantity("sine", "mean").value(columns, 1.0) == pytest.approx((2.0 * 2.0 + 0.01 * 3.0) / 2.01, rel=1e-14)


def test_a_vector_counts_by_its_length():
    assert value("f", "last") == pytest.approx(20.0, rel=1e-15)


def test_passages_are_interpolated_forwards_and_backwards():
    angles, values = numpy.array([0.0, 2.0, 4.0, 6.0, 4.0, 2.0]), numpy.arange(6.0)
    assert passages(angles, values, 3.0).tolist() == [1.5, 4.5]
    assert len(passages(angles, values, 3.0 - math.tau)) == 2
    # Two turns backwards from the angle on.
    angles = -math.tau * numpy.array([0.0, 0.6, 1.0, 1.5, 2.0])
    assert passages(angles, numpy.arange(5.0), 0.0).tolist() == [2.0, 4.0]


@pytest.mark.parametrize("off", [-1e-10, 0.0, 1e-10])
@pytest.mark.parametrize("place", range(5))
def test_rounding_takes_neither_a_passage_nor_a_sample_away(off, place):
    angles, values = math.tau * numpy.array([0.0, 0.5, 1.0, 1.5, 2.0]), numpy.arange(5.0)
    angles[place] += off
    assert passages(angles, values, 0.0) == pytest.approx([2.0, 4.0], abs=1e-9)
    assert passages(-angles, values, 0.0).tolist() == passages(angles, values, 0.0).tolist()
    assert Quantity("v", "mean").value({TIME: numpy.arange(5.0), ANGLE: angles, "v": values}, 1.0) == 3.0


def test_what_is_not_there_is_named():
    for of, at, transient, word in [("w", None, 0.0, "`w`"), ("v", 1.0, 3.9, "of 0 passages of 1 rad is NaN"), ("v", None, 9.0, "0 values")]:
        with pytest.raises(QuantityError, match=word):
            value(of, "mean", at, transient)


@pytest.mark.parametrize("at", [None, 1.0])
@pytest.mark.parametrize("reduce", REDUCTIONS)
@pytest.mark.parametrize("of", ["v", "f"])
def test_slopes_are_those_of_differences(of, reduce, at):
    random = numpy.random.default_rng(3)
    base = {"v": random.standard_normal(41), "f.x": random.standard_normal(41), "f.y": random.standard_normal(41)}
    base[ANGLE] = math.tau * TURNS + 0.01
    slopes = {name: random.standard_normal((41, 2)) for name in base}
    moved = lambda place, size: {name: base[name] + size * slopes[name][:, place] for name in slopes} | {TIME: TURNS}
    base[TIME] = TURNS
    own = Quantity(of, reduce, at)
    found = own.slope(base, slopes, 0.55)
    for place in range(2):
        difference = (own.value(moved(place, 1e-6), 0.55) - own.value(moved(place, -1e-6), 0.55)) / 2e-6
        assert found[place] == pytest.approx(difference, rel=1e-6, abs=1e-8)
