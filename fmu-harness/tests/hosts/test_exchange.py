"""Model exchange: hosts whose own integrators move every mechanism as co-simulation does."""

import os
import zipfile
from ctypes import c_double
from pathlib import Path

import casadi
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Model
from fmpy.validation import validate_fmu
from lxml import etree
from pathsim import Connection, Simulation
from pathsim.blocks import Constant, Scope
from pathsim.solvers import RKDP54
from pathsim_fmi import ModelExchangeFMU

FMUS = Path(os.environ["SLIDERCRANK_FMUS"])
SIXTEEN = ["".join(c for bit, c in enumerate("ABCT") if bits >> bit & 1) for bits in range(16)]
NAMES = [f"joints-{letters}" for letters in SIXTEEN] + ["bristles", "faces", "flexible", "driven", "prescribed"]

STOP, STEP = 1e-3, 1e-5  # some impacts, too few for motions that began alike to part
OUTPUTS = ["slider.x", "slider.v", "crank.angle", "crank.speed"]
# Least digits: measured with CVode at 1e-9, the worst of the mechanisms is off by a fifth of these.
BOUNDS = dict(zip(OUTPUTS, [4e-9, 3e-4, 2e-7, 3e-3]))


def mechanism(name, version=2):
    file = FMUS / ("mechanisms" if version == 2 else "mechanisms3") / f"{name}.fmu"
    assert file.is_file(), f"{file} was not packaged"
    return str(file)


def simulate(file, kind, tolerance, output=OUTPUTS, **settings):
    return simulate_fmu(
        file,
        fmi_type=kind,
        stop_time=STOP,
        output_interval=STEP,
        output=output,
        relative_tolerance=tolerance,
        record_events=False,
        **settings,
    )


def reference(file, output=OUTPUTS):
    return simulate(file, "CoSimulation", 1e-10, output + ["solver.events"], start_values={"solver.method": 3})


def compare(ours, theirs, bounds=BOUNDS):
    assert len(ours) == len(theirs)
    for name, bound in bounds.items():
        apart = np.abs(ours[name] - theirs[name]).max()
        assert apart <= bound, f"{name} is off by {apart}"


def test_fmpys_cvode_moves_every_mechanism_as_co_simulation_does():
    events = 0
    for name in NAMES:
        file = mechanism(name)
        ours = reference(file)
        compare(ours, simulate(file, "ModelExchange", 1e-9))
        events += ours["solver.events"][-1]
    assert events > 100


def test_fmi_3_hands_cvode_the_equations_of_fmi_2_to_the_bit():
    for name in NAMES:
        two, three = (simulate(mechanism(name, version), "ModelExchange", 1e-7) for version in (2, 3))
        assert two.tobytes() == three.tobytes(), name


@pytest.mark.parametrize("version", [2, 3])
def test_states_of_every_kind_are_described_without_a_complaint(version):
    for name in ["joints-ABCT", "bristles", "faces", "flexible", "prescribed"]:
        assert validate_fmu(mechanism(name, version)) == []


def test_fmi_3_names_states_indicators_and_clocks():
    for name, contacts in [("joints-C", ["joint.C"]), ("joints-AT", ["joint.A", *(f"joint.T[{i}]" for i in "1234")])]:
        two, three = (read_model_description(mechanism(name, version)) for version in (2, 3))
        states = [[unknown.variable.name for unknown in file.derivatives] for file in (two, three)]
        assert states[0] == states[1]
        assert [unknown.variable.derivative.name for unknown in three.derivatives] == [
            name.removeprefix("der(").removesuffix(")") for name in states[1]
        ]
        assert len(three.eventIndicators) == two.numberOfEventIndicators
        assert [unknown.variable.name for unknown in three.eventIndicators] == [f"indicator.{c}" for c in contacts]
        clocks = [variable.name for variable in three.modelVariables if variable.type == "Clock"]
        assert clocks == [c.replace("T[", "T.contact_change[") if "[" in c else f"{c}.contact_change" for c in contacts]
    rigid = read_model_description(mechanism("rigid", 3))
    assert rigid.modelExchange is None and not rigid.derivatives and not rigid.eventIndicators
    # Bristles are straight when their contact opens.
    for version, element in [(2, "ScalarVariable"), (3, "Float64")]:
        with zipfile.ZipFile(mechanism("bristles", version)) as archive:
            variables = etree.fromstring(archive.read("modelDescription.xml")).iter(element)
        reset = [v.get("name") for v in variables if "true" in (e.get("reinit") for e in v.iter())]
        assert len(reset) == 5 and all(".bristle" in name for name in reset), reset


def test_fmpys_euler_takes_the_events_where_its_steps_end():
    """A method of the first order that steps over a closing contact by 1e-7 s: off by some 1e-4 of what moves."""
    file, part = mechanism("joints-C"), 100
    euler = simulate_fmu(
        file,
        fmi_type="ModelExchange",
        solver="Euler",
        stop_time=STOP,
        step_size=STEP / part,
        output_interval=STEP / part,
        output=OUTPUTS,
        record_events=False,
    )
    ours = reference(file)
    assert ours["solver.events"][-1] >= 2
    compare(ours, euler[::part], {"slider.x": 1e-5, "crank.angle": 1e-3})


