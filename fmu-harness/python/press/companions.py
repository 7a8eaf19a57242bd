"""Writes the press's companions as unpacked FMUs: one folder each, the same files from the same sources.

    companions.py FOLDER

PythonFMU makes the files. Its description is then completed: units, initial unknowns; and what
changes from day to day, GUID and date, is replaced by a digest and left out.
"""

import hashlib
import sys
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

from lxml import etree
from pythonfmu.builder import FmuBuilder

# A folder of its own: a unit imports what it brings along, and a host that had the same names on its
# path would give it those.
SOURCES = Path(__file__).with_name("units")
SLAVES = ["controller", "sheet"]
SHARED = SOURCES / "variables.py"

# Exponents of SI base units, as FMI 2.0 wants them.
UNITS = {
    "1": {},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "m/s": {"m": 1, "s": -1},
    "J": {"kg": 1, "m": 2, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N.m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1},
    "N.m.s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
    "kg.m2": {"kg": 1, "m": 2},
}


def unpacked(slave, folder):
    """PythonFMU's files of one slave; returns the folder."""
    with TemporaryDirectory() as place:
        options = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
        file = FmuBuilder.build_FMU(SOURCES / f"{slave}.py", dest=place, project_files=[SHARED], **options)
        into = folder / file.stem
        with zipfile.ZipFile(file) as archive:
            archive.extractall(into)
    return into


def units_of(slave):
    module = __import__(slave)
    rows = {**module.PARAMETERS, **module.INPUTS, **module.OUTPUTS, **getattr(module, "STATE", {})}
    return {name: unit for name, (_, unit, _) in rows.items()}


def complete(description, units):
    """Units, and every output as an initial unknown."""
    definitions = etree.Element("UnitDefinitions")
    for name in sorted(set(units.values())):
        unit = etree.SubElement(definitions, "Unit", name=name)
        etree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in UNITS[name].items()})
    description.find("CoSimulation").addnext(definitions)
    for variable in description.iter("ScalarVariable"):
        variable.find("Real").set("unit", units[variable.get("name")])
    outputs = description.find("ModelStructure/Outputs")
    initial = etree.SubElement(description.find("ModelStructure"), "InitialUnknowns")
    for unknown in outputs:
        etree.SubElement(initial, "Unknown", index=unknown.get("index"))


def main(folder):
    for slave in SLAVES:
        into = unpacked(slave, folder)
        file = into / "modelDescription.xml"
        description = etree.parse(file, etree.XMLParser(remove_blank_text=True)).getroot()
        complete(description, units_of(slave))
        del description.attrib["generationDateAndTime"]
        description.set("guid", "")
        sources = [path for path in sorted(into.rglob("*")) if path.is_file() and path != file]
        digest = hashlib.sha256(etree.tostring(description, method="c14n"))
        for path in sources:
            digest.update(path.relative_to(into).as_posix().encode() + b"\0" + path.read_bytes())
        description.set("guid", "{" + digest.hexdigest()[:32] + "}")
        etree.ElementTree(description).write(file, encoding="UTF-8", xml_declaration=True, pretty_print=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
