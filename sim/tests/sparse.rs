//! Frames of which the camera keeps regions, drawn as far as it looks at them, are those drawn as a whole.

mod small_scene;

use boresight_sim::{Drawing, Simulation, Simulator};

fn assert_sparse_is_whole(simulator: &Simulator, frames: std::ops::Range<u64>) {
    let mut seen = simulator.camera().unwrap();
    let mut all = simulator.camera().unwrap().drawing(Drawing::All);
    let mut regions = 0;
    for number in frames.clone() {
        let (seen, all) = (seen.expose(number).unwrap(), all.expose(number).unwrap());
        // The frame with its regions, telemetry, truth and objects, to the bit.
        assert!(seen == all, "frame {number}");
        regions += seen.frame.windows().unwrap().len();
    }
    assert!(regions as u64 > frames.end - frames.start, "{regions} regions");
}

/// Regions about all that is above `threshold_dn`.
fn restless(threshold_dn: u16) -> Simulation {
    let mut simulation = small_scene::restless();
    simulation.roi.as_mut().unwrap().threshold_dn = threshold_dn;
    simulation
}

#[test]
fn a_sparse_frame_is_the_whole_frame_with_few_regions_and_with_many() {
    // The background has 41 DN with a noise of 1.6 DN: these floors are exceeded by sources alone, by some pixels of the
    // background, and by a tenth of it.
    for (threshold_dn, count) in [(67, 500), (46, 100), (43, 20)] {
        assert_sparse_is_whole(&small_scene::simulator(&restless(threshold_dn)), 0..count);
    }
}

#[test]
fn a_sparse_frame_is_the_whole_frame_on_an_even_detector() {
    let mut simulation = small_scene::still();
    simulation.roi = restless(46).roi;
    simulation.sensor.fixed_pattern = Default::default();
    assert_sparse_is_whole(&small_scene::simulator(&simulation), 0..400);
}
