//! Motion from the poses of fields, and from the station's outline where visible: selection of fields, and
//! reports.

use contract::docking::{Motion, PoseEstimate};
use nalgebra::{Matrix1, Matrix6, Vector1};

use super::filters::{MotionConfig, OutlineRange, Track, unknown_rates};
use super::scatter::Scatter;
use crate::PipelineError;
use crate::docking::pose::geometry::to_vector;

/// Longest time without a pose after which the motion remains valid, s.
const MAX_GAP_S: f64 = 5.0;

/// Longest time for which a pose confirms the next one, s: five fields. Wrong poses are found here and there
/// in a video without a recognisable target, and before the rates are known a later one would agree.
const MAX_CONFIRMATION_S: f64 = 0.11;

/// Number of successive fields off the motion after which it begins anew.
const CONTRARY_FIELDS: u32 = 5;

/// Largest normalised square of the difference between an outline's range and the motion. Outlines with a
/// larger one are left out.
const OUTLINE_GATE: f64 = 25.0;

/// Number of fields after which a motion can confirm a pose that would not be reported without confirmation.
const ESTABLISHED_FIELDS: u32 = 4;

/// Smallest number of fields in a reported motion.
const MIN_FIELDS: u32 = 3;

/// Motion of the camera, field by field.
#[derive(Debug, Clone)]
pub struct MotionTracker {
    config: MotionConfig,
    track: Option<Track>,
    scatter: Scatter<6>,
    outline_scatter: Scatter<1>,
    /// Number of successive fields that were left out.
    contrary: u32,
    /// Number of successive outlines that were left out.
    contrary_outlines: u32,
    /// Number of poses used since the last report, and since the motion began.
    fields: u32,
    all_fields: u32,
    /// Time of the last pose that was used, s.
    last_pose_s: f64,
}

/// Agreement of a pose with the motion so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Continuity {
    /// No pose of the five fields before confirms this one.
    Begins,
    /// The pose agrees with the motion of earlier ones.
    Continues,
    /// The pose differs from the motion by more than the gate.
    Breaks,
}

impl MotionTracker {
    /// Creates a tracker without any measurement.
    ///
    /// # Errors
    /// Those of [`MotionConfig::check`].
    pub fn new(config: MotionConfig) -> Result<Self, PipelineError> {
        config.check()?;
        Ok(Self {
            config,
            track: None,
            scatter: Scatter::default(),
            outline_scatter: Scatter::default(),
            contrary: 0,
            contrary_outlines: 0,
            fields: 0,
            all_fields: 0,
            last_pose_s: f64::NEG_INFINITY,
        })
    }

    /// Returns true if a pose agrees with a motion that at least four fields have established.
    pub fn confirms(&self, time_s: f64, estimate: &PoseEstimate) -> bool {
        let Some(track) = self.track.as_ref().filter(|_| self.all_fields >= ESTABLISHED_FIELDS) else {
            return false;
        };
        let elapsed_s = time_s - track.time_s;
        if !(elapsed_s > 0.0 && elapsed_s <= MAX_GAP_S) {
            return false;
        }
        let mut next = track.clone();
        next.predict(time_s, &self.config);
        let square = next.least_square(&to_vector(&estimate.pose), &(estimate.covariance + track.common));
        square.is_some_and(|square| square <= self.config.field_gate)
    }

    /// Returns the addition to the covariance of a pose whose time is uncertain by `sigma_s`, one standard
    /// deviation, s: the motion within that time. Without a motion, the largest rates of a camera are
    /// assumed.
    pub(in crate::docking) fn timing_covariance(&self, time_s: f64, sigma_s: f64) -> Matrix6<f64> {
        let kept = self.track.as_ref().filter(|track| (0.0..=MAX_GAP_S).contains(&(time_s - track.time_s)));
        let squares = kept.map_or_else(|| unknown_rates(&self.config), Track::squares_of_rates);
        squares * (sigma_s * sigma_s)
    }

    /// Adds the pose of a field, with the part of its covariance that is common to the fields of several
    /// seconds; `is_small`: the target's features are narrower than pixels, and more of the covariance may be
    /// common. Returns the agreement with the motion, and the factor by which the scatter of the fields
    /// exceeds their covariances.
    pub fn add(
        &mut self,
        time_s: f64,
        estimate: &PoseEstimate,
        common: &Matrix6<f64>,
        is_small: bool,
    ) -> (Continuity, f64) {
        if !time_s.is_finite() {
            return (Continuity::Begins, 1.0);
        }
        let is_kept = self.track.as_ref().is_some_and(|track| {
            let elapsed_s = time_s - track.time_s;
            elapsed_s > 0.0 && elapsed_s <= MAX_GAP_S
        });
        if !is_kept {
            self.scatter = Scatter::default();
            self.scatter.add(time_s, &to_vector(&estimate.pose), &estimate.covariance);
            let common = common + self.scatter.common_part(common, is_small);
            self.begin(time_s, estimate, &common);
            return (Continuity::Begins, 1.0);
        }
        let factor = self.scatter.add(time_s, &to_vector(&estimate.pose), &estimate.covariance);
        let noise = PoseEstimate { covariance: estimate.covariance * factor, ..*estimate };
        (self.follow(time_s, &noise, common, is_small), factor)
    }

