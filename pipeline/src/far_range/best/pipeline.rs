//! The steps of the best mode in their order, and what is kept from frame to frame.

use contract::{
    AttitudeSource, CameraFrame, Cluster, Covariance2, Direction, Frame, Icrs, Label, Measurement,
    NoSolution, Outcome, PixelPoint, Readout, Rotation, Setup, Solution, TargetCalibration, Telemetry,
};
use hifitime::Epoch;
use nalgebra::Matrix2;

use super::config::AttitudePrior;
use super::hot_pixels::HotPixels;
use super::lost_in_space::{self, LostInSpace};
use super::mounting::{AttitudeError, MountingFilter};
use super::photometry::{
    FittedSource, FrameLight, KnownSource, PhotometryModel, Source, SourceFitter, TargetStart,
};
use super::point_image::PointImageEstimate;
use super::stars::{
    ExpectedStar, StarCandidate, StarMeasurement, image_covariance, matches_at_positions, matches_by_offset,
    solve_attitude,
};
use super::start::AttitudeStart;
use super::tracks::{TargetCandidate, TrackModel, Tracks};
use crate::far_range::aberration::apparent_direction;
use crate::far_range::background::{Background, BackgroundEstimator};
use crate::far_range::config::{AberrationConfig, FarRangeConfig};
use crate::far_range::detect::{Blob, Detector, transmitted_pixels};
use crate::far_range::identify::StarList;
use crate::far_range::overrides::{Identity, Overrides};
use crate::far_range::usable::unusable;
use crate::{CameraModel, PipelineError};

/// The best mode on one sequence of frames.
#[derive(Debug)]
pub(in crate::far_range) struct BestPipeline {
    config: FarRangeConfig,
    model: CameraModel,
    stars: StarList,
    readout: Option<Readout>,
    light: Calibrated,
    mounting: MountingFilter,
    /// With no prior attitude.
    lost_in_space: Option<LostInSpace>,
    psf: PointImageEstimate,
    /// Natural logarithm of measured over expected flux of stars.
    brightness: Brightness,
    hot_pixels: HotPixels,
    tracks: Tracks,
    background: BackgroundEstimator,
    detector: Detector,
    fitter: SourceFitter,
    last: Option<LastFrame>,
}

/// Numbers of the calibration that photometry needs.
#[derive(Debug, Clone, Copy)]
struct Calibrated {
    response: f64,
    full_well_e: f64,
    may_spill: bool,
    zero_magnitude_e_per_s: Option<f64>,
    target: Option<TargetCalibration>,
}

/// Scale of the brightness of stars, estimated over frames.
#[derive(Debug, Clone, Copy)]
struct Brightness {
    /// Natural logarithm of measured flux over that of the calibration, or of [`UNKNOWN_ZERO_MAGNITUDE`].
    log_ratio: f64,
    knowledge: ScaleKnowledge,
}

/// Where a brightness scale comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ScaleKnowledge {
    Nowhere,
    Calibration,
    Stars,
}

/// The frame before.
#[derive(Debug, Clone, Copy)]
struct LastFrame {
    time: Epoch,
    camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
}

/// The attitude of a frame and the stars that gave it.
struct FrameAttitude {
    /// `None` when neither telemetry nor stars give one.
    camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    error: AttitudeError,
    source: AttitudeSource,
    /// For each cluster the star that it is.
    star_of: Vec<Option<u32>>,
    n_stars: u32,
    expected: Vec<ExpectedStar>,
    /// Fitted positions of stars, by their clusters.
    fitted: Vec<(usize, PixelPoint)>,
}

/// Clusters looked at in the search for stars, the brightest.
const MAX_STAR_CANDIDATES: usize = 60;

/// Candidates for the target whose images are fitted as long as no track is settled, the brightest; those where the best track is expected always are.
const MAX_FITTED: usize = 2;

/// Exponent of the numbers of clutter by flux: N(> F) ∝ F^−1.2, that of the stars (Allen 1973, Astrophysical Quantities, §117).
const CLUTTER_EXPONENT: f64 = 1.2;

/// Odds of a cluster at the threshold of detection, natural logarithm.
const THRESHOLD_LOG_ODDS: f64 = -2.0;

/// Misfit from which on an unsaturated cluster is hardly a point or a small body, and the odds that it loses then.
const CLUTTER_MISFIT: f64 = 4.0;
const MISFIT_LOG_ODDS: f64 = 5.0;

/// Expected stars within this distance of a cluster are fitted with it, px.
const KNOWN_REACH_PX: f64 = 24.0;

/// Relative standard deviation of the flux of a star with the brightness scale known: colours and variability.
const STAR_FLUX_SIGMA: f64 = 0.4;

/// Standard deviation of the logarithm of the width of the target's image without a calibration of its size, and the least with one.
const UNKNOWN_BODY_LOG_WIDTH: f64 = 0.03;
const LEAST_BODY_LOG_WIDTH: f64 = 0.001;

/// Distance of the centre of brightness of a sunlit body from its centre, along an axis, over half its size: standard deviation. That of a Lambert
/// sphere is up to 0.6 at a phase of 90°, that of a plate with the Sun behind the camera 0.
const BRIGHTNESS_OFFSET: f64 = 0.35;

