//! Tests on fields over the whole sky, with noise, missing stars and false sources.

use contract::{Angle, Camera, Direction};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::*;
use crate::camera_model::tests::argon;

/// Random number generator: SplitMix64 (Steele, Lea & Flood 2014).
pub(in super::super) struct Random(pub(in super::super) u64);

impl Random {
    /// Returns a uniform number in (0, 1).
    pub(in super::super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + 1e-17
    }

    /// Returns a standard normal number (Box & Muller).
    pub(in super::super) fn normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        (-2.0 * libm::log(u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
    }

    /// Returns a direction, uniform over the sphere.
    fn direction(&mut self) -> Direction<Icrs> {
        Direction::from_vector(Vector3::from_fn(|_, _| self.normal())).unwrap()
    }

    /// Returns an attitude, uniform over all rotations.
    fn attitude(&mut self) -> Rotation<CameraFrame, Icrs> {
        let [w, x, y, z] = [(); 4].map(|()| self.normal());
        Rotation::from_unit_quaternion(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
    }

    fn position(&mut self, model: &CameraModel) -> PixelPoint {
        let (columns, rows) = model.size_px();
        PixelPoint::new(self.uniform() * columns as f64 - 0.5, self.uniform() * rows as f64 - 0.5)
    }
}

/// Returns `count` stars up to a magnitude, uniform over the sky. Their number increases as in the real sky:
/// by √10 per magnitude.
fn even_sky(count: u32, faintest: f64) -> Vec<ListedStar> {
    let mut random = Random(7);
    (1..=count)
        .map(|id| ListedStar {
            id,
            direction: random.direction(),
            magnitude: faintest + 2.0 * libm::log10(random.uniform()),
        })
        .collect()
}

/// Returns the stars of Hipparcos up to Hp = 7.5 (format: sim/data/make_hipparcos2.py).
fn real_sky() -> Vec<ListedStar> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../sim/data/hipparcos2.bin");
    let bytes = std::fs::read(path).unwrap();
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0_i64, |sum, &byte| sum << 8 | i64::from(byte));
    let signed = |bytes: &[u8]| {
        let bits = 64 - 8 * bytes.len();
        number(bytes) << bits >> bits
    };
    bytes[48..]
        .chunks_exact(29)
        .map(|row| ListedStar {
            id: number(&row[..3]) as u32,
            direction: Direction::from_ra_dec(
                Angle::from_radians(1e-10 * number(&row[3..8]) as f64),
                Angle::from_radians(1e-10 * signed(&row[8..13]) as f64),
            ),
            magnitude: 1e-4 * signed(&row[22..25]) as f64,
        })
        .filter(|star| star.magnitude <= 7.5)
        .collect()
}

fn camera(columns: usize, rows: usize, field_deg: f64, k1: f64) -> CameraModel {
    let pixel_um = 10.0;
    CameraModel::new(&Camera {
        columns,
        rows,
        focal_length_mm: 1e-3 * pixel_um * columns as f64 / (2.0 * libm::tan(0.5 * field_deg.to_radians())),
        pixel_width_um: pixel_um,
        pixel_height_um: pixel_um,
        principal_x_px: 0.5 * columns as f64 - 0.5,
        principal_y_px: 0.5 * rows as f64 - 0.5,
        radial: [k1, 0.0, 0.0],
        tangential: [0.0; 2],
    })
    .unwrap()
}

/// Largest number of detectable stars of a field, as passed on by the pipeline.
const MAX_DETECTABLE: usize = 60;

/// Returns the sources of a field with its `detectable` brightest stars: 0.3 px of noise, 0.3 mag of scatter,
/// 30 % of the stars missing, 30 % of the sources false.
fn sources(
    random: &mut Random,
    model: &CameraModel,
    stars: &[PixelPoint],
    magnitudes: &[f64],
    detectable: usize,
) -> Vec<(PixelPoint, f64)> {
    let mut sources: Vec<(PixelPoint, f64)> = stars
        .iter()
        .zip(magnitudes)
        .take(detectable)
        .map(|(position, magnitude)| {
            let position =
                PixelPoint::new(position.x + 0.3 * random.normal(), position.y + 0.3 * random.normal());
            (position, libm::pow(10.0, -0.4 * (magnitude + 0.3 * random.normal())))
        })
        .collect();
    let missing = (0.3 * detectable as f64).round() as usize;
    for _ in 0..missing {
        sources.remove((random.uniform() * sources.len() as f64) as usize);
    }
    let of_stars = sources.len();
    for _ in 0..(0.3 / 0.7 * of_stars as f64).round() as usize {
        let flux = sources[(random.uniform() * of_stars as f64) as usize].1;
        sources.push((random.position(model), flux));
    }
    sources
}

