//! The Moon compared with JPL's DE421.

use std::fs;

use boresight_truth::moon::moon_position_km;
use nalgebra::Vector3;

#[test]
fn the_moon_is_where_de421_has_it() {
    let path = format!("{}/../../golden/moon/moon_de421.csv", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).unwrap();
    let (mut rows, mut worst_deg, mut worst_km) = (0, 0.0_f64, 0.0_f64);
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let theirs = Vector3::new(numbers[1], numbers[2], numbers[3]);
        let ours = moon_position_km(numbers[0]);
        worst_deg = worst_deg.max(libm::atan2(ours.cross(&theirs).norm(), ours.dot(&theirs)).to_degrees());
        worst_km = worst_km.max((ours.norm() - theirs.norm()).abs());
        rows += 1;
    }
    assert_eq!(rows, 400);
    assert!(worst_deg < 0.025, "{worst_deg} degrees");
    assert!(worst_km < 50.0, "{worst_km} km");
}
