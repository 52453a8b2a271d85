//! Tests of target files: the scenes that they produce, the models that pipelines receive, and the values
//! that are rejected.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::{Body, DockingScene, Facet, MarkQuad, Part, TargetFile};

fn progress() -> TargetFile {
    TargetFile::built_in("progress").unwrap()
}

fn every_target() -> impl Iterator<Item = TargetFile> {
    TargetFile::built_in_names().map(|name| TargetFile::built_in(name).unwrap())
}

fn part<'a>(scene: &'a DockingScene, name: &str) -> &'a Part {
    scene.parts.iter().find(|part| part.name == name).unwrap()
}

/// Vector area of a closed polygon, along its normal: half of Newell's sum.
fn area_vector(ring: &[Vector3<f64>]) -> Vector3<f64> {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    edges.map(|(a, b)| (a - ring[0]).cross(&(b - ring[0]))).sum::<Vector3<f64>>() / 2.0
}

/// Area of a facet less its holes, which have the opposite orientation.
fn area(facet: &Facet) -> f64 {
    let rings = std::iter::once(&facet.outer).chain(&facet.holes);
    rings.map(|ring| area_vector(ring).dot(&facet.normal)).sum()
}

fn assert_near(value: f64, expected: f64, relative: f64) {
    assert!((value / expected - 1.0).abs() < relative, "{value}, expected {expected}");
}

#[test]
fn every_built_in_target_is_allowed_and_bears_its_name() {
    for name in TargetFile::built_in_names() {
        let target: TargetFile = toml::from_str(TargetFile::built_in_text(name).unwrap()).unwrap();
        target.check().unwrap();
        assert_eq!(target.name, name);
    }
    assert!(TargetFile::built_in("soyuz").is_none());
}

#[test]
fn a_target_is_the_same_after_writing_and_reading() {
    for target in every_target() {
        let text = toml::to_string(&target).unwrap();
        assert_eq!(toml::from_str::<TargetFile>(&text).unwrap(), target);
    }
}

#[test]
fn facets_are_flat_and_turn_about_their_outward_normals() {
    for target in every_target() {
        for (part, facet) in
            target.scene().parts.iter().flat_map(|part| part.facets.iter().map(move |facet| (part, facet)))
        {
            let name = format!("{} of {}", part.name, target.name);
            assert!((facet.normal.norm() - 1.0).abs() < 1e-12, "{name}");
            assert!((0.0..=1.0).contains(&facet.reflectance), "{name}");
            let outer = area_vector(&facet.outer);
            assert!((outer.normalize() - facet.normal).norm() < 1e-9, "{name}: {:?}", facet.normal);
            for hole in &facet.holes {
                let hole = area_vector(hole);
                assert!((hole.normalize() + facet.normal).norm() < 1e-9, "{name}: hole");
                assert!(hole.norm() < outer.norm(), "{name}: hole larger than the facet");
            }
            // 1e-9 m over tens of metres is about a thousand rounding errors.
            for corner in facet.outer.iter().chain(facet.holes.iter().flatten()) {
                assert!(facet.normal.dot(&(corner - facet.outer[0])).abs() < 1e-9, "{name}");
            }
        }
    }
}

#[test]
fn a_scene_is_small_enough_to_draw_a_hundred_times_a_second() {
    for target in every_target() {
        let scene = target.scene();
        let facets: usize = scene.parts.iter().map(|part| part.facets.len()).sum();
        assert!(facets < 1500, "{}: {facets}", target.name);
    }
}

#[test]
fn plate_and_marks_share_the_area_of_the_disk() {
    for target in every_target() {
        let marks = target.model().marks.len();
        let scene = target.scene();
        let plate = part(&scene, "plate");
        assert_eq!(plate.facets.len(), 1 + marks);
        assert_eq!(plate.facets[0].holes.len(), marks);
        let disk = PI * target.plate.radius_m * target.plate.radius_m;
        assert_near(plate.facets.iter().map(area).sum(), disk, 1e-12);
    }
    let scene = progress().scene();
    for mark in &part(&scene, "plate").facets[1..] {
        assert_near(area(mark), 0.040 * 0.012, 1e-12);
    }
}

