//! Planets in the field of view.

use contract::{CameraFrame, Direction, Icrs, Rotation};
use optics::{Projection, Radiometry};
use truth::{ObjectKind, Observer, Planet};

use super::star_field::is_within;
use super::{CameraMotion, Source};

/// Appends the planets whose image falls on the detector during the exposure, from the Sun outwards. They are
/// point sources: the largest, Venus near conjunction, spans 1′. `tdb_j2000_s` is the time of the observer;
/// `reach_px` returns the extent of an image, px, for a flux in photoelectrons per second.
pub fn add_visible(
    tdb_j2000_s: f64,
    observer: &Observer,
    camera: &CameraMotion,
    projection: &Projection,
    radiometry: &Radiometry,
    reach_px: impl Fn(f64) -> f64,
    sources: &mut Vec<Source>,
) {
    for planet in Planet::ALL {
        let Some(apparent_planet) = planet.apparent(tdb_j2000_s, observer) else { continue };
        let apparent = observer.apparent_from_astrometric(apparent_planet.astrometric);
        let electrons_per_s = radiometry.star(apparent_planet.magnitude, Some(planet.b_v()), None);
        if let Some(position) = projection.project(&(camera.middle * apparent))
            && is_within(position, projection, reach_px(electrons_per_s) + camera.reach_px(projection))
        {
            sources.push(Source {
                kind: ObjectKind::Planet,
                id: planet.number(),
                position,
                ends: camera.ends.map(|end| projection.project(&(end * apparent)).unwrap_or(position)),
                astrometric: Some(apparent_planet.astrometric),
                magnitude: Some(apparent_planet.magnitude),
                electrons_per_s,
            });
        }
    }
}

/// Electrons per second of the brightest unhidden planet on the detector, or `at_least` if that is larger.
pub fn brightest(
    tdb_j2000_s: f64,
    observer: &Observer,
    camera_from_icrs: Rotation<CameraFrame, Icrs>,
    projection: &Projection,
    radiometry: &Radiometry,
    at_least: f64,
    is_hidden: impl Fn(Direction<Icrs>) -> bool,
) -> f64 {
    let mut seen = Vec::new();
    let camera = CameraMotion::still(camera_from_icrs);
    add_visible(tdb_j2000_s, observer, &camera, projection, radiometry, |_| 0.0, &mut seen);
    let seen = seen.iter().filter(|planet| !planet.astrometric.is_some_and(&is_hidden));
    seen.map(|planet| planet.electrons_per_s).fold(at_least, f64::max)
}