/// Odds of a track from which on its target is looked for where no cluster is, and the signal-to-noise ratio that its light must have there.
const FORCED_LOG_ODDS: f64 = 4.0;
const FORCED_SNR: f64 = 4.0;
const FORCED_REACH_PX: f64 = 4.0;

impl FrameAttitude {
    /// Of a frame that neither telemetry nor stars give an attitude.
    fn unknown(sources: &[Source]) -> Self {
        let source = match sources.iter().filter(|source| source.spike.is_none()).count() {
            0 => AttitudeSource::NoStars,
            count if count < lost_in_space::LEAST_MATCHED => AttitudeSource::TooFewStars,
            _ => AttitudeSource::NoMatch,
        };
        let any = nalgebra::Matrix3::identity() * (std::f64::consts::PI * std::f64::consts::PI);
        Self {
            camera_from_icrs: None,
            error: AttitudeError { mean: nalgebra::Vector3::zeros(), covariance: any },
            source,
            star_of: vec![None; sources.len()],
            n_stars: 0,
            expected: Vec::new(),
            fitted: Vec::new(),
        }
    }
}

impl BestPipeline {
    /// A pipeline before its first frame.
    ///
    /// # Errors
    /// Those of the checks of configuration, camera, calibration and readout.
    pub(in crate::far_range) fn new(config: FarRangeConfig, setup: &Setup) -> Result<Self, PipelineError> {
        config.check()?;
        config.check_suppression(setup.zero_suppression_dn, setup.bit_depth)?;
        setup.calibration.check().map_err(contract::ContractError::from)?;
        if let Some(readout) = setup.readout {
            readout.check().map_err(contract::ContractError::from)?;
        }
        let model = CameraModel::new(&setup.camera)?;
        let calibration = &setup.calibration;
        Ok(Self {
            stars: StarList::new(&setup.stars, config.identification.max_magnitude, &model),
            readout: setup.readout,
            light: Calibrated {
                response: calibration.response_sigma.unwrap_or(UNKNOWN_RESPONSE),
                full_well_e: calibration.full_well_e.unwrap_or(f64::INFINITY),
                may_spill: calibration.spill_fraction.is_none_or(|fraction| fraction > 0.0),
                zero_magnitude_e_per_s: calibration.zero_magnitude_e_per_s,
                target: calibration.target,
            },
            lost_in_space: (config.best.prior == AttitudePrior::None)
                .then(|| LostInSpace::new(&setup.stars, &model, config.identification.max_magnitude)),
            mounting: MountingFilter::new(setup.camera_from_body, calibration.attitude),
            psf: PointImageEstimate::new(calibration, config.best.psf_width_error),
            brightness: Brightness {
                log_ratio: 0.0,
                // Without a readout, fluxes are in digital numbers.
                knowledge: match (setup.readout, calibration.zero_magnitude_e_per_s) {
                    (Some(_), Some(_)) => ScaleKnowledge::Calibration,
                    _ => ScaleKnowledge::Nowhere,
                },
            },
            hot_pixels: HotPixels::default(),
            tracks: Tracks::default(),
            background: BackgroundEstimator::default(),
            detector: Detector::default(),
            fitter: SourceFitter::default(),
            last: None,
            model,
            config,
        })
    }

    /// [`contract::Pipeline::process`] with results of single steps given from outside.
    pub(in crate::far_range) fn process_with(
        &mut self,
        frame: &Frame,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        if let Some(reason) = unusable(frame, telemetry, &self.model) {
            return Outcome::none(NoSolution::Failed(reason));
        }
        let elapsed_s = self.advance(telemetry);
        let Some(background) = self.background.estimate(frame) else {
            return Outcome::none(NoSolution::EmptyFrame);
        };
        let thresholds = self.config.thresholds.of(frame, Some(background));
        if 2 * self.detector.look(frame, thresholds) > transmitted_pixels(frame) {
            return Outcome::none(NoSolution::SaturatedFrame);
        }
        let max_clusters = self.config.max_clusters as usize;
        let blobs: Vec<Blob> =
            self.detector.detect(frame, thresholds, background.median_dn, max_clusters).to_vec();
        let photometry = self.photometry(frame, background);
        let detector = std::mem::take(&mut self.detector);
        let hot_pixels = std::mem::take(&mut self.hot_pixels);
        let light = FrameLight { frame, detector: &detector, model: &photometry, hot_pixels: &hot_pixels };
        let sources: Vec<Source> = blobs
            .iter()
            .enumerate()
            .map(|(i, blob)| photometry.source(frame, blob, detector.members(i), &self.psf.image([0.0; 2])))
            .collect();
        let least_e =
            self.threshold_flux_e(f64::from(thresholds.high_dn) - background.median_dn, &photometry);
        let outcome = self.answer(light, &sources, least_e, telemetry, elapsed_s, overrides);
        self.detector = detector;
        self.hot_pixels = hot_pixels;
        for spike in sources.iter().filter_map(|source| source.spike) {
            self.hot_pixels.count(spike);
        }
        outcome
    }