#[test]
fn measured_circles_are_round_to_ten_micrometres() {
    let target = progress();
    let scene = target.scene();
    let circles = [
        (&part(&scene, "plate").facets[0].outer, [0.0, 0.0], target.plate.radius_m),
        (&part(&scene, "docking ring").facets[0].outer, target.docking_unit.axis_m, 0.66),
        (&part(&scene, "docking ring").facets[0].holes[0], target.docking_unit.axis_m, 0.52),
    ];
    for (ring, centre, radius) in circles {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            for point in [*a, (a + b) / 2.0] {
                let distance = libm::hypot(point.x - centre[0], point.y - centre[1]);
                assert!((distance - radius).abs() < 1e-5, "{distance} from the centre, not {radius}");
            }
        }
    }
}

#[test]
fn areas_are_those_of_the_shapes() {
    let target = progress();
    let scene = target.scene();
    let total = |name: &str| part(&scene, name).facets.iter().map(area).sum::<f64>();
    let circle = |radius: f64| PI * radius * radius;
    // Two bars of 0.30 by 0.03 minus their common square; four ends and eight flanks of thickness 0.01 m.
    assert_near(total("cross"), 2.0 * 0.30 * 0.03 - 0.03 * 0.03, 1e-12);
    assert_near(total("cross edges"), 0.01 * (4.0 * 0.03 + 8.0 * (0.15 - 0.015)), 1e-12);
    assert_near(total("docking ring"), circle(0.66) - circle(0.52), 1e-9);
    assert_near(total("station face"), circle(2.05) - circle(0.52), 1e-9);
    // Eight blocks without their backs.
    assert_near(total("docking blocks"), 8.0 * (0.06 * 0.06 + 4.0 * 0.06 * 0.05), 1e-12);
    // Walls of n sides: the circumference of the polygon with the circle's area is larger by π²/(6 n²), which
    // is 0.7 % for 16 sides.
    assert_near(total("post"), 2.0 * PI * 0.010 * 0.29, 0.007);
    assert_near(total("docking wall"), 2.0 * PI * 0.66 * 0.35, 0.0005);
    let slant = libm::hypot(0.40 - 0.06, 0.55 - 0.06);
    assert_near(total("docking cone"), PI * (0.40 + 0.06) * slant + circle(0.06), 0.001);
}

/// A closed body has no net vector area; that of a body open only towards the station faces the front.
#[test]
fn bodies_are_closed_but_for_their_backs() {
    let net = |part: &Part| part.facets.iter().map(|facet| facet.normal * area(facet)).sum::<Vector3<f64>>();
    let target = progress();
    let scene = target.scene();
    for (i, body) in target.fittings.as_ref().unwrap().body.iter().enumerate() {
        let part = part(&scene, &format!("fitting {i}"));
        let closed = match body {
            Body::Cylinder { from_m, to_m, .. } => from_m[..2] != to_m[..2],
            Body::Box { .. } | Body::Panel { .. } => false,
        };
        let front: f64 = part.facets.iter().filter(|f| f.normal.z == 1.0).map(area).sum();
        let expected = if closed { Vector3::zeros() } else { Vector3::z() * front };
        assert!((net(part) - expected).norm() < 1e-12, "{}: {}", part.name, net(part));
    }
}

#[test]
fn blankets_are_apart_from_each_other_and_clear_of_the_docking_unit() {
    let target = progress();
    let scene = target.scene();
    let tiles = &part(&scene, "blankets").facets;
    assert!(tiles.len() > 100);
    let crosses = |a: &Facet, b: &Facet| {
        let side = |p: &Vector3<f64>, q: &Vector3<f64>, r: &Vector3<f64>| (q - p).cross(&(r - p)).z > 0.0;
        let edges = |f: &Facet| -> Vec<_> {
            f.outer.iter().copied().zip(f.outer.iter().copied().cycle().skip(1)).collect()
        };
        edges(a).iter().any(|(p, q)| {
            edges(b).iter().any(|(r, s)| side(p, q, r) != side(p, q, s) && side(r, s, p) != side(r, s, q))
        })
    };
    let centre = |f: &Facet| f.outer.iter().sum::<Vector3<f64>>() / f.outer.len() as f64;
    for (i, a) in tiles.iter().enumerate() {
        for b in &tiles[i + 1..] {
            // No tile contains another: the tiles are of similar size, and their centres are apart.
            assert!(!crosses(a, b) && (centre(a) - centre(b)).norm() > 0.1);
        }
        let axis = Vector3::new(0.0, -1.25, a.outer[0].z);
        for corner in &a.outer {
            let radius = (corner - axis).norm();
            assert!(radius > 0.66 && radius < 2.0, "a tile's corner {radius} m from the axis");
        }
        assert!((0.22..=0.46).contains(&a.reflectance));
    }
}

