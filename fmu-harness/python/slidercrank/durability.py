"""Load spectra of a run: rainflow cycles of joint forces, counts per class, extremes of every stroke.

Cycles are counted by the library `rainflow` (ASTM E 1049-85, 5.4.4). A cycle between two communication points is missed:
ask for short steps, or read `joint.J.force.peak`, which an FMU with `joint.J.peak.audit` finds within the integrator's
steps.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy
import pandas
import rainflow

from .quantity import ROUNDING

JOINTS = ("A", "B", "C", "T")
TURN = 2.0 * numpy.pi


def force(run: pandas.DataFrame, joint: str) -> pandas.Series:
    """Magnitude [N] of a joint's force over time; `run` has both of its components."""
    x, y = (run[f"joint.{joint}.force.{axis}"] for axis in "xy")
    return pandas.Series(numpy.hypot(x, y), index=run.index, name=f"joint.{joint}.force")


def cycles(series: pandas.Series) -> pandas.DataFrame:
    """Rainflow cycles of a series over time: range and mean in its unit, count (0.5 or 1), first and last time."""
    if not numpy.isfinite(series).all():
        raise ValueError(f"{series.name} has values that are not finite")
    time = series.index.to_numpy()
    found = [
        (span, mean, count, time[first], time[last])
        for span, mean, count, first, last in rainflow.extract_cycles(series.to_numpy())
        if span > 0.0
    ]
    return pandas.DataFrame(found, columns=["range", "mean", "count", "from", "to"], dtype=float)


def equivalent(counted: pandas.DataFrame, exponent: float, repetitions: float = 1.0) -> float:
    """The range whose `repetitions` do the damage of all counted cycles together.

    Palmgren and Miner's sum with a Wöhler curve of slope `exponent`: (Σ count·range^m / repetitions)^(1/m).
    """
    if not (0.0 < exponent < numpy.inf and 0.0 < repetitions < numpy.inf):
        raise ValueError(f"exponent {exponent} and repetitions {repetitions} must be finite and above 0")
    largest = counted["range"].max() if len(counted) else 0.0
    if largest == 0.0:
        return 0.0
    # In shares of the largest range, whose powers do not overflow.
    damage = (counted["count"] * (counted["range"] / largest) ** exponent).sum()
    return float(largest * (damage / repetitions) ** (1.0 / exponent))


def spectrum(run: pandas.DataFrame, joints: Iterable[str] = JOINTS, classes: int = 32) -> pandas.DataFrame:
    """Load spectrum of joint forces: cycles by class of their range [N], of equal width up to the largest.

    A row is a class, its index the upper bound of the range. For each joint there is a column with the cycles in the
    class, and a column `J.exceeding` with the cycles of this class and all above it.
    """
    if classes < 1:
        raise ValueError(f"classes = {classes}: wanted at least 1")
    counted = {joint: cycles(force(run, joint)) for joint in joints}
    largest = max((frame["range"].max() for frame in counted.values() if len(frame)), default=0.0)
    bounds = numpy.linspace(0.0, largest or 1.0, classes + 1)
    table = pandas.DataFrame(index=pandas.Index(bounds[1:], name="range"))
    for joint, frame in counted.items():
        table[joint], _ = numpy.histogram(frame["range"], bins=bounds, weights=frame["count"])
        table[f"{joint}.exceeding"] = table[joint][::-1].cumsum()[::-1]
    return table


def strokes(run: pandas.DataFrame, of: str | Iterable[str]) -> pandas.DataFrame:
    """Smallest, mean and largest value of one output or several in every whole stroke: a turn of the crank from its start.

    A row is a stroke, its index the number. The columns are pairs of an output and `min`, `mean` or `max`.
    """
    outputs = [of] if isinstance(of, str) else list(of)
    angle = run["crank.angle"].to_numpy()
    turned = numpy.abs(angle - angle[0]) / TURN
    passed = numpy.floor(turned + ROUNDING).astype(int)
    number, whole = pandas.Series(passed, index=run.index, name="stroke"), passed[-1]
    grouped = run.loc[number < whole, outputs].groupby(number[number < whole])
    return grouped.agg(["min", "mean", "max"])
