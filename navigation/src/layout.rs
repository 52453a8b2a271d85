//! Order of the states of the sequential filter and their noise.
//!
//! State: the six relative elements, the rate of aδa, constant rotations of both classes of measurements, and
//! the states of their slow errors (Gauss–Markov, or a damped oscillation of two states).

use contract::navigation::NavigationSetup;
use nalgebra::Matrix2xX;

use crate::linearisation::Linearisation;
use crate::parameters::DAY_S;
use crate::sight::{ErrorClass, radians_from_arcsec};
use crate::slow_errors::{SlowProcess, slow_processes};

/// Order of the state and its noise, constant over a campaign.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) drag: Option<usize>,
    pub(crate) drag_mean_m_s: f64,
    bias: [[Option<usize>; 3]; 2],
    pub(crate) slow: Vec<SlowProcess>,
    /// Prior variances of the states after the elements.
    pub(crate) variances: Vec<f64>,
    /// Spectral density of the relative acceleration along R, T, N, m²/s³.
    pub(crate) acceleration: [f64; 3],
}

impl Layout {
    /// Orders the states of a setup.
    pub(crate) fn new(setup: &NavigationSetup, velocity_noise_m_s_per_hour: [f64; 3]) -> Self {
        let mut variances = Vec::new();
        let mut add = |sigma: f64| {
            (sigma > 0.0).then(|| {
                variances.push(sigma * sigma);
                5 + variances.len()
            })
        };
        let drag = add(setup.drag.sigma_m_per_day / DAY_S);
        let bias = ErrorClass::ALL.map(|class| {
            class.errors(&setup.errors).constant_arcsec.map(|sigma| add(radians_from_arcsec(sigma)))
        });
        let slow = slow_processes(&setup.errors, &ErrorClass::ALL, 6 + variances.len());
        variances.extend(slow.iter().flat_map(|process| process.states().map(|_| process.variance)));
        let drag_mean_m_s = setup.drag.a_da_rate_m_per_day / DAY_S;
        let acceleration = velocity_noise_m_s_per_hour.map(|sigma| sigma * sigma / 3600.0);
        Self { drag, drag_mean_m_s, bias, slow, variances, acceleration }
    }

    /// Number of states.
    pub(crate) fn count(&self) -> usize {
        6 + self.variances.len()
    }

    /// Returns the derivatives of the predicted angles with respect to the state, 2 × states.
    pub(crate) fn design(&self, linearisation: &Linearisation, class: ErrorClass) -> Matrix2xX<f64> {
        let mut design = Matrix2xX::zeros(self.count());
        design.columns_mut(0, 6).copy_from(&linearisation.by_elements);
        for (k, column) in self.bias[usize::from(class == ErrorClass::WithoutStars)].iter().enumerate() {
            if let Some(column) = column {
                design.set_column(*column, &linearisation.by_rotation.column(k));
            }
        }
        for slow in &self.slow {
            let slopes = slow.slopes(class, linearisation.by_displacement);
            design.set_column(slow.state, &slopes.into());
        }
        design
    }
}
