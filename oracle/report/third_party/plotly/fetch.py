#!/usr/bin/env python3
"""Fetches the cartesian bundle of plotly.js and its licence from npm, and checks both against SHA256SUMS.

    python3 fetch.py                   the version of README.md: fails unless the files have the hashes of SHA256SUMS
    python3 fetch.py --version X.Y.Z   another version: writes its files and their hashes; README.md is changed by hand

npm must be on the PATH. npm itself checks the archive against the hash of its registry.
"""

import argparse
import hashlib
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACKAGE = "plotly.js-cartesian-dist-min"
FILES = ["LICENSE", "plotly-cartesian.min.js"]


def documented_version() -> str:
    """The version in the table of README.md."""
    found = re.search(r"^\| version \| (\S+) \|$", (HERE / "README.md").read_text(), re.MULTILINE)
    if found is None:
        sys.exit("README.md has no row `version`")
    return found.group(1)


def fetch(version: str) -> dict[str, bytes]:
    """The files of one version, by name."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", "--silent", f"{PACKAGE}@{version}"], cwd=folder, check=True, stdout=sys.stderr)
        (archive,) = Path(folder).glob("*.tgz")
        with tarfile.open(archive) as tar:
            members = {name: tar.extractfile(f"package/{name}") for name in FILES}
            return {name: member.read() for name, member in members.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", help="another version than that of README.md")
    version = parser.parse_args().version
    files = fetch(version or documented_version())
    sums = "".join(f"{hashlib.sha256(data).hexdigest()}  {name}\n" for name, data in files.items())
    expected = (HERE / "SHA256SUMS").read_text()
    if version is None and sums != expected:
        sys.exit(f"the files of npm have the SHA-256\n{sums}expected\n{expected}")
    for name, data in files.items():
        (HERE / name).write_bytes(data)
    (HERE / "SHA256SUMS").write_text(sums)
    print(f"{PACKAGE} {version or documented_version()}:\n{sums}", end="")


if __name__ == "__main__":
    main()
