#!/usr/bin/env python3
"""Writes scenarios/argon-numerical.toml: `argon` with numerically integrated orbits and a plan of their own.

    cargo run --release -p boresight-sim --example argon_numerical_plan | python3 scenarios/make_argon_numerical.py

The orbit and the trajectory are those of the plan on standard input; everything else is that of scenarios/argon.toml.
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
HEAD = """# ARGON with numerically integrated orbits: gravity to degree and order 36, Sun, Moon, drag, radiation
# pressure; finite burns with errors of execution and late, inexact reports.
#
# Written by scenarios/make_argon_numerical.py. Orbit, manoeuvres and forces are assumed, not ARGON's own:
# sim/examples/argon_numerical_plan.rs. All other tables are those of scenarios/argon.toml, whose comments
# state their origin; they were fitted to Table 2 with the orbits of `argon`, not with these.
"""


def main():
    argon = (HERE / "argon.toml").read_text()
    before, rest = argon.split("# Written by scenarios/argon_plan.py", 1)
    after = rest[rest.index("# Counts from the paper; hours and cadence assumed."):]
    # The head of argon.toml ends with its first key.
    before = before[before.index("title = "):]
    before = re.sub(r'^title = .*$', 'title = "ARGON with numerical orbits: 23-27 April 2012, from 30 km to 3 km"', before, count=1, flags=re.M)
    plan = sys.stdin.read().strip()
    (HERE / "argon-numerical.toml").write_text(f"{HEAD}{before}{plan}\n\n{after}")


if __name__ == "__main__":
    main()
