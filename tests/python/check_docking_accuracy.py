#!/usr/bin/env python3
"""Asserts that the pose is more accurate than OpenCV's, from the table of docking_accuracy on standard input.

    cargo run --release -p boresight-research --bin docking_accuracy -- OUT --poses 10 --python PYTHON | python3 tests/python/check_docking_accuracy.py

In every row: nine poses of ten are answered, the root mean squares of the errors of range, position and
angles are smaller than OpenCV's on the same frames, and within 2.5 times the Cramer-Rao bound (2 is the goal
for 200 poses; a root mean square of ten has an uncertainty of a quarter).
"""

import sys

WHAT = ("range, %", "place, mm", "angles, degrees")
FIGURES = slice(3, 6)  # their root mean squares, after row, method and answered
OVER_BOUND = slice(2, 5)  # in the line best/3, which has no number of answers
MAX_OVER_BOUND = 2.5


def main():
    rows = {}
    for line in sys.stdin:
        print(line, end="")
        words = line.split()
        if len(words) in (9, 10) and words[1] in ("best", "OpenCV"):
            answered, asked = map(int, words[2].split("/"))
            rows.setdefault(words[0], {})[words[1]] = (answered / asked, words[FIGURES])
        elif len(words) == 5 and words[1] == "best/3":
            rows.setdefault(words[0], {})[words[1]] = words[OVER_BOUND]
    if not rows:
        sys.exit("no row in the table")
    for name, methods in rows.items():
        (share, best), (_, opencv) = methods["best"], methods["OpenCV"]
        if share < 0.9:
            sys.exit(f"{name}: {share:.0%} of the poses are answered, expected 90 %")
        for what, ours, theirs in zip(WHAT, best, opencv):
            # Rows without a result of OpenCV have nothing to compare with.
            if theirs != "-" and not float(ours) < float(theirs):
                sys.exit(f"{name}: error of {what}: {ours}, expected below OpenCV's {theirs}")
        for what, over in zip(WHAT, methods["best/3"]):
            if not float(over) < MAX_OVER_BOUND:
                sys.exit(f"{name}: error of {what}: {over} times the bound, expected below {MAX_OVER_BOUND}")


main()
