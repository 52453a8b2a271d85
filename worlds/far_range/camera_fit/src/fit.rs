//! The steps of a fit in order.

use contract::{Camera, CameraFrame, Icrs, OutOfRange, PixelPoint, Rotation};
use files::{GreyImage, PixelConversion};
use hifitime::Epoch;
use rayon::prelude::*;
use sim::SimError;

use crate::adjustment::{AdjustedCamera, Adjustment, Observation, Term};
use crate::epoch::{EpochOffset, epoch_offset};
use crate::left_out::MAX_SQUARE;
use crate::mixture::group_of_one_camera;
use crate::reading::{Reading, has_swapped_bytes, other_reading};
use crate::rounds::{FittedRounds, MIN_ALL_STARS, MIN_STARS, SolvedFrames, adjust_in_rounds};
use crate::solution::{FrameSolution, solve_frames};
use crate::sources::{ImageSources, find_sources};
use crate::star_list::SkyList;
use crate::stars::photometry::{Photometry, photometry};
use crate::stars::profile::{StarProfile, star_profile};

/// Number of pixels with the largest value of all frames from which it is the saturation level.
const MIN_SATURATED: usize = 4;

/// A frame of the night sky.
#[derive(Debug, Clone)]
pub struct SkyFrame {
    /// Name in messages.
    pub name: String,
    /// Grey values.
    pub image: GreyImage,
}

/// What is known of the camera beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstGuess {
    /// Width of the field along columns, degrees, 0.5 to 120.
    pub field_deg: f64,
    /// Largest relative error of the field, 0 to 0.2.
    pub tolerance: f64,
    /// Width and height of a pixel, µm, each 0.01 to 1e4: they set the unit of the focal length, and its
    /// ratio along columns and rows.
    pub pixel_um: [f64; 2],
    /// Time of the frames, UTC.
    pub time: Epoch,
}

/// Reason why no camera was fitted.
#[derive(Debug)]
pub enum FitError {
    /// No frame was given.
    NoFrames,
    /// Frames of different sizes: columns and rows of the first, and the name and size of another one.
    OtherSize([usize; 2], String, [usize; 2]),
    /// No frame has an attitude; the reason of each.
    NoAttitude(Vec<UnsolvedFrame>),
    /// The images are not as a camera shows the sky.
    Reading {
        /// Frame by which it was found.
        name: String,
        /// How they must be read.
        reading: Reading,
    },
    /// The stars of the frames are too few, or do not determine the camera.
    TooFewStars(usize),
    /// A value of the first guess is out of range.
    Guess(OutOfRange),
    /// The time is outside the ephemerides.
    Time(SimError),
}

impl std::fmt::Display for FitError {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoFrames => formatter.write_str("no frames, expected at least one"),
            Self::OtherSize(first, name, other) => write!(
                formatter,
                "{name}: is {} × {} pixels, expected {} × {} as the first frame: a camera has one size",
                other[0], other[1], first[0], first[1]
            ),
            Self::NoAttitude(frames) => {
                formatter.write_str("the stars of no frame fit the catalogue")?;
                for frame in frames.iter().take(8) {
                    write!(formatter, "\n  {}: {}", frame.name, frame.reason)?;
                }
                formatter.write_str(
                    "\nCheck the field (--field-deg, --tolerance), and that the images show \
                     at least five stars brighter than V = 10.",
                )
            }
            Self::Reading { name, reading } => write!(formatter, "{name}: {reading}"),
            Self::TooFewStars(count) => write!(
                formatter,
                "{count} stars in all frames, expected at least {MIN_ALL_STARS}: add frames"
            ),
            Self::Guess(error) => error.fmt(formatter),
            Self::Time(error) => error.fmt(formatter),
        }
    }
}

impl std::error::Error for FitError {}

/// A frame without an attitude.
#[derive(Debug, Clone, PartialEq)]
pub struct UnsolvedFrame {
    /// Name of the frame.
    pub name: String,
    /// Number of its sources that are no spikes.
    pub sources: usize,
    /// Reason.
    pub reason: String,
}

/// A frame with its attitude.
#[derive(Debug, Clone)]
pub struct FittedFrame {
    /// Name of the frame.
    pub name: String,
    /// Attitude.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Number of stars.
    pub stars: usize,
    /// Root mean square of their residuals along an axis, px.
    pub rms_px: f64,
}

