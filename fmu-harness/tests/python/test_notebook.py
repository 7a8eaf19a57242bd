"""The notebook runs from its first to its last cell and draws."""

import nbformat
from nbclient import NotebookClient

from slidercrank.source import home


def test_every_cell_runs_and_four_figures_are_drawn(tmp_path, monkeypatch):
    monkeypatch.delenv("MPLBACKEND", raising=False)
    notebook = nbformat.read(home() / "fmu-harness/python/example.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)
    nbformat.validate(notebook)
    # Limits that only end what hangs; a figure that comes late would be dropped without a word.
    limits = {"startup_timeout": 600, "timeout": 600, "iopub_timeout": 600}
    NotebookClient(notebook, **limits, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 4
