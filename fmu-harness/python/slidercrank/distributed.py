"""A study on a Dask cluster: the same runs, the same journal, the same results as `sweep`.

Workers need this package and its `distributed` extra, and the platform that the FMU has a binary for. Whatever starts
a Dask cluster will do: `dask.distributed.LocalCluster`, `dask_jobqueue.SLURMCluster`, `dask_kubernetes.operator.KubeCluster`.
"""

from __future__ import annotations

import hashlib
import math
import threading
import time
import zipfile
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from queue import Empty, SimpleQueue
from tempfile import TemporaryDirectory

import pandas
from dask.typing import Key
from distributed import Client, Future, KilledWorker, get_worker
from distributed.client import FutureCancelledError
from fmpy import read_model_description

from .journal import Journal, Outcome, path
from .recipe import Recipe, RunError, StoppedError
from .results import load, save, table
from .source import output_directory
from .study import Plan, plan
from .unit import Unit

AHEAD = 4
"""Runs that are handed out for each thread of the cluster."""
REFRESH = 2.0
"""[s] Between two looks at the cluster's size."""
FETCH = 30.0
"""[s] The longest time to wait for the outcome of a finished run, before the others have their turn."""
SHIPMENTS = 20
"""How often the FMU is shipped to a cluster that has dropped it: all workers that took it died, or it was restarted."""


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
    patience: float = 300.0,
) -> pandas.DataFrame:
    """Runs what the study's journal does not have yet on the client's cluster; one row a run, as `slidercrank.study`.

    `fmu` is the study's packaged scene, `budget` [s] the longest time for one run. A run that fails is a row that says
    why. A client that was killed goes on from the journal, which `sweep` can go on from too. A run that takes longer
    than `budget`, or whose workers die again and again, or one after another for reasons of their own, is a row that
    says so, but no line of the journal: the next call tries it again. A study waits for workers: only when there is
    none for `patience` [s] it is a `StudyError`.
    """
    planned = plan(study_file)
    file = Path(fmu)
    check_scene(file, planned.recipe)
    into = output_directory(output)
    data = file.read_bytes()
    shipment = Shipment(data, hashlib.sha256(data).hexdigest(), replace(planned.recipe, origin={}), budget)
    with Journal(path(into, planned.recipe.name), planned.recipe.digest) as journal:
        journal.check(len(planned.runs), len(planned.recipe.keep))
        lost = Hand(client, planned, shipment, journal, patience).out()
        results = table(planned, {**journal.outcomes, **lost})
    found = into / f"sweep-{planned.recipe.name}.parquet"
    save(results, found)
    return load(found)


def check_scene(fmu: Path, recipe: Recipe) -> None:
    """An FMU of another scene would give other results under this study's name."""
    with zipfile.ZipFile(fmu) as archive:
        files = {name: f"documentation/{name}.toml" for name in ("scene", "modes")}
        held = set(archive.namelist())
        texts = {name: archive.read(file).decode() for name, file in files.items() if file in held}
    if any(texts.get(name) != recipe.origin.get(name) for name in files):
        raise StudyError(f"{fmu} is not the study's scene `{recipe.scene}` as it stands: package it anew")
    if any(own.points for own in recipe.inputs) and not read_model_description(str(fmu)).fmiVersion.startswith("2."):
        # Its results would differ from those of `sweep`, under the same digest.
        raise StudyError(f"{fmu} holds inputs from point to point, which follow lines in the study: package it for FMI 2.0")


