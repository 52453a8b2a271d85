//! A small scene for tests: 160 × 120 pixels, 3.9° × 2.9° of sky, a target 10 km ahead, about twenty stars.

use std::path::Path;

use boresight_sim::catalog::CatalogConfig;
use boresight_sim::onboard::{RoiConfig, ScanOrder, ShutterConfig};
use boresight_sim::optics::{OpticsConfig, PsfConfig, RadiometryConfig};
use boresight_sim::scene::{BackgroundConfig, TargetConfig};
use boresight_sim::sensor::{
    BloomingConfig, CosmicRayConfig, FixedPatternConfig, HotPixelConfig, HotPixelDistribution,
    LineNoiseConfig, NoiseConfig, SensorConfig, Switch, TelegraphConfig,
};
use boresight_sim::truth::{
    AttitudeConfig, ControlConfig, DriftConfig, ElementsConfig, GroupConfig, Guidance, KnowledgeConfig,
    ManoeuvreConfig, MountingConfig, OrbitConfig, RelativeElements, Trajectory, TrajectorySource, clock,
};
use boresight_sim::{Simulation, Simulator};
use contract::{Camera, Direction, Icrs, Mounting};

/// Middle of the exposure of frame 0.
pub(crate) const START_UTC: &str = "2012-04-25T12:00:00Z";

/// Returns the orbits of a simulation.
pub(crate) fn orbit_of(simulation: &mut Simulation) -> &mut OrbitConfig {
    simulation.trajectory.orbit_mut().unwrap()
}

pub(crate) fn simulator(simulation: &Simulation) -> Simulator {
    Simulator::new(simulation, Path::new("")).unwrap()
}

/// An inertial camera that points at the target's position in frame 0, without control or knowledge errors; a
/// fixed exposure; whole images; every noise on. No pixel is saturated.
pub(crate) fn still() -> Simulation {
    let orbit = orbit();
    let states = Trajectory::new(&orbit).unwrap().states_at(clock::parse_utc(START_UTC).unwrap());
    let ahead: Direction<Icrs> = Direction::from_vector(states.line_of_sight_km()).unwrap();
    Simulation {
        seed: 20120425,
        catalog: CatalogConfig { magnitude_limit: Some(9.5), ..CatalogConfig::default() },
        trajectory: TrajectorySource::MeanElements(orbit),
        attitude_profile: None,
        schedule: vec![GroupConfig {
            name: "only".into(),
            start_utc: START_UTC.into(),
            cadence_s: 0.25,
            count: 1000,
        }],
        attitude: looking_at(ahead.ra().degrees(), ahead.dec().degrees()),
        knowledge: KnowledgeConfig::default(),
        mounting: MountingConfig::default(),
        camera: Camera {
            columns: 160,
            rows: 120,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 81.3,
            principal_y_px: 58.4,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [1e-7, -2e-7],
        },
        psf: PsfConfig::GaussianHalo { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.03 },
        optics: OpticsConfig::default(),
        radiometry: RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1.5e6, colour_term: 0.0 },
        background: BackgroundConfig::default(),
        sensor: SensorConfig {
            bit_depth: 12,
            gain_e_per_dn: 10.0,
            bias_dn: 40.3,
            full_well_e: 60_000.0,
            read_noise_e: 15.0,
            dark_current_e_per_s: 40.0,
            background_e_per_s: 60.0,
            noise: NoiseConfig::default(),
            hot_pixels: HotPixelConfig {
                count: 12,
                seed: 7,
                median_e_per_s: 4000.0,
                spread: 0.8,
                ..HotPixelConfig::default()
            },
            ..SensorConfig::default()
        },
        shutter: ShutterConfig::Fixed { exposure_s: 0.25 },
        roi: None,
        zero_suppression_dn: None,
        target: TargetConfig::LambertSphere { radius_m: 0.1, albedo: 0.3 },
        solar_system: Switch::Off,
    }
}

