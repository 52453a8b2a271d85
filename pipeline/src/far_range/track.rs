//! Tracking: links the clusters of two frames (section 2.2, Eqs. 5 to 10).

use std::collections::VecDeque;

use contract::bounds::require;
use contract::{CameraFrame, Icrs, OutOfRange, PixelPoint, Rotation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::assignment::{AllowedPair, assign};
use super::detect::Blob;
use crate::CameraModel;

/// Similarity that two clusters of successive frames must have to be linked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TrackingConfig {
    /// Δp_max: greatest distance between the expected and the observed position of a cluster, px, above 0
    /// to 20000. Must cover the motion of the target between two frames; a larger value links unlisted stars
    /// as well.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 20000))]
    pub max_displacement_px: f64,
    /// Δs_max: greatest change of the weighted size, in units of full scale, above 0 to 1e9.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub max_size_change: f64,
    /// ω_p: weight of the displacement in the similarity, 0 to 1e6; not both weights are 0.
    #[schemars(range(min = 0, max = 1e6))]
    pub weight_displacement: f64,
    /// ω_s: weight of the change of size in the similarity, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub weight_size: f64,
}

impl Default for TrackingConfig {
    fn default() -> Self {
        Self { max_displacement_px: 15.0, max_size_change: 20.0, weight_displacement: 1.0, weight_size: 1.0 }
    }
}

impl TrackingConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        let expected = "0 to 1e6, and above 0 if the other weight is 0";
        require("tracking.weight_size", self.weight_size, expected, |v| v + self.weight_displacement > 0.0)
    }
}

/// Cluster of the previous frame and its history.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Track {
    /// c_prev: centre in the previous frame.
    pub(super) centre: PixelPoint,
    /// s_prev: weighted size in the previous frame.
    pub(super) size: f64,
    /// True if the cluster was marked as a star.
    pub(super) is_star: bool,
    /// N: number of images that the cluster can be tracked back.
    pub(super) length: u32,
    /// Mean velocity, px/s along columns and rows (Eq. 10).
    pub(super) velocity_px_per_s: [f64; 2],
    /// Velocities of the bounded mean, oldest first; empty if the mean is unbounded.
    steps_px_per_s: VecDeque<[f64; 2]>,
}

impl Track {
    /// Starts a track at this cluster.
    pub(super) fn new(blob: &Blob, is_star: bool) -> Self {
        Self {
            centre: blob.centre,
            size: blob.size,
            is_star,
            length: 0,
            velocity_px_per_s: [0.0; 2],
            steps_px_per_s: VecDeque::new(),
        }
    }

    /// Extends the track by one frame, `dt_s` seconds later.
    ///
    /// Without `n_max` the mean velocity is Eq. 10 as printed, over the whole track. With `n_max` the mean
    /// covers only the last `n_max` steps: earlier steps, for instance a jump to another object, are
    /// forgotten altogether.
    pub(super) fn extended(self, blob: &Blob, is_star: bool, dt_s: f64, n_max: Option<u32>) -> Self {
        let step = [(blob.centre.x - self.centre.x) / dt_s, (blob.centre.y - self.centre.y) / dt_s];
        let mut steps = self.steps_px_per_s;
        let velocity_px_per_s = match n_max {
            None => {
                let n = f64::from(self.length);
                std::array::from_fn(|i| (n * self.velocity_px_per_s[i] + step[i]) / (n + 1.0))
            }
            Some(n_max) => {
                steps.push_back(step);
                if steps.len() > n_max as usize {
                    steps.pop_front();
                }
                std::array::from_fn(|i| steps.iter().map(|step| step[i]).sum::<f64>() / steps.len() as f64)
            }
        };
        Self {
            centre: blob.centre,
            size: blob.size,
            is_star,
            length: self.length.saturating_add(1),
            velocity_px_per_s,
            steps_px_per_s: steps,
        }
    }

    /// Norm of the mean velocity, px/s.
    pub(super) fn speed_px_per_s(&self) -> f64 {
        libm::hypot(self.velocity_px_per_s[0], self.velocity_px_per_s[1])
    }
}

