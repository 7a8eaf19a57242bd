"""The source tree is found, its program called as told, and what it refuses is one error."""

import math
import os
import zipfile
from pathlib import Path

import numpy
import pandas
import pytest
from fmpy import read_model_description

import slidercrank
from slidercrank import SourceError, Unit, package, scenes, simulate, source
from slidercrank.recipe import RunError

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
    with pytest.raises(RunError, match="slider.x"):
        simulate(fmu("ideal"), 0.01, settings={"slider.x": 1.0})


@pytest.mark.parametrize("scene", ["wornpin", "wornpin3"])
def test_steps_are_the_fmu_s_own_unless_others_are_given(scene):
    own = float(read_model_description(str(fmu(scene))).defaultExperiment.stepSize)
    run = simulate(fmu(scene), 1200 * own, outputs="slider.x")
    assert len(run) == 1201 and numpy.allclose(numpy.diff(run.index), own, rtol=1e-9)


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


def run_with(inputs, settings=None, scene="ideal"):
    return simulate(fmu(scene), 0.01, 1e-3, {"drive.mode": 1} | (settings or {}), inputs, outputs="crank.speed")


@pytest.mark.parametrize(
    "inputs, settings, why",
    [
        (RAMP.iloc[:0], {}, "inputs: there are no rows"),
        (RAMP.iloc[::-1], {}, r"inputs, row 2: time 0 s does not increase"),
        (RAMP.set_axis([0.0, math.nan]), {}, "row 2, column `time`: `nan` is not a finite number"),
        (RAMP.replace(10.0, math.inf), {}, "row 2, column `crank.torque`: `inf` is not a finite number"),
        (RAMP.set_axis(pandas.to_timedelta([0.0, 0.01], unit="s")), {}, "the index is timedelta64.*, but must be numbers"),
        (RAMP.set_axis(pandas.to_datetime([0.0, 0.01], unit="s")), {}, "the index is datetime64.*, but must be numbers"),
        (RAMP.set_axis(["0", "0.01"]), {}, "the index is .*, but must be numbers"),
        (RAMP, {"crank.torque": 1.0}, "`crank.torque` is among the settings and the inputs"),
        (RAMP[["crank.torque"] * 2], {}, "two columns have the name `crank.torque`"),
        (RAMP.rename(columns={"crank.torque": "crank.length"}), {}, "inputs: `crank.length` is no input"),
    ],
)
def test_what_is_no_input_over_time_is_refused(inputs, settings, why):
    with pytest.raises(ValueError, match=why):
        run_with(inputs, settings)


def test_whole_seconds_are_times_too():
    inputs = pandas.DataFrame({"crank.torque": [2, 4]}, index=[0, 1])
    assert run_with(inputs).equals(run_with(inputs.astype(float).set_axis([0.0, 1.0])))


REFUSED = [
    ("rod.flexible.bending_modes", 1.9, "`1.9` is not a whole number"),
    ("rod.flexible.bending_modes", "1.9", "`1.9` is not a whole number"),
    ("rod.flexible.bending_modes", 2**32 + 1, "`4294967297` is not a whole number of 32 bits"),
    ("rod.flexible.bending_modes", math.nan, "`nan` is not a whole number"),
    ("energy.audit", 2, "`2` is not true or false"),
    ("energy.audit", "yes", "`yes` is not true or false"),
    ("joint.C.law", "hu", "`hu` is not one of hertz, hunt_crossley, .*, hu_guo, "),
    ("joint.C.law", 8.5, "`8.5` is not one of hertz, "),
    ("crank.length", "long", "`long` is not a finite number"),
    ("crank.length", math.inf, "`inf` is not a finite number"),
]


@pytest.mark.parametrize("scene", ["wornpin", "wornpin3"])
@pytest.mark.parametrize("name, value, why", REFUSED)
def test_a_value_of_another_type_is_refused(scene, name, value, why):
    with pytest.raises(ValueError, match=f"`{name}`: {why}"):
        simulate(fmu(scene), 1e-4, 1e-4, settings={name: value})
    with Unit(fmu(scene)) as unit, pytest.raises(RunError, match=f"`{name}`: {why}"):
        unit.start({name: value})


def test_what_no_value_can_be_set_of_is_refused():
    with pytest.raises(ValueError, match="`joint.C.contact_change`: `1` is not of a type that can be set"):
        simulate(fmu("wornpin3"), 1e-4, 1e-4, settings={"joint.C.contact_change": 1})


@pytest.mark.parametrize("scene", ["wornpin", "wornpin3"])
@pytest.mark.parametrize(
    "name, values",
    [
        ("joint.C.law", ["hu_guo", 9, 9.0, "9"]),
        ("solver.method", ["dop853", 3, numpy.int64(3)]),
        ("energy.audit", [True, 1, 1.0, "true", "1", numpy.True_]),
        ("rod.flexible.bending_modes", [1, 1.0, "1", numpy.float64(1.0)]),
        ("crank.length", [0.04, "0.04"]),
    ],
)
def test_a_value_can_be_told_in_several_ways(scene, name, values):
    outputs = ["slider.x", "joint.C.force.x", "energy.dissipated", "solver.evaluations"]
    plain, *runs = [simulate(fmu(scene), 2e-3, 1e-4, settings, outputs=outputs) for settings in
                    [{}, *({name: value} for value in values)]]
    assert not runs[0].equals(plain) and all(run.equals(runs[0]) for run in runs)
    told = []
    for value in values:
        with Unit(fmu(scene)) as unit:
            unit.start({name: value})
            unit.step(2e-3)
            told.append(list(unit.read(outputs[:3])))
    assert all(row == told[0] for row in told)


def test_one_output_may_be_told_by_its_name():
    one, several = (simulate(fmu("ideal"), 1e-3, 1e-4, outputs=outputs) for outputs in ("slider.x", ["slider.x"]))
    assert one.equals(several)


def test_without_outputs_all_numbers_are_kept_and_no_clocks():
    assert list(simulate(fmu("wornpin3"), 1e-4, 1e-4)) == list(simulate(fmu("wornpin"), 1e-4, 1e-4))


def test_a_study_that_is_wrong_is_told_in_the_program_s_words(write):
    with pytest.raises(SourceError, match="missing field"):
        slidercrank.plan(write('name = "own"\n'))
