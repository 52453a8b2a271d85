#!/usr/bin/env python3
"""Coverage of the intervals of `correct_rate` on cases of both worlds.

    research/interval_coverage/run.py --boresight target/release/boresight --out DIR

Runs the studies beside this file (a population of 240 cases of 20 or 25 frames each), writes the counts of
each case to DIR/NAME.csv, and draws studies of 12, 20, 40 and 100 draws from each with replacement, by the
example `interval_coverage` of boresight-statistics; docs/evidence/studies.md has the table. Needs pyarrow.
"""

import argparse
import pathlib
import subprocess

import pyarrow.parquet

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# The figure of each world that counts right answers.
RATES = ("correct_rate", "measured_rate")


def counts(directory, rate=None):
    """The first of the rates that some case counts: its name, and (count, of) of each case."""
    table = pyarrow.parquet.read_table(directory / "cases.parquet").to_pydict()
    for name in [rate] if rate else RATES:
        if f"{name}.count" in table:
            cases = zip(table[f"{name}.count"], table[f"{name}.of"])
            return name, [(count, of) for count, of in cases if of]
    raise SystemExit(f"{directory}: none of the columns {RATES} in {sorted(table)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--boresight", type=pathlib.Path, default=ROOT / "target/release/boresight")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    files = []
    for study in sorted(HERE.glob("*.toml")):
        directory = options.out / study.stem
        subprocess.run([options.boresight, "study", "run", study, "--out", directory, "--no-report"], check=True)
        name, cases = counts(directory)
        file = options.out / f"{study.stem}.csv"
        file.write_text("count,of\n" + "".join(f"{count},{of}\n" for count, of in cases))
        print(f"{study.stem}: {name} over {len(cases)} cases", flush=True)
        files.append(file.resolve())
    example = ["cargo", "run", "--release", "-p", "boresight-statistics", "--example", "interval_coverage", "--"]
    subprocess.run([*example, *files], cwd=ROOT, check=True)


if __name__ == "__main__":
    main()
