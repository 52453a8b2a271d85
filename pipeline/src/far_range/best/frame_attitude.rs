//! Attitude of a frame from the prior and the frame's stars, and identification of clusters as stars.

use contract::{AttitudeSource, CameraFrame, Icrs, PixelPoint, Rotation, Telemetry};

use super::lost_in_space;
use super::mounting::AttitudeError;
use super::photometry::{FittedSource, PhotometryContext, Source};
use super::rescaling::positions_of_stars;
use super::stars::{
    ExpectedStar, StarCandidate, StarMeasurement, are_confirmed, image_covariance, is_contradicted,
    matches_at_positions, matches_by_offset, solve_attitude,
};
use super::start::AttitudeStart;
use super::state::{BestPipeline, ScaleSource};
use crate::far_range::aberration::apparent_direction;
use crate::far_range::config::AberrationConfig;
use crate::far_range::overrides::{Identity, Overrides};

/// Attitude of a frame, with the stars that determined it.
pub(super) struct FrameAttitude {
    /// Attitude; `None` when neither telemetry nor stars determine it.
    pub(super) camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    pub(super) error: AttitudeError,
    pub(super) source: AttitudeSource,
    /// Catalogue number of the star for each cluster that is a star.
    pub(super) star_of: Vec<Option<u32>>,
    pub(super) n_stars: u32,
    pub(super) expected: Vec<ExpectedStar>,
    /// Fitted positions of stars, with the indices of their clusters.
    pub(super) fitted: Vec<(usize, PixelPoint)>,
}

/// Largest number of clusters considered in the search for stars, brightest first.
const MAX_STAR_CANDIDATES: usize = 60;

/// Distance of another listed star below which images blend, px, and its smallest relative flux that
/// disturbs.
const BLEND_PX: f64 = 5.0;
const BLEND_FRACTION: f64 = 0.02;

/// Standard deviation of the position of a star, px: of a fit, and of the brightness centre of a cluster.
const FITTED_SIGMA_PX: f64 = 0.1;
const CENTROID_SIGMA_PX: f64 = 0.3;

impl FrameAttitude {
    /// Returns the result for a frame whose attitude neither telemetry nor stars determine.
    pub(super) fn unknown(sources: &[Source]) -> Self {
        let source = match sources.iter().filter(|source| source.spike.is_none()).count() {
            0 => AttitudeSource::NoStars,
            count if count < lost_in_space::MIN_MATCHED => AttitudeSource::TooFewStars,
            _ => AttitudeSource::NoMatch,
        };
        Self::without_attitude(source, sources)
    }

    /// Returns the result for a frame whose stars contradict the attitude of the telemetry: many must have an
    /// image there, and none has. The attitude has an unknown error, and no line of sight follows from it.
    fn contradicted(sources: &[Source]) -> Self {
        Self::without_attitude(AttitudeSource::NoMatch, sources)
    }

    fn without_attitude(source: AttitudeSource, sources: &[Source]) -> Self {
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

/// Inputs to the attitude of a frame.
pub(super) struct AttitudeInput<'a> {
    pub(super) context: PhotometryContext<'a>,
    pub(super) sources: &'a [Source],
    /// Length of a star's trail along columns and rows, px.
    pub(super) trail_px: [f64; 2],
    pub(super) start: &'a AttitudeStart,
    pub(super) telemetry: &'a Telemetry,
    pub(super) overrides: &'a Overrides<'a>,
}

impl AttitudeInput<'_> {
    /// Returns the attitude with an error of the start, or the given attitude.
    fn attitude(&self, error: &AttitudeError) -> Rotation<CameraFrame, Icrs> {
        self.attitude_by(error.mean)
    }

    fn attitude_by(&self, error: nalgebra::Vector3<f64>) -> Rotation<CameraFrame, Icrs> {
        self.overrides.camera_from_icrs.unwrap_or_else(|| self.start.attitude(error))
    }
}

