"""The notebooks run; their last cell compares the numbers in their text with the results. The pages of the book
made from them (python/notebooks/render.py) have their texts and outputs."""

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))


def texts(cell):
    """Texts of a cell that its page shows: the words of Markdown, or the outputs."""
    if cell.cell_type == "markdown":
        return [cell.source]
    shown = [output for output in cell.outputs if output.get("name") != "stderr" and "image/png" not in output.get("data", {})]
    found = [output.get("text") or output["data"]["text/plain"] for output in shown]
    # The temporary file of a cell has another name in each kernel.
    return [re.sub(r"/\S*ipykernel_\S+?\.py", "cell.py", text) for text in found]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_to_its_end(path):
    notebook = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "outputs are not committed"
    NotebookClient(notebook, timeout=600, kernel_name="python3", coalesce_streams=True).execute()
    last = notebook.cells[-1].source
    assert "assert" in last and "held against the numbers" in last
    page = (ROOT / "docs" / "notebooks" / f"{path.stem}.md").read_text().split()
    lacking = [text for cell in notebook.cells[:-1] for text in texts(cell) if not is_in(text.split(), page)]
    assert not lacking, "python3 python/notebooks/render.py writes the page anew"


def is_in(words, page):
    """Returns true if the page has the words in a row."""
    return any(page[at : at + len(words)] == words for at in range(len(page) - len(words) + 1))
