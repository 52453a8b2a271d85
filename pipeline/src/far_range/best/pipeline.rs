//! Sequence of steps of the best mode.

use contract::{Cluster, Frame, Label, NoSolution, Outcome, PixelPoint, Readout, Solution, Telemetry};

use super::frame_attitude::{AttitudeInput, FrameAttitude};
use super::hot_pixels::HotPixels;
use super::photometry::{KnownSource, PhotometryContext, PhotometryModel, Source};
use super::stars::ExpectedStar;
use super::state::{BestPipeline, LastFrame, ScaleSource};
use super::target::{CandidateImage, TargetContext};
use super::track::{FrameCandidates, Sky, TargetCandidate, TrackModel};
use super::unlisted_stars::UnlistedStars;
use crate::far_range::background::Background;
use crate::far_range::detect::{Blob, transmitted_pixels};
use crate::far_range::overrides::Overrides;
use crate::far_range::unusable_frame::unusable_reason;

/// Relative standard deviation of a star's flux for a known brightness scale: colours and variability.
const STAR_FLUX_SIGMA: f64 = 0.4;

impl BestPipeline {
    /// Performs [`contract::Pipeline::process`] with given results of single steps.
    pub(in crate::far_range) fn process_with(
        &mut self,
        frame: &Frame,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        if let Some(reason) = unusable_reason(frame, telemetry, &self.model) {
            return Outcome::without_solution(NoSolution::Failed(reason));
        }
        let elapsed_s = self.advance(telemetry);
        let Some(background) = self.background.estimate(frame) else {
            return Outcome::without_solution(NoSolution::EmptyFrame);
        };
        let thresholds = self.config.thresholds.for_frame(frame, Some(background));
        if 2 * self.detector.find_bright(frame, thresholds) > transmitted_pixels(frame) {
            return Outcome::without_solution(NoSolution::SaturatedFrame);
        }
        let max_clusters = self.config.max_clusters as usize;
        let blobs: Vec<Blob> =
            self.detector.detect(frame, thresholds, background.median_dn, max_clusters).to_vec();
        let photometry = self.photometry(frame, background);
        let detector = std::mem::take(&mut self.detector);
        let hot_pixels = std::mem::take(&mut self.hot_pixels);
        let threshold_e =
            self.threshold_flux_e(f64::from(thresholds.high_dn) - background.median_dn, &photometry);
        let context = PhotometryContext {
            frame,
            detector: &detector,
            model: &photometry,
            hot_pixels: &hot_pixels,
            threshold_e,
        };
        let sources: Vec<Source> = blobs
            .iter()
            .enumerate()
            .map(|(i, blob)| photometry.source(frame, blob, detector.members(i), &self.psf.image([0.0; 2])))
            .collect();
        let outcome = self.answer(context, &sources, telemetry, elapsed_s, overrides);
        self.detector = detector;
        self.hot_pixels = hot_pixels;
        for spike in sources.iter().filter_map(|source| source.spike) {
            self.hot_pixels.count(spike);
        }
        outcome
    }

    /// Advances the state to this frame. Returns the time since the last frame, s, or `None` if no linked
    /// frame of the sequence precedes.
    fn advance(&mut self, telemetry: &Telemetry) -> Option<f64> {
        let elapsed_s = self.last.map(|last| (telemetry.time - last.time).to_seconds());
        if !self.config.best.sequence {
            self.mounting.restart();
            self.hot_pixels = HotPixels::default();
        } else if let Some(elapsed_s) = elapsed_s {
            self.mounting.advance(elapsed_s);
        }
        let linked = elapsed_s.filter(|&elapsed| {
            self.config.best.sequence && elapsed > 0.0 && elapsed <= self.config.max_gap_s
        });
        match linked {
            Some(elapsed_s) => self.tracks.advance(elapsed_s),
            None => self.tracks.clear(),
        }
        linked
    }

    fn photometry(&self, frame: &Frame, background: Background) -> PhotometryModel {
        // Without a readout, the noise of the background replaces the read noise, and digital numbers replace
        // electrons.
        let readout = self.readout.unwrap_or(Readout {
            gain_e_per_dn: 1.0,
            bias_dn: background.median_dn,
            read_noise_e: background.sigma_dn,
            saturation_dn: frame.full_scale_dn(),
        });
        let gain = readout.gain_e_per_dn;
        PhotometryModel {
            readout,
            response: self.calibration.response,
            full_well_e: self.calibration.full_well_e,
            may_spill: self.calibration.may_spill,
            background_e: (background.median_dn - readout.bias_dn) * gain,
            pixel_sigma_e: background.sigma_dn * gain,
        }
    }

