"""The command of the package: its output and exit statuses, the monitor's page in it, and its end by Ctrl-C.
"""

import json
import signal
import subprocess
import sys
import sysconfig
import urllib.request
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = [sys.executable, "-m", "boresight"]
"""Command of the package, not the separately built program `boresight`."""
SCRIPT = [str(Path(sysconfig.get_path("scripts")) / "boresight")]


@pytest.mark.parametrize("words", [PACKAGE, SCRIPT], ids=["module", "script"])
def test_answers_and_exit_statuses_are_those_of_the_command(words, command):
    listed = subprocess.run([*words, "scenario", "list", "--json"], capture_output=True, text=True)
    assert (listed.returncode, listed.stderr) == (0, "")
    assert listed.stdout == command("scenario", "list", "--json")
    refused = subprocess.run([*words, "run", "nowhere"], capture_output=True, text=True)
    assert refused.returncode == 2
    assert "`nowhere` is neither a built-in scenario" in refused.stderr
    misused = subprocess.run([*words, "--json", "walk"], capture_output=True, text=True)
    assert misused.returncode == 2
    assert "walk" in json.loads(misused.stdout)["error"]


@pytest.mark.parametrize("words", [PACKAGE, SCRIPT], ids=["module", "script"])
def test_the_monitor_serves_its_page_and_ends_with_ctrl_c(words):
    if not (ROOT / "monitor/dist/index.html").exists():
        pytest.skip("the page was not built before the package: npm run build --prefix monitor")
    given = [*words, "monitor", "docking", "--frames", "24000..24002", "--bind", "127.0.0.1:0"]
    with subprocess.Popen(given, stderr=subprocess.PIPE, text=True) as served:
        try:
            line = served.stderr.readline()
            assert "http://" in line, line
            with urllib.request.urlopen(line.split()[1], timeout=60) as answer:
                assert "<title>Boresight monitor</title>" in answer.read().decode()
            served.send_signal(signal.SIGINT)
            assert served.wait(timeout=60) == 0
        finally:
            served.kill()


def test_ctrl_c_ends_a_run_as_it_ends_the_program(tmp_path):
    given = [*PACKAGE, "run", "docking", "--out", str(tmp_path / "run")]
    with subprocess.Popen(given, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
        try:
            while not (tmp_path / "run/run.toml").exists():
                assert running.poll() is None, "it ended by itself"
            running.send_signal(signal.SIGINT)
            assert running.wait(timeout=60) == -signal.SIGINT
        finally:
            running.kill()
