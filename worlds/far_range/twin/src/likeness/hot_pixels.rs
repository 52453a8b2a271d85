//! Hot pixels of a set of frames.

use camera_fit::Background;
use rayon::prelude::*;

use super::background::Plane;
use super::difference::{Likeness, NotCompared, Unit};
use super::estimate::Estimate;
use crate::FrameSet;

/// Smallest number of frames that separate a hot pixel from a star.
const MIN_FRAMES: usize = 3;

/// Height of a hot pixel, in standard deviations of the noise of a pixel.
const HOT_SIGMAS: f64 = 5.0;

/// Distance from a star within which a pixel says nothing, px.
const STAR_REACH_PX: f64 = 6.0;

const NAME: &str = "hot pixels";

/// Compares the number of hot pixels: those whose median over the frames is above five standard deviations of
/// the noise, the same number of DN in both sets. Numbers scatter as those of Poisson.
///
/// # Errors
/// [`NotCompared`] for fewer than three frames.
pub(crate) fn likeness(camera: &FrameSet, twin: &FrameSet) -> Result<Likeness, NotCompared> {
    for (set, name) in [(camera, "the camera"), (twin, "the twin")] {
        if set.fit.frames.len() < MIN_FRAMES {
            let reason = format!("{} frames of {name}, {MIN_FRAMES} are needed", set.fit.frames.len());
            return Err(NotCompared { name: NAME, reason });
        }
    }
    let limit_dn = HOT_SIGMAS * camera.fit.noise_dn.max(twin.fit.noise_dn);
    let counts = [camera, twin].map(|set| hot_heights_dn(set, limit_dn).len() as f64);
    // The error of a count is not below that of one pixel.
    let estimate = |count: f64| Estimate::known(count, count.max(0.5).sqrt());
    Ok(Likeness::new("hot_pixels", NAME, Unit::Number, counts.map(estimate)))
}

/// Returns the heights of the hot pixels above the background, medians over the frames, DN.
pub fn hot_heights_dn(set: &FrameSet, limit_dn: f64) -> Vec<f64> {
    let planes: Vec<Plane> = (0..set.fit.frames.len())
        .into_par_iter()
        .filter_map(|index| {
            let image = &set.solved(index)?.image;
            let mut plane = Plane::above(image, &Background::of(image));
            leave_out_stars(set, index, &mut plane);
            Some(plane)
        })
        .collect();
    let Some(first) = planes.first() else { return Vec::new() };
    let mut heights = Vec::new();
    let mut seen = Vec::with_capacity(planes.len());
    for place in 0..first.values.len() {
        seen.clear();
        seen.extend(planes.iter().map(|plane| plane.values[place]).filter(|value| !value.is_nan()));
        seen.sort_by(f64::total_cmp);
        // The lower median: half of the frames or more show it.
        let median = if seen.len() < MIN_FRAMES { None } else { seen.get((seen.len() - 1) / 2) };
        if let Some(height) = median.filter(|height| **height > limit_dn) {
            heights.push(*height);
        }
    }
    heights
}

/// Marks the pixels about the stars of a frame as without a statement.
fn leave_out_stars(set: &FrameSet, frame: usize, plane: &mut Plane) {
    for star in set.fit.matched.iter().filter(|star| star.frame == frame) {
        let first = |at: f64| (at - STAR_REACH_PX).max(0.0) as usize;
        let last = |at: f64, side: usize| ((at + STAR_REACH_PX).max(0.0) as usize).min(side - 1);
        for row in first(star.position.y)..=last(star.position.y, plane.rows) {
            for column in first(star.position.x)..=last(star.position.x, plane.columns) {
                let (dx, dy) = (column as f64 - star.position.x, row as f64 - star.position.y);
                if libm::hypot(dx, dy) <= STAR_REACH_PX {
                    plane.values[row * plane.columns + column] = f64::NAN;
                }
            }
        }
    }
}
