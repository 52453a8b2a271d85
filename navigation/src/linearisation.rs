//! Statistical linear regression of a line of sight on the relative elements.
//!
//! Lines of sight are nonlinear in the range. Over a normal distribution of the elements, the angles are
//! replaced by the linear function with the smallest mean square error, computed by the unscented
//! transformation, and the variance of the remainder (Lefebvre, Bruyninckx, De Schutter 2002, IEEE Trans. AC
//! 47, 1406; Julier and Uhlmann 2004, Proc. IEEE 92, 401).

use contract::navigation::RelativeElements;
use nalgebra::{Matrix2, Matrix2x3, Matrix2x6, Matrix6, Vector2, Vector6};

use crate::short_period::Osculation;
use crate::sight::Sight;

/// Weight of the central sigma point times seven: λ = 1 of the unscented transformation in six dimensions,
/// whose points are at √7 σ.
const LAMBDA: f64 = 1.0;

/// Linear function of the elements that replaces two angles.
#[derive(Debug, Clone)]
pub(crate) struct Linearisation {
    /// Mean of the elements.
    centre: Vector6<f64>,
    /// Measured minus predicted angles at the centre, rad.
    pub(crate) residual: Vector2<f64>,
    /// Mean of the angles minus angles at the centre, rad.
    shift: Vector2<f64>,
    /// Slopes, rad/m.
    pub(crate) by_elements: Matrix2x6<f64>,
    /// Derivatives of the angles with respect to a rotation of the camera.
    pub(crate) by_rotation: Matrix2x3<f64>,
    /// Derivatives of the angles with respect to a displacement of the target along columns and rows, rad/m.
    pub(crate) by_displacement: [f64; 2],
    /// Variance of the remainder, rad².
    pub(crate) scatter: Matrix2<f64>,
}

impl Linearisation {
    /// Replaces the angles over a normal distribution of the elements. `None` if its covariance is not
    /// positive definite.
    pub(crate) fn new(
        sight: &Sight,
        centre: &Vector6<f64>,
        covariance: &Matrix6<f64>,
        osculation: Osculation,
    ) -> Option<Self> {
        let factor = covariance.cholesky()?.l();
        let prediction = sight.predict(&RelativeElements::from_vector(centre), osculation);
        let residual = Vector2::from(sight.residual(&prediction));
        let scale = (6.0 + LAMBDA).sqrt();
        let weight = 0.5 / (6.0 + LAMBDA);
        let angle = |offset: &Vector6<f64>| {
            let elements = RelativeElements::from_vector(&(centre + offset));
            residual - Vector2::from(sight.residual(&sight.predict(&elements, osculation)))
        };
        let mut shift = Vector2::zeros();
        let mut squares = Matrix2::zeros();
        let mut slopes = Matrix2x6::zeros();
        for k in 0..6 {
            let offset = factor.column(k) * scale;
            let (plus, minus) = (angle(&offset), angle(&-offset));
            shift += (plus + minus) * weight;
            squares += (plus * plus.transpose() + minus * minus.transpose()) * weight;
            // E[h xᵀ] P⁻¹ with x = L e: a column of H L.
            slopes.set_column(k, &((plus - minus) * (weight * scale)));
        }
        let scatter = squares - shift * shift.transpose() - slopes * slopes.transpose();
        let inverse = factor.solve_lower_triangular(&Matrix6::identity())?;
        Some(Self {
            centre: *centre,
            residual,
            shift,
            by_elements: slopes * inverse,
            by_rotation: prediction.by_rotation(),
            by_displacement: prediction.by_displacement(),
            // Positive but for rounding.
            scatter: scatter.map_with_location(|i, j, x| if i == j { x.max(0.0) } else { x }),
        })
    }

    /// Returns measured angles minus those of the linear function at the elements, rad.
    pub(crate) fn residual_at(&self, elements: &Vector6<f64>) -> Vector2<f64> {
        self.residual - self.shift - self.by_elements * (elements - self.centre)
    }

    /// Returns the change of the angles at the elements by a linearisation there, relative to the white
    /// errors, squared.
    pub(crate) fn departure(&self, sight: &Sight, elements: &Vector6<f64>, osculation: Osculation) -> f64 {
        let prediction = sight.predict(&RelativeElements::from_vector(elements), osculation);
        let bend = self.residual_at(elements) + self.shift - Vector2::from(sight.residual(&prediction));
        let [xx, xy, yy] = sight.noise;
        let inverse = Matrix2::new(xx, xy, xy, yy).try_inverse();
        inverse.map_or(0.0, |inverse| bend.dot(&(inverse * bend)))
    }
}
