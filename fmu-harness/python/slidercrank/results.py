"""Results of a study as the Parquet file that `sweep` writes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas
import pyarrow
import pyarrow.parquet

from .journal import Outcome, values_of
from .study import Plan


def table(plan: Plan, outcomes: Mapping[int, Outcome]) -> pyarrow.Table:
    """All runs, in their order, with what came of them."""
    count, keep = len(plan.runs), plan.recipe.keep
    lacking = count - sum(run in outcomes for run in range(count))
    if lacking:
        raise ValueError(f"only {count - lacking} of {count} runs are finished")
    columns = [("run", pyarrow.array(range(count), pyarrow.int64()))]
    columns += [(name, pyarrow.array(plan.runs[name].to_numpy(), pyarrow.float64())) for name in plan.runs.columns]
    rows = [values_of(outcomes[run], len(keep)) for run in range(count)]
    for place, name in enumerate(keep):
        columns.append((name, pyarrow.array([row[place] for row in rows], pyarrow.float64())))
    status = ["ok" if outcomes[run].failed is None else outcomes[run].failed for run in range(count)]
    columns.append(("status", pyarrow.array(status, pyarrow.string())))
    fields = [pyarrow.field(name, column.type, nullable=False) for name, column in columns]
    schema = pyarrow.schema(fields, metadata=plan.recipe.origin)
    return pyarrow.Table.from_arrays([column for _, column in columns], schema=schema)


def save(results: pyarrow.Table, file: Path) -> None:
    """Writes the file: whole, or not at all."""
    # Only the directory is private: a temporary file would be, too, and the results with it.
    with TemporaryDirectory(dir=file.parent) as folder:
        whole = Path(folder) / file.name
        writer = pyarrow.parquet.ParquetWriter(whole, results.schema, compression="snappy", store_schema=False)
        with writer:
            writer.write_table(results)
            writer.add_key_value_metadata(results.schema.metadata)
        os.replace(whole, file)


def load(file: Path) -> pandas.DataFrame:
    """The table with a run a row; `attrs` tell what it was made from."""
    read = pyarrow.parquet.ParquetFile(file)
    frame = read.read().to_pandas().set_index("run")
    told = read.metadata.metadata or {}
    frame.attrs = {key.decode(): text.decode() for key, text in told.items() if not key.startswith(b"ARROW:")}
    return frame
