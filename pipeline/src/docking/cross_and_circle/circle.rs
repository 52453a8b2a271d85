//! Fit of a circle to points by geometric least squares (docking paper, section 3).

use nalgebra::{Matrix3, Vector2, Vector3};

/// Fitted circle, in the unit of its points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CircleFit {
    /// Centre (Xo, Yo).
    pub(crate) centre: Vector2<f64>,
    /// Radius R.
    pub(crate) radius: f64,
    /// Root mean square of the points' distances from the circle.
    pub(crate) rms: f64,
}

impl CircleFit {
    /// Returns the distance of a point from the circle; negative inside.
    pub(crate) fn residual(&self, point: &Vector2<f64>) -> f64 {
        (point - self.centre).norm() - self.radius
    }
}

/// Computes the first guess: the circle of the smallest algebraic distance, linear in (2 Xo, 2 Yo, R² − Xo² −
/// Yo²) (Kåsa 1976); `None` for fewer than three points and for points on a line.
pub(crate) fn first_guess(points: &[Vector2<f64>]) -> Option<CircleFit> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mean = points.iter().sum::<Vector2<f64>>() / n;
    let spread = points.iter().map(|p| (p - mean).norm_squared()).sum::<f64>() / n;
    if !(spread > 0.0 && spread.is_finite()) {
        return None;
    }
    // Coordinates relative to the mean and scaled by the spread give the best-conditioned normal matrix for
    // these points.
    let size = spread.sqrt();
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for point in points {
        let p = (point - mean) / size;
        let row = Vector3::new(p.x, p.y, 1.0);
        normal += row * row.transpose();
        right += row * p.norm_squared();
    }
    // Points on a line: the smaller moment is negligible compared with the larger one.
    let determinant = normal[(0, 0)] * normal[(1, 1)] - normal[(0, 1)] * normal[(1, 0)];
    if determinant < 1e-9 * n * n {
        return None;
    }
    let solution = normal.lu().solve(&right)?;
    let centre = Vector2::new(solution.x, solution.y) / 2.0;
    let radius2 = solution.z + centre.norm_squared();
    if !(radius2 > 0.0 && radius2.is_finite()) {
        return None;
    }
    Some(with_rms(mean + centre * size, radius2.sqrt() * size, points))
}

/// Minimises Σ (sqrt((A − Xo)² + (B − Yo)²) − R)² by Gauss–Newton from a first guess; `None` when it does not
/// converge.
pub(crate) fn refine(points: &[Vector2<f64>], guess: &CircleFit) -> Option<CircleFit> {
    const STEPS: usize = 30;
    let (mut centre, mut radius) = (guess.centre, guess.radius);
    for _ in 0..STEPS {
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for point in points {
            let away = point - centre;
            let distance = away.norm();
            // A point at the centre has no direction and contributes nothing to the step of the centre.
            let unit = if distance > 0.0 { away / distance } else { Vector2::zeros() };
            let row = Vector3::new(-unit.x, -unit.y, -1.0);
            normal += row * row.transpose();
            right -= row * (distance - radius);
        }
        let step = normal.lu().solve(&right)?;
        centre += Vector2::new(step.x, step.y);
        radius += step.z;
        if !(radius > 0.0 && radius.is_finite() && centre.x.is_finite() && centre.y.is_finite()) {
            return None;
        }
        if step.norm() <= 1e-10 * (1.0 + radius) {
            return Some(with_rms(centre, radius, points));
        }
    }
    None
}

/// Fits a circle: first guess and Gauss–Newton.
pub(crate) fn fit(points: &[Vector2<f64>]) -> Option<CircleFit> {
    refine(points, &first_guess(points)?)
}

/// Fits a circle as [`fit`] does, but to points of which some may be outliers: points farther away than three
/// times the robust standard deviation, and than `tolerance`, are left out, until the set no longer changes.
/// Returns the circle and true for each point that was kept; `None` when fewer than half are kept.
pub(crate) fn fit_robustly(points: &[Vector2<f64>], tolerance: f64) -> Option<(CircleFit, Vec<bool>)> {
    let mut kept = vec![true; points.len()];
    let mut circle = fit(points)?;
    for _ in 0..12 {
        let mut distances: Vec<f64> = points.iter().map(|p| circle.residual(p).abs()).collect();
        let all = distances.clone();
        distances.sort_by(f64::total_cmp);
        // 1.4826 median |x| is the standard deviation of a normal distribution.
        let limit = (3.0 * 1.4826 * distances[distances.len() / 2]).max(tolerance);
        let now: Vec<bool> = all.iter().map(|d| *d <= limit).collect();
        let chosen: Vec<Vector2<f64>> =
            points.iter().zip(&now).filter(|(_, keep)| **keep).map(|(p, _)| *p).collect();
        circle = fit(&chosen)?;
        if now == kept {
            break;
        }
        kept = now;
    }
    (2 * kept.iter().filter(|keep| **keep).count() >= points.len()).then_some((circle, kept))
}

