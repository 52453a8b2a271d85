//! Hand-made truth and outcomes for the tests of the score.

use contract::Camera;
use contract::docking::{
    DockingOutcome, DockingSetup, DockingSolution, FailedCheck, Features, FieldMeasurement, Outline, Pose,
    PoseEstimate, StandOffCross, TargetModel,
};
use nalgebra::{Matrix6, Vector3};

use super::truth::{TargetVisibility, TrueField};

/// A camera of 768 × 576 square pixels, without distortion.
pub(crate) fn camera(focal_px: f64) -> Camera {
    Camera {
        columns: 768,
        rows: 576,
        focal_length_mm: focal_px / 100.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 383.5,
        principal_y_px: 287.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

/// A narrow lens (0), a wide lens (1), and a target with four marks that extend from 0.23 to 0.27 m.
pub(crate) fn setup() -> DockingSetup {
    let mark = |x: f64, y: f64| {
        let corner = |r: f64, side: f64| [r * x - side * y, r * y + side * x];
        [corner(0.27, -0.006), corner(0.27, 0.006), corner(0.23, 0.006), corner(0.23, -0.006)]
    };
    let outline = Outline { centre_m: [0.0, -1.25], radius_m: 0.66, depth_m: 0.1 };
    DockingSetup {
        cameras: vec![camera(2917.0), camera(1055.0)],
        bit_depth: 8,
        target: TargetModel {
            name: "hand-made".to_owned(),
            plate_radius_m: 0.3,
            mark_circle_radius_m: 0.25,
            marks: vec![mark(1.0, 0.0), mark(0.0, 1.0), mark(-1.0, 0.0), mark(0.0, -1.0)],
            cross: StandOffCross {
                height_m: 0.3,
                half_length_m: 0.15,
                width_m: 0.03,
                thickness_m: 0.01,
                post_width_m: 0.020,
            },
            docking_unit: outline,
            station: Outline { radius_m: 2.05, depth_m: 0.45, ..outline },
        },
    }
}

/// A pose straight ahead of the target.
pub(crate) fn ahead(range_m: f64) -> Pose {
    Pose { position_m: Vector3::new(0.0, 0.0, range_m), phi_rad: Vector3::zeros() }
}

/// A field of a camera straight ahead of the target, which approaches at 0.2 m/s, with the narrow lens.
pub(crate) fn field(number: u64, range_m: f64) -> TrueField {
    TrueField {
        field: number,
        time_s: number as f64 * 0.02,
        camera: 0,
        pose: ahead(range_m),
        velocity_m_s: Vector3::new(0.0, 0.0, -0.2),
        phi_rate_rad_s: Vector3::zeros(),
        visibility: TargetVisibility::Full,
        lost_lines: 0.0,
        marks_in_shadow: 0.0,
    }
}

/// A measurement of this pose, with standard deviations of 0.01 m and 0.01 rad in each parameter.
pub(crate) fn measured_outcome(pose: Pose) -> DockingOutcome {
    let covariance = Matrix6::from_diagonal_element(1e-4);
    let best = PoseEstimate { pose, covariance };
    DockingOutcome {
        solution: DockingSolution::Measured(Box::new(FieldMeasurement { best, paper: Some(pose) })),
        features: Features::default(),
        motion: None,
        digitiser: None,
    }
}

/// A doubtful measurement of this pose.
pub(crate) fn doubtful_outcome(pose: Pose, doubt: FailedCheck) -> DockingOutcome {
    let DockingSolution::Measured(measurement) = measured_outcome(pose).solution else {
        unreachable!("it is measured")
    };
    DockingOutcome { solution: DockingSolution::Doubtful { measurement, doubt }, ..measured_outcome(pose) }
}

/// A range-only measurement.
pub(crate) fn range_only(range_m: f64, sigma_m: f64) -> DockingOutcome {
    DockingOutcome {
        solution: DockingSolution::RangeOnly { range_m, sigma_m },
        ..measured_outcome(ahead(1.0))
    }
}
