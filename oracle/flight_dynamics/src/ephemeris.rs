//! Motion and attitude as functions of time, from the content of files.

use contract::{Body, Icrs, Rotation};
use hifitime::Epoch;
use nalgebra::{Quaternion, UnitQuaternion, Vector4};
use sim::truth::{AttitudeFunction, SampledSegment, State, first_node};

use crate::coverage::{Coverage, Uncovered, seconds_between};
use crate::interpolation::{Interpolation, Method, lagrange};
use crate::spk::Spk;
use crate::tle::Tle;

/// Motion of one spacecraft, from a file.
#[derive(Debug, Clone)]
pub struct OrbitEphemeris {
    source: OrbitSource,
}

#[derive(Debug, Clone)]
enum OrbitSource {
    /// Segments in order of time, without overlap but for common ends, with times in seconds since the start
    /// of each.
    Segments(Vec<(Coverage, SampledSegment)>),
    Tle(Box<Tle>),
    Spk(Spk),
}

impl OrbitEphemeris {
    pub(crate) fn from_segments(segments: Vec<(Coverage, SampledSegment)>) -> Self {
        Self { source: OrbitSource::Segments(segments) }
    }

    /// Spans that are covered, in order of time.
    pub fn coverage(&self) -> Vec<Coverage> {
        match &self.source {
            OrbitSource::Segments(segments) => segments.iter().map(|(coverage, _)| *coverage).collect(),
            OrbitSource::Tle(tle) => vec![tle.coverage()],
            OrbitSource::Spk(spk) => spk.coverage(),
        }
    }

    /// Returns the state at `time`, relative to the Earth's centre, ICRS axes. At an instant that two
    /// segments share, the later one counts.
    ///
    /// # Errors
    /// [`Uncovered`] outside the coverage, and in a gap.
    pub fn state_at(&self, time: Epoch) -> Result<State, Uncovered> {
        let state = match &self.source {
            OrbitSource::Segments(segments) => {
                let segment = segments.iter().rev().find(|(coverage, _)| coverage.contains(time));
                segment.map(|(coverage, segment)| segment.state_at(seconds_between(coverage.start, time)))
            }
            OrbitSource::Tle(tle) => tle.state_at(time),
            OrbitSource::Spk(spk) => spk.state_at(time),
        };
        state.ok_or_else(|| Uncovered::new(time, self.coverage().into_iter()))
    }
}

impl From<Tle> for OrbitEphemeris {
    fn from(tle: Tle) -> Self {
        Self { source: OrbitSource::Tle(Box::new(tle)) }
    }
}

impl From<Spk> for OrbitEphemeris {
    fn from(spk: Spk) -> Self {
        Self { source: OrbitSource::Spk(spk) }
    }
}

/// Attitudes with a span and an interpolation.
#[derive(Debug, Clone)]
pub(crate) struct AttitudeNodes {
    pub(crate) coverage: Coverage,
    /// Seconds since the start of the coverage, ascending; at least as many as the interpolation needs.
    times_s: Vec<f64>,
    /// Components w, x, y, z; the sign is that which continues the quaternion before.
    quaternions: Vec<Vector4<f64>>,
    interpolation: Interpolation,
}

impl AttitudeNodes {
    /// Creates a segment; the times of the nodes ascend, and there are as many as the interpolation needs.
    pub(crate) fn new(
        coverage: Coverage,
        interpolation: Interpolation,
        nodes: impl Iterator<Item = (Epoch, Rotation<Body, Icrs>)>,
    ) -> Self {
        let (mut times_s, mut quaternions) = (Vec::new(), Vec::<Vector4<f64>>::new());
        for (time, rotation) in nodes {
            let quaternion = Vector4::from(rotation.wxyz());
            let is_opposite = quaternions.last().is_some_and(|last| last.dot(&quaternion) < 0.0);
            times_s.push(seconds_between(coverage.start, time));
            quaternions.push(if is_opposite { -quaternion } else { quaternion });
        }
        Self { coverage, times_s, quaternions, interpolation }
    }

