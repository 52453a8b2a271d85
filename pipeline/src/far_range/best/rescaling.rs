//! Focal length by the stars of a frame whose attitude is known by telemetry.
//!
//! With a wrong focal length only the stars near the boresight are at their predicted positions. Where most
//! of the bright sources are no listed stars, the stars about the attitude of the telemetry are looked up
//! with a free focal length, as without a prior. If they contradict the stated one, theirs is used for the
//! frame.

use contract::ListedStar;
use nalgebra::Vector3;

use super::config::AttitudePrior;
use super::frame_attitude::FrameAttitude;
use super::lost_in_space::LostInSpace;
use super::photometry::Source;
use super::start::AttitudeStart;
use super::state::BestPipeline;

/// Number of the brightest sources of which less than half are listed stars in a frame that is looked up, and
/// smallest number of them.
const BRIGHT_SOURCES: usize = 10;
const MIN_SOURCES: usize = 5;

/// Largest angle between the attitudes by the stars and by the telemetry: standard deviations of the latter,
/// and a margin, rad (3 arc minutes).
const MAX_SIGMAS: f64 = 5.0;
const MARGIN_RAD: f64 = 8.7e-4;

/// Largest number of frames that are passed over after frames without a focal length of their own.
const MAX_WAIT: u32 = 64;

/// State of the search for the focal length over frames.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rescaling {
    /// True after a frame whose stars contradict the stated focal length: the next frame is looked up first.
    is_active: bool,
    /// Number of frames to be passed over, and number after the next frame without a focal length of its own.
    wait: u32,
    next_wait: u32,
}

impl BestPipeline {
    /// Returns the start of a frame after one whose stars contradict the stated focal length, if they do so
    /// again; sets the camera to their focal length, and otherwise to the stated one.
    pub(super) fn start_as_before(
        &mut self,
        sources: &[Source],
        start: &AttitudeStart,
    ) -> Option<AttitudeStart> {
        if self.is_rescaled {
            self.model = self.stated_model.clone();
            self.is_rescaled = false;
        }
        if !self.rescaling.is_active {
            return None;
        }
        let found = self.rescaled_start(sources, start);
        self.rescaling.is_active = found.is_some();
        found
    }

    /// Returns the start with the focal length of the stars for a frame whose bright sources are mostly no
    /// stars by the stated one, and sets the camera to it; `None` if the stars do not contradict the stated
    /// one.
    pub(super) fn start_of_unexplained(
        &mut self,
        sources: &[Source],
        attitude: &FrameAttitude,
        start: &AttitudeStart,
    ) -> Option<AttitudeStart> {
        let is_free = self.config.best.prior == AttitudePrior::Telemetry
            && self.config.best.focal_length_tolerance > 0.0;
        if !is_free || self.is_rescaled || !is_unexplained(sources, &attitude.star_of) {
            return None;
        }
        if self.config.best.sequence && self.rescaling.wait > 0 {
            self.rescaling.wait -= 1;
            return None;
        }
        let found = self.rescaled_start(sources, start);
        self.rescaling = match found {
            Some(_) => Rescaling { is_active: self.config.best.sequence, ..Rescaling::default() },
            None => {
                let next_wait = (2 * self.rescaling.next_wait).clamp(1, MAX_WAIT);
                Rescaling { is_active: false, wait: self.rescaling.next_wait, next_wait }
            }
        };
        found
    }

    /// Looks up the stars about the attitude of the telemetry with a free focal length.
    fn rescaled_start(&mut self, sources: &[Source], start: &AttitudeStart) -> Option<AttitudeStart> {
        let tolerance = self.config.best.focal_length_tolerance;
        let reference = start.attitude(start.prior.mean);
        let widest = self.stated_model.with_focal_ratio(1.0 - tolerance);
        let near: Vec<ListedStar> =
            self.stars.predict(&reference, &widest).into_iter().map(|predicted| predicted.star).collect();
        let solver = LostInSpace::new(&near, &self.stated_model, f64::INFINITY, tolerance);
        let found = solver.solve(&positions_of_stars(sources)).filter(|found| found.focal_ratio != 1.0)?;
        let turn: Vector3<f64> = (found.camera_from_icrs * reference.inverse()).quaternion().scaled_axis();
        let of_telemetry = MAX_SIGMAS * start.prior.covariance.trace().sqrt();
        let of_stars = MAX_SIGMAS * found.covariance.trace().sqrt();
        if turn.norm() > of_telemetry + of_stars + MARGIN_RAD {
            return None;
        }
        self.model = self.stated_model.with_focal_ratio(found.focal_ratio);
        self.is_rescaled = true;
        Some(AttitudeStart::from_found(&found))
    }
}

/// Returns position, px, and flux of the sources that are no spikes.
pub(super) fn positions_of_stars(sources: &[Source]) -> Vec<(contract::PixelPoint, f64)> {
    let star_like = sources.iter().filter(|source| source.spike.is_none());
    star_like.map(|source| (source.centre, source.flux_e)).collect()
}

/// Returns true if less than half of the brightest sources are listed stars.
fn is_unexplained(sources: &[Source], star_of: &[Option<u32>]) -> bool {
    let mut bright: Vec<(f64, bool)> = sources
        .iter()
        .zip(star_of)
        .filter(|(source, _)| source.spike.is_none())
        .map(|(source, star)| (source.flux_e, star.is_some()))
        .collect();
    bright.sort_by(|a, b| b.0.total_cmp(&a.0));
    bright.truncate(BRIGHT_SOURCES);
    let stars = bright.iter().filter(|(_, is_star)| *is_star).count();
    bright.len() >= MIN_SOURCES && 2 * stars < bright.len()
}

