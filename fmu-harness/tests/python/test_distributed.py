"""On a Dask cluster of several processes a study gives what `sweep` gives, whoever is killed on the way."""

import hashlib
import itertools
import json
import os
import signal
import subprocess
import sys
import zipfile
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import pyarrow
import pyarrow.parquet
import pytest
from distributed import Client, LocalCluster

from slidercrank import distributed, plan, study
from slidercrank.distributed import Shipment, StudyError
from slidercrank.journal import Outcome, path
from slidercrank.results import load, save

from conftest import PRESS, WORN_PIN, bits, fmu

CLIENT = """
import os, signal, sys
from distributed import Client
from slidercrank import distributed
from slidercrank.journal import Journal

class Mortal(Journal):
    def add(self, run, outcome):
        super().add(run, outcome)
        if len(self) == 5:
            os.kill(os.getpid(), signal.SIGKILL)

distributed.Journal = Mortal
distributed.run(sys.argv[1], sys.argv[2], Client(sys.argv[3]), sys.argv[4])
"""
"""Dies with its fifth outcome in the journal."""
LONGEST = 600
"""[s] Ends what hangs; no load makes a wait this long."""


@pytest.mark.parametrize("mask, mode", [(0o022, 0o644), (0o007, 0o660)])
def test_results_may_be_read_by_whom_the_mask_says(tmp_path, mask, mode):
    file, results = tmp_path / "own.parquet", pyarrow.table({"run": [0], "x": [0.1]}, metadata={"study": "own"})
    before = os.umask(mask)
    try:
        for _ in range(2):
            save(results, file)
    finally:
        os.umask(before)
    assert file.stat().st_mode & 0o777 == mode and list(tmp_path.iterdir()) == [file]
    assert load(file)["x"].to_list() == [0.1] and load(file).attrs["study"] == "own"


@contextmanager
def cluster_of(workers):
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster, timeout=LONGEST) as client:
            if workers > 0:
                client.wait_for_workers(workers, timeout=LONGEST)
            yield client


@pytest.fixture(scope="module")
def client():
    with cluster_of(3) as client:
        yield client


@pytest.fixture(scope="module")
def pair():
    with cluster_of(2) as client:
        yield client


@pytest.fixture
def mortals(pair):
    """A client of two workers, of which a test kills what it likes; a nanny starts others in their place."""
    pair.wait_for_workers(2, timeout=LONGEST)
    return pair


@pytest.fixture(scope="module")
def wanted(tmp_path_factory):
    """What `sweep` makes of the worn pin's study."""
    folder = tmp_path_factory.mktemp("wanted")
    (folder / "study.toml").write_text(WORN_PIN)
    return bits(study(folder / "study.toml", output=folder))


def finished(file):
    """Numbers of the runs in a journal, in the order in which they ended."""
    return [json.loads(line)["run"] for line in file.read_text().splitlines()[1:]]


def die_once(mark):
    """Kills this process if it is the first to come here."""
    with suppress(FileExistsError):
        mark.touch(exist_ok=False)
        os.kill(os.getpid(), signal.SIGKILL)


@dataclass(frozen=True)
class DeadlyShipment(Shipment):
    """Kills the first worker that hands it to another."""

    mark: Path

    def __reduce__(self):
        die_once(self.mark)
        return Shipment, (self.fmu, self.digest, self.recipe, self.budget)


@dataclass(frozen=True)
class DeadlyOutcome(Outcome):
    """Kills the first worker that hands it to the client."""

    mark: Path = None

    def __reduce__(self):
        die_once(self.mark)
        return Outcome, (self.values, self.failed, self.stopped)


def die_while_the_fmu_comes(mark, shipment):
    die_once(mark)
    return shipment


def die_while_the_fmu_goes(mark, shipment):
    return DeadlyShipment(shipment.fmu, shipment.digest, shipment.recipe, shipment.budget, mark)


def die_while_it_runs(mark, shipment, settings):
    die_once(mark)
    return distributed.one(shipment, settings)


def die_while_the_outcome_goes(mark, shipment, settings):
    outcome = distributed.one(shipment, settings)
    return DeadlyOutcome(outcome.values, outcome.failed, mark=mark)


@pytest.mark.parametrize("text, scene", [(WORN_PIN, "wornpin"), (PRESS, "press")])
def test_results_are_those_of_sweep_to_the_bit(write, tmp_path, client, text, scene):
    file = write(text)
    wanted = study(file, output=tmp_path / "sweep")
    found = distributed.run(file, fmu(scene), client, tmp_path / "dask")
    failed = (wanted["status"] != "ok").sum()
    assert 0 < failed < len(wanted)
    assert bits(found) == bits(wanted)
    assert found.attrs == wanted.attrs and found.attrs["study"] == text
    ours, theirs = (next((tmp_path / name).glob("*.parquet")) for name in ("dask", "sweep"))
    schemas = [[(c.name, c.physical_type, c.max_definition_level) for c in pyarrow.parquet.ParquetFile(own).schema]
               for own in (ours, theirs)]
    assert schemas[0] == schemas[1]


@pytest.mark.parametrize("task, deadly", [
    ("ship", die_while_the_fmu_comes),
    ("ship", die_while_the_fmu_goes),
    ("one", die_while_it_runs),
    ("one", die_while_the_outcome_goes),
])
def test_a_worker_loses_nothing_whenever_it_dies(write, tmp_path, monkeypatch, mortals, wanted, task, deadly):
    mark = tmp_path / "mark"
    monkeypatch.setattr(distributed, task, partial(deadly, mark))
    found = distributed.run(write(WORN_PIN), fmu("wornpin"), mortals, tmp_path)
    assert mark.exists(), "nobody died"
    assert sorted(finished(path(tmp_path, "own"))) == list(range(24))
    assert bits(found) == wanted


