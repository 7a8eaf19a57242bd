"""One run of an FMU, as a frame."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy
import pandas
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from .calls import kinds_of
from .quantity import plain
from .recipe import RunError
from .setting import Value, value_of

ROUNDING = 1e-6
"""Share of a step by which rows of inputs may be off a communication point."""


def simulate(
    fmu: str | Path,
    stop: float | None = None,
    step: float | None = None,
    settings: Mapping[str, Value] | None = None,
    inputs: pandas.DataFrame | None = None,
    outputs: str | Iterable[str] | None = None,
) -> pandas.DataFrame:
    """Runs an FMU in FMPy; outputs in columns, `time` [s] the index.

    `stop` and `step` [s] are the FMU's own unless they are given. `settings` are start values by name; an item of an
    enumeration is given by its number or its name. `inputs` is a frame whose index is time [s], in order, and whose columns
    are inputs, straight between its rows: steps of any length find the same. An FMU of FMI 3.0 has no slopes of inputs, and
    each step holds its first values until it ends or a row comes. Two rows of one time are a jump. Without `outputs`, a name
    or several, all numbers that the FMU gives are kept. What the FMU refuses is a `RunError` in its own words.
    """
    description = read_model_description(str(fmu))
    known = {variable.name: variable for variable in description.modelVariables}
    if outputs is None:
        kinds = kinds_of(description)
        numbers = (v for v in description.modelVariables if v.causality == "output" and v.type in kinds)
        outputs = [variable.name for variable in numbers]
    outputs = [outputs] if isinstance(outputs, str) else list(outputs)
    for name in [*outputs, *(settings or {}), *(inputs.columns if inputs is not None else [])]:
        if name not in known:
            raise KeyError(f"{Path(fmu).name} has no variable `{name}`")
    starts = {name: value_of(known[name], value) for name, value in (settings or {}).items()}
    if inputs is not None:
        check(inputs, starts)
        for name in inputs.columns:
            if known[name].causality != "input":
                raise ValueError(f"inputs: `{name}` is no input")
    if step is None and description.defaultExperiment and description.defaultExperiment.stepSize:
        # FMPy takes longer steps else, to keep a thousand rows.
        step = float(description.defaultExperiment.stepSize)
    with TemporaryDirectory(prefix="fmu-", ignore_cleanup_errors=True) as folder:
        said: list[str] = []
        hear = lambda *told: said.append(told[-1].decode(errors="replace"))
        try:
            instance = instantiate_fmu(extract(str(fmu), folder), description, "CoSimulation", logger=hear)
        except Exception as error:
            raise RunError("\n".join(said) or str(error)) from error
        if inputs is not None:
            instance.doStep = Signals(instance, inputs, [known[name].valueReference for name in inputs.columns]).step
            starts |= dict(zip(inputs.columns, inputs.to_numpy(float)[0]))
        try:
            result = simulate_fmu(
                folder,
                fmi_type="CoSimulation",
                stop_time=stop,
                output_interval=step,
                start_values=starts,
                output=outputs,
                model_description=description,
                fmu_instance=instance,
            )
        except Exception as error:
            raise RunError("\n".join(said) or str(error)) from error
        finally:
            instance.freeInstance()
    for warning in said:
        print(warning)
    columns = {name: result[name] for name in outputs}
    return pandas.DataFrame(columns, index=pandas.Index(result["time"], name="time"))


def check(inputs: pandas.DataFrame, settings: Container[str]) -> None:
    """A `ValueError` unless the columns are numbers over time, each told once."""
    if not len(inputs):
        raise ValueError("inputs: there are no rows")
    if inputs.index.dtype.kind not in "iuf":
        raise ValueError(f"inputs: the index is {inputs.index.dtype}, but must be numbers, the time in seconds")
    for place, name in enumerate(inputs.columns):
        if name in inputs.columns[:place]:
            raise ValueError(f"inputs: two columns have the name `{name}`")
        if name in settings:
            raise ValueError(f"`{name}` is among the settings and the inputs")
    times = inputs.index.to_numpy(float)
    table = numpy.column_stack([times, inputs.to_numpy(float)])
    for row, column in numpy.argwhere(~numpy.isfinite(table)):
        name = ["time", *inputs.columns][column]
        raise ValueError(f"inputs, row {row + 1}, column `{name}`: `{table[row, column]}` is not a finite number")
    for row in numpy.flatnonzero(numpy.diff(times) < 0.0) + 1:
        raise ValueError(f"inputs, row {row + 1}: time {plain(times[row])} s does not increase")


class Signals:
    """Inputs that are straight between the rows of a frame over time, and constant before and after them."""

    def __init__(self, instance: FMU2Slave | FMU3Slave, inputs: pandas.DataFrame, references: list[int]):
        self.instance, self.do_step, self.references = instance, instance.doStep, references
        self.times, self.table = inputs.index.to_numpy(float), inputs.to_numpy(float)

    def step(self, currentCommunicationPoint: float, communicationStepSize: float) -> object:
        """In place of the instance's `doStep`, as FMPy calls it; a step begins anew at every row."""
        told = None
        for begin, end in self.pieces(currentCommunicationPoint, communicationStepSize):
            values, slopes = self.line(begin, end)
            if isinstance(self.instance, FMU3Slave):
                self.instance.setFloat64(self.references, values)
            else:
                self.instance.setReal(self.references, values)
                self.instance.setRealInputDerivatives(self.references, [1] * len(slopes), slopes)
            told = self.do_step(begin, end - begin)
        return told

    def pieces(self, begin: float, size: float) -> Iterable[tuple[float, float]]:
        """A step without rows in it. A row that is off its communication point by rounding is there."""
        inside = (self.times - begin > ROUNDING * size) & (begin + size - self.times > ROUNDING * size)
        return pairwise([begin, *numpy.unique(self.times[inside]), begin + size])

    def line(self, begin: float, end: float) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Values at the beginning, and slopes from there to the end."""
        after = int(numpy.searchsorted(self.times, (begin + end) / 2.0))
        if not 0 < after < len(self.times):
            row = self.table[min(after, len(self.times) - 1)]
            return row, numpy.zeros_like(row)
        before = after - 1
        slopes = (self.table[after] - self.table[before]) / (self.times[after] - self.times[before])
        return self.table[before] + slopes * (begin - self.times[before]), slopes
