"""Runs the shards of a study on the workers of a Dask cluster.

    python -m boresight.dask_engine --program boresight --out DIR|URL [--scheduler ADDRESS] [--workers N] < plan.json

The plan is the output of `boresight study plan --json`. The files that it names are sent to every worker,
once, by their content: the study, its scenario, the inputs of its cases, and the files among the words of a
program. Each shard is one call of the program on some worker, which writes its file below DIR (a folder
shared by all workers) and returns its manifest. The program skips a complete shard: a task that the scheduler
starts twice only reads one file.

With the URL of an object store, as in s3://bucket/study, a worker fetches an existing shard from the store,
runs the program in a private folder, and stores the results. At the end the shards are fetched and merged
here, and the results are stored beside them.
"""

from __future__ import annotations

import argparse
import ctypes
import hashlib
import json
import logging
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
from contextlib import nullcontext

MISSING = 3
"""Exit status if Dask, or the package for the object store, is not installed."""

PR_SET_PDEATHSIG = 1
"""`prctl` of Linux: the signal that a process receives when its parent dies."""

RETRIES = 3
"""Number of retries of a shard whose program was killed. A program that ends by itself, with any status, is
not retried."""

DEATHS = 100
"""Number of workers that may die during a shard before the scheduler gives it up: a cluster that removes
machines is no fault of a shard. For a cluster on this machine; a scheduler elsewhere has its own
configuration."""

CONNECT_S = 30
"""Longest time until a scheduler answers, s."""


def die_with_parent() -> None:
    """Ends the child with its worker, so that nothing computes for a cluster that is gone. Linux only."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def digest_of(files: dict[str, bytes]) -> str:
    """SHA-256 of files by their absolute paths."""
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        for part in (path.encode(), content):
            digest.update(len(part).to_bytes(8, "little"))
            digest.update(part)
    return digest.hexdigest()


def copy_of(path: str, below: str) -> str:
    """Path of the copy of a file or folder, below a folder that mirrors the absolute paths."""
    return os.path.join(below, *pathlib.PurePath(path).parts[1:])


def unpack(files: dict[str, bytes], below: str) -> None:
    """Writes files below a folder, each at its absolute path. In TOML files, absolute paths of the other
    files are replaced by those of the copies."""
    for path, content in files.items():
        if path.endswith(".toml"):
            for other in files:
                for quote in ('"', "'"):
                    old, new = (f"{quote}{name}{quote}".encode() for name in (other, copy_of(other, below)))
                    content = content.replace(old, new)
        copy = pathlib.Path(copy_of(path, below))
        copy.parent.mkdir(parents=True, exist_ok=True)
        whole = copy.with_name(f".{copy.name}.{os.getpid()}")
        whole.write_bytes(content)
        # Some of the files are programs.
        whole.chmod(0o755)
        whole.replace(copy)


class Store:
    """The results of a study in an object store. An object is there whole or not at all."""

    def __init__(self, url: str) -> None:
        from fsspec.core import url_to_fs  # type: ignore[import-untyped, unused-ignore]

        # Other workers store objects meanwhile: listings are not cached.
        self.files, self.root = url_to_fs(url, use_listings_cache=False)

    def fetch(self, name: str, folder: str) -> bytes | None:
        """Copies an object below a folder, if there is one; its content."""
        try:
            content = self.files.cat_file(f"{self.root}/{name}")
        except FileNotFoundError:
            return None
        copy = pathlib.Path(folder, name)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
        return content

    def put(self, name: str, folder: str, known: bytes | None = None) -> None:
        """Copies a file below a folder into the store, unless the store holds the content `known`."""
        content = pathlib.Path(folder, name).read_bytes()
        if content != known:
            self.files.pipe_file(f"{self.root}/{name}", content)


def is_url(out: str) -> bool:
    return "://" in out


def shard_name(shard: int, of: int) -> str:
    return f"shards/{shard:0{len(str(of))}}-of-{of}.parquet"


def run_shard(
    command: list[str], shard: int, of: int, out: str, folder: str, directory: str, files: list[str]
) -> dict:
    """Runs the program for one shard, with its results in `out`; returns its manifest, or `failed` with the
    program's error."""
    from distributed import get_worker

    below = os.path.join(get_worker().local_directory, folder)
    words = [copy_of(word, below) if word in files else word for word in command]
    workdir = copy_of(directory, below)
    os.makedirs(workdir, exist_ok=True)
    if not is_url(out):
        return run_program([*words, "--out", out], workdir)
    names = ("plan.json", shard_name(shard, of))
    with tempfile.TemporaryDirectory(dir=below) as own:
        try:
            store = Store(out)
            known = {name: store.fetch(name, own) for name in names}
            manifest = run_program([*words, "--out", own], workdir)
            if "failed" not in manifest:
                for name in names:
                    store.put(name, own, known[name])
        except Exception as error:
            # Stores raise exceptions of any type; the scheduler retries.
            raise RuntimeError(f"worker {get_worker().address}: {out}: {error}") from error
    return manifest


