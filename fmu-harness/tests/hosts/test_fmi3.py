"""The FMI 3.0 package in FMPy: valid, the same trajectory as that of FMI 2.0, events as two samples of one time."""

import io
import os
import posixpath
import re
import subprocess
import sys
import zipfile
from ctypes import c_double
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.validation import validate_fmu
from lxml import etree

from conftest import fmu

SCHEMA = Path(fmpy.__file__).with_name("schema") / "fmi3"
SPEED = 5000 * 2 * np.pi / 60
STOP, STEP = 0.0024, 1e-5

MOTION = ["crank.angle", "crank.speed", "rod.angle", "rod.speed", "slider.v"]
PIN = ["joint.C.eccentricity.x", "joint.C.eccentricity.y", "joint.C.contact", "joint.C.force.x", "solver.events"]


@pytest.fixture(scope="module")
def file():
    return fmu("wornpin3")


def read(file, name):
    with zipfile.ZipFile(file) as archive:
        return etree.fromstring(archive.read(name))


def test_fmpy_has_no_complaint(file):
    assert validate_fmu(str(file)) == []
    done = subprocess.run([sys.executable, "-m", "fmpy", "validate", str(file)], capture_output=True, text=True)
    assert "No problems found." in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize(
    "name, schema",
    [
        ("modelDescription.xml", "fmi3ModelDescription.xsd"),
        ("terminalsAndIcons/terminalsAndIcons.xml", "fmi3TerminalsAndIcons.xsd"),
    ],
)
def test_the_schemas_of_the_standard_are_met(file, name, schema):
    schema = etree.XMLSchema(etree.parse(SCHEMA / schema))
    assert schema.validate(read(file, name)), schema.error_log


def test_terminals_have_variables_that_exist_and_the_icon_is_there(file):
    names = {variable.name for variable in read_model_description(str(file)).modelVariables}
    terminals = read(file, "terminalsAndIcons/terminalsAndIcons.xml").findall(".//Terminal")
    assert [terminal.get("name") for terminal in terminals] == ["shaft", "slider"]
    for terminal in terminals:
        members = [member.get("variableName") for member in terminal]
        assert len(members) == 3 and set(members) <= names
    with zipfile.ZipFile(file) as archive:
        assert {"terminalsAndIcons/icon.png", "terminalsAndIcons/icon.svg"} <= set(archive.namelist())
        assert any(re.fullmatch(r"binaries/x86_64-linux/SliderCrank.so", name) for name in archive.namelist())


def test_the_description_tells_what_that_of_fmi_2_tells(file):
    two, three = read_model_description(str(fmu("wornpin"))), read_model_description(str(file))
    kinds = {"Real": "Float64", "Integer": "Int32"}

    def told(variable):
        of = kinds.get(variable.type, variable.type)
        start, least, most = variable.start, variable.min, variable.max
        return variable.valueReference, of, variable.causality, variable.unit, start, least, most, variable.nominal

    both = [{v.name: told(v) for v in description.modelVariables} for description in (two, three)]
    time, indicator, clock = (both[1].pop(name) for name in ("time", "indicator.joint.C", "joint.C.contact_change"))
    assert all(both[1].pop(f"joint.T.corner.{name}")[2] == "local" for name in ("penetration", "contact"))
    assert both[0] == both[1] and time[0] == sum("state." not in name for name in both[0])
    assert indicator[1:3] == ("Float64", "local") and clock[1:3] == ("Clock", "output")

    def structure(unknowns):
        depends = lambda unknown: unknown.dependencies and [v.name for v in unknown.dependencies]  # noqa: E731
        return {u.variable.name: depends(u) for u in unknowns if u.variable.type != "Clock"}

    assert structure(two.outputs) == structure(three.outputs)
    assert structure(two.derivatives) == structure(three.derivatives)
    assert structure(two.initialUnknowns) == structure(three.initialUnknowns)


def test_without_event_mode_it_is_the_run_of_fmi_2_to_the_bit(file):
    names = MOTION + PIN + ["slider.x", "slider.a", "accuracy.position"]
    two, three = (simulate_fmu(str(f), stop_time=STOP, output_interval=STEP, output=names) for f in (fmu("wornpin"), file))
    for name in names:
        assert two[name].tobytes() == three[name].tobytes(), name


def approach(row):
    """How fast the journal approaches the bearing, for the lengths of the default mechanism."""
    r, l = 0.05 * row["crank.speed"], 0.12 * row["rod.speed"]
    x = -r * np.sin(row["crank.angle"]) - l * np.sin(row["rod.angle"]) - row["slider.v"]
    y = r * np.cos(row["crank.angle"]) + l * np.cos(row["rod.angle"])
    place = np.array([row["joint.C.eccentricity.x"], row["joint.C.eccentricity.y"]])
    return abs(place @ [x, y]) / np.hypot(*place)


