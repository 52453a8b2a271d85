//! Tests of a body of plates against closed forms: its flux, its centre of brightness, its shadows.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};

use super::body::LitBody;
use super::facet::Facet;
use super::plate::{BoxConfig, PlateConfig};
use super::surface::SurfaceConfig;
use super::*;

const WHITE: SurfaceConfig = SurfaceConfig { diffuse: 1.0, specular: 0.0, roughness: 0.1 };
const GREY: SurfaceConfig = SurfaceConfig { diffuse: 0.4, specular: 0.0, roughness: 0.1 };

/// Returns a plate in the plane at height `z`, facing +z.
fn plate(
    centre: [f64; 2],
    z: f64,
    size: [f64; 2],
    front: SurfaceConfig,
    back: Option<SurfaceConfig>,
) -> Facet {
    PlateConfig {
        centre_m: [centre[0], centre[1], z],
        normal: [0.0, 0.0, 3.0],
        up: [0.0, 2.0, 1.0],
        width_m: size[0],
        height_m: size[1],
        front,
        back,
    }
    .plate()
    .unwrap()
}

fn unit(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z).normalize()
}

/// Unit vector at an angle from z towards x.
fn tilted(degrees: f64) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Vector3::new(sin, 0.0, cos)
}

/// f_r cos θᵢ cos θₒ A in m²: the flux ratio times the square of a distance so large that all rays are
/// parallel.
fn far_light(plates: &[Facet], eye: Vector3<f64>, sun: Vector3<f64>) -> f64 {
    let far_m = 1e7;
    LitBody::new(plates, eye * far_m, sun).flux_ratio() * far_m * far_m
}

/// Returns a pinhole camera at `eye_m` that points at the origin, with `px` pixels per radian.
fn pinhole(eye_m: Vector3<f64>, px: f64) -> impl Fn(&Vector3<f64>) -> Option<PixelPoint> {
    let z = -eye_m.normalize();
    let x = z.cross(&Vector3::new(0.3, 1.0, 0.1)).normalize();
    let y = z.cross(&x);
    move |point: &Vector3<f64>| {
        let d = point - eye_m;
        (d.dot(&z) > 0.0).then(|| PixelPoint::new(px * d.dot(&x) / d.dot(&z), px * d.dot(&y) / d.dot(&z)))
    }
}

/// Box with one panel in front of a face and one that protrudes, similar to TANGO.
fn tango() -> Vec<Facet> {
    let foil = SurfaceConfig { diffuse: 0.25, specular: 0.2, roughness: 0.15 };
    let cells = SurfaceConfig { diffuse: 0.05, specular: 0.3, roughness: 0.05 };
    let mut plates = BoxConfig { centre_m: [0.0; 3], size_m: [0.80, 0.75, 0.32], surface: foil }
        .plates()
        .unwrap()
        .to_vec();
    plates.push(plate([0.0, 0.0], 0.18, [0.78, 0.73], cells, None));
    plates.push(plate([0.9, 0.0], 0.1, [0.9, 0.7], cells, Some(foil)));
    plates
}

