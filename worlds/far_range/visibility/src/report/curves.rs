//! Curves of a report: probability against magnitude, limiting magnitude against exposure, the sky, the
//! target by range and phase.

use sim::SimError;
use statistics::{Interval, wilson};

use crate::confirm::StarFrame;
use crate::design::{AspectGroup, Design, between};
use crate::detection_model::detection::background_e;
use crate::report::{
    CameraFigures, DetectionPoint, LimitPoint, PointingStars, RangeByPhase, SimulatedPoint, SkySummary,
    StarsLost, WindowPoint,
};
use crate::requirement::definition::Requirements;
use crate::requirement::{SkyStatistic, TargetLight};
use crate::sky::star_count::star_trail_px;

/// Number of points of the curves over exposures and ranges.
const POINTS: usize = 25;
/// Number of worst pointings that are listed.
const WORST: usize = 10;
/// Half the width of the magnitude interval of a simulated point, mag.
const HALF_WIDTH_MAG: f64 = 0.05;
/// Limits of the search for the greatest range, km.
const RANGES_KM: [f64; 2] = [0.01, 1e6];
/// Width of the bins of phase angle along an orbit, degrees.
const PHASE_BIN_DEG: f64 = 15.0;

/// Computes the figures of the camera.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn camera_figures(
    requirements: &Requirements,
    design: &Design<'_>,
) -> Result<CameraFigures, SimError> {
    let file = &requirements.file;
    let (camera, nominal_s) = (&design.camera, file.exposure.nominal_s);
    let background_e_per_s = design.background_e_per_s()?;
    let in_a_pixel = background_e(camera, nominal_s, background_e_per_s);
    Ok(CameraFigures {
        field_deg: camera.projection.field().map(|field| field.map(contract::Angle::degrees)),
        zero_point_e_per_s: camera.radiometry.star(0.0, None, None),
        saturation_e: camera.config.sensor.saturation_e(),
        threshold_dn: design.rule.thresholds(camera, in_a_pixel).high_dn,
        background_e_per_s,
        star_trail_px: star_trail_px(camera, &design.motion, nominal_s),
        n_min: file.n_min,
        probability: file.probability,
        nominal_s,
    })
}

/// Computes the detection probability against magnitude at the nominal exposure, in steps of 0.1 mag within 3
/// mag of the magnitude of probability 0.5, where the probability is between 1e-4 and 0.9999.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn detection(
    requirements: &Requirements,
    design: &Design<'_>,
) -> Result<Vec<DetectionPoint>, SimError> {
    let exposure_s = requirements.file.exposure.nominal_s;
    let curve = design.curve(exposure_s)?;
    let Some(half) = design.limiting_magnitude(exposure_s, 0.5)? else { return Ok(Vec::new()) };
    let middle = (10.0 * half).round() / 10.0;
    let points = (-30..=30).map(|i| {
        let magnitude = middle + 0.1 * f64::from(i);
        let electrons = design.camera.radiometry.star(magnitude, None, None) * exposure_s;
        DetectionPoint { magnitude, electrons, probability: curve.probability(electrons) }
    });
    Ok(points.filter(|point| point.probability > 1e-4 && point.probability < 0.9999).collect())
}

/// Returns the simulated counterpart of the curve: stars of the frames by magnitude, where the model predicts
/// that between 3 and 97 % of them are detected.
pub(crate) fn detection_simulated(frames: &[StarFrame], curve: &[DetectionPoint]) -> Vec<SimulatedPoint> {
    let marked = curve.iter().filter(|point| (0.03..=0.97).contains(&point.probability));
    let points = marked.filter_map(|point| {
        let near = |magnitude: f64| (magnitude - point.magnitude).abs() < HALF_WIDTH_MAG;
        let (mut count, mut of, mut chances) = (0_u64, 0_u64, 0.0);
        for star in frames.iter().flat_map(|frame| &frame.stars).filter(|star| near(star.magnitude)) {
            count += u64::from(star.is_detected);
            of += 1;
            chances += star.chance;
        }
        let n = of as f64;
        let Interval { low, high } = wilson(count as f64 / n, n)?;
        Some(SimulatedPoint { magnitude: point.magnitude, count, of, low, high, analytic: chances / n })
    });
    points.collect()
}

/// Computes limiting magnitude and number of stars against exposure.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn limiting_magnitude(
    requirements: &Requirements,
    design: &Design<'_>,
) -> Result<Vec<LimitPoint>, SimError> {
    let file = &requirements.file;
    let mut points = Vec::new();
    for exposure_s in between(file.exposure.min_s, file.exposure.max_s, POINTS) {
        let seen = design.stars(exposure_s, file.n_min)?;
        let n = seen.len().max(1) as f64;
        let curve = design.curve(exposure_s)?;
        points.push(LimitPoint {
            exposure_s,
            half: design.limit_of(&curve, exposure_s, 0.5),
            asked: design.limit_of(&curve, exposure_s, file.probability),
            stars: seen.iter().map(|seen| seen.expected).sum::<f64>() / n,
            probability: seen.iter().map(|seen| seen.chance).sum::<f64>() / n,
        });
    }
    Ok(points)
}

