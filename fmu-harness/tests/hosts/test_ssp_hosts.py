"""The packaged press in two hosts: FMPy's SSP master and ecos, a C++ engine, which both read the package.

Both couple in parallel (Jacobi): every unit steps with what the others gave at the last communication
point. So they hand over the same values, and what is left is how they read the press.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp

from master import Master
from system import Package

FILE = Path(os.environ["SLIDERCRANK_FMUS"]) / "press.ssp"
STEP, POINTS = 1e-4, 7600  # three strokes
LIMIT, SAMPLE = 2000.0, 10
# ecos reads the press after it has set the next inputs: setting one ends the step that went beyond
# this point with a step of its own, and the two differ by less than the solver's tolerance.
ALIKE = 1e-6


@pytest.fixture(scope="module")
def package():
    return Package(FILE)


@pytest.fixture(scope="module")
def signals(package):
    return [f"{unit}.{name}" for unit, connectors in package.connectors.items() for name, _ in connectors]


@pytest.fixture(scope="module")
def fmpy(package, signals):
    # This master adds steps up until it passes the stop time; half a step less is sure to be the last.
    stop = (POINTS - 0.5) * STEP
    rows = simulate_ssp(str(FILE), stop_time=stop, step_size=STEP, parameter_set=package.parameter_set())
    # A row is labelled by where its step starts.
    return {"time": rows["time"] + STEP, **{signal: rows[signal] for signal in signals}}


@pytest.fixture(scope="module")
def ecos(signals):
    # libtbb.so.12, which ecos needs, came with the environment.
    environment = dict(os.environ, LD_LIBRARY_PATH=str(Path(sys.prefix) / "lib"))
    program = [sys.executable, Path(__file__).with_name("in_ecos.py"), FILE, STEP, POINTS, *signals]
    done = subprocess.run(list(map(str, program)), env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    rows = np.array([line.split() for line in done.stdout.splitlines()], dtype=float)
    return dict(zip(["time", *signals], rows.T))


@pytest.fixture(params=["fmpy", "ecos"])
def either(request):
    return request.getfixturevalue(request.param)


def test_what_goes_over_the_wires_is_the_same_to_the_bit(package, fmpy, ecos):
    assert np.array_equal(fmpy["time"], ecos["time"])
    for wire in package.wires:
        name = ".".join(wire.target)
        assert np.array_equal(fmpy[name], ecos[name]), name


def test_both_hosts_come_to_the_same(signals, fmpy, ecos):
    for signal in signals:
        amplitude = np.abs(ecos[signal]).max()
        assert np.abs(fmpy[signal] - ecos[signal]).max() <= ALIKE * amplitude, signal


def test_our_master_with_held_inputs_is_fmpys_to_the_bit(package, fmpy):
    own = Master(package).run("held", STEP, POINTS * STEP).table()
    for name, values in own.items():
        if name != "time":
            assert np.array_equal(values[1:], fmpy[name]), name


def test_the_sheet_is_cut_in_every_stroke(either):
    load, turns = either["press.slider.load"], either["press.crank.angle"] // (2 * np.pi)
    assert turns.max() == 3
    for turn in range(3):
        of_stroke = load[turns == turn]
        assert of_stroke.min() < -0.99 * 300e3 and of_stroke.max() > 30e3, "cut, and snapped back"


def test_the_drive_keeps_its_torque_limit_and_uses_it(either):
    torque = either["press.crank.torque"]
    assert np.abs(torque).max() == LIMIT
    assert np.mean(torque == LIMIT) > 0.01


def test_torque_changes_at_samples_only(either):
    torque = either["controller.torque"]
    # Row n is the point n + 1; samples lie at multiples of ten points.
    changes = np.flatnonzero(np.diff(torque)) + 2
    assert len(changes) > 500 and np.all(changes % SAMPLE == 0)


def test_the_press_follows_its_profile_where_torque_suffices(either):
    angle, speed, wanted = (either[name] for name in ("press.crank.angle", "press.crank.speed", "controller.set_speed"))
    degrees = np.degrees(angle) % 360.0
    # Three strokes; the profile slows down from 270 deg on, the punch is at work from 340 deg on.
    approach = (degrees > 180.0) & (degrees < 270.0) & (np.arange(POINTS) > SAMPLE)
    slowing = (degrees > 270.0) & (degrees < 335.0)
    assert np.abs(speed[approach] / wanted[approach] - 1.0).max() < 0.02
    assert np.abs(speed[slowing] - wanted[slowing]).max() < 0.05 * wanted.max()
    assert speed[(degrees > 335.0) & (degrees < 345.0)].max() < 13.0, "it forms slowly"
