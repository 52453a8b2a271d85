//! Frames with regions of interest, drawn only where the camera needs them, equal frames drawn completely.

use std::ops::Range;

use boresight_sim::{PixelSelection, Simulation, Simulator};

use crate::{argon, small_scene};

/// Asserts that the frames with their regions, telemetry, truth and objects are identical to the bit.
fn assert_sparse_is_whole(simulator: &Simulator, frames: Range<u64>) {
    let mut seen = simulator.camera().unwrap();
    let mut all = simulator.camera().unwrap().with_pixel_selection(PixelSelection::All);
    let mut regions = 0;
    for number in frames.clone() {
        let (seen, all) = (seen.expose(number).unwrap(), all.expose(number).unwrap());
        assert!(seen == all, "frame {number}");
        regions += seen.frame.windows().unwrap().len();
    }
    assert!(regions as u64 > frames.end - frames.start, "{regions} regions");
}

/// Asserts that the images of a camera with zero suppression are identical above the floor, to the bit.
fn assert_above_is_whole(simulator: &Simulator, floor_dn: u16, frames: Range<u64>) {
    let (mut seen, mut all) =
        (simulator.camera().unwrap(), simulator.camera().unwrap().with_pixel_selection(PixelSelection::All));
    let mut lit = 0;
    for number in frames {
        let (seen, all) = (seen.expose(number).unwrap(), all.expose(number).unwrap());
        assert!(seen == all, "frame {number} over {floor_dn}");
        assert!(seen.frame.dn().iter().all(|&dn| dn == 0 || dn > floor_dn) && seen.frame.windows().is_none());
        lit += seen.frame.dn().iter().filter(|dn| **dn > 0).count();
    }
    assert!(lit > 20, "{lit} pixels over {floor_dn}");
}

/// The scene with regions around all pixels above `threshold_dn`.
fn restless(threshold_dn: u16) -> Simulation {
    let mut simulation = small_scene::restless();
    simulation.roi.as_mut().unwrap().threshold_dn = threshold_dn;
    simulation
}

/// The background is 41 DN with a noise of 1.6 DN: these thresholds are exceeded only by sources, by some
/// pixels of the background, and by a tenth of the background.
#[test]
fn a_sparse_frame_is_the_whole_frame_with_few_regions_and_with_many() {
    for (threshold_dn, count) in [(67, 500), (46, 100), (43, 20)] {
        assert_sparse_is_whole(&small_scene::simulator(&restless(threshold_dn)), 0..count);
    }
}

#[test]
fn a_sparse_frame_is_the_whole_frame_on_an_even_detector() {
    let mut simulation = small_scene::still();
    simulation.roi = restless(46).roi;
    assert_sparse_is_whole(&small_scene::simulator(&simulation), 0..400);
}

/// Whole images of which only the pixels above a floor are drawn equal images drawn completely, with 0 for
/// all other pixels.
#[test]
fn suppressed_images_are_whole_images_above_the_floor() {
    for floor_dn in [43, 46, 67] {
        for mut simulation in [small_scene::still(), small_scene::defective(small_scene::restless())] {
            simulation.roi = None;
            simulation.zero_suppression_dn = Some(floor_dn);
            let simulator = small_scene::simulator(&simulation);
            assert_above_is_whole(&simulator, floor_dn, 0..10);
        }
    }
    let both = Simulation { zero_suppression_dn: Some(67), ..restless(67) };
    let refusal = Simulator::new(&both, std::path::Path::new("")).unwrap_err().to_string();
    assert!(refusal.starts_with("zero_suppression_dn is 67, expected no value with [roi]"), "{refusal}");
}

/// Overflowing wells, cosmic-ray hits, dead pixels, smear: with and without line noise, which leaves no pixel
/// undrawn.
#[test]
fn a_sparse_frame_is_the_whole_frame_with_every_effect_of_the_detector() {
    for lines in [true, false] {
        let mut simulation = small_scene::defective(restless(67));
        simulation.sensor.full_well_e = 3000.0;
        if !lines {
            simulation.sensor.line_noise = Default::default();
            simulation.sensor.fixed_pattern.column_offset_e = 0.0;
        }
        assert_sparse_is_whole(&small_scene::simulator(&simulation), 0..40);
    }
}

/// The first twelve of the two hundred frames of each of the five days.
#[test]
fn sparse_frames_of_argon_are_whole_frames() {
    assert_argon(12);
}

/// Full run: `cargo test --release -p boresight-sim --test it sparse:: -- --ignored`, 20 s of CPU time.
#[test]
#[ignore = "1,000 frames of 752 × 580 pixels, four times: for a scheduled job"]
fn a_thousand_sparse_frames_of_argon_are_whole_frames() {
    assert_argon(200);
}

/// Compares the regions of the frames, and every pixel above the floor anywhere in the frame.
fn assert_argon(frames_of_a_day: u64) {
    let argon = argon::simulation();
    let floor_dn = argon.roi.as_ref().unwrap().threshold_dn;
    let regions = small_scene::simulator(&argon);
    let above =
        small_scene::simulator(&Simulation { roi: None, zero_suppression_dn: Some(floor_dn), ..argon });
    for day_start in [0, 1700, 5000, 9000, 14_000] {
        let frames = day_start..day_start + frames_of_a_day;
        assert_sparse_is_whole(&regions, frames.clone());
        assert_above_is_whole(&above, floor_dn, frames);
    }
}