    /// Returns the attitude at the nearest covered time, by the turn at a constant rate.
    fn nearest(&self, time: Epoch) -> Rotation<Body, Icrs> {
        let linear = Self { interpolation: Interpolation::ATTITUDE_DEFAULT, ..self.clone() };
        let time = time.max(self.coverage.start).min(self.coverage.stop);
        linear.rotation_at(time).unwrap_or_else(Rotation::identity)
    }

    fn rotation_at(&self, time: Epoch) -> Option<Rotation<Body, Icrs>> {
        let time_s = seconds_between(self.coverage.start, time);
        let first = first_node(&self.times_s, self.interpolation.nodes(), time_s, |node_s| *node_s);
        let nodes = first..first + self.interpolation.nodes();
        let times_s = self.times_s.get(nodes.clone())?;
        let quaternions = self.quaternions.get(nodes)?;
        let vector = match (self.interpolation.method, times_s, quaternions) {
            (Method::Linear, [from_s, to_s], [from, to]) => {
                along_great_circle(from, to, (time_s - from_s) / (to_s - from_s))
            }
            _ => lagrange(times_s, quaternions, time_s),
        };
        let norm = vector.norm();
        // Nodes far apart: the polynomial passes near zero, where it states no attitude.
        if norm.is_nan() || norm < 0.5 {
            return None;
        }
        let [w, x, y, z] = (vector / norm).into();
        Some(Rotation::from_unit_quaternion(UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))))
    }
}

/// Spherical linear interpolation of unit quaternions less than 90° apart (in quaternion space).
fn along_great_circle(from: &Vector4<f64>, to: &Vector4<f64>, fraction: f64) -> Vector4<f64> {
    let angle = 2.0 * libm::atan2((to - from).norm(), (to + from).norm());
    let sin = libm::sin(angle);
    if sin < 1e-9 {
        return from * (1.0 - fraction) + to * fraction;
    }
    from * (libm::sin((1.0 - fraction) * angle) / sin) + to * (libm::sin(fraction * angle) / sin)
}

/// Attitude of one spacecraft, from a file. Has at least one segment.
#[derive(Debug, Clone)]
pub struct AttitudeEphemeris {
    /// Segments in order of time, without overlap but for common ends.
    segments: Vec<AttitudeNodes>,
}

impl AttitudeEphemeris {
    pub(crate) fn new(segments: Vec<AttitudeNodes>) -> Self {
        Self { segments }
    }

    /// Spans that are covered, in order of time.
    pub fn coverage(&self) -> Vec<Coverage> {
        self.segments.iter().map(|segment| segment.coverage).collect()
    }

    /// Returns the attitude at `time`. At an instant that two segments share, the later one counts.
    ///
    /// # Errors
    /// [`Uncovered`] outside the coverage, in a gap, and between nodes that are too far apart for the
    /// interpolation.
    pub fn rotation_at(&self, time: Epoch) -> Result<Rotation<Body, Icrs>, Uncovered> {
        let segment = self.segments.iter().rev().find(|segment| segment.coverage.contains(time));
        segment
            .and_then(|segment| segment.rotation_at(time))
            .ok_or_else(|| Uncovered::new(time, self.coverage().into_iter()))
    }
}

impl AttitudeFunction for AttitudeEphemeris {
    /// In a gap, the end of the nearest segment counts; where nodes are too far apart for the polynomial, the
    /// turn at a constant rate between the two neighbours.
    fn body_from_icrs(&self, time: Epoch) -> Rotation<Body, Icrs> {
        if let Ok(rotation) = self.rotation_at(time) {
            return rotation;
        }
        let distance_s = |segment: &&AttitudeNodes| {
            let before = seconds_between(time, segment.coverage.start).max(0.0);
            before.max(seconds_between(segment.coverage.stop, time))
        };
        let nearest = self.segments.iter().min_by(|a, b| distance_s(a).total_cmp(&distance_s(b)));
        nearest.map_or_else(Rotation::identity, |segment| segment.nearest(time))
    }
}
