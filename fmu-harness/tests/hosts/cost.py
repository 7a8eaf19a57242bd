"""What a simulated second costs with FMPy at three communication steps; no test, but a measurement.

    target/hosts/bin/python fmu-harness/tests/hosts/cost.py WORNPIN.fmu IDEAL.fmu [OUTPUT...]

CPU time of this process, the least of several runs. The host's share is taken apart in two ways:
- `unit`: less the same loop on a library whose fmi2DoStep and fmi2GetReal do nothing (made here by
  `cc`). What is left is all that happens in the unit, the making of outputs at each point included;
- `solver`: less the same loop on the second FMU, which has next to nothing to integrate but makes
  outputs as well.
"""

import ctypes
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from mechanism import Mechanism

STEPS = [1e-5, 1e-4, 1e-3]
REPEATS = 5
SECONDS = 0.24  # [s] simulated in each run: 20 turns of the worn pin
OUTPUTS = ["slider.x", "slider.v", "joint.C.force.x", "joint.C.force.y"]
TOLERANCE = 1e-6
NOTHING = """
#include <stddef.h>
int fmi2DoStep(void *c, double t, double h, int no) { return 0; }
int fmi2GetReal(void *c, const unsigned *vr, size_t n, double *value) { return 0; }
"""


def idle(folder):
    """The two functions of a unit that does nothing."""
    source, library = Path(folder) / "idle.c", Path(folder) / "idle.so"
    source.write_text(NOTHING)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
    return ctypes.CDLL(str(library))


def loop(slave, references, step):
    """[s] CPU time of stepping to the end and reading the outputs at each point."""
    count = round(SECONDS / step)
    step_on, read = slave.fmu.doStep, slave.fmu.getReal
    start = time.process_time()
    for point in range(count):
        step_on(point * step, step)
        read(references)
    return time.process_time() - start


def least(mechanism, references, step, library=None):
    costs, work = [], 0
    for _ in range(REPEATS):
        slave = mechanism.start(tolerance=TOLERANCE)
        functions = slave.fmu._functions
        if library:
            for name in ("fmi2DoStep", "fmi2GetReal"):
                ours, nothing = functions[name], getattr(library, name)
                nothing.argtypes, nothing.restype = ours.argtypes, ours.restype
                nothing.argnames = ours.argnames
                functions[name] = nothing
        costs.append(loop(slave, references, step))
        work = slave.get("solver.evaluations")
        slave.free()
    return min(costs), work


def main(file, reference, *outputs):
    mechanism, easy = Mechanism(file), Mechanism(reference)
    references = mechanism.references(outputs or OUTPUTS)
    print(f"{Path(file).name}: {SECONDS} s simulated, tolerance {TOLERANCE}, {len(references)} outputs read at each point")
    print(f"{'step':>8} {'total':>10} {'host':>10} {'unit':>10} {'solver':>10}    s of CPU per simulated second")
    shares = []
    with TemporaryDirectory() as folder:
        library = idle(folder)
        for step in STEPS:
            total, work = least(mechanism, references, step)
            host, _ = least(mechanism, references, step, library)
            simple, _ = least(easy, references, step)
            shares.append((total - host, total - simple))
            costs = " ".join(f"{cost / SECONDS:10.4f}" for cost in (total, host, total - host, total - simple))
            print(f"{step:8.0e} {costs}    {work / SECONDS:.0f} evaluations per simulated second")
    units, solvers = zip(*shares)
    print(f"dearest over cheapest: unit {max(units) / min(units):.2f}, solver {max(solvers) / min(solvers):.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
