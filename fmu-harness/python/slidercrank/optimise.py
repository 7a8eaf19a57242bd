"""A few design parameters against one of a study's quantities, by scipy.optimize.

With `method="gradient"` each run also gives the exact derivatives of its quantity, by which L-BFGS-B descends in few runs.
That holds as far as derivatives reach: near grazing there are none, and where motions are chaotic they hold for changes
that are too small to search by. Then Nelder-Mead, which needs none, goes on, and the `Optimum` says why.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy
import pandas
from scipy.optimize import OptimizeResult, differential_evolution
from scipy.optimize import minimize as descend

from .gradient import gradient
from .recipe import Recipe, RunError
from .study import check_bounds, plan
from .unit import Unit

Method = Literal["differential_evolution", "nelder_mead", "gradient"]

TRIAL = 0.01
"""Share of the ranges over which derivatives must tell the change of the value, to be searched by."""
TRUST = 0.1
"""Share of that change by which they may err."""


@dataclass(frozen=True)
class Optimum:
    """The best that was found."""

    parameters: dict[str, float]
    value: float
    evaluations: pandas.DataFrame
    """Every run in its order: parameters, `value` (not a number if it failed), `status`."""
    method: str
    """The method that found it: L-BFGS-B, Nelder-Mead or differential evolution."""
    reason: str
    """Why this method."""


class Enough(Exception):
    """The evaluations are used up."""


class Unreachable(Exception):
    """Why derivatives do not lead to the optimum."""


def minimise(
    file: str | Path,
    fmu: str | Path,
    quantity: str,
    bounds: Mapping[str, tuple[float, float]],
    method: Method = "differential_evolution",
    maximise: bool = False,
    evaluations: int = 200,
    tolerance: float = 1e-3,
    seed: int = 0,
) -> Optimum:
    """The least (or greatest) value of a kept quantity over real parameters within `bounds` (SI units).

    A study's [run] and [keep] say how each evaluation is run; its grid, draws and table have no part in it. An input
    with bounds is constant during a run. One evaluation is one run through FMPy in this process; a run that fails
    counts as infinitely bad. The search ends after so many evaluations, or where parameters vary by less than
    `tolerance` of their ranges (Nelder-Mead and `gradient`, which start in the middle) or values by less than that
    share of their mean (differential evolution). The same seed gives the same search. `gradient` and Nelder-Mead find
    the optimum next to the middle, differential evolution searches everywhere.
    """
    if evaluations < 1:
        raise ValueError(f"evaluations = {evaluations}: wanted at least 1")
    check_bounds(bounds)
    recipe = plan(file).recipe
    if quantity not in recipe.keep:
        raise KeyError(f"{file} keeps no `{quantity}`: {', '.join(recipe.keep)}")
    if method not in SEARCHES:
        raise ValueError(f"method = {method!r}: wanted {', '.join(SEARCHES)}")
    recipe = replace(recipe, keep={quantity: recipe.keep[quantity]}).holding(bounds)
    with TemporaryDirectory(prefix="fmu-", ignore_cleanup_errors=True) as folder:
        unit = Unit(Path(fmu), Path(folder))
        for name in bounds:
            variable = unit.variable(name)
            if variable.type != unit.calls.real or variable.causality not in ("parameter", "input"):
                raise ValueError(f"`{name}` is not a real parameter or input")
        search = _Search(unit, recipe, quantity, bounds, -1.0 if maximise else 1.0, evaluations, tolerance, seed)
        try:
            SEARCHES[method](search)
        except Enough:
            pass
    return search.optimum()


class _Search:
    """Runs over the unit cube of the parameters, with what was found."""

    def __init__(
        self,
        unit: Unit,
        recipe: Recipe,
        quantity: str,
        bounds: Mapping[str, tuple[float, float]],
        sign: float,
        evaluations: int,
        tolerance: float,
        seed: int,
    ):
        self.unit, self.recipe, self.quantity, self.names = unit, recipe, quantity, list(bounds)
        self.sign, self.evaluations, self.tolerance, self.seed = sign, evaluations, tolerance, seed
        self.low, self.high = numpy.array(list(bounds.values()), float).T
        self.cube = [(0.0, 1.0)] * len(bounds)
        self.runs: list[dict[str, float | str]] = []
        self.method, self.reason = "", "asked for"
        self.last: tuple[numpy.ndarray, tuple[float, numpy.ndarray]] | None = None

    def cost(self, point: numpy.ndarray) -> float:
        """The value to be made small at a point of the cube."""
        settings = self._settings(point)
        try:
            value, status = self.unit.run(self.recipe, settings)[0], "ok"
        except RunError as error:
            value, status = math.nan, str(error)
        self.runs.append({**settings, "value": value, "status": status})
        return math.inf if status != "ok" else self.sign * value

    def cost_and_slopes(self, point: numpy.ndarray) -> tuple[float, numpy.ndarray]:
        """The same with its derivatives by the coordinates of the cube. The last point is not run twice."""
        if self.last is not None and numpy.array_equal(self.last[0], point):
            return self.last[1]
        settings = self._settings(point)
        try:
            found = gradient(self.unit, self.recipe, settings, self.quantity, self.names)
        except RunError as error:
            self.runs.append({**settings, "value": math.nan, "status": str(error)})
            raise Unreachable(f"a run has no derivatives: {error}") from error
        self.runs.append({**settings, "value": found.value, "status": "ok"})
        told = self.sign * found.value, self.sign * found.by_parameters * (self.high - self.low)
        self.last = point.copy(), told
        return told

    def optimum(self) -> Optimum:
        frame = pandas.DataFrame(self.runs)
        fine = frame[frame["status"] == "ok"]
        if fine.empty:
            raise RunError(f"none of {len(frame)} runs succeeded, the first: {frame['status'].iloc[0]}")
        best = fine.loc[(self.sign * fine["value"].astype(float)).idxmin()]
        parameters = {name: float(best[name]) for name in self.names}
        return Optimum(parameters, float(best["value"]), frame, self.method, self.reason)

    def _settings(self, point: numpy.ndarray) -> dict[str, float]:
        if len(self.runs) >= self.evaluations:
            raise Enough
        values = numpy.clip(self.low + point * (self.high - self.low), self.low, self.high)
        return dict(zip(self.names, map(float, values)))


def _evolve(search: _Search) -> None:
    search.method = "differential evolution"
    differential_evolution(search.cost, search.cube, rng=search.seed, tol=search.tolerance, popsize=8, polish=False)


def _shrink(search: _Search) -> None:
    search.method = "Nelder-Mead"
    # No tolerance of its own for values: parameters decide.
    options = {"xatol": search.tolerance, "fatol": math.inf, "maxfev": search.evaluations}
    middle = [0.5] * len(search.cube)
    descend(search.cost, middle, method="Nelder-Mead", bounds=search.cube, options=options)


def _follow(search: _Search) -> None:
    search.method = "L-BFGS-B"
    try:
        point, scale = _tried(search)
        _descend(search, point, scale)
    except Unreachable as why:
        search.reason = str(why)
        _shrink(search)


def _tried(search: _Search) -> tuple[numpy.ndarray, float]:
    """The better one of two neighbouring points whose derivatives tell the change between them, and the size of slopes."""
    middle = numpy.full(len(search.cube), 0.5)
    value, slopes = search.cost_and_slopes(middle)
    size = float(numpy.linalg.norm(slopes))
    if size == 0.0:
        raise Unreachable("all derivatives in the middle are 0")
    other = middle - TRIAL * slopes / size
    moved, there = search.cost_and_slopes(other)
    # The mean of both slopes is right for a parabola.
    told = float((slopes + there) @ (other - middle)) / 2
    found = moved - value
    if not abs(found - told) <= TRUST * max(abs(found), abs(told)):
        raise Unreachable(
            f"derivatives do not reach {TRIAL:.0%} of the ranges: they tell a change of {told:.3g}, it is {found:.3g}"
        )
    search.reason = f"derivatives tell the change over {TRIAL:.0%} of the ranges: {told:.3g}, it is {found:.3g}"
    return (other if moved < value else middle), size


def _descend(search: _Search, point: numpy.ndarray, scale: float) -> None:
    before = point

    def cost(point: numpy.ndarray) -> tuple[float, numpy.ndarray]:
        value, slopes = search.cost_and_slopes(point)
        return value / scale, slopes / scale

    def settled(intermediate_result: OptimizeResult) -> None:
        nonlocal before
        step, before = abs(intermediate_result.x - before).max(), intermediate_result.x.copy()
        if step < search.tolerance:
            raise StopIteration

    options = {"ftol": 0.0, "gtol": 1e-2 * search.tolerance}
    found = descend(cost, point, jac=True, method="L-BFGS-B", bounds=search.cube, callback=settled, options=options)
    if "ABNORMAL" in str(found.message):
        raise Unreachable("along the direction of descent the value does not fall as its derivatives tell")


SEARCHES = {"differential_evolution": _evolve, "nelder_mead": _shrink, "gradient": _follow}
