//! Drawing of the image of one source: its body, moved along its trail, through the point-spread function.

use contract::PixelPoint;
use optics::{self, ImagePoint, Psf, Stamp};
use scene::Source;

/// Maximum number of points of a blurred trail, to limit the run time; longer ones have gaps.
const MAX_POINTS: usize = 1 << 18;

/// Point-spread function with the buffers that sources reuse.
#[derive(Debug)]
pub struct Painter {
    psf: Psf,
    blur: Vec<ImagePoint>,
    /// Points of the body in the middle of the exposure.
    body: Vec<ImagePoint>,
    trail: Vec<ImagePoint>,
    /// Points of the trail, each blurred.
    blurred: Vec<ImagePoint>,
    points: Vec<ImagePoint>,
}

impl Painter {
    /// Creates a painter with a point-spread function.
    pub fn new(psf: Psf) -> Self {
        Self {
            psf,
            blur: Vec::new(),
            body: Vec::new(),
            trail: Vec::new(),
            blurred: Vec::new(),
            points: Vec::new(),
        }
    }

    /// Point-spread function of the painter.
    pub fn psf(&self) -> &Psf {
        &self.psf
    }

    /// Displacements of the blur of the following images, px, with shares adding up to 1; none without a
    /// blur.
    pub fn blur_mut(&mut self) -> &mut Vec<ImagePoint> {
        &mut self.blur
    }

    /// Draws into `stamp` the image of a source that gives `electrons` to a detector of (columns, rows).
    /// `resolve` appends the points of its body about `centre`, with shares adding up to 1; it receives the
    /// number of points of the trail, at each of which the whole body is drawn.
    pub fn paint(
        &mut self,
        source: &Source,
        centre: PixelPoint,
        electrons: f64,
        resolve: impl FnOnce(usize, &mut Vec<ImagePoint>),
        detector: (usize, usize),
        stamp: &mut Stamp,
    ) {
        let Self { psf, blur, body, trail, blurred, points } = self;
        let [begin, end] = source.ends;
        trail.clear();
        optics::trail(begin, source.position, end, trail);
        if !blur.is_empty() {
            thin(trail, MAX_POINTS / blur.len());
            carry_along(blur, PixelPoint::new(0.0, 0.0), trail, blurred);
            std::mem::swap(trail, blurred);
        }
        body.clear();
        resolve(trail.len(), body);
        carry_along(body, centre, trail, points);
        psf.stamp_extended(points, electrons, Psf::FLOOR_E, detector, stamp);
    }
}

/// Joins neighbouring points of a trail until at most `most` are left, each at the middle one of its group.
fn thin(trail: &mut Vec<ImagePoint>, most: usize) {
    let group = trail.len().div_ceil(most.max(1));
    if group <= 1 {
        return;
    }
    let joined = |points: &[ImagePoint]| ImagePoint {
        position: points[points.len() / 2].position,
        share: points.iter().map(|point| point.share).sum(),
    };
    *trail = trail.chunks(group).map(joined).collect();
}

/// Computes the points of an image that moves as a whole: each point of the `body` along the `trail` of
/// `centre`.
fn carry_along(body: &[ImagePoint], centre: PixelPoint, trail: &[ImagePoint], points: &mut Vec<ImagePoint>) {
    points.clear();
    for along in trail {
        points.extend(body.iter().map(|point| {
            // Measured from the trail outwards: a point at the centre is exactly on the trail.
            let (dx, dy) = (point.position.x - centre.x, point.position.y - centre.y);
            let position = PixelPoint::new(along.position.x + dx, along.position.y + dy);
            ImagePoint { position, share: along.share * point.share }
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trail_that_is_thinned_keeps_its_flux_and_its_length() {
        let mut points = Vec::new();
        optics::trail(
            PixelPoint::new(0.0, 0.0),
            PixelPoint::new(50.0, 0.0),
            PixelPoint::new(100.0, 0.0),
            &mut points,
        );
        let whole = points.clone();
        thin(&mut points, whole.len());
        assert_eq!(points, whole);
        thin(&mut points, 25);
        assert!(points.len() <= 25, "{}", points.len());
        let flux: f64 = points.iter().map(|point| point.share).sum();
        let mean: f64 = points.iter().map(|point| point.share * point.position.x).sum();
        assert!((flux - 1.0).abs() < 1e-12 && (mean - 50.0).abs() < 0.5, "{flux} {mean}");
    }
}