    /// Adds the range by the station's outline, after the field's pose if there is one.
    pub(in crate::docking) fn add_range(&mut self, time_s: f64, range: &OutlineRange) {
        if !time_s.is_finite() {
            return;
        }
        let variance = range.sigma_m * range.sigma_m;
        let factor = self.outline_scatter.add(time_s, &Vector1::new(range.range_m), &Matrix1::new(variance));
        let range = &OutlineRange { sigma_m: range.sigma_m * factor.sqrt(), ..*range };
        let elapsed_s = self.track.as_ref().map(|track| time_s - track.time_s);
        if !elapsed_s.is_some_and(|elapsed_s| (0.0..=MAX_GAP_S).contains(&elapsed_s)) {
            self.begin_at_range(time_s, range);
            return;
        }
        let Some(track) = &mut self.track else { return };
        let mut next = track.clone();
        next.predict(time_s, &self.config);
        if next.least_square_of_range(range) <= OUTLINE_GATE && next.update_range(range) {
            self.contrary_outlines = 0;
            *track = next;
            return;
        }
        self.contrary_outlines += 1;
        if self.contrary_outlines >= CONTRARY_FIELDS && self.all_fields == 0 {
            self.begin_at_range(time_s, range);
        }
    }

    fn begin_at_range(&mut self, time_s: f64, range: &OutlineRange) {
        (self.contrary, self.contrary_outlines) = (0, 0);
        (self.fields, self.all_fields) = (0, 0);
        self.track = Some(Track::begin_at_range(time_s, range, &self.config));
    }

    fn follow(
        &mut self,
        time_s: f64,
        estimate: &PoseEstimate,
        common: &Matrix6<f64>,
        is_small: bool,
    ) -> Continuity {
        let noise = &estimate.covariance;
        // Not part of the gate: the motion so far has the same error.
        let all_common = &(common + self.scatter.common_part(common, is_small));
        let measured = to_vector(&estimate.pose);
        let Some(track) = &mut self.track else { return Continuity::Begins };
        let mut next = track.clone();
        next.predict(time_s, &self.config);
        let square = next.least_square(&measured, &(noise + common)).unwrap_or(f64::INFINITY);
        if square > self.config.field_gate {
            self.contrary += 1;
            // One pose alone is no more credible than the next one.
            if self.contrary >= CONTRARY_FIELDS || self.all_fields == 1 {
                self.begin(time_s, estimate, all_common);
            }
            return Continuity::Breaks;
        }
        self.contrary = 0;
        let is_confirmed = time_s - self.last_pose_s <= MAX_CONFIRMATION_S;
        if next.update(&measured, noise) {
            next.common = *all_common;
            *track = next;
            self.fields += 1;
            self.all_fields += 1;
            self.last_pose_s = time_s;
        } else {
            self.begin(time_s, estimate, all_common);
        }
        if is_confirmed { Continuity::Continues } else { Continuity::Begins }
    }

    fn begin(&mut self, time_s: f64, estimate: &PoseEstimate, common: &Matrix6<f64>) {
        (self.contrary, self.contrary_outlines) = (0, 0);
        self.fields = 1;
        self.all_fields = 1;
        self.last_pose_s = time_s;
        self.track = Some(Track::begin(time_s, estimate, common, &self.config));
    }

