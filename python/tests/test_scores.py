"""Scores as dictionaries that are displayed as tables."""

import json
import pickle

import pytest

import boresight


@pytest.fixture(scope="module")
def run():
    return boresight.run("argon", frames=range(8000, 8040))


def test_a_score_is_the_dictionary_of_score_json(run):
    document = json.loads((run.directory / "score.json").read_text())
    score = run.score
    assert isinstance(score, dict) and score == document
    assert json.loads(json.dumps(score)) == document
    assert pickle.loads(pickle.dumps(score)) == document
    assert score["figures"]["correct_rate"]["value"] == document["figures"]["correct_rate"]["value"]
    assert boresight.score(run, run.measurements)["figures"] == document["figures"]


def test_a_score_is_displayed_as_a_table(run):
    lines = repr(run.score).splitlines()
    assert lines[0] == "Score of argon: 40 frames"
    assert lines[1].split() == ["figure", "value", "95", "%", "interval", "count"]
    (row,) = [line for line in lines if line.startswith("correct_rate ")]
    figure = run.score["figures"]["correct_rate"]
    assert row.split()[1] == f"{figure['value']:.4g}" and row.endswith(f"{figure['count']} of {figure['of']}")
    assert len({len(line) for line in lines[1:-2]}) == 1, "columns are aligned"
    assert lines[-2].startswith("misses by cause: ")


def test_a_notebook_displays_a_score_as_html(run):
    text = run.score._repr_html_()
    assert "<td>correct_rate</td>" in text and text.count("<tr>") == text.count("</tr>") > 5


def test_a_report_is_written_of_a_run_and_of_measurements_of_another_pipeline(run, tmp_path):
    path = boresight.report(run)
    assert path == run.directory / "report.html" and path.read_text().startswith("<!doctype html>")
    lines = (run.directory / "measurements.csv").read_text().splitlines(keepends=True)
    (tmp_path / "mine.csv").write_text("".join(lines[:-10]))
    mine = boresight.report(run, tmp_path / "pages" / "mine.html", measurements=tmp_path / "mine.csv")
    assert "not reported" in mine.read_text() and "not reported" not in path.read_text()
    with pytest.raises(boresight.InputError, match="`out` is None, expected a path"):
        boresight.report(run, measurements=tmp_path / "mine.csv")
    with pytest.raises(boresight.FileError):
        boresight.report(run, tmp_path / "mine.csv")


def test_text_in_a_score_is_escaped():
    score = boresight.Score(scenario="<b>", frames=1, figures={"<i>": {"value": 1.0, "count": 1, "of": 1}})
    assert "<b>" not in score._repr_html_() and "<i>" not in score._repr_html_()


def test_a_run_in_its_warm_up_displays_the_group():
    score = boresight.run("demo-far-range", frames=range(0, 5)).score
    assert "group warm-up: 5 frames" in repr(score)


def test_incomplete_and_unusual_scores_are_displayed():
    assert repr(boresight.Score()) == "Score of a run: 0 frames"
    assert "x" in repr(boresight.Score(figures={"x": {"value": 3}}, misses={"edge": 2}))
    assert repr(boresight.Score(figures=3, groups=[1])) == "Score of a run: 0 frames"
    assert "2 edge" in repr(boresight.Score(misses={"edge": 2, "dim": 0}))
