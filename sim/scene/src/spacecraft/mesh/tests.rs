//! Tests of meshes: flux and image against rays, closed forms and boxes of plates; refusals.

use std::f64::consts::PI;
use std::path::PathBuf;

use nalgebra::Vector2;
use optics::ImagePoint;

use contract::{Direction, PixelPoint};

use super::super::body::LitBody;
use super::super::plate::BoxConfig;
use super::super::{Spacecraft, TargetConfig};
use super::*;

const GREY: SurfaceConfig = SurfaceConfig { diffuse: 0.4, specular: 0.0, roughness: 0.1 };

fn targets() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/targets"))
}

/// Keys of the satellite in `scenarios/targets/`, from one of its files.
fn smallsat(file: &str) -> MeshConfig {
    MeshConfig {
        path: file.to_owned(),
        material_path: file.ends_with("obj").then(|| "smallsat.mtl".to_owned()),
        unit_m: 1.0,
        radius_m: 2.07,
        attitude: TargetAttitudeConfig::default(),
        surface: None,
        materials: Vec::new(),
    }
}

fn satellite() -> Vec<Facet> {
    smallsat("smallsat.obj").load(&targets()).unwrap()
}

fn unit(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z).normalize()
}

/// Poses as directions of the camera and of the Sun: the dish shades the body, the wings shade it and hide
/// it, the Sun is near the horizon of the cells, the nozzle is lit inside.
fn poses() -> [(Vector3<f64>, Vector3<f64>); 4] {
    [
        (unit(0.8, 0.35, 0.5), unit(0.9, -0.3, 0.2)),
        (unit(0.3, -0.9, 0.3), unit(0.5, 0.75, 0.45)),
        (unit(-0.7, 0.2, 0.7), unit(-0.05, -0.5, 0.85)),
        (unit(0.25, 0.2, -0.95), unit(-0.15, 0.3, -0.9)),
    ]
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

/// Triangle of the witness, from corners alone.
struct Triangle {
    corners: [Vector3<f64>; 3],
    normal: Vector3<f64>,
    surface: SurfaceConfig,
}

fn triangles(facets: &[Facet]) -> Vec<Triangle> {
    let triangle = |facet: &Facet| {
        let corners: [Vector3<f64>; 3] = facet.corners_m().collect::<Vec<_>>().try_into().unwrap();
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        Triangle { corners, normal, surface: facet.front }
    };
    facets.iter().map(triangle).collect()
}

/// Distance along a ray at which it meets a triangle from either side (Möller & Trumbore 1997).
fn hit(triangle: &Triangle, from: &Vector3<f64>, ray: &Vector3<f64>) -> Option<f64> {
    let [a, b, c] = &triangle.corners;
    let (ab, ac) = (b - a, c - a);
    let p = ray.cross(&ac);
    let det = ab.dot(&p);
    let t = from - a;
    let u = t.dot(&p) / det;
    let q = t.cross(&ab);
    let v = ray.dot(&q) / det;
    let along = ac.dot(&q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along > 1e-7).then_some(along)
}

/// Flux ratio, and its centre in the image of [`pinhole`] with one pixel per radian, by rays from the camera:
/// a grid of `n` × `n` rays, each with a ray from the first triangle that it meets to the Sun.
fn by_rays(facets: &[Facet], eye_m: Vector3<f64>, sun: Vector3<f64>, n: usize) -> (f64, Vector2<f64>) {
    let triangles = triangles(facets);
    let z = -eye_m.normalize();
    let x = z.cross(&Vector3::new(0.3, 1.0, 0.1)).normalize();
    let y = z.cross(&x);
    let half = facets.iter().map(Facet::reach).fold(0.0, f64::max) / eye_m.norm() * 1.05;
    let step = 2.0 * half / n as f64;
    let mut nearest = vec![(f64::INFINITY, usize::MAX); n * n];
    for (index, triangle) in triangles.iter().enumerate() {
        let cells: Vec<[f64; 2]> = triangle
            .corners
            .iter()
            .map(|corner| {
                let d = corner - eye_m;
                [x, y].map(|axis| (d.dot(&axis) / d.dot(&z) + half) / step)
            })
            .collect();
        let range = |axis: usize| {
            let low = cells.iter().map(|cell| cell[axis]).fold(f64::INFINITY, f64::min);
            let high = cells.iter().map(|cell| cell[axis]).fold(0.0, f64::max);
            (low - 1.0).max(0.0) as usize..((high + 2.0) as usize).min(n)
        };
        for (i, j) in range(1).flat_map(|i| range(0).map(move |j| (i, j))) {
            let ray = direction([&x, &y, &z], [i, j], step, half);
            if let Some(along) = hit(triangle, &eye_m, &ray)
                && along < nearest[i * n + j].0
            {
                nearest[i * n + j] = (along, index);
            }
        }
    }
    let (mut flux, mut moment) = (0.0, Vector2::zeros());
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let (along, index) = nearest[i * n + j];
        let Some(triangle) = triangles.get(index) else { continue };
        let ray = direction([&x, &y, &z], [i, j], step, half);
        let point = eye_m + ray * along;
        let cos_sun = triangle.normal.dot(&sun);
        let is_front = triangle.normal.dot(&ray) < 0.0;
        if cos_sun <= 0.0 || !is_front || triangles.iter().any(|other| hit(other, &point, &sun).is_some()) {
            continue;
        }
        // Solid angle of the cell: step² cos³ of the angle off the axis.
        let cos = ray.dot(&z) / ray.norm();
        let eye = -ray.normalize();
        let light = triangle.surface.reflectance(&sun, &eye, &triangle.normal)
            * cos_sun
            * step
            * step
            * cos
            * cos
            * cos;
        flux += light;
        moment += Vector2::new(ray.dot(&x), ray.dot(&y)) * light;
    }
    (flux, moment / flux)
}

