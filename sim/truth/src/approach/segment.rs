//! Segments of an approach, and the resulting motion along the docking axis: a sequence of constant
//! accelerations.

use contract::OutOfRange;
use contract::bounds::require;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::oscillation::OscillationConfig;

/// Smallest and largest d3 of an approach, m.
pub(super) const D3_M: std::ops::RangeInclusive<f64> = 0.05..=20_000.0;
/// Maximum duration of a segment and of an approach, s.
const MAX_DURATION_S: f64 = 1e5;

/// One segment of an approach. It begins at the end of the preceding segment; the speed changes to its own at
/// constant acceleration over the approach's `ramp_s`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum SegmentConfig {
    /// Motion towards the target.
    Glide {
        /// d3 at the end, m, 0.05 to 20000; by default the target's contact distance.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.05, max = 20000))]
        to_d3_m: Option<f64>,
        /// Closing speed at the start, m/s, 0 to 100.
        #[schemars(range(min = 0, max = 100))]
        speed_m_s: f64,
        /// Closing speed at the end, m/s, 0 to 100, reached at constant acceleration; by default the speed at
        /// the start.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = 100))]
        end_speed_m_s: Option<f64>,
    },
    /// Motion away from the target.
    Retreat {
        /// d3 at the end, m, 0.05 to 20000.
        #[schemars(range(min = 0.05, max = 20000))]
        to_d3_m: f64,
        /// Speed at the start, m/s, 0 to 100.
        #[schemars(range(min = 0, max = 100))]
        speed_m_s: f64,
        /// Speed at the end, m/s, 0 to 100, reached at constant acceleration; by default the speed at the
        /// start.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = 100))]
        end_speed_m_s: Option<f64>,
    },
    /// Rest along the docking axis.
    Hold {
        /// Duration including the initial braking, s, 0.1 to 1e5 and not shorter than the ramp.
        #[schemars(range(min = 0.1, max = 1e5))]
        duration_s: f64,
    },
    /// Rest along the docking axis, with an oscillation.
    Oscillation {
        /// Duration including the initial braking, s, 0.1 to 1e5 and not shorter than the ramp.
        #[schemars(range(min = 0.1, max = 1e5))]
        duration_s: f64,
        /// Oscillation with phases counted from the start of the segment; its amplitude rises and falls over
        /// the ramp.
        swing: OscillationConfig,
    },
}

fn check_d3(d3_m: f64) -> Result<(), OutOfRange> {
    require("approach.segments[].to_d3_m", d3_m, "0.05 to 20000", |d| D3_M.contains(&d))
}

/// Interval of constant acceleration along the docking axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    begin_s: f64,
    d3_m: f64,
    /// d(d3)/dt at the start: negative when closing.
    rate_m_s: f64,
    acceleration_m_s2: f64,
}

/// d3 and its rate as functions of time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AxialMotion {
    stretches: Vec<Stretch>,
    begin_s: Vec<f64>,
    end_s: f64,
    end_d3_m: f64,
    end_rate_m_s: f64,
}

impl AxialMotion {
    /// Creates the motion from checked segments, starting at `start_d3_m` with the first segment's own speed.
    ///
    /// # Errors
    /// [`OutOfRange`] for a segment that cannot be flown from the end of the preceding segment.
    pub(super) fn new(
        segments: &[SegmentConfig],
        start_d3_m: f64,
        contact_distance_m: f64,
        ramp_s: f64,
    ) -> Result<Self, OutOfRange> {
        let mut motion = Self {
            stretches: Vec::new(),
            begin_s: Vec::new(),
            end_s: 0.0,
            end_d3_m: start_d3_m,
            end_rate_m_s: 0.0,
        };
        for (index, segment) in segments.iter().enumerate() {
            // The first segment begins at its own speed: only then is a constant velocity exactly constant.
            let ramp_s = if index == 0 { 0.0 } else { ramp_s };
            motion
                .append(segment, contact_distance_m, ramp_s)
                .and_then(|()| check_d3(motion.end_d3_m))
                .and_then(|()| motion.check_nearest(contact_distance_m.min(start_d3_m)))
                .map_err(|error| error.in_entry(index))?;
        }
        require("approach.segments (duration, s)", motion.end_s, "at most 1e5", |t| t <= MAX_DURATION_S)?;
        Ok(motion)
    }

