"""Boresight: camera frames with known truth, and an oracle for the pipelines that process them.

    import boresight

    argon = boresight.Scenario.load("argon")
    for frame in argon.frames(range(8000, 8010)):
        print(frame.number, frame.pixels.mean(), frame.truth["target_x_px"])

    run = boresight.run(argon, frames=range(8000, 8100))
    print(run.score["figures"]["correct_rate"])

The numbers are those of the command `boresight`, bit for bit. docs/python.md describes the package,
CONVENTIONS.md frames, pixels, units and time.
"""

from boresight._boresight import (
    FieldTelemetry,
    Frame,
    FrameStream,
    Navigation,
    Run,
    Scenario,
    SimulatedFrame,
    StudyResult,
    Table,
    Telemetry,
    __version__,
    navigate,
    report,
    requirement_names,
    run,
    score,
    study,
    visibility,
)
from boresight.answers import Detection, NoSolution, Pose, RangeOnly
from boresight.errors import BoresightError, FileError, InputError
from boresight.scores import Score

__all__ = [
    "BoresightError",
    "Detection",
    "FieldTelemetry",
    "FileError",
    "Frame",
    "FrameStream",
    "InputError",
    "Navigation",
    "NoSolution",
    "Pose",
    "RangeOnly",
    "Run",
    "Scenario",
    "Score",
    "SimulatedFrame",
    "StudyResult",
    "Table",
    "Telemetry",
    "__version__",
    "navigate",
    "report",
    "requirement_names",
    "run",
    "score",
    "study",
    "visibility",
]
