"""Runs an SSP package in ecos, in a process of its own; prints a row for each communication point.

    in_ecos.py PACKAGE STEP POINTS SIGNAL...
"""

import sys

from ecospy import EcosLib, EcosSimulation

from system import leave

package, step, points, *signals = sys.argv[1:]
names = [signal.replace(".", "::", 1) for signal in signals]
EcosLib.set_log_level("warn")
with EcosSimulation(step_size=float(step), ssp_path=package) as simulation:
    simulation.init(parameter_set="servo")
    for _ in range(int(points)):
        time = simulation.step()
        print(time, *map(simulation.get_real, names))
    simulation.terminate()
leave(0)
