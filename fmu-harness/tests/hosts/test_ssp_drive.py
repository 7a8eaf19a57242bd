"""The drive of the press by itself: its limit, its clock, its profile."""

import sys
from pathlib import Path

import numpy as np
import pytest

import companions

sys.path.insert(0, str(Path(companions.__file__).with_name("units")))

from controller import ServoController  # noqa: E402


def drive(**values):
    slave = ServoController(instance_name="drive")
    for name, value in values.items():
        slave[name] = value
    return slave


def samples(slave, count, start=0):
    """Torque after each of so many samples, one communication step each."""
    torques = []
    for number in range(start, start + count):
        slave.do_step(number * 1e-3, 1e-3)
        torques.append(slave["torque"])
    return torques


def test_a_crank_that_is_held_winds_nothing_up():
    slave = drive(angle=np.pi, speed=0.0)
    torques = samples(slave, 1000)
    assert max(torques) == slave["limit"] and torques[-1] == slave["limit"]
    assert slave["summed"] <= slave["limit"]
    # Let go and too fast, it brakes at the first sample that takes effect.
    slave["speed"] = 1.5 * slave["fast_speed"]
    assert samples(slave, 3, 1000)[-1] < 0.0


@pytest.mark.parametrize("split", [1, 7, 100])
def test_no_split_of_time_changes_what_the_drive_does(split):
    """It samples by its own clock: torque over steps of a share of a sample is that over whole samples."""
    whole, parts = drive(angle=np.pi), drive(angle=np.pi)
    for number in range(50):
        speed = 30.0 + np.sin(number)
        whole["speed"] = parts["speed"] = speed
        whole.do_step(number * 1e-3, 1e-3)
        for part in range(split):
            parts.do_step((number + part / split) * 1e-3, 1e-3 / split)
        assert parts["torque"] == whole["torque"]


def test_the_profile_is_fast_slow_and_fast_with_the_slope_that_it_tells():
    slave = drive()
    angles = np.linspace(0.0, 2 * np.pi, 2001)
    speeds = np.array([slave.profile(angle)[0] for angle in angles])
    assert speeds.max() == pytest.approx(slave["fast_speed"], rel=1e-12)
    assert speeds.min() == pytest.approx(slave["slow_speed"], rel=1e-12)
    ahead = 1e-6
    for angle in angles:
        difference = (slave.profile(angle + ahead)[0] ** 2 - slave.profile(angle - ahead)[0] ** 2) / (2 * ahead)
        # Rounding of two squares of 1000 over the span, and the slope's own slope across it.
        assert slave.profile(angle)[1] == pytest.approx(difference, abs=4 * 1000 * 2.3e-16 / ahead + 1e4 * ahead)
