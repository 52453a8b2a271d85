//! Slow errors of the lines of sight as independent processes of one axis each.
//!
//! A process is Gauss–Markov: of first order (Gelb, *Applied Optimal Estimation*, 1974, section 3.6) or, for
//! a periodic error, damped rotation in two dimensions with autocovariance σ² exp(−|Δt|/τ) cos(2π Δt/P). Its
//! first state is an angle, or a displacement of the target that the distance turns into an angle.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use contract::navigation::{AngleErrors, LineOfSightErrors};

use crate::sight::{ErrorClass, radians_from_arcsec};

/// Quantity of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    /// Angle of the measurements of a class, rad.
    Angle(ErrorClass),
    /// Displacement of the target in all measurements, m.
    Displacement,
}

/// Slow error on one axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlowProcess {
    quantity: Quantity,
    axis: usize,
    /// Variance, rad² or m².
    pub(crate) variance: f64,
    memory_s: f64,
    rate_rad_s: f64,
    /// Index of its first state, the error; a periodic process has a second one.
    pub(crate) state: usize,
    pub(crate) is_periodic: bool,
}

/// Transition of a process over a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlowTransition {
    pub(crate) state: usize,
    pub(crate) is_periodic: bool,
    /// Decay times cosine and sine of the phase.
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    /// Variance of the noise of each state.
    pub(crate) noise: f64,
}

impl SlowProcess {
    /// Indices of its states.
    pub(crate) fn states(&self) -> RangeInclusive<usize> {
        self.state..=self.state + usize::from(self.is_periodic)
    }

    /// Computes the transition over `dt` seconds.
    pub(crate) fn transition(&self, dt: f64) -> SlowTransition {
        let decay = libm::exp(-dt.abs() / self.memory_s);
        let (sin, cos) = libm::sincos(self.rate_rad_s * dt);
        SlowTransition {
            state: self.state,
            is_periodic: self.is_periodic,
            cos: decay * cos,
            sin: decay * sin,
            noise: self.variance * (1.0 - decay * decay),
        }
    }

    /// Returns the derivatives of the two angles of a measurement with respect to the first state.
    /// `by_displacement` are those with respect to a displacement of the target across columns and rows,
    /// rad/m.
    pub(crate) fn slopes(&self, class: ErrorClass, by_displacement: [f64; 2]) -> [f64; 2] {
        let slope = match self.quantity {
            Quantity::Angle(own) => f64::from(u8::from(own == class)),
            Quantity::Displacement => by_displacement[self.axis],
        };
        let mut slopes = [0.0; 2];
        slopes[self.axis] = slope;
        slopes
    }
}

/// Orders the processes of the errors of some classes of measurements; their states are numbered from
/// `first`.
pub(crate) fn slow_processes(
    errors: &LineOfSightErrors,
    classes: &[ErrorClass],
    first: usize,
) -> Vec<SlowProcess> {
    let mut processes: Vec<SlowProcess> = Vec::new();
    let mut add = |quantity: Quantity, sigmas: [f64; 2], memory_s: f64, period_s: Option<f64>| {
        for (axis, sigma) in sigmas.into_iter().enumerate().filter(|(_, sigma)| *sigma > 0.0) {
            processes.push(SlowProcess {
                quantity,
                axis,
                variance: sigma * sigma,
                memory_s,
                rate_rad_s: period_s.map_or(0.0, |period| TAU / period),
                state: processes.last().map_or(first, |last| last.states().end() + 1),
                is_periodic: period_s.is_some(),
            });
        }
    };
    for class in classes {
        let AngleErrors { slow, .. } = class.errors(errors);
        for error in slow {
            let sigmas = error.sigma_arcsec.map(radians_from_arcsec);
            add(Quantity::Angle(*class), sigmas, error.memory_s, error.period_s);
        }
    }
    for error in &errors.displacements {
        add(Quantity::Displacement, error.sigma_m, error.memory_s, error.period_s);
    }
    processes
}
