"""An unpacked FMU, and one run of it through FMPy's low-level calls."""

from __future__ import annotations

import ctypes
import math
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Self

import numpy
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelVariable

from .calls import Number, load
from .quantity import ANGLE, RATE, ROUNDING, TIME, Column, QuantityError, plain
from .recipe import Recipe, RunError, StoppedError
from .setting import Value, limits, value_of

STATUS = ["OK", "Warning", "Discard", "Error", "Fatal", "Pending"]
UNWATCHED = 8
"""Steps between two looks at the clock."""

_loading = threading.Lock()  # FMPy changes the working directory while it loads a library


class Unit:
    """An FMU unpacked into a directory, its library loaded.

    `run` makes one run of a study. `start`, `step`, `read`, `predict`, `step_jacobian` and `set_phase` are for estimators.
    Without a directory the FMU is unpacked into a temporary one.
    """

    def __init__(self, fmu: str | Path, into: Path | None = None):
        if into is None:
            self._folder = TemporaryDirectory(prefix="fmu-", ignore_cleanup_errors=True)
            into = Path(self._folder.name)
        self._started: Estimated | None = None
        with _loading:
            extract(str(fmu), unzipdir=str(into))
            self.description = read_model_description(str(fmu))
            self.variables = {variable.name: variable for variable in self.description.modelVariables}
            self.calls = load(self.description, into)
        self.outputs = {
            name: variable
            for name, variable in self.variables.items()
            if variable.causality == "output" and variable.type in self.calls.kinds
        }

    def run(self, recipe: Recipe, settings: Mapping[str, float], budget: float = 600.0) -> list[float]:
        """The recipe's quantities in a run with these parameters, in the order of its `keep`.

        Inputs that change follow a straight line over each step. In FMI 3.0, which has no slopes of inputs, they are held.
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

    def limits(self, name: str) -> tuple[float, float]:
        """The least and the greatest legal value of a variable; 0 and 1 are false and true."""
        return limits(self.variable(name))

    def variable(self, name: str) -> ModelVariable:
        variable = self.variables.get(name)
        if variable is None:
            raise RunError(f"the FMU has no variable `{name}`")
        return variable

    def start(self, settings: Mapping[str, Value] | None = None) -> None:
        """Starts an instance with these parameters and inputs at time 0, in place of the one before.

        An item of an enumeration is given by its number or its name.
        """
        self.stop()
        instance = Estimated(self, settings or {})
        instance.__enter__()
        self._started = instance

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Frees the instance, if one was started."""
        if self._started is not None:
            self._started.__exit__()
            self._started = None

    @property
    def time(self) -> float:
        """[s] The communication point reached."""
        return self._estimated.time

    def step(self, size: float) -> None:
        """Moves the instance by a step [s]."""
        self._estimated.step(size)

    def read(self, names: Sequence[str]) -> numpy.ndarray:
        """Real variables at the communication point."""
        return self._estimated.read(names)

    def set_inputs(self, values: Mapping[str, float]) -> None:
        """Sets inputs from the communication point on."""
        self._estimated.set_inputs(values)

    @property
    def phase_names(self) -> list[str]:
        """Names of the numbers of a phase: `state.…`, then `joint.….approach`."""
        return self._estimated.phase_names

    def predict(self, step: float, outputs: Sequence[str] = ()) -> Step:
        """Where a step [s] leads; the instance stays where it is."""
        return self._estimated.predict(step, outputs)

    def step_jacobian(
        self, step: float, parameters: Sequence[str] = (), outputs: Sequence[str] = ()
    ) -> StepJacobian:
        """Where a step [s] leads, and its derivatives by the phase and by real parameters and inputs.

        They are exact, through impacts. The instance stays where it is. Where a contact grazes, there is no derivative
        and so a `RunError`.
        """
        return self._estimated.step_jacobian(step, parameters, outputs)

    def set_phase(self, phase: numpy.ndarray, parameters: Mapping[str, float] | None = None) -> None:
        """Continues from this phase, with these values of real parameters.

        A contact without a positive approach speed is open, and a contact that contradicts its penetration follows it.
        """
        self._estimated.set_phase(phase, parameters or {})

    @property
    def _estimated(self) -> Estimated:
        if self._started is None:
            raise RunError("no instance was started")
        return self._started


