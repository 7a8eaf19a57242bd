"""libcosim, the co-simulation library of the Open Simulation Platform, which reads FMUs by FMILibrary."""

import subprocess
import sys
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu

from conftest import fmu

STEP, POINTS = 10_000, 100  # [ns]; 1 ms, with the first impacts of the worn pin
NAMES = ["slider.x", "slider.v", "slider.a", "joint.C.force.x", "solver.events", "joint.C.contact"]


def test_libcosim_computes_what_fmpy_computes(wornpin):
    letters = {"Real": "r", "Integer": "i", "Boolean": "b"}
    variables = {variable.name: variable for variable in wornpin.description.modelVariables}
    references = [f"{letters[variables[name].type]}{variables[name].valueReference}" for name in NAMES]
    program = [sys.executable, Path(__file__).with_name("in_cosim.py"), fmu("wornpin"), STEP, POINTS, *references]
    done = subprocess.run(list(map(str, program)), capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    # libcosim's log goes to standard output, too: its lines begin with a date in brackets.
    rows = [line.split() for line in done.stdout.splitlines() if not line.startswith("[")]
    found = np.array(rows, dtype=float)
    step = STEP * 1e-9
    wanted = simulate_fmu(str(wornpin.file), stop_time=POINTS * step, output_interval=step, output=NAMES)
    wanted = np.array(wanted[NAMES].tolist(), dtype=float)[1:]
    assert found.shape == wanted.shape and wanted[-1, NAMES.index("solver.events")] > 1
    # Times of the two differ in the last digit: libcosim counts nanoseconds.
    scale = abs(wanted).max(axis=0)
    assert (abs(found - wanted) <= 1e-9 * scale).all(), abs(found - wanted).max(axis=0) / scale
