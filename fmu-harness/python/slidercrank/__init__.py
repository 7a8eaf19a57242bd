"""The slider-crank FMU from Python: scenes, runs, studies.

Nothing here knows mechanics. Packaging and studies are done by the program in the source tree, runs by the
packaged FMU in FMPy. `slidercrank.distributed` runs a study on a Dask cluster, `slidercrank.sensitivity` and
`slidercrank.optimise` ask what a study's parameters do, `slidercrank.durability` counts load cycles,
`slidercrank.press` measures what a press shop does, `slidercrank.placements` sorts a study by joints,
`slidercrank.kalman` estimates motion and parameters from measurements, `slidercrank.modes` makes a rod's table of modes from a solid model in CalculiX, `slidercrank.plots` draws.
"""

from .simulation import simulate
from .source import SourceError, package, scenes
from .study import Plan, plan, study
from .unit import Step, StepJacobian, Unit

__all__ = [
    "Plan",
    "SourceError",
    "Step",
    "StepJacobian",
    "Unit",
    "package",
    "plan",
    "scenes",
    "simulate",
    "study",
]
