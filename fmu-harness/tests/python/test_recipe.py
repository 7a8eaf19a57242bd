"""Communication points and inputs, by their formulas."""

import math

import pytest

from slidercrank import plan
from slidercrank.recipe import Input, RunError, wrapped

from conftest import PRESS, WORN_PIN

POINTS = [[1.0, 10.0], [3.0, 30.0], [4.0, 0.0]]


def test_over_time_the_ends_hold():
    own = Input.of({"name": "slider.load", "against": "time", "points": POINTS})
    assert [own.value(time, 0.0) for time in (0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 9.0)] == [10, 10, 20, 30, 15, 0, 0]


@pytest.mark.parametrize("turns", [-2, 0, 5])
def test_over_the_crank_angle_the_turn_repeats(turns):
    own = Input.of({"name": "slider.load", "against": "crank.angle", "points": POINTS})
    middle = (4.0 + math.tau + 1.0) / 2.0
    for angle, value in [(2.0, 20.0), (3.5, 15.0), (middle, 5.0)]:
        # Rounding of the wrapped angle, a few ulp of 5 turns, times the steepest slope.
        assert own.value(0.0, angle + turns * math.tau) == pytest.approx(value, abs=30 * 32 * 2.3e-16)


def test_a_slope_is_that_over_the_crank_angle():
    own = Input.of({"name": "slider.load", "against": "crank.angle", "points": POINTS})
    assert [own.slope(angle + math.tau) for angle in (2.0, 3.5)] == [10.0, -30.0]
    assert own.slope(0.5) == pytest.approx(10.0 / (math.tau - 3.0))
    assert Input.of({"name": "slider.load", "against": "time", "points": POINTS}).slope(2.0) == 0.0


def test_a_chord_joins_the_values_at_both_ends_of_a_step():
    time, angle = (Input.of({"name": "slider.load", "against": over, "points": POINTS}) for over in ("time", "crank.angle"))
    # Past the corner at 3, where the tangent would end at 35.
    assert time.chord(2.5, 3.5, 0.0, 9.0) == (25.0, -10.0)
    assert angle.chord(7.0, 7.5, 2.5, 2.0) == (25.0, -20.0)
    assert angle.chord(7.0, 7.5, 3.5, -2.0) == (15.0, 20.0)
    assert time.chord(5.0, 6.0, 0.0, 9.0) == (0.0, 0.0) and angle.chord(0.0, 0.3, 2.0, 0.0) == (20.0, 0.0)
    assert Input.of({"name": "slider.load", "constant": 0.1}).chord(0.0, 0.3, 2.0, 5.0) == (0.1, 0.0)


def test_an_angle_just_below_zero_is_a_whole_turn():
    assert wrapped(-1e-300) == math.tau and wrapped(-0.0) == 0.0 and wrapped(-1.0) == math.tau - 1.0


def test_points_are_whole_multiples_of_the_step_and_the_last_one_ends_in_time(write):
    recipe = plan(write(WORN_PIN)).recipe
    intervals = list(recipe.intervals(3.5 * recipe.step))
    assert [now for now, _ in intervals] == [point * recipe.step for point in range(4)]
    assert [then for _, then in intervals] == [point * recipe.step for point in (1, 2, 3)] + [3.5 * recipe.step]
    # A sliver of a step is no step.
    assert len(list(recipe.intervals(4.0000001 * recipe.step))) == 4


def test_a_plan_has_the_runs_and_what_they_have_in_common(write):
    planned = plan(write(PRESS))
    assert list(planned.runs.columns) == ["crank.speed_start", "joint.T.clearance"]
    assert planned.runs["joint.T.clearance"].tolist() == [5e-6, 15e-6] * 2
    recipe = planned.recipe
    assert (recipe.name, recipe.scene, recipe.turns, recipe.step) == ("tool", "press", 1.1, 1e-4)
    assert [own.wants_angle for own in recipe.inputs] == [False, True]
    assert recipe.origin["study"] == PRESS and list(recipe.keep) == ["mean", "tilt", "torque", "way"]
    # Ten times what the turns take at the speed of the start.
    assert recipe.latest({"crank.speed_start": -math.tau}) == pytest.approx(11.0)
    with pytest.raises(RunError, match="turns cannot be counted"):
        recipe.latest({"crank.speed_start": 0.0})
    # 20 million steps at the speed of the start, and one more.
    recipe.latest({"crank.speed_start": 1.1 * math.tau / 2000.0})
    with pytest.raises(RunError, match="step of 0.0001 s the run has more than 20000000 communication points"):
        recipe.latest({"crank.speed_start": 1.1 * math.tau / 2000.0001})
