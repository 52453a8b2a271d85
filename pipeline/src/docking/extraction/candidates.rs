//! Candidates for the cross: regions of the binary image, regions of its edges, and a structural scan.

use std::ops::Range;

use imageproc::image::GrayImage;
use nalgebra::Vector2;

use super::components::{self, Component};
use crate::docking::cross_and_circle::cross::CrossSeed;
use crate::docking::preprocessing::binarise;
use crate::docking::preprocessing::edges::EdgeConfig;
use crate::docking::preprocessing::view::{Lens, Overview};

/// Possible cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) seed: CrossSeed,
    /// Similarity to a cross, larger is better. Comparable only within one method of finding candidates.
    weight: f64,
}

impl Candidate {
    /// Returns true if both candidates are of the same object.
    fn repeats(&self, other: &Self) -> bool {
        let near: Vector2<f64> = other.seed.centre - self.seed.centre;
        let scale = self.seed.half_length_px / other.seed.half_length_px;
        near.norm() < 0.25 * other.seed.half_length_px && (0.8..1.25).contains(&scale)
    }
}

/// Smallest half length of a cross, overview pixels.
const MIN_HALF_PX: f64 = 2.5;

/// Finds regions brighter than a threshold that have the shape of a cross.
pub(crate) fn by_regions(overview: &Overview, lens: &Lens) -> Vec<Candidate> {
    let mut found = Vec::new();
    for level in binarise::levels(&overview.grey) {
        cross_shaped(&binarise::above(&overview.grey, level), overview, lens, &mut found);
    }
    best_first(found)
}

/// Finds closed edges that have the outline of a cross.
pub(crate) fn by_edges(overview: &Overview, lens: &Lens, config: &EdgeConfig) -> Vec<Candidate> {
    let mut found = Vec::new();
    cross_shaped(&config.find(&overview.grey), overview, lens, &mut found);
    best_first(found)
}

/// Adds the white regions that have the shape of a cross or of its outline.
fn cross_shaped(binary: &GrayImage, overview: &Overview, lens: &Lens, found: &mut Vec<Candidate>) {
    let half = |component: &Component| {
        let (width, height) = component.extent();
        (width + height) / 4.0
    };
    let is_thin_square = |component: &Component| {
        let (width, height) = component.extent();
        let (middle, centroid) = (component.middle(), component.centroid);
        let off = libm::hypot(middle.0 - centroid.0, middle.1 - centroid.1);
        let square = width.min(height) > 0.7 * width.max(height);
        let thin = f64::from(component.area) < 0.55 * width * height;
        half(component) >= MIN_HALF_PX && square && thin && off < 0.2 * half(component) + 0.5
    };
    for component in components::find(binary, is_thin_square) {
        if component.fourfold <= 0.55 {
            continue;
        }
        let (half, centroid) = (half(&component), component.centroid);
        let (sin, cos) = libm::sincos(component.angle_rad);
        // Bounding rectangle of a rotated cross: half = L cos + w/2 sin. The bar's width w is assumed to be
        // 0.2 L.
        let half_length = half / (cos + 0.1 * sin.abs());
        let slope = sin / cos;
        found.extend(candidate(overview, lens, centroid, half_length, slope, component.fourfold));
    }
}

/// Returns the candidate at a position in the overview.
fn candidate(
    overview: &Overview,
    lens: &Lens,
    (x, y): (f64, f64),
    half_length: f64,
    slope: f64,
    weight: f64,
) -> Option<Candidate> {
    let centre = lens.to_ideal(overview.to_camera(x, y))?;
    let half_length_px = Overview::PIXEL * half_length;
    Some(Candidate { seed: CrossSeed { centre, half_length_px, slope }, weight })
}

/// Smallest half length of a cross that the scan tries, overview pixels.
const MIN_SCAN_HALF_PX: f64 = 3.2;

/// Directions of the arms that the scan tries, rad. The sample at half of an arm's length stays on the bar up
/// to 0.2 rad.
const SCAN_TURNS: [f64; 3] = [0.0, -0.22, 0.22];

/// Half lengths of a scan without limits.
pub(crate) const ALL_SCALES: Range<f64> = 0.0..f64::INFINITY;

/// Finds positions where the centre and samples on the arms are brighter than samples between the arms and
/// beyond their ends, at any scale. Slower than the search by regions, but works without a complete region:
/// an arm may be in shadow, bars may be thinner than a pixel.
///
/// A whole field is searched at all scales; a part of a field, for a target of about known size, at the
/// scales in `halves_px`.
pub(crate) fn by_structure(
    overview: &Overview,
    lens: &Lens,
    min_contrast: f64,
    halves_px: Range<f64>,
) -> Vec<Candidate> {
    let grey = &overview.grey;
    let largest = (f64::from(grey.width().min(grey.height())) / 2.0).min(halves_px.end / Overview::PIXEL);
    let mut found = Vec::new();
    let mut half = (halves_px.start / Overview::PIXEL).max(MIN_SCAN_HALF_PX);
    while half < largest {
        let stride = ((half / 7.0) as usize).max(1);
        for turn in SCAN_TURNS {
            scan(grey, half, turn, stride, min_contrast, &mut |x, y, weight| {
                found.extend(candidate(overview, lens, (x, y), half, libm::tan(turn), weight));
            });
        }
        half *= 1.22;
    }
    best_first(found)
}

