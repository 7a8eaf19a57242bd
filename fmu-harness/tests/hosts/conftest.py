"""The packaged FMUs, whose directory the Rust test hands over."""

import os
import sys
from pathlib import Path

import pytest

from mechanism import Mechanism

STATUS = pytest.StashKey[int]()

SCENES = ["allplay", "flexrod", "guideplay", "ideal", "press", "seed", "wornpin"]


def fmu(scene):
    file = Path(os.environ["SLIDERCRANK_FMUS"]) / f"{scene}.fmu"
    assert file.is_file(), f"{file} was not packaged"
    return file


def unpacked(scene):
    @pytest.fixture(scope="session", name=scene)
    def make(tmp_path_factory):
        return Mechanism(fmu(scene), tmp_path_factory.mktemp(scene))

    return make


allplay, flexrod, guideplay, ideal, press, seed, wornpin = map(unpacked, SCENES)


@pytest.fixture(params=SCENES)
def every_fmu(request):
    """Each shipped scene's file in turn."""
    return fmu(request.param)


def pytest_sessionfinish(session, exitstatus):
    session.config.stash[STATUS] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    """A process that may have loaded units of PythonFMU ends as they need it."""
    if "system" in sys.modules and STATUS in config.stash:
        config.get_terminal_writer().flush()
        sys.modules["system"].leave(config.stash[STATUS])
