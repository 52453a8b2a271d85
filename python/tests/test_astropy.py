"""World coordinates and times as objects of astropy."""

import sys

import numpy as np
import pytest
from astropy.time import Time

import boresight


@pytest.fixture(scope="module")
def argon():
    return boresight.Scenario.load("argon")


@pytest.fixture(scope="module")
def run(argon):
    return boresight.run(argon, frames=range(8000, 8005))


pytestmark = pytest.mark.filterwarnings("ignore::astropy.wcs.FITSFixedWarning")


def stars_of(objects, columns, rows):
    """RA and Dec, degrees, and position, px, of the stars on the detector."""
    x, y = objects["x_px"], objects["y_px"]
    on_detector = (x > -0.5) & (x < columns - 0.5) & (y > -0.5) & (y < rows - 0.5)
    found = on_detector & (np.array(objects["kind"]) == "star")
    return [objects[name][found] for name in ("ra_deg", "dec_deg", "x_px", "y_px")]


@pytest.mark.parametrize("number", [0, 8001, 16000])
def test_world_coordinates_give_the_pixels_of_the_stars_in_the_truth(argon, number):
    frame = argon.frame(number)
    rows, columns = frame.pixels.shape
    ra, dec, x, y = stars_of(frame.objects, columns, rows)
    assert len(ra) > 20
    wcs = argon.wcs(number)
    found = np.array(wcs.all_world2pix(ra, dec, 0, tolerance=1e-6))
    assert np.hypot(*(found - [x, y])).max() <= 0.02
    back = wcs.all_pix2world(x, y, 0)
    assert np.hypot((back[0] - ra) * np.cos(np.radians(dec)), back[1] - dec).max() * 3600 < 2


def test_the_cards_are_those_of_the_command(argon, command, tmp_path):
    from astropy.io import fits
    from astropy.wcs import WCS

    command("render", "argon", "--frames", "9000..9001", "--format", "fits", "--out", tmp_path / "fits")
    (path,) = (tmp_path / "fits").glob("frames/*.fits")
    header = fits.getheader(path)
    wcs = argon.wcs(9000)
    assert wcs.to_header_string(relax=True) == WCS(header).to_header_string(relax=True)
    assert (wcs.pixel_shape, wcs.sip.a_order) == ((752, 580), header["A_ORDER"])


def test_a_frame_without_world_coordinates_is_refused(argon):
    with pytest.raises(boresight.InputError, match="expected a frame of the far range"):
        boresight.Scenario.load("docking").wcs(0)
    with pytest.raises(boresight.InputError, match="no SIP polynomial"):
        argon.with_values({"camera.radial": [-4e-7, 0.0, 0.0]}).wcs(0)
    with pytest.raises(boresight.InputError, match="`number` is 16077"):
        argon.wcs(16077)


def test_times_keep_nanoseconds(argon, run):
    text = argon.frame(8000).telemetry.time_utc
    expected = Time(text.rstrip("Z"), format="isot", scale="utc")
    for time in (argon.frame(8000).telemetry.time, run.truth_frames.time()[0], run.telemetry.time()[0]):
        assert (time.scale, abs((time - expected).sec) < 1e-10) == ("utc", True)
    assert len(run.telemetry.time()) == 5
    assert np.allclose(np.diff(run.telemetry.time().unix), np.diff(run.truth_frames.time().unix))


def test_a_column_of_other_values_is_refused(run):
    with pytest.raises(boresight.InputError, match="`column` is frame, expected a column of times"):
        run.telemetry.time("frame")
    with pytest.raises(boresight.InputError, match="`column` is status, expected a column of times"):
        run.measurements.time("status")
    with pytest.raises(KeyError, match="time_utc"):
        run.measurements.time()


def test_a_missing_astropy_is_named_with_its_remedy(argon, run, monkeypatch):
    for module in [name for name in sys.modules if name.split(".")[0] == "astropy"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "astropy", None)
    with pytest.raises(ImportError, match="Scenario.wcs requires astropy: pip install astropy"):
        argon.wcs(0)
    with pytest.raises(ImportError, match="Table.time requires astropy: pip install astropy"):
        run.telemetry.time()
    with pytest.raises(ImportError, match="Telemetry.time requires astropy: pip install astropy"):
        argon.frame(0).telemetry.time
