//! The stars that fall on the detector.

use contract::{Angle, CameraFrame, Direction, Icrs, PixelPoint, Rotation};

use super::Source;
use crate::catalog::{Catalog, ConeIndex};
use crate::optics::{Projection, RadiometryConfig};
use crate::truth::{ObjectKind, Observer, StarMotion};

/// How far a star may stand from its catalogued place: proper motion (Barnard's star, 10.4″ a year, over 60
/// years), aberration and parallax together stay below 0.2°.
const CATALOG_MARGIN: Angle = Angle::from_degrees(0.2);

/// The catalogue, ready to be looked at.
#[derive(Debug, Clone)]
pub struct StarField {
    index: ConeIndex,
    stars: Vec<PreparedStar>,
}

/// What drawing needs of a star, computed once.
#[derive(Debug, Clone, Copy)]
struct PreparedStar {
    id: u32,
    motion: StarMotion,
    magnitude: f64,
    electrons_per_s: f64,
}

impl StarField {
    /// Prepares the stars of a catalogue.
    pub fn new(catalog: &Catalog, radiometry: &RadiometryConfig) -> Self {
        let stars = catalog
            .stars()
            .iter()
            .map(|star| {
                let magnitude = star.v_mag();
                let electrons_per_s = radiometry.electrons_per_s(magnitude);
                PreparedStar { id: star.id, motion: StarMotion::new(star), magnitude, electrons_per_s }
            })
            .collect();
        Self { index: ConeIndex::new(catalog.stars()), stars }
    }

    /// Appends the stars whose images are centred on the detector or within `margin_px` of its border, by number.
    pub fn look(
        &self,
        observer: &Observer,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        margin_px: f64,
        sources: &mut Vec<Source>,
    ) {
        for star in self.around(camera_from_icrs, projection, margin_px) {
            let apparent = camera_from_icrs * observer.apparent(&star.motion);
            if let Some(position) = projection.project(&apparent)
                && is_within(position, projection, margin_px)
            {
                sources.push(Source {
                    kind: ObjectKind::Star,
                    id: star.id,
                    position,
                    astrometric: Some(observer.astrometric(&star.motion)),
                    magnitude: Some(star.magnitude),
                    electrons_per_s: star.electrons_per_s,
                });
            }
        }
    }

    /// Electrons per second of the brightest star on the detector, or `at_least` when that is more.
    pub fn brightest(
        &self,
        observer: &Observer,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        at_least: f64,
    ) -> f64 {
        let mut brightest = at_least;
        for star in self.around(camera_from_icrs, projection, 0.0) {
            // Most stars are fainter than the best so far and need no place.
            if star.electrons_per_s > brightest
                && let Some(position) =
                    projection.project(&(camera_from_icrs * observer.apparent(&star.motion)))
                && is_within(position, projection, 0.0)
            {
                brightest = star.electrons_per_s;
            }
        }
        brightest
    }

    /// The stars that can be within `margin_px` of the detector, and some more, by number.
    fn around(
        &self,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        margin_px: f64,
    ) -> impl Iterator<Item = &PreparedStar> {
        let boresight = camera_from_icrs.inverse() * Direction::z();
        let (x_px_per_rad, y_px_per_rad) = projection.plate_scale_px_per_rad();
        let margin = Angle::from_radians(margin_px / x_px_per_rad.min(y_px_per_rad));
        let radius = projection.half_diagonal() + margin + CATALOG_MARGIN;
        self.index.within(&boresight, radius).into_iter().map(|index| &self.stars[index])
    }
}

fn is_within(position: PixelPoint, projection: &Projection, margin_px: f64) -> bool {
    let (columns, rows) = projection.detector();
    let inside = |v: f64, n: usize| v >= -0.5 - margin_px && v <= n as f64 - 0.5 + margin_px;
    inside(position.x, columns) && inside(position.y, rows)
}