    fn append(&mut self, segment: &SegmentConfig, contact_m: f64, ramp_s: f64) -> Result<(), OutOfRange> {
        self.begin_s.push(self.end_s);
        match *segment {
            SegmentConfig::Glide { to_d3_m, speed_m_s, end_speed_m_s } => {
                let end = end_speed_m_s.unwrap_or(speed_m_s);
                self.travel(to_d3_m.unwrap_or(contact_m), [-speed_m_s, -end], ramp_s)
            }
            SegmentConfig::Retreat { to_d3_m, speed_m_s, end_speed_m_s } => {
                self.travel(to_d3_m, [speed_m_s, end_speed_m_s.unwrap_or(speed_m_s)], ramp_s)
            }
            SegmentConfig::Hold { duration_s } | SegmentConfig::Oscillation { duration_s, .. } => {
                let before_s = self.end_s;
                self.ramp_to(0.0, ramp_s);
                let rest_s = duration_s - (self.end_s - before_s);
                require("approach.segments[].duration_s", duration_s, "at least approach.ramp_s", |_| {
                    rest_s >= 0.0
                })?;
                self.end_rate_m_s = 0.0;
                self.stretch(rest_s, 0.0);
                Ok(())
            }
        }
    }

    /// Moves to `to_d3_m`; after the ramp the rate changes linearly from the first to the second of
    /// `rates_m_s`.
    fn travel(&mut self, to_d3_m: f64, rates_m_s: [f64; 2], ramp_s: f64) -> Result<(), OutOfRange> {
        self.ramp_to(rates_m_s[0], ramp_s);
        let mean = 0.5 * (rates_m_s[0] + rates_m_s[1]);
        let duration_s = (to_d3_m - self.end_d3_m) / mean;
        require(
            "approach.segments[].to_d3_m",
            to_d3_m,
            "a position ahead, beyond the change of speed, reached at a speed above 0 within 1e5 s",
            |_| duration_s > 0.0 && duration_s <= MAX_DURATION_S,
        )?;
        self.end_rate_m_s = rates_m_s[0];
        self.stretch(duration_s, (rates_m_s[1] - rates_m_s[0]) / duration_s);
        // Set directly, without the rounding of the products, so that the next segment begins at the
        // requested position and speed.
        self.end_d3_m = to_d3_m;
        self.end_rate_m_s = rates_m_s[1];
        Ok(())
    }

    /// Checks that no change of speed brings the camera nearer than `least_d3_m` or beyond the maximum d3.
    fn check_nearest(&self, least_d3_m: f64) -> Result<(), OutOfRange> {
        let ends = self.stretches.iter().skip(1).map(|next| next.begin_s).chain([self.end_s]);
        self.stretches.iter().zip(ends).try_for_each(|(stretch, end_s)| {
            let turn_s = stretch.begin_s - stretch.rate_m_s / stretch.acceleration_m_s2;
            if !(turn_s > stretch.begin_s && turn_s < end_s) {
                return Ok(());
            }
            require(
                "approach.segments[] (d3 where the motion turns, m)",
                stretch.range_and_rate_at(turn_s).0,
                "not nearer than contact and at most 20000: begin the change of speed farther out, or \
                 reduce ramp_s",
                |d3_m| (least_d3_m..=*D3_M.end()).contains(&d3_m),
            )
        })
    }

    fn ramp_to(&mut self, rate_m_s: f64, ramp_s: f64) {
        if ramp_s > 0.0 && rate_m_s != self.end_rate_m_s {
            self.stretch(ramp_s, (rate_m_s - self.end_rate_m_s) / ramp_s);
            self.end_rate_m_s = rate_m_s;
        }
    }

    fn stretch(&mut self, duration_s: f64, acceleration_m_s2: f64) {
        let stretch = Stretch {
            begin_s: self.end_s,
            d3_m: self.end_d3_m,
            rate_m_s: self.end_rate_m_s,
            acceleration_m_s2,
        };
        (self.end_d3_m, self.end_rate_m_s) = stretch.range_and_rate_at(self.end_s + duration_s);
        self.end_s += duration_s;
        self.stretches.push(stretch);
    }

    /// Returns d3, m, and its rate, m/s.
    pub(super) fn range_and_rate_at(&self, time_s: f64) -> (f64, f64) {
        let index = self.stretches.partition_point(|stretch| stretch.begin_s <= time_s);
        self.stretches
            .get(index.saturating_sub(1))
            .map_or((self.end_d3_m, 0.0), |stretch| stretch.range_and_rate_at(time_s))
    }

    /// End time of the last segment, s.
    pub(super) fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Start time of each segment, s.
    pub(super) fn begin_s(&self) -> &[f64] {
        &self.begin_s
    }
}

impl Stretch {
    fn range_and_rate_at(&self, time_s: f64) -> (f64, f64) {
        let t = time_s - self.begin_s;
        let d3_m = self.d3_m + (self.rate_m_s + 0.5 * self.acceleration_m_s2 * t) * t;
        (d3_m, self.rate_m_s + self.acceleration_m_s2 * t)
    }
}
