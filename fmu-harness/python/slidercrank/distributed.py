"""A study on a Dask cluster: the same runs, the same journal, the same results as `sweep`.

Workers need this package and its `distributed` extra, and the platform that the FMU has a binary for. Whatever starts
a Dask cluster will do: `dask.distributed.LocalCluster`, `dask_jobqueue.SLURMCluster`, `dask_kubernetes.operator.KubeCluster`.
"""

from __future__ import annotations

import hashlib
import threading
import time
import zipfile
from collections.abc import Iterator
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas
from dask.typing import Key
from distributed import Client, Future, KilledWorker, as_completed, get_worker
from distributed.client import FutureCancelledError

from .journal import Journal, Outcome, path
from .recipe import Recipe, RunError
from .results import load, save, table
from .source import output_directory
from .study import Plan, plan
from .unit import Unit

AHEAD = 4
"""Runs that are handed out for each thread of the cluster."""
REFRESH = 2.0
"""[s] Between two looks at the cluster's size."""
SHIPMENTS = 20
"""How often the FMU is shipped again to a cluster that has lost all workers that had it."""


class StudyError(RuntimeError):
    """Why a study cannot be run."""


@dataclass(frozen=True)
class Shipment:
    """What every worker needs once."""

    fmu: bytes
    digest: str
    recipe: Recipe
    budget: float


def run(
    study_file: str | Path,
    fmu: str | Path,
    client: Client,
    output: str | Path | None = None,
    budget: float = 600.0,
) -> pandas.DataFrame:
    """Runs what the study's journal does not have yet on the client's cluster; one row a run, as `slidercrank.study`.

    `fmu` is the study's packaged scene, `budget` [s] the longest time for one run. A run that fails is a row that says
    why. A client that was killed goes on from the journal, which `sweep` can go on from too. A run whose workers die
    again and again, or one after another for reasons of their own, is a row that says so, but no line of the journal:
    the next call tries it again.
    """
    planned = plan(study_file)
    file = Path(fmu)
    check_scene(file, planned.recipe)
    into = output_directory(output)
    data = file.read_bytes()
    shipment = Shipment(data, hashlib.sha256(data).hexdigest(), replace(planned.recipe, origin={}), budget)
    with Journal(path(into, planned.recipe.name), planned.recipe.digest) as journal:
        lost = Hand(client, planned, shipment, journal).out()
        results = table(planned, {**journal.outcomes, **lost})
    found = into / f"sweep-{planned.recipe.name}.parquet"
    save(results, found)
    return load(found)


def check_scene(fmu: Path, recipe: Recipe) -> None:
    """An FMU of another scene would give other results under this study's name."""
    with zipfile.ZipFile(fmu) as archive:
        try:
            text = archive.read("documentation/scene.toml").decode()
        except KeyError:
            text = None
    if text != recipe.origin["scene"]:
        raise StudyError(f"{fmu} is not the study's scene `{recipe.scene}` as it stands: package it anew")


class Hand:
    """Hands runs out and takes them in."""

    def __init__(self, client: Client, planned: Plan, shipment: Shipment, journal: Journal):
        self.client, self.planned, self.shipment, self.journal = client, planned, shipment, journal
        self.going: dict[Key, tuple[int, Future[Outcome], Future[Shipment]]] = {}
        self.again: list[int] = []
        self.shipped: Future[Shipment] | None = None
        self.shipments = 0
        self.seen, self.room = -REFRESH, 0

    def out(self) -> dict[int, Outcome]:
        """Runs all that the journal lacks; returns the runs that their workers did not survive."""
        waiting = self.journal.open_runs(len(self.planned.runs))
        lost: dict[int, Outcome] = {}
        finished = as_completed()
        try:
            self._top_up(waiting, finished)
            for future in finished:
                number, _, shipped = self.going.pop(future.key)
                try:
                    outcome = self._taken(future, number, lost)
                except (FutureCancelledError, CancelledError):
                    # All workers that had the FMU, or the result, are gone.
                    self.again.append(number)
                    self.shipped = None if self.shipped is shipped else self.shipped
                else:
                    if outcome is not None:
                        self.journal.add(number, outcome)
                self._top_up(waiting, finished)
        finally:
            self.client.cancel([future for _, future, _ in self.going.values()])
        return lost

    def _taken(self, future: Future[Outcome], number: int, lost: dict[int, Outcome]) -> Outcome | None:
        error = future.exception()
        if isinstance(error, KilledWorker):
            lost[number] = Outcome(failed=f"its workers died, {error.allowed_failures + 1} in all")
            return None
        if error is not None:
            raise StudyError(f"run {number} cannot be done at all: {error}") from error
        return future.result()

    def _top_up(self, waiting: Iterator[int], finished: as_completed) -> None:
        now = time.monotonic()
        if now - self.seen > REFRESH:
            self.seen, self.room = now, max(2, AHEAD * sum(self.client.nthreads().values()))
        while len(self.going) < self.room:
            number = self.again.pop() if self.again else next(waiting, None)
            if number is None:
                return
            shipped = self.shipped or self._ship()
            row = self.planned.runs.iloc[number]
            settings = {name: float(row[name]) for name in self.planned.runs.columns}
            future = self.client.submit(one, shipped, settings, pure=False)
            self.going[future.key] = (number, future, shipped)
            finished.add(future)

    def _ship(self) -> Future[Shipment]:
        if self.shipments > SHIPMENTS:
            raise StudyError(f"the cluster has lost all its workers {SHIPMENTS} times; finished runs are in the journal")
        shipped: Future[Shipment] = self.client.scatter(self.shipment, broadcast=True, hash=False)
        self.shipped, self.shipments = shipped, self.shipments + 1
        return shipped


def one(shipment: Shipment, settings: dict[str, float]) -> Outcome:
    """One run, on a worker."""
    unit = unpacked(shipment)
    try:
        return Outcome(values=tuple(unit.run(shipment.recipe, settings, shipment.budget)))
    except RunError as error:
        return Outcome(failed=str(error))


_units: dict[str, tuple[TemporaryDirectory[str], Unit]] = {}
_unpacking = threading.Lock()


def unpacked(shipment: Shipment) -> Unit:
    """The FMU of a shipment, unpacked once in a process."""
    with _unpacking:
        if shipment.digest not in _units:
            # A nanny sweeps up the directory of a worker that was killed.
            try:
                directory = get_worker().local_directory
            except ValueError:
                directory = None
            folder = TemporaryDirectory(prefix="fmu-", dir=directory, ignore_cleanup_errors=True)
            file = Path(folder.name) / "unit.fmu"
            file.write_bytes(shipment.fmu)
            _units[shipment.digest] = folder, Unit(file, Path(folder.name) / "unpacked")
        return _units[shipment.digest][1]
