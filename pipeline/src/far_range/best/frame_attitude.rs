//! Attitude of a frame from the prior and the frame's stars, and identification of clusters as stars.

use contract::{AttitudeSource, CameraFrame, Icrs, PixelPoint, Rotation, Telemetry};

use super::lost_in_space;
use super::mounting::AttitudeError;
use super::photometry::{FittedSource, PhotometryContext, Source};
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

    /// Returns the initial attitude of the frame. Returns `None` when there is no prior and the stars do not
    /// determine an attitude.
    pub(super) fn start(
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

    /// Determines the attitude of the frame and the clusters that are stars.
    pub(super) fn attitude(
        &mut self,
        context: PhotometryContext<'_>,
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
            return self.given_attitude(context, sources, trail_px, start, overrides, identity, expected);
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
        // First pass with the stars that share a common offset; second pass with all stars at the positions
        // that follow.
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
                    self.fitter.point(context, &sources[i], context.detector.members(i), &self.psf, trail_px)
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
        // The fits finally decide which clusters are stars: those within four standard deviations of the
        // position predicted by the attitude.
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
            // If a star used for the attitude is not at its predicted position, the attitude is solved again
            // without it.
            let measured = retained(measured, &is_star);
            error = solve_attitude(&measured, &prior, of, &self.model).map_or(prior, |solved| solved.error);
            camera_from_icrs = of(error.mean);
        }
        let at_centre = image_covariance(&error.covariance, 0.1, 0.1, (fx, fy));
        let gate_px = 2.0 + 3.5 * at_centre[(0, 0)].max(at_centre[(1, 1)]).sqrt();
        let is_in_image = |position: PixelPoint| context.is_well_inside(position, gate_px);
        let is_chance = n_stars > 0
            && !are_confirmed(&matched, &candidates, &expected, gate_px, context.threshold_e, is_in_image);
        if is_chance {
            error = prior;
            camera_from_icrs = of(prior.mean);
            matched.clear();
            star_of.fill(None);
            n_stars = 0;
            expected = self.expected_stars(&camera_from_icrs, telemetry, overrides);
        }
        if overrides.camera_from_icrs.is_none() && self.lost_in_space.is_none() {
            self.mounting.update(&prior, &error);
        }
        if n_stars == 0
            && overrides.camera_from_icrs.is_none()
            && is_contradicted(&expected, candidates.len(), context.threshold_e, is_in_image)
        {
            return FrameAttitude::contradicted(sources);
        }
        self.update_estimates(&matched, &candidates, &expected, &fits, telemetry.exposure_s);
        let source = match n_stars {
            _ if is_chance => AttitudeSource::NoMatch,
            0 => AttitudeSource::NoStars,
            1 => AttitudeSource::TooFewStars,
            _ => AttitudeSource::Stars,
        };
        let fitted =
            fits.iter().zip(&order).filter_map(|(fit, &i)| Some((i, fit.flatten()?.position))).collect();
        let camera_from_icrs = Some(camera_from_icrs);
        FrameAttitude { camera_from_icrs, error, source, star_of, n_stars, expected, fitted }
    }

    /// Determines the attitude with given identities of the clusters.
    #[allow(clippy::too_many_arguments, reason = "intermediate results of one frame")]
    fn given_attitude(
        &mut self,
        context: PhotometryContext<'_>,
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
            let fit =
                self.fitter.point(context, &sources[i], context.detector.members(i), &self.psf, trail_px);
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
    fn update_estimates(
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
            self.psf.update_from_star(&fit.image);
            if fit.image.flux_e > 0.0 {
                let star = &expected[s];
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
