"""Answers of a pipeline that is written in Python: in docking `Pose`, `RangeOnly` or `NoSolution`, otherwise
`Detection` or `NoSolution`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Detection:
    """Target found in a frame."""

    x_px: float
    """Column of the target's centroid; the centre of the first pixel is 0. On the detector: -0.5 to columns -
    0.5."""
    y_px: float
    """Row of the target's centroid."""
    los_j2000: Sequence[float] | None = None
    """Line of sight to the target, unit vector along the axes of ICRS. Without it the score has the error of
    the centroid, px, and figures of the direction only with an attitude chosen for the score (docs/score.md)."""
    q_cam_j2000: Sequence[float] | None = None
    """Attitude of the camera, unit quaternion (w, x, y, z); recorded, not scored."""
    n_stars: int | None = None
    """Stars identified in the frame."""
    sigma_x_px: float | None = None
    """Standard deviation of `x_px`, px, above 0; with `sigma_y_px` and `correlation_xy`, or none of the
    three."""
    sigma_y_px: float | None = None
    """Standard deviation of `y_px`, px, above 0."""
    correlation_xy: float | None = None
    """Correlation of both errors, above -1 and below 1."""
    sigma_ra_deg: float | None = None
    """Standard deviation of the line of sight across columns of the camera, degrees, above 0, the error of
    the attitude included; with `los_j2000`, `sigma_dec_deg` and `correlation_ra_dec`, or none of the three.
    """
    sigma_dec_deg: float | None = None
    """Standard deviation across rows, degrees, above 0."""
    correlation_ra_dec: float | None = None
    """Correlation of both errors, above -1 and below 1."""
    log_odds: float | None = None
    """Natural logarithm of the odds p/(1 - p) that this is the target."""

    status = "detected"


@dataclass(frozen=True)
class NoSolution:
    """No target, with a reason: `no_target`, `empty_frame`, `saturated_frame`, `no_previous_frame`, or
    `failed: ` and text. In docking `empty_field`, `saturated_field`, `no_target`, `ambiguous_target`,
    `out_of_field`, `too_few_features`, `inconsistent`, or `failed: `."""

    status: str = "no_target"


@dataclass(frozen=True)
class Pose:
    """Docking: pose with all six parameters."""

    d_m: Sequence[float]
    """Position of the camera in the target's frame, (d1, d2, d3), m."""
    phi_deg: Sequence[float]
    """Rotation vector of the camera from ideal docking: active pitch, yaw, roll, degrees."""
    sigma_d_m: Sequence[float] | None = None
    """Standard deviations of `d_m`, m."""
    sigma_phi_deg: Sequence[float] | None = None
    """Standard deviations of `phi_deg`, degrees."""
    contrast: float | None = None
    """Contrast of the digitiser from the next field on, 0.1 to 20; with `brightness` or not at all."""
    brightness: float | None = None
    """Brightness of the digitiser from the next field on, -10 to 10, in units of full scale."""

    status: str = "measured"
    """`measured`; or the test that the pose has failed, and then it counts as doubtful:
    `doubtful: residuals`, `doubtful: features`, `doubtful: motion`, `doubtful: unconfirmed`,
    `doubtful: repeated`."""


@dataclass(frozen=True)
class RangeOnly:
    """Docking: range from the outline of the station, while the target is not resolved."""

    range_m: float
    """d3, m, above 0."""
    sigma_range_m: float | None = None
    """Standard deviation of `range_m`, m."""

    status = "range_only"
