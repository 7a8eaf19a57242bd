"""FMPy runs the file by itself, and gets what the project's own harness gets."""

import csv
import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu

STOP, STEP = 0.024, 1e-5  # two turns of the worn pin


def bits(row):
    return struct.pack(f"{len(row)}d", *map(float, row))


def test_fmpy_and_the_harness_agree_to_the_bit(wornpin):
    with open(Path(os.environ["SLIDERCRANK_FMUS"]) / "wornpin.csv", newline="") as file:
        names, *own = csv.reader(file)
    result = simulate_fmu(str(wornpin.file), stop_time=STOP, output_interval=STEP, output=names[1:])
    assert set(result.dtype.names) == set(names)
    assert len(result) == len(own) == round(STOP / STEP) + 1
    for ours, theirs in zip(own, result[names].tolist()):
        assert bits(ours) == bits(theirs), f"at t = {ours[0]} s"


def test_fmpy_simulates_every_scene_without_an_option(every_fmu, tmp_path):
    table = tmp_path / "table.csv"
    command = [Path(sys.executable).with_name("fmpy"), "simulate", every_fmu, "--validate", "--output-file", table]
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, done.stdout
    assert done.stdout == "", "an FMU that has nothing to complain of is silent"
    result = np.genfromtxt(table, delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert len(result) > 100
    for name in result.dtype.names:
        if result[name].dtype.kind == "f":
            assert np.isfinite(result[name]).all(), name


def test_start_values_of_the_host_reach_the_mechanism(ideal):
    values = {"crank.speed_start": 100.0, "crank.angle_start": 0.25, "drive.mode": 2}
    result = simulate_fmu(
        str(ideal.file), start_values=values, stop_time=0.1, output_interval=0.01, output=["crank.angle"]
    )
    # θ = θ₀ + ω·t: one product and one sum, each rounded once, of numbers up to 10.25.
    bound = 2 * 10.25 * np.finfo(float).eps
    assert np.abs(result["crank.angle"] - (0.25 + 100.0 * result["time"])).max() <= bound


def test_a_tolerance_among_the_start_values_wins_over_the_experiments(wornpin):
    """FMPy's experiment always has the model description's tolerance, which nobody asked for."""

    def run(**options):
        names = ["solver.tolerance_used", "solver.evaluations", "slider.a"]
        return simulate_fmu(str(wornpin.file), stop_time=STOP, output_interval=1e-4, output=names, **options)

    packaged, tight = run(), run(start_values={"solver.tolerance": 1e-9})
    assert set(packaged["solver.tolerance_used"]) == {float(wornpin.variables["solver.tolerance"].start)}
    assert set(tight["solver.tolerance_used"]) == {1e-9}
    assert tight["solver.evaluations"][-1] > packaged["solver.evaluations"][-1]
    assert tight.tolist() == run(relative_tolerance=1e-9).tolist()
    both = run(start_values={"solver.tolerance": 1e-9}, relative_tolerance=1e-4)
    assert tight.tolist() == both.tolist()


def test_fmpys_input_table_drives_the_load(ideal):
    """A load that rises to 400 N. FMPy's own way to hand over slopes too fails in 0.3.32 unless an FMU has nine inputs."""
    table = np.array([(0.0, 0.0), (1e-3, 400.0), (2e-3, 400.0)], dtype=[("time", "f8"), ("slider.load", "f8")])
    names = ["slider.load", "joint.C.force.x", "slider.a"]
    times = dict(stop_time=2e-3, output_interval=1e-4, output=names)
    loaded = simulate_fmu(str(ideal.file), input=table, **times)
    free = simulate_fmu(str(ideal.file), **times)
    # Newton along the guide: m·a = F_C + load, and the speed drive prescribes a; so the pin's force
    # falls by just the load. FMPy sets inputs at the start of a step.
    assert np.array_equal(loaded["slider.a"], free["slider.a"])
    fallen = free["joint.C.force.x"] - loaded["joint.C.force.x"]
    scale = np.abs(free["joint.C.force.x"]).max()
    assert np.abs(fallen - loaded["slider.load"]).max() <= 16 * np.finfo(float).eps * scale
    assert abs(loaded["slider.load"][-1] - 400.0) <= 4 * 400.0 * np.finfo(float).eps
