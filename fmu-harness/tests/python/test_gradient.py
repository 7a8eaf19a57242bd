"""Gradients of a run are those of differences, through impacts and under a load that follows the crank."""

from dataclasses import replace

import numpy
import pytest

from slidercrank import Unit
from slidercrank.gradient import gradient
from slidercrank.quantity import Quantity
from slidercrank.recipe import Input, Recipe, RunError

from conftest import fmu

LOAD = Input("slider.load", None, "crank.angle", ((0.0, 0.0), (1.0, -500.0), (2.0, 300.0), (5.0, 0.0)))
KEEP = {
    "rms": Quantity("joint.A.force", "rms"),
    "peak": Quantity("joint.B.force", "peak"),
    "passage": Quantity("slider.v", "mean", 0.7),
    "spread": Quantity("slider.x", "deviation"),
}
DRIVEN = {"drive.mode": 1, "joint.C.model": 1, "crank.inertia": 1e-2, "crank.com.x": 0.02}
WORN = {"joint.C.clearance": 2e-5}
LENGTHS = {"rod.length": 0.12, "slider.mass": 0.14}
RUN = Recipe("own", "", "wornpin", 1.0, 0.0, 5e-5, 10.0, 523.6, (LOAD,), KEEP, {})


@pytest.fixture
def unit():
    with Unit(fmu("wornpin")) as unit:
        yield unit


@pytest.mark.parametrize(("settings", "turns", "step"), [(DRIVEN, 1.0, 1e-4), (WORN, 0.15, 2e-5)])
def test_a_gradient_is_that_of_differences(unit, settings, turns, step):
    settings, names = {**LENGTHS, **settings, "solver.tolerance": 1e-10}, [*LENGTHS, list(settings)[-1]]
    recipe = replace(RUN, turns=turns, step=step)
    plain = dict(zip(KEEP, unit.run(recipe, settings)))
    columns = []
    for name in names:
        size = 1e-6 * settings[name]
        at = lambda place: numpy.array(unit.run(recipe, {**settings, name: settings[name] + place * size}))
        columns.append((8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * size))
    for quantity, differences in zip(KEEP, numpy.array(columns).T):
        found = gradient(unit, recipe, settings, quantity, names)
        assert found.value == plain[quantity]
        # Measured: shorter differences are rounding, longer ones bend; through impacts both are near 0.5 %.
        assert found.by_parameters == pytest.approx(differences, rel=1e-2), quantity


def test_forces_follow_a_load_over_the_angle_at_once(unit):
    # Without contacts differences are good to 1e-8; samples lie at corners of the load and between them.
    settings, name = {**LENGTHS, **DRIVEN, "solver.tolerance": 1e-12}, "crank.inertia"
    for turns in (0.16, 0.32, 0.5):
        keep = {"force": Quantity("joint.C.force.x", "last"), "speed": Quantity("crank.speed", "last")}
        recipe = replace(RUN, turns=turns, step=1e-4, keep=keep)
        size = 1e-3 * settings[name]
        at = lambda place: numpy.array(unit.run(recipe, {**settings, name: settings[name] + place * size}))
        differences = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * size)
        for quantity, difference in zip(keep, differences):
            found = gradient(unit, recipe, settings, quantity, [name]).by_parameters[0]
            # Measured: 5e-5, of the corners within a step.
            assert found == pytest.approx(difference, rel=2e-4), quantity


def test_a_parameter_that_is_zero_but_for_rounding_has_the_derivative_at_zero(unit):
    settings, name = {**LENGTHS, **DRIVEN}, "crank.com.y"
    recipe = replace(RUN, turns=0.2, step=1e-4, keep={"rms": Quantity("joint.A.force", "rms")})
    at = lambda value: gradient(unit, recipe, {**settings, name: value}, "rms", [name]).by_parameters[0]
    size = 1e-4
    run = lambda value: unit.run(recipe, {**settings, name: value})[0]
    assert at(0.0) == pytest.approx((run(size) - run(-size)) / (2 * size), rel=1e-4)
    for value in (1.2e-16, 1e-12, 1e-8):
        assert at(value) == pytest.approx(at(0.0), rel=1e-4), value


def test_an_input_that_is_asked_for_is_constant(unit):
    settings, name = {**LENGTHS, **DRIVEN, "slider.load": 200.0}, "slider.load"
    recipe = replace(RUN, turns=0.2, step=1e-4, keep={"rms": Quantity("joint.C.force", "rms")})
    constant = lambda load: unit.run(replace(recipe, inputs=(Input(name, load, None, ()),)), settings)[0]
    found = gradient(unit, recipe, settings, "rms", [name])
    assert found.value == constant(200.0)
    assert found.by_parameters[0] == pytest.approx((constant(201.0) - constant(199.0)) / 2.0, rel=1e-4)


def test_both_versions_of_fmi_give_the_same_gradient(unit):
    # FMI 3.0 holds inputs that change.
    constant = (Input("slider.load", -300.0, None, ()),)
    recipe = replace(RUN, turns=0.15, inputs=constant, keep={**KEEP, "contact": Quantity("joint.C.contact", "mean")})
    with Unit(fmu("wornpin3")) as newer:
        assert newer.run(recipe, WORN) == unit.run(recipe, WORN)
        told = [gradient(own, recipe, WORN, "rms", ["joint.C.clearance"]) for own in (unit, newer)]
    assert numpy.array_equal(told[0].by_parameters, told[1].by_parameters) and told[0].value == told[1].value


def test_what_has_no_derivative_says_why(unit):
    contact = replace(RUN, keep={"contact": Quantity("joint.C.contact", "mean")}, turns=0.01)
    with pytest.raises(RunError, match="`joint.C.contact` is not a real output"):
        gradient(unit, contact, WORN, "contact", ["joint.C.clearance"])
    discrete = ["joint.A.impact.speed", "joint.T.force.peak", "solver.error_estimate", "solver.tolerance_used"]
    sums = [*(f"joint.C.{sum}" for sum in ("friction.work", "sliding", "wear.work")), "energy.input", "energy.residual"]
    sums += [f"energy.{sum}" for sum in ("dissipated", "torque_work", "load_work", "contact_loss", "friction_loss")]
    sums += ["energy.viscous_loss", "energy.modal_loss"]
    told = {name: "is discrete" for name in discrete} | {name: "is a sum since the start" for name in sums}
    for name, why in told.items():
        with pytest.raises(RunError, match=f"own: `{name}` {why} and has no derivative"):
            gradient(unit, replace(RUN, keep={"own": Quantity(name, "last")}), WORN, "own", ["joint.C.clearance"])
    kinetic = replace(RUN, keep={"own": Quantity("energy.kinetic", "last")}, turns=0.01)
    assert gradient(unit, kinetic, WORN, "own", ["joint.C.clearance"]).by_parameters.shape == (1,)
    with pytest.raises(RunError, match="moreau"):
        gradient(unit, RUN, {**WORN, "solver.method": 8}, "rms", ["joint.C.clearance"])