/// Counts of fields.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    solved: u32,
    wrong: u32,
    /// Number of fields off by more than 0.1°, including the rotation about the boresight.
    turned: u32,
    false_matches: u32,
    /// Number of fields whose focal length is off by more than five standard deviations of its error, 0.4 px
    /// of each source.
    other_focal_lengths: u32,
}

/// Solves `fields` random fields with at least ten stars of the list. In each field, the brightest stars are
/// detectable, from ten up to `most_detectable`; `change` moves their images.
fn tally(
    sky: &[ListedStar],
    model: &CameraModel,
    fields: u32,
    seed: u64,
    most_detectable: usize,
    change: impl Fn(PixelPoint) -> PixelPoint,
) -> Tally {
    tally_with_focal_errors(sky, model, 0.0, fields, seed, most_detectable, change)
}

/// Works like [`tally`] for cameras whose focal length differs from the stated one by a random share up to
/// `tolerance`.
fn tally_with_focal_errors(
    sky: &[ListedStar],
    stated: &CameraModel,
    tolerance: f64,
    fields: u32,
    seed: u64,
    most_detectable: usize,
    change: impl Fn(PixelPoint) -> PixelPoint,
) -> Tally {
    let solver = LostInSpace::new(sky, stated, 30.0, tolerance);
    let all = StarList::new(sky, 30.0, &stated.with_focal_ratio(1.0 - tolerance));
    let mut random = Random(seed);
    let mut tally = Tally::default();
    let mut done = 0;
    while done < fields {
        let attitude = random.attitude();
        let ratio = if tolerance > 0.0 { 1.0 + tolerance * (2.0 * random.uniform() - 1.0) } else { 1.0 };
        let model = &stated.with_focal_ratio(ratio);
        let mut stars = all.predict(&attitude, model);
        if stars.len() < 10 {
            continue;
        }
        done += 1;
        stars.sort_by(|a, b| a.star.magnitude.total_cmp(&b.star.magnitude));
        let positions: Vec<PixelPoint> = stars.iter().map(|star| change(star.position)).collect();
        let magnitudes: Vec<f64> = stars.iter().map(|star| star.star.magnitude).collect();
        let most = most_detectable.min(stars.len());
        let detectable = 10 + (random.uniform() * (most - 9) as f64) as usize;
        let sources = sources(&mut random, model, &positions, &magnitudes, detectable);
        let Some(found) = solver.solve(&sources) else { continue };
        tally.solved += 1;
        let boresight = |attitude: Rotation<CameraFrame, Icrs>| attitude.inverse() * Direction::z();
        let error = (found.camera_from_icrs * attitude.inverse()).quaternion().scaled_axis();
        let information = found.covariance.try_inverse().unwrap();
        let is_pointed = boresight(found.camera_from_icrs).separation(&boresight(attitude)).degrees() < 0.1;
        // χ² with three degrees of freedom exceeds 27 once in 150,000; the rotation about the boresight is
        // accurate to 0.02 to 0.06°.
        if !is_pointed || error.dot(&(information * error)) > 27.0 {
            tally.wrong += 1;
        }
        tally.turned += u32::from(error.norm().to_degrees() > 0.1);
        let (fx, fy) = model.focal_px();
        let mut squares = 0.0;
        for (_, star) in &found.matched {
            let r = attitude.rotate(star.direction.vector());
            squares += libm::pow(fx * r.x / r.z, 2.0) + libm::pow(fy * r.y / r.z, 2.0);
        }
        let focal_error = libm::log(found.focal_ratio / ratio) * squares.sqrt() / 0.4;
        tally.other_focal_lengths += u32::from(focal_error.abs() > 5.0);
        for (source, star) in found.matched {
            let truth = model.project(&(attitude * star.direction));
            if truth.is_none_or(|truth| change(truth).distance(sources[source].0) > 3.0) {
                tally.false_matches += 1;
            }
        }
    }
    tally
}

/// Checks that at least `least` of 300 fields are solved and none is wrong.
fn check(sky: &[ListedStar], model: &CameraModel, most_detectable: usize, least: u32) {
    let tally = tally(sky, model, 300, 26, most_detectable, |position| position);
    println!("of 300 fields: {tally:?}");
    assert!(
        tally.solved >= least && tally.wrong == 0 && tally.turned <= 1 && tally.false_matches == 0,
        "{tally:?}"
    );
    assert_eq!(tally.other_focal_lengths, 0, "{tally:?}");
}

