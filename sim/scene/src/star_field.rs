//! Stars on the detector.

use contract::{Angle, CameraFrame, Direction, Icrs, PixelPoint, Rotation};
use optics::{Projection, Radiometry};
use truth::catalog::Catalog;
use truth::{ObjectKind, Observer, StarMotion};

use super::{CameraMotion, Source};

/// Maximum angle between a star and its catalogued direction: proper motion (Barnard's star, 10.4″ per year,
/// over 60 years), aberration and parallax together stay below 0.2°. A star of a user's catalogue that moves
/// faster than 11″ per year is lost if its catalogued direction is farther than this from the cone around the
/// field of view.
const CATALOG_MARGIN: Angle = Angle::from_degrees(0.2);

/// Catalogue prepared for searches by direction.
#[derive(Debug, Clone)]
pub struct StarField {
    catalog: Catalog,
    stars: Vec<PreparedStar>,
    /// Electrons per second of the brightest star.
    brightest_e_per_s: f64,
}

/// Precomputed data of a star for drawing.
#[derive(Debug, Clone, Copy)]
struct PreparedStar {
    id: u32,
    motion: StarMotion,
    magnitude: f64,
    electrons_per_s: f64,
}

impl StarField {
    /// Prepares the stars of a catalogue.
    pub fn new(catalog: &Catalog, radiometry: &Radiometry) -> Self {
        let stars: Vec<PreparedStar> = catalog
            .stars()
            .iter()
            .map(|star| {
                let magnitude = star.v_mag();
                let electrons_per_s = radiometry.star(magnitude, star.b_v, star.v_i);
                PreparedStar { id: star.id, motion: StarMotion::new(star), magnitude, electrons_per_s }
            })
            .collect();
        let brightest_e_per_s = stars.iter().map(|star| star.electrons_per_s).fold(0.0, f64::max);
        Self { catalog: catalog.clone(), stars, brightest_e_per_s }
    }

    /// Appends the stars whose image falls on the detector during the exposure, sorted by number. `reach_px`
    /// returns the extent of an image, px, for a flux in photoelectrons per second.
    pub fn add_visible(
        &self,
        observer: &Observer,
        camera: &CameraMotion,
        projection: &Projection,
        reach_px: impl Fn(f64) -> f64,
        sources: &mut Vec<Source>,
    ) {
        let motion_px = camera.reach_px(projection);
        let margin_px = reach_px(self.brightest_e_per_s) + motion_px;
        for star in self.stars_around(camera.middle, projection, margin_px) {
            let astrometric = observer.astrometric(&star.motion);
            let apparent = observer.apparent_from_astrometric(astrometric);
            if let Some(position) = projection.project(&(camera.middle * apparent))
                && (is_within(position, projection, 0.0)
                    || is_within(position, projection, reach_px(star.electrons_per_s) + motion_px))
            {
                sources.push(Source {
                    kind: ObjectKind::Star,
                    id: star.id,
                    position,
                    ends: camera.ends.map(|end| projection.project(&(end * apparent)).unwrap_or(position)),
                    astrometric: Some(astrometric),
                    magnitude: Some(star.magnitude),
                    electrons_per_s: star.electrons_per_s,
                });
            }
        }
    }

    /// Electrons per second of the brightest unhidden star on the detector, or `at_least` if that is larger.
    pub fn brightest(
        &self,
        observer: &Observer,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        at_least: f64,
        is_hidden: impl Fn(Direction<Icrs>) -> bool,
    ) -> f64 {
        let mut brightest = at_least;
        for star in self.stars_around(camera_from_icrs, projection, 0.0) {
            // Most stars are fainter than the brightest so far, so their positions are not needed.
            if star.electrons_per_s > brightest {
                let astrometric = observer.astrometric(&star.motion);
                let apparent = observer.apparent_from_astrometric(astrometric);
                if let Some(position) = projection.project(&(camera_from_icrs * apparent))
                    && is_within(position, projection, 0.0)
                    && !is_hidden(astrometric)
                {
                    brightest = star.electrons_per_s;
                }
            }
        }
        brightest
    }

    /// Returns all stars that can be within `margin_px` of the detector, and some others, sorted by number.
    fn stars_around(
        &self,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
        projection: &Projection,
        margin_px: f64,
    ) -> impl Iterator<Item = &PreparedStar> {
        let boresight = camera_from_icrs.inverse() * Direction::z();
        let (x_px_per_rad, y_px_per_rad) = projection.plate_scale_px_per_rad();
        let margin = Angle::from_radians(margin_px / x_px_per_rad.min(y_px_per_rad));
        let radius = projection.half_diagonal() + margin + CATALOG_MARGIN;
        self.catalog.index().within(&boresight, radius).into_iter().map(|index| &self.stars[index])
    }
}

