#!/usr/bin/env python3
"""Sums the units of a `cargo build --timings` report by crate: seconds of compilation, descending, as CSV.

    cargo build --release --timings
    python3 docs/evidence/building/timings.py target/cargo-timings/cargo-timing.html >docs/evidence/building/after.csv
"""

import collections
import csv
import json
import re
import sys
from pathlib import Path


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = re.search(r"const UNIT_DATA = (\[.*?\]);", Path(sys.argv[1]).read_text(), re.DOTALL)
    if not found:
        sys.exit(f"{sys.argv[1]} has no UNIT_DATA, expected a report of cargo build --timings")
    units = json.loads(found.group(1))
    seconds: collections.Counter[str] = collections.Counter()
    counts: collections.Counter[str] = collections.Counter()
    for unit in units:
        seconds[unit["name"]] += unit["duration"]
        counts[unit["name"]] += 1
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["crate", "units", "seconds"])
    table.writerow(["all", sum(counts.values()), f"{sum(seconds.values()):.1f}"])
    for name, duration in sorted(seconds.items(), key=lambda item: (-item[1], item[0])):
        table.writerow([name, counts[name], f"{duration:.1f}"])


if __name__ == "__main__":
    main()
