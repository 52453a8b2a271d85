"""Stubs of the extension. Docstrings appear in `help(boresight.Scenario)`; frames, pixels, units and time:
CONVENTIONS.md.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias, final, overload

import numpy as np
from numpy.typing import NDArray
from typing_extensions import disjoint_base

from boresight.answers import Detection, NoSolution, Pose, RangeOnly
from boresight.scores import Score

__all__ = [
    "FieldTelemetry",
    "Frame",
    "FrameStream",
    "Navigation",
    "Run",
    "Scenario",
    "SimulatedFrame",
    "StudyResult",
    "Table",
    "Telemetry",
    "__version__",
    "command",
    "navigate",
    "report",
    "requirement_names",
    "run",
    "score",
    "study",
    "visibility",
]

__version__: str

_Word: TypeAlias = str | PathLike[str]
_FarRange: TypeAlias = Callable[[Frame, Telemetry], Detection | NoSolution | Mapping[str, Any] | None]
_Docking: TypeAlias = Callable[[Frame, FieldTelemetry], Pose | RangeOnly | NoSolution | Mapping[str, Any] | None]
_Pipeline: TypeAlias = _FarRange | _Docking | Callable[[dict[str, Any]], _FarRange | _Docking]
"""A callable of (frame, telemetry), or a class that is made with the setup and whose instances are such
callables."""

_Progress: TypeAlias = bool | Callable[[int, int], object] | None
"""Display of progress: None, a bar in a notebook (with tqdm or ipywidgets) and on a terminal; True, on
standard error elsewhere too; False, none; or a function of (done, total)."""

_Answers: TypeAlias = Sequence[Mapping[str, Any] | str]
_Events: TypeAlias = list[dict[str, Any]]
_Navigator: TypeAlias = (
    Callable[[dict[str, Any], _Events, list[str]], _Answers]
    | Callable[[dict[str, Any]], Callable[[_Events, list[str]], _Answers]]
)
"""A function of (setup, events, times), or a class that is made with the setup and whose instances are
callables of (events, times)."""

@disjoint_base
class Frame:
    """Image as transmitted to the ground: the input of a pipeline."""

    @property
    def number(self) -> int:
        """Number of the frame (docking: of the field) in its scenario."""
    @property
    def bit_depth(self) -> int:
        """Bits of the converter: full scale is 2**bit_depth - 1."""
    @property
    def pixels(self) -> NDArray[np.uint16]:
        """Digital numbers, uint16 of shape (rows, columns); `pixels[y, x]`, the centre of the first pixel is
        x = 0, y = 0."""
    @property
    def windows(self) -> list[tuple[int, int, int, int]] | None:
        """Transmitted regions, each (x, y, columns, rows); all other pixels are 0 and carry no signal. None:
        the whole image was transmitted."""
    @property
    def lines(self) -> Literal["all", "even", "odd"] | None:
        """Docking: rows of the camera in the image: row k of the image is the camera's row k, 2k or 2k + 1.
        None in the far range."""

@final
class SimulatedFrame(Frame):
    """Frame with its telemetry and its truth. It can be passed to a pipeline as a `Frame`; a pipeline reads
    only the members of a `Frame`."""

    @property
    def telemetry(self) -> Telemetry | FieldTelemetry:
        """Telemetry passed to a pipeline with the frame: `Telemetry`, or `FieldTelemetry` of a docking field.
        """
    @property
    def truth(self) -> dict[str, Any]:
        """Truth of the frame, by the names of truth/frames.parquet (docking: truth/fields.parquet), units in
        the names."""
    @property
    def objects(self) -> Table:
        """Truth of every object in the frame: a table with the columns of truth/objects.parquet. Far range
        only."""
    @property
    def expected(self) -> NDArray[np.float64]:
        """Frame without noise: expected photoelectrons, dark current and hot pixels included, before
        saturation; float64 of shape (rows, columns). Computed at the first access. Far range only."""

@final
class Telemetry:
    """Measured data of the spacecraft beside a frame's pixels; not the truth."""

    @property
    def time_utc(self) -> str:
        """Middle of the exposure, UTC, ISO 8601 with nanoseconds."""
    @property
    def time(self) -> Any:
        """Middle of the exposure as `astropy.time.Time`, UTC. Raises `ImportError` if astropy is missing."""
    @property
    def exposure_s(self) -> float:
        """Exposure time, s."""
    @property
    def q_sc_j2000(self) -> tuple[float, float, float, float]:
        """Attitude of the spacecraft's body, (w, x, y, z), Hamilton, v_sc = q v_j2000 q*."""
    @property
    def v_orbital_j2000_km_s(self) -> tuple[float, float, float] | None:
        """Velocity about the Earth, km/s, along the axes of ICRS; None if unavailable. The Earth's velocity
        is not included."""

