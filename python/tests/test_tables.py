"""Tables for polars, pandas and pyarrow, and tables from them."""

import shutil

import numpy as np
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pytest

import boresight


@pytest.fixture(scope="module")
def run():
    return boresight.run("argon", frames=range(8000, 8040))


def test_every_library_reads_the_same(run):
    truth = run.truth_objects
    ours = truth["electrons"]
    assert np.array_equal(polars.DataFrame(truth)["electrons"].to_numpy(), ours)
    assert np.array_equal(pyarrow.table(truth)["electrons"].to_numpy(), ours)
    assert np.array_equal(pandas.DataFrame.from_arrow(truth)["electrons"].to_numpy(), ours)
    assert len(truth) == truth.num_rows == len(ours)
    assert truth.column_names[:3] == ["frame", "kind", "id"]


def test_columns_have_numpy_types_and_nan_where_nothing_is(run):
    measured, truth = run.measurements, run.truth_frames
    assert measured["frame"].dtype == np.uint64
    missing = np.array([status != "detected" for status in measured["status"]])
    assert np.array_equal(np.isnan(measured["x_px"]), missing)
    assert truth["time_utc"].dtype == "datetime64[ns]"
    with pytest.raises(KeyError, match="no column `x`; available columns: frame"):
        measured["x"]


def test_rows_are_sliced_and_indexed_like_those_of_a_list(run):
    measured = run.measurements
    frames = list(measured["frame"])
    for rows in (slice(2), slice(-3, None), slice(5, 5), slice(38, 99), slice(None)):
        part = measured[rows]
        assert isinstance(part, boresight.Table) and list(part["frame"]) == frames[rows]
    assert measured[0]["frame"] == 8000 and measured[-1]["frame"] == frames[-1]
    assert measured[:3][2] == measured[2]
    assert polars.DataFrame(measured[1:3])["frame"].to_list() == frames[1:3]
    with pytest.raises(ValueError, match="the step of the slice is 2, expected 1"):
        measured[::2]
    with pytest.raises(IndexError, match="row 40 of a table of 40 rows"):
        measured[40]
    with pytest.raises(TypeError, match="the name of a column"):
        measured[1.5]


def test_a_table_outlives_its_run():
    table = boresight.run("argon", frames=range(8000, 8002)).truth_objects
    frame = polars.DataFrame(table)
    del table
    assert frame["frame"].to_list()[0] == 8000


def test_tables_of_every_library_have_one_score(run):
    measured = run.measurements
    tables = [
        measured,
        polars.DataFrame(measured),
        pyarrow.table(measured),
        pandas.DataFrame.from_arrow(measured),
        measured.to_dict(),
        run.directory / "measurements.csv",
    ]
    for table in tables:
        assert boresight.score(run, table)["figures"] == run.score["figures"], type(table)


@pytest.mark.parametrize("library", ["polars", "pyarrow"])
def test_truth_that_another_library_wrote_gives_the_same_score(run, tmp_path, library):
    theirs = shutil.copytree(run.directory, tmp_path / "theirs")
    (theirs / "SHA256SUMS").unlink()
    path = theirs / "truth/objects.parquet"
    if library == "polars":
        polars.read_parquet(path).write_parquet(path, compression="snappy")
    else:
        table = pyarrow.parquet.read_table(path)
        kinds = table["kind"].dictionary_encode()
        pyarrow.parquet.write_table(table.set_column(1, "kind", kinds), path, data_page_version="2.0")
    assert boresight.score(theirs, run.measurements)["figures"] == run.score["figures"]


def test_four_columns_are_enough_and_a_frame_without_a_row_is_a_miss(run):
    score = boresight.score(run.directory, {"frame": [8001], "status": ["detected"], "x_px": [353.2], "y_px": [309.0]})
    assert (score["frames"], score["figures"]["hit_rate"]["count"]) == (40, 1)


def test_a_place_has_a_line_of_sight_by_the_attitude_that_is_asked_for(run):
    places = {"frame": [8001], "status": ["detected"], "x_px": [353.2], "y_px": [309.0]}
    for attitude in (None, "telemetry", "true"):
        score = boresight.score(run.directory, places, attitude=attitude)
        assert score["attitude"] == (attitude or "none")
        assert score["figures"]["ra_rms_deg"]["of"] == (0 if attitude is None else 1)
        assert abs(score["figures"]["centroid_x_mean_px"]["value"]) < 1.5
    with pytest.raises(boresight.InputError, match="`attitude` is `own`, expected `telemetry` or `true`"):
        boresight.score(run.directory, places, attitude="own")


@pytest.mark.parametrize(
    ("measurements", "told"),
    [
        ({"frame": [8000], "status": ["detected"], "x_px": [1.0]}, "measurements: column `y_px` is missing"),
        ({"frame": [8000], "status": ["detected"], "x_px": ["here"], "y_px": [1]}, "line 2: `x_px` is `here`, expected a finite number"),
        ({"frame": [7], "status": ["no_target"], "x_px": [None], "y_px": [None]}, "`frame` is `7`, expected a frame of"),
        ({"frame": [8000, 8001], "status": ["no_target"], "x_px": [], "y_px": []}, "expected columns of one length"),
        (7, "of type int, expected a file, a table"),
    ],
)
def test_a_wrong_table_is_told_by_row_and_column(run, measurements, told):
    with pytest.raises(boresight.InputError, match=told):
        boresight.score(run, measurements)


def test_what_is_no_run_is_told(tmp_path):
    with pytest.raises(boresight.InputError, match="expected the directory of a run"):
        boresight.score(tmp_path, tmp_path / "measurements.csv")
    with pytest.raises(boresight.FileError, match=r"run\.toml is missing"):
        boresight.Run.load(tmp_path)


def test_a_run_that_was_changed_since_is_refused(run, tmp_path):
    changed = tmp_path / "run"
    shutil.copytree(run.directory, changed)
    table = changed / "telemetry.csv"
    table.write_text(table.read_text().replace(",0.", ",1.", 1))
    for read in (lambda: boresight.Run.load(changed), lambda: boresight.score(changed, run.measurements)):
        with pytest.raises(boresight.InputError, match="SHA-256"):
            read()
