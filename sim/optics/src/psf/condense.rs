//! Replacement of many points that lie close together by few points.

use contract::PixelPoint;

use crate::ImagePoint;

/// Maximum extent of the points along an axis, in units of the σ of the Gaussian that each point spreads
/// into. The images of the points and of their replacements then differ from the third moments on: by less
/// than 2e-5 of the peak.
const CLOSE_SIGMAS: f64 = 0.25;
/// Transverse extent, as a fraction of σ, below which it is neglected: it would widen the image by 1e-6 of
/// its variance.
const NARROW_SIGMAS: f64 = 1e-3;

/// Returns two points, or four if the points do not lie on a line, with the flux of `points`, their mean and
/// their covariance; `None` if nothing would be saved, or if the points are too far apart for a Gaussian of
/// `sigma_px`.
pub(super) fn condensed(points: &[ImagePoint], sigma_px: f64) -> Option<([ImagePoint; 4], usize)> {
    if points.len() <= 2 {
        return None;
    }
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (mut shares, mut sums) = (0.0, [0.0; 2]);
    for ImagePoint { position, share } in points {
        shares += share;
        for (axis, at) in [position.x, position.y].into_iter().enumerate() {
            (low[axis], high[axis]) = (low[axis].min(at), high[axis].max(at));
            sums[axis] += share * at;
        }
    }
    let reach = CLOSE_SIGMAS * sigma_px;
    // The condition is written so that NaN counts as far apart.
    let is_finite = (sums[0] + sums[1]).is_finite();
    if !(is_finite && shares > 0.0 && high[0] - low[0] <= reach && high[1] - low[1] <= reach) {
        return None;
    }
    let mean = [sums[0] / shares, sums[1] / shares];
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for ImagePoint { position, share } in points {
        let (dx, dy) = (position.x - mean[0], position.y - mean[1]);
        (xx, xy, yy) = (xx + share * dx * dx, xy + share * dx * dy, yy + share * dy * dy);
    }
    let (xx, xy, yy) = (xx / shares, xy / shares, yy / shares);
    // Covariance as a aᵀ + b bᵀ: a is a column of its square root (Cholesky) along the wider axis, and b the
    // remainder across it.
    let across = |wide: f64, narrow: f64| (narrow - xy * xy / wide).max(0.0).sqrt();
    let (a, b) = match (xx >= yy, xx.max(yy) > 0.0) {
        (_, false) => ([0.0; 2], [0.0; 2]),
        (true, _) => ([xx.sqrt(), xy / xx.sqrt()], [0.0, across(xx, yy)]),
        (false, _) => ([xy / yy.sqrt(), yy.sqrt()], [across(yy, xx), 0.0]),
    };
    let on_a_line = b[0].max(b[1]) <= NARROW_SIGMAS * sigma_px;
    // Four points divide the flux that otherwise two points have, so they stand farther out by the square
    // root of this factor.
    let (count, stretch) = if on_a_line { (2, 1.0) } else { (4, std::f64::consts::SQRT_2) };
    let point = |offset: [f64; 2], side: f64| ImagePoint {
        position: PixelPoint::new(mean[0] + side * stretch * offset[0], mean[1] + side * stretch * offset[1]),
        share: shares / count as f64,
    };
    Some(([point(a, -1.0), point(a, 1.0), point(b, -1.0), point(b, 1.0)], count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Psf, PsfConfig, Stamp, trail};

    /// Flux, mean and covariance.
    fn moments(points: &[ImagePoint]) -> [f64; 6] {
        let mut moments = [0.0; 6];
        for ImagePoint { position: PixelPoint { x, y }, share } in points {
            for (sum, term) in moments.iter_mut().zip([1.0, *x, *y, x * x, x * y, y * y]) {
                *sum += share * term;
            }
        }
        moments
    }

    fn assert_alike(a: &[ImagePoint], b: &[ImagePoint]) {
        for (a, b) in moments(a).into_iter().zip(moments(b)) {
            assert!((a - b).abs() < 1e-12, "{a} for {b}");
        }
    }

    fn image_point(x: f64, y: f64, share: f64) -> ImagePoint {
        ImagePoint { position: PixelPoint::new(x, y), share }
    }

    #[test]
    fn few_points_have_the_moments_of_many() {
        let triangle = [image_point(0.1, 0.2, 0.5), image_point(0.3, -0.1, 0.3), image_point(-0.2, 0.4, 0.2)];
        let (four, count) = condensed(&triangle, 4.0).unwrap();
        assert_eq!(count, 4);
        assert_alike(&four[..count], &triangle);
        for (dx, dy) in [(0.3, 0.1), (0.0, 0.2), (-0.1, 0.3), (0.0, 0.0)] {
            let line: Vec<ImagePoint> =
                (0..5).map(|i| image_point(f64::from(i) * dx * 0.5, f64::from(i) * dy * 0.5, 0.2)).collect();
            let (two, count) = condensed(&line, 4.0).unwrap();
            assert_eq!(count, 2);
            assert_alike(&two[..count], &line);
        }
    }

    #[test]
    fn points_far_apart_and_few_points_are_left_as_they_are() {
        let line = [image_point(0.0, 0.0, 0.4), image_point(0.5, 0.0, 0.4), image_point(1.1, 0.0, 0.2)];
        assert!(condensed(&line, 4.0).is_none());
        assert!(condensed(&line[..2], 40.0).is_none());
        assert!(condensed(&[image_point(f64::NAN, 0.0, 0.5); 3], 4.0).is_none());
    }

    /// Compares a trail through a wide Gaussian with the same trail drawn point by point.
    #[test]
    fn the_image_stays_the_same() {
        let mut points = Vec::new();
        let (begin, end) = (PixelPoint::new(29.6, 30.0), PixelPoint::new(30.5, 30.4));
        trail(begin, PixelPoint::new(30.1, 30.25), end, &mut points);
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 4.0 }).unwrap();
        let (mut stamp, mut one) = (Stamp::new(), Stamp::new());
        psf.stamp_extended(&points, 1.0, 1e-9, (60, 60), &mut stamp);
        let mut sum = vec![0.0; 3600];
        for ImagePoint { position, share } in &points {
            psf.stamp(*position, *share, 1e-9, (60, 60), &mut one);
            for (x, y, row) in one.rows() {
                row.iter().enumerate().for_each(|(i, e)| sum[y * 60 + x + i] += e);
            }
        }
        let peak = stamp.truth(0.0, 0.0, f64::INFINITY).peak_electrons;
        for (x, y, row) in stamp.rows() {
            for (i, e) in row.iter().enumerate() {
                let error = e - sum[y * 60 + x + i];
                assert!(error.abs() < 2e-5 * peak + 5e-9, "({}, {y}): {error}", x + i);
            }
        }
    }
}