/// Summarises the sky at the nominal exposure.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn sky(requirements: &Requirements, design: &Design<'_>) -> Result<SkySummary, SimError> {
    let file = &requirements.file;
    let seen = design.stars(file.exposure.nominal_s, file.n_min)?;
    let limit = design.limiting_magnitude(file.exposure.nominal_s, file.probability)?.unwrap_or(-99.0);
    let mut counted = seen.iter();
    let mut map = Vec::new();
    let mut excluded = [0_u64; 3];
    for field in &design.sky()?.fields {
        let pointing = &field.pointing;
        if let Some(why) = pointing.excluded {
            excluded[why as usize] += 1;
        }
        let stars = if pointing.excluded.is_none() { counted.next().copied() } else { None };
        map.push(PointingStars {
            ra_deg: pointing.boresight.ra().degrees(),
            dec_deg: pointing.boresight.dec().degrees(),
            roll_deg: pointing.roll().degrees(),
            time_utc: files::format_utc(pointing.time),
            excluded: pointing.excluded.map(|why| why.code().into()),
            background_e_per_s: field.background_e_per_s,
            in_field: field.stars.iter().filter(|star| star.magnitude <= limit).count() as u64,
            stars: stars.map_or(0.0, |seen| seen.expected),
            probability: stars.map_or(0.0, |seen| seen.chance),
        });
    }
    let mut worst: Vec<PointingStars> = map.iter().filter(|p| p.excluded.is_none()).cloned().collect();
    // Ordered by probability; equal probabilities, such as several of 1, by the number of stars.
    worst.sort_by(|a, b| a.probability.total_cmp(&b.probability).then(a.stars.total_cmp(&b.stars)));
    worst.truncate(WORST);
    let mut numbers: Vec<f64> = seen.iter().map(|seen| seen.expected).collect();
    numbers.sort_by(f64::total_cmp);
    let quantile = |q: f64| numbers.get((q * numbers.len() as f64) as usize).copied().unwrap_or(0.0);
    let n = seen.len().max(1) as f64;
    Ok(SkySummary {
        pointings: map.len() as u64,
        counted: seen.len() as u64,
        excluded,
        stars: numbers.iter().sum::<f64>() / n,
        quantiles: [0.01, 0.1, 0.5].map(quantile),
        probability: seen.iter().map(|seen| seen.chance).sum::<f64>() / n,
        share: seen.iter().filter(|seen| seen.chance >= file.probability).count() as f64 / n,
        worst,
        map,
    })
}

/// Returns the shortest exposure with enough stars over the sky, s; `None` if there is none.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn shortest_for_stars(
    requirements: &Requirements,
    design: &Design<'_>,
    probability: f64,
) -> Result<Option<f64>, SimError> {
    let file = &requirements.file;
    let chance = |exposure_s| design.stars_chance(exposure_s, file.n_min, SkyStatistic::Sky);
    let mut fails = None;
    for exposure_s in between(file.exposure.min_s, file.exposure.max_s, 13) {
        if chance(exposure_s)? < probability {
            fails = Some(exposure_s);
            continue;
        }
        let Some(fails) = fails else { return Ok(Some(exposure_s)) };
        let (mut low, mut high) = (libm::log(fails), libm::log(exposure_s));
        for _ in 0..10 {
            let middle = 0.5 * (low + high);
            if chance(libm::exp(middle))? >= probability { high = middle } else { low = middle }
        }
        return Ok(Some(libm::exp(high)));
    }
    Ok(None)
}

/// Computes the usable exposures against range, from far to near, and the ranges at which too few stars
/// remain.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn exposure_window(
    requirements: &Requirements,
    design: &Design<'_>,
) -> Result<(Vec<WindowPoint>, Option<StarsLost>), SimError> {
    let file = &requirements.file;
    let Some(target) = &file.target else { return Ok((Vec::new(), None)) };
    let groups = design.groups(None);
    let [near_km, far_km] = target.ranges_km;
    let (min_s, max_s) = (file.exposure.min_s, file.exposure.max_s);
    let shortest_s = shortest_for_stars(requirements, design, file.probability)?;
    let half_s = shortest_for_stars(requirements, design, 0.5)?;
    let mut points: Vec<WindowPoint> = Vec::new();
    for range_km in between(far_km, near_km, POINTS) {
        let longest_s = design.longest_unsaturated_s(&groups, range_km, file.probability);
        let median_s = design.longest_unsaturated_s(&groups, range_km, 0.5).clamp(min_s, max_s);
        // At far ranges the camera's longest exposure applies to many successive points.
        let (stars, probability) = match points.last().filter(|last| last.median_s == median_s) {
            Some(last) => (last.stars, last.probability),
            None => {
                let seen = design.stars(median_s, file.n_min)?;
                let n = seen.len().max(1) as f64;
                (
                    seen.iter().map(|seen| seen.expected).sum::<f64>() / n,
                    seen.iter().map(|seen| seen.chance).sum::<f64>() / n,
                )
            }
        };
        points.push(WindowPoint {
            range_km,
            longest_s: longest_s.min(max_s),
            median_s,
            shortest_s,
            is_open: shortest_s.is_some_and(|shortest_s| shortest_s <= longest_s),
            stars,
            probability,
        });
    }
    let lost = StarsLost {
        n_min: file.n_min,
        window_closes_km: closes(design, &groups, target.ranges_km, shortest_s, file.probability),
        half_of_frames_km: closes(design, &groups, target.ranges_km, half_s, 0.5),
    };
    Ok((points, Some(lost)))
}