#[cfg(test)]
mod tests {
    use contract::{
        AttitudeSource, Calibration, Camera, CameraFrame, Direction, Frame, PsfCalibration, Readout,
        Rotation, Setup, Telemetry,
    };
    use hifitime::Epoch;

    use super::super::lost_in_space::tests::Random;
    use super::*;
    use crate::far_range::config::{AberrationConfig, FarRangeConfig};
    use crate::far_range::overrides::Overrides;

    const SIDE: usize = 400;
    const FOCAL_PX: f64 = 1500.0;
    const READOUT: Readout =
        Readout { gain_e_per_dn: 10.0, bias_dn: 40.0, read_noise_e: 15.0, saturation_dn: 4095 };

    /// Returns stars at random positions of the image, with the frame that shows them.
    fn stars_and_frame(seed: u64) -> (Vec<ListedStar>, Frame) {
        let mut random = Random(seed);
        let mut electrons = vec![20.0; SIDE * SIDE];
        let mut stars = Vec::new();
        for id in 1..=18_u32 {
            let (x, y) = (15.0 + 370.0 * random.uniform(), 15.0 + 370.0 * random.uniform());
            let flux_e = 30_000.0 + 50_000.0 * random.uniform();
            let centre = 0.5 * (SIDE as f64 - 1.0);
            let at = Vector3::new((x - centre) / FOCAL_PX, (y - centre) / FOCAL_PX, 1.0);
            let direction = Direction::from_vector(at).unwrap();
            stars.push(ListedStar { id, direction, magnitude: -2.5 * libm::log10(flux_e / 375_000.0) });
            for row in y as usize - 6..=y as usize + 6 {
                for column in x as usize - 6..=x as usize + 6 {
                    let squared = libm::pow(column as f64 - x, 2.0) + libm::pow(row as f64 - y, 2.0);
                    let density = libm::exp(-0.5 * squared / 0.81) / (std::f64::consts::TAU * 0.81);
                    electrons[row * SIDE + column] += flux_e * density;
                }
            }
        }
        let dn = electrons.iter().map(|expected| {
            let noisy = expected + (expected + 225.0_f64).sqrt() * random.normal();
            (noisy / READOUT.gain_e_per_dn + READOUT.bias_dn).round() as u16
        });
        (stars, Frame::new(0, SIDE, SIDE, 12, dn.collect(), None).unwrap())
    }

    /// Returns the source of the attitude and its error, degrees, for a focal length stated too long by
    /// `error`.
    fn attitude_with(error: f64, tolerance: f64) -> (Option<AttitudeSource>, f64) {
        let (stars, frame) = stars_and_frame(7);
        let camera = Camera {
            columns: SIDE,
            rows: SIDE,
            focal_length_mm: FOCAL_PX * (1.0 + error) / 100.0,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 0.5 * (SIDE as f64 - 1.0),
            principal_y_px: 0.5 * (SIDE as f64 - 1.0),
            radial: [0.0; 3],
            tangential: [0.0; 2],
        };
        let setup = Setup {
            camera,
            camera_from_body: Rotation::identity(),
            bit_depth: 12,
            readout: Some(READOUT),
            calibration: Calibration {
                psf: Some(PsfCalibration { sigma_px: 0.9, halo_sigma_px: 4.0, halo_fraction: 0.0 }),
                full_well_e: Some(60_000.0),
                spill_fraction: Some(0.0),
                response_sigma: Some(0.0),
                zero_magnitude_e_per_s: Some(1.5e6),
                target: None,
                attitude: None,
            },
            zero_suppression_dn: None,
            stars,
        };
        let mut config = FarRangeConfig { aberration: AberrationConfig::Ignore, ..FarRangeConfig::default() };
        config.best.focal_length_tolerance = tolerance;
        let mut pipeline = BestPipeline::new(config, &setup).unwrap();
        let telemetry = Telemetry {
            time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
            exposure_s: 0.25,
            body_from_icrs: Rotation::identity(),
            velocity_km_s: None,
        };
        let outcome = pipeline.process_with(&frame, &telemetry, &Overrides::default());
        let found: Option<Rotation<CameraFrame, contract::Icrs>> = outcome.camera_from_icrs;
        let off_deg = found.map_or(f64::NAN, |found| found.angle_to(&Rotation::identity()).degrees());
        (outcome.attitude_source, off_deg)
    }

    /// 1.5 % are 3 px at the sides of the image and 4 px in its corners.
    #[test]
    fn stars_about_the_telemetry_give_the_focal_length() {
        for error in [-0.015, 0.015] {
            let (source, off_deg) = attitude_with(error, 0.02);
            assert_eq!(source, Some(AttitudeSource::RescaledStars), "{error}");
            assert!(off_deg < 0.005, "{error}: {off_deg}°");
            assert_ne!(attitude_with(error, 0.0).0, Some(AttitudeSource::RescaledStars));
            assert_ne!(attitude_with(error, 0.01).0, Some(AttitudeSource::RescaledStars));
        }
    }

    #[test]
    fn the_stated_focal_length_stays_where_the_stars_confirm_it() {
        assert_eq!(attitude_with(0.0, 0.02), attitude_with(0.0, 0.0));
        assert_eq!(attitude_with(0.0, 0.02).0, Some(AttitudeSource::Stars));
    }
}
