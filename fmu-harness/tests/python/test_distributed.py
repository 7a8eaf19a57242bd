"""On a Dask cluster of several processes a study gives what `sweep` gives, whoever is killed on the way."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import threading
import time

import pyarrow.parquet
import pytest
from distributed import Client, LocalCluster

from slidercrank import distributed, study
from slidercrank.distributed import StudyError
from slidercrank.journal import path

from conftest import PRESS, WORN_PIN, bits, fmu

LONG = WORN_PIN.replace("draws = 6", "draws = 10").replace("turns = 1.5", "turns = 3").replace("100 um", "200 um")
CLIENT = "import sys\nfrom distributed import Client\nfrom slidercrank import distributed\n" \
    "distributed.run(sys.argv[1], sys.argv[2], Client(sys.argv[3]), sys.argv[4])\n"


@pytest.fixture(scope="module")
def client():
    with LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        client.wait_for_workers(3, timeout=30)
        yield client


def finished(file):
    """Numbers of the runs in a journal, in the order in which they ended."""
    return [json.loads(line)["run"] for line in file.read_text().splitlines()[1:]] if file.exists() else []


def wait_for(file, runs):
    deadline = time.monotonic() + 30
    while len(finished(file)) < runs:
        assert time.monotonic() < deadline, "no runs"
        time.sleep(0.002)


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


@pytest.mark.parametrize("victims", [1, 3])
def test_workers_that_are_killed_lose_nothing(write, tmp_path, client, victims):
    file, journal = write(LONG), path(tmp_path / "dask", "own")
    before = sorted(client.run(os.getpid).values())[:victims]

    def kill():
        wait_for(journal, 5)
        for victim in before:
            os.kill(victim, signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    found = distributed.run(file, fmu("wornpin"), client, tmp_path / "dask")
    killer.join()
    client.wait_for_workers(1, timeout=30)
    assert not set(before) & set(client.run(os.getpid).values())
    assert sorted(finished(journal)) == list(range(40))
    assert bits(found) == bits(study(file, output=tmp_path / "sweep"))


def test_a_client_that_was_killed_goes_on_and_sweep_can_too(write, tmp_path, client):
    file, journal = write(LONG), path(tmp_path / "dask", "own")
    address = client.scheduler.address
    arguments = [file, fmu("wornpin"), address, tmp_path / "dask"]
    first = subprocess.Popen([sys.executable, "-B", "-c", CLIENT, *map(str, arguments)])
    wait_for(journal, 5)
    first.kill()
    first.wait()
    done = finished(journal)
    assert 5 <= len(done) < 40
    (tmp_path / "sweep").mkdir()
    path(tmp_path / "sweep", "own").write_bytes(journal.read_bytes())
    found = distributed.run(file, fmu("wornpin"), client, tmp_path / "dask")
    assert finished(journal)[: len(done)] == done and sorted(finished(journal)) == list(range(40))
    assert bits(found) == bits(study(file, output=tmp_path / "sweep"))


def test_the_fmu_is_unpacked_once_in_a_worker(write, tmp_path, client):
    for seed in (3, 4):
        text = WORN_PIN.replace("seed = 3", f"seed = {seed}")
        distributed.run(write(text), fmu("wornpin"), client, tmp_path / str(seed))
    folders = client.run(lambda dask_worker: [entry.name for entry in os.scandir(dask_worker.local_directory)
                                              if entry.name.startswith("fmu-")])
    digest = hashlib.sha256(fmu("wornpin").read_bytes()).hexdigest()
    known = client.run(lambda: list(distributed._units))
    assert all(own.count(digest) == 1 for own in known.values())
    assert {worker: len(own) for worker, own in folders.items()} == {w: len(own) for w, own in known.items()}


def test_an_fmu_of_another_scene_is_refused_before_anything_is_run(write, tmp_path, client):
    with pytest.raises(StudyError, match="not the study's scene `wornpin`"):
        distributed.run(write(WORN_PIN), fmu("ideal"), client, tmp_path)
    assert not path(tmp_path, "own").exists()


def test_a_run_that_takes_too_long_is_a_row_that_says_so(write, tmp_path, client):
    found = distributed.run(write(WORN_PIN), fmu("wornpin"), client, tmp_path, budget=0.0)
    assert (found["status"] == "stopped after 0 s").sum() == (found["status"].str.startswith("stopped")).sum() > 0
