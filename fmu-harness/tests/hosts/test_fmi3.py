"""The FMI 3.0 package in FMPy: valid, the same trajectory as that of FMI 2.0, events as two samples of one time."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi3 import FMU3Slave
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

    # States and their derivatives are there for model exchange, which FMI 3.0's file does not offer.
    both = [
        {v.name: told(v) for v in description.modelVariables if "state." not in v.name} for description in (two, three)
    ]
    time = both[1].pop("time")
    assert both[0] == both[1] and time[0] == len(both[0])

    def structure(unknowns):
        shared = lambda variables: [v.name for v in variables if "state." not in v.name]  # noqa: E731
        depends = lambda unknown: None if unknown.dependencies is None else shared(unknown.dependencies)  # noqa: E731
        return {u.variable.name: depends(u) for u in unknowns if "state." not in u.variable.name}

    assert structure(two.outputs) == structure(three.outputs)
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
