"""Keeps golden/manifest.toml: the hash of every file, and why it was made last.

A script that makes references calls `begin()` first and `record()` for each file that it wrote. After editing
a script alone, `python3 golden/manifest.py PATH... --reason "..."` records its new hash.
"""

import argparse
import hashlib
import os
import pathlib
import re
import sys

GOLDEN = pathlib.Path(__file__).resolve().parent
MANIFEST = GOLDEN / "manifest.toml"


def begin(parser=None):
    """Parses the command line of a script that makes references. A reason is a must, and CI makes none."""
    if os.environ.get("CI"):
        sys.exit("references are never made in CI: there they are only compared with")
    parser = parser or argparse.ArgumentParser()
    parser.add_argument("--reason", required=True, help="why the references are made anew; kept in the manifest")
    arguments = parser.parse_args()
    if '"' in arguments.reason or "\\" in arguments.reason or "\n" in arguments.reason or not arguments.reason.strip():
        parser.error("the reason is one line without quotes and backslashes")
    return arguments


def record(path, reason):
    """Writes hash and reason of a file into its entry of the manifest, which must exist."""
    name = pathlib.Path(path).resolve().relative_to(GOLDEN).as_posix()
    digest = hashlib.sha256((GOLDEN / name).read_bytes()).hexdigest()
    entry = re.compile(
        r'(path = "' + re.escape(name) + r'"\nsha256 = ")([0-9a-f]*)("\nreason = ")([^"]*)(")'
    )
    text, count = entry.subn(lambda m: m[1] + digest + m[3] + reason + m[5], MANIFEST.read_text())
    if count != 1:
        sys.exit(f"golden/manifest.toml has {count} entries of the form path, sha256, reason for {name}")
    MANIFEST.write_text(text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("paths", nargs="+")
    arguments = begin(parser)
    for path in arguments.paths:
        record(path, arguments.reason)
