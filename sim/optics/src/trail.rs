//! Geometric images: points of light, and the trail of a moving point.

use contract::PixelPoint;

/// Point of the geometric image of an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImagePoint {
    /// Pixel position of the point.
    pub position: PixelPoint,
    /// Fraction of the object's flux, in [0, 1]; the shares of all points add up to 1.
    pub share: f64,
}

/// Longest piece of a trail that is represented by two points, px. With the two-point rule of Gauss the error
/// of a pixel of a Gaussian image of 0.5 px or wider is below 1e-3 of its peak, at 0.8 px below 2e-4.
const PIECE_PX: f64 = 0.5;
/// Length below which a trail is drawn as a point, px: it would widen the image by 1e-5 px² in variance.
const POINT_PX: f64 = 0.01;
/// Maximum number of pieces, to limit the run time of a scenario with fast rotation; longer trails have gaps.
const PIECES: f64 = 4096.0;

/// Appends the trail of a point with positions `begin`, `middle` and `end` at the start, middle and end of
/// the exposure. It follows the parabola through them by Gauss's two-point rule on equal pieces of time. The
/// shares of the points added to `points` sum to 1.
pub fn trail(begin: PixelPoint, middle: PixelPoint, end: PixelPoint, points: &mut Vec<ImagePoint>) {
    let length_px = begin.distance(middle) + middle.distance(end);
    if length_px.is_nan() || length_px < POINT_PX {
        points.push(ImagePoint { position: middle, share: 1.0 });
        return;
    }
    let pieces = (length_px / PIECE_PX).ceil().min(PIECES);
    let offset = 0.5 / 3.0_f64.sqrt();
    for piece in 0..pieces as usize {
        for side in [-offset, offset] {
            // From −1 at the start to 1 at the end.
            let t = 2.0 * (piece as f64 + 0.5 + side) / pieces - 1.0;
            let along = |from: f64, mid: f64, to: f64| {
                mid + t * 0.5 * (to - from) + t * t * (0.5 * (from + to) - mid)
            };
            let position = PixelPoint::new(along(begin.x, middle.x, end.x), along(begin.y, middle.y, end.y));
            points.push(ImagePoint { position, share: 0.5 / pieces });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Psf, PsfConfig, Stamp};

    fn image(points: &[ImagePoint]) -> Vec<f64> {
        let mut stamp = Stamp::new();
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 0.8 }).unwrap();
        psf.stamp_extended(points, 1.0, 1e-9, (60, 60), &mut stamp);
        let mut pixels = vec![0.0; 3600];
        for (x, y, row) in stamp.rows() {
            pixels[y * 60 + x..][..row.len()].copy_from_slice(row);
        }
        pixels
    }

    #[test]
    fn a_trail_is_the_mean_of_the_images_along_it() {
        for (dx, dy) in [(0.3, 0.0), (0.6, 0.2), (7.3, -3.1), (20.0, 11.0)] {
            let at = |t: f64| PixelPoint::new(30.2 + dx * (t - 0.5), 29.7 + dy * (t - 0.5));
            let mut points = Vec::new();
            trail(at(0.0), at(0.5), at(1.0), &mut points);
            assert!((points.iter().map(|point| point.share).sum::<f64>() - 1.0).abs() < 1e-12);
            let n = 4000;
            let dense: Vec<ImagePoint> = (0..n)
                .map(|i| ImagePoint {
                    position: at((f64::from(i) + 0.5) / f64::from(n)),
                    share: 1.0 / f64::from(n),
                })
                .collect();
            let (ours, truth) = (image(&points), image(&dense));
            let peak = truth.iter().copied().fold(0.0, f64::max);
            for (a, b) in ours.iter().zip(&truth) {
                // The floor of the stamps, 1e-9, affects each of them.
                assert!((a - b).abs() < 2e-4 * peak + 2e-9, "{a} {b} of {peak} for ({dx}, {dy})");
            }
        }
    }

    #[test]
    fn a_bent_trail_has_its_mean_where_the_parabola_has_it() {
        let mut points = Vec::new();
        let (begin, end) = (PixelPoint::new(10.0, 10.0), PixelPoint::new(14.0, 10.0));
        trail(begin, PixelPoint::new(12.0, 13.0), end, &mut points);
        let mean = points.iter().fold(0.0, |sum, point| sum + point.share * point.position.y);
        // ∫ 13 − 3t² over [−1, 1] / 2 = 12.
        assert!((mean - 12.0).abs() < 1e-12);
    }

    #[test]
    fn an_image_without_motion_is_a_point() {
        let at = PixelPoint::new(3.0, 4.0);
        for end in [at, PixelPoint::new(3.001, 4.0), PixelPoint::new(f64::NAN, 4.0)] {
            let mut points = Vec::new();
            trail(at, at, end, &mut points);
            assert_eq!(points, [ImagePoint { position: at, share: 1.0 }]);
        }
    }
}
