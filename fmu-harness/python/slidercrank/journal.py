"""Finished runs, a line each, in the file that `sweep` keeps: either goes on where the other was stopped."""

from __future__ import annotations

import json
import math
import operator
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

if sys.platform != "win32":
    import fcntl


class JournalError(RuntimeError):
    """Why a journal cannot be used."""


@dataclass(frozen=True)
class Outcome:
    """What came of a run: its quantities, or why it has none."""

    values: tuple[float, ...] | None = None
    failed: str | None = None
    stopped: bool = False
    """Whether its budget ended it: the file has no such line, so that another journal of the study runs it again."""

    @classmethod
    def of(cls, line: dict[str, Any]) -> Outcome:
        """The outcome in a line of the file, which has either quantities or why there are none."""
        return cls(failed=str(line["failed"])) if "failed" in line else cls(tuple(map(float, line["values"])))

    def told(self) -> dict[str, object]:
        return {"failed": self.failed} if self.values is None else {"values": list(self.values)}


def path(directory: Path, study: str) -> Path:
    """Where the journal of a study is."""
    return directory / f"sweep-{study}.jsonl"


class Journal:
    """The runs of one study that are finished. A line that was cut off is dropped when it is opened.

    While it is open no other program can open it, `sweep` or Python; on Windows only `sweep` sees to that.
    """

    def __init__(self, file: Path, digest: str):
        self.outcomes: dict[int, Outcome] = {}
        self._file = os.open(file, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o644)
        try:
            self._begin(file, digest)
        except BaseException:
            os.close(self._file)
            raise

    def _begin(self, file: Path, digest: str) -> None:
        if sys.platform != "win32":
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise JournalError(f"another program is at work on the study of {file}") from error
            except OSError:
                pass  # a file system without locks
        text = file.read_bytes()
        whole = text[: text.rfind(b"\n") + 1]
        for number, row in enumerate(whole.splitlines(), 1):
            try:
                line = json.loads(row)
                if number == 1:
                    known = line.get("digest")
                else:
                    self.outcomes[operator.index(line["run"])] = Outcome.of(line)
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                if number > 1:
                    raise JournalError(f"{file}, line {number} is damaged") from error
                known = None
            if number == 1 and known != digest:
                raise JournalError(f"{file} belongs to another study: choose another directory, or remove the file")
        os.ftruncate(self._file, len(whole))
        if not whole:
            self._write({"digest": digest})

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        os.close(self._file)

    def __len__(self) -> int:
        return len(self.outcomes)

    def check(self, runs: int, kept: int) -> None:
        """Refuses lines that are none of a study with so many runs, which keeps so many quantities."""
        for run, outcome in self.outcomes.items():
            fits = outcome.values is None or len(outcome.values) == kept
            if not fits or not 0 <= run < runs:
                study = f"the study has {runs} runs, from 0 on, with {kept} values each"
                raise JournalError(f"the journal is damaged in the line of run {run}: {study}")

    def open_runs(self, count: int) -> Iterator[int]:
        """Numbers below `count` that are not finished."""
        return (run for run in range(count) if run not in self.outcomes)

    def add(self, run: int, outcome: Outcome) -> None:
        """Adds a run, in one write; one that was stopped is not written."""
        if not outcome.stopped:
            self._write({"run": run, **outcome.told()})
        self.outcomes[run] = outcome

    def _write(self, line: dict[str, object]) -> None:
        text = json.dumps(line, separators=(",", ":"), ensure_ascii=False, allow_nan=False) + "\n"
        data = text.encode()
        if os.write(self._file, data) != len(data):
            raise JournalError("cannot write the journal: no space is left")


def values_of(outcome: Outcome, count: int) -> tuple[float, ...]:
    """The quantities of a run; not numbers if it failed."""
    return outcome.values if outcome.values is not None else (math.nan,) * count
