"""How every run of a study is done: communication points, inputs, what is kept."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from .quantity import Quantity, plain

SPEED = "crank.speed_start"
"""Parameter that says how long turns may take."""
SLIVER = 1e-6
"""Share of a step that is what remains of a quotient that was meant to be whole."""
MOST_POINTS = 20_000_000
"""A run with more communication points than this counts as a mistake."""


class RunError(RuntimeError):
    """Why a run has no results."""


class StoppedError(RunError):
    """The budget that ended a run, which another budget may not."""


Line = tuple[tuple[float, float], tuple[float, float]]
"""A straight line between two points."""


@dataclass(frozen=True)
class Input:
    """An input: a constant, or straight lines between points over time or over the crank's turn."""

    name: str
    constant: float | None
    against: str | None
    points: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> Input:
        points = tuple((float(x), float(y)) for x, y in told.get("points", []))
        return cls(told["name"], told.get("constant"), told.get("against"), points)

    @property
    def wants_angle(self) -> bool:
        """Whether it needs the crank's angle."""
        return self.against == "crank.angle"

    def value(self, time: float, angle: float) -> float:
        """At a time [s] and crank angle [rad]; over time the ends hold, over the angle the turn repeats."""
        if self.constant is not None:
            return self.constant
        if not self.points:
            return 0.0
        at = wrapped(angle) if self.wants_angle else time
        (x0, y0), _ = line = self._line(at)
        return y0 + _steepness(line) * (at - x0)

    def chord(self, now: float, then: float, angle: float, speed: float) -> tuple[float, float]:
        """Value at `now` [s] and slope [1/s] to `then` [s]; the crank turns on from `angle` [rad] at `speed` [rad/s]."""
        value, step = self.value(now, angle), then - now
        return value, (self.value(then, angle + speed * step) - value) / step

    def slope(self, angle: float) -> float:
        """Per radian of the crank at this angle [rad], of an input over it."""
        return _steepness(self._line(wrapped(angle))) if self.wants_angle and self.points else 0.0

    def _line(self, at: float) -> Line:
        first, last = self.points[0], self.points[-1]
        after = bisect_right(self.points, at, key=lambda point: point[0])
        if 0 < after < len(self.points):
            return self.points[after - 1], self.points[after]
        if not self.wants_angle:
            return (first, first) if after == 0 else (last, last)
        if after == 0:
            return (last[0] - math.tau, last[1]), first
        return last, (first[0] + math.tau, first[1])


def _steepness(line: Line) -> float:
    (x0, y0), (x1, y1) = line
    return (y1 - y0) / (x1 - x0) if x0 < x1 else 0.0


def wrapped(angle: float) -> float:
    """[rad] In 0 ..= 2π, rounded as the harness rounds it."""
    rest = math.fmod(angle, math.tau)
    return rest + math.tau if rest < 0.0 else rest


@dataclass(frozen=True)
class Recipe:
    """What all runs of a study have in common."""

    name: str
    digest: str
    """Of study, scene and plan: what a journal belongs to."""
    scene: str
    turns: float
    """Turns of the crank in a run."""
    transient: float
    """Turns of these that are forgotten."""
    step: float
    """[s] Between communication points."""
    slow: float
    """How long a crank may take for its turns, over what it would at the speed of its start."""
    speed: float
    """[rad/s] The scene's speed at the start."""
    inputs: tuple[Input, ...]
    keep: dict[str, Quantity]
    origin: dict[str, str]
    """What the results are made from, for their metadata."""

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> Recipe:
        """From what `sweep --plan` writes."""
        run = told["run"]
        return cls(
            name=told["name"],
            digest=told["digest"],
            scene=told["scene"],
            turns=run["turns"],
            transient=run["transient"],
            step=run["step"],
            slow=told["slow"],
            speed=told["speed"],
            inputs=tuple(map(Input.of, told["inputs"])),
            keep={name: Quantity(**quantity) for name, quantity in told["keep"].items()},
            origin=dict(told["origin"]),
        )

    def holding(self, names: Container[str]) -> Recipe:
        """The recipe without the inputs of these names: they hold the values that the settings give them."""
        return replace(self, inputs=tuple(own for own in self.inputs if own.name not in names))

    def latest(self, settings: Mapping[str, float]) -> float:
        """[s] When a run has taken too long for its turns."""
        speed = abs(settings.get(SPEED, self.speed))
        if not speed > 0.0:
            raise RunError(f"{SPEED} = 0 rad/s: turns cannot be counted if the crank does not turn")
        span = self.turns * math.tau / speed
        if span > (MOST_POINTS + SLIVER) * self.step:
            raise self._too_many()
        return self.slow * span

    def intervals(self, latest: float) -> Iterator[tuple[float, float]]:
        """[s] Ends of the communication steps: whole multiples of the step, the last one shortened to end in time."""
        sliver = SLIVER * self.step
        point = 0
        while point * self.step < latest - sliver:
            point += 1
            if point > MOST_POINTS:
                raise self._too_many()
            to = point * self.step
            yield (point - 1) * self.step, latest if to > latest - sliver else to

    def _too_many(self) -> RunError:
        points = f"more than {MOST_POINTS} communication points"
        return RunError(f"with a communication step of {plain(self.step)} s the run has {points}")