    /// Returns the flux of a point whose central pixel is at the threshold, electrons.
    fn threshold_flux_e(&self, above_background_dn: f64, photometry: &PhotometryModel) -> f64 {
        let image = self.psf.image([0.0; 2]);
        (above_background_dn.max(1.0) * photometry.readout.gain_e_per_dn / image.central_share()).max(1.0)
    }

    fn answer(
        &mut self,
        context: PhotometryContext<'_>,
        sources: &[Source],
        telemetry: &Telemetry,
        elapsed_s: Option<f64>,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        let start = self.start(sources, telemetry, overrides);
        let trail_px = self.trail_px(telemetry, elapsed_s, start.as_ref());
        let mut attitude = match &start {
            Some(start) => {
                self.attitude(&AttitudeInput { context, sources, trail_px, start, telemetry, overrides })
            }
            None => FrameAttitude::unknown(sources),
        };
        let is_given = overrides.camera_from_icrs.is_some() || overrides.identity.is_some();
        if let Some(start) = start.filter(|_| !is_given)
            && let Some(start) = &self.start_of_unexplained(sources, &attitude, &start)
        {
            attitude =
                self.attitude(&AttitudeInput { context, sources, trail_px, start, telemetry, overrides });
        }
        let known = self.known_sources(&attitude, trail_px);
        let exposure_s = telemetry.exposure_s;
        let unlisted_stars = self.unlisted_stars(&attitude, sources, exposure_s, context.threshold_e);
        let inputs = TargetContext {
            context,
            sources,
            attitude: &attitude,
            known: &known,
            exposure_s,
            unlisted_stars,
        };
        let mut images = self.candidates(inputs, overrides);
        let candidates: Vec<TargetCandidate> = images.iter().map(|image| image.candidate).collect();
        self.update_tracks(&candidates, &inputs);
        self.last = Some(LastFrame { time: telemetry.time, camera_from_icrs: attitude.camera_from_icrs });

        let chosen = self.chosen_candidate(&candidates);
        let solution = match chosen.and_then(|chosen| images.get_mut(chosen.index)) {
            Some(image) => {
                self.fit_candidate(inputs, image);
                let log_odds = chosen.map(|chosen| chosen.log_odds);
                Solution::Detected(self.measurement(image, inputs, overrides, log_odds))
            }
            None if sources.is_empty() => Solution::NoSolution(NoSolution::EmptyFrame),
            None => Solution::NoSolution(NoSolution::NoTarget),
        };
        let target_cluster = chosen.and_then(|chosen| images.get(chosen.index)?.cluster);
        Outcome {
            solution,
            camera_from_icrs: attitude.camera_from_icrs,
            attitude_source: Some(attitude.source),
            n_stars: Some(attitude.n_stars),
            clusters: labelled_clusters(sources, &attitude, &images, target_cluster),
        }
    }

    /// Extends the tracks of possible targets by the candidates of a frame.
    fn update_tracks(&mut self, candidates: &[TargetCandidate], inputs: &TargetContext<'_>) {
        let threshold_e = inputs.context.threshold_e;
        let transmitted_px = transmitted_pixels(inputs.context.frame).max(1) as f64;
        let track_model = TrackModel {
            max_speed_px_per_s: self.config.best.max_speed_px_per_s,
            clutter_per_px2: (candidates.len() as f64 + 1.0) / transmitted_px,
            threshold_e_per_s: threshold_e / inputs.exposure_s,
        };
        let mut attitude_variance_px2: f64 = 0.0;
        for candidate in candidates {
            attitude_variance_px2 = attitude_variance_px2.max(candidate.attitude_variance_px2);
        }
        self.tracks.update(&FrameCandidates {
            candidates,
            model: &track_model,
            sky: Sky { camera_from_icrs: inputs.attitude.camera_from_icrs, model: &self.model },
            attitude_variance_px2,
        });
    }

    /// Returns the candidate of the track with the highest odds; `None` if they are too low, or if its centre
    /// is off the detector: such an object cannot be measured.
    fn chosen_candidate(&self, candidates: &[TargetCandidate]) -> Option<ChosenCandidate> {
        let (index, log_odds) =
            self.tracks.by_odds().find_map(|track| Some((track.candidate?, track.log_odds())))?;
        let is_on_detector = self.model.is_on_detector(candidates.get(index)?.position);
        (is_on_detector && log_odds >= self.config.best.min_log_odds)
            .then_some(ChosenCandidate { index, log_odds })
    }

