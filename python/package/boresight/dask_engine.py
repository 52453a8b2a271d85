"""The shards of a study on the workers of a Dask cluster.

    python -m boresight.dask_engine --program boresight --out DIR [--scheduler ADDRESS] [--workers N] < plan.json

The plan is what `boresight study plan --json` prints. Each shard is one call of the program on some worker, which writes
its file below DIR (a folder that all workers see) and answers with its manifest; nothing else travels. The program does nothing
for a shard that is there and whole, so that a task which the scheduler starts twice costs one look at a file.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import signal
import subprocess
import sys

MISSING = 3
"""Exit status that tells that Dask is not installed."""

PR_SET_PDEATHSIG = 1
"""`prctl` of Linux: the signal that a process gets when its parent dies."""

RETRIES = 3
"""How often a shard is tried again after its worker died or its program failed."""

DEATHS = 100
"""How many workers may die over a shard before the scheduler gives it up: a cluster that takes machines away is no fault of a shard.
Of a cluster on this machine; a scheduler elsewhere has its own configuration."""


def die_with_parent() -> None:
    """Ends the child with its worker: nothing goes on computing for a cluster that is gone. On Linux alone."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def run_shard(command: list[str]) -> dict:
    """Runs the program for one shard and gives its manifest."""
    done = subprocess.run(command, capture_output=True, text=True, preexec_fn=die_with_parent)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: exit status {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="boresight.dask_engine", description=__doc__)
    parser.add_argument("--program", required=True, help="the program boresight, as the workers find it")
    parser.add_argument("--out", required=True, help="folder of the results, which all workers see")
    parser.add_argument("--scheduler", help="address of a scheduler; default: a cluster on this machine")
    parser.add_argument("--workers", type=int, help="workers of a cluster on this machine; default: one a core")
    return parser.parse_args()


def main() -> int:
    try:
        import dask
        from distributed import Client, LocalCluster, as_completed
    except ImportError as error:
        print(error, file=sys.stderr)
        return MISSING
    given = arguments()
    plan = json.load(sys.stdin)
    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS})
    cluster = given.scheduler or LocalCluster(
        n_workers=given.workers, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    )
    with Client(cluster) as client:
        commands = [
            [given.program, "--json", *piece["arguments"], "--out", given.out, "--jobs", "1"]
            for piece in plan["pieces"]
        ]
        futures = client.map(run_shard, commands, retries=RETRIES, pure=False, key="shard")
        done = 0
        for future, manifest in as_completed(futures, with_results=True):
            done += 1
            print(json.dumps({"done": done, "of": len(commands), "shard": manifest["shard"]}), flush=True)
            future.release()
    if given.scheduler is None:
        cluster.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
