"""One number of a run: an output, reduced over time or over its passages of a crank angle."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy
from numpy.typing import NDArray

ANGLE = "crank.angle"
"""The output that counts turns."""
RATE = "crank.speed"
"""The output at whose rate the angle moves on."""
TIME = "time"
"""[s] The communication points, beside the outputs."""

ROUNDING = 1e-9
"""[turns] By how much rounding may shift a communication point that is at an angle, or at the end of whole turns."""

Column = NDArray[numpy.float64]


class QuantityError(ValueError):
    """Why a quantity has no value."""


def plain(number: float) -> str:
    """A number in the fewest digits, without an exponent."""
    return numpy.format_float_positional(number, trim="-")


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


def weighted(values: Column, weights: Column) -> float:
    whole = total(weights)
    return total(weights * values) / whole if whole else math.nan


def weighted_deviation(values: Column, weights: Column) -> float:
    off = values - weighted(values, weights)
    return math.sqrt(weighted(off * off, weights))


OVER_TIME: dict[str, Callable[[Column, Column], float]] = {
    "mean": weighted,
    "rms": lambda values, weights: math.sqrt(weighted(values * values, weights)),
    "deviation": weighted_deviation,
}
"""Those of values that stand for some time each."""


def weights_of(times: Column) -> Column:
    """[s] The time that each of these instants stands for, as in the trapezoidal rule: half of the intervals beside it."""
    ends = numpy.concatenate([times[:1], times, times[-1:]])
    weights: Column = (ends[2:] - ends[:-2]) / 2.0
    return weights


def _one(values: Column, place: int, share: float = 1.0) -> Column:
    shares = numpy.zeros(len(values))
    shares[place] = share
    return shares


def _peak(values: Column) -> Column:
    place = int(numpy.nanargmax(numpy.abs(values)))
    return _one(values, place, math.copysign(1.0, values[place]))


SHARES: dict[str, Callable[[Column], Column]] = {
    "min": lambda values: _one(values, int(numpy.nanargmin(values))),
    "max": lambda values: _one(values, int(numpy.nanargmax(values))),
    "peak": _peak,
    "range": lambda values: SHARES["max"](values) - SHARES["min"](values),
    "mean": lambda values: numpy.full(len(values), 1.0 / len(values)),
    "rms": lambda values: values / (len(values) * REDUCTIONS["rms"](values)),
    "deviation": lambda values: (values - mean(values)) / ((len(values) - 1) * deviation(values)),
    "last": lambda values: _one(values, -1),
}
"""Derivatives of each reduction by the values."""

SHARES_OVER_TIME: dict[str, Callable[[Column, Column], Column]] = {
    "mean": lambda values, weights: weights / total(weights),
    "rms": lambda values, weights: weights * values / (total(weights) * OVER_TIME["rms"](values, weights)),
    "deviation": lambda values, weights: weights
    * (values - weighted(values, weights))
    / (total(weights) * weighted_deviation(values, weights)),
}
"""Derivatives of those of values that stand for some time each."""


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
        values, first = self._values(columns), self._first(columns, transient)
        angles, values = columns[ANGLE][first:], values[first:]
        with numpy.errstate(all="ignore"):
            if self.at is None and self.reduce in OVER_TIME:
                found = OVER_TIME[self.reduce](values, weights_of(columns[TIME][first:]))
            else:
                values = values if self.at is None else passages(angles, values, self.at)
                found = REDUCTIONS[self.reduce](values)
        if not math.isfinite(found):
            shown = "NaN" if math.isnan(found) else str(found)
            what = "values" if self.at is None else f"passages of {plain(self.at)} rad"
            raise QuantityError(f"{self.of} of {len(values)} {what} is {shown}")
        return found

    def slope(self, columns: Mapping[str, Column], slopes: Mapping[str, Column], transient: float) -> Column:
        """The derivatives of a value that is finite, given those of the outputs: a row for each sample."""
        first = self._first(columns, transient)
        values, by = self._values(columns)[first:], self._slopes(columns, slopes)[first:]
        if self.at is not None:
            angles, by_angles = columns[ANGLE][first:], slopes[ANGLE][first:]
            by = passage_slopes(angles, values, by_angles, by, self.at)
            values = passages(angles, values, self.at)
        if self.at is None and self.reduce in OVER_TIME:
            shares = SHARES_OVER_TIME[self.reduce](values, weights_of(columns[TIME][first:]))
        else:
            shares = SHARES[self.reduce](values)
        found: Column = shares @ by
        if not numpy.isfinite(found).all():
            raise QuantityError(f"{self.of} has no finite derivatives")
        return found

    def _values(self, columns: Mapping[str, Column]) -> Column:
        parts = [columns[part] for part in self.outputs(columns)]
        return parts[0] if len(parts) == 1 else numpy.sqrt(parts[0] * parts[0] + parts[1] * parts[1])

    def _slopes(self, columns: Mapping[str, Column], slopes: Mapping[str, Column]) -> Column:
        names = self.outputs(columns)
        if len(names) == 1:
            return slopes[names[0]]
        length = numpy.maximum(self._values(columns), numpy.finfo(float).tiny)
        parts = [(columns[name] / length)[:, None] * slopes[name] for name in names]
        found: Column = numpy.sum(parts, axis=0)
        return found

    def _first(self, columns: Mapping[str, Column], transient: float) -> int:
        """The first sample that counts."""
        angles = columns[ANGLE]
        kept = numpy.abs(angles - angles[0]) >= math.tau * (transient - ROUNDING)
        return int(numpy.argmax(kept)) if kept.any() else len(kept)


def passages(angles: Column, values: Column, at: float) -> Column:
    """Values where the angle passes `at`, whichever way, each interpolated between two communication points.

    A run that starts there has not passed it, one that ends there has; a communication point that is off the angle by
    rounding is there.
    """
    place, share = _passed(angles, at)
    return values[place] + share * (values[place + 1] - values[place])


def passage_slopes(angles: Column, values: Column, by_angles: Column, by_values: Column, at: float) -> Column:
    """Derivatives of `passages`, given those of angles and values."""
    place, share = _passed(angles, at)
    span = (angles[place + 1] - angles[place])[:, None]
    late = share[:, None]
    # share = (passed − before)/(after − before)
    by_share = -(by_angles[place] * (1.0 - late) + by_angles[place + 1] * late) / span
    step = (values[place + 1] - values[place])[:, None]
    found: Column = by_values[place] + late * (by_values[place + 1] - by_values[place]) + by_share * step
    return found


def _passed(angles: Column, at: float) -> tuple[NDArray[numpy.intp], Column]:
    """Samples before each passage, and the passage's share of the way to the next."""
    turns = (angles - at) / math.tau
    turns = numpy.where(numpy.abs(turns - numpy.round(turns)) < ROUNDING, numpy.round(turns), turns)
    before, after = turns[:-1], turns[1:]
    forwards = after >= before
    last = numpy.where(forwards, numpy.floor(before), numpy.ceil(before))
    passed = numpy.where(forwards, numpy.floor(after), numpy.ceil(after))
    place = numpy.flatnonzero(last != passed)
    before, after, passed = before[place], after[place], passed[place]
    return place, (passed - before) / (after - before)
