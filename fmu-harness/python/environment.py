"""Makes a Python environment, or finds it as it should be; prints its interpreter.

    python3 environment.py DIRECTORY REQUIREMENTS [--find]

An environment belongs to one list of packages, one Python and one place: their digest is written
into it when everything is installed. Two callers at once wait for each other. With `--find` nothing
is made: what is not there is an error.
"""

import fcntl
import hashlib
import shutil
import subprocess
import sys
from pathlib import Path

OLDEST_PYTHON = (3, 11)  # what numpy in the lists asks for


def digest(directory, requirements):
    facts = [requirements.read_text(), sys.version, str(directory)]
    return hashlib.sha256("\0".join(facts).encode()).hexdigest()


def run(step, command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{step}\n$ {' '.join(map(str, command))}\n{done.stdout}")


def make(directory, requirements):
    shutil.rmtree(directory, ignore_errors=True)
    run(
        "no virtual environment can be made; on Debian it takes the package python3-venv",
        [sys.executable, "-m", "venv", directory],
    )
    run(
        "the packages cannot be installed: is the Python package index in reach?",
        [directory / "bin" / "python", "-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
        + ["--no-deps", "--only-binary", ":all:", "--requirement", requirements],
    )


def main(directory, requirements, find):
    if sys.version_info < OLDEST_PYTHON:
        sys.exit(f"Python {sys.version.split()[0]} is too old: {'.'.join(map(str, OLDEST_PYTHON))} or newer is needed")
    directory.parent.mkdir(parents=True, exist_ok=True)
    stamp = directory / "digest"
    wanted = digest(directory, requirements)
    with open(directory.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not stamp.is_file() or stamp.read_text() != wanted:
            if find:
                sys.exit("the Python environment has not been made")
            make(directory, requirements)
            stamp.write_text(wanted)
    print(directory / "bin" / "python")


if __name__ == "__main__":
    main(Path(sys.argv[1]).absolute(), Path(sys.argv[2]).absolute(), "--find" in sys.argv[3:])