def test_the_error_falls_with_the_hosts_tolerance():
    file = mechanism("joints-BC")
    ours = reference(file)
    errors = [
        np.abs(ours["slider.v"] - simulate(file, "ModelExchange", tolerance)["slider.v"]).max()
        for tolerance in (1e-5, 1e-7, 1e-9)
    ]
    assert errors[0] > 3 * errors[1] > 9 * errors[2], errors


def test_inputs_of_a_table_drive_the_load():
    file = mechanism("joints-C")
    table = np.array([(0.0, 0.0), (STOP, 400.0)], dtype=[("time", "f8"), ("slider.load", "f8")])
    output = OUTPUTS + ["slider.load"]
    loaded = simulate(file, "ModelExchange", 1e-9, output, input=table)
    free = simulate(file, "ModelExchange", 1e-9, output)
    assert np.allclose(loaded["slider.load"], 400.0 * loaded["time"] / STOP, rtol=0, atol=1e-6)
    assert loaded["slider.v"][-1] - free["slider.v"][-1] > 0.1


def test_a_package_with_rigid_contacts_offers_co_simulation_alone():
    file = mechanism("rigid")
    assert validate_fmu(file) == []
    description = read_model_description(file)
    assert description.modelExchange is None and description.coSimulation is not None
    assert description.numberOfContinuousStates == 0


class Importer:
    """An instance in continuous-time mode by FMPy's low-level calls."""

    def __init__(self, file, directory):
        self.description = read_model_description(file)
        identifier = self.description.modelExchange.modelIdentifier
        self.directory = extract(file, unzipdir=directory)
        self.fmu = FMU2Model(
            guid=self.description.guid,
            unzipDirectory=self.directory,
            modelIdentifier=identifier,
            instanceName="importer",
        )
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.fmu.newDiscreteStates()
        self.fmu.enterContinuousTimeMode()
        self.count = self.description.numberOfContinuousStates

    def states(self):
        x = (c_double * self.count)()
        self.fmu.fmi2GetContinuousStates(self.fmu.component, x, self.count)
        return np.array(x)

    def derivatives(self, x):
        given, found = (c_double * self.count)(*x), (c_double * self.count)()
        self.fmu.fmi2SetContinuousStates(self.fmu.component, given, self.count)
        self.fmu.fmi2GetDerivatives(self.fmu.component, found, self.count)
        return np.array(found)


@pytest.mark.parametrize("name", ["joints-", "joints-C", "joints-ABCT", "flexible"])
def test_casadi_gets_the_right_hand_side_and_its_jacobian(name, tmp_path):
    importer = Importer(mechanism(name), tmp_path)
    builder = casadi.DaeBuilder("unit", str(importer.directory), {})
    states = [variable.variable.name for variable in importer.description.derivatives]
    states = [state.removeprefix("der(").removesuffix(")") for state in states]
    assert builder.x() == states
    ode = builder.create("ode", ["x", "u"], ["ode"])
    x = importer.states()
    inputs = np.zeros(len(builder.u()))
    assert np.array_equal(np.array(ode(x, inputs)).ravel(), importer.derivatives(x))
    rows, _ = ode.jacobian()(x, inputs, 0)
    rows = np.array(rows)
    for column in range(len(x)):
        half = 1e-7
        moved = [x.copy(), x.copy()]
        moved[0][column] -= half
        moved[1][column] += half
        difference = (importer.derivatives(moved[1]) - importer.derivatives(moved[0])) / (2 * half)
        scale = np.abs(difference).max() + np.abs(importer.derivatives(x)).max() * 1e-8 / half
        assert np.abs(rows[:, column] - difference).max() <= 1e-5 * scale
    importer.fmu.terminate()
    importer.fmu.freeInstance()


class OneOutput(ModelExchangeFMU):
    """PathSim 0.1.1 reads every output as a real, Integers and Booleans, too: it is told of one alone."""

    def _get_outputs(self, x, u, t):
        wrapper = self.fmu_wrapper
        wrapper.output_refs = {"slider.x": wrapper.output_refs["slider.x"]}
        return super()._get_outputs(x, u, t)


def test_pathsim_integrates_a_worn_pin_by_its_own_method():
    file = mechanism("joints-C")
    unit = OneOutput(file)
    inputs, scope = [Constant(0.0), Constant(0.0)], Scope()
    links = [Connection(inputs[0], unit[0]), Connection(inputs[1], unit[1]), Connection(unit[0], scope[0])]
    tolerances = dict(tolerance_lte_abs=1e-12, tolerance_lte_rel=1e-9)
    simulation = Simulation([unit, *inputs, scope], links, dt=1e-6, Solver=RKDP54, log=False, **tolerances)
    simulation.run(STOP)
    times, (places,) = scope.read()
    ours = reference(file)
    theirs = np.interp(ours["time"], times, places)
    assert ours["solver.events"][-1] >= 2
    # Its points lie up to microseconds apart, and a straight line between two is off by a·h²/8.
    assert np.abs(theirs - ours["slider.x"]).max() <= 1e-7