/// Checks that at least `least` of `fields` fields are solved although the focal length is wrong by up to
/// `tolerance`, and that attitude and focal length are within their errors in all that are solved.
fn check_with_focal_errors(model: &CameraModel, tolerance: f64, fields: u32, least: u32) {
    let sky = real_sky();
    let tally =
        tally_with_focal_errors(&sky, model, tolerance, fields, 71, MAX_DETECTABLE, |position| position);
    println!("of {fields} fields, {tolerance}: {tally:?}");
    assert!(tally.solved >= least && tally.wrong == 0 && tally.false_matches == 0, "{tally:?}");
    assert_eq!(tally.other_focal_lengths, 0, "{tally:?}");
}

#[test]
fn a_focal_length_wrong_by_two_percent_is_found() {
    check_with_focal_errors(&argon(), 0.02, 100, 99);
}

#[test]
fn a_focal_length_wrong_by_up_to_twenty_percent_is_found() {
    check_with_focal_errors(&argon(), 0.2, 30, 29);
    check_with_focal_errors(&camera(1024, 1024, 60.0, -1e-8), 0.2, 30, 29);
}

/// With a free focal length more attitudes are tested, with higher odds: still none is found.
#[test]
fn sources_at_random_have_no_attitude_at_any_focal_length() {
    let model = argon();
    let solver = LostInSpace::new(&real_sky(), &model, 30.0, 0.1);
    let mut random = Random(12);
    for _ in 0..5 {
        let sources: Vec<_> = (0..40).map(|_| (random.position(&model), random.uniform())).collect();
        assert!(solver.solve(&sources).is_none());
    }
}

#[test]
fn fields_of_an_even_sky_are_solved() {
    check(&even_sky(26_000, 7.5), &argon(), MAX_DETECTABLE, 297);
}

#[test]
fn fields_of_the_real_sky_are_solved() {
    check(&real_sky(), &argon(), MAX_DETECTABLE, 297);
}

#[test]
fn ten_detectable_stars_are_enough() {
    check(&real_sky(), &argon(), 10, 297);
}

#[test]
fn a_field_of_60_degrees_is_solved() {
    check(&real_sky(), &camera(1024, 1024, 60.0, -1e-8), MAX_DETECTABLE, 297);
}

#[test]
fn a_field_of_2_degrees_is_solved_where_the_list_is_deep_enough() {
    check(&even_sky(118_000, 9.0), &camera(1024, 1024, 2.0, 0.0), MAX_DETECTABLE, 297);
}

#[test]
fn a_field_of_2_degrees_has_too_few_stars_of_a_shallow_list() {
    let solver = LostInSpace::new(&real_sky(), &camera(1024, 1024, 2.0, 0.0), 7.5, 0.0);
    let mut random = Random(3);
    let model = camera(1024, 1024, 2.0, 0.0);
    for _ in 0..50 {
        let sources: Vec<_> = (0..20).map(|_| (random.position(&model), random.uniform())).collect();
        assert!(solver.solve(&sources).is_none());
    }
}

#[test]
fn a_mirrored_image_is_not_solved() {
    let model = argon();
    let mirror = |p: PixelPoint| PixelPoint::new(751.0 - p.x, p.y);
    assert_eq!(tally(&real_sky(), &model, 100, 5, MAX_DETECTABLE, mirror), Tally::default());
}

#[test]
fn sources_at_random_have_no_attitude() {
    let model = argon();
    let solver = LostInSpace::new(&real_sky(), &model, 30.0, 0.0);
    let mut random = Random(11);
    for _ in 0..100 {
        let sources: Vec<_> = (0..40).map(|_| (random.position(&model), random.uniform())).collect();
        assert!(solver.solve(&sources).is_none());
    }
}

#[test]
fn fewer_than_four_sources_and_an_empty_list_have_no_attitude() {
    let (model, sky) = (argon(), real_sky());
    let list = StarList::new(&sky, 30.0, &model);
    let stars = list.predict(&Random(2).attitude(), &model);
    let brightest: Vec<_> =
        stars.iter().map(|star| (star.position, libm::pow(10.0, -0.4 * star.star.magnitude))).collect();
    let solver = LostInSpace::new(&sky, &model, 30.0, 0.0);
    assert!(solver.solve(&brightest).is_some());
    for count in 0..4 {
        assert!(solver.solve(&brightest[..count]).is_none());
    }
    assert!(LostInSpace::new(&[], &model, 30.0, 0.0).solve(&brightest).is_none());
    assert!(LostInSpace::new(&sky[..2], &model, 30.0, 0.0).solve(&brightest).is_none());
    assert!(LostInSpace::new(&sky, &model, -30.0, 0.0).solve(&brightest).is_none());
}

