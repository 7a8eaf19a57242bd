"""Studies, run and planned by the program in the source tree."""

from __future__ import annotations

import csv
import json
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas

from .recipe import Recipe
from .source import SourceError, call, output_directory


@dataclass(frozen=True)
class Plan:
    """All runs of a study and how each is done."""

    runs: pandas.DataFrame
    """A parameter a column, a run a row; the index is the run's number."""
    recipe: Recipe
    """What every run has in common."""


def read(file: str | Path) -> dict[str, Any]:
    """A study file as it stands, unchecked: `plan` and `study` check it."""
    return tomllib.loads(Path(file).read_text(encoding="utf-8"))


def study(file: str | Path, workers: int | None = None, output: str | Path | None = None) -> pandas.DataFrame:
    """Runs a study on this machine's cores, or what of it is not in its journal yet; one row a run.

    `attrs` of the frame tell what it was made from: `study`, `scene`, `version`, `seed`.
    """
    from .results import load

    into = output_directory(output)
    threads = [] if workers is None else ["--workers", str(workers)]
    results = into / f"sweep-{read(file)['name']}.parquet"
    before = results.stat().st_mtime_ns if results.exists() else None
    try:
        call("sweep", Path(file).absolute(), *threads, "--output", into)
    except SourceError:
        # A study none of whose runs came to its end has results, too: each row says why.
        if not results.exists() or results.stat().st_mtime_ns == before:
            raise
    return load(results)


def check_bounds(bounds: Mapping[str, tuple[float, float]]) -> None:
    """A `ValueError` unless there are parameters, each with a range."""
    if not bounds:
        raise ValueError("there are no bounds: wanted those of at least one parameter")
    for name, (low, high) in bounds.items():
        if not -math.inf < low < high < math.inf:
            raise ValueError(f"`{name}`: {low} is not below {high}, or one of them is not finite")


def plan(file: str | Path) -> Plan:
    """The table of a study's runs and the recipe of each; nothing is run."""
    with TemporaryDirectory() as folder:
        call("sweep", Path(file).absolute(), "--plan", "--output", folder)
        table = Path(folder) / f"sweep-{read(file)['name']}-plan.csv"
        recipe = Recipe.of(json.loads(table.with_suffix(".json").read_text(encoding="utf-8")))
        with open(table, newline="", encoding="utf-8") as rows:
            names, *cells = csv.reader(rows)
    # pandas' own reader of numbers is not exact in the last bit.
    values = [[float(cell) for cell in row[1:]] for row in cells]
    runs = pandas.DataFrame(values, columns=names[1:], index=pandas.RangeIndex(len(cells), name="run"), dtype=float)
    return Plan(runs, recipe)
