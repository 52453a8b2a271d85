"""Writes generated parts of docs/evidence/speed.md and docs/evidence/speed/benchmarks.md.

A part is the text between `<!-- NAME: ... -->` and `<!-- end of NAME -->`.
"""

import pathlib
import re

FOLDER = pathlib.Path(__file__).resolve().parent
PAGES = {"rivals": FOLDER.parent / "speed.md", "benchmarks": FOLDER / "benchmarks.md"}


def replace(name, text):
    """Replaces a generated part by a text."""
    part = re.compile(rf"(<!-- {name}: [^\n]*-->\n).*?(\n<!-- end of {name} -->)", re.DOTALL)
    path = PAGES[name]
    page, count = part.subn(lambda found: f"{found[1]}\n{text.strip()}\n{found[2]}", path.read_text())
    if count != 1:
        raise SystemExit(f"{path} has {count} parts called {name}, expected one")
    path.write_text(page)


def table(head, rows, names):
    """A table in Markdown, a name before each row; columns after the first are aligned to the right."""
    lines = [head, ["---"] + ["---:"] * (len(head) - 1)] + [[name, *row] for name, row in zip(names, rows)]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def machine():
    """The processor, in words."""
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*: (.*)", cpuinfo)
    flags = re.search(r"flags\s*: (.*)", cpuinfo)
    widest = [name for name in ("avx512f", "avx2") if flags and name in flags[1].split()]
    registers = {"avx512f": "AVX-512", "avx2": "AVX2"}
    widest = registers[widest[0]] if widest else "no AVX2"
    return f"{model[1] if model else 'an unknown processor'}, {widest}, {cpuinfo.count('processor	:')} cores"
