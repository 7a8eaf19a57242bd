"""Figures of runs and studies, by matplotlib; each draws into `ax` or into a new figure, and returns the axes."""

from __future__ import annotations

import numpy
import pandas
from matplotlib import pyplot
from matplotlib.axes import Axes

from .press import BOTTOM


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


def parallelism(strokes: pandas.DataFrame, ax: Axes | None = None) -> Axes:
    """The slide's tilt [mrad, which is mm/m] over the crank's angle from bottom dead centre, a line for each offset."""
    ax = ax or pyplot.figure().add_subplot()
    for offset, stroke in strokes.groupby(level="offset"):
        angles = stroke.index.get_level_values("crank.angle").to_numpy() - strokes.attrs.get(BOTTOM, 0.0)
        around = numpy.degrees((angles + numpy.pi) % (2.0 * numpy.pi) - numpy.pi)
        order = numpy.argsort(around)
        tilts = 1e3 * stroke["slider.angle"].to_numpy()
        ax.plot(around[order], tilts[order], linewidth=0.8, label=f"{1e3 * offset:g} mm")
    ax.set(xlabel="crank angle from bottom dead centre [°]", ylabel="tilt [mrad]", title="Parallelism of the slide")
    ax.legend(title="offset of the load")
    return ax


def placements(study: pandas.DataFrame, quantity: str) -> list[Axes]:
    """A quantity of `slidercrank.placements.placements`: a panel for each clearance of A, joint B down, joint C across.

    Panels have one scale of colours; each field tells its value. A field without a run stays empty.
    """
    fields = study[quantity].where(study["status"] == "ok").unstack("C")
    # A figure of its own, since panels share it.
    count = len(fields.index.unique("A"))
    size = (1.0 + 3.0 * count, 4.0)
    figure, panels = pyplot.subplots(1, count, squeeze=False, sharey=True, figsize=size, layout="constrained")
    for ax, (played, panel) in zip(panels[0], fields.groupby(level="A")):
        values = panel.to_numpy()
        image = ax.imshow(values, vmin=numpy.nanmin(fields), vmax=numpy.nanmax(fields))
        for row, column in numpy.ndindex(values.shape):
            if numpy.isfinite(values[row, column]):
                ax.text(column, row, f"{values[row, column]:.3g}", ha="center", va="center", fontsize=7, color="white",
                        bbox={"facecolor": "black", "alpha": 0.4, "linewidth": 0, "pad": 1})
        ax.set_xticks(range(len(panel.columns)), [f"{1e3 * c:g}" for c in panel.columns])
        ax.set_yticks(range(len(panel)), [f"{1e3 * c:g}" for c in panel.index.get_level_values("B")])
        ax.set(xlabel="C [mm]", title=f"A {1e3 * played:g} mm")
    panels[0][0].set(ylabel="B [mm]")
    figure.colorbar(image, ax=list(panels[0]), label=quantity, shrink=0.6)
    return list(panels[0])
