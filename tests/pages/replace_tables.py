#!/usr/bin/env python3
"""Replaces tables of a TOML file by those of other files, as a page asks its reader to do by hand.

    python3 tests/pages/replace_tables.py SCENARIO FILE...

A table of a FILE replaces the table of that name in SCENARIO, with the tables below it, and stands at its place;
one whose name is new is added at the end. `[trajectory]` also replaces `[orbit]`.
"""

import pathlib
import re
import sys


def tables(text):
    """The parts of a file, (name of the table or "", text with its heading), in order."""
    parts = [["", ""]]
    for line in text.splitlines(keepends=True):
        heading = re.match(r"\[+([\w.]+)\]", line)
        if heading:
            parts.append([heading[1], ""])
        parts[-1][1] += line
    return parts


def main():
    scenario = pathlib.Path(sys.argv[1])
    parts = tables(scenario.read_text())
    for name in sys.argv[2:]:
        new = [part for part in tables(pathlib.Path(name).read_text()) if part[0]]
        tops = {part[0].split(".")[0] for part in new}
        whole = {part[0] for part in new if "." not in part[0]} | ({"orbit"} if "trajectory" in tops else set())
        gone = lambda part: part[0].split(".")[0] in whole or part[0] in {entry[0] for entry in new}
        parts = [part for part in parts if not gone(part)] + [[part[0], part[1].rstrip() + "\n\n"] for part in new]
    scenario.write_text("".join(text for _, text in parts))


if __name__ == "__main__":
    main()