/// Ray through the middle of a cell of the grid, with a depth of 1.
fn direction([x, y, z]: [&Vector3<f64>; 3], [i, j]: [usize; 2], step: f64, half: f64) -> Vector3<f64> {
    let at = |k: usize| (k as f64 + 0.5) * step - half;
    z + x * at(j) + y * at(i)
}

fn image(lit: &LitBody, eye_m: Vector3<f64>, px: f64) -> Vec<ImagePoint> {
    let mut points = Vec::new();
    lit.image(&pinhole(eye_m, px), 1 << 18, &mut points);
    points
}

fn mean(points: &[ImagePoint]) -> Vector2<f64> {
    points.iter().map(|p| Vector2::new(p.position.x, p.position.y) * p.share).sum()
}

#[test]
fn the_flux_of_a_satellite_is_that_of_rays() {
    let facets = satellite();
    for (eye, sun) in poses() {
        let eye_m = eye * 100.0;
        let lit = LitBody::new(&facets, eye_m, sun);
        let (expected, centre) = by_rays(&facets, eye_m, sun, 1000);
        let error = lit.flux_ratio() / expected - 1.0;
        let offset_px = (mean(&image(&lit, eye_m, 2300.0)) - centre * 2300.0).norm();
        assert!(error.abs() < 1e-3, "{error:e}");
        assert!(offset_px < 0.01, "{offset_px} px");
    }
}

/// Corners and triangles of a box, in the order of OBJ.
const BOX: [[f64; 3]; 8] = [
    [-0.4, -0.3, -0.2],
    [0.4, -0.3, -0.2],
    [0.4, 0.3, -0.2],
    [-0.4, 0.3, -0.2],
    [-0.4, -0.3, 0.2],
    [0.4, -0.3, 0.2],
    [0.4, 0.3, 0.2],
    [-0.4, 0.3, 0.2],
];
const FACES: &str = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

fn corners() -> String {
    BOX.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect()
}

/// Keys of a mesh whose triangles have no material.
fn plain(radius_m: f64) -> MeshConfig {
    MeshConfig {
        path: "mesh.obj".to_owned(),
        material_path: None,
        radius_m,
        surface: Some(GREY),
        ..smallsat("smallsat.obj")
    }
}

/// Returns the result of loading a mesh from a text.
fn load(config: &MeshConfig, files: &[(&str, &[u8])]) -> Result<Vec<Facet>, OutOfRange> {
    // A directory per thread of the tests.
    let name = format!("boresight-mesh-{}-{:?}", std::process::id(), std::thread::current().id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, content) in files {
        std::fs::write(folder.join(name), content).unwrap();
    }
    let result = config.load(&folder);
    std::fs::remove_dir_all(&folder).unwrap();
    result
}

