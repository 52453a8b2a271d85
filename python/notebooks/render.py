#!/usr/bin/env python3
"""Runs the notebooks and writes their texts and outputs as pages of the book, docs/notebooks/NAME.md.

    python3 python/notebooks/render.py

needs the package with the extra `test`. Outputs are texts and PNG files; the last cell of a notebook, which
compares its text with its numbers, is left out.
"""

import base64
import io
import pathlib
import re
import textwrap

import nbformat
from nbclient import NotebookClient
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
PAGES = HERE.parents[1] / "docs" / "notebooks"
WIDTH = 110
COLOURS = 64
"""Colours of a picture: enough for a chart, and a fifth of the bytes."""


def wrapped(text):
    """Markdown with paragraphs and items of lists at the width of the pages."""
    lines = []
    for line in text.splitlines():
        indent = "  " if line.startswith("- ") else "   " if line[:3].rstrip(" ").rstrip(".").isdigit() else ""
        lines += textwrap.wrap(line, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False) or [""]
    return "\n".join(lines)


def picture(data, path):
    """Writes a PNG of an output with few colours."""
    image = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")
    image.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def without_paths(text):
    """A text with the temporary file of a cell replaced by `cell.py`."""
    return re.sub(r"/\S*ipykernel_\S+?\.py", "cell.py", text)


def outputs(cell, name, pictures):
    """The outputs of a cell as Markdown; appends the names of its pictures."""
    texts = []
    for output in cell.outputs:
        data = output.get("data", {})
        if output.output_type == "error":
            raise SystemExit(f"{name}: {output.evalue}")
        if "image/png" in data:
            pictures.append(f"{name}-{len(pictures) + 1}.png")
            picture(data["image/png"], PAGES / pictures[-1])
            texts.append(f"![Chart {len(pictures)} of the notebook]({pictures[-1]})\n")
        elif output.get("name") != "stderr":
            text = without_paths(output.get("text") or data.get("text/plain", ""))
            texts.append(f"```text\n{text.rstrip()}\n```\n")
    return "\n".join(texts)


def page(path):
    """The page of a notebook, with a link to the notebook at its end."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=600, kernel_name="python3", coalesce_streams=True).execute()
    parts, pictures = [], []
    for cell in notebook.cells[:-1]:
        if cell.cell_type == "markdown":
            parts.append(wrapped(cell.source) + "\n")
        else:
            parts.append(outputs(cell, path.stem, pictures))
    link = f"../../python/notebooks/{path.name}"
    parts.append(f"*The code is in the [notebook]({link}).*\n")
    return "\n".join(part for part in parts if part)


def main():
    PAGES.mkdir(exist_ok=True)
    for path in sorted(HERE.glob("*.ipynb")):
        (PAGES / f"{path.stem}.md").write_text(page(path))
        print(f"docs/notebooks/{path.stem}.md")


if __name__ == "__main__":
    main()