/// Search for the attitude of a frame: clusters, listed stars, and their matches so far.
struct AttitudeSearch {
    /// Indices of the sources considered, brightest first.
    order: Vec<usize>,
    /// The same sources as candidates for stars.
    candidates: Vec<StarCandidate>,
    expected: Vec<ExpectedStar>,
    /// Pairs of a candidate and an expected star.
    matched: Vec<(usize, usize)>,
    /// Result of the fit to each candidate; `None` before it was tried.
    fits: Vec<Option<Option<FittedSource>>>,
    /// Stars that determine the attitude, and their pairs.
    measured: Vec<StarMeasurement>,
    of_measured: Vec<(usize, usize)>,
    error: AttitudeError,
    camera_from_icrs: Rotation<CameraFrame, Icrs>,
}

impl AttitudeSearch {
    /// Returns the fitted positions, with the indices of their sources.
    fn fitted_positions(&self) -> Vec<(usize, PixelPoint)> {
        let mut positions = Vec::new();
        for (fit, &i) in self.fits.iter().zip(&self.order) {
            if let Some(fit) = fit.flatten() {
                positions.push((i, fit.position));
            }
        }
        positions
    }
}

/// Returns the largest standard deviation of a position in the image, due to the error of the attitude, px,
/// at a tenth of a radian from the boresight.
fn sigma_px(error: &AttitudeError, focal_px: (f64, f64)) -> f64 {
    let covariance = image_covariance(&error.covariance, 0.1, 0.1, focal_px);
    covariance[(0, 0)].max(covariance[(1, 1)]).sqrt()
}

impl BestPipeline {
    /// Returns the length of a star's trail during the exposure along columns and rows, px, by the rotation
    /// of the camera since the last frame.
    pub(super) fn trail_px(
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
        // Trail at the boresight; the noise of the attitude is far below the size of a star's image here.
        [(fx * turn.y * part).abs().min(20.0), (fy * turn.x * part).abs().min(20.0)]
    }

    /// Returns the initial attitude of the frame, and without a prior sets the camera to the focal length of
    /// its stars. Returns `None` when there is no prior and the stars do not determine an attitude.
    pub(super) fn start(
        &mut self,
        sources: &[Source],
        telemetry: &Telemetry,
        overrides: &Overrides<'_>,
    ) -> Option<AttitudeStart> {
        let prior = self.mounting.prior();
        match (&self.lost_in_space, overrides.camera_from_icrs) {
            (None, given) => {
                let reference = self.mounting.reference(telemetry.body_from_icrs);
                let start = AttitudeStart { reference, prior };
                let as_before = given.is_none().then(|| self.start_as_before(sources, &start)).flatten();
                Some(as_before.unwrap_or(start))
            }
            (Some(_), Some(reference)) => Some(AttitudeStart { reference, prior }),
            (Some(solver), None) => {
                let found = solver.solve(&positions_of_stars(sources));
                // A frame without an attitude has the stated focal length, not that of the frame before.
                let focal_ratio = found.as_ref().map_or(1.0, |found| found.focal_ratio);
                self.model = self.stated_model.with_focal_ratio(focal_ratio);
                self.is_rescaled = focal_ratio != 1.0;
                found.as_ref().map(AttitudeStart::from_found)
            }
        }
    }

