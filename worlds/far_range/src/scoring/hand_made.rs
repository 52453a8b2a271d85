//! Hand-made test scene: a camera of 752 × 580 px with pixels of 0.024° and the target in the centre of the
//! image.

use contract::{
    Camera, CameraFrame, Cluster, Direction, Icrs, Label, Measurement, Outcome, PixelPoint, Rotation,
    Solution,
};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};

use crate::scoring::angles::AnswerError;
use crate::scoring::cause::Cause;
use crate::scoring::verdict::{FrameVerdict, MistakenObject, Verdict};

pub(crate) const COLUMNS: usize = 752;
pub(crate) const ROWS: usize = 580;
pub(crate) const CENTRE: PixelPoint = PixelPoint::new(395.0, 288.0);

/// Tangent of the angle of one pixel, 0.024°.
pub(crate) const PIXEL: f64 = 0.024 * std::f64::consts::PI / 180.0;

/// Returns the camera of the far-range paper.
pub(crate) fn camera() -> Camera {
    Camera {
        columns: COLUMNS,
        rows: ROWS,
        focal_length_mm: 20.187,
        pixel_width_um: 8.6,
        pixel_height_um: 8.3,
        principal_x_px: CENTRE.x,
        principal_y_px: CENTRE.y,
        radial: [2.6e-8, 0.0, 0.0],
        tangential: [0.0; 2],
    }
}

pub(crate) fn direction_at(point: PixelPoint) -> Direction<CameraFrame> {
    let vector = Vector3::new((point.x - CENTRE.x) * PIXEL, (point.y - CENTRE.y) * PIXEL, 1.0);
    Direction::from_vector(vector).unwrap()
}

pub(crate) fn unproject(point: PixelPoint) -> Option<Direction<CameraFrame>> {
    Some(direction_at(point))
}

/// Returns the truth of a frame of `day 1`: target in the centre, sunlit, detectable; camera axes parallel to
/// those of ICRS.
pub(crate) fn frame(frame: u64) -> FrameTruth {
    looking(frame, Rotation::identity())
}

/// Returns the truth of a frame as [`frame`] does, but with the camera rotated about all three axes.
pub(crate) fn tilted(frame: u64) -> FrameTruth {
    looking(frame, Rotation::from_rotation_vector(Vector3::new(0.4, -0.9, 0.6)))
}

fn looking(frame: u64, camera_from_icrs: Rotation<CameraFrame, Icrs>) -> FrameTruth {
    FrameTruth {
        frame,
        group: "day 1".to_owned(),
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 23) + Unit::Second * (30.0 * frame as f64),
        exposure_s: 0.25,
        body_from_icrs: Rotation::identity(),
        camera_from_icrs,
        position_km: Vector3::new(7000.0, 0.0, 0.0),
        velocity_km_s: Vector3::new(0.0, 7.5, 0.0),
        line_of_sight: camera_from_icrs.inverse() * Direction::z(),
        range_km: 10.0,
        sun: Direction::from_unit(Vector3::x()),
        phase_deg: 60.0,
        shadow: Shadow::Sunlit,
        sunlit_fraction: 1.0,
        background_e_per_s: 0.0,
        smear_e_per_px: 0.0,
        target_from_icrs: None,
        target_position: Some(CENTRE),
        target_visibility: Visibility::Detectable,
    }
}

fn object(kind: ObjectKind, id: u32, position: PixelPoint, electrons: f64) -> ObjectTruth {
    ObjectTruth {
        frame: 0,
        kind,
        id,
        position,
        astrometric: None,
        magnitude: None,
        electrons,
        peak_electrons: 0.2 * electrons,
        snr: 20.0,
        radius_px: 1.0,
        bloom_px: 0.0,
        cut: 0.0,
    }
}

pub(crate) fn target_with(electrons: f64) -> ObjectTruth {
    object(ObjectKind::Target, 0, CENTRE, electrons)
}

pub(crate) fn star_at(id: u32, position: PixelPoint, electrons: f64) -> ObjectTruth {
    object(ObjectKind::Star, id, position, electrons)
}

pub(crate) fn hot_pixel_at(id: u32, position: PixelPoint, electrons: f64) -> ObjectTruth {
    object(ObjectKind::HotPixel, id, position, electrons)
}

pub(crate) fn cosmic_ray_at(id: u32, position: PixelPoint, electrons: f64) -> ObjectTruth {
    object(ObjectKind::CosmicRay, id, position, electrons)
}

pub(crate) fn cluster(position: PixelPoint, label: Label) -> Cluster {
    Cluster { position, size: 2.0, pixels: 9, label }
}

/// Returns the verdict on a frame without further data.
pub(crate) fn verdict_of(verdict: Verdict) -> FrameVerdict {
    FrameVerdict {
        frame: 0,
        group: "day 1".into(),
        is_warm_up: false,
        verdict,
        image: None,
        n_stars: None,
        attitude_source: None,
        is_absent: false,
        log_odds: None,
    }
}

const NO_ERROR: AnswerError = AnswerError {
    centroid_px: None,
    line_of_sight: None,
    centroid_normalised: None,
    line_of_sight_normalised: None,
};

pub(crate) fn correct_verdict() -> Verdict {
    Verdict::Correct { error: NO_ERROR }
}

pub(crate) fn wrong_verdict() -> Verdict {
    Verdict::Wrong { error: NO_ERROR, taken: MistakenObject::Nothing, cause: Cause::Unexplained }
}

/// Returns an outcome with a centroid only, without a line of sight.
pub(crate) fn detected_at(position: PixelPoint) -> Outcome {
    Outcome {
        solution: Solution::Detected(Measurement::new(position, None)),
        camera_from_icrs: None,
        attitude_source: None,
        n_stars: None,
        clusters: Vec::new(),
    }
}
