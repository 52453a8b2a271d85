//! Confirmation by simulation: frames of the simulator, processed by the detector of the far-range method.

use contract::{Body, CameraFrame, Frame, PipelineFactory, PixelPoint, Rotation, Setup};
use draws::{Effect, Seed};
use far_range::FarRangeScenario;
use files::Failure;
use hifitime::Epoch;
use nalgebra::Vector3;
use pipeline::far_range::{FarRangeConfig, FarRangeFactory, ThresholdConfig};
use rayon::prelude::*;
use sim::onboard::ShutterConfig;
use sim::scene::TargetConfig;
use sim::sensor::Switch;
use sim::truth::{
    AttitudeConfig, ControlConfig, Elements, ElementsConfig, GroupConfig, Guidance, KnowledgeConfig,
    MountingConfig, ObjectKind, ObjectTruth, Observer, OrbitConfig, RelativeElements, State,
    TargetAttitudeConfig, TrajectorySource, clock,
};
use sim::{Simulation, Simulator};

use crate::camera::{CameraConfig, CameraModel, mean_motion_rad_s};
use crate::requirement::{DetectionRule, MotionGuidance, MotionTable};
use crate::sky::Pointing;
use crate::sky::star_count::{Curves, star_trail_px};
use crate::target::{Aspect, Setting, along_track};

/// Largest distance from a cluster's centre to the true position of its object, px, to which half of the
/// object's trail is added.
const MATCH_PX: f64 = 2.5;
/// Jitter of the camera from frame to frame, arcsec, which spreads a target that the camera points at over
/// all positions within a pixel.
const DITHER_ARCSEC: f64 = 300.0;
/// Offset of the case number that separates the draws of target frames from those of star frames.
const TARGET_FRAMES: u64 = 1 << 32;

/// Test bench of the camera.
#[derive(Debug, Clone, Copy)]
pub struct Bench<'a> {
    /// Camera under test.
    pub camera: &'a CameraConfig,
    /// Rule for counting an object as detected.
    pub rule: &'a DetectionRule,
    /// Motion of the camera.
    pub motion: &'a MotionTable,
    /// Seed of all draws.
    pub seed: u64,
}

/// A star of a simulated frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarTrial {
    /// Johnson V magnitude.
    pub magnitude: f64,
    /// Detection probability according to the analytic model.
    pub chance: f64,
    /// True if the detector found the star.
    pub is_detected: bool,
}

/// A simulated frame of stars.
#[derive(Debug, Clone, PartialEq)]
pub struct StarFrame {
    /// Number of stars that the detector found.
    pub detected: u32,
    /// All stars on the detector.
    pub stars: Vec<StarTrial>,
}

