"""A step's Jacobian is that of differences on either library, and both Kalman filters find speed and clearance."""

import math

import numpy
import pytest

from slidercrank import Unit
from slidercrank.kalman import Task, extended, unscented
from slidercrank.recipe import RunError

from conftest import fmu

SPEED, CLEARANCE = "crank.speed_start", "joint.C.clearance"
PIN = {
    "drive.mode": 2,
    "joint.C.model": 2,
    CLEARANCE: 5e-4,
    SPEED: 300 * math.tau / 60,
    "joint.C.young.bearing": 5e8,
    "joint.C.restitution": 0.1,
}
"""A worn pin in a soft bearing."""


@pytest.fixture
def unit():
    with Unit(fmu("wornpin")) as unit:
        yield unit


@pytest.mark.parametrize("portable", [0, 1])
def test_a_jacobian_is_that_of_differences(unit, portable):
    unit.start(PIN | {"solver.tolerance": 1e-10, "solver.portable": portable})
    for _ in range(40):
        unit.step(5e-4)
    found = unit.step_jacobian(1e-3, [CLEARANCE, "slider.load"], ["slider.x", "slider.v"])
    names = found.phase_names
    assert names == ["state.slider.x", "state.rod.angle", "state.slider.vx", "state.rod.speed", "joint.C.approach"]
    assert found.phase_by_phase.shape == (5, 5) and found.phase_by_parameters.shape == (5, 2)
    assert found.outputs_by_phase.shape == (2, 5) and found.outputs_by_parameters.shape == (2, 2)
    assert (found.parameters, found.outputs) == ([CLEARANCE, "slider.load"], ["slider.x", "slider.v"])

    def leads(phase, parameters=None):
        unit.set_phase(phase, parameters)
        step = unit.predict(1e-3, found.outputs)
        return numpy.concatenate([step.next_phase, step.next_outputs])

    size = numpy.array([1e-4, 1e-3, 1e-1, 1.0, 1e-1, 1e-4, 1e-1])
    whole = numpy.vstack([found.phase_by_phase, found.outputs_by_phase])
    for column in range(4):
        change = numpy.zeros(5)
        change[column] = 1e-5 * size[column]
        slope = (leads(found.phase + change) - leads(found.phase - change)) / (2 * change[column])
        assert abs((slope - whole[:, column]) / size).max() < 1e-5 * abs(whole[:, column] / size).max(), names[column]
    slope = (leads(found.phase, {CLEARANCE: 5e-4 + 1e-9}) - leads(found.phase, {CLEARANCE: 5e-4 - 1e-9})) / 2e-9
    exact = numpy.concatenate([found.phase_by_parameters[:, 0], found.outputs_by_parameters[:, 0]])
    assert abs((slope - exact) / size).max() < 1e-5 * abs(exact / size).max()


def test_the_instance_stays_where_it_is_and_goes_where_it_was_told(unit):
    unit.start(PIN)
    unit.step(1e-2)
    unit.set_phase(unit.predict(1e-3).phase)
    told = unit.step_jacobian(1e-3, [CLEARANCE], ["slider.x"])
    plain = unit.predict(1e-3, ["slider.x"])
    assert numpy.array_equal(told.next_phase, plain.next_phase)
    unit.step(1e-3)
    assert unit.read(["slider.x"])[0] == told.next_outputs[0]
    assert numpy.array_equal(unit.predict(1e-3).phase, told.next_phase)


def test_what_is_refused_says_why(unit):
    with pytest.raises(RunError, match="no instance"):
        unit.step_jacobian(1e-3)
    unit.start(PIN)
    for call, why in [
        (lambda: unit.step_jacobian(math.nan), "communicationStepSize = NaN"),
        (lambda: unit.step_jacobian(1e-3, ["joint.C.model"]), "joint.C.model is not a real parameter or input"),
        (lambda: unit.step_jacobian(1e-3, ["nonsense"]), "no variable `nonsense`"),
        (lambda: unit.set_phase(numpy.zeros(3)), "3 numbers of a phase, where there are 5"),
        (lambda: unit.set_phase(unit.predict(1e-3).phase, {CLEARANCE: -1.0}), "joint.C.clearance = -1 is out of range"),
    ]:
        with pytest.raises(RunError, match=why):
            call()


@pytest.mark.parametrize("estimator", [extended, unscented])
def test_speed_and_clearance_are_found_from_noisy_positions(unit, estimator):
    noise, step, count = 20e-6, 5e-4, 400
    unit.start(PIN)
    positions = []
    for _ in range(count):
        unit.step(step)
        positions.append(unit.read(["slider.x"])[0])
    measured = numpy.array(positions) + noise * numpy.random.default_rng(1).standard_normal(count)
    guess = {SPEED: (1.01 * PIN[SPEED], 0.01 * PIN[SPEED]), CLEARANCE: (6e-4, 1e-4)}
    scale = {"state.slider.x": 1e-4, "state.rod.angle": 1e-3, "state.slider.vx": 1.0, "state.rod.speed": 10.0}
    unit.start(PIN | {name: value for name, (value, _) in guess.items()})
    found = estimator(unit, Task("slider.x", noise, step, guess, phase=1e-3, drift=1e-2, scale=scale), measured)
    last = found.course.iloc[-1]
    for name in guess:
        assert abs(last[name] - PIN[name]) < 4 * last[f"{name} ±"], (name, last)
    assert last[f"{CLEARANCE} ±"] < 3e-6 and last[f"{SPEED} ±"] < 1e-4 * PIN[SPEED]
    assert found.steps == count * (1 if estimator is extended else 13)
    assert 0.8 < numpy.sqrt((found.innovation**2).mean()) < 1.2