/// Expected position of a track's cluster in the current frame. A star moves with the change of attitude
/// (Eqs. 5a, 5b, 6); any other cluster stays at its previous position. `None` for a star that the camera no
/// longer sees.
pub(super) fn expected_position(
    track: &Track,
    icrs_from_camera_before: &Rotation<Icrs, CameraFrame>,
    camera_from_icrs_now: &Rotation<CameraFrame, Icrs>,
    model: &CameraModel,
) -> Option<PixelPoint> {
    if !track.is_star {
        return Some(track.centre);
    }
    let star = *icrs_from_camera_before * model.back_project(track.centre)?;
    model.project(&(*camera_from_icrs_now * star))
}

/// Similarity μ of two clusters (Eqs. 7 to 9), smaller for more similar clusters; `None` (∞) beyond the
/// thresholds.
pub(super) fn similarity(
    expected: PixelPoint,
    previous_size: f64,
    blob: &Blob,
    config: &TrackingConfig,
) -> Option<f64> {
    let displacement = blob.centre.distance(expected);
    let size_change = (blob.size - previous_size).abs();
    if displacement > config.max_displacement_px || size_change > config.max_size_change {
        return None;
    }
    let (wp, ws) = (config.weight_displacement, config.weight_size);
    Some((wp * displacement + ws * size_change) / (wp + ws))
}