impl Bench<'_> {
    /// Simulates one frame at each boresight.
    ///
    /// # Errors
    /// A [`Failure`] when the simulation cannot be created.
    pub fn stars(&self, pointings: &[Pointing], exposure_s: f64) -> Result<Vec<StarFrame>, Failure> {
        let model = CameraModel::new(self.camera)?;
        let mut background = [f64::INFINITY, 0.0_f64];
        for pointing in pointings {
            let light = pointing.background_e_per_s(&model, &pointing.observer(self.motion)?);
            background = [background[0].min(light), background[1].max(light)];
        }
        let curves = Curves::new(&model, self.rule, self.motion, exposure_s, background);
        let match_px = MATCH_PX + 0.5 * star_trail_px(&model, self.motion, exposure_s);
        let flights =
            pointings.iter().enumerate().map(|(k, pointing)| self.towards(pointing, exposure_s, k as u64));
        let flights = flights.collect::<Result<Vec<_>, Failure>>()?;
        self.expose(&flights, |seen| {
            let mut stars: Vec<&ObjectTruth> =
                seen.objects.iter().filter(|object| object.kind == ObjectKind::Star).collect();
            let (columns, rows) = (seen.frame.columns(), seen.frame.rows());
            stars.retain(|star| star.position.is_on_detector(columns, rows));
            let found = found(seen.clusters, &stars, match_px);
            let stars: Vec<StarTrial> = stars
                .iter()
                .zip(found)
                .map(|(star, is_detected)| StarTrial {
                    magnitude: star.magnitude.unwrap_or(99.0),
                    chance: curves.chance(libm::log(star.electrons / exposure_s), seen.background_e_per_s),
                    is_detected,
                })
                .collect();
            StarFrame { detected: stars.iter().filter(|star| star.is_detected).count() as u32, stars }
        })
    }

    /// Simulates `count` frames of the target from `range_km`, distributed over the aspects; returns the
    /// number of frames in which it is detected.
    ///
    /// # Errors
    /// A [`Failure`] when the simulation cannot be created.
    pub fn target(
        &self,
        body: &TargetConfig,
        scenario: Option<&FarRangeScenario>,
        aspects: &[Aspect],
        range_km: f64,
        exposure_s: f64,
        count: u32,
    ) -> Result<u64, Failure> {
        let model = CameraModel::new(self.camera)?;
        let match_px = MATCH_PX
            + match self.motion.guidance {
                MotionGuidance::Inertial => 0.5 * model.trail_px(self.motion, exposure_s),
                MotionGuidance::LocalOrbital => 0.0,
            };
        let flights = (0..count as usize).map(|k| {
            let aspect = aspects[k * aspects.len() / count as usize];
            self.at_target(body, scenario, &aspect, range_km, exposure_s, TARGET_FRAMES + k as u64)
        });
        let flights = flights.collect::<Result<Vec<_>, Failure>>()?;
        let shown = self.expose(&flights, |seen| {
            let target: Vec<&ObjectTruth> =
                seen.objects.iter().filter(|object| object.kind == ObjectKind::Target).collect();
            found(seen.clusters, &target, match_px).contains(&true)
        })?;
        Ok(shown.into_iter().filter(|shown| *shown).count() as u64)
    }

    /// Simulates the one frame of each flight on all threads, and returns the results of `look` in the order
    /// of the flights.
    fn expose<T: Send>(
        &self,
        flights: &[Simulation],
        look: impl Fn(&ProcessedFrame<'_>) -> T + Sync,
    ) -> Result<Vec<T>, Failure> {
        let factory =
            FarRangeFactory::new(self.pipeline()).map_err(|error| Failure::Usage(error.to_string()))?;
        let setup = Setup {
            camera: self.camera.camera.clone(),
            camera_from_body: Rotation::<CameraFrame, Body>::identity(),
            bit_depth: self.camera.sensor.bit_depth,
            readout: None,
            calibration: contract::Calibration::default(),
            zero_suppression_dn: None,
            stars: Vec::new(),
        };
        let piece = flights.len().div_ceil(rayon::current_num_threads()).max(1);
        let made = flights.par_chunks(piece).map(|flights| {
            let mut made = Vec::with_capacity(flights.len());
            let Some(first) = flights.first() else { return Ok(made) };
            let mut simulator = Simulator::new(first, std::path::Path::new(""))?;
            for flight in flights {
                simulator.fly(flight)?;
                let exposure = simulator.camera()?.expose(0)?;
                // A new pipeline per frame, without history: every frame is independent.
                let mut pipeline = factory.build(&setup)?;
                let clusters = clusters(&pipeline.process(&exposure.frame, &exposure.telemetry));
                made.push(look(&ProcessedFrame {
                    frame: &exposure.frame,
                    objects: &exposure.objects,
                    background_e_per_s: exposure.truth.background_e_per_s,
                    clusters: &clusters,
                }));
            }
            Ok(made)
        });
        let pieces: Vec<Vec<T>> = made.collect::<Result<_, Failure>>()?;
        Ok(pieces.into_iter().flatten().collect())
    }

    /// Returns the configuration of the far-range method's detector.
    fn pipeline(&self) -> FarRangeConfig {
        let full_scale_dn = f64::from(self.camera.sensor.full_scale_dn());
        let thresholds = match *self.rule {
            DetectionRule::Dn { low_dn, high_dn } => {
                // Adding 0.5 prevents rounding from changing a threshold by one.
                let share = |dn: u16| (f64::from(dn) + 0.5) / full_scale_dn;
                ThresholdConfig::Constant { low: share(low_dn), high: share(high_dn) }
            }
            DetectionRule::Sigmas { low, high } => {
                ThresholdConfig::Automatic { low_sigmas: low, high_sigmas: high, star_fraction: 0.0 }
            }
        };
        FarRangeConfig { thresholds, max_clusters: 2000, ..FarRangeConfig::default() }
    }

    /// Returns a flight that points at a node of the sky's lattice; the target is out of sight.
    fn towards(&self, pointing: &Pointing, exposure_s: f64, number: u64) -> Result<Simulation, Failure> {
        let boresight = *pointing.boresight.vector();
        let x = pointing.camera_from_icrs.inverse().rotate(&Vector3::x());
        let (radial, transverse, guidance) = match self.motion.guidance {
            MotionGuidance::LocalOrbital => (x, boresight, local_orbital()),
            MotionGuidance::Inertial => (boresight, x, inertial(pointing)),
        };
        let elements = circular(radial, transverse, self.motion)?;
        // The target is behind the camera, or, if the Earth is behind the camera, at right angles to the
        // boresight.
        let orbit = orbit(pointing.time, &elements, 10_000.0);
        let invisible = TargetConfig::Beacon { magnitude_at_1_km: 30.0 };
        Ok(self.flight(pointing.time, orbit, guidance, 0.0, invisible, exposure_s, number))
    }

    /// Returns a flight that points at the target in a given aspect.
    fn at_target(
        &self,
        body: &TargetConfig,
        scenario: Option<&FarRangeScenario>,
        aspect: &Aspect,
        range_km: f64,
        exposure_s: f64,
        number: u64,
    ) -> Result<Simulation, Failure> {
        let (time, orbit, body) = match (aspect.setting, scenario) {
            (Setting::Moment { time }, Some(FarRangeScenario { orbit: Some(orbit), .. })) => {
                (time, along_track(orbit, range_km), body.clone())
            }
            (Setting::Phase { turn_deg }, _) => {
                let time = clock::parse_utc("2012-04-26T12:00:00Z")?;
                let orbit = self.at_phase(time, aspect.phase_deg, range_km)?;
                (time, orbit, turned(body, turn_deg))
            }
            (Setting::Moment { .. }, _) => {
                return Err(Failure::Usage(
                    "target.light.kind \"orbit\" needs camera.scenario with a table [orbit]".to_owned(),
                ));
            }
        };
        let guidance = match self.motion.guidance {
            MotionGuidance::LocalOrbital => Guidance::TargetPointing {},
            MotionGuidance::Inertial => {
                let states = sim::truth::Trajectory::new(&orbit)?.states_at(time);
                let towards = contract::Direction::from_vector(states.line_of_sight_km())?;
                Guidance::Inertial {
                    ra_deg: towards.ra().degrees(),
                    dec_deg: towards.dec().degrees(),
                    roll_deg: 0.0,
                }
            }
        };
        Ok(self.flight(time, orbit, guidance, DITHER_ARCSEC, body, exposure_s, number))
    }

    /// Returns an orbit on which the target, `range_km` ahead, is seen at a phase angle. With R and T halfway
    /// between chaser and target, the Sun is at sin φ R − cos φ T.
    fn at_phase(&self, time: Epoch, phase_deg: f64, range_km: f64) -> Result<OrbitConfig, Failure> {
        let centre = Observer::new(time, Vector3::new(7000.0, 0.0, 0.0), Vector3::zeros())?;
        let sun = *centre.sun().vector();
        let beside = sun.cross(&Vector3::z()).normalize();
        let (sin, cos) = libm::sincos(phase_deg.to_radians());
        let (radial, transverse) = (sun * sin + beside * cos, beside * sin - sun * cos);
        let mut elements = circular(radial, transverse, self.motion)?;
        elements.mean_anomaly_deg += (0.5 * range_km / self.motion.semi_major_axis_km).to_degrees();
        Ok(orbit(time, &elements, -range_km * 1000.0))
    }

    /// Returns a simulation of one frame.
    #[allow(clippy::too_many_arguments, reason = "each is a parameter of the simulation; one caller")]
    fn flight(
        &self,
        time: Epoch,
        orbit: OrbitConfig,
        guidance: Guidance,
        jitter_arcsec: f64,
        target: TargetConfig,
        exposure_s: f64,
        number: u64,
    ) -> Simulation {
        let camera = self.camera;
        let start_utc = clock::format_utc(time);
        let seed = Seed { seed: self.seed, case: number }.streams(0, Effect::CaseSeed).word(0);
        Simulation {
            seed,
            catalog: camera.catalog.clone(),
            trajectory: TrajectorySource::MeanElements(orbit),
            attitude_profile: None,
            schedule: vec![GroupConfig { name: "confirm".to_owned(), start_utc, cadence_s: 1.0, count: 1 }],
            attitude: AttitudeConfig {
                guidance,
                control: ControlConfig { jitter_arcsec: [jitter_arcsec; 3], ..ControlConfig::default() },
                motion_smear: Switch::On,
            },
            knowledge: KnowledgeConfig::default(),
            mounting: MountingConfig::default(),
            camera: camera.camera.clone(),
            psf: camera.psf.clone(),
            optics: camera.optics.clone(),
            radiometry: camera.radiometry.clone(),
            background: camera.background.clone(),
            sensor: camera.sensor.clone(),
            shutter: ShutterConfig::Fixed { exposure_s },
            roi: None,
            zero_suppression_dn: None,
            target,
            solar_system: Switch::Off,
        }
    }
}

