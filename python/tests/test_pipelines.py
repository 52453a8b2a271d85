"""A pipeline written in Python is scored like any other, and its errors are outcomes."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import boresight
from boresight import Detection, NoSolution, Pose, RangeOnly

FRAMES = range(8000, 8008)


def statuses(pipeline, scenario="argon", frames=FRAMES, **more):
    return boresight.run(scenario, frames=frames, pipeline=pipeline, **more).measurements["status"]


def brightest(frame, telemetry):
    """The brightest pixel."""
    y, x = np.unravel_index(frame.pixels.argmax(), frame.pixels.shape)
    return Detection(x, y)


def test_answers_of_every_kind_are_read():
    answers = iter(
        [
            Detection(1, 2.5),
            Detection(np.float64(1), np.int64(2), los_j2000=np.array([0.0, 0, 1]), n_stars=3),
            {"status": "detected", "x_px": 3, "y_px": 4},
            None,
            NoSolution("empty_frame"),
            NoSolution("failed: out of film"),
            {"status": "saturated_frame"},
            NoSolution(),
        ]
    )
    run = boresight.run("argon", frames=FRAMES, pipeline=lambda frame, telemetry: next(answers))
    expected = ["detected"] * 3 + ["no_target", "empty_frame", "failed: out of film", "saturated_frame", "no_target"]
    assert run.measurements["status"] == expected
    assert run.measurements["los_j2000_z"][1] == 1 and run.measurements["n_stars"][1] == 3


def test_covariances_are_recorded_and_scored():
    scenario = boresight.Scenario.load("argon")
    truth = {frame.number: frame.truth for frame in scenario.frames(FRAMES)}

    def pipeline(frame, telemetry):
        of = truth[frame.number]
        los = [of[f"los_j2000_{axis}"] for axis in "xyz"]
        return Detection(
            of["target_x_px"] + 0.5, of["target_y_px"], los, sigma_x_px=0.25, sigma_y_px=0.5, correlation_xy=0.5,
            sigma_ra_deg=0.001, sigma_dec_deg=0.002, correlation_ra_dec=-0.5,
        )  # fmt: skip

    run = boresight.run(scenario, frames=FRAMES, pipeline=pipeline)
    assert set(run.measurements["sigma_x_px"]) == {0.25} and set(run.measurements["correlation_ra_dec"]) == {-0.5}
    figures = run.score["figures"]
    correct = figures["correct_rate"]["count"]
    assert correct > 0 and figures["centroid_nees_mean"]["count"] == correct
    # The line of sight is the true one: no error, but for rounding.
    assert figures["line_of_sight_nees_mean"]["value"] < 1e-9
    assert sum(row["frames"] for row in run.score["consistency"] if row["by"] == "image") == correct
    again = boresight.score(run, run.measurements)
    assert again["figures"] == figures and again["consistency"] == run.score["consistency"]


def test_a_class_is_made_with_the_calibration():
    setup = boresight.Scenario.load("argon").setup
    assert setup["readout"]["gain_e_per_dn"] > 0 and setup["calibration"]["full_well_e"] > 0
    assert len(setup["calibration"]["attitude"]["white_arcsec"]) == 3


def test_what_cannot_be_used_is_an_outcome_with_its_reason():
    def raised(frame, telemetry):
        raise ZeroDivisionError("no stars")

    for pipeline, told in [
        (raised, "failed: ZeroDivisionError: no stars ("),
        (lambda f, t: 5, "failed: TypeError: it returned 5, expected Detection, NoSolution, None"),
        (lambda f, t: Detection(float("nan"), 1), "expected finite numbers"),
        (lambda f, t: Detection(900, 1), "not on the detector of 752 × 580 pixels"),
        (lambda f, t: Detection(1, 1, los_j2000=(1, 1, 0)), "is not a unit vector"),
        (lambda f, t: Detection(1, 1, sigma_x_px=0.1), "expected all three or none"),
        (lambda f, t: Detection(1, 1, sigma_x_px=0.1, sigma_y_px=0, correlation_xy=0), "its sigma_y_px is 0, expected a positive"),
        (lambda f, t: {"status": "detected", "x": 1}, "unknown field `x`"),
        (lambda f, t: NoSolution("tired"), "its status `tired` is unknown"),
        (lambda f, t: Pose((0, 0, 9), (0, 0, 0)), "unknown field `d_m`"),
        (lambda f: None, "positional argument"),
    ]:
        run = boresight.run("argon", frames=range(8000, 8003), pipeline=pipeline)
        assert all(told in status for status in run.measurements["status"]), run.measurements["status"]
        assert run.first_failure[0] == 8000
        assert run.score["frames"] == 3


def test_a_class_is_made_once_with_the_setup_and_remembers():
    class Counting:
        def __init__(self, setup):
            self.stars, self.seen = len(setup["stars"]), []

        def __call__(self, frame, telemetry):
            self.seen.append(frame.number)
            return Detection(len(self.seen), self.stars % 100)

    run = boresight.run("argon", frames=FRAMES, pipeline=Counting)
    assert list(run.measurements["x_px"]) == [1, 2, 3, 4, 5, 6, 7, 8]


def test_what_a_class_raises_when_it_is_made_is_raised():
    class Broken:
        def __init__(self, setup):
            raise RuntimeError("no camera")

    with pytest.raises(RuntimeError, match="no camera"):
        boresight.run("argon", frames=FRAMES, pipeline=Broken)


def test_a_pipeline_sees_no_truth():
    seen = []
    boresight.run("argon", frames=range(8000, 8001), pipeline=lambda f, t: seen.extend([f, t]))
    frame, telemetry = seen
    assert not any(hasattr(frame, name) for name in ("truth", "objects", "expected", "telemetry"))
    assert telemetry.exposure_s > 0 and frame.pixels.shape == (580, 752)


def test_the_answers_do_not_depend_on_threads():
    one, two = (boresight.run("argon", frames=range(8000, 8040), pipeline=brightest, jobs=n) for n in (1, 2))
    assert one.score == two.score
    assert (one.directory / "measurements.csv").read_bytes() == (two.directory / "measurements.csv").read_bytes()


def test_docking_pipelines_answer_with_poses():
    answers = iter([Pose((0, 0, 10), (0, 0, 1), (0.1, 0.1, 0.1), contrast=2.0, brightness=-0.5), RangeOnly(300, 4), None])
    seen = []

    def pipeline(field, telemetry):
        seen.append((field.lines, telemetry.contrast))
        return next(answers)

    run = boresight.run("docking", frames=range(24000, 24003), pipeline=pipeline)
    assert run.measurements["status"] == ["measured", "range_only", "no_target"]
    assert seen == [("even", 1.0), ("odd", 2.0), ("even", 2.0)], "what was asked of the digitiser holds from the next field on"


@pytest.mark.parametrize("wrong", [3, "far-range", "exec:", "docking"])
def test_what_is_no_pipeline_is_refused_before_anything_is_made(wrong, tmp_path):
    with pytest.raises(boresight.InputError, match="pipeline"):
        boresight.run("argon", frames=FRAMES, pipeline=wrong, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_directory_in_use_is_a_file_error(tmp_path):
    (tmp_path / "mine").write_text("")
    with pytest.raises(OSError, match="not empty"):
        boresight.run("argon", frames=FRAMES, out=tmp_path)


STUDY = """
title = "long"
scenario = "argon"
seed = 1
frames = "0..40"
[stop]
cases = 640
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.6, max = 1.0 }
"""


@pytest.mark.parametrize("where", ["in the built-in pipeline", "in a Python pipeline", "in a stream", "in a study", "in a study of Python"])
def test_ctrl_c_ends_what_takes_long(where, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    work = {
        "in the built-in pipeline": lambda: boresight.run("argon"),
        "in a Python pipeline": lambda: boresight.run("argon", pipeline=lambda f, t: time.sleep(0.05)),
        "in a stream": lambda: [None for _ in boresight.Scenario.load("argon").frames()],
        "in a study": lambda: boresight.study(tmp_path / "study.toml"),
        "in a study of Python": lambda: boresight.study(tmp_path / "study.toml", pipeline=lambda f, t: time.sleep(0.05)),
    }[where]
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        work()
    # A second until it is pressed, and a case of a study or a batch of frames to be finished.
    assert time.monotonic() - begun < 10