    /// Returns the distribution of the stars in a frame that are not identified. Without an attitude every
    /// cluster may be a star.
    fn unlisted_stars(
        &self,
        attitude: &FrameAttitude,
        sources: &[Source],
        exposure_s: f64,
        threshold_e: f64,
    ) -> UnlistedStars {
        if attitude.camera_from_icrs.is_none() {
            return UnlistedStars::new(sources.len(), false, None, threshold_e);
        }
        let limit_e = self.star_limit_e(exposure_s);
        UnlistedStars::new(attitude.expected.len(), attitude.n_stars > 0, limit_e, threshold_e)
    }

    /// Returns the flux of a star at the limit of the star list, electrons; `None` without a list or a scale
    /// of brightness.
    fn star_limit_e(&self, exposure_s: f64) -> Option<f64> {
        let magnitude = self.star_limit.filter(|_| self.brightness.source != ScaleSource::Unknown)?;
        Some(libm::exp(self.brightness.log_ratio) * self.unscaled_flux_e(magnitude, exposure_s))
    }

    /// Returns the expected stars of known flux as known sources for the fit of a target's image.
    fn known_sources(&self, attitude: &FrameAttitude, trail_px: [f64; 2]) -> Vec<KnownSource> {
        let image = self.psf.image(trail_px);
        let known = |star: &ExpectedStar| {
            let flux_e = star.flux_e?;
            Some(KnownSource { position: star.position, flux_e, flux_sigma: STAR_FLUX_SIGMA, image })
        };
        attitude.expected.iter().filter_map(known).collect()
    }
}

/// Candidate that a frame's measurement is made of.
#[derive(Debug, Clone, Copy)]
struct ChosenCandidate {
    index: usize,
    /// Logarithm of the odds that its track is the target.
    log_odds: f64,
}

/// Returns the clusters of a frame with their labels, at the fitted positions where there are any.
fn labelled_clusters(
    sources: &[Source],
    attitude: &FrameAttitude,
    images: &[CandidateImage],
    target_cluster: Option<usize>,
) -> Vec<Cluster> {
    let mut positions: Vec<PixelPoint> = sources.iter().map(|source| source.centre).collect();
    for (index, position) in &attitude.fitted {
        positions[*index] = *position;
    }
    for image in images {
        if let (Some(index), Some(fit)) = (image.cluster, &image.fit) {
            positions[index] = fit.position;
        }
    }
    let mut clusters = Vec::with_capacity(sources.len());
    for (index, source) in sources.iter().enumerate() {
        let label = match attitude.star_of[index] {
            _ if target_cluster == Some(index) => Label::Target,
            Some(id) => Label::Star(id),
            None if source.spike.is_some() => Label::Hotspot,
            None => Label::Candidate,
        };
        clusters.push(Cluster {
            position: positions[index],
            size: source.blob.size,
            pixels: source.blob.pixels,
            label,
        });
    }
    clusters
}

#[cfg(test)]
mod tests {
    use contract::{Calibration, Camera, Direction, ListedStar, PsfCalibration, Rotation, Setup};
    use hifitime::Epoch;
    use nalgebra::Vector3;

    use super::super::lost_in_space::tests::Random;
    use super::*;
    use crate::far_range::config::{AberrationConfig, FarRangeConfig};

    const SIDE: usize = 64;
    const FOCAL_PX: f64 = 2000.0;
    const SIGMA_PX: f64 = 0.8;
    const EXPOSURE_S: f64 = 0.25;
    const ZERO_MAGNITUDE_E_PER_S: f64 = 1.5e6;
    const READOUT: Readout =
        Readout { gain_e_per_dn: 10.0, bias_dn: 40.3, read_noise_e: 15.0, saturation_dn: 4095 };

    /// Positions and fluxes, px and electrons. The last star has its core at the left edge of the image.
    const STARS: [(PixelPoint, f64); 5] = [
        (PixelPoint { x: 20.3, y: 14.2 }, 80_000.0),
        (PixelPoint { x: 45.7, y: 18.4 }, 60_000.0),
        (PixelPoint { x: 17.4, y: 47.8 }, 90_000.0),
        (PixelPoint { x: 50.2, y: 50.3 }, 70_000.0),
        (PixelPoint { x: 0.1, y: 32.6 }, 75_000.0),
    ];

