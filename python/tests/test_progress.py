"""Progress of long calls."""

import sys
import types

import pytest

import boresight
from boresight import _progress

STUDY = """
title = "three cases of ARGON"
scenario = "argon"
seed = 1
frames = "0..4"
[stop]
cases = 3
[[vary]]
path = "star_list.magnitude_limit"
distribution = { kind = "uniform", min = 5.0, max = 8.0 }
"""


class Terminal:
    """Standard error that is a terminal."""

    def __init__(self):
        self.text = ""

    def write(self, text):
        self.text += text

    def flush(self):
        pass

    def isatty(self):
        return True


@pytest.fixture
def no_tqdm(monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setitem(sys.modules, "ipywidgets", None)


def test_a_function_receives_the_number_of_frames():
    calls = []
    boresight.run("argon", frames=range(0, 12), progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (12, 12)
    assert calls == sorted(calls)


def test_a_function_receives_the_number_of_cases(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    calls = []
    boresight.study(tmp_path / "study.toml", progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (3, 3)


def test_an_exception_of_the_function_ends_the_call():
    def fail(done, total):
        raise RuntimeError("closed window")

    with pytest.raises(RuntimeError, match="closed window"):
        boresight.run("argon", frames=range(0, 2), progress=fail)


def test_nothing_is_written_where_standard_error_is_no_terminal(capfd):
    boresight.run("argon", frames=range(0, 3))
    assert capfd.readouterr() == ("", "")


def test_a_terminal_has_a_line_that_is_erased(monkeypatch, no_tqdm):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    boresight.run("argon", frames=range(0, 3))
    assert "argon [" in terminal.text and "3/3 frames" in terminal.text
    assert terminal.text.endswith(" \r")
    terminal.text = ""
    boresight.run("argon", frames=range(0, 3), progress=False)
    assert terminal.text == ""


def test_true_writes_to_standard_error_that_is_no_terminal(capsys, no_tqdm):
    boresight.run("docking", frames=range(24000, 24002), progress=True)
    assert "2/2 fields" in capsys.readouterr().err


def test_a_notebook_has_the_bar_of_tqdm(monkeypatch):
    shown = []

    class Tqdm:
        def __init__(self, total, unit, desc, leave):
            self.n = 0
            shown.append((total, unit.strip(), desc, leave))

        def update(self, more):
            self.n += more

        def close(self):
            shown.append(self.n)

    module = types.ModuleType("tqdm.auto")
    module.tqdm = Tqdm
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)
    monkeypatch.setattr(_progress, "in_notebook", lambda: True)
    boresight.run("argon", frames=range(0, 3))
    assert shown == [(3, "frames", "argon", False), 3]


def test_a_notebook_without_tqdm_and_ipywidgets_has_no_bar(monkeypatch, no_tqdm, capfd):
    monkeypatch.setattr(_progress, "in_notebook", lambda: True)
    boresight.run("argon", frames=range(0, 3))
    assert capfd.readouterr() == ("", "")


def test_another_value_is_refused():
    with pytest.raises(boresight.InputError, match="`progress` is 'yes', expected None, True, False or a function"):
        boresight.run("argon", frames=range(0, 2), progress="yes")
