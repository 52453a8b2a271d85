//! Rounds of matching stars and adjusting the camera.

use contract::{Camera, CameraFrame, Icrs, Rotation};
use pipeline::CameraModel;

use crate::adjustment::{AdjustedCamera, Adjustment, Observation, PositionErrors, TERMS, Term, adjust};
use crate::fit::{FittedFrame, MatchedStar, SkyFrame};
use crate::left_out::left_out_rms_px;
use crate::solution::FrameSolution;
use crate::sources::ImageSources;
use crate::star_list::SkyList;
use crate::stars::photometry::StarLight;
use crate::stars::profile::ProfileStar;

/// Largest distance between a listed star and its source in the first and in later rounds, px.
const GATES_PX: [f64; 4] = [4.0, 3.0, 2.0, 1.5];

/// Largest distance in standard deviations in the last round: χ² with two degrees of freedom exceeds its
/// square once in 3000. Not below half a pixel.
const GATE_SIGMAS: f64 = 4.0;
const MIN_GATE_PX: f64 = 0.5;

/// Terms of the first round, when only the stars near the centre are matched.
const FIRST_TERMS: [Term; 2] = [Term::FocalLength, Term::Radial1];

/// Smallest number of stars in a frame that takes part.
pub(crate) const MIN_STARS: usize = 4;

/// Smallest distance of a star whose profile is fitted from any other source, px.
const PROFILE_DISTANCE_PX: f64 = 12.0;

/// Smallest number of stars of all frames.
pub(crate) const MIN_ALL_STARS: usize = 8;

/// Camera after the rounds.
pub(crate) struct FittedRounds {
    pub(crate) fitted: Camera,
    pub(crate) adjustment: Adjustment,
    /// Root mean square of the residuals of stars left out, px; `None` if it was not computed.
    pub(crate) left_out_rms_px: Option<f64>,
}

/// Matches stars and adjusts the camera about `camera` in turn, with narrowing gates. The attitudes of
/// `solved` follow. Returns the number of stars if they are too few.
pub(crate) fn adjust_in_rounds(
    camera: &AdjustedCamera,
    solved: &mut SolvedFrames,
    sources: &[ImageSources],
    list: &SkyList,
    is_prediction_wanted: bool,
) -> Result<FittedRounds, usize> {
    let mut fitted = camera.camera(&[0.0; TERMS]);
    let mut left_out = None;
    let mut adjusted: Option<Adjustment> = None;
    for (round, gate_px) in GATES_PX.into_iter().enumerate() {
        let is_last = round + 1 == GATES_PX.len();
        let errors = adjusted.as_ref().filter(|_| is_last).map(|adjusted| adjusted.errors);
        solved.match_stars(&fitted, sources, list, gate_px, errors);
        let observations = solved.observations(sources, list);
        if observations.len() < MIN_ALL_STARS {
            return Err(observations.len());
        }
        let free: &[Term] = if round == 0 { &FIRST_TERMS } else { &Term::ALL };
        if is_last && is_prediction_wanted {
            left_out = left_out_rms_px(camera, free, &solved.attitudes, &observations);
        }
        let found = adjust(camera, free, &solved.attitudes, &observations).ok_or(observations.len())?;
        fitted = camera.camera(&found.terms);
        solved.attitudes.clone_from(&found.attitudes);
        adjusted = Some(found);
    }
    let adjustment = adjusted.ok_or(0_usize)?;
    Ok(FittedRounds { fitted, adjustment, left_out_rms_px: left_out })
}

/// Frames with an attitude, and the sources that are stars.
pub(crate) struct SolvedFrames {
    /// Index of each frame among all.
    frames: Vec<usize>,
    pub(crate) attitudes: Vec<Rotation<CameraFrame, Icrs>>,
    /// Matched sources of each frame with their stars, by index.
    matched: Vec<Vec<(usize, usize)>>,
    /// Index of each frame whose stars do not fit the camera of all frames.
    pub(crate) dropped: Vec<usize>,
}

impl SolvedFrames {
    /// Creates the list of frames, by their index among all, with their solutions.
    pub(crate) fn new(solutions: &[(usize, &FrameSolution)]) -> Self {
        Self {
            frames: solutions.iter().map(|(frame, _)| *frame).collect(),
            attitudes: solutions.iter().map(|(_, solution)| solution.camera_from_icrs).collect(),
            matched: vec![Vec::new(); solutions.len()],
            dropped: Vec::new(),
        }
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

    pub(crate) fn observations(&self, sources: &[ImageSources], list: &SkyList) -> Vec<Observation> {
        let mut observations = Vec::new();
        for (place, matched) in self.matched.iter().enumerate() {
            for &(source, star) in matched {
                let source = &sources[self.frames[place]].sources[source];
                observations.push(Observation {
                    frame: place,
                    position: source.position,
                    sigma_px: source.sigma_px,
                    star: list.stars[star].id,
                    direction: *list.stars[star].direction.vector(),
                });
            }
        }
        observations
    }

    pub(crate) fn fitted_frames(&self, frames: &[SkyFrame], adjustment: &Adjustment) -> Vec<FittedFrame> {
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
    pub(crate) fn matched_stars(
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
    pub(crate) fn profile_stars<'image>(
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

    pub(crate) fn widths_px(&self, sources: &[ImageSources]) -> Vec<f64> {
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
    pub(crate) fn lights(&self, camera: &Camera, sources: &[ImageSources], list: &SkyList) -> Vec<StarLight> {
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
) -> Vec<(usize, contract::PixelPoint)> {
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
    places: &[(usize, contract::PixelPoint)],
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

#[cfg(test)]
mod tests {
    use contract::{Angle, Direction};

    use files::{GreyImage, PixelConversion};
    use hifitime::Epoch;

    use super::*;
    use crate::fit::{FirstGuess, first_camera};
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
            elongation: [0.0; 2],
            peak: [0, 0],
            is_spike: false,
            is_saturated: false,
        };
        let places = star_places(&camera, &camera_from_icrs, &list);
        let sources = [places.iter().map(|(_, at)| source(*at)).collect(), Vec::new()]
            .map(|sources| ImageSources { sources, background_dn: 0.0, noise_dn: 1.0 });
        let solution = FrameSolution { camera_from_icrs, focal_ratio: 1.0, added_radial: 0.0 };
        let mut solved = SolvedFrames::new(&[(0, &solution), (1, &solution)]);
        solved.match_stars(&camera, &sources, &list, 1.5, None);
        assert_eq!((solved.frames, solved.dropped), (vec![0], vec![1]));
        assert_eq!((solved.attitudes.len(), solved.matched.len()), (1, 1));
    }
}
