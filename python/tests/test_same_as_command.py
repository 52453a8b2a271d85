"""The package returns the numbers of the command, bit for bit."""

import json

import matplotlib.image
import numpy as np
import OpenEXR
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
import pytest

import boresight

def bits(table: pa.Table) -> pa.Table:
    """A table whose floating-point numbers are their bits, so that equal means equal."""
    columns = {}
    for name in table.column_names:
        column = table[name].combine_chunks()
        columns[name] = column.view(pa.int64()) if pa.types.is_float64(column.type) else column
    return pa.table(columns)


@pytest.mark.parametrize(("name", "frames"), [("argon", range(0, 40)), ("docking", range(24000, 24020))])
def test_a_run_has_score_and_tables_of_the_command(command, tmp_path, name, frames):
    printed = json.loads(
        command("run", name, "--frames", f"{frames.start}..{frames.stop}", "--out", tmp_path / "run", "--json")
    )
    run = boresight.run(name, frames=frames)
    assert (run.directory / "score.json").read_bytes() == (tmp_path / "run/score.json").read_bytes()
    assert run.score == printed
    for file in sorted(path.relative_to(run.directory) for path in run.directory.rglob("*") if path.is_file()):
        if file.suffix != ".parquet":
            assert (run.directory / file).read_bytes() == (tmp_path / "run" / file).read_bytes(), file
    of_truth = "truth/frames.parquet" if name == "argon" else "truth/fields.parquet"
    theirs = pyarrow.parquet.read_table(tmp_path / "run" / of_truth)
    assert bits(pa.table(run.truth_frames)).equals(bits(theirs))


def test_measurements_are_the_file_to_the_bit(command, tmp_path):
    command("run", "argon", "--frames", "8000..8010", "--out", tmp_path / "run")
    run = boresight.Run.load(tmp_path / "run")
    rows = (tmp_path / "run/measurements.csv").read_text().splitlines()
    header = rows[0].split(",")
    for name in ("x_px", "los_j2000_x", "q_cam_j2000_w"):
        cells = [row.split(",")[header.index(name)] for row in rows[1:]]
        expected = np.array([float(cell) if cell else np.nan for cell in cells])
        assert run.measurements[name].tobytes() == expected.tobytes()


def test_pixels_are_those_of_rendered_images(command, tmp_path):
    command("render", "argon", "--frames", "9000..9004", "--format", "png", "--out", tmp_path / "far")
    for frame in boresight.Scenario.load("argon").frames(range(9000, 9004)):
        image = matplotlib.image.imread(tmp_path / f"far/frames/{frame.number:06}.png")
        assert np.array_equal(frame.pixels, np.round(image * 65535).astype(np.uint16))
    command("render", "docking", "--frames", "24000..24004", "--format", "png", "--out", tmp_path / "docking")
    for field in boresight.Scenario.load("docking").frames(range(24000, 24004)):
        image = matplotlib.image.imread(tmp_path / f"docking/frames/{field.number:06}.png")
        assert np.array_equal(field.pixels, np.round(image * 255).astype(np.uint16))


def test_expected_electrons_are_those_of_render(command, tmp_path):
    """To the bit of the file's 32-bit numbers."""
    command("render", "argon", "--frames", "9000..9001", "--format", "png", "--expected", "--out", tmp_path / "out")
    with OpenEXR.File(str(tmp_path / "out/truth/expected/009000.exr"), separate_channels=True) as file:
        theirs = file.channels()["Y"].pixels
    ours = boresight.Scenario.load("argon").frame(9000).expected
    assert np.array_equal(ours.astype(np.float32), theirs)


def test_scores_of_tables_are_those_of_files(command, tmp_path):
    command("run", "argon", "--frames", "8000..8040", "--out", tmp_path / "run")
    printed = json.loads(command("score", tmp_path / "run", tmp_path / "run/measurements.csv", "--json"))
    assert boresight.score(tmp_path / "run", tmp_path / "run/measurements.csv") == printed
    run = boresight.Run.load(tmp_path / "run")
    assert boresight.score(run, run.measurements)["figures"] == printed["figures"]


STUDY = """
title = "ten frames of ARGON"
scenario = "argon"
seed = 9
frames = "2000..2010"
[stop]
cases = 8
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.6, max = 1.0 }
"""


def test_a_study_has_summary_and_rows_of_the_command(command, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    printed = json.loads(command("study", "run", tmp_path / "study.toml", "--out", tmp_path / "theirs", "--json"))
    result = boresight.study(tmp_path / "study.toml", out=tmp_path / "ours")
    assert result.summary == printed
    theirs = pyarrow.parquet.read_table(tmp_path / "theirs/cases.parquet").replace_schema_metadata(None)
    assert bits(pa.table(result.rows)).equals(bits(theirs))


def test_visibility_is_that_of_the_command(command):
    name = boresight.requirement_names()[0]
    assert boresight.visibility(name, frames=0) == json.loads(command("visibility", name, "--frames", "0", "--json"))