@dataclass(frozen=True)
class Step:
    """Both ends of a step."""

    phase_names: list[str]
    outputs: list[str]
    """Names of `next_outputs`."""
    phase: numpy.ndarray
    """Where the step begins."""
    next_phase: numpy.ndarray
    """Where it ends."""
    next_outputs: numpy.ndarray


@dataclass(frozen=True)
class StepJacobian(Step):
    """A step with its derivatives. Rows are those of the phase or the outputs, columns of the phase or `parameters`."""

    parameters: list[str]
    """Names of columns."""
    phase_by_phase: numpy.ndarray
    phase_by_parameters: numpy.ndarray
    outputs_by_phase: numpy.ndarray
    outputs_by_parameters: numpy.ndarray


class Selection:
    """Outputs of one type, read together."""

    def __init__(self, call: Callable[..., int], kind: Number, variables: list[ModelVariable]):
        self.call, self.kind = call, kind
        self.names = [variable.name for variable in variables]
        self.references = (ctypes.c_uint * len(variables))(*(variable.valueReference for variable in variables))
        self.buffer = (kind * len(variables))()
        self.rows = bytearray()

    def read(self, component: int) -> None:
        self.call(component, self.references, len(self.names), self.buffer)

    def record(self, component: int) -> None:
        self.read(component)
        self.rows += bytes(self.buffer)

    def columns(self) -> dict[str, Column]:
        table = numpy.frombuffer(self.rows, dtype=self.kind).reshape(-1, len(self.names))
        return {name: numpy.ascontiguousarray(table[:, place], float) for place, name in enumerate(self.names)}


class Session:
    """One instance: instantiated with parameters, initialised, freed."""

    def __init__(self, unit: Unit, settings: Mapping[str, Value]):
        self.unit, self.calls = unit, unit.calls
        self.said: str | None = None
        self.settings = settings
        self.phase_names: list[str] = []
        self.component: int | None = None

    def __enter__(self) -> Self:
        self.component, self.callbacks = self.calls.instantiate(self._log)
        if not self.component:
            raise RunError(f"the FMU could not be instantiated{self._because()}")
        try:
            for name, value in self.settings.items():
                self._try(f"setting `{name}`", self._set, name, value)
            for function, *arguments in self.calls.entering:
                self._standard(function, *arguments)
            self._initialize()
            self._standard("ExitInitializationMode")
            self._initialized()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self.component:
            self.calls.of("FreeInstance")(self.component)
            self.component = None

    def _initialize(self) -> None:
        """What is done in initialization mode."""

    def _initialized(self) -> None:
        """What is done at the start."""

    def _references(self, names: Iterable[str]) -> ctypes.Array[ctypes.c_uint]:
        variables = [self.unit.variable(name) for name in names]
        return (ctypes.c_uint * len(variables))(*(variable.valueReference for variable in variables))

    def _set(self, name: str, value: Value) -> None:
        variable = self.unit.variable(name)
        try:
            own = value_of(variable, value)
        except ValueError as error:
            raise RunError(str(error)) from error
        kind, number = self.calls.kinds[variable.type]
        values = numpy.array([own], number).ctypes.data_as(ctypes.POINTER(number))
        self.calls.access("Set", kind)(self.component, self._references([name]), 1, values)

    def _standard(self, function: str, *arguments: object) -> None:
        self._try(self.calls.prefix + function, self.calls.of(function), self.component, *arguments)

    def _stepping(self, now: float, size: float) -> str:
        return f"{self.calls.prefix}DoStep from {plain(now)} s by {plain(size)} s"

    def _try(self, call: str, function: Callable[..., object], *arguments: object) -> None:
        try:
            function(*arguments)
        except FMICallException as error:
            raise RunError(self._answer(call, error)) from error

    def _answer(self, call: str, error: FMICallException) -> str:
        return self._told(call, error.status)

    def _told(self, call: str, status: int) -> str:
        known = 0 <= status < len(STATUS)
        name = self.calls.prefix + STATUS[status] if known else f"the unknown status {status}"
        return f"{call} returned {name}{self._because()}"

    def _because(self) -> str:
        return "" if self.said is None else f": {self.said}"

    def read_phase_names(self) -> None:
        size = ctypes.c_size_t()
        self._call("phase_names", None, ctypes.byref(size))
        names = ctypes.create_string_buffer(size.value)
        self._call("phase_names", names, ctypes.byref(size))
        self.phase_names = names.value.decode().splitlines()

    def predict(self, step: float, outputs: Sequence[str]) -> Step:
        count = len(self.phase_names)
        phase, after, told = numpy.empty(count), numpy.empty(count), numpy.empty(len(outputs))
        self._map(step, [], outputs, [phase, after, told], [None] * 4)
        return Step(list(self.phase_names), list(outputs), phase, after, told)

    def step_jacobian(self, step: float, parameters: Sequence[str], outputs: Sequence[str]) -> StepJacobian:
        count, rows, columns = len(self.phase_names), len(outputs), len(parameters)
        phase, after, told = numpy.empty(count), numpy.empty(count), numpy.empty(rows)
        matrices = [numpy.empty(shape) for shape in [(count, count), (count, columns), (rows, count), (rows, columns)]]
        self._map(step, parameters, outputs, [phase, after, told], matrices)
        return StepJacobian(list(self.phase_names), list(outputs), phase, after, told, list(parameters), *matrices)

    def _map(
        self,
        step: float,
        parameters: Sequence[str],
        outputs: Sequence[str],
        vectors: Sequence[numpy.ndarray],
        matrices: Sequence[numpy.ndarray | None],
    ) -> None:
        by, of, count = self._references(parameters), self._references(outputs), ctypes.c_size_t(len(self.phase_names))
        self._call(
            "step_jacobian",
            ctypes.c_double(step),
            by,
            ctypes.c_size_t(len(by)),
            of,
            ctypes.c_size_t(len(of)),
            ctypes.byref(count),
            *map(_pointer, vectors),
            *map(_pointer, matrices),
        )

    def _call(self, name: str, *arguments: object) -> None:
        name = self.calls.own + name
        function = getattr(self.calls.slave.dll, name, None)
        if function is None:
            raise RunError(f"the FMU has no function `{name}`")
        status = function(ctypes.c_void_p(self.component), *arguments)
        if status != 0:
            raise RunError(self._told(name, status))

    def _log(self, *told: bytes) -> None:
        self.said = told[-1].decode(errors="replace")