fn box_mesh() -> Vec<Facet> {
    let radius_m = Vector3::from(BOX[6]).norm();
    load(&plain(radius_m), &[("mesh.obj", format!("{}{FACES}", corners()).as_bytes())]).unwrap()
}

#[test]
fn a_box_of_triangles_is_the_box_of_plates() {
    let mesh = box_mesh();
    assert_eq!(mesh.len(), 12);
    let plates = BoxConfig { centre_m: [0.0; 3], size_m: [0.8, 0.6, 0.4], surface: GREY }.plates().unwrap();
    for (eye, sun) in poses() {
        for range_m in [3.0, 100.0, 30_000.0] {
            let eye_m = eye * range_m;
            let [of_mesh, of_plates] =
                [&mesh[..], &plates[..]].map(|facets| LitBody::new(facets, eye_m, sun));
            // The quadrature of two triangles differs from that of their rectangle by perspective.
            let error = of_mesh.flux_ratio() / of_plates.flux_ratio() - 1.0;
            assert!(error.abs() < 1e-3 / (range_m * range_m) + 1e-12, "{error:e} at {range_m} m");
            let offset = mean(&image(&of_mesh, eye_m, 2300.0)) - mean(&image(&of_plates, eye_m, 2300.0));
            assert!(offset.norm() < 2e-3, "{offset} px at {range_m} m");
        }
    }
}

