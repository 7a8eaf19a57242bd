"""The journal's file: cut anywhere, it loses one line at most, and another study's is left alone."""

import json

import pytest

from slidercrank import SourceError, plan, study
from slidercrank.journal import Journal, JournalError, Outcome, path

from conftest import WORN_PIN, bits

OUTCOMES = [Outcome((0.1 + 0.2,)), Outcome(failed="µ \"quoted\"\nin two lines"), Outcome((1e-300,)), Outcome((-7.0,))]


def test_what_was_cut_off_is_run_again_and_nothing_else(tmp_path):
    file = path(tmp_path, "own")
    with Journal(file, "digest") as journal:
        for run, outcome in enumerate(OUTCOMES):
            journal.add(run, outcome)
    whole = file.read_bytes()
    for cut in range(len(whole) + 1):
        file.write_bytes(whole[:cut])
        with Journal(file, "digest") as journal:
            lines = max(whole[:cut].count(b"\n") - 1, 0)
            assert list(journal.open_runs(4)) == list(range(lines, 4))
            for run in range(lines, 4):
                journal.add(run, OUTCOMES[run])
        assert file.read_bytes() == whole
    with Journal(file, "digest") as journal:
        assert journal.outcomes == dict(enumerate(OUTCOMES))


def test_two_programs_are_not_at_work_on_one_study(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(WORN_PIN)
    with Journal(path(tmp_path, "own"), plan(file).recipe.digest) as journal:
        journal.add(0, OUTCOMES[0])
        with pytest.raises(JournalError, match="another program is at work"):
            Journal(path(tmp_path, "own"), "digest")
        with pytest.raises(SourceError, match="another program is at work"):
            study(file, output=tmp_path)
    assert path(tmp_path, "own").read_bytes().count(b"\n") == 2


def test_another_study_s_journal_is_left_alone(tmp_path):
    file = path(tmp_path, "own")
    with Journal(file, "one") as journal:
        journal.add(0, OUTCOMES[0])
    before = file.read_bytes()
    with pytest.raises(JournalError, match="another study"):
        Journal(file, "another")
    for damaged in (b"{}", b'{"run":1}', b'{"run":1.5,"values":[1.0]}', b'{"run":1,"values":["one"]}', b"[1]"):
        file.write_bytes(before + damaged + b"\n")
        with pytest.raises(JournalError, match="line 3 is damaged"):
            Journal(file, "one")


@pytest.mark.parametrize(("run", "values"), [(4, (1.0,)), (-1, (1.0,)), (1, ()), (1, (1.0, 2.0))])
def test_lines_that_are_none_of_the_study_s_are_refused(tmp_path, run, values):
    with Journal(path(tmp_path, "own"), "digest") as journal:
        journal.add(0, OUTCOMES[0])
        journal.add(1, OUTCOMES[1])
        journal.check(4, 1)
        journal.add(run, Outcome(values))
        with pytest.raises(JournalError, match=f"damaged in the line of run {run}: the study has 4 runs"):
            journal.check(4, 1)


def test_sweep_believes_the_lines_that_are_written_here_and_runs_the_others(write, tmp_path):
    file = write(WORN_PIN)
    whole = study(file, output=tmp_path / "whole")
    planned = plan(file)
    (tmp_path / "half").mkdir()
    told = [0.1 + 0.2, 1e-300, -7.0, 12345.678]
    with Journal(path(tmp_path / "half", "own"), planned.recipe.digest) as journal:
        journal.add(5, Outcome(tuple(told)))
        journal.add(7, Outcome(failed="so it was told"))
    half = study(file, output=tmp_path / "half")
    assert half.loc[5, list(planned.recipe.keep)].tolist() == told
    assert half.loc[7, "status"] == "so it was told"
    assert bits(half.drop([5, 7])) == bits(whole.drop([5, 7]))


def test_sweep_refuses_the_journal_of_another_study_too(write, tmp_path):
    with Journal(path(tmp_path, "own"), "digest"):
        pass
    with pytest.raises(SourceError, match="another study"):
        study(write(WORN_PIN), output=tmp_path)
    assert json.loads(path(tmp_path, "own").read_text()) == {"digest": "digest"}
