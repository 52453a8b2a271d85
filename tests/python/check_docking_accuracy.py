#!/usr/bin/env python3
"""Asserts that the pose is measured better than by OpenCV, from the table of examples/docking_accuracy on standard input.

    cargo run --release --example docking_accuracy -- OUT --poses 10 --python PYTHON | python3 tests/python/check_docking_accuracy.py

In every row: nine poses of ten are answered, and the root mean squares of the errors of range and place are smaller than OpenCV's on
the same frames. With ten poses a row that is a check of the chain; the figures are those of 200.
"""

import sys

FIGURES = slice(3, 5)  # root mean squares of range and place, after row, method and answered


def main():
    rows = {}
    for line in sys.stdin:
        print(line, end="")
        words = line.split()
        if len(words) in (9, 10) and words[1] in ("best", "OpenCV"):
            answered, asked = map(int, words[2].split("/"))
            rows.setdefault(words[0], {})[words[1]] = (answered / asked, words[FIGURES])
    if not rows:
        sys.exit("no row in the table")
    for name, methods in rows.items():
        (share, best), (_, opencv) = methods["best"], methods["OpenCV"]
        if share < 0.9:
            sys.exit(f"{name}: {share:.0%} of the poses are answered, expected 90 %")
        for what, ours, theirs in zip(("range, %", "place, mm"), best, opencv):
            # Where OpenCV gives no result there is nothing to be better than.
            if theirs != "-" and not float(ours) < float(theirs):
                sys.exit(f"{name}: error of {what}: {ours}, expected below OpenCV's {theirs}")


main()