@final
class FieldTelemetry:
    """Telemetry of a docking field."""

    @property
    def time_s(self) -> float:
        """Middle of the field's exposure, s since the beginning of the sequence."""
    @property
    def camera(self) -> int:
        """Index of the field's camera in the setup, from 0."""
    @property
    def contrast(self) -> float:
        """Contrast of the digitiser, 0.1 to 20."""
    @property
    def brightness(self) -> float:
        """Brightness of the digitiser, -10 to 10, in units of full scale."""

@final
class FrameStream(Iterator[SimulatedFrame]):
    """Iterator of frames in order. Other threads make them, some ahead of the current one."""

    def __iter__(self) -> FrameStream: ...
    def __next__(self) -> SimulatedFrame: ...

@final
class Table:
    """Columns by name; polars, pandas and pyarrow take it by the Arrow C data interface."""

    @property
    def column_names(self) -> list[str]:
        """Names of the columns, in order."""
    @property
    def num_rows(self) -> int:
        """Number of rows."""
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, key: str, /) -> Any:
        """A column: a numpy array (NaN for missing values; times `datetime64[ns]`), or a list of texts."""
    @overload
    def __getitem__(self, key: slice, /) -> Table:
        """A table of some rows, as in `table[:2]`; the step is 1."""
    @overload
    def __getitem__(self, key: int, /) -> dict[str, Any]:
        """A row by column; an index below 0 counts from the end."""
    def time(self, column: str = "time_utc") -> Any:
        """A column of times as `astropy.time.Time`, UTC, with nanoseconds. Raises `ImportError` if astropy is
        missing, and `InputError` for a column of other values."""
    def to_dict(self) -> dict[str, Any]:
        """All columns by name."""
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> Any: ...
    def __arrow_c_schema__(self) -> Any: ...

@final
class Scenario:
    """Scenario to simulate: a built-in one or a TOML file, with all its values checked."""

    @staticmethod
    def load(scenario: _Word) -> Scenario:
        """Reads a built-in scenario by its name, a TOML file, or the `run.toml` of a run to repeat.

        Raises `InputError` with line and column of the first mistake.
        """
    @staticmethod
    def from_case(study: _Word, case: int) -> Scenario:
        """Returns the scenario of a case of a study (docs/studies.md), with the values and the seed drawn for
        it.

        `study` is the study's file. Raises `InputError` for a case outside the study.
        """
    @staticmethod
    def builtin_names() -> list[str]:
        """Names of the built-in scenarios."""
    @property
    def name(self) -> str:
        """Name of the scenario."""
    @property
    def title(self) -> str:
        """Title of the scenario, one line."""
    @property
    def world(self) -> Literal["far_range", "docking"]:
        """World of the scenario."""
    @property
    def seed(self) -> int:
        """Seed of every random draw."""
    @property
    def frame_count(self) -> int:
        """Number of frames (docking: fields)."""
    @property
    def setup(self) -> dict[str, Any]:
        """Setup passed to a pipeline before the first frame: camera, mounting and star list (docking: cameras
        and target). Its keys are those of the greeting in docs/external-pipeline.md."""
    def with_values(self, values: dict[str, Any]) -> Scenario:
        """Returns a scenario with other values, by their paths: `{"sensor.gain_e_per_dn": 3.0,
        "schedule[0].count": 100}`.

        Raises `InputError` for a path that does not exist, and for a value outside its range.
        """
    def with_seed(self, seed: int) -> Scenario:
        """Returns a scenario with another seed, 0 to 2**63 - 1: other noise, unchanged sky."""
    def value(self, path: str) -> Any:
        """Value at a path, as in `sensor.gain_e_per_dn`; tables are dictionaries, omitted values None."""
    def to_toml(self) -> str:
        """Text of a scenario file with all values, defaults included."""
    def frame(self, number: int) -> SimulatedFrame:
        """Makes one frame, with the bits of a whole run."""
    def wcs(self, number: int) -> Any:
        """World coordinates of a frame as an `astropy.wcs.WCS`: the cards of the frame's FITS file, TAN-SIP,
        from astrometric ICRS coordinates to pixels, with aberration and distortion, made from the truth.

        Pixels are those of the package with `origin=0`, and of `world_to_pixel`: the centre of the first
        pixel is x = 0, y = 0. Far range only. Raises `ImportError` if astropy is missing, and `InputError`
        for a camera whose distortion no SIP polynomial follows to the corners.
        """
    def frames(self, frames: range | None = None, *, jobs: int | None = None) -> FrameStream:
        """Makes frames, in order, on `jobs` threads (1 to 1024; default: all cores) ahead of the caller.

        `frames` is a `range` of step 1; default: all frames.
        """

