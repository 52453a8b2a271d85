"""Code that type checkers must accept, or refuse: checked by `mypy --strict`, never run."""

from typing import Any

import boresight
from boresight import Detection, Frame, NoSolution, Pose


def brightest(frame: Frame, telemetry: boresight.Telemetry) -> Detection:
    y, x = divmod(int(frame.pixels.argmax()), frame.pixels.shape[1])
    return Detection(x, y)


def nothing(frame: Frame, telemetry: boresight.Telemetry | boresight.FieldTelemetry) -> None:
    return None


class Docking:
    def __init__(self, setup: dict[str, Any]) -> None:
        self.cameras = setup["cameras"]

    def __call__(self, field: Frame, telemetry: boresight.FieldTelemetry) -> Pose | NoSolution:
        return NoSolution("no_target" if telemetry.camera == 0 else "out_of_field")


def number(frame: Frame, telemetry: boresight.Telemetry) -> float:
    return telemetry.exposure_s


def no_orbit(setup: dict[str, Any], events: list[dict[str, Any]], times: list[str]) -> list[str]:
    return ["no_initial_orbit" for _ in times]


class Filter:
    mode = "sequential"

    def __init__(self, setup: dict[str, Any]) -> None:
        self.epoch = setup["epoch_utc"]

    def __call__(self, events: list[dict[str, Any]], times: list[str]) -> list[dict[str, Any] | str]:
        return ["no_convergence" for _ in times]


boresight.navigate("run", navigator=no_orbit)
boresight.navigate("run", navigator=Filter, every_s=60, prior=False)
boresight.run("argon", frames=range(10), pipeline=brightest)
boresight.run("argon", pipeline=nothing)
boresight.run("docking", pipeline=Docking)
boresight.run("argon", pipeline="exec:python3 pipeline.py")
boresight.study("study.toml", pipeline=Docking)
boresight.run("argon", progress=False).score["figures"]
boresight.study("study.toml", progress=lambda done, total: print(done, total))
boresight.run("argon", progress="yes")  # type: ignore[arg-type]
boresight.run("argon", pipeline=number)  # type: ignore[arg-type]

telemetry = boresight.Scenario.load("argon").frame(0).telemetry
telemetry.exposure_s  # type: ignore[union-attr]
if isinstance(telemetry, boresight.Telemetry):
    exposure_s: float = telemetry.exposure_s
