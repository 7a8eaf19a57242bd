"""What a run of a study costs beside `sweep`, on a Dask cluster on this machine.

    python -m slidercrank.overhead STUDY.toml FMU [--workers N]

Both run the study afresh with so many workers, and then once more with nothing left to do; the difference of the two
times is what the runs took.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from distributed import Client, LocalCluster

from . import distributed
from .study import plan, study


def timed(call: Callable[[], object]) -> float:
    """[s] Of the wall."""
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m slidercrank.overhead", description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path)
    parser.add_argument("fmu", type=Path)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    runs = len(plan(given.study).runs)
    costs = {}
    with TemporaryDirectory() as folder:
        sweep = lambda: study(given.study, given.workers, Path(folder) / "sweep")
        costs["sweep"] = timed(sweep), timed(sweep)
        with (
            LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None) as cluster,
            Client(cluster) as client,
        ):
            dask = lambda: distributed.run(given.study, given.fmu, client, Path(folder) / "dask")
            costs["dask"] = timed(dask), timed(dask)
    print(f"{runs} runs, {given.workers} workers")
    print("| with | all [s] | nothing left [s] | worker time per run [ms] |\n|---|--:|--:|--:|")
    per_run = {}
    for name, (whole, idle) in costs.items():
        per_run[name] = 1e3 * (whole - idle) * given.workers / runs
        print(f"| {name} | {whole:.2f} | {idle:.2f} | {per_run[name]:.1f} |")
    print(f"Dask costs {per_run['dask'] - per_run['sweep']:.1f} ms more per run.")


if __name__ == "__main__":
    main()
