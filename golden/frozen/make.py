#!/usr/bin/env python3
"""Freezes the results of the commands in commands.toml: hashes of their output and of every file that they
leave.

    python3 golden/frozen/make.py --check                      # all commands, also long ones; exit 1 when a result changed
    python3 golden/frozen/make.py --reason "what changed them" # writes hashes.txt anew

Needs Python's standard library (3.11) and cargo. `--program FILE` uses a built program instead of building
this tree's.
"""

import argparse
import hashlib
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import manifest  # noqa: E402

HASHES = HERE / "hashes.txt"


def build():
    subprocess.run(["cargo", "build", "--release", "--locked", "--quiet"], cwd=ROOT, check=True)
    return ROOT / "target" / "release" / "boresight"


def results(program, folder):
    """Yields a line for each result: its SHA-256, and its path or the command that printed it."""
    shutil.copytree(ROOT / "scenarios", folder / "scenarios")
    for name in ("far-range.toml", "docking.toml"):
        shutil.copy(HERE / name, folder / name)
    seen = set(files(folder))
    for command in tomllib.loads((HERE / "commands.toml").read_text())["command"]:
        words = command["words"]
        answer = subprocess.run([program, *words.split()], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if answer.returncode not in (0, 1):
            sys.exit(f"boresight {words}\n{answer.stderr.decode()}")
        yield digest(answer.stdout), f"{answer.returncode} boresight {words}"
        for path in files(folder):
            if path not in seen:
                seen.add(path)
                yield digest((folder / path).read_bytes()), path


def files(folder):
    """Paths of the results: all files but reports, which are for people and change with their words."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file() and path.name != "report.html")


def digest(content):
    return hashlib.sha256(content).hexdigest()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--program", type=pathlib.Path)
    if "--check" in sys.argv:
        arguments = parser.parse_args()
    else:
        arguments = manifest.begin(parser)
    program = (arguments.program or build()).resolve()
    with tempfile.TemporaryDirectory() as folder:
        lines = [f"{digest}  {name}\n" for digest, name in results(program, pathlib.Path(folder))]
    if arguments.check:
        frozen = HASHES.read_text().splitlines(keepends=True)
        changed = sorted(set(lines) ^ set(frozen), key=lambda line: line.split("  ", 1)[1])
        sys.stdout.writelines(("now     " if line in lines else "frozen  ") + line for line in changed)
        print(f"{len(lines)} results, {len({line.split('  ', 1)[1] for line in changed})} of them changed")
        sys.exit(1 if changed else 0)
    HASHES.write_text("".join(lines))
    for name in ("make.py", "commands.toml", "far-range.toml", "docking.toml", "hashes.txt"):
        manifest.record(HERE / name, arguments.reason)


if __name__ == "__main__":
    main()