fn with_rms(centre: Vector2<f64>, radius: f64, points: &[Vector2<f64>]) -> CircleFit {
    let mut circle = CircleFit { centre, radius, rms: 0.0 };
    let sum: f64 = points.iter().map(|p| circle.residual(p) * circle.residual(p)).sum();
    circle.rms = (sum / points.len() as f64).sqrt();
    circle
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn arc(centre: (f64, f64), radius: f64, from: f64, to: f64, n: usize) -> Vec<Vector2<f64>> {
        (0..n)
            .map(|i| {
                let (sin, cos) = libm::sincos(from + (to - from) * i as f64 / (n - 1) as f64);
                Vector2::new(centre.0 + radius * cos, centre.1 + radius * sin)
            })
            .collect()
    }

    proptest! {
        #[test]
        fn exact_points_give_their_circle(
            x in -500.0..500.0f64, y in -500.0..500.0f64, r in 1.0..400.0f64, turn in 0.5..6.2f64,
        ) {
            let circle = fit(&arc((x, y), r, 0.1, 0.1 + turn, 9)).unwrap();
            // A short arc amplifies the rounding of the coordinates by (2π/turn)⁴.
            prop_assert!((circle.centre - Vector2::new(x, y)).norm() < 1e-6 && (circle.radius - r).abs() < 1e-6);
        }
    }

    #[test]
    fn the_residuals_are_orthogonal_to_their_derivatives() {
        // Conditions for a minimum of the geometric distance: Σ e = 0 and Σ e (direction) = 0.
        let mut points = arc((10.0, 20.0), 50.0, 0.0, 4.0, 11);
        for (i, point) in points.iter_mut().enumerate() {
            *point += Vector2::new(((i * 7) % 5) as f64 - 2.0, ((i * 3) % 7) as f64 - 3.0) * 0.4;
        }
        let circle = fit(&points).unwrap();
        let mut gradient = Vector3::zeros();
        for point in &points {
            let unit = (point - circle.centre).normalize();
            gradient += Vector3::new(unit.x, unit.y, 1.0) * circle.residual(point);
        }
        assert!(gradient.norm() < 1e-8, "{gradient:?}");
        // Four points at the corners of a rectangle lie on the circle about its centre.
        let corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 8.0), (0.0, 8.0)].map(|(x, y)| Vector2::new(x, y));
        let circle = fit(&corners).unwrap();
        assert!((circle.centre - Vector2::new(3.0, 4.0)).norm() < 1e-12);
        assert!((circle.radius - 5.0).abs() < 1e-12 && circle.rms < 1e-12);
    }

    #[test]
    fn degenerate_points_have_no_circle() {
        let line: Vec<_> = (0..8).map(|i| Vector2::new(f64::from(i), 2.0 * f64::from(i))).collect();
        assert_eq!(fit(&line), None);
        assert_eq!(fit(&[]), None);
        assert_eq!(fit(&[Vector2::new(1.0, 1.0); 5]), None);
        assert_eq!(fit(&arc((0.0, 0.0), 1.0, 0.0, 1.0, 2)), None);
        assert_eq!(fit(&[Vector2::new(f64::NAN, 0.0), Vector2::zeros(), Vector2::new(1.0, 0.0)]), None);
    }

    #[test]
    fn points_off_the_circle_are_omitted() {
        let mut points = arc((100.0, 100.0), 40.0, 0.0, 6.0, 30);
        for i in [3, 4, 17, 25] {
            points[i] += Vector2::new(9.0, -6.0);
        }
        let (circle, kept) = fit_robustly(&points, 0.5).unwrap();
        assert!((circle.radius - 40.0).abs() < 1e-9);
        assert_eq!(kept.iter().filter(|k| !**k).count(), 4);
    }
}
