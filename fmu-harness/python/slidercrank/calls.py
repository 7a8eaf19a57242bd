"""The calls of FMI 2.0 and FMI 3.0 that a run needs, alike for both."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from fmpy import calloc, free
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2CoSimulation,
)
from fmpy.fmi3 import FMU3Slave, fmi3IntermediateUpdateCallback, fmi3LogMessageCallback
from fmpy.model_description import ModelDescription

Number = type[ctypes.c_double] | type[ctypes.c_int] | type[ctypes.c_longlong] | type[ctypes.c_bool]
"""What a variable is in C."""


class Calls:
    """A loaded library of either version. A call of the FMU that fails is an `FMICallException`."""

    prefix: str
    """Of the standard's functions."""
    own: str
    """Of the functions beside the standard's."""
    kinds: Mapping[str, tuple[str, Number]]
    """Of each type of variables: how they are got and set, and what they are in C; real ones first."""
    real: str
    """How real ones are got and set."""
    interpolates: bool
    """Whether inputs can follow straight lines over a step."""
    entering: list[tuple[Any, ...]]
    """What leads into initialization mode: functions with their arguments after the component."""
    slave: Any

    def of(self, function: str) -> Callable[..., int]:
        """A function of the standard by its name without prefix."""
        found: Callable[..., int] = getattr(self.slave, self.prefix + function)
        return found

    def access(self, verb: str, kind: str) -> Callable[..., int]:
        """Gets or sets variables of a kind: takes the component, references, their number and values."""
        raise NotImplementedError

    def set_slopes(self, component: int | None, references: object, count: int, slopes: object) -> None:
        """Sets slopes [1/s] of real inputs, where inputs can follow straight lines."""
        raise NotImplementedError

    def instantiate(self, log: Callable[..., None]) -> tuple[int | None, object]:
        """A component, and what must be kept as long as it lives. `log` takes the message as its last argument."""
        raise NotImplementedError

    def do_step(self, component: int | None, now: float, size: float) -> None:
        raise NotImplementedError


class Fmi2(Calls):
    prefix, own, real = "fmi2", "slidercrank_", "Real"
    kinds = {
        "Real": ("Real", ctypes.c_double),
        "Integer": ("Integer", ctypes.c_int),
        "Enumeration": ("Integer", ctypes.c_int),
        "Boolean": ("Boolean", ctypes.c_int),
    }
    entering = [("SetupExperiment", 0, 0.0, 0.0, 0, 0.0), ("EnterInitializationMode",)]

    def __init__(self, description: ModelDescription, folder: Path):
        self.slave = FMU2Slave(**_library(description, folder))
        self.interpolates = description.coSimulation.canInterpolateInputs
        self.resources = (folder / "resources").absolute().as_uri()

    def access(self, verb: str, kind: str) -> Callable[..., int]:
        return self.of(verb + kind)

    def set_slopes(self, component: int | None, references: object, count: int, slopes: object) -> None:
        orders = (ctypes.c_int * count)(*([1] * count))
        self.of("SetRealInputDerivatives")(component, references, count, orders, slopes)

    def instantiate(self, log: Callable[..., None]) -> tuple[int | None, object]:
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(log)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        name, guid = self.slave.instanceName.encode(), self.slave.guid.encode()
        resources, functions = self.resources.encode(), ctypes.byref(callbacks)
        return self.slave.fmi2Instantiate(name, fmi2CoSimulation, guid, resources, functions, 0, 1), callbacks

    def do_step(self, component: int | None, now: float, size: float) -> None:
        self.slave.fmi2DoStep(component, now, size, 1)


class Fmi3(Calls):
    prefix, own, real = "fmi3", "slidercrank_fmi3_", "Float64"
    kinds = {
        "Float64": ("Float64", ctypes.c_double),
        "Int32": ("Int32", ctypes.c_int),
        "Enumeration": ("Int64", ctypes.c_longlong),
        "Boolean": ("Boolean", ctypes.c_bool),
    }
    entering = [("EnterInitializationMode", False, 0.0, 0.0, False, 0.0)]
    interpolates = False

    def __init__(self, description: ModelDescription, folder: Path):
        self.slave = FMU3Slave(**_library(description, folder))
        self.resources = str((folder / "resources").absolute()) + os.path.sep
        self.ended = [ctypes.byref(kind()) for kind in (ctypes.c_bool, ctypes.c_bool, ctypes.c_bool, ctypes.c_double)]
        """What a step tells of its end."""

    def access(self, verb: str, kind: str) -> Callable[..., int]:
        call = self.of(verb + kind)
        # Without arrays there are as many values as references.
        return lambda component, references, count, values: call(component, references, count, values, count)

    def instantiate(self, log: Callable[..., None]) -> tuple[int | None, object]:
        callbacks = fmi3LogMessageCallback(log), fmi3IntermediateUpdateCallback()
        name, guid = self.slave.instanceName.encode(), self.slave.guid.encode()
        modes = False, True, False, False
        resources = self.resources.encode()
        return self.slave.fmi3InstantiateCoSimulation(name, guid, resources, *modes, None, 0, None, *callbacks), callbacks

    def do_step(self, component: int | None, now: float, size: float) -> None:
        self.slave.fmi3DoStep(component, now, size, True, *self.ended)


def load(description: ModelDescription, folder: Path) -> Calls:
    """The library of an unpacked FMU."""
    return _version(description)(description, folder)


def kinds_of(description: ModelDescription) -> Mapping[str, tuple[str, Number]]:
    """Types of variables that are numbers, as in `Calls.kinds`."""
    return _version(description).kinds


def _version(description: ModelDescription) -> type[Fmi2] | type[Fmi3]:
    return Fmi3 if description.fmiVersion.startswith("3") else Fmi2


def _library(description: ModelDescription, folder: Path) -> dict[str, str]:
    return {
        "guid": description.guid,
        "unzipDirectory": str(folder),
        "modelIdentifier": description.coSimulation.modelIdentifier,
        "instanceName": description.modelName,
    }