class Instance(Session):
    """One run: instantiated, initialised, marched."""

    def __init__(self, unit: Unit, recipe: Recipe, settings: Mapping[str, float], names: list[str]):
        super().__init__(unit, settings)
        self.recipe = recipe
        kinds = dict(self.calls.kinds.values())
        groups: dict[str, list[ModelVariable]] = {kind: [] for kind in kinds}
        for name in names:
            if name not in unit.outputs:
                raise RunError(f"turns cannot be counted: `{name}` is not an output of this FMU")
            variable = unit.outputs[name]
            groups[self.calls.kinds[variable.type][0]].append(variable)
        select = lambda kind, group: Selection(self.calls.access("Get", kind), kinds[kind], group)
        self.selections = [select(kind, group) for kind, group in groups.items() if group]
        self.crank = select(self.calls.real, [unit.outputs[name] for name in (ANGLE, RATE) if name in unit.outputs])
        self.angle_now, self.speed_now = 0.0, 0.0
        self.times = [0.0]
        """[s] The communication points."""
        self.inputs, real = self._references(own.name for own in recipe.inputs), ctypes.c_double * len(recipe.inputs)
        self.values, self.rates, self.set_real = real(), real(), self.calls.access("Set", self.calls.real)
        self.wants_angle = any(own.wants_angle for own in recipe.inputs)
        self.interpolates = self.calls.interpolates and (RATE in unit.outputs or not self.wants_angle)
        """Whether inputs follow straight lines over a step; otherwise they are held."""

    def _initialize(self) -> None:
        self._look()
        self.values[:] = [own.value(0.0, self.angle_now) for own in self.recipe.inputs]
        self._set_inputs(f"Set{self.calls.real}", self.set_real, self.values)

    def _initialized(self) -> None:
        self._record()

    def march(self, latest: float, budget: float) -> None:
        """Steps until the crank has made its turns; an error if `latest` [s] or the budget [s of the wall] comes first."""
        turns, clock = self.recipe.turns, time.monotonic()
        # The angle is the first of the real outputs.
        real = self.selections[0].buffer
        start = real[0]
        for point, (now, then) in enumerate(self.recipe.intervals(latest), 1):
            self._apply_inputs(now, then)
            self._before(now, then - now)
            try:
                self.calls.do_step(self.component, now, then - now)
            except FMICallException as error:
                raise RunError(self._answer(self._stepping(now, then - now), error)) from error
            self._record()
            self._after()
            self.times.append(then)
            turned = abs(real[0] - start) / math.tau
            if then >= latest and turned < turns:
                made = f"the crank has made {turned:.3f} of {plain(turns)} turns by t = {plain(then)} s"
                raise RunError(f"{made}; give a stop time instead")
            if turned / (turns - ROUNDING) >= 1.0:
                return
            if point % UNWATCHED == 0 and time.monotonic() - clock > budget:
                raise StoppedError(f"stopped after {plain(budget)} s")

    def _before(self, now: float, size: float) -> None:
        """What is done before a step from `now` [s] by `size` [s]."""

    def _after(self) -> None:
        """What is done after a step."""

    def columns(self) -> dict[str, Column]:
        """What was recorded."""
        outputs = {name: column for selection in self.selections for name, column in selection.columns().items()}
        return {TIME: numpy.array(self.times), **outputs}

    def _look(self) -> None:
        """Reads how the crank turns, if an input depends on it."""
        if self.wants_angle:
            self._try("reading outputs", self.crank.read, self.component)
            self.angle_now, self.speed_now = [*self.crank.buffer, 0.0][:2]

    def _apply_inputs(self, now: float, then: float) -> None:
        self._look()
        for place, own in enumerate(self.recipe.inputs):
            self.values[place], self.rates[place] = own.chord(now, then, self.angle_now, self.speed_now)
        self._set_inputs(f"Set{self.calls.real}", self.set_real, self.values)
        if self.interpolates:
            self._set_inputs("SetRealInputDerivatives", self.calls.set_slopes, self.rates)

    def _set_inputs(self, name: str, function: Callable[..., object], values: object) -> None:
        if not self.recipe.inputs:
            return
        try:
            function(self.component, self.inputs, len(self.inputs), values)
        except FMICallException as error:
            raise RunError(self._answer(f"{self.calls.prefix}{name} of {list(self.inputs)}", error)) from error

    def _record(self) -> None:
        for selection in self.selections:
            self._try("reading outputs", selection.record, self.component)


