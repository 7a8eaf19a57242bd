"""Packaged scenes, whose directory the Rust test hands over, and studies."""

import os
from pathlib import Path

import numpy
import pytest

WORN_PIN = """
name = "own"
scene = "wornpin"
seed = 3
draws = 6

[run]
turns = 1.5
transient = 0.25
step = 2e-5

[grid]
"solver.method" = ["verner7", "moreau"]
"joint.C.friction.law" = ["none", "lugre"]

[random]
"joint.C.clearance" = { log_uniform = { min = "100 um", max = "500 um" } }
"joint.C.friction.static_coefficient" = { uniform = { min = 0.1, max = 0.2 } }

[keep]
contact = { of = "joint.C.contact", reduce = "mean" }
dead_centre = { of = "accuracy.position", reduce = "mean", at = 0.5 }
peak_force = { of = "joint.C.force", reduce = "peak" }
position = { of = "accuracy.position", reduce = "rms" }
"""
"""Verner's method and bristles, a boolean, a vector, passages; rigid contacts have no bristles, so some runs fail."""

PRESS = """
name = "tool"
scene = "press"

[run]
turns = 1.1
transient = 0.1
step = 1e-4

[grid]
"joint.T.clearance" = ["5 um", "15 um"]
"crank.speed_start" = ["300 spm", 0.0]

[keep]
mean = { of = "slider.x", reduce = "mean" }
tilt = { of = "slider.angle", reduce = "range", at = 0 }
torque = { of = "drive.torque", reduce = "min" }
way = { of = "slider.v", reduce = "last" }
"""
"""A load over the crank's turn; a crank that stands has no turns."""


def fmu(scene):
    file = Path(os.environ["SLIDERCRANK_FMUS"]) / f"{scene}.fmu"
    assert file.is_file(), f"{file} was not packaged"
    return file


@pytest.fixture
def write(tmp_path):
    """Writes a study into a fresh directory."""

    def made(text):
        file = tmp_path / "study.toml"
        file.write_text(text)
        return file

    return made


@pytest.fixture
def deck(tmp_path):
    """Writes a deck into a fresh directory."""

    def made(text, name="rod.inp"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return made


def bits(frame):
    """What is in a frame, to the bit: names, numbers as bytes, texts."""
    numbers = frame.select_dtypes("number").astype(numpy.float64)
    return list(frame.columns), list(numbers.columns), numbers.to_numpy().tobytes(), list(frame["status"])