def run_program(words: list[str], workdir: str) -> dict:
    """Runs the program and returns its JSON output, or `failed` with its error.

    A killed program raises an error, and the scheduler retries; one that ended by itself would end in the
    same way.
    """
    from distributed import get_worker

    try:
        done = subprocess.run(words, cwd=workdir, capture_output=True, text=True, preexec_fn=die_with_parent)
    except OSError as error:
        return {"failed": f"worker {get_worker().address}: {words[0]}: {error.strerror}; BORESIGHT_PROGRAM names the program as workers find it"}
    if done.returncode < 0:
        raise RuntimeError(f"{' '.join(words)}: ended by signal {-done.returncode}")
    if done.returncode != 0:
        return {"failed": done.stderr.strip() or f"{' '.join(words)}: exit status {done.returncode}"}
    return json.loads(done.stdout)


def merge(program: str, plan: dict, url: str) -> int:
    """Fetches the shards of a study from a store, runs the program that merges them, and stores the results;
    returns the program's exit status."""
    store, pieces = Store(url), plan["pieces"]
    # Arguments of a shard, without `--shard I/N`.
    words = list(pieces[0]["arguments"])
    place = words.index("--shard")
    del words[place : place + 2]
    words[words.index("run")] = "merge"
    with tempfile.TemporaryDirectory() as folder:
        for name in ("plan.json", *(shard_name(piece["shard"], len(pieces)) for piece in pieces)):
            store.fetch(name, folder)
        done = subprocess.run([program, *words, "--out", folder], cwd=plan["directory"])
        # 1: merged, and a requirement is not met.
        if done.returncode in (0, 1):
            # Checksums are stored last: they cover all other files.
            for name in sorted(os.listdir(folder), key=lambda name: name == "SHA256SUMS"):
                if name not in ("plan.json", "shards") and not name.startswith("."):
                    store.put(name, folder)
    return done.returncode


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="boresight.dask_engine", description=__doc__)
    parser.add_argument("--program", required=True, help="the program boresight, as the workers find it")
    parser.add_argument("--out", required=True, help="folder of the results, which all workers see, or the URL of an object store, as in s3://bucket/study")
    parser.add_argument("--scheduler", help="address of a scheduler; default: a cluster on this machine")
    parser.add_argument("--workers", type=int, help="workers of a cluster on this machine; default: one a core")
    return parser.parse_args()


def main() -> int:
    try:
        import dask
        from distributed import Client, LocalCluster, as_completed

        from boresight.dask_plugin import StudyFiles
    except ImportError as error:
        print(error, file=sys.stderr)
        return MISSING

    # Errors are reported once, below.
    logging.disable(logging.CRITICAL)
    given = arguments()
    plan = json.load(sys.stdin)
    files = {path: pathlib.Path(path).read_bytes() for path in plan["files"]}
    folder = f"boresight-{digest_of(files)[:16]}"
    commands = [[given.program, "--json", *piece["arguments"], "--jobs", "1"] for piece in plan["pieces"]]
    if is_url(given.out):
        try:
            Store(given.out)
        except (ImportError, ValueError) as error:
            print(f"--out is {given.out}: {error}", file=sys.stderr)
            return MISSING
    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS, "distributed.comm.timeouts.connect": CONNECT_S})
    done = 0
    try:
        local = {"n_workers": given.workers, "threads_per_worker": 1, "host": "127.0.0.1", "dashboard_address": None}
        # Workers of this machine write to the same standard error, whose last line is the error.
        scheduler = nullcontext(given.scheduler) if given.scheduler else LocalCluster(**local, silence_logs=logging.CRITICAL)
        with scheduler as cluster, Client(cluster, timeout=CONNECT_S) as client:
            client.register_plugin(StudyFiles(files, folder))
            futures = client.map(
                run_shard,
                commands,
                [piece["shard"] for piece in plan["pieces"]],
                of=len(commands),
                out=given.out,
                folder=folder,
                directory=plan["directory"],
                files=list(files),
                retries=RETRIES,
                pure=False,
                key="shard",
            )
            for future in as_completed(futures):
                if future.status in ("cancelled", "lost"):
                    raise ConnectionError("the scheduler is gone")
                manifest = future.result()
                if "failed" in manifest:
                    client.cancel(futures)
                    raise RuntimeError(manifest["failed"])
                done += 1
                print(json.dumps({"done": done, "of": len(commands), "shard": manifest["shard"]}), flush=True)
                future.release()
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return 1
    except OSError as error:
        where = f"the scheduler at {given.scheduler}" if given.scheduler else "the cluster on this machine"
        print(
            f"{where} does not answer ({error}); {done} of {len(commands)} shards were reported, what is whole in {given.out} is kept, and "
            "the same command goes on from there",
            file=sys.stderr,
        )
        return 1
    if not is_url(given.out):
        return 0
    try:
        return merge(given.program, plan, given.out)
    except Exception as error:
        print(f"{given.out}: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
