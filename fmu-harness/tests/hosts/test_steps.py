"""The result does not depend on how the host cuts time, and neither does the work."""

import random

import pytest
from fmpy.fmi1 import FMICallException

from mechanism import grid

TURN = 0.012  # [s] of the worn pin's crank
STOP = 2 * TURN
COUNTS = ["solver.steps", "solver.rejected", "solver.evaluations", "solver.events"]


def every_millisecond(slave, step):
    """Pictures at each whole millisecond, by communication steps of `step`."""
    fine = round(1e-3 / step)
    # Points as multiples of the millisecond's own parts: those in common are the same numbers.
    points = [milli * 1e-3 + part * step for milli in range(round(STOP / 1e-3)) for part in range(fine)]
    points.append(STOP)
    pictures = slave.run(points)[fine - 1 :: fine]
    counts = slave.get_all(COUNTS)
    slave.free()
    return pictures, counts


@pytest.mark.parametrize("scene", ["wornpin", "guideplay", "allplay"])
def test_10_us_100_us_and_1_ms_give_the_same_bits_for_the_same_work(scene, request):
    mechanism = request.getfixturevalue(scene)
    fine, middle, coarse = [
        every_millisecond(mechanism.start(tolerance=1e-6), step) for step in (1e-5, 1e-4, 1e-3)
    ]
    assert len(coarse[0]) == round(STOP / 1e-3)
    assert fine == middle == coarse


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("scene", ["wornpin", "press"])
def test_any_split_gives_the_same_bits(scene, seed, request):
    mechanism, chance = request.getfixturevalue(scene), random.Random(seed)
    # Steps from nanoseconds to milliseconds, a few so small that time hardly moves.
    cuts = sorted({STOP * chance.random() ** chance.choice([1, 1, 8]) for _ in range(200)} | {1e-15})
    whole, split = mechanism.start(), mechanism.start()
    assert whole.run([0.0, STOP])[-1] == split.run([0.0, *cuts, STOP])[-1]
    whole.free()
    split.free()


def test_an_input_set_to_what_it_is_cuts_nothing(press):
    told, quiet = press.start(), press.start()
    points = grid(0.0, 1e-4, 200)
    pictures = []
    for here, there in zip(points, points[1:]):
        told.set({"crank.torque": 0.0, "slider.load": 0.0})
        told.fmu.doStep(here, there - here)
        pictures.append(told.picture())
    assert pictures == quiet.run(points)
    told.free()
    quiet.free()


def test_time_never_drifts_from_the_hosts(ideal):
    """A million sums of 60 Hz leave the host's clock off by rounding; ours is the host's."""
    slave = ideal.start({"drive.mode": 2, "crank.speed_start": 1.0})
    time, step = 0.0, 1.0 / 60.0
    for _ in range(20_000):
        slave.fmu.doStep(time, step)
        time += step
    # θ = ω·t with ω = 1: one rounding.
    assert abs(slave.get("crank.angle") - time) <= 2 * time * 2.0**-53
    slave.free()


@pytest.mark.parametrize("step", [0.0, -1e-3, float("nan")])
def test_a_step_that_leads_nowhere_is_refused_and_forgotten(ideal, step):
    slave = ideal.start()
    before = slave.picture()
    with pytest.raises(FMICallException) as refusal:
        slave.fmu.doStep(0.0, step)
    assert refusal.value.status == 3
    assert slave.picture() == before
    slave.fmu.doStep(0.0, 1e-3)
    slave.free()


def test_a_defined_stop_holds_up_to_rounding(ideal):
    slave = ideal.start(stop=1e-3)
    slave.fmu.doStep(0.0, 1e-3 * (1 + 2**-51))
    with pytest.raises(FMICallException):
        slave.fmu.doStep(1e-3, 1e-3)
    slave.free()
