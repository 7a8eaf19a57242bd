"""The press with its servo drive as an SSP package: valid as a whole and in its parts."""

import os
from pathlib import Path

import pytest
from fmpy.ssp.ssd import read_ssd
from fmpy.validation import validate_fmu
from lxml import etree
from pyssp_standard.ssp import SSP

from system import NAMES, Package

FILE = Path(os.environ["SLIDERCRANK_FMUS"]) / "press.ssp"


@pytest.fixture(scope="module")
def package():
    return Package(FILE)


@pytest.fixture(scope="module")
def structure(package):
    return etree.parse(package.folder / "SystemStructure.ssd").getroot()


def test_the_schema_accepts_the_structure():
    read_ssd(str(FILE), validate=True)


def test_pyssp_standard_accepts_structure_and_wires():
    with SSP(FILE, mode="r") as package, package.system_structure as structure:
        structure.__check_compliance__()
        everything = dict(unconnected_inputs=True, connector_not_in_system=True)
        assert structure.check_connections(**everything) == []
        assert (structure.default_experiment.start_time, structure.default_experiment.stop_time) == (0.0, 0.8)


def test_pyssp_standard_would_see_a_fault(structure, tmp_path):
    """A connector of a kind that there is not."""
    from pyssp_standard.ssd import SSD
    from xmlschema import XMLSchemaValidationError

    broken = etree.fromstring(etree.tostring(structure))
    broken.find(".//ssd:Connector", NAMES).set("kind", "sideways")
    file = tmp_path / "SystemStructure.ssd"
    file.write_bytes(etree.tostring(broken))
    with pytest.raises(XMLSchemaValidationError):
        SSD(file).__check_compliance__()


def test_every_fmu_in_it_is_valid(package):
    files = sorted((package.folder / "resources").glob("*.fmu"))
    assert [file.name for file in files] == ["ServoController.fmu", "Sheet.fmu", "press.fmu"]
    for file in files:
        assert validate_fmu(str(file)) == [], file.name


def test_connectors_and_values_are_those_of_the_fmus(package, structure):
    for component in structure.iter(f"{{{NAMES['ssd']}}}Component"):
        name = component.get("name")
        for connector in component.iterfind("ssd:Connectors/ssd:Connector", NAMES):
            variable = package.variable(name, connector.get("name"))
            assert (connector.get("kind"), connector[0].get("unit")) == (variable.causality, variable.unit)
        for value in component.iterfind(".//ssv:Parameter", NAMES):
            variable = package.variable(name, value.get("name"))
            assert (variable.causality, value[0].get("unit")) == ("parameter", variable.unit)


def test_both_ends_of_a_wire_have_one_unit_that_is_defined(package, structure):
    defined = {unit.get("name") for unit in structure.iterfind("ssd:Units/*", NAMES)}
    for wire in package.wires:
        units = {package.variable(*end).unit for end in (wire.source, wire.target)}
        assert len(units) == 1 and units <= defined, wire


def test_units_mean_the_same_in_every_fmu_and_in_the_package(package, structure):
    def bases(root, path):
        # A unit without a base is one that nothing is said of.
        own = {unit.get("name"): dict(unit[0].attrib) for unit in root.iterfind(path, NAMES) if len(unit)}
        return {name: {base: float(power) for base, power in unit.items()} for name, unit in own.items()}

    told = bases(structure, "ssd:Units/*")
    for name, place in package.places.items():
        own = bases(etree.parse(Path(place) / "modelDescription.xml").getroot(), "UnitDefinitions/Unit")
        for unit in told.keys() & own.keys():
            assert told[unit] == own[unit], (name, unit)
