//! Single progressive fields of random poses at one range through one lens, with blur and noise only.

use draws::{Seed, Stream, uniform};
use std::path::Path;

use contract::Camera;
use contract::docking::Pose;
use nalgebra::Vector3;
use sim::SimError;
use sim::docking::{
    CameraConfig, DockingSimulation, DockingSimulator, LensConfig, LightingConfig, SunConfig,
};
use sim::television::{Interlace, TelevisionConfig, VideoNoiseConfig};
use sim::truth::approach::{ApproachConfig, ConstantVelocityConfig};

/// Name of the target.
pub const TARGET: &str = "progress";
/// Standard deviation of the video noise, DN.
pub const NOISE_DN: f64 = 2.0;
/// Standard deviation of the lens's point-spread function, px.
pub const BLUR_PX: f64 = 0.7;

/// Row of a table: a lens and a distance.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Name in the table and on the command line.
    pub name: &'static str,
    /// Focal length, px.
    pub focal_px: f64,
    /// Range of the target, m.
    pub range_m: f64,
}

impl Row {
    /// Creates a row of the wide lens.
    pub const fn wide(name: &'static str, range_m: f64) -> Self {
        Self { name, focal_px: 1055.0, range_m }
    }

    /// Creates a row of the narrow lens.
    pub const fn narrow(name: &'static str, range_m: f64) -> Self {
        Self { name, focal_px: 2917.0, range_m }
    }

    /// Seed of the row's draws.
    pub fn seed(&self, seed: u64) -> Seed {
        Seed { seed, case: self.focal_px as u64 * 1000 + self.range_m as u64 }
    }

    /// Draws a pose at the row's d3: lateral offsets uniform within a fraction `offset` of d3, angles within
    /// `angle_deg`.
    pub fn random_pose(&self, offset: f64, angle_deg: f64, stream: &mut Stream) -> Pose {
        let mut symmetric = || 2.0 * uniform(stream) - 1.0;
        let d = self.range_m;
        let position_m = Vector3::new(offset * d * symmetric(), offset * d * symmetric(), d);
        Pose { position_m, phi_rad: Vector3::from_fn(|_, _| angle_deg.to_radians() * symmetric()) }
    }

    /// Creates the simulator of the single field of a pose, case `number` of a table.
    pub fn simulator(
        &self,
        camera: &Camera,
        pose: &Pose,
        sun: SunConfig,
        noise_dn: f64,
        (seed, number): (u64, u64),
    ) -> Result<DockingSimulator, SimError> {
        let simulation = DockingSimulation {
            // Noise is addressed by seed and number of the field, which is 0 in every case, so each case has
            // another seed.
            seed: (seed << 32) ^ (self.seed(seed).case << 16) ^ number,
            start_utc: "2004-01-31T13:04:00Z".to_owned(),
            target: TARGET.to_owned(),
            approach: ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
                position_m: pose.position_m.into(),
                velocity_m_s: [0.0; 3],
                phi_deg: pose.phi_rad.map(f64::to_degrees).into(),
                phi_rate_deg_s: [0.0; 3],
                duration_s: 0.0,
            }),
            cameras: vec![CameraConfig { name: "TV".to_owned(), until_range_m: 0.0, camera: camera.clone() }],
            lens: LensConfig { blur_sigma_px: BLUR_PX },
            lighting: LightingConfig { sun: Some(sun), fill_radiance: 0.12, ..LightingConfig::default() },
            television: TelevisionConfig {
                interlace: Interlace::Off,
                noise: VideoNoiseConfig { sigma_dn8: noise_dn },
                ..TelevisionConfig::default()
            },
        };
        DockingSimulator::new(&simulation, Path::new("."))
    }
}
