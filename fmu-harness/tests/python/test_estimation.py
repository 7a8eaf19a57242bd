"""A step's Jacobian is that of differences on either library, and both Kalman filters find parameters and phase."""

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


def test_both_versions_of_fmi_give_the_same_numbers(unit):
    with Unit(fmu("wornpin3")) as newer:
        told = []
        for own in (unit, newer):
            own.start(PIN)
            own.set_inputs({"slider.load": -10.0})
            own.step(2e-2)
            phase = own.predict(1e-3).phase
            own.set_phase(phase, {CLEARANCE: 4e-4})
            found = own.step_jacobian(1e-3, [CLEARANCE, "slider.load"], ["slider.x", "joint.C.force.x"])
            own.step(1e-3)
            matrices = [found.phase_by_phase, found.phase_by_parameters, found.outputs_by_phase, found.outputs_by_parameters]
            told.append([phase, found.next_phase, found.next_outputs, own.read(found.outputs), *matrices])
        assert all(map(numpy.array_equal, *told))
        with pytest.raises(RunError, match="slidercrank_fmi3_step_jacobian returned fmi3Error: .*communicationStepSize"):
            newer.step_jacobian(math.nan)


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
    with pytest.raises(RunError, match="joint.C.clearance = -1 is out of range"):
        unit.start({CLEARANCE: -1.0})
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


def test_limits_are_those_of_the_description(unit):
    with Unit(fmu("wornpin3")) as newer:
        for own in (unit, newer):
            assert own.limits("solver.method") == (1.0, 12.0) and own.limits("drive.mode") == (1.0, 2.0)
            assert own.limits("energy.audit") == (0.0, 1.0)
            assert own.limits("rod.flexible.bending_modes") == (0.0, 8.0)
            assert own.limits(CLEARANCE) == (1e-9, 0.1)
            assert own.limits("slider.x") == (-math.inf, math.inf)


SCALE = {"state.slider.x": 1e-4, "state.rod.angle": 1e-3, "state.slider.vx": 1.0, "state.rod.speed": 10.0}


def positions(unit, settings, step, count):
    """Of the slider, after each step."""
    unit.start(settings)
    found = []
    for _ in range(count):
        unit.step(step)
        found.append(unit.read(["slider.x"])[0])
    return numpy.array(found)


@pytest.mark.parametrize("estimator", [extended, unscented])
@pytest.mark.parametrize("truth, guess", [(-0.010, -0.011), (-0.001, 0.0)])
def test_a_parameter_may_be_negative_or_guessed_as_0(unit, estimator, truth, guess):
    name, step = "guide.offset", 1e-3
    measured = positions(unit, PIN | {"joint.C.model": 1, name: truth}, step, 30)
    unit.start(PIN | {"joint.C.model": 1, name: guess})
    task = Task("slider.x", 1e-6, step, {name: (guess, 1e-3)}, phase=0.0, drift=0.0, scale={})
    assert estimator(unit, task, measured).course[name].iloc[-1] == pytest.approx(truth, abs=2e-6)


@pytest.mark.parametrize("estimator", [extended, unscented])
def test_a_parameter_stays_within_its_legal_range(unit, estimator):
    step, task = 5e-4, Task("slider.x", 20e-6, 5e-4, {CLEARANCE: (6e-4, 5e-4)}, phase=1e-3, drift=1e-2, scale=SCALE)
    measured = positions(unit, PIN, step, 60)
    unit.start(PIN | {CLEARANCE: 6e-4})
    # Points of the unscented filter begin at −0.5 mm.
    assert abs(estimator(unit, task, measured).course[CLEARANCE].iloc[-1] - PIN[CLEARANCE]) < 1e-4
    # Positions that no clearance explains.
    unit.start(PIN | {CLEARANCE: 6e-4})
    assert (estimator(unit, task, measured + 1e-2).course[CLEARANCE] >= 6e-5).all()


@pytest.mark.parametrize("estimator", [extended, unscented])
def test_a_phase_is_estimated_alone(unit, estimator):
    noise, step = 20e-6, 5e-4
    measured = positions(unit, PIN, step, 60)
    unit.start(PIN)
    unit.set_phase(unit.predict(step).phase + numpy.array([1e-4, 1e-3, 0.0, 0.0, 0.0]))
    found = estimator(unit, Task("slider.x", noise, step, {}, phase=1.0, drift=1e-2, scale=SCALE), measured)
    assert found.course.shape == (60, 0)
    # Uncorrected it would end 340 µm off.
    assert abs(unit.read(["slider.x"])[0] - measured[-1]) < noise


def test_a_scale_of_what_is_no_number_of_the_phase_is_refused(unit):
    unit.start(PIN)
    task = Task("slider.x", 1e-6, 5e-4, {}, phase=1.0, drift=1e-3, scale={"slider.x": 1e-4})
    with pytest.raises(KeyError, match="the phase has no `slider.x`: state.slider.x, state.rod.angle"):
        extended(unit, task, numpy.zeros(1))


@pytest.mark.parametrize("estimator", [extended, unscented])
def test_speed_and_clearance_are_found_from_noisy_positions(unit, estimator):
    noise, step, count = 20e-6, 5e-4, 400
    measured = positions(unit, PIN, step, count) + noise * numpy.random.default_rng(1).standard_normal(count)
    guess = {SPEED: (1.01 * PIN[SPEED], 0.01 * PIN[SPEED]), CLEARANCE: (6e-4, 1e-4)}
    unit.start(PIN | {name: value for name, (value, _) in guess.items()})
    found = estimator(unit, Task("slider.x", noise, step, guess, phase=1e-3, drift=1e-2, scale=SCALE), measured)
    last = found.course.iloc[-1]
    for name in guess:
        assert abs(last[name] - PIN[name]) < 4 * last[f"{name} ±"], (name, last)
    assert last[f"{CLEARANCE} ±"] < 3e-6 and last[f"{SPEED} ±"] < 1e-4 * PIN[SPEED]
    assert found.steps == count * (1 if estimator is extended else 13)
    assert 0.8 < numpy.sqrt((found.innovation**2).mean()) < 1.2