/// Icosahedron whose triangles are divided into four, `levels` times, with all corners on the unit sphere.
fn icosphere(levels: u32) -> Vec<Facet> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut triangles = Vec::new();
    let corner = |i: usize| {
        let (one, other) = ([1.0, -1.0][i % 2], [golden, -golden][i / 2 % 2]);
        match i / 4 {
            0 => unit(0.0, one, other),
            1 => unit(one, other, 0.0),
            _ => unit(other, 0.0, one),
        }
    };
    for (a, b, c) in (0..12).flat_map(|a| (0..12).flat_map(move |b| (0..12).map(move |c| (a, b, c)))) {
        let [a, b, c] = [a, b, c].map(corner);
        // Neighbours are 63.4 degrees apart. Each triangle is found once, from its lowest corner by name.
        let near =
            |one: &Vector3<f64>, other: &Vector3<f64>| (one.dot(other) - 1.0 / 5.0_f64.sqrt()).abs() < 1e-9;
        let key = |v: &Vector3<f64>| [v.x, v.y, v.z];
        if near(&a, &b) && near(&b, &c) && near(&c, &a) && key(&a) < key(&b) && key(&a) < key(&c) {
            let is_outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
            triangles.extend(is_outward.then_some([a, b, c]));
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..levels {
        let divide = |[a, b, c]: [Vector3<f64>; 3]| {
            let [ab, bc, ca] = [a + b, b + c, c + a].map(|middle| middle.normalize());
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(divide).collect();
    }
    closure::check(&triangles).unwrap();
    triangles.into_iter().filter_map(|triangle| Facet::triangle(triangle, GREY)).collect()
}

#[test]
fn an_icosphere_tends_to_the_sphere() {
    let far_m = 1e7;
    let eye = unit(0.3, 0.2, 0.4);
    let across = eye.cross(&Vector3::y()).normalize();
    for phase_deg in [0.0_f64, 45.0, 90.0, 120.0] {
        let (sin, cos) = libm::sincos(phase_deg.to_radians());
        let sun = eye * cos + across * sin;
        let expected = GREY.diffuse * 2.0 / 3.0 * super::super::lambert_phase(phase_deg.to_radians());
        let errors = [2, 3, 4].map(|levels| {
            LitBody::new(&icosphere(levels), eye * far_m, sun).flux_ratio() * far_m * far_m / expected - 1.0
        });
        // The corners are on the sphere: the error falls by about four per level, and the terminator moves
        // between triangles.
        for (error, limit) in errors.into_iter().zip([0.03, 8e-3, 2.5e-3]) {
            assert!(error.abs() < limit, "{errors:?} at {phase_deg}°");
        }
    }
}

/// From resolved to point, the image keeps the flux of the integral, and its centre that of fine cells.
#[test]
fn nothing_jumps_between_100_m_and_30_km() {
    let facets = satellite();
    let (eye, sun) = poses()[1];
    let mut counts = std::collections::BTreeSet::new();
    let mut last: Option<(f64, Vector2<f64>)> = None;
    let mut range_m = 100.0;
    while range_m < 30_000.0 {
        let eye_m = eye * range_m;
        let lit = LitBody::new(&facets, eye_m, sun);
        let flux = lit.flux_ratio();
        // Centre of brightness in metres at the body, by cells of 0.1 % of the body.
        let scale = 2300.0 / range_m;
        let exact = lit.centre(&pinhole(eye_m, 300.0 * range_m)) / 300.0;
        // 4 m are a pixel at 9.2 km with the first lens, and at 600 m with the second.
        for px in [2300.0, 150.0] {
            let points = image(&lit, eye_m, px);
            counts.insert(points.len());
            let cells = lit.cells_flux(&pinhole(eye_m, px));
            assert!((cells / flux - 1.0).abs() < 1e-3, "{} at {range_m} m", cells / flux);
            let offset_px = (mean(&points) - exact * px / range_m).norm();
            assert!(offset_px < 0.01, "{offset_px} px at {range_m} m");
            let shares: f64 = points.iter().map(|point| point.share).sum();
            assert!((shares - 1.0).abs() < 1e-12, "{shares}");
        }
        let light = flux * range_m * range_m;
        if let Some((was_light, was_exact)) = last {
            // Perspective changes the visible part by 2 % of body over range per step.
            assert!((light / was_light - 1.0).abs() < 2e-3, "{} at {range_m} m", light / was_light);
            assert!((exact - was_exact).norm() * scale < 0.02, "{exact} at {range_m} m");
        }
        last = Some((light, exact));
        range_m *= 1.05;
    }
    assert!(counts.contains(&1) && counts.contains(&4) && counts.len() > 50, "{counts:?}");
}

#[test]
fn the_peak_is_that_of_the_image() {
    let facets = satellite();
    for (eye, sun) in poses() {
        for range_m in [100.0, 1000.0, 10_000.0] {
            let eye_m = eye * range_m;
            let lit = LitBody::new(&facets, eye_m, sun);
            let share = lit.peak_share(&pinhole(eye_m, 2300.0), 0.2).unwrap();
            // A Gaussian with 0.2 of its flux in the central pixel: 0.2 exp(−0.2 π r²).
            let points = image(&lit, eye_m, 2300.0);
            let at = |x: f64, y: f64| {
                points.iter().map(move |p| {
                    let d = Vector2::new(p.position.x - x, p.position.y - y).norm_squared();
                    p.share * 0.2 * libm::exp(-PI * 0.2 * d)
                })
            };
            let brightest = points
                .iter()
                .step_by(points.len() / 200 + 1)
                .map(|p| at(p.position.x, p.position.y).sum::<f64>())
                .fold(0.0, f64::max);
            assert!((0.7..1.6).contains(&(share / brightest)), "{share} {brightest} at {range_m} m");
        }
    }
}

#[test]
fn both_files_are_one_satellite() {
    let [obj, glb] = ["smallsat.obj", "smallsat.glb"].map(|file| smallsat(file).load(&targets()).unwrap());
    assert_eq!(obj.len(), glb.len());
    // Facets of equal area may be in another order.
    let middle = |facet: &Facet| facet.corners_m().sum::<Vector3<f64>>() / 3.0;
    for facet in &obj {
        let near = |other: &&Facet| {
            (middle(facet) - middle(other)).norm() < 1e-6 && (facet.normal - other.normal).norm() < 1e-3
        };
        let other = glb.iter().find(near).unwrap();
        let [one, other] = [facet, other].map(|f| [f.front.diffuse, f.front.specular, f.front.roughness]);
        assert!((Vector3::from(one) - Vector3::from(other)).amax() < 1e-6, "{one:?} {other:?}");
    }
    // The table of `make_smallsat.py`.
    let cells = SurfaceConfig { diffuse: 0.05, specular: 0.12, roughness: 0.05 };
    let share = |facets: &[Facet]| {
        let is_of_cells = |facet: &&Facet| (facet.front.specular - cells.specular).abs() < 1e-6;
        facets.iter().filter(is_of_cells).map(Facet::area).sum::<f64>()
    };
    // Six panels of 0.5 m by 0.7 m.
    assert!((share(&obj) - 2.1).abs() < 1e-9 && (share(&glb) - 2.1).abs() < 1e-6);
    let darker = MaterialConfig { name: "cells".to_owned(), surface: GREY };
    let changed = MeshConfig { materials: vec![darker], ..smallsat("smallsat.glb") };
    let facets = changed.load(&targets()).unwrap();
    assert!((facets.iter().filter(|f| f.front == GREY).map(Facet::area).sum::<f64>() - 2.1).abs() < 1e-6);
}

#[test]
fn colours_become_reflectances() {
    // Pure green has the luminance 0.7152. Phong's exponent 198 is α = (2/200)^½.
    let phong = material::from_phong([0.0, 1.0, 0.0], [0.1; 3], 198.0).unwrap();
    assert!((phong.diffuse - 0.7152).abs() < 1e-12 && (phong.specular - 0.1).abs() < 1e-12);
    assert!((phong.roughness - 0.1).abs() < 1e-12);
    assert!(material::from_phong([0.9; 3], [0.2; 3], 10.0).unwrap_err().contains("more than 1"));
    assert!(material::from_phong([0.1; 3], [0.0; 3], f64::NAN).unwrap_err().contains("Ns"));
    let metal = material::from_metallic_roughness([0.5; 3], 1.0, 0.5).unwrap();
    assert_eq!([metal.diffuse, metal.specular, metal.roughness], [0.0, 0.5, 0.25]);
    let paint = material::from_metallic_roughness([0.5; 3], 0.0, 1.0).unwrap();
    assert!((paint.diffuse - 0.48).abs() < 1e-12 && (paint.specular - 0.04).abs() < 1e-12);
    assert_eq!(paint.roughness, 0.6);
}

/// Faults of OBJ files. Each entry is the text, and a part of the message.
#[test]
fn faulty_obj_files_are_refused_by_name() {
    let all = corners();
    let with = |faces: &str| format!("{all}{faces}");
    let turned = FACES.replace("f 1 4 3 2", "f 1 2 3 4");
    let inside_out: String = FACES
        .lines()
        .map(|line| {
            let mut words: Vec<&str> = line.split(' ').skip(1).collect();
            words.reverse();
            format!("f {}\n", words.join(" "))
        })
        .collect();
    let cases = [
        (String::new(), "without triangles"),
        (all.clone(), "without triangles"),
        (with(&FACES.replace("f 4 1 5 8\n", "")), "open edges, the first at the triangle"),
        (with(&turned), "inconsistent winding at 4 edges"),
        (with(&inside_out), "inside out"),
        (with("f 1 2 99\n"), "index out of range"),
        (with("f 1 2 0\n"), "index out of range"),
        (with("f 1 2 -99\n"), "index out of range"),
        (with("f 1 2 x\n"), "line 9 of which is no face"),
        (with("f 1 2\n"), "a face of which has 2 corners"),
        (with("f 1 1 1\n"), "all have no area"),
        (format!("v nan 0 0\n{all}{}", FACES), "corner at (NaN, 0, 0)"),
        (format!("{}{FACES}", all.replace("-0.4", "inf")), "corner at (inf, -0.3, -0.2)"),
        (with("v 1 2\n"), "line 9 of which is no corner"),
        (with("v 1 2 3 0.5 0.5 0.5\n"), "line 9 of which has a colour"),
        (with("l 1 2\n"), "line 9 of which is a statement `l`"),
        (with("curv2 1 2\n"), "statement `curv2`"),
        (with("f 1 2 \\\n3\n"), "goes on in the next line"),
        (with("v 0.1 0 -0.2\nf 2 9 3 4 1\n"), "is not convex"),
        (with(&"f 1 2 3\n".repeat(10_001)), "a mesh of 10001 triangles"),
        (format!("{}{FACES}", all.replace("0.", "400.")), "target.radius_m is"),
        (
            format!("mtllib box.mtl\n{all}usemtl foil\n{FACES}"),
            "material \"foil\": it is in the material library \"box.mtl\"",
        ),
        (format!("{all}usemtl foil\n{FACES}"), "the file names no material library"),
    ];
    let radius_m = Vector3::from(BOX[6]).norm();
    for (text, expected) in cases {
        let message = load(&plain(radius_m), &[("mesh.obj", text.as_bytes())]).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\nexpected {expected}");
        assert!(message.starts_with("target.") && message.contains(", expected "), "{message}");
    }
    let message = load(&plain(radius_m), &[("mesh.obj", &[0xff, 0xfe])]).unwrap_err().to_string();
    assert!(message.contains("is no text"), "{message}");
}

/// Change of the keys of a mesh.
type Change = fn(&mut MeshConfig);

/// Faults of the keys, and of material libraries: the change of the keys, the library, and the message.
#[test]
fn faulty_keys_and_materials_are_refused_by_name() {
    let mesh = format!("{}usemtl foil\n{FACES}", corners());
    let radius_m = Vector3::from(BOX[6]).norm();
    let key = |change: Change| {
        let mut config = MeshConfig { material_path: Some("mesh.mtl".to_owned()), ..plain(radius_m) };
        change(&mut config);
        config
    };
    fn none(_: &mut MeshConfig) {}
    let fine = "newmtl foil\nKd 0.5 0.5 0.5\n";
    let cases: [(Change, &str, &str); 18] = [
        (|c| c.path = "absent.obj".to_owned(), fine, "absent.obj (No such file"),
        (|c| c.path = "mesh.stl".to_owned(), fine, "expected a file named .obj"),
        (|c| c.unit_m = 0.001, fine, "it is 0.000539 m with unit_m = 0.001"),
        (|c| c.radius_m = 0.6, fine, "target.radius_m is 0.6, expected the distance of the farthest corner"),
        (|c| c.material_path = Some("absent.mtl".to_owned()), fine, "target.material_path is absent.mtl"),
        (
            |c| c.materials = vec![MaterialConfig { name: "fiol".to_owned(), surface: GREY }],
            fine,
            "target.materials[0].name is fiol, expected a material of mesh.obj: \"foil\"",
        ),
        (
            |c| {
                c.materials = vec![MaterialConfig {
                    name: "foil".to_owned(),
                    surface: SurfaceConfig { diffuse: 0.9, specular: 0.2, roughness: 0.1 },
                }]
            },
            fine,
            "target.materials[0].surface.specular is 0.2",
        ),
        (none, "", "without a material"),
        (none, "newmtl other\nKd 0.5 0.5 0.5\n", "it is not in the library"),
        (none, "newmtl foil\nKs 0.5 0.5 0.5\n", "no diffuse colour (Kd)"),
        (none, "newmtl foil\nKd 0.9 0.9 0.9\nKs 0.5 0.5 0.5\n", "more than 1"),
        (none, "newmtl foil\nKd 0.5 0.5 0.5\nmap_Kd foil.png\n", "it has the texture \"foil.png\""),
        (none, "newmtl foil\nKd 0.5 0.5 0.5\nmap_refl foil.png\n", "it has a texture (map_refl)"),
        (none, "newmtl foil\nKd 0.5 0.5 0.5\nKe 1 1 1\n", "it emits light (Ke)"),
        (none, "newmtl foil\nKd 0.5 0.5 0.5\nd 0.5\n", "it is transparent (d)"),
        (none, "newmtl foil\nKd 0.5 0.5 0.5\nTr 0.5\n", "it is transparent (Tr)"),
        (none, "newmtl foil\nKd x y z\n", "which cannot be read"),
        (none, "newmtl foil\nKd 0.5 0.5\n", "line 2 of which is no colour"),
    ];
    for (change, library, expected) in cases {
        let files =
            [("mesh.obj", mesh.as_bytes()), ("mesh.mtl", library.as_bytes()), ("mesh.stl", b"".as_slice())];
        let message = load(&key(change), &files).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\nexpected {expected}");
    }
    let without = MeshConfig { surface: None, ..plain(radius_m) };
    let message = load(&without, &[("mesh.obj", format!("{}{FACES}", corners()).as_bytes())]).unwrap_err();
    assert!(message.to_string().contains("target.surface is absent"), "{message}");
}

/// Returns the satellite's .glb with a text of its JSON replaced by another of any length.
fn glb_with(from: &str, to: &str) -> Vec<u8> {
    let bytes = std::fs::read(targets().join("smallsat.glb")).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let text = std::str::from_utf8(&bytes[20..20 + length]).unwrap();
    assert!(text.contains(from), "{from}");
    let mut text = text.replacen(from, to, 1);
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let rest = &bytes[20 + length..];
    let mut out = b"glTF".to_vec();
    for number in [2, 20 + text.len() + rest.len(), text.len()] {
        out.extend((number as u32).to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(text.as_bytes());
    out.extend(rest);
    out
}

/// Faults of glTF files. Each entry is the replaced text, its replacement, and a part of the message.
#[test]
fn faulty_glb_files_are_refused_by_name() {
    let cases = [
        ("\"scene\":0,\"scenes\":[{\"nodes\":[0]}],", "", "without a scene"),
        ("\"scenes\":[{\"nodes\":[0]}]", "\"scenes\":[{\"nodes\":[]}]", "without triangles"),
        ("\"name\":\"smallsat\",\"mesh\":0}],", "\"children\":[0]}],", "has a circle"),
        ("\"indices\":1", "\"mode\":5,\"indices\":1", "primitive of the mode TriangleStrip"),
        ("{\"POSITION\":0}", "{\"POSITION\":999}", "accessor that it does not have"),
        ("{\"POSITION\":0}", "{\"POSITION\":0,\"COLOR_0\":0}", "colours of corners"),
        ("\"indices\":1", "\"indices\":1,\"targets\":[{\"POSITION\":0}]", "morph targets"),
        (
            "\"scene\":0",
            "\"scene\":0,\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"]",
            "the extension EXT_mesh",
        ),
        (
            "\"scene\":0",
            "\"scene\":0,\"extensionsUsed\":[\"KHR_materials_ior\"]",
            "uses the extension KHR_materials_ior",
        ),
        (
            "\"scene\":0",
            "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
            "cannot be read",
        ),
        ("\"scene\":0", "\"scene\":0,\"animations\":[{\"channels\":[],\"samplers\":[]}]", "animations"),
        ("\"scene\":0", "\"scene\":0,\"skins\":[{\"joints\":[0]}]", "skins"),
        ("\"name\":\"black\"", "\"name\":\"black\",\"emissiveFactor\":[1,0,0]", "it emits light"),
        ("\"name\":\"black\"", "\"name\":\"black\",\"alphaMode\":\"BLEND\"", "it is transparent"),
        (
            "\"byteOffset\":0,\"byteLength\":",
            "\"byteOffset\":0,\"byteLength\":99999",
            "accessor beyond its data",
        ),
        ("\"buffers\":[{", "\"buffers\":[{\"uri\":\"a.bin\",", "data in another file"),
        ("\"nodes\":[{\"name\":\"smallsat\",", "\"nodes\":[{\"scale\":[2,2,2],", "target.radius_m is 2.07"),
        ("\"componentType\":5123", "\"componentType\":5126", "indices that are no unsigned integers"),
    ];
    let config = MeshConfig { path: "mesh.glb".to_owned(), ..smallsat("smallsat.glb") };
    for (from, to, expected) in cases {
        let message = load(&config, &[("mesh.glb", &glb_with(from, to))]).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\nexpected {expected}");
    }
    for bytes in [b"".as_slice(), b"glTF", b"glTF\x02\0\0\0\0\0\0\0", b"{\"asset\":{\"version\":\"2.0\"}}"] {
        let message = load(&config, &[("mesh.glb", bytes)]).unwrap_err().to_string();
        assert!(message.contains("does not begin as a .glb file"), "{message}");
    }
    let library = MeshConfig { material_path: Some("a.mtl".to_owned()), ..config };
    assert!(load(&library, &[]).unwrap_err().to_string().contains("glTF holds its materials"));
}

#[test]
fn nodes_of_a_scene_are_placed_and_reflected() {
    let config = MeshConfig { path: "mesh.glb".to_owned(), ..smallsat("smallsat.glb") };
    let original = config.load(&targets().join("../targets")).err();
    assert!(original.is_some(), "mesh.glb is not there");
    let at_rest = smallsat("smallsat.glb").load(&targets()).unwrap();
    // A half turn about z, and a mirror in x: the sum is the body mirrored in y.
    let node = "\"nodes\":[{\"rotation\":[0,0,1,0],\"scale\":[-1,1,1],";
    let bytes = glb_with("\"nodes\":[{", node);
    let placed = load(&config, &[("mesh.glb", &bytes)]).unwrap();
    let (eye, sun) = poses()[0];
    let mirror = |v: Vector3<f64>| Vector3::new(v.x, -v.y, v.z);
    let light = LitBody::new(&at_rest, eye * 100.0, sun).flux_ratio();
    let mirrored = LitBody::new(&placed, mirror(eye) * 100.0, mirror(sun)).flux_ratio();
    assert!((mirrored / light - 1.0).abs() < 1e-6, "{}", mirrored / light);
}

#[test]
fn a_mesh_hides_stars_and_must_not_hold_the_camera() {
    let config = smallsat("smallsat.obj");
    let target = Spacecraft::load(&TargetConfig::Mesh(config), &targets()).unwrap();
    let at = |eye_m: Vector3<f64>| target.outline(&(eye_m * 1e-3), None).unwrap();
    // Inside the body, in the gap between body and wing, and in a panel.
    for (x, y, is_inside) in [(0.1, 0.2, true), (0.2, 0.4, false), (0.0, 0.7, true), (0.05, 0.7, false)] {
        assert_eq!(at(Vector3::new(x, y, 0.1)).holds_camera(), is_inside, "({x}, {y})");
    }
    // From 50 m in front of the panels, along x: the middle panel, the gap beside it, the boom in the gap.
    let eye_m = Vector3::new(50.0, 0.0, 0.0);
    let outline = at(eye_m);
    for (y, z, is_hidden) in [(1.27, 0.1, true), (1.01, 0.1, false), (1.01, 0.0, true), (1.27, 0.5, false)] {
        let star = Direction::from_vector(Vector3::new(0.0, y, z) - eye_m).unwrap();
        assert_eq!(outline.hides(&star), is_hidden, "({y}, {z})");
        assert!(outline.is_near(&star));
    }
}

/// Returns the next number of a linear congruential sequence (Knuth, MMIX), its upper bits below `limit`.
fn next(state: &mut u64, limit: usize) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*state >> 33) as usize) % limit
}

