"""Scenarios and frames as objects."""

import gc
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import boresight


@pytest.fixture(scope="module")
def argon():
    return boresight.Scenario.load("argon")


def test_a_scenario_says_what_it_is(argon):
    assert (argon.name, argon.world, argon.seed, argon.frame_count) == ("argon", "far_range", 20120423, 16077)
    names = ["argon", "argon-numerical", "demo-docking", "demo-far-range", "docking", "middle-range", "starting-point"]
    assert boresight.Scenario.builtin_names() == names
    assert argon.setup["camera"]["columns"] == 752


def test_values_are_set_by_path_and_leave_the_first_scenario_alone(argon):
    other = argon.with_values({"sensor.gain_e_per_dn": np.float32(3), "seed": 7})
    assert (other.value("sensor.gain_e_per_dn"), other.seed) == (3.0, 7)
    assert argon.value("sensor.gain_e_per_dn") != 3.0
    assert argon.with_seed(7).seed == 7
    with pytest.raises(boresight.InputError, match="`seed` is -1, expected an integer"):
        argon.with_seed(-1)


def test_a_scenario_written_as_toml_is_the_same(argon, tmp_path):
    (tmp_path / "again.toml").write_text(argon.to_toml())
    again = boresight.Scenario.load(tmp_path / "again.toml")
    assert again.to_toml() == argon.to_toml()
    assert np.array_equal(again.frame(77).pixels, argon.frame(77).pixels)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"sensor.gain_e_per_dn": -3}, r"sensor\.gain_e_per_dn: is -3, expected 0\.05"),
        ({"sensor.gain_e_per_dn": "much"}, "expected a number"),
        ({"sensor.gainn": 1}, "unknown field `gainn`"),
        ({"nothing.here": 1}, "has no key `nothing`"),
        ({"schedule[99].count": 1}, "has 5 elements"),
        ({"sensor..gain": 1}, "expected a path of keys"),
        ({"seed": -1}, "`seed` is -1"),
        ({"psf.sigma_px": float("nan")}, "`psf.sigma_px` is nan"),
        ({3: 1}, "expected paths as keys"),
    ],
)
def test_a_wrong_value_is_told_with_its_path(argon, values, told):
    with pytest.raises(boresight.InputError, match=told):
        argon.with_values(values)


def test_a_scenario_that_is_not_there_is_told():
    with pytest.raises(ValueError, match="did you mean `argon`"):
        boresight.Scenario.load("argn")
    with pytest.raises(boresight.InputError, match="expected text or a path"):
        boresight.Scenario.load(3)


def test_pixels_own_their_memory_and_outlive_the_frame(argon):
    frame = argon.frame(9000)
    pixels = frame.pixels
    assert (pixels.dtype, pixels.shape, pixels.flags.c_contiguous) == (np.uint16, (580, 752), True)
    assert frame.pixels is pixels, "one array, not a copy each time"
    before = pixels.copy()
    del frame
    gc.collect()
    assert np.array_equal(pixels, before)


def test_a_frame_alone_is_that_of_a_stream(argon):
    frames = list(argon.frames(range(8000, 8005), jobs=2))
    assert [frame.number for frame in frames] == [8000, 8001, 8002, 8003, 8004]
    alone = argon.frame(8003)
    assert np.array_equal(alone.pixels, frames[3].pixels)
    assert alone.telemetry.q_sc_j2000 == frames[3].telemetry.q_sc_j2000
    assert alone.truth == frames[3].truth


@pytest.mark.parametrize("number", [-1, 16077])
def test_a_frame_that_there_is_not_is_told(argon, number):
    with pytest.raises(boresight.InputError, match=f"`number` is {number}, expected a frame of the scenario, 0 to 16076"):
        argon.frame(number)


def test_the_truth_is_that_of_the_image(argon):
    """The brightest pixel of a frame lies at the true position of its target, which is bright and isolated.
    """
    frame = argon.frame(8001)
    objects = frame.objects
    assert objects["kind"][0] == "target"
    y, x = np.unravel_index(frame.expected.argmax(), frame.expected.shape)
    assert abs(objects["x_px"][0] - x) < 1 and abs(objects["y_px"][0] - y) < 1
    assert frame.expected.sum() > objects["electrons"].sum()
    assert frame.truth["exposure_s"] == frame.telemetry.exposure_s


@pytest.mark.parametrize("frames", [range(5, 5), range(10, 0), range(0, 10, 2), range(0, 10**6), (0, 4), 7, "0..4", range(-1, 4)])
def test_a_range_that_is_none_is_refused(argon, frames):
    with pytest.raises(boresight.InputError, match="expected a non-empty range of step 1"):
        argon.frames(frames)


def makers():
    """Threads of this process that make frames, by their names (Linux keeps 15 characters of them)."""
    names = (path.read_text().strip() for path in Path("/proc/self/task").glob("*/comm"))
    return sum(name == "boresight frame" for name in names)


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted in /proc")
def test_threads_of_a_stream_that_nobody_reads_on_end(argon):
    stream = argon.frames()
    next(stream)
    assert makers() >= 1
    del stream
    begun = time.monotonic()
    # The batch that is being made is made to its end.
    while makers() and time.monotonic() - begun < 30:
        time.sleep(0.05)
    assert makers() == 0


def test_python_runs_while_frames_are_made(argon):
    """The interpreter's lock is free: another thread counts while this one waits for frames. With the lock
    held, it would run once or twice a frame."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    other = threading.Thread(target=count)
    other.start()
    try:
        start = counted[0]
        for frame in argon.frames(range(8000, 8060), jobs=1):
            del frame
        assert counted[0] - start > 10 * 60
    finally:
        stop.set()
        other.join()


def test_docking_has_fields(argon):
    docking = boresight.Scenario.load("docking")
    field = docking.frame(24000)
    assert (field.pixels.shape, field.lines, field.bit_depth) == ((288, 768), "even", 8)
    assert field.telemetry.time_s == field.truth["time_s"]
    with pytest.raises(boresight.InputError, match="expected a frame of the far range"):
        field.expected
