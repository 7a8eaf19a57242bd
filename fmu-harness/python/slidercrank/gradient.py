"""Exact gradients of a study's quantities by real parameters, through impacts.

A run is a chain of steps. The FMU gives each step's Jacobian by phase, parameters and inputs (`slidercrank_step_jacobian`),
and the derivatives of the start by parameters; the chain rule does the rest. What is differentiated is the very number that
a run without derivatives gives, sampled at the communication points.

Where an input over the crank's angle follows a line, the phase at the end of a step is differentiated as if the line had
moved by its mean change: an error of the second order of the step, in steps with a corner of the input.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy
from fmpy.model_description import ModelVariable

from .quantity import ANGLE, RATE, QuantityError
from .recipe import Recipe, RunError
from .unit import Instance, Unit


STEP = 1e-3
"""Steps of differences at the start, as shares of the parameters."""
LEAST = 1e-3
"""What shares are taken of, at least, of a parameter that may be negative: an offset [m] or an angle [rad] near 0."""
CENTRAL = [(-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12)]
"""Places of a difference in steps, with their weights."""

SUM = "since the start"
"""What the model description says of outputs that sum up a run."""


@dataclass(frozen=True)
class Gradient:
    """A quantity of a run with its derivatives."""

    value: float
    by_parameters: numpy.ndarray
    """In the order of the names asked for."""


def gradient(
    unit: Unit, recipe: Recipe, settings: Mapping[str, float], quantity: str, names: Sequence[str], budget: float = 600.0
) -> Gradient:
    """A kept quantity of a run with these parameters, and its derivatives by the real parameters `names`.

    Inputs among `names` are constant during the run. Where there is no derivative, near grazing, with rigid contacts, of
    discrete outputs and of sums since the start, there is a `RunError` that says so.
    """
    kept, recipe = recipe.keep[quantity], recipe.holding(names)
    try:
        crank = [ANGLE, RATE]
        outputs = [*crank, *(output for output in kept.outputs(unit.outputs) if output not in crank)]
    except QuantityError as error:
        raise RunError(f"{quantity}: {error}") from error
    for output in outputs:
        if output in unit.outputs and (why := _without_derivative(unit, unit.outputs[output])):
            raise RunError(f"{quantity}: `{output}` {why} and has no derivative")
    with _Chain(unit, recipe, settings, outputs, start(unit, recipe, settings, outputs, names)) as chain:
        chain.march(recipe.latest(settings), budget)
        columns, slopes = chain.columns(), numpy.array(chain.slopes)
    by_name = {output: slopes[:, place] for place, output in enumerate(outputs)}
    try:
        return Gradient(kept.value(columns, recipe.transient), kept.slope(columns, by_name, recipe.transient))
    except QuantityError as error:
        raise RunError(f"{quantity}: {error}") from error


def _without_derivative(unit: Unit, output: ModelVariable) -> str | None:
    """Why an output has no derivative, if it has none: the phase must determine it."""
    if output.type != unit.calls.real:
        return "is not a real output"
    if output.variability != "continuous":
        return "is discrete"
    return f"is a sum {SUM}" if SUM in output.description else None


@dataclass(frozen=True)
class Start:
    """Derivatives at the start of a run, a column for each parameter."""

    parameters: list[str]
    phase: numpy.ndarray
    outputs: numpy.ndarray


def start(
    unit: Unit, recipe: Recipe, settings: Mapping[str, float], outputs: list[str], names: Sequence[str]
) -> Start:
    """Derivatives of the start, which is smooth, by differences of order 4."""
    columns = []
    for name in names:
        value = settings[name]
        least = LEAST if unit.limits(name)[0] < 0.0 else 0.0
        step = max(abs(value), least) * STEP or STEP
        columns.append(
            sum(share / step * _started(unit, recipe, {**settings, name: value + place * step}, outputs)
                for place, share in CENTRAL)
        )
    table = numpy.array(columns).T
    return Start(list(names), table[len(outputs) :], table[: len(outputs)])


def _started(unit: Unit, recipe: Recipe, settings: Mapping[str, float], outputs: list[str]) -> numpy.ndarray:
    """Outputs at the start, and the phase there."""
    with Instance(unit, recipe, settings, outputs) as instance:
        instance.read_phase_names()
        columns = instance.columns()
        phase = instance.predict(recipe.step, []).phase
    return numpy.concatenate([[columns[output][0] for output in outputs], phase])


class _Chain(Instance):
    """A run whose steps are differentiated."""

    def __init__(self, unit: Unit, recipe: Recipe, settings: Mapping[str, float], outputs: list[str], begin: Start):
        super().__init__(unit, recipe, settings, outputs)
        self.names, self.parameters, self.phase_slopes = outputs, begin.parameters, begin.phase
        self.turning = [own for own in recipe.inputs if own.wants_angle]
        self.slopes = [begin.outputs]
        """Of the outputs at each communication point, by the parameters."""

    def _initialized(self) -> None:
        super()._initialized()
        self.read_phase_names()

    def _before(self, now: float, size: float) -> None:
        count = len(self.parameters)
        found = self.step_jacobian(size, [*self.parameters, *(own.name for own in self.turning)], self.names)
        # Inputs over the crank's angle follow angle and speed, the first outputs.
        turned, faster = self.slopes[-1][:2]
        begin = end = numpy.array([numpy.multiply(own.slope(self.angle_now), turned) for own in self.turning])
        if self.interpolates:
            angle = self.angle_now + self.speed_now * size
            end = numpy.array([own.slope(angle) * (turned + size * faster) for own in self.turning])
        # What a line does to the phase is, but for the third order of the step, what its mean does.
        mean = (begin + end) / 2.0
        direct = numpy.vstack([numpy.eye(count), *mean])
        self.slopes.append(found.outputs_by_phase @ self.phase_slopes + found.outputs_by_parameters @ direct)
        self.phase_slopes = found.phase_by_phase @ self.phase_slopes + found.phase_by_parameters @ direct
        self.missing = end - mean

    def _after(self) -> None:
        if self.interpolates:
            # Forces and accelerations follow the inputs at the end of the step.
            for own, slopes in zip(self.turning, self.missing):
                self.slopes[-1] += numpy.outer(self._effect(own.name), slopes)

    def _effect(self, name: str) -> numpy.ndarray:
        """Derivatives of the outputs by an input at constant phase."""
        outputs, input = self._references(self.names), self._references([name])
        one, effect = (ctypes.c_double * 1)(1.0), (ctypes.c_double * len(outputs))()
        self._standard("GetDirectionalDerivative", outputs, len(outputs), input, 1, one, effect)
        return numpy.array(effect)
