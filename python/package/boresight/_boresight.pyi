"""The library behind the package. Docstrings are those of `help(boresight.Scenario)`; frames, pixels, units and time: CONVENTIONS.md."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray
from typing_extensions import disjoint_base

from boresight.answers import Detection, NoSolution, Pose, RangeOnly

__all__ = [
    "FieldTelemetry",
    "Frame",
    "FrameStream",
    "Run",
    "Scenario",
    "SimulatedFrame",
    "StudyResult",
    "Table",
    "Telemetry",
    "__version__",
    "command",
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
"""A callable of (frame, telemetry), or a class that is made with the setup and whose instances are one."""

@disjoint_base
class Frame:
    """An image as it arrives on the ground: what a pipeline sees."""

    @property
    def number(self) -> int:
        """Number of the frame (docking: of the field) in its scenario."""
    @property
    def bit_depth(self) -> int:
        """Bits of the converter: full scale is 2**bit_depth - 1."""
    @property
    def pixels(self) -> NDArray[np.uint16]:
        """Digital numbers, uint16 of shape (rows, columns); `pixels[y, x]`, the centre of the first pixel is x = 0, y = 0."""
    @property
    def windows(self) -> list[tuple[int, int, int, int]] | None:
        """The regions that were transmitted, each (x, y, columns, rows); all other pixels are 0 and mean nothing. None: the whole image was."""
    @property
    def lines(self) -> Literal["all", "even", "odd"] | None:
        """Docking: which rows of the camera these are: row k of the image is the camera's row k, 2k or 2k + 1. None in the far range."""

@final
class SimulatedFrame(Frame):
    """A frame with its telemetry and its truth. As a `Frame` it can be given to a pipeline, which looks at no more than a `Frame` has."""

    @property
    def telemetry(self) -> Telemetry | FieldTelemetry:
        """What a pipeline is told beside the frame: `Telemetry`, or `FieldTelemetry` of a docking field."""
    @property
    def truth(self) -> dict[str, Any]:
        """The truth about the frame, by the names of truth/frames.parquet (docking: truth/fields.parquet), units in the names."""
    @property
    def objects(self) -> Table:
        """The truth about every object in the frame: a table with the columns of truth/objects.parquet. Far range alone."""
    @property
    def expected(self) -> NDArray[np.float64]:
        """The frame without noise: expected photoelectrons, dark current and hot pixels included, before saturation; float64 of shape (rows,
        columns). Made when it is first asked for. Far range alone."""

@final
class Telemetry:
    """What the spacecraft tells about a frame besides its pixels: measured, not the truth."""

    @property
    def time_utc(self) -> str:
        """Middle of the exposure, UTC, ISO 8601 with nanoseconds."""
    @property
    def exposure_s(self) -> float:
        """Exposure time, s."""
    @property
    def q_sc_j2000(self) -> tuple[float, float, float, float]:
        """Attitude of the spacecraft's body, (w, x, y, z), Hamilton, v_sc = q v_j2000 q*."""
    @property
    def v_orbital_j2000_km_s(self) -> tuple[float, float, float] | None:
        """Velocity about the Earth, km/s, along the axes of ICRS; None when it is not known. The Earth's own is not in it."""

@final
class FieldTelemetry:
    """What is known of a docking field besides its pixels."""

    @property
    def time_s(self) -> float:
        """Middle of the field's exposure, s since the beginning of the sequence."""
    @property
    def camera(self) -> int:
        """Which of the setup's cameras took it, from 0."""
    @property
    def contrast(self) -> float:
        """Contrast of the digitiser, 0.1 to 20."""
    @property
    def brightness(self) -> float:
        """Brightness of the digitiser, -10 to 10, in units of full scale."""

@final
class FrameStream(Iterator[SimulatedFrame]):
    """Frames in order, an iterator. They are made on other threads, some ahead of the one that is taken."""

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
    def __getitem__(self, key: str, /) -> Any:
        """A numpy array (NaN where there is no value; times `datetime64[ns]`), or a list of words."""
    def to_dict(self) -> dict[str, Any]:
        """All columns by name."""
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> Any: ...
    def __arrow_c_schema__(self) -> Any: ...