#[test]
fn the_layout_of_the_blankets_is_its_seeds() {
    let tiles = |target: &TargetFile| part(&target.scene(), "blankets").facets.clone();
    let mut target = progress();
    let first = tiles(&target);
    assert_eq!(first, tiles(&target));
    // A change of the plate or the cross leaves the tiles unchanged; a change of the seed does not.
    target.plate.radius_m = 0.4;
    target.cross.height_m = 0.35;
    assert_eq!(first, tiles(&target));
    target.station.blankets.as_mut().unwrap().seed += 1;
    assert_ne!(first, tiles(&target));
}

#[test]
fn a_pipeline_receives_the_values_of_the_file() {
    let target = progress();
    let model = target.model();
    assert_eq!(
        (model.name.as_str(), model.plate_radius_m, model.mark_circle_radius_m),
        ("progress", 0.30, 0.25)
    );
    assert_eq!(model.marks.len(), 12);
    for (i, mark) in model.marks.iter().enumerate() {
        let mean = |axis: usize| mark.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
        let (sin, cos) = libm::sincos((30.0 * i as f64).to_radians());
        assert!((mean(0) - 0.25 * cos).abs() < 1e-15 && (mean(1) - 0.25 * sin).abs() < 1e-15, "mark {i}");
    }
    let cross =
        (model.cross.height_m, model.cross.half_length_m, model.cross.width_m, model.cross.thickness_m);
    assert_eq!(cross, (0.30, 0.15, 0.030, 0.010));
    let outline = |outline: contract::docking::Outline| (outline.centre_m, outline.radius_m, outline.depth_m);
    assert_eq!(outline(model.docking_unit), ([0.0, -1.25], 0.66, 0.10));
    assert_eq!(outline(model.station), ([0.0, -1.25], 2.05, 0.45));
}

/// The marks of a pipeline's model are the drawn marks, in the same order.
#[test]
fn marks_are_drawn_where_the_model_has_them() {
    for target in every_target() {
        let scene = target.scene();
        for (mark, facet) in target.model().marks.iter().zip(&part(&scene, "plate").facets[1..]) {
            let corners: Vec<[f64; 2]> = facet.outer.iter().map(|p| [p.x, p.y]).collect();
            assert_eq!(corners, mark);
        }
    }
}

/// LM-10 Through LM-14 Vehicle Familiarization Manual: base diameter 17.68 in, cross 15 in above the base.
#[test]
fn the_lunar_modules_target_has_the_manuals_figures() {
    let model = TargetFile::built_in("apollo").unwrap().model();
    assert!((2.0 * model.plate_radius_m - 17.68 * 0.0254).abs() < 1e-9);
    assert!((model.cross.height_m - 15.0 * 0.0254).abs() < 1e-9);
}

/// The mean circle of single marks passes through their centres: bars 0.12 m out, squares at 0.085 m along
/// both axes.
#[test]
fn single_marks_have_a_mean_circle() {
    let radius = TargetFile::built_in("idss").unwrap().model().mark_circle_radius_m;
    assert!((radius - (0.12 + libm::hypot(0.085, 0.085)) / 2.0).abs() < 1e-12, "{radius}");
}

#[test]
fn every_optional_table_may_be_missing() {
    let mut target = progress();
    target.marks = None;
    target.fittings = None;
    target.structure = None;
    target.station.blankets = None;
    target.docking_unit.blocks = None;
    let text = toml::to_string(&target).unwrap();
    let target: TargetFile = toml::from_str(&text).unwrap();
    target.check().unwrap();
    let names: Vec<String> = target.scene().parts.into_iter().map(|part| part.name).collect();
    assert_eq!(
        names,
        [
            "station wall",
            "station face",
            "docking cone",
            "docking flange",
            "docking wall",
            "docking ring",
            "plate",
            "post",
            "cross edges",
            "cross"
        ]
    );
    let model = target.model();
    assert!(model.marks.is_empty());
    assert_eq!(model.mark_circle_radius_m, 0.30);
}

