#!/usr/bin/env python3
"""Does what a new user does with a wheel, in an environment without Rust and without this source tree, and times it.

    python3 tests/python/first_minutes.py boresight-0.1.0-….whl

1. Install: a new virtual environment, `pip install` of the wheel.
2. Demo: `boresight demo --no-open`, and its page in Chromium, if that is installed, where it must show its figures.
3. Monitor: `boresight monitor` serves its page.
4. Examples: `boresight examples` writes them, and a pipeline among them runs.
5. Pages: the commands of README and book that tests/pages/checks.toml names and that need neither this tree nor a
   compiler (tests/pages/run.py --installed).

Steps 1 and 2 shall take at most 90 s together on two quiet cores; the script prints the times and ends with 1 only if
a step fails. Standard library only.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHROMIUM = [
    "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--dump-dom",
]


class Trial:
    """An environment of its own in the folder `home`, and the times of the steps."""

    def __init__(self, home):
        self.home = home
        self.bin = home / "env/bin"
        self.times = []
        # Only the system's own programs: no cargo, no rustc, nothing of the caller.
        self.environment = {"PATH": f"{self.bin}:/usr/bin:/bin", "HOME": str(home), "LANG": "C.UTF-8"}
        for name in ("PIP_INDEX_URL", "PIP_CONFIG_FILE", "PIP_CERT", "PIP_FIND_LINKS", "HTTPS_PROXY", "SSL_CERT_FILE"):
            if name in os.environ:
                self.environment[name] = os.environ[name]
        for program in ("cargo", "rustc"):
            if shutil.which(program, path=self.environment["PATH"]):
                sys.exit(f"{program} is on the path of the trial, which must have no compiler")

    def run(self, *words):
        """The standard output of a command of the user, who is in the folder `home`."""
        done = subprocess.run([*map(str, words)], cwd=self.home, env=self.environment, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, words))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def timed(self, name, step, *arguments):
        start = time.monotonic()
        step(*arguments)
        self.times.append((name, time.monotonic() - start))
        print(f"{name:<12}{self.times[-1][1]:7.1f} s", flush=True)


def install(trial, wheel):
    trial.run(sys.executable, "-m", "venv", trial.home / "env")
    trial.run(trial.bin / "pip", "install", "--quiet", wheel)


def demo(trial):
    trial.run("boresight", "demo", "--no-open")
    page = trial.home / "runs/demo-001/index.html"
    text = page.read_text()
    if shutil.which("chromium", path=trial.environment["PATH"]):
        profile = f"--user-data-dir={trial.home / 'profile'}"
        text = trial.run(*CHROMIUM, profile, page.as_uri())
    if "<h1" not in text or "<image" not in text:
        sys.exit(f"{page} has no heading or no frame")


def monitor(trial):
    """Starts the monitor on a free port and reads its page."""
    words = ["boresight", "monitor", "argon", "--bind", "127.0.0.1:0"]
    pipe = subprocess.PIPE
    with subprocess.Popen(words, cwd=trial.home, env=trial.environment, stdout=pipe, stderr=subprocess.STDOUT, text=True) as server:
        try:
            for line in server.stdout:
                address = re.search(r"http://127\.0\.0\.1:\d+\S*", line)
                if address:
                    page = urllib.request.urlopen(address[0], timeout=30).read().decode()
                    if "monitor.js" not in page:
                        sys.exit("the monitor has no page")
                    return
            sys.exit("the monitor printed no address")
        finally:
            server.terminate()


def examples(trial):
    trial.run("boresight", "examples")
    trial.run("boresight", "run", "argon", "--frames", "8000..8010", "--pipeline", "exec:python3 examples/brightest.py", "--out", "tried")


def pages(trial):
    trial.run(trial.bin / "python", ROOT / "tests/pages/run.py", "--program", trial.bin / "boresight", "--installed")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheel", type=pathlib.Path)
    wheel = parser.parse_args().wheel.resolve()
    if not wheel.is_file():
        parser.error(f"no file {wheel}")
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB")
    with tempfile.TemporaryDirectory() as home:
        trial = Trial(pathlib.Path(home))
        trial.timed("install", install, trial, wheel)
        trial.timed("demo", demo, trial)
        print(f"{'both':<12}{sum(seconds for _, seconds in trial.times):7.1f} s of 90")
        trial.timed("monitor", monitor, trial)
        trial.timed("examples", examples, trial)
        trial.timed("pages", pages, trial)


if __name__ == "__main__":
    main()
