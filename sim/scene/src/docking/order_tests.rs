//! Ray tests that the order of the parts agrees with the depth of the facets.

use draws::{Effect, Seed, Stream, uniform};
use nalgebra::Vector3;

use super::{DockingScene, Facet, TargetFile};

/// Camera distances, m, and maximum lateral offset as a share of the distance: 0.3 is 17°.
const DISTANCES_M: [f64; 5] = [1.0, 3.0, 10.0, 60.0, 400.0];
const ASIDE: f64 = 0.3;
const RAYS: usize = 10_000;

/// Returns the multiple of `ray` at which a ray from `eye` meets a facet that faces `eye`.
fn hit(facet: &Facet, eye: Vector3<f64>, ray: Vector3<f64>) -> Option<f64> {
    let slope = facet.normal.dot(&ray);
    let along = facet.normal.dot(&(facet.outer[0] - eye)) / slope;
    if slope >= 0.0 || along <= 0.0 {
        return None;
    }
    let point = eye + ray * along;
    // Point and facet are projected along the axis closest to the normal; the even-odd rule counts the
    // crossings of a half line.
    let size = facet.normal.abs();
    let (u, v) = if size.z >= size.x && size.z >= size.y {
        (0, 1)
    } else if size.x >= size.y {
        (1, 2)
    } else {
        (2, 0)
    };
    let crossings = |ring: &[Vector3<f64>]| {
        let edges = ring.iter().zip(ring.iter().cycle().skip(1));
        edges
            .filter(|(a, b)| {
                let (above, share) = (a[v] > point[v], (point[v] - a[v]) / (b[v] - a[v]));
                above != (b[v] > point[v]) && point[u] < a[u] + share * (b[u] - a[u])
            })
            .count()
    };
    let count = crossings(&facet.outer) + facet.holes.iter().map(|hole| crossings(hole)).sum::<usize>();
    (count % 2 == 1).then_some(along)
}

/// Returns a camera position and a ray from it towards a point near a facet of the scene.
fn ray(scene: &DockingScene, stream: &mut Stream) -> (Vector3<f64>, Vector3<f64>) {
    let mut draw = |scale: f64| scale * (2.0 * uniform(stream) - 1.0);
    let facets: Vec<&Facet> = scene.parts.iter().flat_map(|part| &part.facets).collect();
    let pick = |share: f64, count: usize| ((share + 1.0) / 2.0 * count as f64) as usize;
    let distance_m = DISTANCES_M[pick(draw(1.0), DISTANCES_M.len())];
    let eye = Vector3::new(draw(ASIDE * distance_m), draw(ASIDE * distance_m), distance_m);
    let facet = facets[pick(draw(1.0), facets.len())];
    let corner = facet.outer[pick(draw(1.0), facet.outer.len())];
    let size = (facet.outer[facet.outer.len() / 2] - facet.outer[0]).norm();
    let aim = corner + Vector3::new(draw(size), draw(size), 0.0);
    (eye, aim - eye)
}

/// Painted back to front, the nearest facet is on top, and no facet of a part covers another facet of that
/// part.
#[test]
fn the_nearest_part_is_painted_last() {
    for name in TargetFile::built_in_names() {
        let scene = TargetFile::built_in(name).unwrap().scene();
        let mut stream = Seed { seed: 1, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let mut met = 0;
        for _ in 0..RAYS {
            let (eye, ray) = ray(&scene, &mut stream);
            let mut nearest = (f64::INFINITY, "");
            let mut last = "";
            for part in &scene.parts {
                let hits: Vec<f64> = part.facets.iter().filter_map(|facet| hit(facet, eye, ray)).collect();
                assert!(hits.len() <= 1, "{name}: {} covers itself from {eye} along {ray}", part.name);
                if let Some(&along) = hits.first() {
                    last = &part.name;
                    if along <= nearest.0 {
                        nearest = (along, &part.name);
                    }
                }
            }
            assert_eq!(last, nearest.1, "{name}: from {eye} along {ray}");
            met += usize::from(!last.is_empty());
        }
        assert!(met > RAYS / 3, "{name}: only {met} rays meet anything");
    }
}
