//! Mean elements of chaser and target with secular drift.
//!
//! Between manoeuvres each orbit drifts at its own secular rates. The chaser's orbit is stored as one arc
//! from each manoeuvre to the next; any instant can therefore be computed independently.

use contract::OutOfRange;
use hifitime::Epoch;

use super::clock::parse_utc_field;
use super::ephemeris::check_covered;
use super::orbit::Elements;
use super::states::{OrbitConfig, States, seconds_between};

/// Mean elements of both spacecraft over all time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeanElements {
    epoch: Epoch,
    target: Elements,
    /// Arcs in order of time; the first also extends back before the epoch.
    arcs: Vec<Arc>,
}

/// Orbit of the chaser from one manoeuvre to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arc {
    start_s: f64,
    chaser: Elements,
}

impl Arc {
    fn chaser_at(&self, time_s: f64) -> Elements {
        self.chaser.propagate(time_s - self.start_s)
    }
}

impl MeanElements {
    /// Computes the arcs.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid epoch, or an orbit outside the supported range; [`OutOfRange`] for a
    /// manoeuvre that is out of order, not after the epoch, or results in an unsupported orbit.
    pub(super) fn new(config: &OrbitConfig) -> Result<Self, OutOfRange> {
        let epoch = parse_utc_field("orbit.epoch_utc", &config.epoch_utc)?;
        check_covered("orbit.epoch_utc", &config.epoch_utc, epoch)?;
        let target = config.target.elements()?;
        config.relative.check()?;
        let chaser = config.relative.chaser(&target);
        if !chaser.is_supported() {
            return Err(OutOfRange::new(
                "orbit.relative",
                format!("{:?}", config.relative),
                "a chaser orbit with an eccentricity of at most 0.9, a perigee above 100 km and an \
                 inclination to the equator",
            ));
        }
        let mut last = Arc { start_s: 0.0, chaser };
        let mut arcs = vec![last];
        for (index, manoeuvre) in config.manoeuvres.iter().enumerate() {
            manoeuvre.check(index)?;
            let time = manoeuvre.time()?;
            check_covered(format!("orbit.manoeuvres[{index}].time_utc"), &manoeuvre.time_utc, time)?;
            let start_s = seconds_between(epoch, time);
            if start_s <= last.start_s {
                let expected = "after the orbit's epoch and after the previous manoeuvre";
                return Err(manoeuvre.refused_time(index, expected));
            }
            let chaser = manoeuvre.apply(&last.chaser_at(start_s)).ok_or_else(|| {
                manoeuvre.refused_impulse(index, "an impulse that results in a supported orbit")
            })?;
            last = Arc { start_s, chaser };
            arcs.push(last);
        }
        Ok(Self { epoch, target, arcs })
    }

    /// Returns the orbit's epoch.
    pub(super) fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Returns the states of chaser and target `time_s` seconds after the orbit's epoch; at a manoeuvre, the
    /// states just after it.
    pub(super) fn states_at(&self, time_s: f64) -> States {
        let (chaser, target) = self.elements(time_s);
        States { time_s, chaser: chaser.state(), target: target.state() }
    }

    /// Returns the elements of (chaser, target).
    pub(super) fn elements(&self, time_s: f64) -> (Elements, Elements) {
        let begun = self.arcs.partition_point(|arc| arc.start_s <= time_s);
        let arc = &self.arcs[begun.saturating_sub(1)];
        (arc.chaser_at(time_s), self.target.propagate(time_s))
    }
}
