#!/usr/bin/env python3
"""Counts the lines of production code by crate: without comments, blank lines and tests.

    python3 docs/evidence/building/lines.py [DIRECTORY]

Tests are files and folders named `tests`, and the item after `#[cfg(test)]`. Research programs, examples,
benchmarks and scripts of other languages are not counted.
"""

import collections
import pathlib
import re
import sys

CRATES = ("contract", "config", "sim", "pipeline", "navigation", "oracle", "worlds", "src", "python", "fuzz")
SKIPPED = {"tests", "benches", "target", "node_modules", "examples"}


def lines(text: str) -> int:
    count = 0
    item = None  # Of a test: the indentation at which its item ends.
    for line in text.splitlines():
        stripped = line.strip()
        indent = len(line) - len(line.lstrip())
        if item is None and stripped == "#[cfg(test)]":
            item = indent
        elif item is not None:
            if stripped and indent == item and (stripped.startswith("}") or re.search(r"[;}]$", stripped)):
                item = None
        elif stripped and not stripped.startswith("//"):
            count += 1
    return count


def room(parts: tuple[str, ...]) -> str:
    """Returns the room of a file: its crate, its folder in a folder of crates, or its part of the pipelines."""
    if parts[0] in ("oracle", "worlds", "sim"):
        return "/".join(parts[:2])
    if parts[0] == "pipeline" and len(parts) > 3:
        return "/".join(parts[:3])
    return parts[0]


def main() -> None:
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    counts: collections.Counter[str] = collections.Counter()
    for crate in CRATES:
        for path in (root / crate).rglob("*.rs"):
            parts = path.relative_to(root).parts
            if SKIPPED & set(parts) or path.name == "tests.rs":
                continue
            counts[room(parts)] += lines(path.read_text())
    for name, count in sorted(counts.items()):
        print(f"{count:6} {name}")
    print(f"{sum(counts.values()):6} all")


if __name__ == "__main__":
    main()
