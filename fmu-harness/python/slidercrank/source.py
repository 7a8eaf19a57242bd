"""The source tree and the program in it."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

HOME = "SLIDERCRANK_HOME"
"""Environment variable that names the source tree."""
PROGRAM = "SLIDERCRANK_PROGRAM"
"""Environment variable that names a built `fmu-harness` to call in place of `cargo run --release`."""


class SourceError(RuntimeError):
    """The source tree is not there, or its program refused; the text says why."""


def home() -> Path:
    """The source tree: what `SLIDERCRANK_HOME` names, or the nearest one from the working directory upwards."""
    named = os.environ.get(HOME)
    places = [Path(named)] if named else [Path.cwd(), *Path.cwd().parents]
    for place in places:
        if (place / "fmu-harness" / "Cargo.toml").is_file():
            return place.absolute()
    looked = f"{HOME}={named}" if named else f"{Path.cwd()} and above; {HOME} may name one"
    raise SourceError(f"no source tree of SliderCrank: looked in {looked}")


def call(*arguments: str | Path) -> str:
    """What the program prints; a `SourceError` with what it complains of."""
    program = os.environ.get(PROGRAM)
    command = [program] if program else ["cargo", "run", "--release", "--quiet", "--package", "fmu-harness", "--"]
    words = [*command, *map(str, arguments)]
    # cargo looks for its workspace here; paths among the arguments are absolute.
    try:
        done = subprocess.run(words, cwd=home(), capture_output=True, text=True)
    except OSError as error:
        raise SourceError(f"{words[0]} cannot be started: {error}") from error
    if done.returncode != 0:
        raise SourceError(done.stderr.strip() or f"{words[0]} ended with {done.returncode}")
    return done.stdout


def output_directory(directory: str | Path | None) -> Path:
    """`directory`, or the program's own `target/out`; made if it is not there."""
    found = home() / "target" / "out" if directory is None else Path(directory).absolute()
    found.mkdir(parents=True, exist_ok=True)
    return found


def scenes() -> list[str]:
    """Names of the shipped scenes; those in folders as `folder/name`."""
    root = home() / "fmu-harness" / "scenes"
    names = lambda folder: sorted(file.stem for file in folder.glob("*.toml"))
    return names(root) + [f"{folder}/{name}" for folder in ("effects", "peers") for name in names(root / folder)]


def scene_argument(scene: str | Path) -> str:
    """A scene as the program takes it from its own working directory: a shipped one's name, or a file's whole path."""
    return str(Path(scene).absolute()) if str(scene).endswith(".toml") else str(scene)


def package(scene: str | Path, output: str | Path | None = None) -> Path:
    """Packages a scene, a shipped one's name or a `.toml` file, as an FMU and returns the file.

    Without `output` it is `target/out/NAME.fmu` in the source tree.
    """
    named = scene_argument(scene)
    file = Path(output).absolute() if output else output_directory(None) / f"{Path(named).stem}.fmu"
    call("package", "--scene", named, "--output", file)
    return file