#[test]
fn bad_values_are_refused_with_their_path() {
    let refused = |path: &str, change: fn(&mut TargetFile)| {
        let mut target = progress();
        change(&mut target);
        let message = target.check().unwrap_err().to_string();
        assert!(message.starts_with(&format!("{path} is ")), "{path}: {message}");
        assert!(message.contains(", expected "), "{message}");
    };
    refused("name", |t| t.name = " ".to_owned());
    refused("contact.source", |t| t.contact.source.clear());
    refused("contact.camera_to_disk_m", |t| t.contact.camera_to_disk_m = 0.3);
    refused("plate.source", |t| t.plate.source.clear());
    refused("plate.radius_m", |t| t.plate.radius_m = 0.0);
    refused("plate.radius_m", |t| t.plate.radius_m = f64::NAN);
    refused("plate.reflectance", |t| t.plate.reflectance = 1.1);
    refused("marks.reflectance", |t| t.marks.as_mut().unwrap().reflectance = -0.1);
    refused("marks.ring.circle_radius_m", |t| ring(t).circle_radius_m = 0.29);
    refused("marks.ring.circle_radius_m", |t| ring(t).circle_radius_m = 0.0);
    refused("marks.ring.length_m", |t| ring(t).length_m = 0.5);
    refused("marks.ring.width_m", |t| ring(t).width_m = f64::INFINITY);
    refused("marks.ring.first_angle_deg", |t| ring(t).first_angle_deg = 400.0);
    refused("marks.ring.count", |t| ring(t).count = 0);
    refused("marks.ring.count", |t| ring(t).width_m = 0.15);
    refused("number of marks", |t| t.marks.as_mut().unwrap().ring = None);
    refused("marks.quad[0].corners_m[3][1]", |t| {
        quad(t, [[0.0, 0.1], [0.01, 0.1], [0.01, 0.11], [0.0, f64::NAN]])
    });
    refused("marks.quad[0].corners_m", |t| quad(t, [[0.0, 0.1], [0.0, 0.31], [-0.01, 0.31], [-0.01, 0.1]]));
    // Clockwise corners; then a mark that overlaps the first mark of the ring.
    refused("marks.quad[0].corners_m", |t| quad(t, [[0.0, 0.1], [0.0, 0.11], [0.01, 0.11], [0.01, 0.1]]));
    refused("marks.quad[0].corners_m", |t| quad(t, [[0.25, 0.0], [0.26, 0.0], [0.26, 0.02], [0.25, 0.02]]));
    refused("cross.width_m", |t| t.cross.width_m = 0.0);
    refused("cross.thickness_m", |t| t.cross.thickness_m = -0.01);
    refused("cross.height_m", |t| t.cross.height_m = 0.01);
    refused("cross.half_length_m", |t| t.cross.half_length_m = 0.015);
    refused("cross.post_radius_m", |t| t.cross.post_radius_m = 0.02);
    refused("cross.post_reflectance", |t| t.cross.post_reflectance = 2.0);
    refused("docking_unit.axis_m[1]", |t| t.docking_unit.axis_m[1] = f64::NEG_INFINITY);
    refused("docking_unit.depth_m", |t| t.docking_unit.depth_m = -0.1);
    refused("docking_unit.cone_radius_m", |t| t.docking_unit.cone_radius_m = 0.0);
    refused("docking_unit.inner_radius_m", |t| t.docking_unit.inner_radius_m = 0.4);
    refused("docking_unit.outer_radius_m", |t| t.docking_unit.outer_radius_m = 0.5);
    refused("docking_unit.recess_m", |t| t.docking_unit.recess_m = 0.0);
    refused("docking_unit.cone_depth_m", |t| t.docking_unit.cone_depth_m = 0.06);
    refused("docking_unit.blocks.count", |t| t.docking_unit.blocks.as_mut().unwrap().count = 33);
    refused("docking_unit.blocks.size_m", |t| t.docking_unit.blocks.as_mut().unwrap().size_m[0] = 0.2);
    refused("station.radius_m", |t| t.station.radius_m = 0.7);
    refused("station.centre_m[0]", |t| t.station.centre_m[0] = 1e6);
    refused("station.depth_m", |t| t.station.depth_m = 0.1);
    refused("station.length_m", |t| t.station.length_m = 0.0);
    refused("station.blankets.rings", |t| t.station.blankets.as_mut().unwrap().rings = 1_000_000);
    refused("station.blankets.ring_width_m", |t| t.station.blankets.as_mut().unwrap().ring_width_m = 1.0);
    refused("station.blankets.tile_width_m", |t| t.station.blankets.as_mut().unwrap().tile_width_m = 1e-9);
    refused("station.blankets.gap_m", |t| t.station.blankets.as_mut().unwrap().gap_m = 0.1);
    refused("station.blankets.thickness_m", |t| t.station.blankets.as_mut().unwrap().thickness_m = 0.35);
    refused("station.blankets.reflectance", |t| {
        t.station.blankets.as_mut().unwrap().reflectance = [0.5, 0.4];
    });
    refused("fittings.source", |t| t.fittings.as_mut().unwrap().source.clear());
    // In front of the disk's plane; then a negative radius.
    refused("fittings.body[1]", |t| fitting(t, [0.0, 1.0, 0.1], 0.1));
    refused("fittings.body[1].radius_m", |t| fitting(t, [0.0, 1.0, -0.2], -0.1));
    refused("fittings.body[1].to_m[2]", |t| fitting(t, [0.0, 1.0, f64::NAN], 0.1));
    refused("structure.body[0]", |t| {
        let body = t.fittings.as_ref().unwrap().body[0].clone();
        t.structure.as_mut().unwrap().body[0] = body;
    });
    refused("structure.body[1].cells[0]", |t| panel(t, [usize::MAX, 3]));
    refused("structure.body[1].cells[0]", |t| panel(t, [0, 3]));
    refused("structure.body[1].cells", |t| panel(t, [9, 8]));
    refused("structure.body[1].gap_m", |t| panel(t, [1, 64]));
    refused("structure.body", |t| {
        let bodies = &mut t.structure.as_mut().unwrap().body;
        *bodies = vec![bodies[0].clone(); 101];
    });
}

