"""The library behind the package. Docstrings are those of `help(boresight.Scenario)`; units and frames: CONVENTIONS.md."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

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
    "requirement_names",
    "run",
    "score",
    "study",
    "visibility",
]

__version__: str

_Word: TypeAlias = str | PathLike[str]
_Answer: TypeAlias = Detection | NoSolution | Pose | RangeOnly | Mapping[str, Any] | None
_Pipeline: TypeAlias = Callable[[Frame, Any], _Answer] | type
"""A callable of (frame, telemetry), or a class made with the setup whose instances are one."""

class Frame:
    """An image as it arrives on the ground: what a pipeline sees."""

    @property
    def number(self) -> int:
        """Number of the frame (docking: of the field) in its scenario."""
    @property
    def bit_depth(self) -> int:
        """Bits of the converter."""
    @property
    def pixels(self) -> NDArray[np.uint16]:
        """Digital numbers, shape (rows, columns)."""
    @property
    def windows(self) -> list[tuple[int, int, int, int]] | None:
        """Transmitted regions, (x, y, columns, rows); None: the whole image."""
    @property
    def lines(self) -> Literal["all", "even", "odd"] | None:
        """Docking: which rows of the camera these are."""

@final
class SimulatedFrame(Frame):
    """A frame with its telemetry and its truth."""

    @property
    def telemetry(self) -> Any:
        """`Telemetry`, or `FieldTelemetry` of a docking field."""
    @property
    def truth(self) -> dict[str, Any]:
        """The truth about the frame, by the names of truth/frames.parquet."""
    @property
    def objects(self) -> Table:
        """The truth about every object in it; far range alone."""
    @property
    def expected(self) -> NDArray[np.float64]:
        """Expected photoelectrons without noise, shape (rows, columns); far range alone."""

@final
class Telemetry:
    """What the spacecraft tells about a frame: measured, not the truth."""

    @property
    def time_utc(self) -> str:
        """Middle of the exposure, ISO 8601."""
    @property
    def exposure_s(self) -> float:
        """Exposure time, s."""
    @property
    def q_sc_j2000(self) -> tuple[float, float, float, float]:
        """Attitude of the body, (w, x, y, z)."""
    @property
    def v_orbital_j2000_km_s(self) -> tuple[float, float, float] | None:
        """Velocity about the Earth, km/s."""

@final
class FieldTelemetry:
    """What is known of a docking field besides its pixels."""

    @property
    def time_s(self) -> float:
        """Seconds since the beginning of the sequence."""
    @property
    def camera(self) -> int:
        """Which of the setup's cameras, from 0."""
    @property
    def contrast(self) -> float:
        """Contrast of the digitiser."""
    @property
    def brightness(self) -> float:
        """Brightness of the digitiser, in units of full scale."""

@final
class FrameStream(Iterator[SimulatedFrame]):
    """Frames in order, made on other threads."""

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
        """Reads a built-in scenario, a TOML file, or the `run.toml` of a run."""
    @staticmethod
    def of_case(study: _Word, case: int) -> Scenario:
        """The scenario of a case of a study."""
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
        """What a pipeline is told before the first frame."""
    def with_values(self, values: dict[str, Any]) -> Scenario:
        """The same scenario with other values, by their paths."""
    def with_seed(self, seed: int) -> Scenario:
        """The same scenario with another seed."""
    def value(self, path: str) -> Any:
        """The value at a path."""
    def to_toml(self) -> str:
        """All its values with all defaults, as a file that can be run."""
    def frame(self, number: int) -> SimulatedFrame:
        """Makes one frame."""
    def frames(self, frames: range | None = None, *, jobs: int | None = None) -> FrameStream:
        """Makes frames, in order, on `jobs` threads."""

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
        """score.json."""
    @property
    def first_failure(self) -> tuple[int, str] | None:
        """The first failure of the pipeline: (frame, reason)."""
    @property
    def truth_frames(self) -> Table:
        """The truth about each frame."""
    @property
    def truth_objects(self) -> Table:
        """The truth about each object in each frame; far range alone."""
    @property
    def measurements(self) -> Table:
        """The pipeline's answers."""
    @property
    def telemetry(self) -> Table:
        """What a pipeline may know of each frame."""
    @property
    def clusters(self) -> Table:
        """What the pipeline took each cluster for; far range alone."""
    @property
    def motion(self) -> Table:
        """What the pipeline said at the end of each portion; docking alone."""

@final
class StudyResult:
    """What a study gave: its summary, and a row a case."""

    @property
    def directory(self) -> Path:
        """The directory of the study."""
    @property
    def summary(self) -> dict[str, Any]:
        """summary.json."""
    @property
    def first_failure(self) -> tuple[int, int, str] | None:
        """The first failure of the pipeline: (case, frame, reason)."""
    @property
    def rows(self) -> Table:
        """A row a case."""

def run(
    scenario: Scenario | _Word,
    *,
    frames: range | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    out: _Word | None = None,
    timeout_s: float = 10.0,
) -> Run:
    """Makes frames, has a pipeline process them, and scores its answers."""

def score(truth: Run | _Word, measurements: _Word | Table | Mapping[str, Sequence[Any]] | Any) -> dict[str, Any]:
    """Scores measurements against the truth."""

def study(
    path: _Word,
    *,
    out: _Word | None = None,
    pipeline: _Pipeline | str | None = None,
    jobs: int | None = None,
    timeout_s: float = 10.0,
) -> StudyResult:
    """Runs what is missing of a study and sums it up."""

def visibility(requirement: _Word, *, frames: int | None = None, jobs: int | None = None) -> dict[str, Any]:
    """Says which requirements a camera meets, and what would meet them."""

def requirement_names() -> list[str]:
    """Names of the built-in requirement files."""