@final
class Run:
    """Result of a run: score, truth and measurements."""

    @staticmethod
    def load(directory: _Word) -> Run:
        """Opens the directory of a run."""
    @property
    def directory(self) -> Path:
        """Directory of the run."""
    @property
    def score(self) -> Score:
        """score.json, described in docs/score.md: a dictionary that is displayed as a table. Rates are 0 to 1;
        each figure has its count and its 95 % interval."""
    @property
    def first_failure(self) -> tuple[int, str] | None:
        """First failure of the pipeline, (frame, reason); None if it never failed, or for a loaded run."""
    @property
    def truth_frames(self) -> Table:
        """Truth of each frame: truth/frames.parquet (docking: truth/fields.parquet)."""
    @property
    def truth_objects(self) -> Table:
        """Truth of each object in each frame: truth/objects.parquet. Far range only."""
    @property
    def measurements(self) -> Table:
        """Outcomes of the pipeline: measurements.csv."""
    @property
    def telemetry(self) -> Table:
        """Telemetry of each frame: telemetry.csv."""
    @property
    def clusters(self) -> Table:
        """Class that the pipeline assigned to each cluster: clusters.parquet. Far range only."""
    @property
    def motion(self) -> Table:
        """Motion that the pipeline reported at the end of each portion: motion.csv. Docking only."""

@final
class StudyResult:
    """Result of a study: its summary, and a row per case."""

    @property
    def directory(self) -> Path:
        """Directory of the study."""
    @property
    def summary(self) -> dict[str, Any]:
        """Figures with intervals, sensitivities, the worst cases: the dictionary of summary.json
        (docs/studies.md)."""
    @property
    def first_failure(self) -> tuple[int, int, str] | None:
        """First failure of the pipeline among the cases of this call, (case, frame, reason); None if it never
        failed."""
    @property
    def rows(self) -> Table:
        """A row per case: `case`, `seed`, `set.PATH` for drawn values, and NAME, NAME.count, NAME.of for each
        figure."""

@final
class Navigation:
    """Result of a navigation: figures, and an estimate at each time."""

    @property
    def directory(self) -> Path:
        """Directory of navigation.csv and navigation.json."""
    @property
    def figures(self) -> dict[str, Any]:
        """Figures: navigation.json, described in docs/score.md."""
    @property
    def estimates(self) -> Table:
        """Estimate, error and σ at each time: navigation.csv."""

def navigate(
    run: Run | _Word,
    *,
    navigator: _Navigator | str | None = None,
    every_s: float = 600.0,
    prior: bool = True,
    out: _Word | None = None,
    timeout_s: float = 60.0,
) -> Navigation:
    """Determines the relative orbit from the lines of sight of a far-range run, and compares it with the
    truth, with the numbers of the command `boresight navigate`.

    `run`: a `Run` or its directory. `every_s`: interval of the estimates, s. `prior`: False for a navigation
    without a prior. `out`: directory for navigation.csv and navigation.json, which must not exist there.
    `timeout_s`: longest time that an `exec:` navigator may take for a request, s.

    `navigator` is `batch`, `sequential`, `exec:COMMAND`, a function of (setup, events, times), which receives
    all events, or a class that is made with the setup and whose instances are callables of (events, times):
    the events since the previous call, and the times of the requested estimates. A class with `mode =
    "sequential"` is called for each time in turn. Setup and events are dictionaries with the keys of
    docs/navigation.md. The answer is a list with an entry for each time: a dictionary with the keys of that
    page, or the reason for no estimate as text. An `Exception` becomes the reason of all times of the call;
    other exceptions (Ctrl-C) end the navigation.
    """