@final
class Scenario:
    """What to simulate: a built-in scenario or a TOML file, with all its values checked."""

    @staticmethod
    def load(scenario: _Word) -> Scenario:
        """Reads a built-in scenario by its name, a TOML file, or the `run.toml` of a run to be repeated.

        Raises `InputError` with line and column of the first mistake.
        """
    @staticmethod
    def of_case(study: _Word, case: int) -> Scenario:
        """The scenario of a case of a study (docs/studies.md), with the values and the seed that were drawn for it.

        `study` is the study's file. Raises `InputError` for a case that the study does not have.
        """
    @staticmethod
    def builtin_names() -> list[str]:
        """Names of the built-in scenarios."""
    @property
    def name(self) -> str:
        """Name of the scenario."""
    @property
    def title(self) -> str:
        """What it is, in one line."""
    @property
    def world(self) -> Literal["far_range", "docking"]:
        """Which of the two worlds it is of."""
    @property
    def seed(self) -> int:
        """Seed of every random draw."""
    @property
    def frame_count(self) -> int:
        """Number of its frames (docking: fields)."""
    @property
    def setup(self) -> dict[str, Any]:
        """What a pipeline is told before the first frame: camera, mounting and star list (docking: cameras and target). Its keys are those of
        the greeting in docs/external-pipeline.md."""
    def with_values(self, values: dict[str, Any]) -> Scenario:
        """The same scenario with other values, by their paths: `{"sensor.gain_e_per_dn": 3.0, "schedule[0].count": 100}`.

        Raises `InputError` for a path that there is not, and for a value outside its range.
        """
    def with_seed(self, seed: int) -> Scenario:
        """The same scenario with another seed, 0 to 2**63 - 1: other noise, the same sky."""
    def value(self, path: str) -> Any:
        """The value at a path, as in `sensor.gain_e_per_dn`; tables as dictionaries, None for what the scenario leaves out."""
    def to_toml(self) -> str:
        """All its values with all defaults, as a file that can be run."""
    def frame(self, number: int) -> SimulatedFrame:
        """Makes one frame: the same bits as in a whole run."""
    def frames(self, frames: range | None = None, *, jobs: int | None = None) -> FrameStream:
        """Makes frames, in order, on `jobs` threads (1 to 1024; default: all cores) while the caller works on those before.

        `frames` is a `range` of step 1; all frames without one.
        """

@final
class Run:
    """What a run gave: score, truth and measurements."""

    @staticmethod
    def load(directory: _Word) -> Run:
        """Opens the directory of a run."""
    @property
    def directory(self) -> Path:
        """The directory of the run."""
    @property
    def score(self) -> dict[str, Any]:
        """score.json, described in docs/score.md. Rates are 0 to 1, each figure has its count and its 95 % interval."""
    @property
    def first_failure(self) -> tuple[int, str] | None:
        """The first failure of the pipeline, (frame, reason); None if it never failed, or the run was loaded."""
    @property
    def truth_frames(self) -> Table:
        """The truth about each frame: truth/frames.parquet (docking: truth/fields.parquet)."""
    @property
    def truth_objects(self) -> Table:
        """The truth about each object in each frame: truth/objects.parquet. Far range alone."""
    @property
    def measurements(self) -> Table:
        """The pipeline's answers: measurements.csv."""
    @property
    def telemetry(self) -> Table:
        """What a pipeline may know of each frame beside its pixels: telemetry.csv."""
    @property
    def clusters(self) -> Table:
        """What the pipeline took each cluster for: clusters.parquet. Far range alone."""
    @property
    def motion(self) -> Table:
        """What the pipeline said at the end of each portion: motion.csv. Docking alone."""

@final
class StudyResult:
    """What a study gave: its summary, and a row a case."""

    @property
    def directory(self) -> Path:
        """The directory of the study."""
    @property
    def summary(self) -> dict[str, Any]:
        """Figures with intervals, sensitivities, the worst cases: the dictionary of summary.json (docs/studies.md)."""
    @property
    def first_failure(self) -> tuple[int, int, str] | None:
        """The first failure of the pipeline among the cases that were run now, (case, frame, reason); None if it never failed."""
    @property
    def rows(self) -> Table:
        """A row a case: `case`, `seed`, `set.PATH` for what was drawn, and NAME, NAME.count, NAME.of for each figure."""

