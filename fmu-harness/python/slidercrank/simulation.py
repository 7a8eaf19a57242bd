"""One run of an FMU, as a frame."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy
import pandas
from fmpy import read_model_description, simulate_fmu


def simulate(
    fmu: str | Path,
    stop: float | None = None,
    step: float | None = None,
    settings: Mapping[str, float | int | bool | str] | None = None,
    inputs: pandas.DataFrame | None = None,
    outputs: Iterable[str] | None = None,
) -> pandas.DataFrame:
    """Runs an FMU in FMPy; outputs in columns, `time` [s] the index.

    `stop` and `step` [s] are the FMU's own unless they are given. `settings` are start values by name, `inputs` a frame
    whose index is time [s] and whose columns are inputs, straight between its rows. Without `outputs` all numbers that
    the FMU gives are kept.
    """
    description = read_model_description(str(fmu))
    known = {variable.name: variable for variable in description.modelVariables}
    if outputs is None:
        numbers = (v for v in description.modelVariables if v.causality == "output" and v.type != "String")
        outputs = [variable.name for variable in numbers]
    outputs = list(outputs)
    for name in [*outputs, *(settings or {}), *(inputs.columns if inputs is not None else [])]:
        if name not in known:
            raise KeyError(f"{Path(fmu).name} has no variable `{name}`")
    result = simulate_fmu(
        str(fmu),
        fmi_type="CoSimulation",
        stop_time=stop,
        output_interval=step,
        start_values=dict(settings or {}),
        input=None if inputs is None else signals(inputs),
        output=outputs,
    )
    columns = {name: result[name] for name in outputs}
    return pandas.DataFrame(columns, index=pandas.Index(result["time"], name="time"))


def signals(inputs: pandas.DataFrame) -> numpy.ndarray:
    """Inputs as FMPy takes them."""
    kinds = [("time", float), *((name, float) for name in inputs.columns)]
    rows = zip(inputs.index, *(inputs[name] for name in inputs.columns))
    return numpy.array([tuple(map(float, row)) for row in rows], dtype=kinds)
