//! Pointings evenly distributed over the whole sky: the star field finds the same stars as a search through
//! all stars.

use std::path::Path;

use boresight_sim::catalog::{Catalog, CatalogConfig};
use boresight_sim::optics::{Projection, Radiometry, RadiometryConfig};
use boresight_sim::scene::{CameraMotion, StarField};
use boresight_sim::truth::{Observer, StarMotion, clock};
use contract::{Angle, Camera, CameraFrame, Direction, Icrs, Rotation};
use nalgebra::Vector3;

const POINTINGS: usize = 500;

/// Point `i` of a Fibonacci lattice of [`POINTINGS`] on the sphere; each point represents the same solid
/// angle.
fn lattice(i: usize) -> (f64, f64) {
    let z = 1.0 - (2.0 * i as f64 + 1.0) / POINTINGS as f64;
    let golden_turns = i as f64 * 0.618_033_988_749_894_9;
    (360.0 * golden_turns.fract(), libm::asin(z).to_degrees())
}

/// Camera that points at lattice point `i`, with a different roll angle for each point.
fn camera_at(i: usize) -> Rotation<CameraFrame, Icrs> {
    let (ra_deg, dec_deg) = lattice(i);
    let boresight: Direction<Icrs> =
        Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg));
    let z = *boresight.vector();
    let (sin, cos) = libm::sincos(i as f64);
    // Any direction that is not parallel to the boresight.
    let aside = if z.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let (u, v) = (z.cross(&aside).normalize(), z.cross(&z.cross(&aside)).normalize());
    let x = u * cos + v * sin;
    Rotation::from_axes(&x, &z.cross(&x), &z)
}

/// Field of the far-range camera, 18.2° × 13.6°, on a detector with coarser pixels.
fn projection() -> Projection {
    Projection::new(&Camera {
        columns: 188,
        rows: 145,
        focal_length_mm: 20.187,
        pixel_width_um: 34.4,
        pixel_height_um: 33.2,
        principal_x_px: 93.4,
        principal_y_px: 72.1,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    })
    .unwrap()
}

#[test]
fn at_every_pointing_the_field_has_every_star_and_no_other() {
    let bright = CatalogConfig { magnitude_limit: Some(6.5), ..CatalogConfig::default() };
    let catalog = Catalog::load(&bright, Path::new("")).unwrap();
    let projection = projection();
    let (columns, rows) = projection.detector();
    let time = clock::parse_utc("2026-06-01T00:00:00Z").unwrap();
    let observer =
        Observer::new(time, Vector3::new(3000.0, 6000.0, 1500.0), Vector3::new(-6.0, 2.0, 4.0)).unwrap();
    // The reference transforms every star of the catalogue into the camera frame.
    let apparent: Vec<(u32, Direction<Icrs>)> =
        catalog.stars().iter().map(|star| (star.id, observer.apparent(&StarMotion::new(star)))).collect();
    let radiometry =
        Radiometry::new(&RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1e6, colour_term: 0.0 }).unwrap();
    let field = StarField::new(&catalog, &radiometry);
    let (mut stars, mut fewest) = (0, usize::MAX);
    for i in 0..POINTINGS {
        let camera = camera_at(i);
        let mut sources = Vec::new();
        field.add_visible(&observer, &CameraMotion::still(camera), &projection, |_| 0.0, &mut sources);
        let shown: Vec<u32> = sources.iter().map(|source| source.id).collect();
        let expected: Vec<u32> = apparent
            .iter()
            .filter(|(_, direction)| {
                let position = projection.project(&(camera * *direction));
                position.is_some_and(|position| position.is_on_detector(columns, rows))
            })
            .map(|(id, _)| *id)
            .collect();
        assert_eq!(shown, expected, "pointing {i}: {:?}", lattice(i));
        stars += shown.len();
        fewest = fewest.min(shown.len());
    }
    // The lattice weights the sky uniformly: the mean number of stars is the sky's density times the solid
    // angle of the field.
    let (w, h): (f64, f64) = (188.0 * 34.4e-3 / 2.0 / 20.187, 145.0 * 33.2e-3 / 2.0 / 20.187);
    let solid_angle = 4.0 * libm::asin(w * h / ((1.0 + w * w) * (1.0 + h * h)).sqrt());
    let density = apparent.len() as f64 / (4.0 * std::f64::consts::PI);
    let mean = stars as f64 / POINTINGS as f64;
    // The fields overlap three times. A star counts about three times, plus or minus one: 1 %.
    assert!((mean / (density * solid_angle) - 1.0).abs() < 0.01, "{mean} stars, {}", density * solid_angle);
    assert!(fewest > 5, "a field of {fewest} stars brighter than 6.5");
}
