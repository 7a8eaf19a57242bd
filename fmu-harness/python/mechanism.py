"""Our FMU through FMPy's low-level calls, with names in place of value references.

A *picture* of an instance is the bytes of all its outputs: two are equal only if every bit is.
"""

import functools
import struct
from ctypes import byref
from pathlib import Path
from tempfile import mkdtemp

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CoSimulation

OF_INTERVAL = (".impact.speed", ".force.peak", "solver.error_estimate")
"""Endings of outputs that belong to the interval since the last communication point, not to the instant."""


class Mechanism:
    """An unpacked FMU; `start()` gives an instance at its first communication point."""

    def __init__(self, file, into=None):
        self.file = Path(file)
        self.directory = Path(extract(str(file), unzipdir=into or mkdtemp()))
        self.description = read_model_description(str(file))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}

    def outputs(self, kinds=("Real", "Integer", "Boolean")):
        return [v for v in self.description.modelVariables if v.causality == "output" and v.type in kinds]

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def instantiate(self, name="mechanism", **odd):
        return Slave(self, name, **odd)

    def start(self, settings={}, start=0.0, stop=None, tolerance=None, **odd):
        slave = self.instantiate(**odd)
        slave.set(settings)
        slave.fmu.setupExperiment(tolerance=tolerance, startTime=start, stopTime=stop)
        slave.initialize()
        return slave


class Slave:
    """One instance."""

    def __init__(self, mechanism, name="mechanism", location="as FMPy says", callbacks=None, visible=0, logging=0):
        self.mechanism = mechanism
        self.fmu = FMU2Slave(
            guid=mechanism.description.guid,
            unzipDirectory=str(mechanism.directory),
            modelIdentifier=mechanism.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        if location == "as FMPy says":
            location = (mechanism.directory / "resources").as_uri()
        self.fmu.callbacks = callbacks or defaultCallbacks
        self.fmu.component = self.fmu.fmi2Instantiate(
            name.encode(),
            fmi2CoSimulation,
            mechanism.description.guid.encode(),
            location and location.encode(),
            byref(self.fmu.callbacks),
            visible,
            logging,
        )
        assert self.fmu.component, "not instantiated"

    def initialize(self):
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, values):
        for name, value in values.items():
            variable = self.mechanism.variables[name]
            call = {"Real": self.fmu.setReal, "Boolean": self.fmu.setBoolean}.get(variable.type, self.fmu.setInteger)
            call([variable.valueReference], [value])

    def get(self, name):
        return self.get_all([name])[0]

    def get_all(self, names):
        return [self._get(self.mechanism.variables[name].type)([reference])[0]
                for name, reference in zip(names, self.mechanism.references(names))]

    def _get(self, kind):
        return {"Real": self.fmu.getReal, "Boolean": self.fmu.getBoolean}.get(kind, self.fmu.getInteger)

    def picture(self):
        """All outputs of the instant, bit for bit; not those of the interval since the last communication point."""
        numbers = []
        for kind in ("Real", "Integer", "Boolean"):
            numbers += self._get(kind)(_outputs(self.mechanism, kind))
        return struct.pack(f"{len(numbers)}d", *numbers)

    def run(self, points):
        """Steps from the first to the last of these communication points; a picture at each but the first."""
        pictures = []
        for here, there in zip(points, points[1:]):
            self.fmu.doStep(here, there - here)
            pictures.append(self.picture())
        return pictures

    def free(self):
        self.fmu.freeInstance()


@functools.lru_cache
def _outputs(mechanism, kind):
    outputs = mechanism.outputs((kind,))
    return [variable.valueReference for variable in outputs if not variable.name.endswith(OF_INTERVAL)]


def grid(start, step, count):
    """Communication points at whole multiples of a step."""
    return [start + n * step for n in range(count + 1)]