fn ring(target: &mut TargetFile) -> &mut super::MarkRing {
    target.marks.as_mut().unwrap().ring.as_mut().unwrap()
}

fn quad(target: &mut TargetFile, corners_m: [[f64; 2]; 4]) {
    target.marks.as_mut().unwrap().quad.push(MarkQuad { corners_m });
}

fn fitting(target: &mut TargetFile, to_m: [f64; 3], radius_m: f64) {
    target.fittings.as_mut().unwrap().body[1] =
        Body::Cylinder { from_m: [0.0, 1.0, -0.3], to_m, radius_m, sides: 8, reflectance: 0.5 };
}

fn panel(target: &mut TargetFile, new: [usize; 2]) {
    let Body::Panel { cells, .. } = &mut target.structure.as_mut().unwrap().body[1] else {
        panic!("not a panel")
    };
    *cells = new;
}

#[test]
fn unknown_and_missing_fields_are_refused_by_name() {
    let text = TargetFile::built_in_text("progress").unwrap();
    let message = |text: &str| toml::from_str::<TargetFile>(text).unwrap_err().to_string();
    assert!(message(&text.replace("post_radius_m", "post_radius")).contains("post_radius"));
    assert!(message(&text.replacen("source = ", "origin = ", 1)).contains("origin"));
    assert!(message(&text.replace("kind = \"panel\"", "kind = \"sail\"")).contains("sail"));
}

#[test]
fn the_schema_describes_every_table_of_a_target_file() {
    let schema = serde_json::to_value(schemars::schema_for!(TargetFile)).unwrap();
    let properties = schema["properties"].as_object().unwrap();
    for table in ["contact", "plate", "marks", "cross", "docking_unit", "station", "fittings", "structure"] {
        assert!(properties[table]["description"].is_string(), "{table}");
    }
    let required = schema["required"].as_array().unwrap();
    assert_eq!(required.len(), 6, "{required:?}");
}
