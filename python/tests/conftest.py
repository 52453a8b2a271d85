"""Fixtures of the tests: the command that results are compared with."""

import os
import shlex
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def command():
    """Runs the command `boresight`: that of BORESIGHT_PROGRAM, or the one built by cargo from this tree."""
    program = os.environ.get("BORESIGHT_PROGRAM", "cargo run --release --locked --quiet --")

    def run(*words: object) -> str:
        done = subprocess.run([*shlex.split(program), *map(str, words)], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    return run