    /// Determines the attitude of the frame and the clusters that are stars.
    pub(super) fn attitude(&mut self, input: &AttitudeInput<'_>) -> FrameAttitude {
        if let Some(identity) = input.overrides.identity {
            return self.given_attitude(input, identity);
        }
        let prior = input.start.prior;
        let mut search = self.begin_search(input);
        // First pass with the stars that share a common offset; second pass with all stars at the positions
        // that follow.
        for _ in 0..2 {
            self.measure_stars(&mut search, input);
            let is_solved = self.solve(&mut search, input);
            if !is_solved || search.matched.is_empty() {
                break;
            }
            let gate_px = 1.0 + 3.5 * sigma_px(&search.error, self.model.focal_px());
            search.matched = matches_at_positions(&search.candidates, &search.expected, |_| gate_px);
        }
        let (mut star_of, mut n_stars) = self.stars_of_clusters(&search, input.sources.len());
        self.solve_without_misplaced(&mut search, &star_of, input);

        // Matches that bright listed stars do not confirm are chance: the prior remains.
        let gate_px = 2.0 + 3.5 * sigma_px(&search.error, self.model.focal_px());
        let is_in_image = |position: PixelPoint| input.context.is_well_inside(position, gate_px);
        let threshold_e = input.context.threshold_e;
        let AttitudeSearch { candidates, expected, matched, .. } = &search;
        let is_chance =
            n_stars > 0 && !are_confirmed(matched, candidates, expected, gate_px, threshold_e, is_in_image);
        if is_chance {
            search.error = prior;
            search.camera_from_icrs = input.attitude(&prior);
            search.matched.clear();
            search.expected = self.expected_stars(&search.camera_from_icrs, input.telemetry, input.overrides);
            star_of.fill(None);
            n_stars = 0;
        }
        let is_attitude_given = input.overrides.camera_from_icrs.is_some();
        if !is_attitude_given && self.lost_in_space.is_none() && !self.is_rescaled {
            self.mounting.update(&prior, &search.error);
        }
        let clusters = search.candidates.len();
        if n_stars == 0
            && !is_attitude_given
            && is_contradicted(&search.expected, clusters, threshold_e, is_in_image)
        {
            return FrameAttitude::contradicted(input.sources);
        }
        self.update_estimates(&search, input.telemetry.exposure_s);
        let source = match n_stars {
            _ if is_chance => AttitudeSource::NoMatch,
            0 => AttitudeSource::NoStars,
            1 => AttitudeSource::TooFewStars,
            _ if self.is_rescaled => AttitudeSource::RescaledStars,
            _ => AttitudeSource::Stars,
        };
        FrameAttitude {
            camera_from_icrs: Some(search.camera_from_icrs),
            error: search.error,
            source,
            star_of,
            n_stars,
            fitted: search.fitted_positions(),
            expected: search.expected,
        }
    }

    /// Begins the search with the brightest clusters and the listed stars, matched by a common offset.
    fn begin_search(&self, input: &AttitudeInput<'_>) -> AttitudeSearch {
        let sources = input.sources;
        let prior = input.start.prior;
        let mut order: Vec<usize> = (0..sources.len()).filter(|&i| sources[i].spike.is_none()).collect();
        order.sort_by(|&a, &b| sources[b].flux_e.total_cmp(&sources[a].flux_e).then(a.cmp(&b)));
        order.truncate(MAX_STAR_CANDIDATES);
        let mut candidates = Vec::with_capacity(order.len());
        for &i in &order {
            candidates.push(StarCandidate {
                position: sources[i].centre,
                flux_e: sources[i].flux_e,
                is_saturated: sources[i].saturated > 0,
            });
        }
        let camera_from_icrs = input.attitude(&prior);
        let expected = self.expected_stars(&camera_from_icrs, input.telemetry, input.overrides);
        let at_centre = image_covariance(&prior.covariance, 0.0, 0.0, self.model.focal_px());
        let offset_px = [at_centre[(0, 0)].sqrt(), at_centre[(1, 1)].sqrt()];
        let sigma_roll = prior.covariance[(2, 2)].sqrt();
        AttitudeSearch {
            matched: matches_by_offset(&candidates, &expected, offset_px, sigma_roll),
            fits: vec![None; candidates.len()],
            order,
            candidates,
            expected,
            measured: Vec::new(),
            of_measured: Vec::new(),
            error: prior,
            camera_from_icrs,
        }
    }