/// Scans the image at one scale and direction.
fn scan(
    grey: &GrayImage,
    half: f64,
    turn: f64,
    stride: usize,
    min_contrast: f64,
    report: &mut dyn FnMut(f64, f64, f64),
) {
    let (sin, cos) = libm::sincos(turn);
    let width = grey.width() as usize;
    let offset = |along: f64, down: f64| {
        let (dx, dy) = (half * (along * cos - down * sin), half * (along * sin + down * cos));
        dy.round() as isize * width as isize + dx.round() as isize
    };
    let between = [(0.36, 0.36), (-0.36, -0.36), (0.36, -0.36), (-0.36, 0.36)].map(|(a, d)| offset(a, d));
    let inner = [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)].map(|(a, d)| offset(a, d));
    let outer = [(0.82, 0.0), (-0.82, 0.0), (0.0, 0.82), (0.0, -0.82)].map(|(a, d)| offset(a, d));
    let beyond = [(1.3, 0.0), (-1.3, 0.0), (0.0, 1.3), (0.0, -1.3)].map(|(a, d)| offset(a, d));
    let margin = (1.4 * half).ceil() as usize + 1;
    let pixels = grey.as_raw();
    let least = min_contrast.ceil() as u8;
    let (right, bottom) = (width.saturating_sub(margin), (grey.height() as usize).saturating_sub(margin));
    for y in (margin..bottom).step_by(stride) {
        for x in (margin..right).step_by(stride) {
            let here = y * width + x;
            // The margin keeps every offset inside the image.
            let at = |by: isize| pixels[here.wrapping_add_signed(by)];
            let centre = pixels[here];
            let Some(need) = centre.checked_sub(least) else { continue };
            if between.iter().any(|by| at(*by) > need) {
                continue;
            }
            let dark = f64::from(between.iter().map(|by| at(*by)).fold(0, u8::max));
            // Seven of the eight samples on the arms must be bright, and three of the four beyond them dark.
            let mut arms = [0; 8];
            arms.iter_mut().zip(inner.iter().chain(&outer)).for_each(|(arm, by)| *arm = at(*by));
            arms.sort_unstable();
            let weight = f64::from(arms[1].min(centre)) - dark;
            if weight < min_contrast {
                continue;
            }
            let middle = dark + 0.6 * weight;
            if beyond.iter().filter(|by| f64::from(at(**by)) > middle).count() > 1 {
                continue;
            }
            report(x as f64, y as f64, weight);
        }
    }
}

/// Sorts candidates by weight, best first, and removes those that repeat a better one.
fn best_first(mut found: Vec<Candidate>) -> Vec<Candidate> {
    // The sort is stable: candidates of equal weight keep their order of discovery, which is deterministic.
    found.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in found {
        if !kept.iter().any(|other| candidate.repeats(other)) {
            kept.push(candidate);
        }
        if kept.len() >= 200 {
            break;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::preprocessing::view::View;
    use crate::docking::synthetic::{self, Scene};
    use contract::docking::Lines;

    /// Returns true if one of the candidates is the scene's cross, accurate enough to be measured.
    fn has(found: &[Candidate], scene: &Scene) -> bool {
        let truth = scene.cross();
        found.iter().any(|candidate| {
            let seed = candidate.seed;
            (seed.centre - truth.centre).norm() < 0.15 * truth.half_length_px + 1.5
                && (seed.half_length_px / truth.half_length_px - 1.0).abs() < 0.25
                && (seed.slope - truth.slope).abs() < 0.2
        })
    }

    #[test]
    fn regions_edges_and_structure_each_find_the_cross() {
        for (range_m, roll_rad) in [(3.0, 0.0), (5.0, 0.1), (10.0, -0.1)] {
            let scene = Scene { range_m, roll_rad, noise_dn: 3.0, ..Scene::default() };
            let field = scene.field(Lines::Even);
            let (overview, lens) = (View::new(&field).overview(), synthetic::lens());
            assert!(has(&by_regions(&overview, &lens), &scene), "regions, {range_m} m");
            assert!(has(&by_structure(&overview, &lens, 10.0, ALL_SCALES), &scene), "structure, {range_m} m");
            if range_m < 10.0 {
                let edges = by_edges(&overview, &lens, &EdgeConfig::default());
                assert!(has(&edges, &scene), "edges, {range_m} m");
            }
        }
    }

    #[test]
    fn structure_finds_a_cross_with_an_arm_in_shadow() {
        let scene = Scene { shadow_from_m: 0.10, noise_dn: 2.0, ..Scene::default() };
        let field = scene.field(Lines::Even);
        assert!(has(
            &by_structure(&View::new(&field).overview(), &synthetic::lens(), 10.0, ALL_SCALES),
            &scene
        ));
    }

    #[test]
    fn a_field_without_a_cross_has_no_candidate_of_its_size() {
        let scene = Scene { cross: false, ..Scene::default() };
        let field = scene.field(Lines::Even);
        let (overview, lens) = (View::new(&field).overview(), synthetic::lens());
        assert!(!has(&by_regions(&overview, &lens), &scene));
        assert!(!has(&by_edges(&overview, &lens, &EdgeConfig::default()), &scene));
    }
}
