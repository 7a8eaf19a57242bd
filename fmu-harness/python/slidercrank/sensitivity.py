"""Sobol indices of a study's quantities, by SALib."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy
import pandas
from SALib.analyze import sobol as indices
from SALib.sample import sobol as design

from .study import check_bounds, read, study

ROUNDING = 1e-13
"""Share of its size by which a quantity that does not vary may seem to."""


def sobol(
    file: str | Path,
    bounds: Mapping[str, tuple[float, float]],
    samples: int,
    seed: int = 0,
    confidence: float = 0.95,
    workers: int | None = None,
    output: str | Path | None = None,
) -> pandas.DataFrame:
    """First-order and total indices of every kept quantity with respect to the parameters in `bounds` (SI units).

    The study's `table` is where the design is written, `samples` × (parameters + 2) rows; `samples` is a power of two.
    Indexed by quantity and parameter: `S1`, `ST` and half the widths of their confidence intervals, `S1_conf`,
    `ST_conf`. The same seed gives the same design, and the same study goes on from its journal.
    """
    told = read(file)
    if "table" not in told:
        raise ValueError(f'{file}: wanted `table = "design.csv"`, where the design is written')
    others = [block for block in ("grid", "random") if told.get(block)]
    if others:
        raise ValueError(f"{file}: [{others[0]}] would run every point of the design many times")
    if samples < 2 or samples & (samples - 1):
        raise ValueError(f"samples = {samples}: wanted a power of two")
    check_bounds(bounds)
    problem = {"num_vars": len(bounds), "names": list(bounds), "bounds": [list(pair) for pair in bounds.values()]}
    points = design.sample(problem, samples, calc_second_order=False, seed=seed)
    write(Path(file).parent / told["table"], list(bounds), points.tolist())
    frame = study(file, workers, output)
    failed = frame[frame["status"] != "ok"]
    if len(failed):
        raise ValueError(f"{len(failed)} of {len(frame)} runs failed, the first: {failed['status'].iloc[0]}")
    rows = []
    for quantity in sorted(told["keep"]):
        values = frame[quantity].to_numpy(float)
        # What varies by rounding alone has no parts: the indices of a constant are not numbers.
        if numpy.ptp(values) <= ROUNDING * numpy.abs(values).max():
            values = numpy.full_like(values, values[0])
        found = indices.analyze(problem, values, calc_second_order=False, conf_level=confidence, seed=seed)
        for place, name in enumerate(bounds):
            numbers = {key: float(found[key][place]) for key in ("S1", "S1_conf", "ST", "ST_conf")}
            rows.append({"quantity": quantity, "parameter": name, **numbers})
    return pandas.DataFrame(rows).set_index(["quantity", "parameter"])


def write(file: Path, names: list[str], rows: list[list[float]]) -> None:
    """A study's table; each number reads back as the same number."""
    with open(file, "w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out)
        writer.writerow(names)
        writer.writerows([map(repr, row) for row in rows])