/// Returns the range at which the longest exposure falls to the one that the stars need: it falls with the
/// square of the range.
fn closes(
    design: &Design<'_>,
    groups: &[AspectGroup],
    [near_km, far_km]: [f64; 2],
    needed_s: Option<f64>,
    probability: f64,
) -> Option<f64> {
    let needed_s = needed_s?;
    let is_open = |range_km| design.longest_unsaturated_s(groups, range_km, probability) >= needed_s;
    if is_open(near_km) || !is_open(far_km) {
        return None;
    }
    let (mut closed, mut open) = (libm::log(near_km), libm::log(far_km));
    for _ in 0..20 {
        let middle = 0.5 * (closed + open);
        if is_open(libm::exp(middle)) { open = middle } else { closed = middle }
    }
    Some(libm::exp(open))
}

/// Computes the greatest range at which the target is detected, by phase angle.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn target_range(
    requirements: &Requirements,
    design: &Design<'_>,
) -> Result<Vec<RangeByPhase>, SimError> {
    let file = &requirements.file;
    let Some(target) = &file.target else { return Ok(Vec::new()) };
    let groups = match target.light {
        TargetLight::Phases { .. } => design.groups(None),
        TargetLight::Orbit { .. } => by_phase(design.groups(None)),
    };
    let mut rows = Vec::new();
    for group in groups {
        let phases_deg = group.phases_deg;
        let groups = [group];
        let greatest = |exposure_s| greatest_range_km(design, &groups, exposure_s, file.probability);
        let nominal_km = greatest(file.exposure.nominal_s)?;
        // An equal exposure gives an equal range.
        let same = file.exposure.max_s == file.exposure.nominal_s;
        let longest_km = if same { nominal_km } else { greatest(file.exposure.max_s)? };
        rows.push(RangeByPhase { phases_deg, nominal_km, longest_km });
    }
    Ok(rows)
}

/// Groups the instants of an orbit into bins of phase angle.
fn by_phase(groups: Vec<AspectGroup>) -> Vec<AspectGroup> {
    let mut aspects: Vec<_> = groups.into_iter().flat_map(|group| group.aspects).collect();
    aspects.sort_by(|a, b| a.phase_deg.total_cmp(&b.phase_deg));
    let bin = |phase_deg: f64| (phase_deg / PHASE_BIN_DEG).floor();
    let pieces = aspects.chunk_by(|a, b| bin(a.phase_deg) == bin(b.phase_deg));
    let group = |piece: &[crate::target::Aspect]| AspectGroup {
        phases_deg: [piece[0].phase_deg, piece[piece.len() - 1].phase_deg],
        aspects: piece.to_vec(),
    };
    pieces.map(group).collect()
}

/// Returns the greatest range at which the target is detected in all groups of aspects; searched beyond the
/// ranges at which the body is resolved, where the probability decreases.
///
/// # Errors
/// The errors of [`Design::sky`].
pub(crate) fn greatest_range_km(
    design: &Design<'_>,
    groups: &[AspectGroup],
    exposure_s: f64,
    probability: f64,
) -> Result<Option<f64>, SimError> {
    let shows =
        |range_km| Ok::<bool, SimError>(design.target_chance(groups, range_km, exposure_s)?.0 >= probability);
    // From far to near: a resolved body, whose signal is spread over pixels, then does not end the search.
    let ranges: Vec<f64> = between(RANGES_KM[1], RANGES_KM[0], 17).collect();
    let mut beyond = None;
    for range_km in ranges {
        if !shows(range_km)? {
            beyond = Some(range_km);
            continue;
        }
        let Some(beyond) = beyond else { return Ok(Some(range_km)) };
        let (mut shown, mut missed) = (libm::log(range_km), libm::log(beyond));
        for _ in 0..10 {
            let middle = 0.5 * (shown + missed);
            if shows(libm::exp(middle))? { shown = middle } else { missed = middle }
        }
        return Ok(Some(libm::exp(shown)));
    }
    Ok(None)
}
