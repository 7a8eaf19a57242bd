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


RAMP = pandas.DataFrame({"crank.torque": [0.0, 10.0]}, index=[0.0, 0.01])
KINK = pandas.DataFrame({"crank.torque": [0.0, 4.0, -6.0, 0.0]}, index=[0.002, 0.0032, 0.0032, 0.008])
"""It also jumps, and stays as it is before and after its rows."""
FREE = {"settings": {"drive.mode": 1, "crank.speed_start": 1.0}, "outputs": ["crank.angle", "crank.speed"]}


@pytest.mark.parametrize("inputs", [RAMP, KINK])
def test_inputs_are_straight_between_their_rows_whatever_the_step(inputs):
    runs = [simulate(fmu("ideal"), 0.01, step, **FREE, inputs=inputs).iloc[-1] for step in (1e-2, 5e-3, 1e-4)]
    assert runs[0].equals(runs[1]) and runs[0].equals(runs[2])
    held = simulate(fmu("ideal"), 0.01, 1e-2, **FREE, inputs=inputs.iloc[:1]).iloc[-1]
    assert abs(runs[0]["crank.speed"] - held["crank.speed"]) > 1.0


def test_fmi_3_holds_inputs_until_the_step_ends_or_a_row_comes():
    ramp, pulse = RAMP, pandas.DataFrame({"crank.torque": [0.0, 0.0, 4.0, 4.0, 0.0]}, index=[0, 0.002, 0.002, 0.004, 0.004])
    two, three = (
        [simulate(fmu(name), 0.01, step, **FREE, inputs=inputs)["crank.speed"].iloc[-1] for inputs, step in
         [(pulse, 1e-2), (ramp, 1e-4), (ramp, 1e-2)]]
        for name in ("ideal", "ideal3")
    )
    assert three[0] == two[0]
    assert three[1] == pytest.approx(two[1], rel=0.01) and three[1] != two[1]
    # In one step of the ramp there is no torque at all.
    assert three[2] == simulate(fmu("ideal3"), 0.01, 1e-2, **FREE)["crank.speed"].iloc[-1]


def test_without_outputs_all_numbers_are_kept_and_no_clocks():
    assert list(simulate(fmu("wornpin3"), 1e-4, 1e-4)) == list(simulate(fmu("wornpin"), 1e-4, 1e-4))


def test_a_study_that_is_wrong_is_told_in_the_program_s_words(write):
    with pytest.raises(SourceError, match="missing field"):
        slidercrank.plan(write('name = "own"\n'))
