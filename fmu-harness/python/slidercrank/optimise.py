"""A few design parameters against one of a study's quantities, by scipy.optimize."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy
import pandas
from scipy.optimize import differential_evolution
from scipy.optimize import minimize as descend

from .recipe import RunError
from .study import plan
from .unit import Unit


@dataclass(frozen=True)
class Optimum:
    """The best that was found."""

    parameters: dict[str, float]
    value: float
    evaluations: pandas.DataFrame
    """Every run in its order: parameters, `value` (not a number if it failed), `status`."""


class Enough(Exception):
    """The evaluations are used up."""


def minimise(
    file: str | Path,
    fmu: str | Path,
    quantity: str,
    bounds: Mapping[str, tuple[float, float]],
    method: Literal["differential_evolution", "nelder_mead"] = "differential_evolution",
    maximise: bool = False,
    evaluations: int = 200,
    tolerance: float = 1e-3,
    seed: int = 0,
) -> Optimum:
    """The least (or greatest) value of a kept quantity over parameters within `bounds` (SI units).

    A study's [run] and [keep] say how each evaluation is run; its grid, draws and table have no part in it. One
    evaluation is one run through FMPy in this process; a run that fails counts as infinitely bad. The search ends
    after so many evaluations, or where parameters vary by less than `tolerance` of their ranges (Nelder-Mead, which
    starts in the middle) or values by less than that share of their mean (differential evolution). The same seed gives
    the same search.
    """
    recipe = plan(file).recipe
    if quantity not in recipe.keep:
        raise KeyError(f"{file} keeps no `{quantity}`: {', '.join(recipe.keep)}")
    for name, (low, high) in bounds.items():
        if not low < high:
            raise ValueError(f"`{name}`: {low} is not below {high}")
    recipe = replace(recipe, keep={quantity: recipe.keep[quantity]})
    low, high = numpy.array(list(bounds.values()), float).T
    runs: list[dict[str, float | str]] = []
    with TemporaryDirectory(prefix="fmu-", ignore_cleanup_errors=True) as folder:
        unit = Unit(Path(fmu), Path(folder))

        def cost(point: numpy.ndarray) -> float:
            """At a point of the unit cube."""
            if len(runs) >= evaluations:
                raise Enough
            settings = dict(zip(bounds, map(float, numpy.clip(low + point * (high - low), low, high))))
            try:
                value, status = unit.run(recipe, settings)[0], "ok"
            except RunError as error:
                value, status = math.nan, str(error)
            runs.append({**settings, "value": value, "status": status})
            return math.inf if status != "ok" else -value if maximise else value

        cube = [(0.0, 1.0)] * len(bounds)
        try:
            if method == "differential_evolution":
                differential_evolution(cost, cube, rng=seed, tol=tolerance, popsize=8, polish=False)
            elif method == "nelder_mead":
                # No tolerance of its own for values: parameters decide.
                options = {"xatol": tolerance, "fatol": math.inf, "maxfev": evaluations}
                descend(cost, [0.5] * len(bounds), method="Nelder-Mead", bounds=cube, options=options)
            else:
                raise ValueError(f"method = {method!r}: wanted differential_evolution or nelder_mead")
        except Enough:
            pass
    frame = pandas.DataFrame(runs)
    fine = frame[frame["status"] == "ok"]
    if fine.empty:
        raise RunError(f"none of {len(frame)} runs succeeded, the first: {frame['status'].iloc[0]}")
    best = fine.loc[fine["value"].idxmax() if maximise else fine["value"].idxmin()]
    return Optimum({name: float(best[name]) for name in bounds}, float(best["value"]), frame)
