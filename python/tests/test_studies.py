"""Studies of a pipeline written in Python: cases that run side by side do not affect each other."""

import pytest

import boresight
from boresight import Detection

STUDY = """
title = "a few frames of ARGON"
scenario = "argon"
seed = 9
frames = "2000..2004"
[stop]
cases = 6
[[vary]]
path = "star_list.magnitude_limit"
distribution = { kind = "uniform", min = 5.0, max = 8.0 }
[[vary]]
path = "sensor.hot_pixels.count"
distribution = { kind = "integer", min = 0, max = 40 }
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    return path


class Remembering:
    """Answers with data of its case only: the number of listed stars, and the number of frames received."""

    def __init__(self, setup):
        self.stars, self.seen = len(setup["stars"]), 0

    def __call__(self, frame, telemetry):
        self.seen += 1
        y, x = divmod(int(frame.pixels.argmax()), frame.pixels.shape[1])
        return Detection(x, y, n_stars=self.stars + 1000 * self.seen)


def brightest(frame, telemetry):
    y, x = divmod(int(frame.pixels.argmax()), frame.pixels.shape[1])
    return Detection(x, y)


@pytest.mark.parametrize("pipeline", [Remembering, brightest])
def test_each_case_is_a_run_of_its_own(study, pipeline):
    result = boresight.study(study, pipeline=pipeline, jobs=3)
    rows = result.rows
    assert len(rows) == 6 and not any(rows["has_failed"]) and result.first_failure is None
    for case in range(6):
        alone = boresight.run(boresight.Scenario.from_case(study, case), frames=range(2000, 2004), pipeline=pipeline)
        for name in ("hit_rate", "correct_rate", "stars_mean"):
            figure = alone.score["figures"][name]
            assert rows[f"{name}.count"][case] == figure["count"] and rows[f"{name}.of"][case] == figure["of"]
            if figure["value"] is not None:
                assert rows[name][case] == figure["value"], name
    if pipeline is Remembering:
        assert len(set(rows["stars_mean"])) == 6, "the test needs cases with other stars"


def test_the_worst_case_tells_the_call_that_runs_it_again(study):
    result = boresight.study(study, pipeline=brightest)
    worst = result.summary["worst"][0]
    run = eval(worst["replay"], {"boresight": boresight, "brightest": brightest})
    assert run.score["figures"][result.summary["worst_by"]]["value"] == worst["value"]


def test_exceptions_are_outcomes(study):
    def falls(frame, telemetry):
        if frame.number == 2002:
            raise ZeroDivisionError("no stars")
        return brightest(frame, telemetry)

    class Broken:
        def __init__(self, setup):
            raise RuntimeError("no camera")

    for pipeline, frame, told in [(falls, 2002, "ZeroDivisionError: no stars ("), (Broken, 2000, "RuntimeError: no camera (")]:
        result = boresight.study(study, pipeline=pipeline, jobs=2)
        assert result.summary["failed_cases"] == 6 and all(result.rows["has_failed"])
        case, at, reason = result.first_failure
        assert (case, at) == (0, frame) and reason.startswith(told), result.first_failure


def test_the_same_callable_goes_on_and_another_is_refused(study, tmp_path):
    asked = []

    def counting(frame, telemetry):
        asked.append(frame.number)
        return None

    first = boresight.study(study, pipeline=counting, out=tmp_path / "out")
    count = len(asked)
    assert count == 6 * 4
    again = boresight.study(study, pipeline=counting, out=tmp_path / "out")
    assert len(asked) == count and again.summary == first.summary
    for other in (brightest, None):
        with pytest.raises(boresight.InputError, match="hash"):
            boresight.study(study, pipeline=other, out=tmp_path / "out")


def test_what_is_no_exception_ends_the_study_and_keeps_its_finished_cases(study, tmp_path):
    asked = []

    def leaving(frame, telemetry):
        asked.append(frame.number)
        if len(asked) == 4 + 3:
            raise SystemExit(3)
        return None

    out = tmp_path / "out"
    with pytest.raises(SystemExit):
        boresight.study(study, pipeline=leaving, out=out, jobs=1)
    assert [path.suffix for path in (out / "shards").iterdir()] == [".journal"] and not (out / "cases.parquet").exists()

    result = boresight.study(study, pipeline=leaving, out=out, jobs=1)
    assert len(asked) == 7 + 5 * 4, "only the case that was ended and those after it run"
    assert result.summary["failed_cases"] == 0 and not list(out.glob("shards/*.journal"))


@pytest.mark.parametrize("wrong", [3, "far-range", "exec:", "docking"])
def test_what_is_no_pipeline_is_refused_before_anything_is_made(study, wrong, tmp_path):
    with pytest.raises(boresight.InputError, match="pipeline"):
        boresight.study(study, pipeline=wrong, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_case_that_is_not_there_is_refused(study):
    with pytest.raises(boresight.InputError, match="`case` is 6, expected a case of the study, 0 to 5"):
        boresight.Scenario.from_case(study, 6)