    /// Fits the matched clusters, brightest first, and collects those that can determine the attitude.
    fn measure_stars(&mut self, search: &mut AttitudeSearch, input: &AttitudeInput<'_>) {
        let AttitudeSearch { order, candidates, expected, matched, fits, measured, of_measured, .. } = search;
        measured.clear();
        of_measured.clear();
        matched.sort_by(|a, b| candidates[b.0].flux_e.total_cmp(&candidates[a.0].flux_e).then(a.cmp(b)));
        for &(c, s) in matched.iter() {
            if measured.len() >= self.config.best.max_stars as usize || is_blended(expected, s) {
                continue;
            }
            let i = order[c];
            let fit = *fits[c].get_or_insert_with(|| self.fit(i, input));
            if let Some(star) = self.star_measurement(&input.sources[i], fit, &expected[s], input.overrides) {
                measured.push(star);
                of_measured.push((c, s));
            }
        }
    }

    /// Solves the attitude from the measured stars, drops outliers, and moves the expected stars to their
    /// positions by this attitude. Returns false if the stars determine no attitude.
    fn solve(&self, search: &mut AttitudeSearch, input: &AttitudeInput<'_>) -> bool {
        let attitude = |error| input.attitude_by(error);
        let Some(solved) = solve_attitude(&search.measured, &input.start.prior, attitude, &self.model) else {
            return false;
        };
        for (pair, is_used) in search.of_measured.iter().zip(&solved.used) {
            if !is_used {
                search.matched.retain(|matched| matched != pair);
            }
        }
        search.measured = retained(std::mem::take(&mut search.measured), &solved.used);
        search.of_measured = retained(std::mem::take(&mut search.of_measured), &solved.used);
        search.error = solved.error;
        search.camera_from_icrs = input.attitude(&search.error);
        for star in &mut search.expected {
            let seen = search.camera_from_icrs.rotate(&star.apparent);
            if let Some(position) = self.model.project_vector(&seen) {
                star.position = position;
            }
        }
        true
    }

    /// Returns the star of each cluster, by the position of its fit, and the number of stars: those within
    /// four standard deviations of the position predicted by the attitude.
    fn stars_of_clusters(&self, search: &AttitudeSearch, clusters: usize) -> (Vec<Option<u32>>, u32) {
        let mut star_of = vec![None; clusters];
        let mut n_stars = 0;
        let attitude_px = sigma_px(&search.error, self.model.focal_px());
        for &(c, s) in &search.matched {
            let fit = search.fits[c].flatten();
            let position = fit.map_or(search.candidates[c].position, |fit| fit.position);
            let centre_px = if fit.is_some() { FITTED_SIGMA_PX } else { CENTROID_SIGMA_PX };
            let limit_px = 4.0 * libm::hypot(attitude_px, centre_px) + 0.2;
            if position.distance(search.expected[s].position) <= limit_px {
                star_of[search.order[c]] = Some(search.expected[s].star.id);
                n_stars += 1;
            }
        }
        (star_of, n_stars)
    }

    /// Solves the attitude again without the stars that are not at their predicted positions, if there are
    /// any among those that determined it.
    fn solve_without_misplaced(
        &self,
        search: &mut AttitudeSearch,
        star_of: &[Option<u32>],
        input: &AttitudeInput<'_>,
    ) {
        let is_at_position =
            |&(c, s): &(usize, usize)| star_of[search.order[c]] == Some(search.expected[s].star.id);
        let is_star: Vec<bool> = search.of_measured.iter().map(is_at_position).collect();
        if !is_star.contains(&false) {
            return;
        }
        let prior = input.start.prior;
        let measured = retained(std::mem::take(&mut search.measured), &is_star);
        let solved = solve_attitude(&measured, &prior, |error| input.attitude_by(error), &self.model);
        search.error = solved.map_or(prior, |solved| solved.error);
        search.camera_from_icrs = input.attitude(&search.error);
    }

    fn fit(&mut self, source: usize, input: &AttitudeInput<'_>) -> Option<FittedSource> {
        let members = input.context.detector.members(source);
        self.fitter.point(input.context, &input.sources[source], members, &self.psf, input.trail_px)
    }

