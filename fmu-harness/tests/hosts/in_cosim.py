"""Runs an FMU in libcosim, in a process of its own; prints a row of values for each communication point.

    in_cosim.py FMU STEP_IN_NANOSECONDS POINTS REFERENCE...

A reference is a letter for the type and a value reference: r3, i7, b9.
"""

import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

file, step, points, *references = sys.argv[1:]
execution = CosimExecution.from_step_size(step_size=int(step))
slave = execution.add_local_slave(local_slave=CosimLocalSlave(fmu_path=file, instance_name="mechanism"))
observer = CosimObserver.create_last_value()
execution.add_observer(observer=observer)
readers = {"r": observer.last_real_values, "i": observer.last_integer_values, "b": observer.last_boolean_values}


def value(reference):
    (found,) = readers[reference[0]](slave_index=slave, variable_references=[int(reference[1:])])
    return repr(float(found))


for _ in range(int(points)):
    assert execution.step(step_count=1), "libcosim does not step"
    print(*map(value, references))