/// A star of a frame that took part in a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatchedStar {
    /// Index of the frame in [`CameraFit::frames`].
    pub frame: usize,
    /// Number in the Hipparcos catalogue.
    pub id: u32,
    /// Visual magnitude.
    pub magnitude: f64,
    /// Colour index B−V, if known.
    pub b_v: Option<f64>,
    /// Measured position, px.
    pub position: PixelPoint,
    /// Measured minus computed position, px.
    pub residual_px: [f64; 2],
    /// Standard deviation of the residual along an axis, px.
    pub sigma_px: f64,
    /// Flux above the background, DN.
    pub flux_dn: f64,
    /// Width of the profile, standard deviation of a Gaussian, px; NaN if it is wider than the window.
    pub width_px: f64,
    /// Height in the smoothed image, standard deviations of its noise.
    pub significance: f64,
}

/// A fitted camera.
#[derive(Debug, Clone)]
pub struct CameraFit {
    /// Camera.
    pub camera: Camera,
    /// Terms with the standard deviation of their parameter (mm, px, px⁻², px⁻⁴, px⁻⁶, px⁻¹), and true
    /// if the stars determine it: at least twice as well as what is assumed beforehand.
    pub sigmas: Vec<(Term, f64, bool)>,
    /// Adjustment with all stars.
    pub adjustment: Adjustment,
    /// Frames with an attitude.
    pub frames: Vec<FittedFrame>,
    /// Frames without an attitude.
    pub unsolved: Vec<UnsolvedFrame>,
    /// Root mean square of the residuals of all stars along an axis, px, those beyond five standard
    /// deviations counted as five.
    pub rms_px: f64,
    /// The same of stars left out of the adjustment; NaN if there are too few to leave any out.
    pub left_out_rms_px: f64,
    /// Number of stars.
    pub stars: usize,
    /// Stars of all frames.
    pub matched: Vec<MatchedStar>,
    /// Profile of the stars; `None` with too few bright ones.
    pub profile: Option<StarProfile>,
    /// Median of the widths of unsaturated stars, standard deviation of a Gaussian, px; `None` without one.
    pub width_px: Option<f64>,
    /// Background and noise of a pixel, medians over the frames, DN.
    pub background_dn: f64,
    /// Noise of a pixel, median over the frames, DN.
    pub noise_dn: f64,
    /// Brightness scale; `None` with too few stars.
    pub photometry: Option<Photometry>,
    /// Value of a saturated pixel, DN: the largest value of the frames if several pixels have it, otherwise
    /// `full_scale`.
    pub saturation_dn: f64,
    /// Largest value that a pixel of the files can have.
    pub full_scale: f64,
    /// True if the frames were converted from colour.
    pub is_colour: bool,
    /// Number of frames of another camera, which are left out: they are among [`CameraFit::unsolved`].
    pub other_cameras: usize,
    /// Epoch of the stars by their proper motions, relative to the stated time; `None` if the stars do not
    /// determine it.
    pub epoch: Option<EpochOffset>,
}

