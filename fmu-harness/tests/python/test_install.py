"""pip installs the package, and it works from where it was installed."""

import os
import shutil
import subprocess
import sys

from slidercrank.source import home


def test_what_pip_installs_is_the_whole_package(tmp_path):
    sources, into = home() / "fmu-harness/python", tmp_path / "site"
    # setuptools builds beside the sources.
    shutil.copytree(sources, tmp_path / "python", ignore=shutil.ignore_patterns("__pycache__"))
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    subprocess.run([*pip, "--target", into, tmp_path / "python"], check=True)
    modules = lambda folder: sorted(file.name for file in folder.iterdir() if file.suffix in (".py", ".typed"))
    assert modules(into / "slidercrank") == modules(sources / "slidercrank")
    assert "py.typed" in modules(into / "slidercrank")
    told = "import slidercrank, sys; print(slidercrank.__file__); print(len(slidercrank.scenes()))"
    done = subprocess.run([sys.executable, "-c", told], env={**os.environ, "PYTHONPATH": str(into)}, capture_output=True, text=True)
    file, scenes = done.stdout.split()
    assert file.startswith(str(into)) and int(scenes) > 8
