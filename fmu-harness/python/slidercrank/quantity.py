"""One number of a run: an output, reduced over time or over its passages of a crank angle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy
from numpy.typing import NDArray

ANGLE = "crank.angle"
"""The output that counts turns."""

Column = NDArray[numpy.float64]


class QuantityError(ValueError):
    """Why a quantity has no value."""


def total(values: Column) -> float:
    """The sum from the first to the last; numpy's own adds in pairs."""
    return float(numpy.add.accumulate(values)[-1]) if len(values) else 0.0


def mean(values: Column) -> float:
    return total(values) / len(values) if len(values) else math.nan


def deviation(values: Column) -> float:
    off = values - mean(values)
    return math.sqrt(total(off * off) / (len(values) - 1)) if len(values) > 1 else math.nan


def least(values: Column) -> float:
    return float(numpy.fmin.reduce(values)) if len(values) else math.nan


def greatest(values: Column) -> float:
    return float(numpy.fmax.reduce(values)) if len(values) else math.nan


REDUCTIONS = {
    "min": least,
    "max": greatest,
    "peak": lambda values: max(abs(least(values)), abs(greatest(values))),
    "range": lambda values: greatest(values) - least(values),
    "mean": mean,
    "rms": lambda values: math.sqrt(mean(values * values)),
    "deviation": deviation,
    "last": lambda values: float(values[-1]) if len(values) else math.nan,
}
"""How many values become one."""


@dataclass(frozen=True)
class Quantity:
    """What is kept of a run."""

    of: str
    """An output, or the length of a vector of two: `joint.C.force` stands for its x and y."""
    reduce: str
    """One of `REDUCTIONS`."""
    at: float | None = None
    """[rad] If there, only the passages of this crank angle count."""

    def outputs(self, known: Mapping[str, object]) -> list[str]:
        """The outputs that it is made of."""
        parts = [self.of] if self.of in known else [f"{self.of}.x", f"{self.of}.y"]
        if not all(part in known for part in parts):
            raise QuantityError(f"no column `{self.of}`")
        return parts

    def value(self, columns: Mapping[str, Column], transient: float) -> float:
        """In a run without its first `transient` turns."""
        parts = [columns[part] for part in self.outputs(columns)]
        values = parts[0] if len(parts) == 1 else numpy.sqrt(parts[0] * parts[0] + parts[1] * parts[1])
        angles = columns[ANGLE]
        kept = numpy.abs(angles - angles[0]) >= math.tau * transient
        first = int(numpy.argmax(kept)) if kept.any() else len(kept)
        angles, values = angles[first:], values[first:]
        with numpy.errstate(all="ignore"):
            found = REDUCTIONS[self.reduce](values if self.at is None else passages(angles, values, self.at))
        if not math.isfinite(found):
            shown = "NaN" if math.isnan(found) else str(found)
            raise QuantityError(f"{self.of} of {len(values)} values is {shown}")
        return found


def passages(angles: Column, values: Column, at: float) -> Column:
    """Values where the angle passes `at`, whichever way, each interpolated between two communication points."""
    turns = (angles - at) / math.tau
    before, after = turns[:-1], turns[1:]
    place = numpy.flatnonzero((numpy.floor(before) != numpy.floor(after)) & (after != before))
    before, after = before[place], after[place]
    passed = numpy.floor(numpy.maximum(before, after))
    share = (passed - before) / (after - before)
    return values[place] + share * (values[place + 1] - values[place])
