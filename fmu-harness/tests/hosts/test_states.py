"""Saved states: a run that was saved, restored or carried elsewhere is the run that never stopped."""

import subprocess
import sys
from pathlib import Path

import pytest

from mechanism import grid

STEP = 1e-5
BEFORE, AFTER = 700, 300
POINTS = grid(0.0, STEP, BEFORE + AFTER)
# Every process that saves such a state each step and frees none (as one iterative master does)
# pays this for each.
SMALL = 64 * 1024


def moments(slave):
    """The first communication points at which a journal flies and touches, with their states."""
    found = {}
    for here, there in zip(POINTS, POINTS[1:]):
        slave.fmu.doStep(here, there - here)
        touching = slave.get("joint.C.contact")
        if touching not in found:
            found[touching] = there, slave.fmu.getFMUstate()
    assert len(found) == 2, "a worn pin both flies and touches within some crank turns"
    return found.values()


@pytest.mark.parametrize("scene", ["wornpin", "allplay", "seed"])
def test_a_rolled_back_run_is_the_run_to_the_bit(scene, request):
    slave = request.getfixturevalue(scene).start()
    slave.run(POINTS[: BEFORE + 1])
    state = slave.fmu.getFMUstate()
    straight_on = slave.run(POINTS[BEFORE:])
    for _ in range(5):
        slave.fmu.setFMUstate(state)
        assert slave.run(POINTS[BEFORE:]) == straight_on
    slave.fmu.freeFMUstate(state)
    assert not state, "freeing a state leaves NULL"
    slave.free()


def test_states_from_contact_and_from_flight_both_go_on_to_the_bit(wornpin):
    slave = wornpin.start()
    for time, state in moments(slave):
        points = grid(time, STEP, 200)
        slave.fmu.setFMUstate(state)
        once = slave.run(points)
        slave.fmu.setFMUstate(state)
        assert slave.run(points) == once
        slave.fmu.freeFMUstate(state)
    slave.free()


def test_a_state_saved_again_takes_the_old_ones_place(wornpin):
    slave = wornpin.start()
    state = slave.fmu.getFMUstate()
    address = state.value
    slave.run(POINTS[:51])
    slave.fmu.fmi2GetFMUstate(slave.fmu.component, state)
    assert state.value == address
    after = slave.run(POINTS[50:101])
    slave.fmu.setFMUstate(state)
    assert slave.run(POINTS[50:101]) == after
    slave.free()


def test_freeing_no_state_is_no_fault(wornpin):
    slave = wornpin.start()
    state = slave.fmu.getFMUstate()
    slave.fmu.freeFMUstate(state)
    slave.fmu.freeFMUstate(state)
    slave.free()


def test_serialized_bytes_are_small_and_the_same_each_time(wornpin):
    slave = wornpin.start()
    slave.run(POINTS[: BEFORE + 1])
    states = [slave.fmu.getFMUstate() for _ in range(2)]
    first, second = map(slave.fmu.serializeFMUstate, states)
    assert first == second
    assert len(first) < SMALL
    again = slave.fmu.serializeFMUstate(slave.fmu.deSerializeFMUstate(first))
    assert again == first
    slave.free()


@pytest.mark.parametrize("scene", ["wornpin", "press", "allplay"])
def test_a_fresh_process_goes_on_to_the_bit(scene, request, tmp_path):
    mechanism = request.getfixturevalue(scene)
    slave = mechanism.start()
    slave.set({"slider.load": -50.0})
    slave.run(POINTS[: BEFORE + 1])
    saved = tmp_path / "state"
    saved.write_bytes(slave.fmu.serializeFMUstate(slave.fmu.getFMUstate()))
    straight_on = slave.run(POINTS[BEFORE:])
    slave.free()

    program = [sys.executable, Path(__file__).with_name("go_on.py"), mechanism.file, saved, STEP, BEFORE, AFTER]
    fresh = subprocess.run(list(map(str, program)), capture_output=True, text=True)
    assert fresh.returncode == 0, fresh.stderr
    assert list(map(bytes.fromhex, fresh.stdout.split())) == straight_on


def test_a_state_brings_along_which_library_computes(wornpin):
    portable, usual = wornpin.start({"solver.portable": True}), wornpin.start()
    portable.run(POINTS[: BEFORE + 1])
    state = portable.fmu.serializeFMUstate(portable.fmu.getFMUstate())
    straight_on = portable.run(POINTS[BEFORE:])
    newer = not usual.get("solver.portable_used")
    usual.fmu.setFMUstate(usual.fmu.deSerializeFMUstate(state))
    assert usual.get("solver.portable_used")
    assert usual.run(POINTS[BEFORE:]) == straight_on
    # And back: a reset brings the packaged choice.
    usual.fmu.reset()
    usual.fmu.setupExperiment()
    usual.initialize()
    assert usual.get("solver.portable_used") != newer
    assert (usual.run(POINTS)[-1] == straight_on[-1]) != newer
    usual.free()
    portable.free()