/// Files with changed bytes and numbers are read or refused; no reader panics.
#[test]
fn changed_files_end_no_reader() {
    let glb = std::fs::read(targets().join("smallsat.glb")).unwrap();
    let obj = format!("newmtl foil\nKd 0.5 0.5 0.5\nNs 10\n{}usemtl foil\n{FACES}", corners()).into_bytes();
    let numbers: [&[u8]; 8] =
        [b"0", b"-1", b"4294967295", b"18446744073709551615", b"1e308", b"nan", b"65535", b""];
    let (mut state, mut read, mut refused) = (1, 0, 0);
    for round in 0..6000 {
        let name = ["mesh.glb", "mesh.obj"][round % 2];
        let mut bytes = [&glb, &obj][round % 2].clone();
        // Of the glTF file, mostly the first chunk: the JSON text.
        let reach = if round % 3 == 0 { bytes.len() } else { bytes.len().min(3000) };
        for _ in 0..=next(&mut state, 3) {
            let at = next(&mut state, reach.min(bytes.len()));
            let end = at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
            if end > at {
                // The number keeps its length in the glTF file, whose chunks have stated lengths.
                let mut number = numbers[next(&mut state, numbers.len())].to_vec();
                if round % 2 == 0 {
                    number.resize(end - at, b'0');
                }
                bytes.splice(at..end, number);
            } else {
                bytes[at] = next(&mut state, 256) as u8;
            }
        }
        let mut config = MeshConfig { path: name.to_owned(), ..plain(0.5385) };
        config.material_path = (round % 2 == 1).then(|| name.to_owned());
        config.radius_m = if round % 2 == 1 { 0.5385 } else { 2.07 };
        match load(&config, &[(name, &bytes)]) {
            Ok(facets) => read += usize::from(!facets.is_empty()),
            Err(_) => refused += 1,
        }
    }
    assert!(read > 100 && refused > 1000, "{read} read, {refused} refused");
}
