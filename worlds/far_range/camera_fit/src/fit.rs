//! The steps of a fit in order.

use contract::{Camera, CameraFrame, Icrs, OutOfRange, PixelPoint, Rotation};
use files::{GreyImage, PixelConversion};
use hifitime::Epoch;
use pipeline::CameraModel;
use rayon::prelude::*;
use sim::SimError;

use crate::adjustment::{AdjustedCamera, Adjustment, Observation, PositionErrors, Term, adjust};
use crate::left_out::{MAX_SQUARE, left_out_rms_px};
use crate::photometry::{Photometry, StarLight, photometry};
use crate::profile::{ProfileStar, StarProfile, star_profile};
use crate::solution::{FrameSolution, solve_frames};
use crate::sources::{ImageSources, find_sources};
use crate::star_list::SkyList;

/// Largest distance between a listed star and its source in the first and in later rounds, px.
const GATES_PX: [f64; 4] = [4.0, 3.0, 2.0, 1.5];

/// Largest distance in standard deviations in the last round: χ² with two degrees of freedom exceeds its
/// square once in 3000. Not below half a pixel.
const GATE_SIGMAS: f64 = 4.0;
const MIN_GATE_PX: f64 = 0.5;

/// Terms of the first round, when only the stars near the centre are matched.
const FIRST_TERMS: [Term; 2] = [Term::FocalLength, Term::Radial1];

/// Number of pixels with the largest value of all frames from which it is the saturation level.
const MIN_SATURATED: usize = 4;

/// Smallest number of stars in a frame that takes part.
const MIN_STARS: usize = 4;

/// Smallest distance of a star whose profile is fitted from any other source, px.
const PROFILE_DISTANCE_PX: f64 = 12.0;

/// Smallest number of stars of all frames.
const MIN_ALL_STARS: usize = 8;

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
                    "\nCheck the field (--field-deg, --tolerance), that the images are not mirrored, and that they \
                     show at least five stars brighter than V = 10.",
                )
            }
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
    /// Number of pixels that are bright in at least half of the frames; `None` for fewer than three frames.
    pub hot_pixels: Option<usize>,
    /// Brightness scale; `None` with too few stars.
    pub photometry: Option<Photometry>,
    /// Value of a saturated pixel, DN: the largest value of the frames if several pixels have it, otherwise
    /// `full_scale`.
    pub saturation_dn: f64,
    /// Largest value that a pixel of the files can have.
    pub full_scale: f64,
    /// True if the frames were converted from colour.
    pub is_colour: bool,
}

/// Fits a camera to frames.
///
/// # Errors
/// [`FitError`].
pub fn fit_camera(frames: &[SkyFrame], guess: &FirstGuess) -> Result<CameraFit, FitError> {
    let first_camera = first_camera(frames, guess)?;
    let list = SkyList::new(guess.time).map_err(FitError::Time)?;
    let saturation_dn = saturation_dn(frames);
    let sources: Vec<ImageSources> =
        frames.par_iter().map(|frame| find_sources(&frame.image, saturation_dn)).collect();
    let solutions = solve_frames(&sources, &list.stars, &first_camera, guess.tolerance).map_err(|error| {
        FitError::Guess(OutOfRange::new("field_deg", error.to_string(), "a possible camera"))
    })?;
    let mut unsolved = unsolved_frames(frames, &sources, &solutions);
    let mut solved = SolvedFrames::new(&solutions);
    if solved.frames.is_empty() {
        return Err(FitError::NoAttitude(unsolved));
    }
    let camera = AdjustedCamera::new(&Camera {
        focal_length_mm: first_camera.focal_length_mm * solved.focal_ratio,
        ..first_camera.clone()
    });
    let mut fitted = camera.camera(&[0.0; crate::adjustment::TERMS]);
    let mut left_out = None;
    let mut adjusted = None;
    for (round, gate_px) in GATES_PX.into_iter().enumerate() {
        let is_last = round + 1 == GATES_PX.len();
        let errors = adjusted.as_ref().filter(|_| is_last).map(|adjusted: &Adjustment| adjusted.errors);
        solved.match_stars(&fitted, &sources, &list, gate_px, errors);
        let observations = solved.observations(&sources, &list);
        if observations.len() < MIN_ALL_STARS {
            return Err(FitError::TooFewStars(observations.len()));
        }
        let free: &[Term] = if round == 0 { &FIRST_TERMS } else { &Term::ALL };
        if is_last {
            left_out = left_out_rms_px(&camera, free, &solved.attitudes, &observations);
        }
        let found = adjust(&camera, free, &solved.attitudes, &observations)
            .ok_or(FitError::TooFewStars(observations.len()))?;
        fitted = camera.camera(&found.terms);
        solved.attitudes.clone_from(&found.attitudes);
        adjusted = Some(found);
    }
    let Some(adjustment) = adjusted else { return Err(FitError::NoFrames) };
    for &frame in &solved.dropped {
        let reason = format!("fewer than {MIN_STARS} stars fit the camera of the other frames");
        let name = frames[frame].name.clone();
        unsolved.push(UnsolvedFrame { name, sources: star_like(&sources[frame]), reason });
    }
    let observations = solved.observations(&sources, &list);
    let stars = observations.len();
    Ok(CameraFit {
        sigmas: Term::ALL.iter().map(|term| parameter(&camera, *term, &adjustment, &fitted)).collect(),
        frames: solved.fitted_frames(frames, &adjustment),
        rms_px: rms_px(&observations, &adjustment),
        left_out_rms_px: left_out.unwrap_or(f64::NAN),
        stars,
        matched: solved.matched_stars(&sources, &list, &adjustment),
        profile: star_profile(&fitted, &solved.profile_stars(frames, &sources)),
        width_px: median(solved.widths_px(&sources)),
        background_dn: median(sources.iter().map(|frame| frame.background_dn).collect()).unwrap_or(f64::NAN),
        noise_dn: median(sources.iter().map(|frame| frame.noise_dn).collect()).unwrap_or(f64::NAN),
        hot_pixels: hot_pixels(&sources),
        photometry: photometry(&solved.lights(&fitted, &sources, &list)),
        saturation_dn,
        full_scale: frames.iter().map(|frame| frame.image.full_scale).fold(0.0, f64::max),
        is_colour: frames.iter().any(|frame| frame.image.conversion == PixelConversion::MeanOfColours),
        camera: fitted,
        adjustment,
        unsolved,
    })
}

