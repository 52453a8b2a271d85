//! Random poses and suns of a range and a lens.

use std::path::Path;

use contract::Camera;
use contract::docking::Pose;
use nalgebra::Vector3;
use sim::SimError;
use sim::docking::{CameraConfig, DockingSimulation, DockingSimulator, LensConfig, LightingConfig};
use sim::mitsuba::Crop;
use sim::randomness::{Effect, Seed, Stream, uniform};
use sim::television::{Interlace, TelevisionConfig};
use sim::truth::approach::{ApproachConfig, ConstantVelocityConfig, target_from_camera};

use crate::docking_random::{camera, random_sun};

/// Lateral offset at most, as a part of d3, and angles at most, degrees.
const OFFSET: f64 = 0.02;
const ANGLE_DEG: f64 = 2.0;
/// Half the side of the square about the disk's centre that Mitsuba renders, m: the disk's radius is 0.3 m, and the cross, which
/// stands off by as much, is seen before it.
const HALF_SIDE_M: f64 = 0.36;

/// A lens and a distance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) name: &'static str,
    focal_px: f64,
    range_m: f64,
}

impl Row {
    pub(crate) const ALL: [Self; 5] = [
        Self { name: "narrow-20m", focal_px: 2917.0, range_m: 20.0 },
        Self { name: "narrow-10m", focal_px: 2917.0, range_m: 10.0 },
        Self { name: "narrow-5m", focal_px: 2917.0, range_m: 5.0 },
        Self { name: "wide-5m", focal_px: 1055.0, range_m: 5.0 },
        Self { name: "wide-2m", focal_px: 1055.0, range_m: 2.0 },
    ];
}

/// One frame: a pose, a Sun, noise of its own.
pub(crate) struct Case {
    pub(crate) camera: Camera,
    pub(crate) pose: Pose,
    pub(crate) simulator: DockingSimulator,
    focal_px: f64,
}

impl Case {
    /// The pose of this number: lateral offsets and angles uniform within their limits, the Sun uniform over the cap about
    /// the face's normal.
    pub(crate) fn random(row: &Row, seed: u64, number: u64) -> Result<Self, SimError> {
        let own = Seed { seed, case: row.focal_px as u64 * 1000 + row.range_m as u64 };
        let mut stream = own.stream(number, Effect::AttitudeControl, 0);
        let symmetric = |stream: &mut Stream| 2.0 * uniform(stream) - 1.0;
        let d = row.range_m;
        let position_m =
            Vector3::new(OFFSET * d * symmetric(&mut stream), OFFSET * d * symmetric(&mut stream), d);
        let phi_rad = Vector3::from_fn(|_, _| ANGLE_DEG.to_radians() * symmetric(&mut stream));
        let pose = Pose { position_m, phi_rad };
        let sun = random_sun(&mut stream);
        let camera = camera(row.focal_px);
        let simulation = DockingSimulation {
            // The field's number is 0 in every case: so seeds differ.
            seed: (seed << 32) ^ (own.case << 16) ^ number,
            start_utc: "2004-01-31T13:04:00Z".to_owned(),
            target: "progress".to_owned(),
            approach: ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
                position_m: pose.position_m.into(),
                velocity_m_s: [0.0; 3],
                phi_deg: pose.phi_rad.map(f64::to_degrees).into(),
                phi_rate_deg_s: [0.0; 3],
                duration_s: 0.0,
            }),
            cameras: vec![CameraConfig { name: "TV".to_owned(), until_range_m: 0.0, camera: camera.clone() }],
            lens: LensConfig { blur_sigma_px: 0.7 },
            lighting: LightingConfig { sun: Some(sun), fill_radiance: 0.12, ..LightingConfig::default() },
            television: TelevisionConfig { interlace: Interlace::Off, ..TelevisionConfig::default() },
        };
        let simulator = DockingSimulator::new(&simulation, Path::new("."))?;
        Ok(Self { camera, pose, simulator, focal_px: row.focal_px })
    }

    /// The square about the disk, as much of it as is in the image.
    pub(crate) fn target_window(&self) -> Crop {
        let centre = target_from_camera(&self.pose).transpose() * -self.pose.position_m;
        let half_px = self.focal_px * HALF_SIDE_M / centre.z;
        let span = |principal: f64, offset: f64, side: usize| {
            let middle = principal + 0.5 + self.focal_px * offset / centre.z;
            let low = (middle - half_px).round().max(0.0) as usize;
            let high = ((middle + half_px).round().max(0.0) as usize).min(side);
            (low, high.saturating_sub(low))
        };
        let (x, columns) = span(self.camera.principal_x_px, centre.x, self.camera.columns);
        let (y, rows) = span(self.camera.principal_y_px, centre.y, self.camera.rows);
        Crop { x, y, columns, rows }
    }
}
