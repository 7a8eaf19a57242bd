"""An unpacked FMU, and one run of it through FMPy's low-level calls."""

from __future__ import annotations

import ctypes
import math
import threading
import time
from array import array
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

import numpy
from fmpy import calloc, extract, free, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2CoSimulation,
)
from fmpy.model_description import ModelVariable

from .quantity import ANGLE, Column, QuantityError
from .recipe import Recipe, RunError

STATUS = ["fmi2OK", "fmi2Warning", "fmi2Discard", "fmi2Error", "fmi2Fatal", "fmi2Pending"]
UNWATCHED = 8
"""Steps between two looks at the clock."""
MOST_POINTS = 20_000_000
"""More communication points than this end a run."""
Number = type[ctypes.c_double] | type[ctypes.c_int]
"""What a variable is in C."""

_loading = threading.Lock()  # FMPy changes the working directory while it loads a library


class Unit:
    """An FMU unpacked into a directory, its library loaded."""

    def __init__(self, fmu: Path, into: Path):
        with _loading:
            extract(str(fmu), unzipdir=str(into))
            self.description = read_model_description(str(fmu))
            self.variables = {variable.name: variable for variable in self.description.modelVariables}
            self.slave = FMU2Slave(
                guid=self.description.guid,
                unzipDirectory=str(into),
                modelIdentifier=self.description.coSimulation.modelIdentifier,
                instanceName=self.description.modelName,
            )
        self.resources = (into / "resources").absolute().as_uri()
        self.outputs = {
            name: variable
            for name, variable in self.variables.items()
            if variable.causality == "output" and variable.type != "String"
        }

    def run(self, recipe: Recipe, settings: Mapping[str, float], budget: float = 600.0) -> list[float]:
        """The recipe's quantities in a run with these parameters, in the order of its `keep`.

        A run that has none is a `RunError` that says why, in the harness's own words.
        """
        latest = recipe.latest(settings)
        names = [ANGLE]
        for quantity in recipe.keep.values():
            # A quantity of nothing is told of after the run, as the harness does.
            with suppress(QuantityError):
                names += [output for output in quantity.outputs(self.outputs) if output not in names]
        with Instance(self, recipe, settings, names) as instance:
            instance.march(latest, budget)
            columns = instance.columns()
        values = []
        for name, quantity in recipe.keep.items():
            try:
                values.append(quantity.value(columns, recipe.transient))
            except QuantityError as error:
                raise RunError(f"{name}: {error}") from error
        return values


class Selection:
    """Outputs of one type, read together."""

    def __init__(self, call: Callable[..., int], kind: Number, variables: list[ModelVariable]):
        self.call = call
        self.names = [variable.name for variable in variables]
        self.references = (ctypes.c_uint * len(variables))(*(variable.valueReference for variable in variables))
        self.buffer = (kind * len(variables))()
        self.rows = array("d" if kind is ctypes.c_double else "i")

    def read(self, component: int) -> None:
        self.call(component, self.references, len(self.names), self.buffer)

    def record(self, component: int) -> None:
        self.read(component)
        self.rows.frombytes(bytes(self.buffer))

    def columns(self) -> dict[str, Column]:
        kind = numpy.float64 if self.rows.typecode == "d" else numpy.intc
        table = numpy.frombuffer(self.rows, dtype=kind).reshape(-1, len(self.names))
        return {name: numpy.ascontiguousarray(table[:, place], float) for place, name in enumerate(self.names)}


