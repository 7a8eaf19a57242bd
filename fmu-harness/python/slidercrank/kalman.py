"""Motion and parameters of a machine from measured outputs: an extended and an unscented Kalman filter on the FMU.

What is estimated is the phase of the mechanism and, behind it, real parameters. Both filters begin at the unit's
communication point, predict with the FMU's own step and correct phase and parameters of its instance. The extended one
needs one step with its Jacobian for each measurement, the unscented one 2·n + 1 plain steps for n estimated numbers.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy
import pandas

from .unit import Unit


TRUST = 3.0
"""Standard deviations beyond which a measurement does not correct more."""
LEAST = 0.1
"""Share of its first guess below which a parameter that must be above 0 does not fall."""


@dataclass(frozen=True)
class Task:
    """What is measured, and what is to be found."""

    output: str
    """The measured output."""
    noise: float
    """Its standard deviation."""
    step: float
    """[s] Between measurements."""
    parameters: Mapping[str, tuple[float, float]]
    """First guesses of parameters and their standard deviations."""
    phase: float
    """Standard deviation of each number of the first phase, over its `scale`."""
    drift: float
    """Standard deviation that a step adds to each number of the phase, over its `scale`."""
    scale: Mapping[str, float]
    """Scales of the phase's numbers."""

    def scales(self, names: Sequence[str]) -> numpy.ndarray:
        """Scales in the order of the phase; without one, a number is not estimated."""
        for name in self.scale:
            if name not in names:
                raise KeyError(f"the phase has no `{name}`: {', '.join(names)}")
        return numpy.array([self.scale.get(name, 0.0) for name in names])


@dataclass(frozen=True)
class Estimate:
    """What a filter has found."""

    course: pandas.DataFrame
    """Parameters, and their standard deviations as `… ±`, after each measurement, over time [s]."""
    innovation: numpy.ndarray
    """Measured minus predicted, over its standard deviation."""
    seconds: float
    """Wall time."""
    steps: int
    """Steps that the FMU made, with or without Jacobian."""


class _Filter:
    """What both filters have in common."""

    def __init__(self, unit: Unit, task: Task):
        self.unit, self.task, self.names = unit, task, list(task.parameters)
        self.scales = task.scales(unit.phase_names)
        guesses = numpy.array([*task.parameters.values()], float).reshape(-1, 2)
        self.phase = unit.predict(task.step).phase
        self.parameters = guesses[:, 0]
        self.least, self.greatest = numpy.array([unit.limits(name) for name in self.names]).reshape(-1, 2).T
        # A clearance or a mass that came down to its legal minimum would be another machine.
        self.least = numpy.where(self.least > 0.0, numpy.maximum(self.least, LEAST * self.parameters), self.least)
        self.covariance = numpy.diag(numpy.concatenate([task.phase * self.scales, guesses[:, 1]]) ** 2)
        drift = numpy.concatenate([task.drift * self.scales, numpy.zeros(len(guesses))])
        self.drift = numpy.diag(drift**2)
        self.steps = 0

    def place(self, phase: numpy.ndarray, parameters: numpy.ndarray) -> None:
        """Continues from this phase; beyond its range a parameter acts as at the limit."""
        self.unit.set_phase(phase, dict(zip(self.names, map(float, self.legal(parameters)))))

    def legal(self, parameters: numpy.ndarray) -> numpy.ndarray:
        return parameters.clip(self.least, self.greatest)

    def follow(self, measured: numpy.ndarray) -> Estimate:
        began, rows, innovations = time.perf_counter(), [], []
        count = len(self.phase)
        for value in measured:
            predicted, gain, variance = self.predict()
            innovation = value - predicted
            # Around an impact predictions err by more than their variance tells.
            trusted = float(numpy.clip(innovation, -TRUST * variance**0.5, TRUST * variance**0.5))
            self.phase = self.phase + gain[:count] * trusted
            self.parameters = self.legal(self.parameters + gain[count:] * trusted)
            self.covariance -= numpy.outer(gain, gain) * variance
            # Rounding must not make it lopsided.
            self.covariance = 0.5 * (self.covariance + self.covariance.T)
            self.unit.step(self.task.step)
            self.place(self.phase, self.parameters)
            innovations.append(innovation / variance**0.5)
            deviations = numpy.sqrt(numpy.diag(self.covariance)[count:].clip(0.0))
            rows.append([*self.parameters, *deviations])
        names = [*self.names, *(f"{name} ±" for name in self.names)]
        times = pandas.Index(self.task.step * numpy.arange(1, len(rows) + 1), name="time")
        seconds = time.perf_counter() - began
        return Estimate(pandas.DataFrame(rows, times, names), numpy.array(innovations), seconds, self.steps)

    def predict(self) -> tuple[float, numpy.ndarray, float]:
        """Predicted measurement, gain and variance of the innovation; phase and covariance go on by a step."""
        raise NotImplementedError