class Estimated(Session):
    """One instance at a communication point, for an estimator. The functions beside the standard's are in the guide."""

    def __init__(self, unit: Unit, settings: Mapping[str, Value]):
        super().__init__(unit, settings)
        self.time = 0.0

    def _initialized(self) -> None:
        self.read_phase_names()

    def step(self, size: float) -> None:
        self._try(self._stepping(self.time, size), self.calls.do_step, self.component, self.time, size)
        self.time += size

    def read(self, names: Sequence[str]) -> numpy.ndarray:
        values = (ctypes.c_double * len(names))()
        references = self._references(names)
        get, real = self.calls.access("Get", self.calls.real), f"{self.calls.prefix}Get{self.calls.real}"
        self._try(real, get, self.component, references, len(names), values)
        return numpy.array(values)

    def set_inputs(self, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            self._try(f"setting `{name}`", self._set, name, value)

    def set_phase(self, phase: numpy.ndarray, parameters: Mapping[str, float]) -> None:
        numbers = numpy.ascontiguousarray(phase, float)
        values = numpy.array([*parameters.values()], float)
        references = self._references(parameters)
        self._call(
            "set_phase",
            _pointer(numbers),
            ctypes.c_size_t(numbers.size),
            references,
            ctypes.c_size_t(len(references)),
            _pointer(values),
        )


def _pointer(array: numpy.ndarray | None) -> ctypes.c_void_p:
    return ctypes.c_void_p(None if array is None else array.ctypes.data)
