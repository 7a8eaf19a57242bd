"""What coupling does to the press: strokes, bottom dead centre over clearance, error over communication step.

    study.py JOB.json

The job: `package`; `strokes`, a CSV to write; `stroke_step`, `stroke_stop` [s]; `factors` of all clearances,
`clearance_step`, `clearance_stop` [s]; `steps`, `references`, two short steps, and `step_stop`, `grid`
[s], at whose multiples runs are compared. Prints what it found as JSON.
"""

import csv
import json
import sys
import time
from math import pi, tau
from pathlib import Path

import numpy

from master import METHODS, Master
from system import Package, leave

JOINTS = "ABCT"
IDEAL = [("press", f"joint.{joint}.model", 1) for joint in JOINTS]
# Of the press, so that what is compared is the coupling.
TOLERANCE = 1e-9
# Crank angle on both sides of bottom dead centre in which the slider turns back.
TURNING = 0.3


def number(package, unit, name):
    """A parameter as the package has it."""
    return package.values[unit].get(name, float(package.variable(unit, name).start))


def strokes(package, job):
    """The run that hosts see, as a CSV; and its account."""
    run = Master(package).run("held", job["stroke_step"], job["stroke_stop"])
    table = run.table()
    with open(job["strokes"], "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(table)
        out.writerows(map(repr, row) for row in numpy.array(list(table.values())).T.tolist())
    turns = (table["press.crank.angle"] - pi) / tau
    count = numpy.floor(turns[-1])
    whole = turns <= count
    torque, limit = table["controller.torque"][whole], number(package, "controller", "limit")
    return {
        "strokes": float(count),
        "lasts": float(numpy.interp(count, turns, table["time"]) / count),
        "torque": float(numpy.abs(torque).max()),
        "rms_torque": float(numpy.sqrt(numpy.mean(torque**2))),
        "limited": float(numpy.mean(numpy.abs(torque) >= limit)),
        "limit": limit,
        "slowest": float(table["press.crank.speed"].min()),
        "fastest": float(table["press.crank.speed"].max()),
        "cut": float(numpy.interp(count, turns, table["sheet.work"]) / count),
        "ports": books(run),
    }


def books(run):
    return {
        name: {"inside": port.inside, "outside": port.outside, "exchanged": port.exchanged}
        for name, port in run.ports.items()
    }


def clearances(package, job):
    """Where the slider turns back in each stroke, over its place with ideal joints; and its error under load."""
    reach = number(package, "press", "crank.length") + number(package, "press", "rod.length")
    found = []
    for factor in job["factors"]:
        names = [f"joint.{joint}.clearance" for joint in JOINTS]
        settings = [("press", name, number(package, "press", name) * factor) for name in names] if factor else IDEAL
        table = Master(package, settings).run("extrapolated", job["clearance_step"], job["clearance_stop"]).table()
        angle, x = table["press.crank.angle"], table["press.slider.x"]
        dead = [numpy.abs(angle - tau * turn) < TURNING for turn in range(1, int((angle[-1] - TURNING) / tau) + 1)]
        found.append({
            "clearance": number(package, "press", "joint.A.clearance") * factor,
            "dead_centre": [float(x[near].max() - reach) for near in dead],
            "loaded": [float(table["press.accuracy.position"][near].min()) for near in dead],
        })
    return found


def steps(package, job, settings):
    """Error of the crank's speed and the slider's place, and energy made by the coupling, for each master and step."""

    def run(method, step):
        begin = time.process_time()
        run = Master(package, settings, TOLERANCE).run(method, step, job["step_stop"], round(job["grid"] / step))
        return run, run.table(), time.process_time() - begin

    reference, other = [run("iterated", step)[1] for step in job["references"]]
    points = []
    for method in METHODS:
        for step in job["steps"]:
            one, table, cost = run(method, step)
            points.append({
                "method": method,
                "step": step,
                "speed": rms(table, reference, "press.crank.speed"),
                "position": rms(table, reference, "press.slider.x"),
                "passes": one.passes / round(job["step_stop"] / step),
                "cost": cost / job["step_stop"],
                "ports": books(one),
            })
    floor = {"speed": rms(other, reference, "press.crank.speed"), "position": rms(other, reference, "press.slider.x")}
    return {"points": points, "floor": floor}


def rms(table, reference, name):
    return float(numpy.sqrt(numpy.mean((table[name] - reference[name]) ** 2)))


def main(job):
    package = Package(job["package"])
    print(json.dumps({
        "strokes": strokes(package, job),
        "clearances": clearances(package, job),
        "ideal": steps(package, job, IDEAL),
        "worn": steps(package, job, []),
    }))


if __name__ == "__main__":
    main(json.loads(Path(sys.argv[1]).read_text()))
    leave(0)
