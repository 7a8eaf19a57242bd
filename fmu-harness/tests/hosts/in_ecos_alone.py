"""Runs one FMU in ecos, in a process of its own; prints a row for each communication point.

    in_ecos_alone.py FMU STEP POINTS SIGNAL...
"""

import sys

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

file, step, points, *signals = sys.argv[1:]
EcosLib.set_log_level("err")
with EcosSimulationStructure() as structure:
    structure.add_model("unit", file)
    with EcosSimulation(structure=structure, step_size=float(step)) as simulation:
        simulation.init()
        for _ in range(int(points)):
            time = simulation.step()
            print(repr(time), *(repr(simulation.get_real(f"unit::{signal}")) for signal in signals))
        simulation.terminate()