    /// Lets the time since the last frame pass, s; `None` where no frame of the sequence came before.
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
        // Without a readout the noise of the background stands for it, and the digital numbers for electrons.
        let readout = self.readout.unwrap_or(Readout {
            gain_e_per_dn: 1.0,
            bias_dn: background.median_dn,
            read_noise_e: background.sigma_dn,
            saturation_dn: frame.full_scale_dn(),
        });
        let gain = readout.gain_e_per_dn;
        PhotometryModel {
            readout,
            response: self.light.response,
            full_well_e: self.light.full_well_e,
            may_spill: self.light.may_spill,
            background_e: (background.median_dn - readout.bias_dn) * gain,
            pixel_sigma_e: background.sigma_dn * gain,
        }
    }

    /// Flux of a point whose central pixel is at the threshold, electrons.
    fn threshold_flux_e(&self, above_background_dn: f64, photometry: &PhotometryModel) -> f64 {
        let image = self.psf.image([0.0; 2]);
        (above_background_dn.max(1.0) * photometry.readout.gain_e_per_dn / image.central_share()).max(1.0)
    }

    fn answer(
        &mut self,
        light: FrameLight<'_>,
        sources: &[Source],
        least_e: f64,
        telemetry: &Telemetry,
        elapsed_s: Option<f64>,
        overrides: &Overrides<'_>,
    ) -> Outcome {
        let start = self.start(sources, telemetry, overrides);
        let trail_px = self.trail_px(telemetry, elapsed_s, start.as_ref());
        let attitude = match &start {
            Some(start) => self.attitude(light, sources, trail_px, start, telemetry, overrides),
            None => FrameAttitude::unknown(sources),
        };
        let known = self.known_sources(&attitude, trail_px);
        let (mut candidates, mut fits, mut cluster_of) = (Vec::new(), Vec::new(), Vec::new());
        let fitted_in_any_case = if self.tracks.is_settled() { 0 } else { MAX_FITTED };
        for i in self.target_clusters(light, sources, &attitude, overrides) {
            let source = &sources[i];
            let fit = (candidates.len() < fitted_in_any_case || self.tracks.is_expected(source.centre))
                .then(|| {
                    self.fit_target(light, source, light.detector.members(i), &known, telemetry.exposure_s)
                })
                .flatten();
            let log_odds = self.log_odds(source, fit.as_ref(), least_e);
            candidates.push(self.candidate(source, fit.as_ref(), log_odds, telemetry.exposure_s, &attitude));
            fits.push(fit);
            cluster_of.push(Some(i));
        }
        if let Some((candidate, fit)) =
            self.forced(light, &candidates, &known, telemetry.exposure_s, &attitude)
        {
            candidates.push(candidate);
            fits.push(Some(fit));
            cluster_of.push(None);
        }
        let track_model = TrackModel {
            max_speed_px_per_s: self.config.best.max_speed_px_per_s,
            clutter_per_px2: (sources.len() as f64 + 1.0) / transmitted_pixels(light.frame).max(1) as f64,
        };
        let model = &self.model;
        let position_of = |direction: &Direction<Icrs>| {
            model.project_vector(&attitude.camera_from_icrs?.rotate(direction.vector()))
        };
        self.tracks.update(&candidates, &track_model, &position_of);
        self.last = Some(LastFrame { time: telemetry.time, camera_from_icrs: attitude.camera_from_icrs });

        let chosen = self
            .tracks
            .best()
            .find_map(|track| track.candidate.filter(|_| track.log_odds >= self.config.best.min_log_odds));
        if let Some(c) = chosen
            && fits[c].is_none()
            && let Some(i) = cluster_of[c]
        {
            let fit =
                self.fit_target(light, &sources[i], light.detector.members(i), &known, telemetry.exposure_s);
            candidates[c].position = fit.map_or(candidates[c].position, |fit: FittedSource| fit.position);
            fits[c] = fit;
        }
        let solution = match chosen {
            Some(c) => Solution::Detected(self.measurement(
                &candidates[c],
                fits[c].as_ref(),
                &attitude,
                light.frame,
                telemetry.exposure_s,
                overrides,
            )),
            None if sources.is_empty() => Solution::NoSolution(NoSolution::EmptyFrame),
            None => Solution::NoSolution(NoSolution::NoTarget),
        };
        let mut positions: Vec<PixelPoint> = sources.iter().map(|source| source.centre).collect();
        let targets =
            cluster_of.iter().zip(&fits).filter_map(|(i, fit)| Some(((*i)?, fit.as_ref()?.position)));
        for (i, position) in attitude.fitted.iter().copied().chain(targets) {
            positions[i] = position;
        }
        let clusters = sources.iter().enumerate().map(|(i, source)| Cluster {
            position: positions[i],
            size: source.blob.size,
            pixels: source.blob.pixels,
            label: match attitude.star_of[i] {
                _ if chosen.and_then(|c| cluster_of[c]) == Some(i) => Label::Target,
                Some(id) => Label::Star(id),
                None if source.spike.is_some() => Label::Hotspot,
                None => Label::Candidate,
            },
        });
        Outcome {
            solution,
            camera_from_icrs: attitude.camera_from_icrs,
            attitude_source: Some(attitude.source),
            n_stars: Some(attitude.n_stars),
            clusters: clusters.collect(),
        }
    }

    /// Length of the trail of a star during the exposure along columns and rows, px, by the turn of the camera since the last frame.
    fn trail_px(
        &self,
        telemetry: &Telemetry,
        elapsed_s: Option<f64>,
        start: Option<&AttitudeStart>,
    ) -> [f64; 2] {
        let last = self.last.and_then(|last| last.camera_from_icrs);
        let (Some(elapsed_s), Some(last), Some(start)) = (elapsed_s, last, start) else { return [0.0; 2] };
        let turn = (start.attitude(start.prior.mean) * last.inverse()).quaternion().scaled_axis();
        let (fx, fy) = self.model.focal_px();
        let part = telemetry.exposure_s / elapsed_s;
        // Of the boresight; the noise of the attitude is far below a star's image here.
        [(fx * turn.y * part).abs().min(20.0), (fy * turn.x * part).abs().min(20.0)]
    }

    /// The attitude that the frame starts from; `None` without a prior when its stars give none.
    fn start(
        &self,
        sources: &[Source],
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Option<AttitudeStart> {
        let prior = self.mounting.prior();
        match (&self.lost_in_space, overrides.camera_from_icrs) {
            (None, _) => {
                Some(AttitudeStart { reference: self.mounting.reference(telemetry.body_from_icrs), prior })
            }
            (Some(_), Some(reference)) => Some(AttitudeStart { reference, prior }),
            (Some(solver), None) => {
                let stars: Vec<(PixelPoint, f64)> = sources
                    .iter()
                    .filter(|source| source.spike.is_none())
                    .map(|source| (source.centre, source.flux_e))
                    .collect();
                solver.solve(&stars).map(|found| AttitudeStart::from_found(&found))
            }
        }
    }

    /// The attitude of the frame, and which clusters are stars.
    fn attitude(
        &mut self,
        light: FrameLight<'_>,
        sources: &[Source],
        trail_px: [f64; 2],
        start: &AttitudeStart,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> FrameAttitude {
        let prior = start.prior;
        let of = |error: nalgebra::Vector3<f64>| match overrides.camera_from_icrs {
            Some(given) => given,
            None => start.attitude(error),
        };
        let mut camera_from_icrs = of(prior.mean);
        let mut expected = self.expected_stars(&camera_from_icrs, telemetry, overrides);
        if let Some(identity) = overrides.identity {
            return self.given_attitude(light, sources, trail_px, start, overrides, identity, expected);
        }
        let mut order: Vec<usize> = (0..sources.len()).filter(|&i| sources[i].spike.is_none()).collect();
        order.sort_by(|&a, &b| sources[b].flux_e.total_cmp(&sources[a].flux_e).then(a.cmp(&b)));
        order.truncate(MAX_STAR_CANDIDATES);
        let candidates: Vec<StarCandidate> = order
            .iter()
            .map(|&i| StarCandidate {
                position: sources[i].centre,
                flux_e: sources[i].flux_e,
                is_saturated: sources[i].saturated > 0,
            })
            .collect();
        let (fx, fy) = self.model.focal_px();
        let at_centre = image_covariance(&prior.covariance, 0.0, 0.0, (fx, fy));
        let sigma_px = [at_centre[(0, 0)].sqrt(), at_centre[(1, 1)].sqrt()];
        let sigma_roll = prior.covariance[(2, 2)].sqrt();
        let mut matched = matches_by_offset(&candidates, &expected, sigma_px, sigma_roll);
        let mut fits: Vec<Option<Option<FittedSource>>> = vec![None; candidates.len()];
        let mut error = prior;
        let (mut measured, mut of_match) = (Vec::new(), Vec::new());
        // Once with the stars of the common offset, once with all that are where they then must be.
        for _ in 0..2 {
            measured.clear();
            of_match.clear();
            matched.sort_by(|a, b| candidates[b.0].flux_e.total_cmp(&candidates[a.0].flux_e).then(a.cmp(b)));
            for &(c, s) in &matched {
                if measured.len() >= self.config.best.max_stars as usize || is_blended(&expected, s) {
                    continue;
                }
                let i = order[c];
                let fit = *fits[c].get_or_insert_with(|| {
                    self.fitter.point(light, &sources[i], light.detector.members(i), &self.psf, trail_px)
                });
                if let Some(star) = self.star_measurement(&sources[i], fit, &expected[s], overrides) {
                    measured.push(star);
                    of_match.push((c, s));
                }
            }
            let Some(solved) = solve_attitude(&measured, &prior, of, &self.model) else { break };
            let dropped: Vec<(usize, usize)> = of_match
                .iter()
                .zip(&solved.used)
                .filter(|(_, used)| !**used)
                .map(|(pair, _)| *pair)
                .collect();
            matched.retain(|pair| !dropped.contains(pair));
            measured = retained(measured, &solved.used);
            of_match = retained(of_match, &solved.used);
            error = solved.error;
            camera_from_icrs = of(error.mean);
            for star in &mut expected {
                if let Some(position) = self.model.project_vector(&camera_from_icrs.rotate(&star.apparent)) {
                    star.position = position;
                }
            }
            let at_centre = image_covariance(&error.covariance, 0.1, 0.1, (fx, fy));
            let gate_px = 1.0 + 3.5 * at_centre[(0, 0)].max(at_centre[(1, 1)]).sqrt();
            if matched.is_empty() {
                break;
            }
            matched = matches_at_positions(&candidates, &expected, |_| gate_px);
        }
        // Its own fits decide at last which clusters are stars: within four standard deviations of where the attitude has them.
        let mut star_of = vec![None; sources.len()];
        let mut n_stars = 0;
        for &(c, s) in &matched {
            let position = fits[c].flatten().map_or(candidates[c].position, |fit| fit.position);
            let at = image_covariance(&error.covariance, 0.1, 0.1, (fx, fy));
            let limit_px =
                4.0 * libm::hypot(
                    at[(0, 0)].max(at[(1, 1)]).sqrt(),
                    if fits[c].flatten().is_some() { 0.1 } else { 0.3 },
                ) + 0.2;
            if position.distance(expected[s].position) <= limit_px {
                star_of[order[c]] = Some(expected[s].star.id);
                n_stars += 1;
            }
        }
        let is_star: Vec<bool> =
            of_match.iter().map(|&(c, s)| star_of[order[c]] == Some(expected[s].star.id)).collect();
        if is_star.contains(&false) {
            // A star that is not where its own attitude has it gave no attitude.
            let measured = retained(measured, &is_star);
            error = solve_attitude(&measured, &prior, of, &self.model).map_or(prior, |solved| solved.error);
            camera_from_icrs = of(error.mean);
        }
        if overrides.camera_from_icrs.is_none() && self.lost_in_space.is_none() {
            self.mounting.update(&prior, &error);
        }
        self.learn(&matched, &candidates, &expected, &fits, telemetry.exposure_s);
        let source = match n_stars {
            0 => AttitudeSource::NoStars,
            1 => AttitudeSource::TooFewStars,
            _ => AttitudeSource::Stars,
        };
        let fitted =
            fits.iter().zip(&order).filter_map(|(fit, &i)| Some((i, fit.flatten()?.position))).collect();
        let camera_from_icrs = Some(camera_from_icrs);
        FrameAttitude { camera_from_icrs, error, source, star_of, n_stars, expected, fitted }
    }

    /// The attitude with the identities of clusters given from outside.
    #[allow(clippy::too_many_arguments, reason = "the state of one frame, half way")]
    fn given_attitude(
        &mut self,
        light: FrameLight<'_>,
        sources: &[Source],
        trail_px: [f64; 2],
        start: &AttitudeStart,
        overrides: &Overrides<'_>,
        identity: &dyn Fn(PixelPoint) -> Identity,
        expected: Vec<ExpectedStar>,
    ) -> FrameAttitude {
        let star_of: Vec<Option<u32>> = sources
            .iter()
            .map(|source| match identity(source.centre) {
                Identity::Star(id) => Some(id),
                _ => None,
            })
            .collect();
        let mut measured = Vec::new();
        for (i, id) in star_of.iter().enumerate().filter_map(|(i, id)| Some((i, (*id)?))) {
            let Some(s) = expected.iter().position(|star| star.star.id == id) else { continue };
            if measured.len() >= self.config.best.max_stars as usize || is_blended(&expected, s) {
                continue;
            }
            let fit = self.fitter.point(light, &sources[i], light.detector.members(i), &self.psf, trail_px);
            measured.extend(self.star_measurement(&sources[i], fit, &expected[s], overrides));
        }
        let of = |error: nalgebra::Vector3<f64>| match overrides.camera_from_icrs {
            Some(given) => given,
            None => start.attitude(error),
        };
        let prior = start.prior;
        let error = solve_attitude(&measured, &prior, of, &self.model).map_or(prior, |solved| solved.error);
        let camera_from_icrs = Some(of(error.mean));
        if self.lost_in_space.is_none() {
            self.mounting.update(&prior, &error);
        }
        let n_stars = measured.len() as u32;
        let source = if n_stars >= 2 { AttitudeSource::Stars } else { AttitudeSource::TooFewStars };
        FrameAttitude { camera_from_icrs, error, source, star_of, n_stars, expected, fitted: Vec::new() }
    }

    /// Listed stars where they are expected, by an attitude of the camera.
    fn expected_stars(
        &self,
        camera_from_icrs: &Rotation<CameraFrame, Icrs>,
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Vec<ExpectedStar> {
        let scale = libm::exp(self.brightness.log_ratio);
        self.stars
            .predict(camera_from_icrs, &self.model)
            .into_iter()
            .filter_map(|predicted| {
                let star = predicted.star;
                let apparent = match (overrides.apparent, self.config.aberration) {
                    (Some(apparent), _) => *apparent(&star).vector(),
                    (None, AberrationConfig::Ignore) => *star.direction.vector(),
                    (None, AberrationConfig::Correct) => {
                        apparent_direction(telemetry.time, telemetry.velocity_km_s, star.direction.vector())
                    }
                };
                let position = self.model.project_vector(&camera_from_icrs.rotate(&apparent))?;
                let flux_e = (self.brightness.knowledge != ScaleKnowledge::Nowhere)
                    .then(|| scale * self.unscaled_flux_e(star.magnitude, telemetry.exposure_s));
                Some(ExpectedStar { star, apparent, position, flux_e })
            })
            .collect()
    }

    fn star_measurement(
        &self,
        source: &Source,
        fit: Option<FittedSource>,
        expected: &ExpectedStar,
        overrides: &Overrides<'_>,
    ) -> Option<StarMeasurement> {
        let fit = fit?;
        let floor = self.config.best.star_floor_px * self.config.best.star_floor_px;
        let misfit = fit.image.misfit().max(1.0);
        let [xx, _, yy] = fit.image.covariance_px2;
        let position =
            overrides.centroid.and_then(|centroid| centroid(source.blob.centre)).unwrap_or(fit.position);
        Some(StarMeasurement {
            position,
            variance_px2: [misfit * xx + floor, misfit * yy + floor],
            apparent: expected.apparent,
        })
    }

    /// Takes the widths and the brightness of the stars into their estimates.
    fn learn(
        &mut self,
        matched: &[(usize, usize)],
        candidates: &[StarCandidate],
        expected: &[ExpectedStar],
        fits: &[Option<Option<FittedSource>>],
        exposure_s: f64,
    ) {
        if !self.config.best.sequence {
            return;
        }
        let mut log_ratios = Vec::new();
        for &(c, s) in matched {
            let Some(fit) = fits[c].flatten() else { continue };
            if candidates[c].is_saturated {
                continue;
            }
            self.psf.take(&fit.image);
            if fit.image.flux_e > 0.0 {
                let star = &expected[s];
                let unscaled = self.unscaled_flux_e(star.star.magnitude, exposure_s);
                // An exposure of 0 s gives no scale.
                let log_ratio = libm::log(fit.image.flux_e / unscaled);
                log_ratios.extend(Some(log_ratio).filter(|ratio| ratio.is_finite()));
            }
        }
        if log_ratios.len() >= 3 {
            log_ratios.sort_by(f64::total_cmp);
            let median = log_ratios[log_ratios.len() / 2];
            let gain = match self.brightness.knowledge {
                ScaleKnowledge::Nowhere => 1.0,
                ScaleKnowledge::Calibration => 0.5,
                ScaleKnowledge::Stars => 0.1,
            };
            self.brightness.log_ratio += gain * (median - self.brightness.log_ratio);
            self.brightness.knowledge = ScaleKnowledge::Stars;
        }
    }

    /// Flux of a star by the calibration alone, electrons.
    fn unscaled_flux_e(&self, magnitude: f64, exposure_s: f64) -> f64 {
        let scale = self.light.zero_magnitude_e_per_s.unwrap_or(UNKNOWN_ZERO_MAGNITUDE);
        scale * exposure_s * libm::pow(10.0, -0.4 * magnitude)
    }

    /// Expected stars of known flux as known sources under the image of a target.
    fn known_sources(&self, attitude: &FrameAttitude, trail_px: [f64; 2]) -> Vec<KnownSource> {
        let image = self.psf.image(trail_px);
        let known = |star: &ExpectedStar| {
            let flux_e = star.flux_e?;
            Some(KnownSource { position: star.position, flux_e, flux_sigma: STAR_FLUX_SIGMA, image })
        };
        attitude.expected.iter().filter_map(known).collect()
    }

    /// Clusters that may be the target, the brightest first.
    fn target_clusters(
        &self,
        light: FrameLight<'_>,
        sources: &[Source],
        attitude: &FrameAttitude,
        overrides: &Overrides<'_>,
    ) -> Vec<usize> {
        let is_hot = |source: &Source| {
            source.spike.is_some() || {
                let (x, y) = (source.centre.x.round(), source.centre.y.round());
                source.blob.pixels <= 2
                    && x >= 0.0
                    && y >= 0.0
                    && light.hot_pixels.contains(y as usize * light.frame.columns() + x as usize)
            }
        };
        let mut clusters: Vec<usize> = (0..sources.len())
            .filter(|&i| match overrides.identity {
                Some(identity) => identity(sources[i].centre) == Identity::Neither,
                None => attitude.star_of[i].is_none() && !is_hot(&sources[i]),
            })
            .collect();
        clusters.sort_by(|&a, &b| sources[b].flux_e.total_cmp(&sources[a].flux_e).then(a.cmp(&b)));
        clusters
    }

    fn fit_target(
        &mut self,
        light: FrameLight<'_>,
        source: &Source,
        members: &[u32],
        known: &[KnownSource],
        exposure_s: f64,
    ) -> Option<FittedSource> {
        let near: Vec<KnownSource> = known
            .iter()
            .filter(|star| {
                star.position.distance(source.centre) <= KNOWN_REACH_PX && star.flux_e > 1e-3 * source.flux_e
            })
            .copied()
            .collect();
        let start = TargetStart {
            position: source.centre,
            position_sigma_px: f64::INFINITY,
            flux_e: source.flux_e,
            body_log_width: self.body_log_width(source.flux_e, exposure_s),
            members,
            is_saturated: source.saturated > 0,
            is_cut: source.is_cut,
        };
        self.fitter.target(light, &start, &self.psf, &near)
    }

    /// Half the angular size of the target by its flux, rad; `None` without a calibration of it.
    fn angular_radius(&self, flux_e: f64, exposure_s: f64) -> Option<f64> {
        let target = self.light.target?;
        let range_m = 1000.0 * (target.e_per_s_at_1_km * exposure_s / flux_e.max(1e-9)).sqrt();
        Some(target.radius_m / range_m)
    }

    /// Error of the centroid by the structure of the body, px: a body of half the size a with a skewness of 1 shifts what pixels at three widths from the
    /// centre give by (3² − 3) μ₃/(6 σ²), with its third moment μ₃ = (a/√3)³ (Gram–Charlier series of the image).
    fn structure_px(&self, flux_e: f64, exposure_s: f64) -> f64 {
        let Some(radius) = self.angular_radius(flux_e, exposure_s) else { return 0.0 };
        let (fx, fy) = self.model.focal_px();
        let deviation_px = radius * fx.max(fy) / 3.0_f64.sqrt();
        let sigma_px = self.psf.image([0.0; 2]).sigma_px;
        // A body larger than the image of a point is resolved: its structure is no skewness of a point any more.
        (deviation_px * deviation_px * deviation_px / (sigma_px * sigma_px)).min(deviation_px)
    }

    /// Standard deviation of the logarithm of the width of the target's image: a uniform body of half the size a widens a Gaussian of width σ by
    /// a²/(6 σ²).
    fn body_log_width(&self, flux_e: f64, exposure_s: f64) -> f64 {
        let Some(radius) = self.angular_radius(flux_e, exposure_s) else { return UNKNOWN_BODY_LOG_WIDTH };
        let (fx, fy) = self.model.focal_px();
        let size_px = radius * fx.max(fy) / self.psf.image([0.0; 2]).sigma_px;
        (size_px * size_px / 6.0).clamp(LEAST_BODY_LOG_WIDTH, 0.5)
    }

    /// Natural logarithm of the odds that a cluster is the target, by its brightness and shape alone.
    fn log_odds(&self, source: &Source, fit: Option<&FittedSource>, least_e: f64) -> f64 {
        let mut log_odds =
            THRESHOLD_LOG_ODDS + CLUTTER_EXPONENT * libm::log((source.flux_e / least_e).max(1e-3));
        if source.saturated == 0
            && let Some(fit) = fit
            && (fit.image.misfit() > CLUTTER_MISFIT || fit.image.width < 0.6)
        {
            log_odds -= MISFIT_LOG_ODDS;
        }
        log_odds
    }

    fn candidate(
        &self,
        source: &Source,
        fit: Option<&FittedSource>,
        log_odds: f64,
        exposure_s: f64,
        attitude: &FrameAttitude,
    ) -> TargetCandidate {
        let position = fit.map_or(source.centre, |fit| fit.position);
        let fitted_flux_e = fit.map(|fit| fit.image.flux_e).filter(|flux_e| *flux_e > 0.0);
        let variance_px2 = fit.map_or(0.1, |fit| {
            let [xx, _, yy] = fit.image.covariance_px2;
            xx.max(yy).min(4.0)
        });
        TargetCandidate {
            position,
            variance_px2,
            flux_e_per_s: fitted_flux_e.unwrap_or(source.flux_e) / exposure_s,
            is_flux_bounded: fitted_flux_e.is_none() && (source.saturated > 0 || source.is_cut),
            log_odds,
            direction: self.direction(position, attitude),
        }
    }

    fn direction(&self, position: PixelPoint, attitude: &FrameAttitude) -> Option<Direction<Icrs>> {
        Some(attitude.camera_from_icrs?.inverse() * self.model.back_project(position)?)
    }

    /// The target where the best track predicts it, when no candidate is there: too faint for a cluster, or merged with a star.
    fn forced(
        &mut self,
        light: FrameLight<'_>,
        candidates: &[TargetCandidate],
        known: &[KnownSource],
        exposure_s: f64,
        attitude: &FrameAttitude,
    ) -> Option<(TargetCandidate, FittedSource)> {
        let track = *self.tracks.best().next()?;
        let sigma_px = track.variance_px2().sqrt();
        if track.log_odds < FORCED_LOG_ODDS || sigma_px > FORCED_REACH_PX {
            return None;
        }
        let reach_px = 4.0 * sigma_px + 1.0;
        if candidates.iter().any(|candidate| candidate.position.distance(track.position) <= reach_px) {
            return None;
        }
        let near: Vec<KnownSource> = known
            .iter()
            .filter(|star| star.position.distance(track.position) <= KNOWN_REACH_PX)
            .copied()
            .collect();
        let (rate, rate_sigma) = track.flux_e_per_s();
        let start = TargetStart {
            position: track.position,
            position_sigma_px: sigma_px,
            flux_e: rate * exposure_s,
            body_log_width: self.body_log_width(rate * exposure_s, exposure_s),
            members: &[],
            is_saturated: false,
            is_cut: false,
        };
        let fit = self.fitter.target(light, &start, &self.psf, &near)?;
        let log_flux = libm::log((fit.image.flux_e / (rate * exposure_s)).max(1e-9));
        let is_seen = fit.image.flux_e > FORCED_SNR * fit.image.flux_sigma_e
            && log_flux.abs() < 3.0 * rate_sigma.max(0.3)
            && fit.image.misfit() < CLUTTER_MISFIT;
        let [xx, _, yy] = fit.image.covariance_px2;
        is_seen.then(|| {
            let candidate = TargetCandidate {
                position: fit.position,
                variance_px2: xx.max(yy),
                flux_e_per_s: fit.image.flux_e / exposure_s,
                is_flux_bounded: false,
                log_odds: THRESHOLD_LOG_ODDS,
                direction: self.direction(fit.position, attitude),
            };
            (candidate, fit)
        })
    }

    /// The answer: position and line of sight of the target with their covariances.
    fn measurement(
        &self,
        candidate: &TargetCandidate,
        fit: Option<&FittedSource>,
        attitude: &FrameAttitude,
        frame: &Frame,
        exposure_s: f64,
        overrides: &Overrides<'_>,
    ) -> Measurement {
        let given = overrides.centroid.and_then(|centroid| centroid(candidate.position));
        let (columns, rows) = (frame.columns() as f64, frame.rows() as f64);
        let fitted = given.unwrap_or(candidate.position);
        // The centre of a cut image may lie a fraction of a pixel off the detector.
        let position = PixelPoint::new(fitted.x.clamp(-0.5, columns - 0.5), fitted.y.clamp(-0.5, rows - 0.5));
        let line_of_sight = self.direction(position, attitude);
        let centroid = match (given, fit) {
            (None, Some(fit)) => {
                let structure_px = self.structure_px(fit.image.flux_e, exposure_s);
                let floor = self.config.best.target_floor_px * self.config.best.target_floor_px
                    + structure_px * structure_px;
                let misfit = fit.image.misfit().max(1.0);
                let [xx, xy, yy] = fit.image.covariance_px2.map(|element| misfit * element);
                Some(Matrix2::new(xx + floor, xy, xy, yy + floor))
            }
            _ => None,
        };
        let offset = fit
            .and_then(|fit| self.angular_radius(fit.image.flux_e, exposure_s))
            .map_or(0.0, |radius| BRIGHTNESS_OFFSET * radius);
        let of = |matrix: Matrix2<f64>| {
            Covariance2::from_matrix(matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 1)]).ok()
        };
        Measurement {
            position,
            position_covariance: centroid.and_then(of),
            line_of_sight,
            line_of_sight_covariance: centroid.and_then(|centroid| {
                of(self.line_of_sight_covariance(position, centroid, offset, attitude)?)
            }),
        }
    }

    /// Covariance of the angles atan2(X, Z) and atan2(Y, Z) of the line of sight, rad², from those of the centroid, px², and of the attitude, and from the
    /// standard deviation of the distance between centre of brightness and body, rad.
    fn line_of_sight_covariance(
        &self,
        position: PixelPoint,
        centroid: Matrix2<f64>,
        offset: f64,
        attitude: &FrameAttitude,
    ) -> Option<Matrix2<f64>> {
        attitude.camera_from_icrs?;
        let (u, v) = self.model.to_ideal(position)?;
        let (fx, fy) = self.model.focal_px();
        let (x, y) = (u / fx, v / fy);
        // dα = d(X/Z)/(1 + (X/Z)²). The distortion changes the scale of a pixel by less than a percent.
        let by_ideal = Matrix2::new(1.0 / (fx * (1.0 + x * x)), 0.0, 0.0, 1.0 / (fy * (1.0 + y * y)));
        let in_image = centroid + image_covariance(&attitude.error.covariance, x, y, (fx, fy));
        Some(by_ideal * in_image * by_ideal.transpose() + Matrix2::identity() * (offset * offset))
    }
}

/// Response of single pixels without a calibration, relative standard deviation.
const UNKNOWN_RESPONSE: f64 = 0.01;

/// Photoelectrons per second from a star of V = 0 without a calibration: an aperture of a square centimetre before silicon.
const UNKNOWN_ZERO_MAGNITUDE: f64 = 1.5e6;

/// Distance of another listed star within which an image is that of both, px, and the part of the flux from which on it disturbs.
const BLEND_PX: f64 = 5.0;
const BLEND_FRACTION: f64 = 0.02;

/// The entries whose flag is set.
fn retained<T>(entries: Vec<T>, flags: &[bool]) -> Vec<T> {
    entries.into_iter().zip(flags).filter(|(_, flag)| **flag).map(|(entry, _)| entry).collect()
}

/// Whether another listed star shines into the image of star `s`.
fn is_blended(stars: &[ExpectedStar], s: usize) -> bool {
    let flux = |star: &ExpectedStar| libm::pow(10.0, -0.4 * star.star.magnitude);
    stars.iter().enumerate().any(|(other, star)| {
        other != s
            && star.position.distance(stars[s].position) < BLEND_PX
            && flux(star) > BLEND_FRACTION * flux(&stars[s])
    })
}