class _Extended(_Filter):
    def predict(self) -> tuple[float, numpy.ndarray, float]:
        task, count = self.task, len(self.phase)
        self.place(self.phase, self.parameters)
        found = self.unit.step_jacobian(task.step, self.names, [task.output])
        self.steps += 1
        jacobian = numpy.eye(count + len(self.names))
        jacobian[:count] = numpy.hstack([found.phase_by_phase, found.phase_by_parameters])
        slope = numpy.concatenate([found.outputs_by_phase[0], found.outputs_by_parameters[0]])
        # The output is that at the step's end, its derivative by what was before.
        variance = slope @ self.covariance @ slope + task.noise**2
        across = jacobian @ self.covariance @ slope
        self.phase = found.next_phase
        self.covariance = jacobian @ self.covariance @ jacobian.T + self.drift
        return float(found.next_outputs[0]), across / variance, float(variance)


class _Unscented(_Filter):
    def predict(self) -> tuple[float, numpy.ndarray, float]:
        task, count = self.task, len(self.phase)
        free = numpy.flatnonzero(numpy.concatenate([self.scales, numpy.ones(len(self.names))]))
        size = len(free)
        root = numpy.linalg.cholesky(self.covariance[numpy.ix_(free, free)])
        middle = numpy.concatenate([self.phase, self.parameters])
        points = numpy.tile(middle, (2 * size + 1, 1))
        for place, column in enumerate(root.T):
            points[1 + place, free] += size**0.5 * column
            points[1 + size + place, free] -= size**0.5 * column
        told = numpy.empty(len(points))
        for place, point in enumerate(points):
            self.place(point[:count], point[count:])
            found = self.unit.predict(task.step, [task.output])
            points[place, :count], told[place] = found.next_phase, found.next_outputs[0]
        self.steps += len(points)
        # Points at √n standard deviations have the same weight, and the middle has none.
        weight = numpy.full(len(points), 0.5 / size)
        weight[0] = 0.0
        mean, predicted = weight @ points, weight @ told
        apart = (points - mean)[:, free]
        variance = weight @ (told - predicted) ** 2 + task.noise**2
        across = numpy.zeros(len(middle))
        across[free] = (weight * (told - predicted)) @ apart
        self.covariance[numpy.ix_(free, free)] = (weight * apart.T) @ apart
        self.covariance += self.drift
        # Approach speeds are those of the middle, since contacts may be open in some points.
        self.phase = numpy.where(self.scales > 0.0, mean[:count], points[0, :count])
        return float(predicted), across / variance, float(variance)


def extended(unit: Unit, task: Task, measured: numpy.ndarray) -> Estimate:
    """By an extended Kalman filter: the covariance goes on by the exact Jacobian of the step."""
    return _Extended(unit, task).follow(measured)


def unscented(unit: Unit, task: Task, measured: numpy.ndarray) -> Estimate:
    """By an unscented Kalman filter (Julier and Uhlmann, κ = 0): the covariance goes on by points around the middle."""
    return _Unscented(unit, task).follow(measured)