/// All effects of the simulator: a camera fixed in the orbital frame through a mounting that differs from its
/// nominal one, control and knowledge errors, shutter control, regions of interest, a manoeuvre.
pub(crate) fn restless() -> Simulation {
    let nominal = Mounting { phi_deg: -90.0, theta_deg: 1.0, psi_deg: 5.0 };
    let slow = |rms: f64| DriftConfig { rms_arcsec: [rms; 3], periods_s: vec![5930.0, 910.0, 173.0] };
    let mut simulation = still();
    orbit_of(&mut simulation).manoeuvres = vec![ManoeuvreConfig {
        time_utc: "2012-04-25T12:00:31Z".into(),
        dv_rtn_m_s: [0.01, -0.02, 0.03],
        duration_s: 0.0,
    }];
    simulation.schedule[0].cadence_s = 15.0;
    simulation.attitude = AttitudeConfig {
        guidance: Guidance::LocalOrbital { phi_deg: 0.1, theta_deg: -0.2, psi_deg: 3.0 },
        control: ControlConfig {
            drift: slow(60.0),
            jitter_arcsec: [3.0, 5.0, 7.0],
            ..ControlConfig::default()
        },
        motion_smear: Switch::On,
    };
    simulation.knowledge = KnowledgeConfig {
        bias_arcsec: [15.0, -10.0, 20.0],
        drift: slow(20.0),
        noise_arcsec: [50.0, 40.0, 30.0],
        latency_s: 0.02,
        velocity_noise_m_s: 0.1,
    };
    simulation.mounting = MountingConfig { actual: Mounting { psi_deg: 5.05, ..nominal }, nominal };
    simulation.shutter = ShutterConfig::Automatic {
        min_s: 0.0005,
        max_s: 0.25,
        target_level: 0.05,
        step_factor: 1.2,
        lag_s: 30.0,
    };
    simulation.roi = Some(RoiConfig {
        count: 20,
        columns: 20,
        rows: 9,
        anchor_column: 10,
        anchor_row: 2,
        threshold_dn: 60,
        scan: ScanOrder::Rows,
    });
    simulation
}

/// All detector effects at once.
pub(crate) fn defective(mut simulation: Simulation) -> Simulation {
    let sensor = &mut simulation.sensor;
    sensor.hot_pixels = HotPixelConfig {
        count: 40,
        law: HotPixelDistribution::Pareto { index: 1.5 },
        telegraph: Some(TelegraphConfig { fraction: 0.5, low_level: 0.2, high_s: 20.0, low_s: 40.0 }),
        ..sensor.hot_pixels.clone()
    };
    sensor.fixed_pattern = FixedPatternConfig {
        seed: 12,
        prnu_fraction: 0.02,
        dsnu_fraction: 0.3,
        column_offset_e: 2.0,
        dead_pixels: 300,
        dead_columns: 2,
        ..FixedPatternConfig::default()
    };
    sensor.line_noise = LineNoiseConfig { row_e: 3.0, column_e: 1.0 };
    sensor.cosmic_rays = Some(cosmic_rays(1000.0));
    sensor.blooming = Some(BloomingConfig { spill_fraction: 1.0 });
    sensor.non_linearity = 0.01;
    sensor.frame_transfer_s = 0.001;
    simulation
}

/// Cosmic-ray hits on a thin detector at the given rate.
pub(crate) fn cosmic_rays(rate_per_cm2_s: f64) -> CosmicRayConfig {
    CosmicRayConfig {
        rate_per_cm2_s,
        thickness_um: 15.0,
        readout_s: 0.1,
        mean_e_per_um: 80.0,
        landau_e_per_um: 4.9,
        south_atlantic: None,
    }
}

/// A camera pointed at a direction in the sky, without control error.
pub(crate) fn looking_at(ra_deg: f64, dec_deg: f64) -> AttitudeConfig {
    AttitudeConfig {
        guidance: Guidance::Inertial { ra_deg, dec_deg, roll_deg: 20.0 },
        control: ControlConfig::default(),
        motion_smear: Switch::On,
    }
}

/// A dawn-dusk orbit at 750 km, with the chaser 10 km behind.
fn orbit() -> OrbitConfig {
    OrbitConfig {
        epoch_utc: "2012-04-25T00:00:00Z".into(),
        target: ElementsConfig {
            semi_major_axis_km: 7130.0,
            eccentricity: 0.003,
            inclination_deg: 98.28,
            raan_deg: 126.4,
            argument_of_perigee_deg: 90.0,
            mean_anomaly_deg: 270.0,
        },
        relative: RelativeElements {
            a_dlambda_m: -10_000.0,
            a_dey_m: 100.0,
            a_diy_m: 100.0,
            ..RelativeElements::default()
        },
        manoeuvres: vec![],
        execution: None,
        reports: None,
    }
}
