//! The steps of the best mode in their order, and what is kept from frame to frame.

use contract::{
    CameraFrame, Cluster, Direction, Frame, Icrs, Label, NoSolution, Outcome, PixelPoint, Readout, Rotation,
    Setup, Solution, TargetCalibration, Telemetry,
};
use hifitime::Epoch;

use super::config::AttitudePrior;
use super::faint_points::FaintPoints;
use super::frame_attitude::FrameAttitude;
use super::hot_pixels::HotPixels;
use super::lost_in_space::LostInSpace;
use super::mounting::MountingFilter;
use super::photometry::{FrameLight, KnownSource, PhotometryModel, Source, SourceFitter};
use super::point_image::PointImageEstimate;
use super::stars::ExpectedStar;
use super::target::TargetContext;
use super::tracks::{TargetCandidate, TrackModel, Tracks};
use crate::far_range::background::{Background, BackgroundEstimator};
use crate::far_range::config::FarRangeConfig;
use crate::far_range::detect::{Blob, Detector, transmitted_pixels};
use crate::far_range::identify::StarList;
use crate::far_range::overrides::Overrides;
use crate::far_range::usable::unusable;
use crate::{CameraModel, PipelineError};

/// The best mode on one sequence of frames.
#[derive(Debug)]
pub(in crate::far_range) struct BestPipeline {
    pub(super) config: FarRangeConfig,
    pub(super) model: CameraModel,
    pub(super) stars: StarList,
    pub(super) readout: Option<Readout>,
    pub(super) light: Calibrated,
    pub(super) mounting: MountingFilter,
    /// With no prior attitude.
    pub(super) lost_in_space: Option<LostInSpace>,
    pub(super) psf: PointImageEstimate,
    /// Natural logarithm of measured over expected flux of stars.
    pub(super) brightness: Brightness,
    pub(super) hot_pixels: HotPixels,
    pub(super) tracks: Tracks,
    pub(super) background: BackgroundEstimator,
    pub(super) detector: Detector,
    pub(super) faint_points: FaintPoints,
    pub(super) fitter: SourceFitter,
    pub(super) last: Option<LastFrame>,
}

/// Numbers of the calibration that photometry needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Calibrated {
    pub(super) response: f64,
    pub(super) full_well_e: f64,
    pub(super) may_spill: bool,
    pub(super) zero_magnitude_e_per_s: Option<f64>,
    pub(super) target: Option<TargetCalibration>,
}

/// Scale of the brightness of stars, estimated over frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Brightness {
    /// Natural logarithm of measured flux over that of the calibration, or of [`UNKNOWN_ZERO_MAGNITUDE`].
    pub(super) log_ratio: f64,
    pub(super) knowledge: ScaleKnowledge,
}

/// Where a brightness scale comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScaleKnowledge {
    Nowhere,
    Calibration,
    Stars,
}

/// The frame before.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastFrame {
    pub(super) time: Epoch,
    pub(super) camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
}

/// Relative standard deviation of the flux of a star with the brightness scale known: colours and variability.
const STAR_FLUX_SIGMA: f64 = 0.4;

/// Response of single pixels without a calibration, relative standard deviation.
const UNKNOWN_RESPONSE: f64 = 0.01;

/// Photoelectrons per second from a star of V = 0 without a calibration: an aperture of a square centimetre before silicon.
const UNKNOWN_ZERO_MAGNITUDE: f64 = 1.5e6;

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
            faint_points: FaintPoints::default(),
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
        let threshold_e =
            self.threshold_flux_e(f64::from(thresholds.high_dn) - background.median_dn, &photometry);
        let light = FrameLight {
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
        let outcome = self.answer(light, &sources, telemetry, elapsed_s, overrides);
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
        let exposure_s = telemetry.exposure_s;
        let of = TargetContext { light, sources, attitude: &attitude, known: &known, exposure_s };
        let mut images = self.candidates(of, overrides);
        let candidates: Vec<TargetCandidate> = images.iter().map(|image| image.candidate).collect();
        let track_model = TrackModel {
            max_speed_px_per_s: self.config.best.max_speed_px_per_s,
            clutter_per_px2: (candidates.len() as f64 + 1.0) / transmitted_pixels(light.frame).max(1) as f64,
            threshold_e_per_s: light.threshold_e / exposure_s,
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
        let solution = match chosen.and_then(|c| images.get_mut(c)) {
            Some(image) => {
                self.fit_candidate(of, image);
                Solution::Detected(self.measurement(image, of, overrides))
            }
            None if sources.is_empty() => Solution::NoSolution(NoSolution::EmptyFrame),
            None => Solution::NoSolution(NoSolution::NoTarget),
        };
        let target_cluster = chosen.and_then(|c| images.get(c)?.cluster);
        let mut positions: Vec<PixelPoint> = sources.iter().map(|source| source.centre).collect();
        let targets = images.iter().filter_map(|image| Some((image.cluster?, image.fit.as_ref()?.position)));
        for (i, position) in attitude.fitted.iter().copied().chain(targets) {
            positions[i] = position;
        }
        let clusters = sources.iter().enumerate().map(|(i, source)| Cluster {
            position: positions[i],
            size: source.blob.size,
            pixels: source.blob.pixels,
            label: match attitude.star_of[i] {
                _ if target_cluster == Some(i) => Label::Target,
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

    /// Flux of a star by the calibration alone, electrons.
    pub(super) fn unscaled_flux_e(&self, magnitude: f64, exposure_s: f64) -> f64 {
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
}
