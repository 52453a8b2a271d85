//! Order of the states of the sequential filter and their noise.
//!
//! State: the six relative elements, the rate of aδa, constant rotations of both classes of measurements, and
//! the states of their slow errors (Gauss–Markov, or a damped oscillation of two states).

use std::f64::consts::TAU;

use contract::navigation::NavigationSetup;
use nalgebra::Matrix2xX;

use crate::linearisation::Linearisation;
use crate::parameters::DAY_S;
use crate::sight::{ErrorClass, radians_from_arcsec};

/// Slow error on one axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slow {
    class: ErrorClass,
    axis: usize,
    pub(crate) variance: f64,
    pub(crate) memory_s: f64,
    pub(crate) rate_rad_s: f64,
    /// Index of its state; a periodic error has the next one too.
    pub(crate) state: usize,
    pub(crate) is_periodic: bool,
}

/// Order of the state and its noise, constant over a campaign.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) drag: Option<usize>,
    pub(crate) drag_mean_m_s: f64,
    bias: [[Option<usize>; 3]; 2],
    pub(crate) slow: Vec<Slow>,
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
        let classes = [
            (ErrorClass::WithStars, &setup.errors.with_stars),
            (ErrorClass::WithoutStars, &setup.errors.without_stars),
        ];
        let bias =
            classes.map(|(_, errors)| errors.constant_arcsec.map(|sigma| add(radians_from_arcsec(sigma))));
        let mut slow = Vec::new();
        for (class, errors) in classes {
            for error in &errors.slow {
                for axis in 0..2 {
                    let sigma = radians_from_arcsec(error.sigma_arcsec[axis]);
                    let Some(state) = add(sigma) else { continue };
                    let is_periodic = error.period_s.is_some();
                    if is_periodic {
                        add(sigma);
                    }
                    slow.push(Slow {
                        class,
                        axis,
                        variance: sigma * sigma,
                        memory_s: error.memory_s,
                        rate_rad_s: error.period_s.map_or(0.0, |period| TAU / period),
                        state,
                        is_periodic,
                    });
                }
            }
        }
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
        for slow in self.slow.iter().filter(|slow| slow.class == class) {
            design[(slow.axis, slow.state)] = 1.0;
        }
        design
    }
}
