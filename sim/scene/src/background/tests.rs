use optics::{KnownDetector, OpticsConfig, QuantumEfficiency, RadiometryConfig};
use truth::ecliptic;

use super::*;

fn camera() -> Camera {
    Camera {
        columns: 300,
        rows: 200,
        focal_length_mm: 20.0,
        pixel_width_um: 10.0,
        pixel_height_um: 8.0,
        principal_x_px: 149.5,
        principal_y_px: 99.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

fn one_zero_point() -> Radiometry {
    Radiometry::new(&RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1e7, colour_term: 0.0 }).unwrap()
}

fn spectral() -> Radiometry {
    Radiometry::new(&RadiometryConfig::Spectral {
        aperture_diameter_mm: 20.0,
        transmission: 0.8,
        quantum_efficiency: QuantumEfficiency::Known(KnownDetector::SiliconCcd),
        band_nm: None,
    })
    .unwrap()
}

fn background(config: &BackgroundConfig, radiometry: &Radiometry) -> Background {
    let projection = Projection::new(&camera()).unwrap();
    Background::new(config, &camera(), &projection, radiometry).unwrap().unwrap()
}

/// Attitude of a camera that points along a direction in ecliptic axes.
fn looking_at(ecliptic: Vector3<f64>) -> Rotation<CameraFrame, Icrs> {
    let z = ecliptic::to_icrs(ecliptic).normalize();
    let x = z.cross(&Vector3::new(0.3, 0.9, 0.1)).normalize();
    Rotation::from_axes(&x, &z.cross(&x), &z)
}

fn time() -> Epoch {
    clock::parse_utc("2012-04-25T12:00:00Z").unwrap()
}

/// Position of the Sun at ecliptic longitude 0, at 1 au; the observer is above the day side.
fn sun_km() -> Vector3<f64> {
    ecliptic::to_icrs(Vector3::x()) * AU_KM
}

fn observer_km() -> Vector3<f64> {
    ecliptic::to_icrs(Vector3::new(0.6, 0.8, 0.0)) * 7000.0
}

fn field(
    config: &BackgroundConfig,
    radiometry: &Radiometry,
    boresight: Vector3<f64>,
) -> (BackgroundField, Vec<f64>) {
    let field =
        background(config, radiometry).field(time(), &observer_km(), &sun_km(), looking_at(boresight));
    let mut pixels = vec![7.0; 3];
    field.electrons_per_s(&mut pixels);
    (field, pixels)
}

const LAW: StrayLightConfig =
    StrayLightConfig { exclusion_deg: 40.0, transmittance: 1e-7, power: 2.0, power_inside: 4.0 };

#[test]
fn effects_are_off_by_default_and_stray_light_requires_an_aperture() {
    let projection = Projection::new(&camera()).unwrap();
    let new = |config: &BackgroundConfig| {
        Background::new(config, &camera(), &projection, &one_zero_point())
            .map(|background| background.is_some())
    };
    assert!(!new(&BackgroundConfig::default()).unwrap());
    let sun = BackgroundConfig { sun: Some(LAW), ..BackgroundConfig::default() };
    assert!(new(&sun).unwrap_err().to_string().contains("spectral"));
    let wrong = BackgroundConfig { faint_stars_s10: -1.0, ..BackgroundConfig::default() };
    assert!(new(&wrong).unwrap_err().to_string().contains("faint_stars_s10"));
}

/// 1 S10 is one star of V = 10 per square degree: zero point · 10⁻⁴ · the pixel's solid angle, which
/// decreases as cos³ of the angle to the boresight in a pinhole camera.
#[test]
fn faint_stars_have_the_flux_of_their_number() {
    let config = BackgroundConfig { faint_stars_s10: 100.0, ..BackgroundConfig::default() };
    let (_, pixels) = field(&config, &one_zero_point(), Vector3::z());
    let square_degrees = 10.0 * 8.0 * 1e-6 / 400.0 * SQUARE_DEGREES_PER_SR;
    let at = |x: usize, y: usize| {
        let (u, v) = ((x as f64 - 149.5) * 10e-3, (y as f64 - 99.5) * 8e-3);
        let cos2 = 400.0 / (400.0 + u * u + v * v);
        1e7 * 1e-4 * 100.0 * square_degrees * cos2 * cos2.sqrt()
    };
    for (x, y) in [(0, 0), (149, 99), (299, 199), (10, 150), (201, 3)] {
        let ratio = pixels[y * 300 + x] / at(x, y);
        // Linear interpolation between nodes 19 pixels apart.
        assert!((ratio - 1.0).abs() < 1e-4, "({x}, {y}): {ratio}");
    }
}

/// Leinert et al. (1998): 60 S10 at the pole of the ecliptic, 23.3 mag per square arc second; 22.1 near the
/// antisolar point.
#[test]
fn zodiacal_light_has_its_published_surface_brightness() {
    let config = BackgroundConfig { zodiacal: Switch::On, ..BackgroundConfig::default() };
    for (boresight, magnitude) in [(Vector3::z(), 23.34), (-Vector3::z(), 23.34), (-Vector3::x(), 22.14)] {
        let (_, pixels) = field(&config, &one_zero_point(), boresight);
        let square_arcsec = 10.0 * 8.0 * 1e-6 / 400.0 * SQUARE_DEGREES_PER_SR * 3600.0 * 3600.0;
        let found = -2.5 * libm::log10(pixels[100 * 300 + 150] / square_arcsec / 1e7);
        assert!((found - magnitude).abs() < 0.03, "{found} for {magnitude}");
    }
}

#[test]
fn the_mean_is_that_of_the_pixels_and_neighbours_are_alike() {
    let config = BackgroundConfig {
        zodiacal: Switch::On,
        faint_stars_s10: 20.0,
        sun: Some(LAW),
        earth: Some(EarthLightConfig { albedo: 0.3, scatter: LAW }),
        moon: Some(LAW),
    };
    let (field, pixels) = field(&config, &spectral(), Vector3::new(0.1, 0.3, 1.0));
    assert_eq!(pixels.len(), 300 * 200);
    let mean = pixels.iter().sum::<f64>() / pixels.len() as f64;
    assert!((field.mean_e_per_s() / mean - 1.0).abs() < 1e-12);
    for row in pixels.chunks_exact(300) {
        assert!(row.windows(2).all(|pair| (pair[1] / pair[0] - 1.0).abs() < 0.01));
    }
}

/// Expected value: the Sun on a square metre of bare detector, times the transmittance at its angle, times
/// the area of a pixel.
#[test]
fn stray_light_of_the_sun_is_its_irradiance_times_the_transmittance() {
    let config = BackgroundConfig { sun: Some(LAW), ..BackgroundConfig::default() };
    let radiometry = spectral();
    let (_, pixels) = field(&config, &radiometry, Vector3::new(0.0, 0.0, 1.0));
    // 90° from the Sun: (40/90)² of the transmittance at 40°; pixel (150, 100) is 0.02° off the boresight.
    let bare = radiometry.bare_sunlight_e_per_s_m2().unwrap() * libm::pow(10.0, 0.4 * 26.76) * 80e-12;
    let expected = bare * 1e-7 * (40.0 / 90.0) * (40.0 / 90.0);
    assert!((pixels[100 * 300 + 150] / expected - 1.0).abs() < 2e-3);
    // A photon of 600 nm has 3.3e-19 J, and a third of 1361 W/m² becomes electrons: some 1e21 electrons per
    // second and m².
    assert!((5e20..2e21).contains(&(bare / 80e-12)), "{bare}");
}

#[test]
fn in_the_shadow_of_the_earth_the_sun_scatters_nothing() {
    let config = BackgroundConfig { sun: Some(LAW), ..BackgroundConfig::default() };
    let night = -ecliptic::to_icrs(Vector3::x()) * 7000.0;
    let dark = background(&config, &spectral()).field(time(), &night, &sun_km(), looking_at(Vector3::z()));
    assert_eq!(dark.mean_e_per_s(), 0.0);
}

/// The full Moon is 400 000 times fainter than the Sun (14 mag), and with equal scattering so is its stray
/// light.
#[test]
fn the_moon_scatters_as_much_less_as_it_is_fainter() {
    let config = BackgroundConfig {
        moon: Some(StrayLightConfig { power: 0.0, power_inside: 0.0, ..LAW }),
        ..BackgroundConfig::default()
    };
    let moon = background(&config, &spectral());
    // Full and new moons both occur within half a year; here the Sun is placed opposite to the Moon.
    let to_moon = moon::moon_position_km(clock::tdb_j2000_s(time()));
    let observer = to_moon.normalize() * 7000.0;
    let mean =
        |sun: Vector3<f64>| moon.field(time(), &observer, &sun, looking_at(Vector3::z())).mean_e_per_s();
    let full = mean(-to_moon.normalize() * AU_KM);
    let bare = spectral().bare_sunlight_e_per_s_m2().unwrap() * libm::pow(10.0, 0.4 * 26.76) * 80e-12;
    let nearness = 384_400.0 / (to_moon.norm() - 7000.0);
    let expected = bare * 1e-7 * libm::pow(10.0, -0.4 * (26.76 - 12.73)) * nearness * nearness;
    assert!((full / expected - 1.0).abs() < 0.01, "{}", full / expected);
    assert!(mean(to_moon.normalize() * AU_KM) < 0.01 * full);
}

/// cos⁴ law of a uniform sky: cos³ of the pixels' solid angles times the cosine of the foreshortened
/// aperture.
#[test]
fn an_even_sky_falls_off_by_the_fourth_power_of_the_cosine() {
    let even = BackgroundConfig { faint_stars_s10: 100.0, ..BackgroundConfig::default() };
    let optics = OpticsConfig { cos_fourth: Switch::On, ..OpticsConfig::default() };
    let vignetting = Vignetting::new(&optics, &camera()).unwrap();
    let background = background(&even, &one_zero_point()).vignetted(&vignetting);
    let mut pixels = Vec::new();
    let (position_km, sun_km) = (Vector3::new(7000.0, 0.0, 0.0), Vector3::new(1.5e8, 0.0, 0.0));
    background.field(time(), &position_km, &sun_km, looking_at(Vector3::z())).electrons_per_s(&mut pixels);
    let projection = Projection::new(&camera()).unwrap();
    let cos = projection.unproject(PixelPoint::new(0.0, 0.0)).unwrap().vector().z;
    let ratio = pixels[0] / pixels[100 * 300 + 150];
    // The field is linear between the nodes: an error of 1e-5.
    assert!((ratio - cos * cos * cos * cos).abs() < 2e-5, "{ratio}, {}", cos * cos * cos * cos);
}
