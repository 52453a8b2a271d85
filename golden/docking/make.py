"""Makes golden/docking/*.exr: docking scenes rendered by Mitsuba.

This project's exporter (sim/render/src/mitsuba), which the suite mitsuba_live compares with closed forms, writes the
scenes for Mitsuba; Mitsuba alone computes the radiance. Needs cargo, and Mitsuba 3.9.1 on the PATH or in
BORESIGHT_MITSUBA. Takes some ten minutes of four cores.

    python3 -m venv .venv && .venv/bin/pip install -r golden/docking/requirements.txt
    PATH=$PWD/.venv/bin:$PATH python3 golden/docking/make.py --reason "why the old ones are wrong"

A changed built-in target is copied with `cp scenarios/targets/progress.toml golden/docking/target.toml`.
"""

import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402


def main():
    reason = manifest.begin().reason
    subprocess.run(
        ["cargo", "run", "--quiet", "-p", "boresight-research", "--bin", "golden_docking", "--", str(HERE)], cwd=HERE.parent.parent, check=True
    )
    for path in [*sorted(HERE.glob("*.exr")), HERE / "cases.toml", HERE / "target.toml"]:
        manifest.record(path, reason)


if __name__ == "__main__":
    main()