/// Returns true if a position is on the detector or at most `margin_px` beyond its border along each axis.
pub(super) fn is_within(position: PixelPoint, projection: &Projection, margin_px: f64) -> bool {
    let (columns, rows) = projection.detector();
    let inside = |v: f64, n: usize| v >= -0.5 - margin_px && v <= n as f64 - 0.5 + margin_px;
    inside(position.x, columns) && inside(position.y, rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Camera;
    use nalgebra::Vector3;
    use optics::RadiometryConfig;
    use truth::catalog::CatalogStar;
    use truth::clock;

    fn radiometry() -> Radiometry {
        Radiometry::new(&RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1e6, colour_term: 0.0 }).unwrap()
    }

    fn projection() -> Projection {
        Projection::new(&Camera {
            columns: 300,
            rows: 200,
            focal_length_mm: 20.0,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 149.5,
            principal_y_px: 99.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        })
        .unwrap()
    }

    fn observer() -> Observer {
        let time = clock::parse_utc("2012-04-25T12:00:00Z").unwrap();
        Observer::new(time, Vector3::new(7000.0, 0.0, 0.0), Vector3::new(0.0, 7.5, 0.0)).unwrap()
    }

    fn looking_at(ra_deg: f64, dec_deg: f64) -> Rotation<CameraFrame, Icrs> {
        let z = *Direction::<Icrs>::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg))
            .vector();
        let x = z.cross(&Vector3::new(0.1, 0.2, 0.7)).normalize();
        Rotation::from_axes(&x, &z.cross(&x), &z)
    }

    fn seen(field: &StarField, camera_from_icrs: Rotation<CameraFrame, Icrs>, margin_px: f64) -> Vec<Source> {
        let mut sources = Vec::new();
        field.add_visible(
            &observer(),
            &CameraMotion::still(camera_from_icrs),
            &projection(),
            |_| margin_px,
            &mut sources,
        );
        sources
    }

    /// The star that controls the shutter is one that is drawn.
    #[test]
    fn the_brightest_is_the_brightest_of_those_on_the_detector() {
        let field = StarField::new(&Catalog::hipparcos2(), &radiometry());
        for (ra_deg, dec_deg) in [(84.0, -1.0), (101.0, -16.0), (266.4, -29.0), (0.0, 90.0), (180.0, 0.0)] {
            let camera_from_icrs = looking_at(ra_deg, dec_deg);
            let stars = seen(&field, camera_from_icrs, 0.0);
            let expected = stars.iter().map(|star| star.electrons_per_s).fold(0.0, f64::max);
            let brightest =
                |at_least| field.brightest(&observer(), camera_from_icrs, &projection(), at_least, |_| false);
            assert!(expected > 0.0);
            assert_eq!(brightest(0.0), expected);
            assert_eq!(brightest(2.0 * expected), 2.0 * expected, "something brighter than all stars");
        }
    }

    #[test]
    fn a_margin_adds_stars_around_the_detector_and_keeps_the_others() {
        let field = StarField::new(&Catalog::hipparcos2(), &radiometry());
        let (inside, around) =
            (seen(&field, looking_at(84.0, -1.0), 0.0), seen(&field, looking_at(84.0, -1.0), 20.0));
        assert!(inside.iter().all(|star| around.contains(star) && star.position.is_on_detector(300, 200)));
        let added = around.iter().filter(|star| !star.position.is_on_detector(300, 200));
        // 340 × 240 against 300 × 200: the area grows by a factor of 1.36.
        let share = added.count() as f64 / inside.len() as f64;
        assert!((0.15..0.6).contains(&share), "{share}");
        assert!(around.is_sorted_by(|a, b| a.id < b.id));
    }

    /// Known limit, see [`CATALOG_MARGIN`]: a star of a user's catalogue that moves 90″ per year has moved
    /// 0.53° from 1991.25 to 2012 and is not found at the edge of the field of view. A slower star at the
    /// same position is found.
    #[test]
    fn a_star_faster_than_any_known_is_lost_at_the_edge() {
        let camera_from_icrs = looking_at(40.0, 0.0);
        let icrs_from_camera = camera_from_icrs.inverse();
        let corner = icrs_from_camera * projection().unproject(PixelPoint::new(2.0, 2.0)).unwrap();
        let boresight = icrs_from_camera * Direction::z();
        let years = 21.065;
        let found = |arcsec_per_yr: f64| {
            // The star's motion reversed: straight away from the boresight.
            let outwards = (corner.vector() - boresight.vector()).normalize();
            let back = Angle::from_arcsec(arcsec_per_yr * years).radians();
            let start: Direction<Icrs> = Direction::from_vector(corner.vector() + outwards * back).unwrap();
            // The field of view is near the equator, so right ascension and declination have equal scale to
            // 1e-3.
            let pm = |to: Angle, from: Angle| (to.arcsec() - from.arcsec()) * 1000.0 / years;
            let star = CatalogStar {
                id: 1,
                ra_rad: start.ra().radians(),
                dec_rad: start.dec().radians(),
                parallax_mas: 0.0,
                pm_ra_mas_per_yr: pm(corner.ra(), start.ra()),
                pm_dec_mas_per_yr: pm(corner.dec(), start.dec()),
                radial_velocity_km_s: 0.0,
                hp_mag: 5.0,
                b_v: None,
                v_i: None,
            };
            let motion = StarMotion::new(&star);
            let at = projection().project(&(camera_from_icrs * observer().apparent(&motion))).unwrap();
            assert!(at.is_on_detector(300, 200), "{at:?}");
            let prepared = PreparedStar { id: 1, motion, magnitude: 5.0, electrons_per_s: 1e4 };
            let catalog = Catalog::from_stars(vec![star]);
            let field = StarField { catalog, stars: vec![prepared], brightest_e_per_s: 1e4 };
            seen(&field, camera_from_icrs, 0.0).len()
        };
        assert_eq!((found(10.4), found(90.0)), (1, 0));
    }
}
