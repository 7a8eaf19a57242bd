"""Derivatives: of inputs in time, of outputs in time, of outputs by inputs."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from mechanism import grid

INPUTS = ["crank.torque", "slider.load"]
EPS = np.finfo(float).eps


def swinging(mechanism):
    """A torque-driven mechanism under way, with both inputs at work."""
    slave = mechanism.start({"drive.mode": 1, "crank.speed_start": 300.0, "crank.angle_start": 1.0})
    slave.set({"crank.torque": 20.0, "slider.load": -100.0})
    slave.fmu.doStep(0.0, 1e-4)
    return slave


def test_a_sloping_input_is_where_the_slope_leads(ideal):
    slave = swinging(ideal)
    load = ideal.references(["slider.load"])
    slave.set({"slider.load": 10.0})
    slave.fmu.setRealInputDerivatives(load, [1], [2e5])
    slave.fmu.doStep(1e-4, 5e-4)
    # u + u̇·h, once rounded in each of the two points, the difference and the product.
    assert abs(slave.get("slider.load") - 110.0) <= 4 * 110.0 * EPS * (6e-4 / 5e-4)
    slave.free()


def test_one_sloping_step_is_what_many_held_ones_tend_to(ideal):
    """Held inputs at the middle of each piece of the ramp miss its effect by a second-order error."""

    def end(pieces, sloping):
        slave = swinging(ideal)
        torque = ideal.references(["crank.torque"])
        points = grid(1e-4, 2e-3 / pieces, pieces)
        for here, there in zip(points, points[1:]):
            begin, size = here - 1e-4, there - here
            slope = 0.0 if sloping else size / 2
            slave.set({"crank.torque": 1e4 * (begin + slope)})
            if sloping:
                slave.fmu.setRealInputDerivatives(torque, [1], [1e4])
            slave.fmu.doStep(here, size)
        speed = slave.get("crank.speed")
        slave.free()
        return speed

    one, hundred = end(1, True), end(100, True)
    errors = [abs(end(pieces, False) - one) for pieces in (10, 20, 40)]
    # The solver's tolerance of 1e-6 lets the two sloping runs differ by so much.
    assert abs(one - hundred) <= 1e-6 * one
    assert 3.0 < errors[0] / errors[1] < 5.0, errors
    assert 3.0 < errors[1] / errors[2] < 5.0, errors


@pytest.mark.parametrize("scene", ["ideal", "wornpin", "press"])
def test_output_derivatives_are_the_slopes_of_the_outputs(scene, request):
    mechanism = request.getfixturevalue(scene)
    slave = mechanism.start({"slider.load": -10.0})
    names = ["slider.x", "slider.y", "slider.angle", "crank.angle", "rod.angle", "slider.v", "crank.speed"]
    references, orders = mechanism.references(names), [1] * len(names)
    here, ahead = 1.3e-3, 1e-7
    # Whichever side of a contact's first touch this is: within 0.2 µs the outputs are smooth.
    slave.run([0.0, here - ahead])
    before = np.array(slave.get_all(names))
    slave.run([here - ahead, here])
    slopes = np.array(slave.fmu.getRealOutputDerivatives(references, orders))
    slave.run([here, here + ahead])
    after = np.array(slave.get_all(names))
    slave.free()
    difference = (after - before) / (2 * ahead)
    # Rounding of the two values over the span, and a curvature of 1e-5 of the slope.
    scale = np.maximum(np.abs(before), 1e-6)
    assert np.all(np.abs(slopes - difference) <= 8 * EPS * scale / ahead + 1e-4 * np.abs(slopes) + 1e-6), (
        slopes,
        difference,
    )


def test_only_first_derivatives_of_outputs_and_inputs_are_given(ideal):
    slave = swinging(ideal)
    outputs, inputs = ideal.references(["slider.x"]), ideal.references(INPUTS[:1])
    for order in (0, 2):
        with pytest.raises(FMICallException):
            slave.fmu.getRealOutputDerivatives(outputs, [order])
        with pytest.raises(FMICallException):
            slave.fmu.setRealInputDerivatives(inputs, [order], [1.0])
    with pytest.raises(FMICallException):
        slave.fmu.setRealInputDerivatives(outputs, [1], [1.0])
    slave.free()


def sensitivities(slave):
    """One row for each real output, one column for each input: by the FMU, and by changing the input."""
    mechanism = slave.mechanism
    outputs = [variable.name for variable in mechanism.outputs(("Real",))]
    unknowns, knowns = mechanism.references(outputs), mechanism.references(INPUTS)
    told = np.array([slave.fmu.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns]).T
    values = slave.get_all(INPUTS)
    changed = []
    for name, value in zip(INPUTS, values):
        sides = []
        for side in (+0.5, -0.5):
            slave.set({name: value + side})
            sides.append(np.array(slave.get_all(outputs)))
        slave.set({name: value})
        changed.append(sides[0] - sides[1])
    return outputs, told, np.array(changed).T, np.array(slave.get_all(outputs))


@pytest.mark.parametrize("scene", ["ideal", "wornpin", "allplay", "press"])
def test_directional_derivatives_are_what_a_changed_input_does(scene, request):
    slave = swinging(request.getfixturevalue(scene))
    outputs, told, seen, values = sensitivities(slave)
    slave.free()
    # Outputs are affine in the inputs, save where friction or contact bend them; differences are
    # rounded to the output's own size. `accuracy.*` are themselves differences of numbers of the slider's size.
    sizes = dict(zip(outputs, np.abs(values)))
    for error, motion in (("position", "x"), ("velocity", "v"), ("acceleration", "a")):
        sizes[f"accuracy.{error}"] += sizes[f"slider.{motion}"]
    size = np.array([sizes[name] for name in outputs])
    bound = 1e-6 * np.abs(told) + 64 * EPS * (1.0 + size)[:, None]
    for name, row, other, allowed in zip(outputs, told, seen, bound):
        assert np.all(np.abs(row - other) <= allowed), (name, row, other)


@pytest.mark.parametrize("drive", [1, 2])
@pytest.mark.parametrize("scene", ["ideal", "wornpin", "allplay", "press"])
def test_what_feeds_through_is_declared(scene, drive, request):
    """An output that an input moves at once lists it; where something lies is moved by no input."""
    from lxml import etree

    mechanism = request.getfixturevalue(scene)
    root = etree.parse(str(mechanism.directory / "modelDescription.xml")).getroot()
    names = [variable.get("name") for variable in root.iter("ScalarVariable")]
    declared = {}
    for unknown in root.find("ModelStructure/Outputs"):
        indices = unknown.get("dependencies")
        assert indices is not None, "an absent list would mean: depends on everything"
        known = {names[int(index) - 1] for index in indices.split()}
        # Continuous states, of which model exchange asks, are listed, too.
        declared[names[int(unknown.get("index")) - 1]] = {name for name in known if not name.startswith("state.")}
    slave = mechanism.start({"drive.mode": drive, "crank.speed_start": 300.0, "crank.angle_start": 1.0})
    outputs, told, seen, _ = sensitivities(slave)
    slave.free()
    for name, rows in zip(outputs, np.hstack([told, seen])):
        moved_by = {INPUTS[column % 2] for column in np.flatnonzero(rows)}
        assert moved_by <= declared[name], name
    for position in ("slider.x", "slider.v", "slider.y", "crank.angle", "crank.speed", "rod.angle"):
        assert declared[position] == set(), position