    /// Returns the motion at the last field used. Returns `None` when fewer than three fields were used since
    /// the last report, or when the speed is beyond that of any approach.
    pub fn report(&mut self) -> Option<Motion> {
        let fields = std::mem::take(&mut self.fields);
        if fields < MIN_FIELDS || self.all_fields < MIN_FIELDS {
            return None;
        }
        let motion = self.track.as_ref()?.motion(fields);
        let rate_m_s = motion.velocity_m_s.norm();
        (rate_m_s.is_finite() && rate_m_s <= 3.0 * self.config.speed_m_s).then_some(motion)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{approach, normal};
    use super::*;
    use crate::docking::pose::geometry::to_pose;
    use contract::docking::Pose;
    use nalgebra::{Cholesky, Vector6};

    /// Returns the covariance of a field: metres beside radians, with the strong correlation of lateral
    /// position and attitude.
    fn field_covariance() -> Matrix6<f64> {
        let mut shape = Matrix6::identity();
        for (i, j, correlation) in [(0, 4, 0.98), (1, 3, -0.98)] {
            shape[(i, j)] = correlation;
            shape[(j, i)] = correlation;
        }
        let sigma = Vector6::new(4e-3, 4e-3, 2e-3, 8e-4, 8e-4, 1e-4);
        Matrix6::from_fn(|i, j| shape[(i, j)] * sigma[i] * sigma[j])
    }

    /// Returns the pose of field `k` of a motion, with noise of that covariance.
    fn measured(motion: impl Fn(f64) -> Pose, k: u32, seed: u64) -> (f64, PoseEstimate) {
        let covariance = field_covariance();
        let root = Cholesky::new(covariance).unwrap().l();
        let t = f64::from(k) * 0.02;
        let draw = Vector6::from_fn(|i, _| normal(seed * 1_000_003 + u64::from(k) * 16 + i as u64));
        (t, PoseEstimate { pose: to_pose(&(to_vector(&motion(t)) + root * draw)), covariance })
    }

    /// Returns the pose of a ship that brakes from 0.3 m/s with 0.06 m/s² between 2 s and 7 s, then stands
    /// still.
    fn braking(t: f64) -> Pose {
        let mut pose = approach(t.min(2.0));
        let s = (t - 2.0).clamp(0.0, 5.0);
        pose.position_m.z += -0.3 * s + 0.03 * s * s;
        pose
    }

    /// Returns the errors of (d, φ) at the reports of a motion relative to their covariance, and those of
    /// d3's rate relative to its standard deviation.
    fn reports(motion: impl Fn(f64) -> Pose, seed: u64, seconds: u32) -> Vec<(f64, f64)> {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let mut reports_in_sigma = Vec::new();
        for k in 0..50 * seconds {
            let (t, estimate) = measured(&motion, k, seed);
            let expected = if k == 0 { Continuity::Begins } else { Continuity::Continues };
            assert_eq!(tracker.add(t, &estimate, &Matrix6::zeros(), false).0, expected, "field {k}");
            if k % 10 == 9 {
                let report = tracker.report().unwrap();
                let off = report.pose.position_m - motion(t).position_m;
                let h = 1e-3;
                let rate = (motion(t + h).position_m.z - motion(t - h).position_m.z) / (2.0 * h);
                let sigma = report.position_covariance.diagonal().map(f64::sqrt);
                reports_in_sigma.push((off.z / sigma[2], (report.velocity_m_s.z - rate) / sigma[5]));
            }
        }
        reports_in_sigma
    }

    fn share_within_3_sigma(motion: impl Fn(f64) -> Pose + Copy, seconds: u32) -> (f64, f64) {
        let reports_in_sigma: Vec<(f64, f64)> =
            (0..10).flat_map(|seed| reports(motion, seed, seconds)).collect();
        let share = |of: &dyn Fn(&(f64, f64)) -> f64| {
            reports_in_sigma.iter().filter(|one| of(one).abs() <= 3.0).count() as f64
                / reports_in_sigma.len() as f64
        };
        (share(&|one| one.0), share(&|one| one.1))
    }

    #[test]
    fn the_motion_of_steady_and_braking_approaches_is_within_its_covariance() {
        // 10 sequences of 15 and 45 reports; 99.7 % of the reports are expected within 3 σ.
        let (position, rate) = share_within_3_sigma(approach, 3);
        assert!(position >= 0.98 && rate >= 0.98, "{position} {rate}");
        let (position, rate) = share_within_3_sigma(braking, 9);
        assert!(position >= 0.98 && rate >= 0.97, "{position} {rate}");
    }

    #[test]
    fn an_outline_gives_the_range_rate_before_the_first_pose() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let range = |k: u32| 60.0 - 1.2 * f64::from(k) * 0.02;
        for k in 0..160 {
            let t = f64::from(k) * 0.02;
            if k >= 150 {
                let sigma = Vector6::new(1.0, 1.0, 0.3, 0.02, 0.02, 0.01);
                let draw = Vector6::from_fn(|i, _| normal(u64::from(k) * 8 + i as u64));
                let at = Vector6::new(0.3, -0.2, range(k), 0.0, 0.0, 0.0);
                let pose = to_pose(&(at + sigma.component_mul(&draw)));
                let covariance = Matrix6::from_diagonal(&sigma.component_mul(&sigma));
                let (continuity, _) =
                    tracker.add(t, &PoseEstimate { pose, covariance }, &Matrix6::zeros(), false);
                let expected = if k == 150 { Continuity::Begins } else { Continuity::Continues };
                assert_eq!(continuity, expected, "field {k}");
            }
            // The rim makes the outline 0.7 % too large.
            let range_m = 0.993 * range(k) + 0.03 * normal(90_000 + u64::from(k));
            tracker.add_range(t, &OutlineRange { range_m, sigma_m: 0.03, radius_px: 6000.0 / range_m });
            assert!(k >= 152 || tracker.clone().report().is_none());
        }
        let motion = tracker.report().unwrap();
        let rate = -motion.velocity_m_s.z;
        assert!((rate - 1.2).abs() < 0.05 && motion.position_covariance[(5, 5)].sqrt() < 0.05, "{motion:?}");
        assert!((motion.pose.position_m.z - range(159)).abs() < 0.3);
    }

