"""Goes on from serialized bytes in a process that has seen nothing else; prints the pictures.

go_on.py FMU STATE STEP BEFORE AFTER
"""

import sys
from pathlib import Path

from mechanism import Mechanism, grid

file, state, step, before, after = sys.argv[1:]
slave = Mechanism(file).instantiate("elsewhere")
slave.fmu.setFMUstate(slave.fmu.deSerializeFMUstate(Path(state).read_bytes()))
points = grid(0.0, float(step), int(before) + int(after))
for picture in slave.run(points[int(before):]):
    print(picture.hex())
slave.free()
