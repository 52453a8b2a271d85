"""A navigation returns the numbers of the command; a navigator written in Python is scored like any other."""

import importlib.util
import io
import json
from pathlib import Path

import pytest

import boresight

EXAMPLE = Path(__file__).parents[2] / "examples/prior_orbit.py"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return boresight.run("argon", frames=range(40), out=tmp_path_factory.mktemp("navigation") / "run")


@pytest.fixture()
def example(monkeypatch):
    """Functions of the example in examples, which is a program."""
    monkeypatch.setattr("builtins.input", lambda: json.dumps({"setup": {}}))
    monkeypatch.setattr("sys.stdin", io.StringIO())
    spec = importlib.util.spec_from_file_location("prior_orbit", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("navigator", [None, "batch", "sequential"])
def test_figures_and_table_are_those_of_the_command(command, tmp_path, run, navigator):
    words = ["--navigator", navigator] if navigator else []
    printed = command("navigate", run.directory, "--every", "60", "--out", tmp_path / "theirs", "--json", *words)
    ours = boresight.navigate(run, navigator=navigator, every_s=60, out=tmp_path / "ours")
    assert ours.figures == json.loads(printed)
    for name in ("navigation.csv", "navigation.json"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert len(ours.estimates["time_utc"]) == ours.figures["score"]["requested"]


def test_a_class_and_a_function_answer_as_the_program(run, example):
    class Prior:
        mode = "sequential"

        def __init__(self, setup):
            self.setup, self.manoeuvres = setup, []

        def __call__(self, events, times):
            self.manoeuvres += [event["manoeuvre"] for event in events if "manoeuvre" in event]
            return [example.estimate(self.setup, self.manoeuvres, time) for time in times]

    def prior(setup, events, times):
        manoeuvres = [event["manoeuvre"] for event in events if "manoeuvre" in event]
        return [example.estimate(setup, manoeuvres, time) for time in times]

    program = boresight.navigate(run, navigator=f"exec:python3 '{EXAMPLE}'", every_s=60).figures["score"]
    assert program["estimates"] == program["requested"] > 0
    for navigator in (Prior, prior):
        made = boresight.navigate(run, navigator=navigator, every_s=60)
        assert made.figures["score"] == program
        assert made.figures["estimator"] == navigator.__name__


def test_faults_of_a_navigator_are_answers(run):
    def statuses(navigator):
        return set(boresight.navigate(run, navigator=navigator, every_s=300).estimates["status"])

    def clouds(setup, events, times):
        raise RuntimeError("clouds")

    (status,) = statuses(clouds)
    assert status.startswith("failed: RuntimeError: clouds (")
    assert statuses(lambda setup, events, times: ["no_convergence"] * len(times)) == {"no_convergence"}
    for answer, reason in [([], "its 0 estimates"), (3, "expected a list"), ([{"no": 1}], "cannot be read")]:
        (status,) = statuses(lambda setup, events, times, answer=answer: answer)
        assert reason in status, status


def test_wrong_arguments_are_refused(run, tmp_path):
    with pytest.raises(boresight.InputError, match="navigator.*int"):
        boresight.navigate(run, navigator=3)
    with pytest.raises(boresight.InputError, match="did you mean `batch`"):
        boresight.navigate(run, navigator="bach")
    with pytest.raises(boresight.InputError, match="--every"):
        boresight.navigate(run, every_s=-1)
    with pytest.raises(KeyboardInterrupt):

        def stop(setup, events, times):
            raise KeyboardInterrupt

        boresight.navigate(run, navigator=stop)

    class Daily:
        mode = "daily"

    with pytest.raises(boresight.InputError, match="mode"):
        boresight.navigate(run, navigator=Daily)