class Hand:
    """Hands runs out and takes them in."""

    def __init__(self, client: Client, planned: Plan, shipment: Shipment, journal: Journal, patience: float):
        self.client, self.planned, self.shipment, self.journal = client, planned, shipment, journal
        self.patience = patience
        self.going: dict[Key, tuple[int, Future[Outcome], Future[Shipment]]] = {}
        self.finished: SimpleQueue[Future[Outcome]] = SimpleQueue()
        self.again: list[int] = []
        self.shipped: Future[Shipment] | None = None
        self.shipments = 0
        self.looked, self.manned, self.room = -math.inf, time.monotonic(), 0

    def out(self) -> dict[int, Outcome]:
        """Runs all that the journal lacks; returns the runs that their workers did not survive."""
        waiting = self.journal.open_runs(len(self.planned.runs))
        lost: dict[int, Outcome] = {}
        try:
            self._top_up(waiting)
            while self.going:
                # A cluster without workers finishes nothing, so the wait is bounded.
                with suppress(Empty):
                    self._take_in(self.finished.get(timeout=REFRESH), lost)
                self._top_up(waiting)
        finally:
            self.client.cancel([future for _, future, _ in self.going.values()])
        return lost

    def _take_in(self, future: Future[Outcome], lost: dict[int, Outcome]) -> None:
        number, _, shipped = self.going[future.key]
        error, outcome = None, None
        try:
            error = future.exception(timeout=FETCH)
            outcome = future.result(timeout=FETCH) if error is None else None
        except TimeoutError:
            # The worker died with the outcome in its memory, and the cluster makes it again.
            self._watch(future)
            return
        except (FutureCancelledError, CancelledError):
            # The cluster was restarted and has forgotten everything.
            self._hand_out_again(future)
            return
        except KilledWorker as killed:
            error = killed
        if isinstance(error, KilledWorker) and error.task == shipped.key:
            self._hand_out_again(future)
            return
        del self.going[future.key]
        if outcome is not None:
            self.journal.add(number, outcome)
        elif isinstance(error, KilledWorker):
            lost[number] = Outcome(failed=f"its workers died, {error.allowed_failures + 1} in all")
        else:
            raise StudyError(f"run {number} cannot be done at all: {error}") from error

    def _hand_out_again(self, future: Future[Outcome]) -> None:
        number, _, shipped = self.going.pop(future.key)
        self.again.append(number)
        self.shipped = None if self.shipped is shipped else self.shipped

    def _top_up(self, waiting: Iterator[int]) -> None:
        self._look()
        while len(self.going) < self.room:
            number = self.again.pop() if self.again else next(waiting, None)
            if number is None:
                return
            shipped = self.shipped or self._ship()
            row = self.planned.runs.iloc[number]
            settings = {name: float(row[name]) for name in self.planned.runs.columns}
            future = self.client.submit(one, shipped, settings, pure=False)
            self.going[future.key] = (number, future, shipped)
            self._watch(future)

    def _watch(self, future: Future[Outcome]) -> None:
        future.add_done_callback(self.finished.put)

    def _look(self) -> None:
        """Looks at the cluster's size, now and then."""
        now = time.monotonic()
        if now - self.looked < REFRESH:
            return
        threads = sum(self.client.nthreads().values())
        self.looked, self.room = now, max(2, AHEAD * threads)
        if threads > 0:
            self.manned = now
        elif now - self.manned > self.patience:
            without = f"the cluster has had no worker for {self.patience:g} s"
            raise StudyError(f"{without}; finished runs are in the journal")

    def _ship(self) -> Future[Shipment]:
        if self.shipments == SHIPMENTS:
            raise StudyError(f"the cluster has dropped the FMU {SHIPMENTS} times; finished runs are in the journal")
        # Data that is scattered dies with its workers, and a worker that dies while it is scattered is an error. What
        # a task has made is made again wherever it is missing.
        shipped: Future[Shipment] = self.client.submit(ship, self.shipment, pure=False)
        self.shipped, self.shipments = shipped, self.shipments + 1
        return shipped


def ship(shipment: Shipment) -> Shipment:
    """The shipment, on the first worker that wants it; the others have it from there."""
    return shipment


def one(shipment: Shipment, settings: dict[str, float]) -> Outcome:
    """One run, on a worker."""
    unit = unpacked(shipment)
    try:
        return Outcome(values=tuple(unit.run(shipment.recipe, settings, shipment.budget)))
    except RunError as error:
        return Outcome(failed=str(error), stopped=isinstance(error, StoppedError))


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
