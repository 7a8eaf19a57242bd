"""What every Python peer is asked, and how it answers.

    python PEER.py JOB METHOD

JOB is a JSON file: "parameters" of the scene in SI units, "span" [s] and "points" of a run, a ladder of "tolerances",
the error norm's "scales", the "longest_step" [s], the state at the "start", the scene's "file" and the "library" of its
equations. The answer is a line of JSON for each tolerance: "seconds" of CPU time for the span without output,
"evaluations", "events", and the "positions" at equidistant points from a run of its own, or there what is "measured"
for the error in place of positions; or a "note" why not. A peer that compiles tells the time of that on the clock,
"compilation" [s]: it counts neither as CPU time nor in the budget.
"""

import json
import sys
import time

FEWEST_RUNS = 2
MOST_RUNS = 200
ENOUGH = 0.2  # [s] Repeated until the runs have taken so long together.


def load():
    """The job and the method."""
    with open(sys.argv[1]) as file:
        return json.load(file), sys.argv[2]


def answer(job, march, what="positions", clock=time.process_time, compilation=lambda: 0.0):
    """Asks `march(tolerance, points)` at each tolerance; it returns `what` at the points, evaluations and events. `clock`
    tells the CPU time until now, `compilation` that of compiling, on the clock."""
    for tolerance in job["tolerances"]:
        line, compiled = {"tolerance": tolerance}, compilation()
        try:
            found, evaluations, events = march(tolerance, job["points"])
            least, total, runs = float("inf"), 0.0, 0
            while runs < MOST_RUNS and (runs < FEWEST_RUNS or total < ENOUGH):
                start = clock()
                march(tolerance, 1)
                spent = clock() - start
                least, total, runs = min(least, spent), total + spent, runs + 1
            flat = [float(x) for point in found for x in point]
            line.update({"seconds": least, "evaluations": int(evaluations), "events": int(events), what: flat})
        except Exception as error:  # a method that fails is a result
            line["note"] = f"gave up: {error}".replace("\n", " ")[:200]
        line["compilation"] = compilation() - compiled
        print(json.dumps(line), flush=True)