def test_events_are_two_samples_of_one_time_and_the_first_is_the_published_one(file):
    run = dict(stop_time=STOP, output_interval=STEP, output=MOTION + PIN, relative_tolerance=1e-10)
    result = simulate_fmu(str(file), use_event_mode=True, early_return_allowed=True, **run)
    pairs = np.flatnonzero(np.diff(result["time"]) == 0)
    contact, events = result["joint.C.contact"], result["solver.events"]
    # Contacts change between the two samples of an event and nowhere else.
    assert np.array_equal(np.flatnonzero(np.diff(contact.astype(int)) != 0), pairs)
    assert np.array_equal(np.flatnonzero(np.diff(events) != 0), pairs) and events[-1] == len(pairs) >= 6
    first = result[pairs[0]]
    assert abs(np.degrees(SPEED * first["time"]) - 6.8186) < 5e-5
    assert abs(approach(first) - 4.38578) < 5e-6
    assert not first["joint.C.contact"] and result[pairs[0] + 1]["joint.C.contact"]
    assert first["crank.angle"] == result[pairs[0] + 1]["crank.angle"]
    # The samples between are those of a run without events, up to the rounding of FMPy's sums of steps.
    plain = simulate_fmu(str(file), **run)
    assert abs(plain["slider.v"][-1] - result["slider.v"][-1]) < 1e-9


def test_intermediate_updates_tell_the_steps_and_may_end_one(file):
    description = read_model_description(str(file))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    directory = extract(str(file))
    times, early = [], [False]

    def update(_, time, set_requested, get_allowed, finished, can_return_early, requested, at):
        assert set_requested and get_allowed and finished and can_return_early
        times.append((time, slave.getFloat64([references["crank.angle"]])[0]))
        if early[0]:
            requested[0] = True
            at[0] = time

    slave = FMU3Slave(
        guid=description.guid,
        unzipDirectory=directory,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="slave",
    )
    slave.instantiate(
        earlyReturnAllowed=True,
        intermediateUpdate=update,
        requiredIntermediateVariables=[references["crank.angle"]],
    )
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    assert slave.doStep(0.0, 1e-3)[2:] == (False, 1e-3)
    assert len(times) > 5 and times == sorted(times) and times[-1][0] < 1e-3
    early[0] = True
    _, _, returned, reached = slave.doStep(1e-3, 1e-3)
    assert returned and 1e-3 <= reached < 2e-3 and times[-1][0] == reached
    slave.terminate()
    slave.freeInstance()


class Model:
    """An instance for model exchange, moved by the explicit Euler method."""

    def __init__(self, file):
        self.description = read_model_description(str(file))
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        self.fmu = FMU3Model(
            guid=self.description.guid,
            unzipDirectory=extract(str(file)),
            modelIdentifier=self.description.modelExchange.modelIdentifier,
            instanceName="model",
        )
        self.fmu.instantiate()
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.fmu.updateDiscreteStates()
        self.fmu.enterContinuousTimeMode()
        self.count, self.indicators = self.fmu.getNumberOfContinuousStates(), self.fmu.getNumberOfEventIndicators()
        assert self.count == self.description.numberOfContinuousStates
        assert self.indicators == self.description.numberOfEventIndicators
        self.time = 0.0

    def read(self, function, count):
        values = (c_double * count)()
        function(values, count)
        return np.array(values)

    def step(self, size):
        states = self.read(self.fmu.getContinuousStates, self.count)
        rates = self.read(self.fmu.getContinuousStateDerivatives, self.count)
        self.time += size
        self.fmu.setTime(self.time)
        self.fmu.setContinuousStates((c_double * self.count)(*(states + size * rates)), self.count)

    def float64(self, name):
        return self.fmu.getFloat64([self.references[name]])[0]


def test_a_clock_is_active_at_each_touch_and_parting_in_model_exchange(file):
    model = Model(file)
    clock, contact = (model.references[name] for name in ("joint.C.contact_change", "joint.C.contact"))
    ticks, closed = 0, False
    for _ in range(4000):
        model.step(5e-7)
        (indicator,) = model.read(model.fmu.getEventIndicators, model.indicators)
        assert model.float64("indicator.joint.C") == indicator
        enter, terminate = model.fmu.completedIntegratorStep()
        assert enter == ((indicator <= 0) != closed) and not terminate
        if not enter:
            continue
        model.fmu.enterEventMode()
        assert model.fmu.getClock([clock]) == [True] and model.fmu.getBoolean([contact]) == [closed]
        model.fmu.updateDiscreteStates()
        closed = not closed
        assert model.fmu.getClock([clock]) == [False] and model.fmu.getBoolean([contact]) == [closed]
        model.fmu.enterContinuousTimeMode()
        ticks += 1
    assert ticks >= 4
    model.fmu.terminate()
    model.fmu.freeInstance()