/// Returns the value of a saturated pixel: the largest value of all frames if pixels pile up at it (at least
/// four, and more than in the tenth below it), otherwise the largest value that the files can hold. A
/// converter of 12 or 14 bits fills files of 16 bits only to a part.
fn saturation_dn(frames: &[SkyFrame]) -> f64 {
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

/// Returns the camera of the first guess.
fn first_camera(frames: &[SkyFrame], guess: &FirstGuess) -> Result<Camera, FitError> {
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
        let reason = match count {
            0 => "no star-like source".to_owned(),
            1..=4 => format!("{count} star-like sources, five are needed"),
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

/// Frames with an attitude, and the sources that are stars.
struct SolvedFrames {
    /// Index of each frame among all.
    frames: Vec<usize>,
    attitudes: Vec<Rotation<CameraFrame, Icrs>>,
    /// Matched sources of each frame with their stars, by index.
    matched: Vec<Vec<(usize, usize)>>,
    /// Index of each frame whose stars do not fit the camera of all frames.
    dropped: Vec<usize>,
    /// Median focal length over that of the first guess.
    focal_ratio: f64,
}

impl SolvedFrames {
    fn new(solutions: &[Option<FrameSolution>]) -> Self {
        let (mut frames, mut attitudes, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for (index, solution) in solutions.iter().enumerate() {
            if let Some(solution) = solution {
                frames.push(index);
                attitudes.push(solution.camera_from_icrs);
                ratios.push(solution.focal_ratio);
            }
        }
        let matched = vec![Vec::new(); frames.len()];
        let focal_ratio = median(ratios).unwrap_or(1.0);
        Self { frames, attitudes, matched, dropped: Vec::new(), focal_ratio }
    }

    /// Matches listed stars and sources that are nearest to each other, within a gate. Frames that are left
    /// with too few stars are dropped: nothing would determine their attitude.
    fn match_stars(
        &mut self,
        camera: &Camera,
        sources: &[ImageSources],
        list: &SkyList,
        gate_px: f64,
        errors: Option<PositionErrors>,
    ) {
        let frames = std::mem::take(&mut self.frames);
        let attitudes = std::mem::take(&mut self.attitudes);
        self.matched.clear();
        for (frame, attitude) in frames.into_iter().zip(attitudes) {
            let places = star_places(camera, &attitude, list);
            let matched = mutual_matches(&places, &sources[frame], gate_px, errors);
            if matched.len() < MIN_STARS {
                self.dropped.push(frame);
                continue;
            }
            self.frames.push(frame);
            self.attitudes.push(attitude);
            self.matched.push(matched);
        }
    }

    fn observations(&self, sources: &[ImageSources], list: &SkyList) -> Vec<Observation> {
        let mut observations = Vec::new();
        for (place, matched) in self.matched.iter().enumerate() {
            for &(source, star) in matched {
                let source = &sources[self.frames[place]].sources[source];
                observations.push(Observation {
                    frame: place,
                    position: source.position,
                    sigma_px: source.sigma_px,
                    direction: *list.stars[star].direction.vector(),
                });
            }
        }
        observations
    }

    fn fitted_frames(&self, frames: &[SkyFrame], adjustment: &Adjustment) -> Vec<FittedFrame> {
        let mut fitted = Vec::new();
        let mut first = 0;
        for (place, matched) in self.matched.iter().enumerate() {
            let residuals = &adjustment.residuals[first..first + matched.len()];
            first += matched.len();
            let squares: f64 = residuals.iter().map(|[x, y]| x * x + y * y).sum();
            fitted.push(FittedFrame {
                name: frames[self.frames[place]].name.clone(),
                camera_from_icrs: adjustment.attitudes[place],
                stars: matched.len(),
                rms_px: (squares / (2.0 * matched.len() as f64)).sqrt(),
            });
        }
        fitted
    }

    /// Returns the stars of all frames, in the order of the residuals.
    fn matched_stars(
        &self,
        sources: &[ImageSources],
        list: &SkyList,
        adjustment: &Adjustment,
    ) -> Vec<MatchedStar> {
        let mut stars: Vec<MatchedStar> = Vec::with_capacity(adjustment.residuals.len());
        for (place, matched) in self.matched.iter().enumerate() {
            for &(source, star) in matched {
                let Some(&residual_px) = adjustment.residuals.get(stars.len()) else { return stars };
                let source = &sources[self.frames[place]].sources[source];
                stars.push(MatchedStar {
                    frame: place,
                    id: list.stars[star].id,
                    magnitude: list.stars[star].magnitude,
                    b_v: list.b_v[star],
                    position: source.position,
                    residual_px,
                    sigma_px: adjustment.errors.sigma_px(source.sigma_px),
                    flux_dn: source.flux_dn,
                    width_px: source.width_px,
                    significance: source.significance,
                });
            }
        }
        stars
    }

    /// Returns the stars whose profile can be fitted: no other source shares their pixels.
    fn profile_stars<'image>(
        &self,
        frames: &'image [SkyFrame],
        sources: &[ImageSources],
    ) -> Vec<ProfileStar<'image>> {
        let mut stars = Vec::new();
        for (place, matched) in self.matched.iter().enumerate() {
            let of_frame = &sources[self.frames[place]];
            for &(index, _) in matched {
                let source = &of_frame.sources[index];
                let is_alone = of_frame.sources.iter().enumerate().all(|(other, rival)| {
                    other == index || rival.position.distance(source.position) > PROFILE_DISTANCE_PX
                });
                if is_alone {
                    stars.push(ProfileStar {
                        image: &frames[self.frames[place]].image,
                        noise_dn: of_frame.noise_dn,
                        position: source.position,
                        peak: source.peak,
                        significance: source.significance,
                    });
                }
            }
        }
        stars
    }

    fn widths_px(&self, sources: &[ImageSources]) -> Vec<f64> {
        let mut widths = Vec::new();
        for (place, matched) in self.matched.iter().enumerate() {
            for &(source, _) in matched {
                let source = &sources[self.frames[place]].sources[source];
                if !source.is_saturated && source.width_px.is_finite() {
                    widths.push(source.width_px);
                }
            }
        }
        widths
    }

    /// Returns the brightness of every listed star in the frames, with its flux if it has a source.
    fn lights(&self, camera: &Camera, sources: &[ImageSources], list: &SkyList) -> Vec<StarLight> {
        let mut lights = Vec::new();
        for (place, matched) in self.matched.iter().enumerate() {
            for (star, _) in star_places(camera, &self.attitudes[place], list) {
                let source = matched.iter().find(|pair| pair.1 == star).map(|pair| pair.0);
                let source = source.map(|source| sources[self.frames[place]].sources[source]);
                if source.is_some_and(|source| source.is_saturated) {
                    continue;
                }
                lights.push(StarLight {
                    magnitude: list.stars[star].magnitude,
                    b_v: list.b_v[star],
                    flux_dn: source.map(|source| source.flux_dn),
                    significance: source.map_or(0.0, |source| source.significance),
                });
            }
        }
        lights
    }
}

/// Returns the listed stars on the detector, by index, with their places.
fn star_places(
    camera: &Camera,
    attitude: &Rotation<CameraFrame, Icrs>,
    list: &SkyList,
) -> Vec<(usize, PixelPoint)> {
    let Ok(model) = CameraModel::new(camera) else { return Vec::new() };
    let (fx, fy) = camera.focal_length_px();
    // The undistorted field is at most a half larger than the detector: beyond, the polynomial means nothing.
    let reach = |side: usize, focal: f64| 0.75 * side as f64 / focal;
    let (reach_x, reach_y) = (reach(camera.columns, fx), reach(camera.rows, fy));
    let matrix = attitude.matrix();
    let mut places = Vec::new();
    for (index, star) in list.stars.iter().enumerate() {
        let direction = matrix * star.direction.vector();
        let is_near = direction.z > 0.0
            && direction.x.abs() <= reach_x * direction.z
            && direction.y.abs() <= reach_y * direction.z;
        if let Some(at) = is_near.then(|| model.project_vector(&direction)).flatten()
            && at.is_on_detector(camera.columns, camera.rows)
        {
            places.push((index, at));
        }
    }
    places
}

/// Returns the pairs of sources and stars that are nearest to each other within a gate, narrowed to
/// the errors of the positions where they are known. A second star within twice
/// the gate blends with the first: its source belongs to neither.
fn mutual_matches(
    places: &[(usize, PixelPoint)],
    frame: &ImageSources,
    gate_px: f64,
    errors: Option<PositionErrors>,
) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    for (index, source) in frame.sources.iter().enumerate() {
        if source.is_spike || source.is_saturated {
            continue;
        }
        let gate_px = match errors {
            Some(errors) => gate_px.min((GATE_SIGMAS * errors.sigma_px(source.sigma_px)).max(MIN_GATE_PX)),
            None => gate_px,
        };
        let mut near = places.iter().filter(|(_, at)| at.distance(source.position) <= 2.0 * gate_px);
        let (Some((star, at)), None) = (near.next(), near.next()) else { continue };
        let is_only_source = frame.sources.iter().enumerate().all(|(other, rival)| {
            other == index || rival.position.distance(*at) > source.position.distance(*at)
        });
        if at.distance(source.position) <= gate_px && is_only_source {
            pairs.push((index, *star));
        }
    }
    pairs
}

/// Returns the number of pixels that are a maximum in at least half of the frames; `None` for fewer than
/// three.
fn hot_pixels(sources: &[ImageSources]) -> Option<usize> {
    if sources.len() < 3 {
        return None;
    }
    let mut peaks: Vec<[usize; 2]> = Vec::new();
    for frame in sources {
        peaks.extend(frame.sources.iter().map(|source| source.peak));
    }
    peaks.sort_unstable();
    let mut count = 0;
    let mut first = 0;
    while first < peaks.len() {
        let same = peaks[first..].iter().take_while(|peak| **peak == peaks[first]).count();
        count += usize::from(2 * same >= sources.len());
        first += same;
    }
    Some(count)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use contract::{Angle, Direction};

    use super::*;
    use crate::sources::Source;

    /// A frame without matching sources has no observations, and its turns would make the equations singular.
    #[test]
    fn a_frame_that_loses_its_stars_is_dropped() {
        let image = GreyImage {
            columns: 800,
            rows: 600,
            values: Vec::new(),
            full_scale: 255.0,
            conversion: PixelConversion::None,
        };
        let frame = SkyFrame { name: "a".to_owned(), image };
        let time = Epoch::from_gregorian_utc_at_midnight(2026, 3, 1);
        let guess = FirstGuess { field_deg: 15.0, tolerance: 0.1, pixel_um: [5.0; 2], time };
        let camera = first_camera(&[frame], &guess).unwrap();
        let list = SkyList::new(time).unwrap();
        let orion = Direction::<Icrs>::from_ra_dec(Angle::from_degrees(84.0), Angle::from_degrees(-1.0));
        let turn =
            nalgebra::UnitQuaternion::rotation_between(orion.vector(), &nalgebra::Vector3::z()).unwrap();
        let camera_from_icrs = Rotation::from_unit_quaternion(turn);
        let source = |at| Source {
            position: at,
            flux_dn: 100.0,
            significance: 50.0,
            sigma_px: 0.1,
            width_px: 1.0,
            peak: [0, 0],
            is_spike: false,
            is_saturated: false,
        };
        let places = star_places(&camera, &camera_from_icrs, &list);
        let sources = [places.iter().map(|(_, at)| source(*at)).collect(), Vec::new()]
            .map(|sources| ImageSources { sources, background_dn: 0.0, noise_dn: 1.0 });
        let solution = FrameSolution { camera_from_icrs, focal_ratio: 1.0, matched: Vec::new() };
        let mut solved = SolvedFrames::new(&[Some(solution.clone()), Some(solution)]);
        solved.match_stars(&camera, &sources, &list, 1.5, None);
        assert_eq!((solved.frames, solved.dropped), (vec![0], vec![1]));
        assert_eq!((solved.attitudes.len(), solved.matched.len()), (1, 1));
    }
}
