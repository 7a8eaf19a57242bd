"""What a simulated second costs with FMPy at three communication steps; no test, but a measurement.

    target/hosts/bin/python fmu-harness/tests/hosts/cost.py FMU [SECONDS [OUTPUTS]]

CPU time of this process, the least of several runs. FMPy's own share is taken apart by running the
same loop on a library whose fmi2DoStep and fmi2GetReal do nothing; it is compiled here by `cc`.
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


def loop(slave, references, step, seconds):
    """[s] CPU time of stepping to the end and reading the outputs at each point."""
    count = round(seconds / step)
    step_on, read = slave.fmu.doStep, slave.fmu.getReal
    start = time.process_time()
    for point in range(count):
        step_on(point * step, step)
        read(references)
    return time.process_time() - start


def least(mechanism, references, step, seconds, library=None):
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
        costs.append(loop(slave, references, step, seconds))
        work = slave.get("solver.evaluations")
        slave.free()
    return min(costs), work


def main(file, seconds=0.24, outputs="slider.x,slider.v,joint.C.force.x,joint.C.force.y"):
    mechanism, seconds = Mechanism(file), float(seconds)
    names = [v.name for v in mechanism.outputs(("Real",))] if outputs == "all" else outputs.split(",")
    references = mechanism.references(names)
    print(f"{Path(file).name}: {seconds} s simulated, tolerance {TOLERANCE}, {len(names)} outputs read at each point")
    print(f"{'step':>8} {'total':>10} {'host':>10} {'unit':>10}  evaluations/s    [s of CPU per simulated second]")
    units = []
    with TemporaryDirectory() as folder:
        library = idle(folder)
        for step in STEPS:
            total, work = least(mechanism, references, step, seconds)
            host, _ = least(mechanism, references, step, seconds, library)
            units.append(total - host)
            shown = [f"{cost / seconds:10.4f}" for cost in (total, host, total - host)]
            print(f"{step:8.0e} {' '.join(shown)}  {work / seconds:13.0f}")
    print(f"host apart, the dearest step costs {max(units) / min(units):.2f} times the cheapest")


if __name__ == "__main__":
    main(*sys.argv[1:])
