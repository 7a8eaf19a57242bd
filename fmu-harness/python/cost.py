"""What a run costs with FMPy at several communication steps, and what it gives.

    python cost.py JOB.json

The job: `fmu`, a file; `settings`, names and values set before initialisation; `inputs`, each with a
name and either a `value` or points `x` and `y` over `time` or `crank.angle`; `steps` [s]; `window` [s],
over which outputs are kept; `span` [s], over which time is taken; `kept`, outputs that go into
FOLDER/N.csv for the Nth step; `read`, outputs that are read at each point of a timed run; `repeats`.

Prints a list with an entry for each step: `total`, CPU time of this process in a loop of fmi2DoStep
and fmi2GetReal; `host`, the same loop on a library whose two functions do nothing (made here by `cc`),
both the least of several runs and per simulated second; `evaluations` per simulated second.
"""

import ctypes
import json
import subprocess
import sys
import time
from math import tau
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy

from mechanism import Mechanism

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


class Inputs:
    """Constant ones are set once; the others follow straight lines, set at the beginning of every step."""

    def __init__(self, slave, inputs):
        self.slave = slave
        self.crank = slave.mechanism.references(["crank.angle", "crank.speed"])
        self.references = slave.mechanism.references([own["name"] for own in inputs])
        self.inputs = inputs
        self.constant = all("value" in own for own in inputs)

    def set(self, now):
        angle = self.slave.fmu.getReal(self.crank)[0]
        self.slave.fmu.setReal(self.references, self.values(now, angle))

    def set_lines(self, now, step):
        angle, speed = self.slave.fmu.getReal(self.crank)
        begin, end = self.values(now, angle), self.values(now + step, angle + speed * step)
        self.slave.fmu.setReal(self.references, begin)
        slopes = [(there - here) / step for here, there in zip(begin, end)]
        self.slave.fmu.setRealInputDerivatives(self.references, [1] * len(slopes), slopes)

    def values(self, now, angle):
        return [self.value(own, now, angle) for own in self.inputs]

    @staticmethod
    def value(own, now, angle):
        if "value" in own:
            return own["value"]
        if own["over"] == "time":
            return float(numpy.interp(now, own["x"], own["y"]))
        return float(numpy.interp(angle, own["x"], own["y"], period=tau))


def started(mechanism, job):
    slave = mechanism.instantiate()
    slave.set(job["settings"])
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    inputs = Inputs(slave, job["inputs"])
    inputs.set(0.0)
    slave.fmu.exitInitializationMode()
    return slave, inputs


def run(slave, inputs, step, end, references, look=lambda now, values: None):
    """[s] CPU time of stepping to the last point before the end and reading outputs at each."""
    step_on, read = slave.fmu.doStep, slave.fmu.getReal
    begin = time.process_time()
    for point in range(points(end, step)):
        now = point * step
        if not inputs.constant:
            inputs.set_lines(now, step)
        step_on(now, step)
        look(now + step, read(references))
    return time.process_time() - begin


def points(end, step):
    """A millionth of a step is what remains of a quotient that was meant to be whole."""
    return int(end / step + 1e-6)


def keep(mechanism, job, step, file):
    slave, inputs = started(mechanism, job)
    with open(file, "w") as out:
        out.write(",".join(["time", *job["kept"]]) + "\n")
        row = lambda now, values: out.write(",".join(map(repr, [now, *values])) + "\n")
        references = mechanism.references(job["kept"])
        row(0.0, slave.fmu.getReal(references))
        run(slave, inputs, step, job["window"], references, row)
    slave.free()


def least(mechanism, job, step, library=None):
    """[s] The cheapest of several runs, and evaluations of the right-hand side."""
    references, costs, work = mechanism.references(job["read"]), [], 0
    for _ in range(job["repeats"]):
        slave, inputs = started(mechanism, job)
        functions = slave.fmu._functions
        if library:
            for name in ("fmi2DoStep", "fmi2GetReal"):
                ours, nothing = functions[name], getattr(library, name)
                nothing.argtypes, nothing.restype = ours.argtypes, ours.restype
                nothing.argnames = ours.argnames
                functions[name] = nothing
        costs.append(run(slave, inputs, step, job["span"], references))
        work = slave.get("solver.evaluations")
        slave.free()
    return min(costs), work


def main(file):
    job = json.loads(Path(file).read_text())
    mechanism = Mechanism(job["fmu"])
    results = []
    with TemporaryDirectory() as folder:
        library = idle(folder)
        for number, step in enumerate(job["steps"]):
            keep(mechanism, job, step, Path(job["folder"]) / f"{number}.csv")
            total, work = least(mechanism, job, step)
            host, _ = least(mechanism, job, step, library)
            simulated = points(job["span"], step) * step
            results.append({
                "total": total / simulated,
                "host": host / simulated,
                "evaluations": work / simulated,
                "over": simulated,
            })
    print(json.dumps(results))


if __name__ == "__main__":
    main(sys.argv[1])
