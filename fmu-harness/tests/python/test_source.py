"""The source tree is found, its program called as told, and what it refuses is one error."""

import os
import zipfile
from pathlib import Path

import pandas
import pytest

import slidercrank
from slidercrank import SourceError, package, scenes, simulate, source

from conftest import fmu


def test_the_scenes_are_those_that_the_program_knows(tmp_path):
    with pytest.raises(SourceError) as refused:
        package("nothing", tmp_path / "nothing.fmu")
    shipped = str(refused.value).split("shipped scenes are ")[1].split(";")[0]
    assert sorted(scenes()) == sorted(shipped.split(", "))


def test_a_scene_file_is_packaged_where_it_is_wanted(tmp_path):
    text = (source.home() / "fmu-harness/scenes/ideal.toml").read_text() + "\n# own\n"
    (tmp_path / "own.toml").write_text(text)
    file = package(tmp_path / "own.toml", tmp_path / "out" / "own.fmu")
    assert file == tmp_path / "out" / "own.fmu"
    assert zipfile.ZipFile(file).read("documentation/scene.toml").decode() == text


def test_without_a_source_tree_there_is_one_clear_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(source.HOME)
    with pytest.raises(SourceError, match="SLIDERCRANK_HOME may name one"):
        scenes()
    monkeypatch.setenv(source.HOME, str(tmp_path / "gone"))
    with pytest.raises(SourceError, match="gone"):
        scenes()


def test_the_tree_is_found_upwards_and_cargo_called_in_it(tmp_path, monkeypatch):
    root, bin = tmp_path / "tree", tmp_path / "bin"
    below = root / "some" / "where"
    for folder in (root / "fmu-harness", below, bin):
        folder.mkdir(parents=True)
    (root / "fmu-harness" / "Cargo.toml").touch()
    (bin / "cargo").write_text('#!/bin/sh\npwd > "$SEEN"\necho "$@" >> "$SEEN"\n')
    (bin / "cargo").chmod(0o755)
    monkeypatch.setenv("PATH", f"{bin}:{os.environ['PATH']}")
    monkeypatch.setenv("SEEN", str(tmp_path / "seen"))
    monkeypatch.delenv(source.HOME)
    monkeypatch.delenv(source.PROGRAM)
    monkeypatch.chdir(below)
    file = package("press", "own.fmu")
    where, words = Path(tmp_path / "seen").read_text().splitlines()
    assert where == str(root)
    assert words == f"run --release --quiet --package fmu-harness -- package --scene press --output {file}"
    assert file == below / "own.fmu"


def test_a_run_is_a_frame_over_time_with_the_settings_and_inputs_that_were_given():
    load = pandas.DataFrame({"slider.load": [0.0, -1000.0]}, index=[0.0, 0.01])
    names = ["slider.x", "slider.v", "drive.torque"]
    told = {"settings": {"crank.length": 0.04}, "outputs": names}
    free = simulate(fmu("ideal"), 0.01, 1e-3, **told)
    loaded = simulate(fmu("ideal"), 0.01, 1e-3, **told, inputs=load)
    assert list(free.columns) == names and free.index.name == "time" and len(free) == 11
    # Cranks of a given speed move the same under any load: power of the load alone is added to the drive's.
    pandas.testing.assert_series_equal(free["slider.x"], loaded["slider.x"], rtol=1e-9)
    assert free["slider.x"].iloc[0] == pytest.approx(0.04 + 0.12, rel=1e-9)
    assert abs(loaded["drive.torque"] - free["drive.torque"]).max() > 1.0
    with pytest.raises(KeyError, match="slider.w"):
        simulate(fmu("ideal"), outputs=["slider.w"])


def test_a_study_that_is_wrong_is_told_in_the_program_s_words(write):
    with pytest.raises(SourceError, match="missing field"):
        slidercrank.plan(write('name = "own"\n'))