#[test]
fn a_diffuse_plate_has_its_closed_form() {
    let plates = [plate([0.0, 0.0], 0.0, [2.0, 1.5], GREY, None)];
    for (sun_deg, eye_deg) in [(0.0, 0.0), (30.0, -50.0), (80.0, 10.0)] {
        let cosines = libm::cos(f64::to_radians(sun_deg)) * libm::cos(f64::to_radians(eye_deg));
        let expected = 0.4 / PI * 3.0 * cosines;
        // The finite distance contributes 1e-7 or less.
        assert!((far_light(&plates, tilted(eye_deg), tilted(sun_deg)) / expected - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_side_is_bright_when_sun_and_camera_are_both_on_it() {
    let one = [plate([0.0, 0.0], 0.0, [1.0, 1.0], GREY, None)];
    let two = [plate([0.0, 0.0], 0.0, [1.0, 1.0], GREY, Some(WHITE))];
    assert_eq!(far_light(&one, tilted(10.0), tilted(170.0)), 0.0);
    assert_eq!(far_light(&one, tilted(170.0), tilted(170.0)), 0.0);
    assert_eq!(far_light(&two, tilted(170.0), tilted(10.0)), 0.0);
    let ratio = far_light(&two, tilted(170.0), tilted(150.0)) / far_light(&two, tilted(10.0), tilted(30.0));
    assert!((ratio - 2.5).abs() < 1e-9);
}

#[test]
fn a_box_seen_face_on_is_that_face() {
    let faces = BoxConfig { centre_m: [0.0; 3], size_m: [0.8, 0.75, 0.32], surface: GREY }.plates().unwrap();
    let face = [plate([0.0, 0.0], 0.16, [0.8, 0.75], GREY, None)];
    let (eye, sun) = (Vector3::z(), tilted(35.0));
    assert!((far_light(&faces, eye, sun) / far_light(&face, eye, sun) - 1.0).abs() < 1e-9);
}

/// A convex body hides and shades only its own far side, so its flux is the sum over its faces.
#[test]
fn a_box_is_the_sum_of_its_lit_and_visible_faces() {
    let size = [0.8, 0.75, 0.32];
    let faces = BoxConfig { centre_m: [0.1, -0.2, 0.3], size_m: size, surface: GREY }.plates().unwrap();
    let (eye, sun) = (unit(1.0, 0.5, 0.3), unit(-0.2, 0.9, 0.6));
    let expected = 0.4 / PI * (size[2] * size[0] * eye.y * sun.y + size[0] * size[1] * eye.z * sun.z);
    assert!((far_light(&faces, eye, sun) / expected - 1.0).abs() < 1e-6);
}

/// A sphere of 64 × 32 plates replaces the Lambert sphere. The plates are tangent at their centres, so their
/// areas differ from the sphere's by factors such as 2 sin(Δ/2)/Δ, by about 1e-3.
#[test]
fn many_plates_on_a_sphere_follow_lamberts_phase_law() {
    let (rings, sectors) = (32, 64);
    let mut plates = Vec::new();
    let step = PI / f64::from(rings);
    for ring in 0..rings {
        let polar = (f64::from(ring) + 0.5) * step;
        let (sin, cos) = libm::sincos(polar);
        for sector in 0..sectors {
            let (s, c) = libm::sincos(2.0 * PI * f64::from(sector) / f64::from(sectors));
            let normal = Vector3::new(sin * c, sin * s, cos);
            let up = Vector3::new(-cos * c, -cos * s, sin);
            plates.push(
                PlateConfig {
                    centre_m: normal.into(),
                    normal: normal.into(),
                    up: up.into(),
                    width_m: 2.0 * PI / f64::from(sectors) * sin,
                    height_m: step,
                    front: WHITE,
                    back: None,
                }
                .plate()
                .unwrap(),
            );
        }
    }
    for phase_deg in [0.0_f64, 30.0, 60.0, 90.0, 120.0] {
        // Each plate is computed separately: neighbours that touch at an angle would shade slivers of each
        // other.
        let (eye, sun) = (unit(0.3, 0.2, 0.4), {
            let across = unit(0.3, 0.2, 0.4).cross(&Vector3::y()).normalize();
            unit(0.3, 0.2, 0.4) * libm::cos(phase_deg.to_radians())
                + across * libm::sin(phase_deg.to_radians())
        });
        let light: f64 = plates.iter().map(|plate| far_light(&[*plate], eye, sun)).sum();
        let expected = 2.0 / 3.0 * lambert_phase(phase_deg.to_radians());
        // 4e-3 of the flux at full phase, because the terminator falls between plates.
        assert!((light - expected).abs() < 4e-3 * 2.0 / 3.0, "{light} for {expected} at {phase_deg}°");
    }
}

#[test]
fn a_panel_flashes_at_the_angle_of_a_mirror() {
    let shiny = SurfaceConfig { diffuse: 0.05, specular: 0.5, roughness: 0.03 };
    let panel = [plate([0.0, 0.0], 0.0, [1.0, 1.0], shiny, None)];
    let light = |eye_deg: f64| far_light(&panel, tilted(eye_deg), tilted(-40.0));
    let flash = light(40.0);
    let (before, after) = (light(20.0), light(60.0));
    assert!(flash > 50.0 * before && flash > 50.0 * after, "{before} {flash} {after}");
    let brightest =
        (0..900).map(|i| f64::from(i) / 10.0).max_by(|a, b| light(*a).total_cmp(&light(*b))).unwrap();
    // The lobe is slightly steeper towards the plane, so its maximum is within a tenth of its width of 3.4°.
    assert!((brightest - 40.0).abs() < 0.4, "{brightest}");
}

#[test]
fn a_shadow_removes_its_own_area() {
    // A black screen of 1 m by 1 m stands 1 m above a plate of 4 m: the Sun at 45° towards x casts its shadow
    // 1 m to the side.
    let black = SurfaceConfig { diffuse: 0.0, specular: 0.0, roughness: 0.1 };
    let ground = plate([0.0, 0.0], 0.0, [4.0, 4.0], GREY, None);
    let screen = plate([0.0, 0.0], 1.0, [1.0, 1.0], black, Some(black));
    let light = |plates: &[Facet], eye: Vector3<f64>| far_light(plates, eye, tilted(45.0));
    // Seen along the sunlight, the screen hides its own shadow: one square metre of 16 is lost; from above,
    // two.
    for (eye, lost) in
        [(tilted(45.0), 1.0), (Vector3::z(), 2.0), (tilted(-45.0), 2.0), (tilted(20.0), 1.63603)]
    {
        let share = light(&[ground, screen], eye) / light(&[ground], eye);
        // At 20° the hidden square is 0.36397 m away from the shadow, so the union of the two is 2 − 0.36397.
        assert!((share - (1.0 - lost / 16.0)).abs() < 1e-5, "{share} for {lost}");
    }
}

/// The exact areas agree with rays from points of each plate to the Sun and to the camera.
#[test]
fn shadows_and_occlusions_are_those_of_rays() {
    let plates: Vec<Facet> =
        tango().into_iter().map(|p| Facet { front: GREY, back: p.back.map(|_| GREY), ..p }).collect();
    let blocked = |from: &Vector3<f64>, to: &Vector3<f64>, own: usize| {
        plates.iter().enumerate().filter(|(j, _)| *j != own).any(|(_, other)| {
            let (a, b) = (other.local(from), other.local(to));
            if (a.z > 0.0) == (b.z > 0.0) {
                return false;
            }
            let hit = a + (b - a) * (a.z / (a.z - b.z));
            hit.x.abs() < other.half_width && hit.y.abs() < other.half_height
        })
    };
    for (eye, sun) in [
        (unit(0.5, 0.3, 0.9), unit(-0.7, 0.2, 0.5)),
        (unit(-1.0, 0.3, 0.3), unit(0.9, 0.1, 0.35)),
        (unit(-0.4, -0.6, -0.5), unit(-0.9, -0.3, 0.05)),
    ] {
        let eye_m = eye * 6.0;
        let mut expected = 0.0;
        for (i, plate) in plates.iter().enumerate() {
            let n = 200;
            for (j, k) in (0..n * n).map(|m| (m / n, m % n)) {
                let along = |half: f64, i: i32| half * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
                let point = plate.point_in_body_frame(&Vector2::new(
                    along(plate.half_width, j),
                    along(plate.half_height, k),
                ));
                let to_eye = eye_m - point;
                let cosines = plate.normal.dot(&sun) * plate.normal.dot(&to_eye.normalize());
                let bright = cosines > 0.0 && (plate.normal.dot(&sun) > 0.0 || plate.back.is_some());
                if bright && !blocked(&point, &(point + sun * 100.0), i) && !blocked(&point, &eye_m, i) {
                    let area = 4.0 * plate.half_width * plate.half_height / f64::from(n * n);
                    expected += 0.4 / PI * cosines * area / to_eye.norm_squared();
                }
            }
        }
        let light = LitBody::new(&plates, eye_m, sun).flux_ratio();
        // Points at the edge of a shadow are counted fully or not at all: an error of about 1/200 of its
        // length.
        assert!(expected > 0.0 && (light / expected - 1.0).abs() < 5e-3, "{light} {expected}");
    }
}

fn image(lit: &LitBody, eye_m: Vector3<f64>, px: f64) -> Vec<ImagePoint> {
    let mut points = Vec::new();
    lit.image(&pinhole(eye_m, px), 1 << 18, &mut points);
    points
}

fn mean(points: &[ImagePoint]) -> Vector2<f64> {
    points.iter().fold(Vector2::zeros(), |sum, p| sum + Vector2::new(p.position.x, p.position.y) * p.share)
}

#[test]
fn the_shares_of_an_image_add_up_to_one_and_its_cells_to_the_flux() {
    let plates = tango();
    for range_m in [3.0, 30.0, 3e3, 3e4] {
        let eye_m = unit(0.4, -0.3, 0.8) * range_m;
        let lit = LitBody::new(&plates, eye_m, unit(0.1, 0.8, 0.7));
        let points = image(&lit, eye_m, 2300.0);
        assert!((points.iter().map(|p| p.share).sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(points.len() <= (1 << 18) + 4 * 40, "{} at {range_m} m", points.len());
    }
}

/// The peak of the image after a Gaussian of 0.8 px, the mean and the flux all change continuously as the
/// body approaches from afar.
#[test]
fn nothing_jumps_as_the_body_comes_nearer() {
    let plates = tango();
    let (direction, sun) = (unit(0.4, -0.3, 0.8), unit(0.1, 0.8, 0.7));
    let mut last: Option<(f64, f64, Vector2<f64>)> = None;
    let mut range_m = 200_000.0;
    let mut kinds = std::collections::BTreeSet::new();
    while range_m > 400.0 {
        let eye_m = direction * range_m;
        let lit = LitBody::new(&plates, eye_m, sun);
        let points = image(&lit, eye_m, 2300.0);
        kinds.insert(points.len());
        let centre = mean(&points);
        let peak: f64 = points
            .iter()
            .map(|p| {
                let d = Vector2::new(p.position.x, p.position.y) - centre;
                p.share * libm::exp(-0.5 * d.norm_squared() / 0.64)
            })
            .sum();
        let light = lit.flux_ratio() * range_m * range_m;
        // Centre of brightness in metres at the body; perspective shifts it by size²/range.
        let place = centre * range_m / 2300.0;
        if let Some((was_light, was_peak, was_place)) = last {
            assert!((light / was_light - 1.0).abs() < 1e-3, "light at {range_m} m");
            // In a step of 0.5 % the width of the image changes by 0.5 %, and its peak by less.
            assert!(
                (peak - was_peak).abs() < 1e-3 + 0.01 * (1.0 - peak),
                "{was_peak} to {peak} at {range_m} m"
            );
            assert!(
                (place - was_place).norm() * 2300.0 / range_m < 1e-3,
                "{was_place} to {place} at {range_m} m"
            );
        }
        last = Some((light, peak, place));
        range_m *= 0.995;
    }
    assert!(kinds.contains(&1) && kinds.contains(&4) && kinds.len() > 4, "{kinds:?}");
}

/// A resolved body and a point source of the same body have equal flux for every size of cell.
#[test]
fn the_sum_over_the_cells_of_the_image_is_the_flux_of_the_point() {
    let plates = tango();
    for range_m in [5.0, 20.0, 1000.0] {
        let eye_m = unit(0.4, -0.3, 0.8) * range_m;
        // Near the specular direction of the panels, where radiance varies most over the body.
        let lit = LitBody::new(&plates, eye_m, unit(-0.38, 0.33, 0.8));
        let [coarse, fine] = [300.0, 30_000.0].map(|px| lit.cells_flux(&pinhole(eye_m, px)));
        assert!((fine / lit.flux_ratio() - 1.0).abs() < 1e-6, "{} at {range_m} m", fine / lit.flux_ratio());
        assert!((coarse / fine - 1.0).abs() < 2e-3, "{} at {range_m} m", coarse / fine);
    }
}

#[test]
fn the_centre_of_brightness_is_on_the_sunlit_side() {
    let cube = BoxConfig { centre_m: [0.0; 3], size_m: [1.0; 3], surface: GREY }.plates().unwrap();
    let eye_m = unit(1.0, 0.0, 1.0) * 10_000.0;
    let place = |sun: Vector3<f64>| mean(&image(&LitBody::new(&cube, eye_m, sun), eye_m, 1e5));
    let sunward = |sun: Vector3<f64>| {
        let towards = pinhole(eye_m, 1e5)(&(sun * 1.0)).unwrap();
        place(sun).dot(&Vector2::new(towards.x, towards.y))
    };
    assert!(place(unit(1.0, 0.0, 1.0)).norm() < 1e-6, "in full light it is in the middle");
    for sun in [unit(1.0, 0.0, 0.2), unit(0.2, 0.0, 1.0), unit(1.0, 0.0, -0.5)] {
        assert!(sunward(sun) > 0.0, "{sun}");
    }
    // Only the face x = 0.5 is lit: its centre is √½ · ½ m from the middle, 3.54 px.
    assert!((place(unit(1.0, 0.0, -0.5)).norm() - 5.0 * std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-3);
}

#[test]
fn a_large_image_has_a_lower_peak_than_a_point_and_a_small_one_the_same() {
    let cube = BoxConfig { centre_m: [0.0; 3], size_m: [1.0; 3], surface: GREY }.plates().unwrap();
    let share = |range_m: f64, eye: Vector3<f64>| {
        let eye_m = eye * range_m;
        let lit = LitBody::new(&cube, eye_m, unit(0.3, 0.2, 1.0));
        lit.peak_share(&pinhole(eye_m, 1000.0), 0.2).unwrap()
    };
    // One square metre at a distance of 99.5 m: 10.05 × 10.05 px.
    assert!((share(100.0, Vector3::z()) - 0.0099).abs() < 1e-4);
    // Three faces, with 0.05 px between their centres.
    assert!((share(10_000.0, unit(1.0, 1.0, 1.0)) - 0.2).abs() < 1e-3);
}

#[test]
fn the_penumbra_dims_a_body_in_proportion() {
    let config: TargetConfig =
        toml::from_str("kind = \"plates\"\n[[boxes]]\nsize_m = [1, 2, 3]\nsurface = { diffuse = 0.3 }")
            .unwrap();
    let light = |sunlit_fraction: f64| {
        let lighting = Lighting {
            chaser_km: Vector3::new(3.0, 4.0, 5.0),
            sun_km: Vector3::new(1.0, 0.2, 0.1) * 1.5e8,
            sunlit_fraction,
        };
        Spacecraft::new(&config).unwrap().appearance(&lighting, Some(Rotation::identity())).magnitude()
    };
    let full = light(1.0).unwrap();
    for fraction in [0.9, 0.5, 1e-6] {
        let expected = full - 2.5 * libm::log10(fraction);
        assert!((light(fraction).unwrap() - expected).abs() < 1e-12);
    }
    assert_eq!(light(0.0), None);
}

#[test]
fn a_camera_in_the_midst_of_the_body_is_no_failure() {
    for eye_m in [Vector3::zeros(), Vector3::new(0.2, 0.1, 0.17), Vector3::new(0.9, 0.0, 0.1)] {
        let lit = LitBody::new(&tango(), eye_m, unit(0.1, 0.8, 0.7));
        assert!(lit.flux_ratio() >= 0.0);
    }
}

#[test]
fn numbers_out_of_range_are_reported_with_their_path() {
    let message = |text: &str| {
        let config: TargetConfig = toml::from_str(text).unwrap();
        config.check().unwrap_err().to_string()
    };
    let body = |plate: &str| {
        message(&format!(
            "kind = \"plates\"\n[[plates]]\ncentre_m = [0, 0, 0]\nwidth_m = 1.0\nheight_m = 1.0\n{plate}"
        ))
    };
    assert!(message("kind = \"plates\"").contains("target.plates is 0"));
    let front = "front = { diffuse = 0.2 }";
    assert!(
        body(&format!("normal = [0, 0, 0]\nup = [0, 1, 0]\n{front}")).contains("target.plates[0].normal")
    );
    assert!(body(&format!("normal = [0, 2, 0]\nup = [0, 1, 0]\n{front}")).contains("target.plates[0].up"));
    let bright = "normal = [0, 0, 1]\nup = [0, 1, 0]\nfront = { diffuse = 0.7, specular = 0.4 }";
    assert!(body(bright).contains("target.plates[0].front.specular is 0.4"));
    let back = format!("normal = [0, 0, 1]\nup = [0, 1, 0]\n{front}\nback = {{ diffuse = -0.1 }}");
    assert!(body(&back).contains("target.plates[0].back.diffuse is -0.1"));
    let second = "kind = \"plates\"\n[[boxes]]\nsize_m = [1, 1, 1]\nsurface = { diffuse = 0.2 }\n\
                  [[boxes]]\nsize_m = [1, 1, 1]\nsurface = { diffuse = 0.2, specular = 0.1, roughness = 2.0 }";
    assert!(message(second).contains("target.boxes[1].surface.roughness is 2"));
    let boxes = "kind = \"plates\"\n[[boxes]]\nsize_m = [1.0, 0.0, 1.0]\nsurface = { diffuse = 0.2 }";
    assert!(message(boxes).contains("target.boxes[0].size_m[1] is 0"));
}