/// Fits a camera to frames.
///
/// # Errors
/// [`FitError`].
pub fn fit_camera(frames: &[SkyFrame], guess: &FirstGuess) -> Result<CameraFit, FitError> {
    let first_camera = first_camera(frames, guess)?;
    if let Some(frame) = frames.iter().find(|frame| has_swapped_bytes(&frame.image)) {
        return Err(FitError::Reading { name: frame.name.clone(), reading: Reading::BytesSwapped });
    }
    let list = SkyList::new(guess.time).map_err(FitError::Time)?;
    let saturation_dn = saturation_dn(frames);
    let sources: Vec<ImageSources> =
        frames.par_iter().map(|frame| find_sources(&frame.image, saturation_dn)).collect();
    let refuse = |error: contract::ContractError| {
        FitError::Guess(OutOfRange::new("field_deg", error.to_string(), "a possible camera"))
    };
    let solutions = solve_frames(&sources, &list.stars, &first_camera, guess.tolerance).map_err(refuse)?;
    let mut unsolved = unsolved_frames(frames, &sources, &solutions);
    if unsolved.len() == frames.len() {
        let other = other_reading(frames, &sources, &list.stars, &first_camera, guess.tolerance);
        return Err(match other.map_err(refuse)? {
            Some((name, reading)) => FitError::Reading { name, reading },
            None => FitError::NoAttitude(unsolved),
        });
    }
    let (group, contradictions) = group_of_one_camera(&solutions, &first_camera, &sources, &list);
    let members: Vec<(usize, &FrameSolution)> =
        group.iter().filter_map(|&frame| Some((frame, solutions[frame].as_ref()?))).collect();
    let camera = AdjustedCamera::new(&camera_of_solutions(&first_camera, &members));
    let mut solved = SolvedFrames::new(&members);
    let rounds =
        adjust_in_rounds(&camera, &mut solved, &sources, &list, true).map_err(FitError::TooFewStars)?;
    let FittedRounds { fitted, adjustment, left_out_rms_px } = rounds;
    let left_out = |frame: usize, reason: String| UnsolvedFrame {
        name: frames[frame].name.clone(),
        sources: star_like(&sources[frame]),
        reason,
    };
    for &frame in &solved.dropped {
        let reason = format!("fewer than {MIN_STARS} stars fit the camera of the other frames");
        unsolved.push(left_out(frame, reason));
    }
    for contradiction in &contradictions {
        unsolved.push(left_out(contradiction.frame, contradiction.reason(&fitted)));
    }
    let observations = solved.observations(&sources, &list);
    // Near the end of the ephemerides there is no later year to compare with.
    let epoch = epoch_offset(&camera, &adjustment, &observations, guess.time).ok().flatten();
    let stars = observations.len();
    Ok(CameraFit {
        sigmas: Term::ALL.iter().map(|term| parameter(&camera, *term, &adjustment, &fitted)).collect(),
        frames: solved.fitted_frames(frames, &adjustment),
        rms_px: rms_px(&observations, &adjustment),
        left_out_rms_px: left_out_rms_px.unwrap_or(f64::NAN),
        stars,
        matched: solved.matched_stars(&sources, &list, &adjustment),
        profile: star_profile(&fitted, &solved.profile_stars(frames, &sources)),
        width_px: median(solved.widths_px(&sources)),
        background_dn: median(sources.iter().map(|frame| frame.background_dn).collect()).unwrap_or(f64::NAN),
        noise_dn: median(sources.iter().map(|frame| frame.noise_dn).collect()).unwrap_or(f64::NAN),
        photometry: photometry(&solved.lights(&fitted, &sources, &list)),
        saturation_dn,
        full_scale: frames.iter().map(|frame| frame.image.full_scale).fold(0.0, f64::max),
        is_colour: frames.iter().any(|frame| frame.image.conversion == PixelConversion::MeanOfColours),
        other_cameras: contradictions.len(),
        epoch,
        camera: fitted,
        adjustment,
        unsolved,
    })
}

/// Returns the value of a saturated pixel: the largest value of all frames if pixels pile up at it (at least
/// four, and more than in the tenth below it), otherwise the largest value that the files can hold. A
/// converter of 12 or 14 bits fills files of 16 bits only to a part.
pub fn saturation_dn(frames: &[SkyFrame]) -> f64 {
    let full_scale = frames.iter().map(|frame| frame.image.full_scale).fold(0.0, f64::max);
    let mut largest = f32::NEG_INFINITY;
    for frame in frames {
        largest = frame.image.values.iter().copied().fold(largest, f32::max);
    }
    let (mut at_largest, mut below) = (0, 0);
    for value in frames.iter().flat_map(|frame| &frame.image.values) {
        at_largest += usize::from(*value == largest);
        below += usize::from(*value < largest && *value >= 0.9 * largest);
    }
    let is_piled_up = at_largest >= MIN_SATURATED && at_largest > below;
    if is_piled_up { f64::from(largest) } else { full_scale }
}

/// Returns the camera with the median focal length and distortion of the solutions of its frames.
fn camera_of_solutions(first: &Camera, members: &[(usize, &FrameSolution)]) -> Camera {
    let of_all = |value: fn(&FrameSolution) -> f64| {
        median(members.iter().map(|(_, solution)| value(solution)).collect())
    };
    let ratio = of_all(|solution| solution.focal_ratio).unwrap_or(1.0);
    let radial = of_all(|solution| solution.added_radial).unwrap_or(0.0);
    first_with(first, ratio, radial)
}

