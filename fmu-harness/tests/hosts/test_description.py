"""What the package says of itself: foreign validators, and what none of them looks at."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
from fmpy.validation import validate_fmu
from lxml import etree

BIN = Path(sys.executable).parent
XSD = Path(fmpy.__file__).with_name("schema") / "fmi2" / "fmi2ModelDescription.xsd"


def description(fmu):
    with zipfile.ZipFile(fmu) as archive:
        return etree.fromstring(archive.read("modelDescription.xml"))


def printed(*command):
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, done.stdout
    return done.stdout


def test_fmpy_has_no_complaint(every_fmu):
    assert validate_fmu(str(every_fmu)) == []


def test_fmpy_validate_and_info_say_so_on_the_command_line(every_fmu):
    assert "No problems found." in printed(BIN / "fmpy", "validate", every_fmu)
    info = printed(BIN / "fmpy", "info", every_fmu)
    assert re.search(r"FMI Type +Model Exchange, Co-Simulation", info)
    assert re.search(r"Platforms .*linux64", info)


def test_the_schema_of_the_standard_is_met(every_fmu):
    schema = etree.XMLSchema(etree.parse(XSD))
    assert schema.validate(description(every_fmu)), schema.error_log


def test_fmutool_has_no_complaint(every_fmu):
    report = printed(BIN / "fmutool", "-input", every_fmu, "-check")
    bad = [line for line in report.splitlines() if re.match(r"\s*(WARNING|ERROR|CRITICAL|FATAL)", line)]
    assert bad == [], report
    assert "This FMU seems to be compliant with FMI-2.0." in report
    assert "No semantic error against the FMI-2 standard." in report


# From here on: what the validators miss, on the packaged files themselves.


def reals(root):
    """(variable, attributes with those of its declared type behind them)"""
    types = {kind.get("name"): dict(kind[0].attrib) for kind in root.iter("SimpleType")}
    for variable in root.iter("ScalarVariable"):
        own = dict(variable[0].attrib)
        yield variable, {**types.get(own.get("declaredType"), {}), **own}


def test_start_values_lie_in_their_ranges(every_fmu):
    def number(attributes, name, absent):
        text = attributes.get(name)
        return absent if text in (None, "true", "false") else float(text)

    for variable, attributes in reals(description(every_fmu)):
        low, high = number(attributes, "min", -float("inf")), number(attributes, "max", float("inf"))
        start = number(attributes, "start", None)
        assert low <= high, variable.get("name")
        assert start is None or low <= start <= high, (variable.get("name"), start, low, high)


def test_no_two_variables_share_a_reference(every_fmu):
    variables = list(description(every_fmu).iter("ScalarVariable"))
    assert len({variable.get("valueReference") for variable in variables}) == len(variables)


def test_every_display_unit_is_defined(every_fmu):
    root = description(every_fmu)
    units = {unit.get("name"): {shown.get("name") for shown in unit.iter("DisplayUnit")} for unit in root.iter("Unit")}
    asked = [kind[0].attrib for kind in root.iter("SimpleType")] + [attributes for _, attributes in reals(root)]
    shown = [(real["unit"], real["displayUnit"]) for real in asked if "displayUnit" in real]
    assert shown
    for unit, display in shown:
        assert display in units[unit]


def test_the_header_holds_what_validators_do_not_read(every_fmu):
    root = description(every_fmu)
    experiment = root.find("DefaultExperiment").attrib
    assert float(experiment["stopTime"]) > float(experiment["startTime"])
    assert float(experiment["stepSize"]) > 0 and float(experiment["tolerance"]) > 0
    assert re.fullmatch(r"[A-Za-z_][A-Za-z_0-9]*", root.find("CoSimulation").get("modelIdentifier"))
    date = root.get("generationDateAndTime")
    assert date is None or re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", date)
    assert root.get("variableNamingConvention") == "structured"


FLAGS = [
    "canHandleVariableCommunicationStepSize",
    "canInterpolateInputs",
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "providesDirectionalDerivative",
    "canNotUseMemoryManagementFunctions",
]


def test_every_capability_is_declared(every_fmu):
    flags = description(every_fmu).find("CoSimulation").attrib
    assert all(flags.get(flag) == "true" for flag in FLAGS), flags
    assert int(flags["maxOutputDerivativeOrder"]) >= 1
    for one_sided in ("needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess", "canRunAsynchronuously"):
        assert flags.get(one_sided, "false") == "false"


def test_the_archive_is_as_the_standard_wants_it(every_fmu):
    with zipfile.ZipFile(every_fmu) as archive:
        for entry in archive.infolist():
            assert entry.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
            assert "\\" not in entry.orig_filename and not entry.filename.startswith("/")
            assert ".." not in entry.filename.split("/")
            sized_afterwards = entry.flag_bits & 8
            assert not sized_afterwards or entry.compress_type == zipfile.ZIP_DEFLATED
            assert (entry.external_attr >> 16) & 0o170000 != 0o120000, "a link"
        names = set(archive.namelist())
    wanted = {"modelDescription.xml", "model.png", "documentation/index.html", "documentation/licenses/license.txt"}
    assert wanted <= names
