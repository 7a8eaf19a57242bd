"""FMPy runs the package for Linux in this process and the package for Windows under Wine, and gets the same bits.

    in_wine.py LINUX64.fmu WIN64.fmu

FMPy starts a server under Wine that loads the library. The server ends as soon as it can open a lock file, which it tries
every half second: FMPy holds a lock on the file, so that on Windows it cannot be opened while FMPy lives. Wine ignores that
lock. A run that was not over within the server's first half second would hang. Therefore the lock file is put into a folder
whose name no Windows program can open; FMPy kills the server at the end of the run.
"""

import os
import tempfile
from pathlib import Path

folder = tempfile.TemporaryDirectory()
# Python's own temporary files, among them the unpacked FMU, stay where they are; C's `tempnam` follows the variable.
tempfile.tempdir = tempfile.gettempdir()
locks = Path(folder.name) / "?"
locks.mkdir()
os.environ["TMPDIR"] = str(locks)

import sys  # noqa: E402

from fmpy import simulate_fmu  # noqa: E402

linux, windows = sys.argv[1:]
# Long enough for several of the server's attempts to open the lock file.
times = dict(stop_time=0.1, output_interval=1e-4, output=["slider.x", "slider.v", "slider.a", "joint.C.force.x"])
own = simulate_fmu(linux, **times)
other = simulate_fmu(windows, remote_platform="win64", **times)
assert own.tobytes() == other.tobytes(), f"{own}\n{other}"
print(len(own), "points")