class Instance:
    """One run: instantiated, initialised, marched."""

    def __init__(self, unit: Unit, recipe: Recipe, settings: Mapping[str, float], names: list[str]):
        self.unit, self.recipe, self.slave = unit, recipe, unit.slave
        self.said: str | None = None
        # Kept, since the FMU calls them as long as it lives.
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self.callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        self.callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        self.settings = settings
        self.component: int | None = None
        calls: dict[str, tuple[Callable[..., int], Number]] = {
            "Real": (self.slave.fmi2GetReal, ctypes.c_double),
            "Integer": (self.slave.fmi2GetInteger, ctypes.c_int),
            "Boolean": (self.slave.fmi2GetBoolean, ctypes.c_int),
        }
        groups: dict[str, list[ModelVariable]] = {kind: [] for kind in calls}
        for name in names:
            if name not in unit.outputs:
                raise RunError(f"turns cannot be counted: `{name}` is not an output of this FMU")
            variable = unit.outputs[name]
            groups["Integer" if variable.type == "Enumeration" else variable.type].append(variable)
        self.selections = [Selection(*calls[kind], group) for kind, group in groups.items() if group]
        self.angle = Selection(*calls["Real"], [unit.outputs[ANGLE]])
        inputs = [unit.variables[own.name] for own in recipe.inputs]
        self.inputs = (ctypes.c_uint * len(inputs))(*(variable.valueReference for variable in inputs))
        self.values = (ctypes.c_double * len(inputs))()
        self.wants_angle = any(own.wants_angle for own in recipe.inputs)

    def __enter__(self) -> Instance:
        slave = self.slave
        description = self.unit.description
        self.component = slave.fmi2Instantiate(
            description.modelName.encode(),
            fmi2CoSimulation,
            description.guid.encode(),
            self.unit.resources.encode(),
            ctypes.byref(self.callbacks),
            0,
            1,
        )
        if not self.component:
            raise RunError(f"the FMU could not be instantiated{self._because()}")
        try:
            for name, value in self.settings.items():
                self._try(f"setting `{name}`", self._set, name, value)
            self._try("fmi2SetupExperiment", slave.fmi2SetupExperiment, self.component, 0, 0.0, 0.0, 0, 0.0)
            self._try("fmi2EnterInitializationMode", slave.fmi2EnterInitializationMode, self.component)
            self._apply_inputs(0.0)
            self._try("fmi2ExitInitializationMode", slave.fmi2ExitInitializationMode, self.component)
            self._record()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self.component:
            self.slave.fmi2FreeInstance(self.component)
            self.component = None

    def march(self, latest: float, budget: float) -> None:
        """Steps until the crank has made its turns; an error if `latest` [s] or the budget [s of the wall] comes first."""
        turns, clock = self.recipe.turns, time.monotonic()
        # The angle is the first of the real outputs.
        real = self.selections[0].buffer
        start = real[0]
        step, component = self.slave.fmi2DoStep, self.component
        for point, (now, then) in enumerate(self.recipe.intervals(latest), 1):
            self._apply_inputs(now)
            try:
                step(component, now, then - now, 1)
            except FMICallException as error:
                call = f"fmi2DoStep from {plain(now)} s by {plain(then - now)} s"
                raise RunError(self._answer(call, error)) from error
            self._record()
            turned = abs(real[0] - start) / math.tau
            if then >= latest and turned < turns:
                made = f"the crank has made {turned:.3f} of {plain(turns)} turns by t = {plain(then)} s"
                raise RunError(f"{made}; give a stop time instead")
            # A billionth of a turn is what rounding leaves of a whole number of them.
            if turned / (turns - 1e-9) >= 1.0 or point == MOST_POINTS:
                return
            if point % UNWATCHED == 0 and time.monotonic() - clock > budget:
                raise RunError(f"stopped after {plain(budget)} s")

    def columns(self) -> dict[str, Column]:
        """What was recorded."""
        return {name: column for selection in self.selections for name, column in selection.columns().items()}

    def _apply_inputs(self, now: float) -> None:
        if not self.values:
            return
        angle = 0.0
        if self.wants_angle:
            self._try("reading outputs", self.angle.read, self.component)
            angle = self.angle.buffer[0]
        for place, own in enumerate(self.recipe.inputs):
            self.values[place] = own.value(now, angle)
        set_real = self.slave.fmi2SetReal
        try:
            set_real(self.component, self.inputs, len(self.inputs), self.values)
        except FMICallException as error:
            raise RunError(self._answer(f"fmi2SetReal of {list(self.inputs)}", error)) from error

    def _record(self) -> None:
        for selection in self.selections:
            self._try("reading outputs", selection.record, self.component)

    def _set(self, name: str, value: float) -> None:
        variable = self.unit.variables.get(name)
        if variable is None:
            raise RunError(f"the FMU has no variable `{name}`")
        reference = (ctypes.c_uint * 1)(variable.valueReference)
        if variable.type == "Real":
            self.slave.fmi2SetReal(self.component, reference, 1, (ctypes.c_double * 1)(value))
        elif variable.type == "Boolean":
            self.slave.fmi2SetBoolean(self.component, reference, 1, (ctypes.c_int * 1)(int(value)))
        else:
            self.slave.fmi2SetInteger(self.component, reference, 1, (ctypes.c_int * 1)(int(value)))

    def _try(self, call: str, function: Callable[..., object], *arguments: object) -> None:
        try:
            function(*arguments)
        except FMICallException as error:
            raise RunError(self._answer(call, error)) from error

    def _answer(self, call: str, error: FMICallException) -> str:
        known = 0 <= error.status < len(STATUS)
        status = STATUS[error.status] if known else f"the unknown status {error.status}"
        return f"{call} returned {status}{self._because()}"

    def _because(self) -> str:
        return "" if self.said is None else f": {self.said}"

    def _log(self, _environment: object, _name: bytes, _status: int, _category: bytes, message: bytes) -> None:
        self.said = message.decode(errors="replace")


def plain(number: float) -> str:
    """A number in the fewest digits, without an exponent."""
    return numpy.format_float_positional(number, trim="-")