def test_corners_are_arrays():
    file = str(fmu("guideplay3"))
    output = ["joint.T.corner.penetration", "joint.T.corner.contact", "joint.T.penetration", "joint.T.contacts"]
    for kind in ("CoSimulation", "ModelExchange"):
        result = simulate_fmu(file, fmi_type=kind, stop_time=0.02, output_interval=1e-4, output=output)
        depths, contacts = result["joint.T.corner.penetration"], result["joint.T.corner.contact"]
        assert depths.shape[1:] == contacts.shape[1:] == (4,)
        assert np.array_equal(depths.max(axis=1), result["joint.T.penetration"])
        assert np.array_equal(contacts.sum(axis=1), result["joint.T.contacts"])
        assert {0, 1} <= set(result["joint.T.contacts"])


def test_cvode_moves_it_as_co_simulation_does(file):
    run = dict(stop_time=1e-3, output_interval=1e-5, output=["slider.x", "slider.v"], record_events=False)
    ours = simulate_fmu(str(file), fmi_type="CoSimulation", relative_tolerance=1e-10, **run)
    theirs = simulate_fmu(str(file), fmi_type="ModelExchange", relative_tolerance=1e-9, **run)
    assert np.abs(ours["slider.x"] - theirs["slider.x"]).max() < 1e-8
    assert np.abs(ours["slider.v"] - theirs["slider.v"]).max() < 1e-4


def reference(file):
    """The experiment of the layered standard fmi-ls-ref: settings, stimuli, results."""
    folder = "extra/org.fmi-standard.fmi-ls-ref/"
    manifest = read(file, folder + "fmi-ls-manifest.xml")
    name = "{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-name"
    assert manifest.tag == "fmiReferences" and manifest.get(name) == "org.fmi-standard.fmi-ls-ref"
    (source,) = (r.get("source") for r in manifest.findall("Related") if r.get("role") == "experiment/smoke-test")
    with zipfile.ZipFile(file) as archive:
        for related in manifest.findall("Related"):
            assert posixpath.normpath(folder + related.get("source")) in archive.namelist()
        experiment = read(file, folder + source).find("Experiment")
        texts = [archive.read(folder + experiment.find(name).get("source")) for name in ("Stimuli", "References")]
    settings = experiment.find("TransientSimulation")
    stop, step = (float(settings.get(name)) for name in ("stopTime", "stepSize"))
    tables = [
        np.array([tuple(row) for row in np.loadtxt(io.BytesIO(text), delimiter=",", skiprows=1)], dtype=columns(text))
        for text in texts
    ]
    return dict(stop_time=stop, output_interval=step, relative_tolerance=float(experiment.get("tolerance"))), tables


def columns(text):
    """What the first line names."""
    return [(name.strip('"'), "f8") for name in text.decode().splitlines()[0].split(",")]


@pytest.mark.parametrize("package", ["wornpin", "wornpin3"])
def test_the_reference_inside_the_package_is_what_a_host_gets(package):
    settings, (stimuli, results) = reference(fmu(package))
    names = results.dtype.names[1:]
    assert len(np.unique(stimuli["slider.load"])) == 2 and len(results) == 101 and "slider.x" in names
    run = dict(settings, input=stimuli, output=names)
    got = simulate_fmu(str(fmu(package)), start_values={"solver.portable": True}, **run)
    for name in names:
        # FMPy's sums of steps are off the points by rounding.
        assert np.abs(got[name] - results[name]).max() <= 1e-9 * np.abs(results[name]).max(), name
    without = simulate_fmu(str(fmu(package)), **{**run, "input": None})
    assert np.abs(without["slider.v"] - results["slider.v"]).max() > 1e-6, "the stimuli do nothing"


def test_ecos_runs_the_package_without_clocks():
    """Its parser of descriptions (fmi4c) frees what belongs to a clock twice, so it runs packages without clocks."""
    file, step, points, signals = fmu("wornpin3-without-clocks"), 1e-5, 100, ["slider.x", "slider.v", "crank.angle"]
    assert not [variable for variable in read_model_description(str(file)).modelVariables if variable.type == "Clock"]
    assert validate_fmu(str(file)) == []
    script = Path(__file__).with_name("in_ecos_alone.py")
    command = [sys.executable, str(script), str(file), str(step), str(points), *signals]
    # libtbb.so.12, which ecos needs, came with the environment.
    environment = dict(os.environ, LD_LIBRARY_PATH=str(Path(sys.prefix) / "lib"))
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines() if line[:1].isdigit()]
    theirs = np.array(rows, dtype=float)
    ours = simulate_fmu(str(file), stop_time=step * points, output_interval=step, output=signals)
    assert len(theirs) == points
    for column, name in enumerate(signals, 1):
        assert np.abs(theirs[:, column] - ours[name][1:]).max() <= 1e-9 * np.abs(ours[name]).max(), name