    /// Returns a frame of the stars on a background of 20 e, with noise.
    fn frame() -> Frame {
        let mut random = Random(45);
        let share = |pixel: usize, centre: f64| {
            let cumulative =
                |edge: f64| 0.5 * libm::erf((edge - centre) / (SIGMA_PX * std::f64::consts::SQRT_2));
            cumulative(pixel as f64 + 0.5) - cumulative(pixel as f64 - 0.5)
        };
        let dn = (0..SIDE * SIDE).map(|i| {
            let (column, row) = (i % SIDE, i / SIDE);
            let of = |(at, flux_e): &(PixelPoint, f64)| flux_e * share(column, at.x) * share(row, at.y);
            let expected_e = 20.0 + STARS.iter().map(of).sum::<f64>();
            let sigma_e = (expected_e + READOUT.read_noise_e * READOUT.read_noise_e).sqrt();
            let electrons = expected_e + sigma_e * random.normal();
            (electrons / READOUT.gain_e_per_dn + READOUT.bias_dn).round() as u16
        });
        Frame::new(0, SIDE, SIDE, 12, dn.collect(), None).unwrap()
    }

    fn pipeline() -> BestPipeline {
        let centre_px = 0.5 * (SIDE as f64 - 1.0);
        let stars = STARS.iter().zip(1..).map(|((at, flux_e), id)| ListedStar {
            id,
            direction: Direction::from_vector(Vector3::new(
                (at.x - centre_px) / FOCAL_PX,
                (at.y - centre_px) / FOCAL_PX,
                1.0,
            ))
            .unwrap(),
            magnitude: -2.5 * libm::log10(flux_e / (ZERO_MAGNITUDE_E_PER_S * EXPOSURE_S)),
        });
        let setup = Setup {
            camera: Camera {
                columns: SIDE,
                rows: SIDE,
                focal_length_mm: FOCAL_PX / 100.0,
                pixel_width_um: 10.0,
                pixel_height_um: 10.0,
                principal_x_px: centre_px,
                principal_y_px: centre_px,
                radial: [0.0; 3],
                tangential: [0.0; 2],
            },
            camera_from_body: Rotation::identity(),
            bit_depth: 12,
            readout: Some(READOUT),
            calibration: Calibration {
                psf: Some(PsfCalibration { sigma_px: SIGMA_PX, halo_sigma_px: 4.0, halo_fraction: 0.0 }),
                full_well_e: Some(60_000.0),
                spill_fraction: Some(0.0),
                response_sigma: Some(0.0),
                zero_magnitude_e_per_s: Some(ZERO_MAGNITUDE_E_PER_S),
                target: None,
                attitude: None,
            },
            zero_suppression_dn: None,
            stars: stars.collect(),
        };
        let config = FarRangeConfig { aberration: AberrationConfig::Ignore, ..FarRangeConfig::default() };
        BestPipeline::new(config, &setup).unwrap()
    }

    /// The noise of the fits is below 0.01 px. The centre of brightness of the star at the edge is off by
    /// more than ten times the tolerance.
    #[test]
    fn the_clusters_of_stars_are_at_their_fitted_positions() {
        let (mut pipeline, frame) = (pipeline(), frame());
        let telemetry = Telemetry {
            time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
            exposure_s: EXPOSURE_S,
            body_from_icrs: Rotation::identity(),
            velocity_km_s: None,
        };
        let outcome = pipeline.process_with(&frame, &telemetry, &Overrides::default());
        let background = pipeline.background.estimate(&frame).unwrap();
        let photometry = pipeline.photometry(&frame, background);
        let thresholds = pipeline.config.thresholds.for_frame(&frame, Some(background));
        let mut detector = std::mem::take(&mut pipeline.detector);
        detector.find_bright(&frame, thresholds);
        let blobs = detector.detect(&frame, thresholds, background.median_dn, 100).to_vec();
        let centres: Vec<PixelPoint> = blobs
            .iter()
            .enumerate()
            .map(|(i, blob)| {
                photometry.source(&frame, blob, detector.members(i), &pipeline.psf.image([0.0; 2])).centre
            })
            .collect();
        for ((truth, _), id) in STARS.iter().zip(1..) {
            let is_this = |cluster: &&Cluster| cluster.label == Label::Star(id);
            let cluster = outcome.clusters.iter().find(is_this).unwrap();
            let nearest = centres.iter().map(|centre| centre.distance(*truth)).fold(f64::INFINITY, f64::min);
            assert!(cluster.position.distance(*truth) < 0.02, "star {id} at {truth:?}: {cluster:?}");
            assert!(id < 5 || nearest > 0.2, "centre of brightness at the edge: {nearest} px");
        }
    }
}
