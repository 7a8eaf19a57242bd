"""An SSP package, unpacked: its units as FMPy's slaves, its wires, its parameter values."""

import os
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.ssp.ssd import Parameter, ParameterSet, find_components, read_ssd
from lxml import etree

NAMES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}


@dataclass(frozen=True)
class Wire:
    """From an output to an input."""

    source: tuple  # unit, variable
    target: tuple
    continuous: bool  # whether a line may be drawn through its values


class Package:
    """What is in the file; `start()` gives its units at their first communication point."""

    def __init__(self, file):
        self.file = str(file)
        self.folder = Path(extract(self.file, unzipdir=mkdtemp()))
        structure = read_ssd(self.file)
        self.connectors, self.descriptions, self.places = {}, {}, {}
        for component in find_components(structure.system):
            fmu = self.folder / component.source
            self.descriptions[component.name] = read_model_description(str(fmu))
            self.places[component.name] = extract(str(fmu), unzipdir=mkdtemp())
            self.connectors[component.name] = [(own.name, own.kind) for own in component.connectors]
        self.values = self._values()
        self.wires = [self._wire(own) for own in structure.system.connections]
        experiment = self._tree().find("ssd:DefaultExperiment", NAMES)
        self.stop = float(experiment.get("stopTime"))

    def _tree(self):
        return etree.parse(self.folder / "SystemStructure.ssd").getroot()

    def _values(self):
        """Parameter values by unit: numbers, whatever their type."""
        values = {}
        for component in self._tree().iterfind(".//ssd:Component", NAMES):
            rows = component.iterfind(".//ssv:Parameter", NAMES)
            values[component.get("name")] = {row.get("name"): float(row[0].get("value")) for row in rows}
        return values

    def _wire(self, connection):
        ends = (
            (connection.startElement, connection.startConnector),
            (connection.endElement, connection.endConnector),
        )
        kinds = [self.variable(*end).variability for end in ends]
        return Wire(*ends, continuous="discrete" not in kinds)

    def variable(self, unit, name):
        return next(own for own in self.descriptions[unit].modelVariables if own.name == name)

    def parameter_set(self):
        """For FMPy's master, which takes parameter values by hand."""
        rows = [(f"{unit}.{name}", value) for unit, own in self.values.items() for name, value in own.items()]
        return ParameterSet(parameters=[Parameter(name=name, type="Real", value=value) for name, value in rows])

    def start(self, settings=(), tolerance=None):
        """Every unit initialised; `settings` are further (unit, name, value). Outputs go over the wires once."""
        units = {name: Slave(self, name) for name in self.connectors}
        settings = [(unit, *row) for unit, own in self.values.items() for row in own.items()] + list(settings)
        for name, unit in units.items():
            unit.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
            unit.set({own: value for owner, own, value in settings if owner == name})
            unit.fmu.enterInitializationMode()
        for wire in self.wires:
            unit, name = wire.source
            units[wire.target[0]].set({wire.target[1]: units[unit].get([name])[0]})
        for unit in units.values():
            unit.fmu.exitInitializationMode()
        return units


class Slave:
    """One instance, with names in place of value references."""

    def __init__(self, package, name):
        description = package.descriptions[name]
        self.variables = {own.name: own for own in description.modelVariables}
        self.takes_slopes = description.coSimulation.canInterpolateInputs
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=package.places[name],
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.fmu.instantiate()

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def set(self, values):
        for name, value in values.items():
            variable = self.variables[name]
            if variable.type == "Real":
                self.fmu.setReal([variable.valueReference], [value])
            elif variable.type == "Boolean":
                self.fmu.setBoolean([variable.valueReference], [bool(value)])
            else:
                self.fmu.setInteger([variable.valueReference], [int(value)])

    def get(self, names):
        return self.fmu.getReal(self.references(names))

    def free(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


def leave(status):
    """Ends this process without the destructors of libraries, as one has to that loaded a unit of PythonFMU.

    As the process ends, PythonFMU 0.7.0 counts down a reference in memory that it freed just before
    (`finalizePythonInterpreter`). Most runs survive that; where the memory has been used again, the heap
    is corrupt and the process aborts.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