def run(
    scenario: Scenario | _Word,
    *,
    frames: range | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    out: _Word | None = None,
    timeout_s: float = 10.0,
    progress: _Progress = None,
) -> Run:
    """Makes frames, processes them by a pipeline, and scores the outcomes, with the numbers of the command
    `boresight run`.

    `scenario`: a scenario, the name of a built-in one, or the path of a TOML file. `frames`: a `range` of
    step 1; default: all frames (docking: fields). `jobs`: threads that make frames, 1 to 1024; default: all
    cores. The results do not depend on it. `out`: a new or empty directory that keeps the run. `timeout_s`:
    longest time that an `exec:` pipeline may take for a frame, s.

    `pipeline` is None (the built-in one), `exec:COMMAND`, a callable of (frame, telemetry), or a class that
    is made with the setup and whose instances are such callables. A callable returns `Detection`,
    `NoSolution`, None (no target) or a dictionary with the keys of docs/external-pipeline.md; in docking
    `Pose`, `RangeOnly`, `NoSolution` or None. An `Exception` becomes the outcome of its frame, with its
    message; other exceptions (Ctrl-C) end the run.

    `progress`: None shows a bar in a notebook (with tqdm or ipywidgets) and on a terminal; True shows it on
    standard error elsewhere too, False nowhere; a function of (done, total) is called instead.
    """

def report(
    results: Run | StudyResult | _Word, out: _Word | None = None, *, measurements: _Word | None = None
) -> Path:
    """Writes the report of results as one HTML file, as the command `boresight report` does, and returns its
    path.

    `results` is a `Run`, a `StudyResult`, or the directory of a run, of a study, of a processed dataset or of
    `boresight visibility --out`. `out` is the file, which replaces an earlier report and no other file;
    default: `report.html` in the directory. `measurements` is a file of measurements on the frames of the
    directory, in place of its `measurements.csv`; it needs `out`.
    """

def score(
    truth: Run | _Word,
    measurements: _Word | Table | Mapping[str, Sequence[Any]] | Any,
    *,
    attitude: Literal["telemetry", "true"] | None = None,
) -> Score:
    """Scores measurements against the truth, as the command `boresight score` does.

    `truth` is a `Run`, or the directory of a run or of a rendered dataset. `measurements` is a file, or a
    table: of boresight, polars, pandas or pyarrow, or a dictionary of columns. Its columns are those of
    measurements.csv (docs/formats.md), with the units of their names (px, degrees, m); `frame`, `status`,
    `x_px`, `y_px` are enough (docking: `field`, `status`, `d1_m` ... `phi3_deg`). A frame of the truth
    without a row is a miss. Beside a file, `clusters.parquet` (docking: `motion.csv`) is read too: evidence
    for the causes of misses. `attitude`, `telemetry` or `true`, turns centroids without a line of sight into
    one. Returns score.json: a dictionary that is displayed as a table.
    """

def study(
    path: _Word,
    *,
    out: _Word | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    timeout_s: float = 10.0,
    progress: _Progress = None,
) -> StudyResult:
    """Runs the missing cases of a study and summarises it, as the command `boresight study run` does.

    `path` is the study's file (docs/studies.md). `out` keeps the results, and a later call runs only missing
    cases. Without it they are in a temporary directory that is deleted with the object. `jobs`: threads that
    make frames, 1 to 1024; default: all cores. `timeout_s`: longest time that an `exec:` pipeline may take
    for a frame, s.

    `pipeline` is None (the built-in one), `exec:COMMAND`, a callable of (frame, telemetry), or a class of
    them, as in `run`. Cases run side by side, and call it one at a time: a class is made anew for every case,
    with the case's setup; a function is called for frames of several cases in turn, and must keep no state.
    An exception becomes the outcome of its frame.

    `progress`: None shows a bar in a notebook (with tqdm or ipywidgets) and on a terminal; True shows it on
    standard error elsewhere too, False nowhere; a function of (done, total) is called instead.
    """

def visibility(requirement: _Word, *, frames: int | None = None, jobs: int | None = None) -> dict[str, Any]:
    """Returns the requirements that a camera meets, and the exposure (s), aperture (mm) or focal length (mm)
    that meets them, as the command `boresight visibility` does: the dictionary that it prints with `--json`
    (docs/visibility.md).

    `requirement` is the name of a built-in requirement file or the path of one; `frames` are simulated for
    each result, 0 (none) to 100000, instead of the file's number. `jobs`: threads, 1 to 1024; default: all
    cores.
    """

def requirement_names() -> list[str]:
    """Names of the built-in requirement files."""

def command(words: Sequence[str]) -> int:
    """Runs the command `boresight` with the words after its name, and returns its exit status: 0 success, 1
    negative result, 2 usage error or invalid input. Python handles no signal meanwhile: `python -m boresight`
    leaves them to the system."""