/// A simulated frame with its true objects and detected clusters.
struct ProcessedFrame<'a> {
    frame: &'a Frame,
    objects: &'a [ObjectTruth],
    background_e_per_s: f64,
    clusters: &'a [PixelPoint],
}

/// Returns true for each object that was found: a cluster counts for the brightest object within a distance.
fn found(clusters: &[PixelPoint], objects: &[&ObjectTruth], match_px: f64) -> Vec<bool> {
    let mut found = vec![false; objects.len()];
    for cluster in clusters {
        // If several objects are within the distance, the cluster is attributed to the brightest.
        let near = objects.iter().enumerate().filter(|(_, o)| o.position.distance(*cluster) <= match_px);
        if let Some((index, _)) = near.max_by(|(_, a), (_, b)| a.electrons.total_cmp(&b.electrons)) {
            found[index] = true;
        }
    }
    found
}

fn clusters(outcome: &contract::Outcome) -> Vec<PixelPoint> {
    outcome.clusters.iter().map(|cluster| cluster.position).collect()
}

/// Returns a circular orbit with these radial and transverse unit vectors.
fn circular(
    radial: Vector3<f64>,
    transverse: Vector3<f64>,
    motion: &MotionTable,
) -> Result<ElementsConfig, Failure> {
    let a_km = motion.semi_major_axis_km;
    let velocity_km_s = transverse * (mean_motion_rad_s(a_km) * a_km);
    let elements = Elements::from_state(&State { position_km: radial * a_km, velocity_km_s });
    let elements = elements.ok_or_else(|| {
        Failure::Usage("a simulated orbit lies in the equatorial plane; use another seed".to_owned())
    })?;
    Ok(ElementsConfig {
        semi_major_axis_km: elements.semi_major_axis_km,
        eccentricity: elements.eccentricity.max(0.0),
        inclination_deg: elements.inclination_rad.to_degrees(),
        raan_deg: elements.raan_rad.to_degrees(),
        argument_of_perigee_deg: elements.argument_of_perigee_rad.to_degrees(),
        mean_anomaly_deg: elements.mean_anomaly_rad.to_degrees(),
    })
}

fn orbit(time: Epoch, target: &ElementsConfig, a_dlambda_m: f64) -> OrbitConfig {
    OrbitConfig {
        epoch_utc: clock::format_utc(time),
        target: target.clone(),
        relative: RelativeElements { a_dlambda_m, ..RelativeElements::default() },
        manoeuvres: Vec::new(),
        execution: None,
        reports: None,
    }
}

fn local_orbital() -> Guidance {
    Guidance::LocalOrbital { phi_deg: 0.0, theta_deg: 0.0, psi_deg: 0.0 }
}

/// Returns a guidance that gives the attitude of a pointing.
fn inertial(pointing: &Pointing) -> Guidance {
    Guidance::Inertial {
        ra_deg: pointing.boresight.ra().degrees(),
        dec_deg: pointing.boresight.dec().degrees(),
        roll_deg: pointing.roll().degrees(),
    }
}

/// Returns the body with its attitude fixed in the orbital frame.
fn turned(body: &TargetConfig, [phi_deg, theta_deg, psi_deg]: [f64; 3]) -> TargetConfig {
    body.with_attitude(TargetAttitudeConfig::Orbital { phi_deg, theta_deg, psi_deg })
}
