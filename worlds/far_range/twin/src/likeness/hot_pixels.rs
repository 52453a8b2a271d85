//! Hot pixels of a set of frames.

use camera_fit::Background;
use rayon::prelude::*;
use statrs::distribution::{Binomial, DiscreteCDF};

use super::background::Plane;
use super::difference::{Likeness, NotCompared, Unit};
use super::estimate::Estimate;
use crate::FrameSet;

/// Smallest number of frames at different pointings that separate a hot pixel from a star.
const MIN_FRAMES: usize = 3;

/// Distance that a pointing differs from another one, px: stars move by more.
const POINTING_PX: f64 = 20.0;

/// Height of a hot pixel, in standard deviations of the noise of a pixel: the least, and the factor by which
/// it is raised until chance gives no more than one.
const HOT_SIGMAS: f64 = 5.0;
const HEIGHT_STEP: f64 = 1.2;
const MAX_STEPS: usize = 40;

/// Distance from a star within which a pixel says nothing, px.
const STAR_REACH_PX: f64 = 6.0;

const NAME: &str = "hot pixels";

/// Compares the number of hot pixels: those that are above the same number of DN in so many frames of each
/// set that chance gives no more than one. Numbers scatter as those of Poisson.
///
/// # Errors
/// [`NotCompared`] for fewer than three frames at different pointings.
pub(crate) fn likeness(camera: &FrameSet, twin: &FrameSet) -> Result<Likeness, NotCompared> {
    let mut stacks = Vec::with_capacity(2);
    for (set, name) in [(camera, "the camera"), (twin, "the twin")] {
        let stack = Stack::of(set);
        if stack.planes.len() < MIN_FRAMES {
            let count = stack.planes.len();
            let reason = format!("{count} frames of {name} at different pointings, {MIN_FRAMES} are needed");
            return Err(NotCompared { name: NAME, reason });
        }
        stacks.push(stack);
    }
    let noise_dn = camera.fit.noise_dn.max(twin.fit.noise_dn);
    let Some(limit_dn) = limit_without_chance(&stacks, noise_dn) else {
        let reason = "pixels at the height of hot ones are too many in every frame".to_owned();
        return Err(NotCompared { name: NAME, reason });
    };
    let mut counts = stacks.iter().map(|stack| stack.heights_dn(limit_dn).len() as f64);
    let counts = [counts.next().unwrap_or(0.0), counts.next().unwrap_or(0.0)];
    // The error of a count is not below that of one pixel.
    let estimate = |count: f64| Estimate::known(count, count.max(0.5).sqrt());
    Ok(Likeness::new("hot_pixels", NAME, Unit::Number, counts.map(estimate)))
}

/// Returns the heights of the hot pixels of a set above the background, medians over the frames, and the
/// least height of one, DN; `None` for fewer than three frames at different pointings.
pub fn hot_pixels(set: &FrameSet) -> Option<(Vec<f64>, f64)> {
    let stack = Stack::of(set);
    if stack.planes.len() < MIN_FRAMES {
        return None;
    }
    let stacks = [stack];
    let limit_dn = limit_without_chance(&stacks, set.fit.noise_dn)?;
    Some((stacks[0].heights_dn(limit_dn), limit_dn))
}

/// Returns the least height at which chance gives no more than one hot pixel in each stack.
fn limit_without_chance(stacks: &[Stack], noise_dn: f64) -> Option<f64> {
    let mut limit_dn = HOT_SIGMAS * noise_dn;
    for _ in 0..MAX_STEPS {
        if stacks.iter().all(|stack| stack.frames_needed(limit_dn).is_some()) {
            return Some(limit_dn);
        }
        limit_dn *= HEIGHT_STEP;
    }
    None
}

/// Frames at different pointings, above their backgrounds, without their stars.
struct Stack {
    planes: Vec<Plane>,
}

impl Stack {
    fn of(set: &FrameSet) -> Self {
        let planes = different_pointings(set)
            .into_par_iter()
            .filter_map(|index| {
                let image = &set.solved(index)?.image;
                let mut plane = Plane::above(image, &Background::of(image));
                leave_out_stars(set, index, &mut plane);
                Some(plane)
            })
            .collect();
        Self { planes }
    }

    /// Returns the number of frames, half of them or more, that must show a pixel above `limit_dn`, so that
    /// of pixels that are above it by chance, independently in each frame, no more than one is expected;
    /// `None` if all frames are too few.
    fn frames_needed(&self, limit_dn: f64) -> Option<usize> {
        let (mut above, mut all) = (0.0, 0.0);
        for plane in &self.planes {
            above += plane.values.iter().filter(|value| **value > limit_dn).count() as f64;
            all += plane.values.iter().filter(|value| !value.is_nan()).count() as f64;
        }
        let pixels = all / self.planes.len().max(1) as f64;
        let chance = Binomial::new(above / f64::max(all, 1.0), self.planes.len() as u64).ok()?;
        let half = self.planes.len().div_ceil(2);
        (half..=self.planes.len()).find(|&needed| pixels * chance.sf(needed as u64 - 1) <= 1.0)
    }

    /// Returns the heights of the pixels above `limit_dn` in as many frames as are needed, medians, DN.
    fn heights_dn(&self, limit_dn: f64) -> Vec<f64> {
        let (Some(needed), Some(first)) = (self.frames_needed(limit_dn), self.planes.first()) else {
            return Vec::new();
        };
        let mut heights = Vec::new();
        let mut seen = Vec::with_capacity(self.planes.len());
        for place in 0..first.values.len() {
            seen.clear();
            seen.extend(self.planes.iter().map(|plane| plane.values[place]).filter(|value| !value.is_nan()));
            let above = seen.iter().filter(|value| **value > limit_dn).count();
            if above >= needed {
                seen.sort_by(f64::total_cmp);
                heights.push(seen[seen.len() / 2].max(limit_dn));
            }
        }
        heights
    }
}

/// Returns the frames, by index, whose attitudes differ from each other by more than some pixels.
fn different_pointings(set: &FrameSet) -> Vec<usize> {
    let (focal_px, _) = set.fit.camera.focal_length_px();
    let mut kept: Vec<usize> = Vec::new();
    for (index, frame) in set.fit.frames.iter().enumerate() {
        let is_different = kept.iter().all(|&other| {
            let turn = frame.camera_from_icrs * set.fit.frames[other].camera_from_icrs.inverse();
            let [w, x, y, z] = turn.wxyz();
            let angle = 2.0 * libm::atan2((x * x + y * y + z * z).sqrt(), w.abs());
            angle * focal_px > POINTING_PX
        });
        if is_different {
            kept.push(index);
        }
    }
    kept
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
