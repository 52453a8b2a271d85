#!/usr/bin/env python3
"""Makes the baselines of the project's own gates anew, from runs of scenarios/gates/ by the program of this
tree.

    python3 golden/baselines/make.py --reason "why the old ones no longer hold"          # all
    python3 golden/baselines/make.py argon --reason "why the old one no longer holds"    # one

Needs Python's standard library and cargo.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

NAMES = ("argon", "docking", "empty")


def boresight(*words):
    subprocess.run(["cargo", "run", "--release", "--locked", "--quiet", "--", *map(str, words)], cwd=ROOT, check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"which of {', '.join(NAMES)}; all without")
    arguments = manifest.begin(parser)
    for name in arguments.names or NAMES:
        if name not in NAMES:
            parser.error(f"there is no baseline `{name}`, expected one of {', '.join(NAMES)}")
        folder = HERE / name
        with tempfile.TemporaryDirectory() as run:
            boresight("run", f"scenarios/gates/{name}.toml", "--out", run)
            boresight("gate", "baseline", run, "--out", folder, "--reason", arguments.reason, "--replace")
        # The manifest has their hashes.
        (folder / "SHA256SUMS").unlink()
        for file in ("baseline.toml", "rows.parquet"):
            manifest.record(folder / file, arguments.reason)
    manifest.record(HERE / "make.py", arguments.reason)


if __name__ == "__main__":
    main()
