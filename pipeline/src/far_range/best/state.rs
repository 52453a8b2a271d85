//! State of the best mode, kept from frame to frame.

use contract::{CameraFrame, Icrs, Readout, Rotation, Setup, TargetCalibration};
use hifitime::Epoch;

use super::config::AttitudePrior;
use super::faint_points::FaintPoints;
use super::hot_pixels::HotPixels;
use super::lost_in_space::LostInSpace;
use super::mounting::MountingFilter;
use super::photometry::SourceFitter;
use super::point_image::PointImageEstimate;
use super::rescaling::Rescaling;
use super::tracks::Tracks;
use super::unlisted_stars::magnitude_limit;
use crate::far_range::background::BackgroundEstimator;
use crate::far_range::config::FarRangeConfig;
use crate::far_range::detect::Detector;
use crate::far_range::identify::StarList;
use crate::{CameraModel, PipelineError};

/// Best mode for one sequence of frames.
#[derive(Debug)]
pub(in crate::far_range) struct BestPipeline {
    pub(super) config: FarRangeConfig,
    /// Camera as stated, and with the focal length in use.
    pub(super) stated_model: CameraModel,
    pub(super) model: CameraModel,
    pub(super) stars: StarList,
    /// Magnitude that counts as the limit of the star list; `None` for an empty list.
    pub(super) star_limit: Option<f64>,
    pub(super) readout: Option<Readout>,
    pub(super) calibration: PhotometryCalibration,
    pub(super) mounting: MountingFilter,
    /// True if the stars of the frame contradict the stated focal length.
    pub(super) is_rescaled: bool,
    /// State of the search for the focal length of frames with a prior attitude.
    pub(super) rescaling: Rescaling,
    /// Solver for frames without a prior attitude.
    pub(super) lost_in_space: Option<LostInSpace>,
    pub(super) psf: PointImageEstimate,
    /// Brightness scale of the stars.
    pub(super) brightness: Brightness,
    pub(super) hot_pixels: HotPixels,
    pub(super) tracks: Tracks,
    pub(super) background: BackgroundEstimator,
    pub(super) detector: Detector,
    pub(super) faint_points: FaintPoints,
    pub(super) fitter: SourceFitter,
    pub(super) last: Option<LastFrame>,
}

/// Calibration parameters for photometry.
#[derive(Debug, Clone, Copy)]
pub(super) struct PhotometryCalibration {
    pub(super) response: f64,
    pub(super) full_well_e: f64,
    pub(super) may_spill: bool,
    pub(super) zero_magnitude_e_per_s: Option<f64>,
    pub(super) target: Option<TargetCalibration>,
}

/// Scale of the brightness of stars, estimated over frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Brightness {
    /// Natural logarithm of the ratio of measured flux to that by the calibration, or by
    /// [`UNKNOWN_ZERO_MAGNITUDE`].
    pub(super) log_ratio: f64,
    pub(super) source: ScaleSource,
}

/// Source of a brightness scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScaleSource {
    Unknown,
    Calibration,
    Stars,
}

/// Time and attitude of the previous frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastFrame {
    pub(super) time: Epoch,
    pub(super) camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
}

/// Default response of single pixels without a calibration, relative standard deviation.
const UNKNOWN_RESPONSE: f64 = 0.01;

/// Default photoelectrons per second from a star of V = 0 without a calibration: an aperture of one square
/// centimetre in front of silicon.
const UNKNOWN_ZERO_MAGNITUDE: f64 = 1.5e6;

impl BestPipeline {
    /// Creates a pipeline before its first frame.
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
        let widest = model.with_focal_ratio(1.0 - config.best.focal_length_tolerance);
        Ok(Self {
            star_limit: magnitude_limit(&setup.stars)
                .map(|limit| limit.min(config.identification.max_magnitude)),
            stars: StarList::new(&setup.stars, config.identification.max_magnitude, &widest),
            readout: setup.readout,
            calibration: PhotometryCalibration {
                response: calibration.response_sigma.unwrap_or(UNKNOWN_RESPONSE),
                full_well_e: calibration.full_well_e.unwrap_or(f64::INFINITY),
                may_spill: calibration.spill_fraction.is_none_or(|fraction| fraction > 0.0),
                zero_magnitude_e_per_s: calibration.zero_magnitude_e_per_s,
                target: calibration.target,
            },
            lost_in_space: (config.best.prior == AttitudePrior::None).then(|| {
                let max_magnitude = config.identification.max_magnitude;
                LostInSpace::new(&setup.stars, &model, max_magnitude, config.best.focal_length_tolerance)
            }),
            mounting: MountingFilter::new(setup.camera_from_body, calibration.attitude),
            psf: PointImageEstimate::new(calibration, config.best.psf_width_error),
            brightness: Brightness {
                log_ratio: 0.0,
                // Without a readout, fluxes are in digital numbers.
                source: match (setup.readout, calibration.zero_magnitude_e_per_s) {
                    (Some(_), Some(_)) => ScaleSource::Calibration,
                    _ => ScaleSource::Unknown,
                },
            },
            is_rescaled: false,
            rescaling: Rescaling::default(),
            hot_pixels: HotPixels::default(),
            tracks: Tracks::default(),
            background: BackgroundEstimator::default(),
            detector: Detector::default(),
            faint_points: FaintPoints::default(),
            fitter: SourceFitter::default(),
            last: None,
            stated_model: model.clone(),
            model,
            config,
        })
    }

    /// Returns the flux of a star by the calibration only, electrons.
    pub(super) fn unscaled_flux_e(&self, magnitude: f64, exposure_s: f64) -> f64 {
        let scale = self.calibration.zero_magnitude_e_per_s.unwrap_or(UNKNOWN_ZERO_MAGNITUDE);
        scale * exposure_s * libm::pow(10.0, -0.4 * magnitude)
    }
}