    /// Determines the attitude with given identities of the clusters.
    fn given_attitude(
        &mut self,
        input: &AttitudeInput<'_>,
        identity: &dyn Fn(PixelPoint) -> Identity,
    ) -> FrameAttitude {
        let prior = input.start.prior;
        let expected = self.expected_stars(&input.attitude(&prior), input.telemetry, input.overrides);
        let mut star_of = Vec::with_capacity(input.sources.len());
        for source in input.sources {
            star_of.push(match identity(source.centre) {
                Identity::Star(id) => Some(id),
                _ => None,
            });
        }
        let mut measured = Vec::new();
        for (i, id) in star_of.iter().enumerate() {
            let Some(id) = *id else { continue };
            let Some(s) = expected.iter().position(|star| star.star.id == id) else { continue };
            if measured.len() >= self.config.best.max_stars as usize || is_blended(&expected, s) {
                continue;
            }
            let fit = self.fit(i, input);
            measured.extend(self.star_measurement(&input.sources[i], fit, &expected[s], input.overrides));
        }
        let solved = solve_attitude(&measured, &prior, |error| input.attitude_by(error), &self.model);
        let error = solved.map_or(prior, |solved| solved.error);
        if self.lost_in_space.is_none() {
            self.mounting.update(&prior, &error);
        }
        let n_stars = measured.len() as u32;
        FrameAttitude {
            camera_from_icrs: Some(input.attitude(&error)),
            error,
            source: if n_stars >= 2 { AttitudeSource::Stars } else { AttitudeSource::TooFewStars },
            star_of,
            n_stars,
            expected,
            fitted: Vec::new(),
        }
    }

    /// Returns the listed stars at their expected positions for a camera attitude.
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
                let flux_e = (self.brightness.source != ScaleSource::Unknown)
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

    /// Updates the estimates of width and brightness scale with the stars.
    fn update_estimates(&mut self, search: &AttitudeSearch, exposure_s: f64) {
        if !self.config.best.sequence {
            return;
        }
        let mut log_ratios = Vec::new();
        for &(c, s) in &search.matched {
            let Some(fit) = search.fits[c].flatten() else { continue };
            if search.candidates[c].is_saturated {
                continue;
            }
            self.psf.update_from_star(&fit.image);
            if fit.image.flux_e > 0.0 {
                let star = &search.expected[s];
                let unscaled = self.unscaled_flux_e(star.star.magnitude, exposure_s);
                // An exposure of 0 s does not determine the scale.
                let log_ratio = libm::log(fit.image.flux_e / unscaled);
                log_ratios.extend(Some(log_ratio).filter(|ratio| ratio.is_finite()));
            }
        }
        if log_ratios.len() >= 3 {
            log_ratios.sort_by(f64::total_cmp);
            let median = log_ratios[log_ratios.len() / 2];
            let gain = match self.brightness.source {
                ScaleSource::Unknown => 1.0,
                ScaleSource::Calibration => 0.5,
                ScaleSource::Stars => 0.1,
            };
            self.brightness.log_ratio += gain * (median - self.brightness.log_ratio);
            self.brightness.source = ScaleSource::Stars;
        }
    }
}

/// Returns the entries whose flag is set.
fn retained<T>(entries: Vec<T>, flags: &[bool]) -> Vec<T> {
    entries.into_iter().zip(flags).filter(|(_, flag)| **flag).map(|(entry, _)| entry).collect()
}

/// Returns true if another listed star contributes to the image of star `s`.
fn is_blended(stars: &[ExpectedStar], s: usize) -> bool {
    let flux = |star: &ExpectedStar| libm::pow(10.0, -0.4 * star.star.magnitude);
    stars.iter().enumerate().any(|(other, star)| {
        other != s
            && star.position.distance(stars[s].position) < BLEND_PX
            && flux(star) > BLEND_FRACTION * flux(&stars[s])
    })
}