@pytest.mark.parametrize("victims", [1, 2])
def test_workers_that_are_killed_while_runs_are_handed_out_lose_nothing(
    write, tmp_path, monkeypatch, mortals, wanted, victims
):
    submit, calls = mortals.submit, itertools.count(1)
    nannies = list(mortals.cluster.workers.values())[:victims]

    def deadly(*arguments, **options):
        # Nine calls hand out the FMU and four runs a worker; the others follow as outcomes come in.
        if next(calls) == 15:
            for nanny in nannies:
                os.kill(nanny.pid, signal.SIGKILL)
        return submit(*arguments, **options)

    monkeypatch.setattr(mortals, "submit", deadly)
    found = distributed.run(write(WORN_PIN), fmu("wornpin"), mortals, tmp_path)
    assert next(calls) > 15
    assert sorted(finished(path(tmp_path, "own"))) == list(range(24))
    assert bits(found) == wanted


def test_a_study_that_its_cluster_forgets_is_handed_out_again(write, tmp_path, monkeypatch, mortals, wanted):
    submit, calls = mortals.submit, itertools.count(1)

    def forgetful(*arguments, **options):
        future = submit(*arguments, **options)
        if next(calls) == 15:
            mortals.cancel([future, arguments[1]], force=True)
        return future

    monkeypatch.setattr(mortals, "submit", forgetful)
    found = distributed.run(write(WORN_PIN), fmu("wornpin"), mortals, tmp_path)
    assert sorted(finished(path(tmp_path, "own"))) == list(range(24))
    assert bits(found) == wanted


def test_a_study_waits_for_workers_and_says_so_when_none_comes(write, tmp_path, wanted):
    file = write(WORN_PIN)
    with cluster_of(0) as client:
        with pytest.raises(StudyError, match="no worker for 0.5 s"):
            distributed.run(file, fmu("wornpin"), client, tmp_path, patience=0.5)
        assert finished(path(tmp_path, "own")) == []
        client.cluster.scale(1)
        assert bits(distributed.run(file, fmu("wornpin"), client, tmp_path, patience=LONGEST)) == wanted


def test_a_client_that_was_killed_goes_on_and_sweep_can_too(write, tmp_path, client, wanted):
    file, journal = write(WORN_PIN), path(tmp_path / "dask", "own")
    arguments = [file, fmu("wornpin"), client.scheduler.address, tmp_path / "dask"]
    killed = subprocess.run([sys.executable, "-c", CLIENT, *map(str, arguments)])
    assert killed.returncode == -signal.SIGKILL
    done = finished(journal)
    assert len(done) == 5
    (tmp_path / "sweep").mkdir()
    path(tmp_path / "sweep", "own").write_bytes(journal.read_bytes())
    found = distributed.run(file, fmu("wornpin"), client, tmp_path / "dask")
    assert finished(journal)[:5] == done and sorted(finished(journal)) == list(range(24))
    assert bits(found) == bits(study(file, output=tmp_path / "sweep")) == wanted


def test_the_fmu_is_unpacked_once_in_a_worker(write, tmp_path, client):
    for seed in (3, 4):
        text = WORN_PIN.replace("seed = 3", f"seed = {seed}")
        distributed.run(write(text), fmu("wornpin"), client, tmp_path / str(seed))
    folders = client.run(lambda dask_worker: [entry.name for entry in os.scandir(dask_worker.local_directory)
                                              if entry.name.startswith("fmu-")])
    digest = hashlib.sha256(fmu("wornpin").read_bytes()).hexdigest()
    known = client.run(lambda: list(distributed._units))
    # A worker that is slow may find nothing left to run.
    assert any(digest in own for own in known.values())
    assert {worker: len(own) for worker, own in folders.items()} == {w: len(own) for w, own in known.items()}


def test_an_fmu_of_another_scene_is_refused_before_anything_is_run(write, tmp_path, client):
    with pytest.raises(StudyError, match="not the study's scene `wornpin`"):
        distributed.run(write(WORN_PIN), fmu("ideal"), client, tmp_path)
    assert not path(tmp_path, "own").exists()


def test_an_fmu_that_holds_inputs_is_refused_where_the_study_s_follow_lines(write):
    with pytest.raises(StudyError, match="package it for FMI 2.0"):
        distributed.check_scene(fmu("press3"), plan(write(PRESS)).recipe)


def test_an_fmu_with_another_table_of_modes_is_refused(write, tmp_path):
    recipe = plan(write(WORN_PIN)).recipe
    file = tmp_path / "flexible.fmu"
    for table, wanted in [("mass = 1.0", "mass = 1.0"), ("mass = 1.0", "mass = 2.0"), ("mass = 1.0", None)]:
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("documentation/scene.toml", recipe.origin["scene"])
            archive.writestr("documentation/modes.toml", table)
        told = replace(recipe, origin={**recipe.origin, **({} if wanted is None else {"modes": wanted})})
        with nullcontext() if table == wanted else pytest.raises(StudyError, match="package it anew"):
            distributed.check_scene(file, told)


def test_a_run_that_takes_too_long_is_a_row_that_says_so(write, tmp_path, client):
    found = distributed.run(write(WORN_PIN), fmu("wornpin"), client, tmp_path, budget=0.0)
    assert (found["status"] == "stopped after 0 s").sum() == (found["status"].str.startswith("stopped")).sum() > 0
    again = distributed.run(write(WORN_PIN), fmu("wornpin"), client, tmp_path)
    assert (again["status"] == "ok").any() and not again["status"].str.startswith("stopped").any()
