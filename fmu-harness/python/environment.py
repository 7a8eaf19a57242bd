"""Makes a Python environment, or finds it as it should be; prints its interpreter.

    python3 environment.py DIRECTORY REQUIREMENTS [--find]

An environment belongs to one list of packages, one Python and one place: their digest is written
into it when everything is installed. Two callers at once wait for each other. With `--find` nothing
is made: what is not there is an error.

Packages are installed by uv, which takes seconds where pip takes half a minute. uv itself is in the
environment `uv` beside the others, installed by pip. Where uv fails, pip installs everything.
"""

import ast
import fcntl
import hashlib
import subprocess
import sys
from pathlib import Path

OLDEST_PYTHON = (3, 11)  # what numpy in the lists asks for
PINNED = ["--no-deps", "--only-binary", ":all:", "--requirement"]
UV_OPTIONS = {  # uv does not read pip's settings: where packages come from, and whom to trust
    "index-url": "--default-index",
    "extra-index-url": "--index",
    "find-links": "--find-links",
    "cert": "--cert",
    "trusted-host": "--allow-insecure-host",
}


def digest(directory, requirements):
    facts = [requirements.read_text(), sys.version, str(directory)]
    return hashlib.sha256("\0".join(facts).encode()).hexdigest()


def run(step, command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{step}\n$ {' '.join(map(str, command))}\n{done.stdout}")


def by_pip(directory, requirements):
    run(
        "no virtual environment can be made; on Debian it takes the package python3-venv",
        [sys.executable, "-m", "venv", "--clear", directory],
    )
    run(
        "the packages cannot be installed: is the Python package index in reach?",
        [directory / "bin" / "python", "-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
        + ["--no-compile", *PINNED, requirements],
    )


def by_uv(directory, requirements):
    """Returns whether uv has installed everything."""
    try:
        tools = environment(directory.parent / "uv", requirements.with_name("uv.txt"), by_pip).parent
    except SystemExit:  # there is no uv for this machine
        return False
    settings = subprocess.run([tools / "python", "-m", "pip", "config", "list"], capture_output=True, text=True)
    options = {}  # what the environment says comes first, and counts
    for name, value in (line.split("=", 1) for line in settings.stdout.splitlines() if "=" in line):
        options.setdefault(UV_OPTIONS.get(name.rsplit(".", 1)[-1]), ast.literal_eval(value).split())
    words = [word for option, places in options.items() if option for place in places for word in (option, place)]
    python = directory / "bin" / "python"
    steps = [
        [sys.executable, "-m", "venv", "--clear", "--without-pip", directory],
        [tools / "uv", "pip", "install", "--quiet", "--python", python, *words, *PINNED, requirements],
    ]
    return all(subprocess.run(step, capture_output=True).returncode == 0 for step in steps)


def by_either(directory, requirements):
    if not by_uv(directory, requirements):
        by_pip(directory, requirements)


def environment(directory, requirements, make):
    """The interpreter of an environment; `make` makes it if it is not as it should be."""
    directory.parent.mkdir(parents=True, exist_ok=True)
    stamp = directory / "digest"
    wanted = digest(directory, requirements)
    with open(directory.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not stamp.is_file() or stamp.read_text() != wanted:
            make(directory, requirements)
            stamp.write_text(wanted)
    return directory / "bin" / "python"


def refuse(directory, requirements):
    sys.exit("the Python environment has not been made")


if __name__ == "__main__":
    if sys.version_info < OLDEST_PYTHON:
        sys.exit(f"Python {sys.version.split()[0]} is too old: {'.'.join(map(str, OLDEST_PYTHON))} or newer is needed")
    directory, requirements = (Path(word).absolute() for word in sys.argv[1:3])
    print(environment(directory, requirements, refuse if "--find" in sys.argv[3:] else by_either))