/// Returns for each cluster the previous track to which it is linked (an index into `tracks`), by the
/// assignment of least total μ. `expected` holds one position per track.
pub(super) fn link(
    blobs: &[Blob],
    tracks: &[Track],
    expected: &[Option<PixelPoint>],
    config: &TrackingConfig,
) -> Vec<Option<usize>> {
    // Sorted by image column: most pairs are far apart and are never compared.
    let mut positions: Vec<(usize, PixelPoint)> =
        expected.iter().enumerate().filter_map(|(column, position)| Some((column, (*position)?))).collect();
    positions.sort_unstable_by(|(_, a), (_, b)| a.x.total_cmp(&b.x));
    let mut pairs = Vec::new();
    for (row, blob) in blobs.iter().enumerate() {
        let (left, right) =
            (blob.centre.x - config.max_displacement_px, blob.centre.x + config.max_displacement_px);
        let first = positions.partition_point(|(_, position)| position.x < left);
        let near = positions[first..].iter().take_while(|(_, position)| position.x <= right);
        pairs.extend(near.filter_map(|&(column, position)| {
            let cost = similarity(position, tracks.get(column)?.size, blob, config)?;
            Some(AllowedPair { row, column, cost })
        }));
    }
    pairs.sort_unstable_by_key(|pair| (pair.row, pair.column));
    assign(blobs.len(), tracks.len(), &pairs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera_model::tests::argon;
    use contract::{Body, Direction};
    use nalgebra::Vector3;

    fn blob(x: f64, y: f64, size: f64) -> Blob {
        Blob { centre: PixelPoint::new(x, y), size, pixels: 1 }
    }

    fn track(x: f64, y: f64, is_star: bool) -> Track {
        Track::new(&blob(x, y, 1.0), is_star)
    }

    const CONFIG: TrackingConfig = TrackingConfig {
        max_displacement_px: 10.0,
        max_size_change: 5.0,
        weight_displacement: 2.0,
        weight_size: 1.0,
    };

    #[test]
    fn a_star_is_propagated_through_the_change_of_attitude() {
        let model = argon();
        let camera_from_body: Rotation<CameraFrame, Body> =
            Rotation::from_rotation_vector(Vector3::new(0.3, -0.2, 1.0));
        let before: Rotation<Body, Icrs> = Rotation::from_rotation_vector(Vector3::new(1.0, 2.0, 0.5));
        let now = Rotation::from_rotation_vector(Vector3::new(0.01, -0.02, 0.03)) * before;
        let (camera_before, camera_now) = (camera_from_body * before, camera_from_body * now);
        // Truth: one direction of the sky, projected at both attitudes.
        let sky: Direction<Icrs> =
            camera_before.inverse() * Direction::from_vector(Vector3::new(0.02, 0.03, 1.0)).unwrap();
        let seen_before = model.project(&(camera_before * sky)).unwrap();
        let seen_now = model.project(&(camera_now * sky)).unwrap();
        let expect = |is_star| {
            let track = track(seen_before.x, seen_before.y, is_star);
            expected_position(&track, &camera_before.inverse(), &camera_now, &model).unwrap()
        };
        assert!(expect(true).distance(seen_now) < 1e-8);
        assert!(
            seen_now.distance(seen_before) > 20.0,
            "the attitude must change for this test to say anything"
        );
        // Any other cluster is expected at its previous position.
        assert_eq!(expect(false), seen_before);
    }

    #[test]
    fn a_star_behind_the_camera_has_no_expected_position() {
        let turned = Rotation::from_rotation_vector(Vector3::new(3.0, 0.0, 0.0));
        assert_eq!(
            expected_position(&track(300.0, 200.0, true), &Rotation::identity(), &turned, &argon()),
            None
        );
    }

    #[test]
    fn similarity_is_eq_9() {
        // Δp = 5, Δs = 2: (2 · 5 + 1 · 2) / 3.
        let got = similarity(PixelPoint::new(0.0, 0.0), 1.0, &blob(3.0, 4.0, 3.0), &CONFIG).unwrap();
        assert!((got - 4.0).abs() < 1e-15);
    }

    #[test]
    fn similarity_is_infinite_beyond_either_threshold() {
        let origin = PixelPoint::new(0.0, 0.0);
        assert!(similarity(origin, 1.0, &blob(10.0, 0.0, 6.0), &CONFIG).is_some());
        assert_eq!(similarity(origin, 1.0, &blob(10.1, 0.0, 1.0), &CONFIG), None);
        assert_eq!(similarity(origin, 1.0, &blob(0.0, 0.0, 6.1), &CONFIG), None);
    }

    #[test]
    fn links_follow_the_expected_positions() {
        let tracks = [track(0.0, 0.0, true), track(20.0, 0.0, false)];
        let expected = [Some(PixelPoint::new(18.0, 0.0)), Some(tracks[1].centre)];
        let blobs = [blob(21.0, 0.0, 1.0), blob(18.0, 0.0, 1.0), blob(100.0, 0.0, 1.0)];
        assert_eq!(link(&blobs, &tracks, &expected, &CONFIG), [Some(1), Some(0), None]);
    }

    #[test]
    fn a_track_expected_nowhere_is_not_linked() {
        assert_eq!(link(&[blob(0.0, 0.0, 1.0)], &[track(0.0, 0.0, true)], &[None], &CONFIG), [None]);
    }

    #[test]
    fn mean_velocity_is_eq_10() {
        let mut track = track(0.0, 0.0, false);
        for (i, x) in [1.0, 3.0, 9.0].into_iter().enumerate() {
            track = track.extended(&blob(x, 0.0, 1.0), false, 2.0, None);
            assert_eq!(track.length, i as u32 + 1);
        }
        // Mean of 0.5, 1 and 3 px/s.
        assert!((track.speed_px_per_s() - 1.5).abs() < 1e-15);
    }

    #[test]
    fn a_bounded_memory_forgets_the_first_frames() {
        let run = |n_max: Option<u32>| {
            let mut track = track(0.0, 0.0, false);
            // Back and forth: 100 frames at +1 px/s, 100 at −1 px/s.
            for i in 1..=200 {
                let x = if i <= 100 { f64::from(i) } else { f64::from(200 - i) };
                track = track.extended(&blob(x, 0.0, 1.0), false, 1.0, n_max);
            }
            track.speed_px_per_s()
        };
        assert!(run(None) < 1e-12, "Eq. 10 as printed: back at the first pixel, the mean velocity is 0");
        assert!(run(Some(10)) > 0.99);
    }

    #[test]
    fn a_bounded_memory_forgets_a_jump_altogether() {
        let mut track = track(0.0, 0.0, false);
        for i in 0..=20 {
            assert!(i == 0 || track.speed_px_per_s() > 0.0 || i > 10);
            track = track.extended(&blob(15.0, 0.0, 1.0), false, 15.0, Some(10));
        }
        assert_eq!(track.speed_px_per_s(), 0.0);
    }
}