    #[test]
    fn a_steady_approach_improves_the_range_rate() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let mut sigmas = Vec::new();
        for k in 0..200 {
            let (t, estimate) = measured(approach, k, 1);
            tracker.add(t, &estimate, &Matrix6::zeros(), false);
            if k % 10 == 9 {
                sigmas.push(tracker.report().unwrap().position_covariance[(5, 5)].sqrt());
            }
        }
        // First from a field's 2 mm over 0.2 s, then over seconds of constant velocity.
        assert!(sigmas[0] > 0.01 && sigmas[19] < 0.25 * sigmas[0], "{sigmas:?}");
    }

    #[test]
    fn a_wrong_field_breaks_the_motion_and_is_left_out() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        for k in 0..30 {
            let (t, mut estimate) = measured(approach, k, 4);
            let is_wrong = k == 20;
            if is_wrong {
                estimate.pose.position_m.z += 0.5;
                assert!(!tracker.confirms(t, &estimate));
            }
            let (continuity, _) = tracker.add(t, &estimate, &Matrix6::zeros(), false);
            assert_eq!(continuity == Continuity::Breaks, is_wrong, "field {k}");
        }
        let motion = tracker.report().unwrap();
        assert_eq!(motion.fields, 29);
        assert!((motion.pose.position_m.z - approach(motion.time_s).position_m.z).abs() < 0.01);
    }

    #[test]
    fn fields_that_all_contradict_begin_the_motion_anew() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        let elsewhere = |t: f64| {
            let mut pose = approach(t);
            pose.position_m.z += if t < 0.399 { 0.0 } else { 3.0 };
            pose
        };
        let broken = (0..40).filter(|k| {
            let (t, estimate) = measured(elsewhere, *k, 5);
            tracker.add(t, &estimate, &Matrix6::zeros(), false).0 == Continuity::Breaks
        });
        assert_eq!(broken.collect::<Vec<_>>(), (20..20 + CONTRARY_FIELDS).collect::<Vec<_>>());
    }

    #[test]
    fn errors_common_to_all_fields_are_added_and_not_averaged() {
        let common = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6));
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        for k in 0..100 {
            let (t, estimate) = measured(approach, k, 6);
            tracker.add(t, &estimate, &common, false);
        }
        assert!(tracker.report().unwrap().position_covariance[(2, 2)] >= 1e-4);
    }

    #[test]
    fn too_few_fields_and_impossible_rates_are_not_reported() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        assert_eq!(tracker.report(), None);
        for k in 0..2 {
            let (t, estimate) = measured(approach, k, 7);
            tracker.add(t, &estimate, &Matrix6::zeros(), false);
        }
        assert_eq!(tracker.report(), None);
        let config = MotionConfig { speed_m_s: 0.05, ..MotionConfig::default() };
        let mut slow = MotionTracker::new(config).unwrap();
        for k in 0..100 {
            let (t, estimate) = measured(approach, k, 7);
            slow.add(t, &estimate, &Matrix6::zeros(), false);
        }
        assert_eq!(slow.report(), None, "0.3 m/s is six times the speed that is expected");
    }

    /// Any number of fields of the same time contains no rates; the motion begins with the first later field.
    #[test]
    fn fields_of_one_moment_give_no_motion() {
        let mut tracker = MotionTracker::new(MotionConfig::default()).unwrap();
        for k in 0..30 {
            let (_, estimate) = measured(|_| approach(1.0), k, 8);
            tracker.add(1.0, &estimate, &Matrix6::zeros(), false);
            assert_eq!(tracker.clone().report(), None, "field {k}");
        }
        for k in 1..MIN_FIELDS {
            assert_eq!(tracker.clone().report(), None, "{k} moments");
            let time_s = 1.0 + 0.02 * f64::from(k);
            let (_, estimate) = measured(|_| approach(time_s), 30 + k, 8);
            tracker.add(time_s, &estimate, &Matrix6::zeros(), false);
        }
        assert_eq!(tracker.report().unwrap().fields, MIN_FIELDS);
    }
}