/// Returns a camera with another focal length, over its own, and an added radial distortion, px⁻².
pub(crate) fn first_with(first: &Camera, focal_ratio: f64, added_radial: f64) -> Camera {
    let [k1, k2, k3] = first.radial;
    Camera {
        focal_length_mm: first.focal_length_mm * focal_ratio,
        radial: [k1 + added_radial, k2, k3],
        ..first.clone()
    }
}

/// Returns the camera of the first guess.
pub(crate) fn first_camera(frames: &[SkyFrame], guess: &FirstGuess) -> Result<Camera, FitError> {
    let Some(first) = frames.first() else { return Err(FitError::NoFrames) };
    let size = [first.image.columns, first.image.rows];
    for frame in frames {
        let other = [frame.image.columns, frame.image.rows];
        if other != size {
            return Err(FitError::OtherSize(size, frame.name.clone(), other));
        }
    }
    let refuse = |path: &str, value: f64, expected: &str| {
        Err(FitError::Guess(OutOfRange::new(path, value.to_string(), expected)))
    };
    if !(0.5..=120.0).contains(&guess.field_deg) {
        return refuse("field_deg", guess.field_deg, "0.5 to 120");
    }
    if !(0.0..=0.2).contains(&guess.tolerance) {
        return refuse("tolerance", guess.tolerance, "0 to 0.2");
    }
    let half_field = 0.5 * guess.field_deg.to_radians();
    let [width_um, height_um] = guess.pixel_um;
    let camera = Camera {
        columns: size[0],
        rows: size[1],
        focal_length_mm: 0.5 * size[0] as f64 * width_um * 1e-3 / libm::tan(half_field),
        pixel_width_um: width_um,
        pixel_height_um: height_um,
        principal_x_px: 0.5 * size[0] as f64 - 0.5,
        principal_y_px: 0.5 * size[1] as f64 - 0.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    };
    camera.check().map_err(FitError::Guess)?;
    Ok(camera)
}

/// Returns the root mean square of the residuals along an axis, with a limit for single wrong stars.
fn rms_px(observations: &[Observation], adjustment: &Adjustment) -> f64 {
    let mut squares = 0.0;
    for (observation, [x, y]) in observations.iter().zip(&adjustment.residuals) {
        let sigma_px = adjustment.errors.sigma_px(observation.sigma_px);
        squares += (x * x + y * y).min(MAX_SQUARE * sigma_px * sigma_px);
    }
    (squares / (2.0 * observations.len() as f64)).sqrt()
}

fn unsolved_frames(
    frames: &[SkyFrame],
    sources: &[ImageSources],
    solutions: &[Option<FrameSolution>],
) -> Vec<UnsolvedFrame> {
    let mut unsolved = Vec::new();
    for (index, solution) in solutions.iter().enumerate() {
        if solution.is_some() {
            continue;
        }
        let count = star_like(&sources[index]);
        let reason = match (count, sources[index].trail_deg()) {
            (_, Some(deg)) => format!(
                "{count} sources are trails along {deg:.0}° from the columns to the rows: a trail of more than some \
                 7 px has no position along it; expose shorter"
            ),
            (0, _) => "no star-like source".to_owned(),
            (1, _) => "1 star-like source, five are needed".to_owned(),
            (2..=4, _) => format!("{count} star-like sources, five are needed"),
            _ => format!("{count} star-like sources, no set of them matches the catalogue"),
        };
        unsolved.push(UnsolvedFrame { name: frames[index].name.clone(), sources: count, reason });
    }
    unsolved
}

/// Returns the number of sources that are no spikes.
fn star_like(frame: &ImageSources) -> usize {
    frame.sources.iter().filter(|source| !source.is_spike).count()
}

/// Returns the standard deviation of a parameter, and true if the stars determine it.
fn parameter(
    camera: &AdjustedCamera,
    term: Term,
    adjustment: &Adjustment,
    fitted: &Camera,
) -> (Term, f64, bool) {
    let sigma = adjustment.covariance[term as usize][term as usize].sqrt();
    (term, camera.parameter_sigma(term, sigma, fitted), sigma < 0.5 * term.prior_sigma())
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
