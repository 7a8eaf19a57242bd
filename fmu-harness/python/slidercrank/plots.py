"""Figures of runs and studies, by matplotlib; each draws into `ax` or into a new figure, and returns the axes."""

from __future__ import annotations

import numpy
import pandas
from matplotlib import pyplot
from matplotlib.axes import Axes


def orbit(run: pandas.DataFrame, joint: str = "C", clearance: float | None = None, ax: Axes | None = None) -> Axes:
    """The path of a joint's journal in its bearing [µm], and the circle of its clearance [m] if that is given."""
    ax = ax or pyplot.figure().add_subplot()
    x, y = (1e6 * run[f"joint.{joint}.eccentricity.{axis}"] for axis in "xy")
    ax.plot(x, y, linewidth=0.6, label="journal")
    if clearance is not None:
        angle = numpy.linspace(0.0, 2.0 * numpy.pi, 361)
        around = 1e6 * clearance
        ax.plot(around * numpy.cos(angle), around * numpy.sin(angle), "k--", linewidth=0.8, label="clearance")
    ax.set(xlabel="x [µm]", ylabel="y [µm]", title=f"Journal of joint {joint}", aspect="equal")
    return ax


def phase(run: pandas.DataFrame, of: str = "slider.x", rate: str = "slider.v", ax: Axes | None = None) -> Axes:
    """One output over another, such as a velocity over its position; SI units."""
    ax = ax or pyplot.figure().add_subplot()
    ax.plot(run[of], run[rate], linewidth=0.6)
    ax.set(xlabel=of, ylabel=rate, title="Phase portrait")
    return ax


def histogram(study: pandas.DataFrame, quantity: str, bins: int = 30, ax: Axes | None = None) -> Axes:
    """How often a study's quantity took which value, in the runs that did not fail."""
    ax = ax or pyplot.figure().add_subplot()
    values = study.loc[study["status"] == "ok", quantity]
    ax.hist(values, bins=bins)
    ax.set(xlabel=quantity, ylabel="runs", title=f"{len(values)} of {len(study)} runs")
    return ax
