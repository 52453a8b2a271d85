//! Mean elements of chaser and target with secular drift.
//!
//! Between manoeuvres each orbit drifts at its own secular rates. The chaser's orbit is stored as one arc
//! from each manoeuvre to the next; any instant can therefore be computed independently.

use contract::OutOfRange;
use hifitime::Epoch;

use super::manoeuvre::ManoeuvreConfig;
use super::orbit::Elements;
use super::states::{OrbitConfig, States, burns};

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
    /// Computes the arcs for the orbits of `config` and its manoeuvres as `executed`.
    ///
    /// # Errors
    /// [`OutOfRange`] for an invalid epoch, or an orbit outside the supported range; [`OutOfRange`] for a
    /// manoeuvre that is out of order, not after the epoch, or results in an unsupported orbit.
    pub(super) fn new(config: &OrbitConfig, executed: &[ManoeuvreConfig]) -> Result<Self, OutOfRange> {
        let (epoch, chaser, target) = config.initial_elements()?;
        let mut last = Arc { start_s: 0.0, chaser };
        let mut arcs = vec![last];
        for (index, (manoeuvre, burn)) in executed.iter().zip(burns(config, executed, epoch)?).enumerate() {
            if burn.duration_s > 0.0 {
                return Err(OutOfRange::new(
                    format!("orbit.manoeuvres[{index}].duration_s"),
                    burn.duration_s,
                    "0, an impulse, with mean elements (a numerical trajectory permits a duration)",
                ));
            }
            let start_s = burn.start_s;
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
