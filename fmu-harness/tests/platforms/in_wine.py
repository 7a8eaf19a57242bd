"""FMPy runs the package for Linux here and the one for Windows under Wine, and gets the same bits.

    in_wine.py LINUX64.fmu WIN64.fmu
"""

import sys

from fmpy import simulate_fmu

linux, windows = sys.argv[1:]
# Few points: over FMPy's connection with Wine each may take half a second.
times = dict(stop_time=1e-3, output_interval=1e-4, output=["slider.x", "slider.v", "slider.a", "joint.C.force.x"])
own = simulate_fmu(linux, **times)
other = simulate_fmu(windows, remote_platform="win64", **times)
assert own.tobytes() == other.tobytes(), f"{own}\n{other}"
print(len(own), "points")
