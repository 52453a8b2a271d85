//! The stars that fall on the detector.

use contract::{Angle, CameraFrame, Direction, Icrs, Rotation};

use super::Source;
use crate::catalog::{Catalog, ConeIndex};
use crate::optics::Projection;
use crate::sensor::Photometry;
use crate::truth::ObjectKind;
use crate::truth::apparent::{Observer, StarMotion};

/// How far a star may stand from its catalogued place: proper motion (Barnard's star, 10.4″ a year, over 60
/// years), aberration and parallax together stay below 0.2°.
const CATALOG_MARGIN: Angle = Angle::from_degrees(0.2);

/// The catalogue, ready to be looked at.
#[derive(Debug, Clone)]
pub struct StarField {
    index: ConeIndex,
    stars: Vec<Listed>,
}

/// What drawing needs of a star, computed once.
#[derive(Debug, Clone, Copy)]
struct Listed {
    id: u32,
    motion: StarMotion,
    magnitude: f64,
    electrons_per_s: f64,
}

impl StarField {
    /// Prepares the stars of a catalogue.
    pub fn new(catalog: &Catalog, photometry: &Photometry) -> Self {
        let stars = catalog
            .stars()
            .iter()
            .map(|star| {
                let magnitude = star.v_mag();
                let electrons_per_s = photometry.electrons_per_s(magnitude);
                Listed { id: star.id, motion: StarMotion::new(star), magnitude, electrons_per_s }
            })
            .collect();
        Self { index: ConeIndex::new(catalog.stars()), stars }
    }

    /// Appends the stars whose images are centred on the detector or within `margin_px` of it, by number.
    pub fn look(
        &self,
        observer: &Observer,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        margin_px: f64,
        sources: &mut Vec<Source>,
    ) {
        let boresight = camera_from_icrs.inverse() * Direction::z();
        let margin = Angle::from_radians(margin_px / projection.smallest_scale_px_per_rad());
        let radius = projection.half_diagonal() + margin + CATALOG_MARGIN;
        for index in self.index.within(&boresight, radius) {
            let star = &self.stars[index];
            let astrometric = observer.astrometric(&star.motion);
            let apparent = observer.apparent_of(&astrometric);
            let Some(position) = projection.project(&(camera_from_icrs * apparent)) else {
                continue;
            };
            if !projection.is_within(position, margin_px) {
                continue;
            }
            sources.push(Source {
                kind: ObjectKind::Star,
                id: star.id,
                position,
                astrometric,
                magnitude: star.magnitude,
                electrons_per_s: star.electrons_per_s,
            });
        }
    }
}