#[test]
fn sources_that_are_not_finite_are_passed_over() {
    let (model, sky) = (argon(), real_sky());
    let attitude = Random(2).attitude();
    let mut sources: Vec<_> = StarList::new(&sky, 30.0, &model)
        .predict(&attitude, &model)
        .iter()
        .map(|star| (star.position, libm::pow(10.0, -0.4 * star.star.magnitude)))
        .collect();
    let nan = PixelPoint::new(f64::NAN, f64::INFINITY);
    sources.splice(0..0, [(nan, 1e9), (PixelPoint::new(1.0, 1.0), f64::NAN)]);
    let found = LostInSpace::new(&sky, &model, 30.0, 0.0).solve(&sources).unwrap();
    assert!(found.camera_from_icrs.angle_to(&attitude).degrees() < 1e-3);
    assert!(found.matched.iter().all(|(source, _)| *source >= 2));
}

/// A list with one crowded region has as many stars as any field, and as few pairs.
#[test]
fn the_memory_of_a_crowded_list_is_bounded() {
    let mut random = Random(9);
    let crowd: Vec<ListedStar> = (0..20_000)
        .map(|id| {
            let offset = Vector3::from_fn(|_, _| 1e-4 * random.normal());
            let direction = Direction::from_vector(Vector3::x() + offset).unwrap();
            ListedStar { id, direction, magnitude: random.uniform() }
        })
        .collect();
    let solver = LostInSpace::new(&crowd, &argon(), 30.0, 0.0);
    assert_eq!(solver.stars.len(), 24);
}

/// All triples once, in the order of the paper: for four sources 123, 234, 124, 134.
#[test]
fn triples_come_in_the_order_of_pyramid() {
    let four: Vec<_> = pyramid_order(4).collect();
    assert_eq!(four, [[0, 1, 2], [1, 2, 3], [0, 1, 3], [0, 2, 3]]);
    assert_eq!(pyramid_order(25).count(), 2300);
    assert_eq!(pyramid_order(2).count() + pyramid_order(0).count(), 0);
}

/// Returns the numbers of fields that are solved and false, of `fields` whose focal length is wrong by up to
/// a tenth and whose corners are moved by `shift`.
fn solved_with_distortion(stated: &CameraModel, shift: f64, fields: u32) -> (u32, u32) {
    let sky = real_sky();
    let solver = LostInSpace::new(&sky, stated, 30.0, 0.12).with_unknown_distortion(0.08);
    let mut random = Random(83);
    let (mut solved, mut wrong, mut done) = (0, 0, 0);
    while done < fields {
        let attitude = random.attitude();
        let lens = Lens { focal_ratio: 0.9 + 0.2 * random.uniform(), corner_shift: shift };
        let model = stated.with_focal_ratio(lens.focal_ratio).with_added_radial(lens.radial(stated));
        let mut stars = StarList::new(&sky, 30.0, &model).predict(&attitude, &model);
        if stars.len() < 20 {
            continue;
        }
        done += 1;
        stars.sort_by(|a, b| a.star.magnitude.total_cmp(&b.star.magnitude));
        let positions: Vec<PixelPoint> = stars.iter().map(|star| star.position).collect();
        let magnitudes: Vec<f64> = stars.iter().map(|star| star.star.magnitude).collect();
        let detectable = MAX_DETECTABLE.min(stars.len());
        let sources = sources(&mut random, &model, &positions, &magnitudes, detectable);
        let Some(found) = solver.solve(&sources) else { continue };
        solved += 1;
        let boresight = |attitude: Rotation<CameraFrame, Icrs>| attitude.inverse() * Direction::z();
        let off = boresight(found.camera_from_icrs).separation(&boresight(attitude)).degrees();
        let misses = found.matched.iter().filter(|(source, star)| {
            let truth = model.project(&(attitude * star.direction));
            truth.is_none_or(|truth| truth.distance(sources[*source].0) > 4.0)
        });
        wrong += u32::from(off > 0.3 || 4 * misses.count() > found.matched.len());
    }
    (solved, wrong)
}

#[test]
fn an_unknown_distortion_is_found_with_the_focal_length() {
    for (name, stated) in [("argon", argon()), ("60 degrees", camera(1024, 1024, 60.0, 0.0))] {
        for shift in [-0.08, 0.04] {
            let (solved, wrong) = solved_with_distortion(&stated, shift, 4);
            println!("{name}, corners moved by {shift}: {solved} of 4 solved, {wrong} false");
            assert!(solved == 4 && wrong == 0, "{name} {shift}: {solved} {wrong}");
        }
    }
}

/// More attitudes are tested than with a known distortion, with higher odds: still none is found.
#[test]
fn sources_at_random_have_no_attitude_at_any_distortion() {
    let model = camera(1024, 1024, 30.0, 0.0);
    let solver = LostInSpace::new(&real_sky(), &model, 30.0, 0.1).with_unknown_distortion(0.08);
    let mut random = Random(13);
    let sources: Vec<_> = (0..40).map(|_| (random.position(&model), random.uniform())).collect();
    assert!(solver.solve(&sources).is_none());
}