def run(
    scenario: Scenario | _Word,
    *,
    frames: range | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    out: _Word | None = None,
    timeout_s: float = 10.0,
) -> Run:
    """Makes frames, has a pipeline process them, and scores its answers, as the command `boresight run` does and with the same numbers.

    `scenario`: a scenario, the name of a built-in one, or the path of a TOML file. `frames`: a `range` of step 1; all frames (docking:
    fields) without one. `jobs`: threads that make frames, 1 to 1024; default: all cores. The results do not depend on it. `out`: a new or
    empty directory that keeps the run. `timeout_s`: longest time that an `exec:` pipeline may take for a frame, s.

    `pipeline` is None (the built-in one), `exec:COMMAND`, a callable of (frame, telemetry), or a class that is made with the setup and
    whose instances are such a callable. A callable returns `Detection`, `NoSolution`, None (no target) or a dictionary with the keys of
    docs/external-pipeline.md; in docking `Pose`, `RangeOnly`, `NoSolution` or None. Whatever it raises is the outcome of its frame, with
    its message; only what is no `Exception` (Ctrl-C) ends the run.
    """

def score(
    truth: Run | _Word,
    measurements: _Word | Table | Mapping[str, Sequence[Any]] | Any,
    *,
    attitude: Literal["telemetry", "true"] | None = None,
) -> dict[str, Any]:
    """Scores measurements against the truth, as the command `boresight score` does.

    `truth` is a `Run`, or the directory of a run or of a rendered dataset. `measurements` is a file, or a table: boresight's own, one of
    polars, pandas or pyarrow, or a dictionary of columns. Its columns are those of measurements.csv (docs/formats.md), px, degrees and m as
    their names say; `frame`, `status`, `x_px`, `y_px` are enough (docking: `field`, `status`, `d1_m` ... `phi3_deg`). A frame of the truth
    without a row is a miss. Of a file, `clusters.parquet` (docking: `motion.csv`) beside it is read too: evidence for the causes of misses.
    `attitude`, `telemetry` or `true`, turns centroids without a line of sight into one. Gives the dictionary of score.json.
    """

def study(
    path: _Word,
    *,
    out: _Word | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    timeout_s: float = 10.0,
) -> StudyResult:
    """Runs what is missing of a study and sums it up, as the command `boresight study run` does.

    `path` is the study's file (docs/studies.md). `out` keeps the results; run again with it, only what is missing is made. Without it they
    are in a temporary directory, gone with the object. `jobs`: threads that make frames, 1 to 1024; default: all cores. `timeout_s`: longest
    time that an `exec:` pipeline may take for a frame, s.

    `pipeline` is None (the built-in one), `exec:COMMAND`, a callable of (frame, telemetry), or a class of them, as in `run`. Cases run side
    by side, and call it one at a time: a class is made anew for every case, with the case's setup; a function is called for frames of
    several cases in turn, and must remember nothing. Whatever it raises is the outcome of its frame.
    """

def visibility(requirement: _Word, *, frames: int | None = None, jobs: int | None = None) -> dict[str, Any]:
    """Says which requirements a camera meets, and which exposure (s), aperture (mm) or focal length (mm) would, as the command `boresight
    visibility` does: the dictionary that it prints with `--json` (docs/visibility.md).

    `requirement` is the name of a built-in requirement file or the path of one; `frames` are simulated for each result, 0 (none) to 100000,
    instead of the file's number. `jobs`: threads, 1 to 1024; default: all cores.
    """

def requirement_names() -> list[str]:
    """Names of the built-in requirement files."""

def command(words: Sequence[str]) -> int:
    """Runs the command `boresight` with the words that follow its name, and gives its exit status: 0 done, 1 the answer is no, 2 usage or
    bad input. Python hears of no signal meanwhile: `python -m boresight` leaves them to the system.
    """
