//! A scenario produces the same bits on every machine, in any order, on any thread, and with any other
//! effects switched on or off.

use boresight_sim::scene::TargetConfig;
use boresight_sim::sensor::Switch;
use boresight_sim::truth::{ControlConfig, FrameTruth, KnowledgeConfig, ObjectKind, ObjectTruth};
use boresight_sim::{Exposure, Simulation, Simulator};
use contract::Telemetry;
use sha2::{Digest, Sha256};

use crate::small_scene::{restless, simulator, still};

/// SHA-256 of values in a fixed byte order: every bit of every number.
#[derive(Default)]
struct Fingerprint(Sha256);

impl Fingerprint {
    fn number(&mut self, value: f64) {
        self.0.update(value.to_bits().to_le_bytes());
    }

    fn numbers<const N: usize>(&mut self, values: [f64; N]) {
        values.into_iter().for_each(|value| self.number(value));
    }

    fn word(&mut self, word: &str) {
        self.0.update(word.as_bytes());
        self.0.update([0]);
    }

    fn whole(&mut self, value: u64) {
        self.0.update(value.to_le_bytes());
    }

    fn hex(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Hash of the digital numbers and transmitted regions.
fn pixels(exposures: &[Exposure]) -> String {
    let mut print = Fingerprint::default();
    for exposure in exposures {
        exposure.frame.dn().iter().for_each(|dn| print.0.update(dn.to_le_bytes()));
        for window in exposure.frame.windows().into_iter().flatten() {
            for side in [window.x, window.y, window.columns, window.rows] {
                print.whole(side as u64);
            }
        }
    }
    print.hex()
}

fn frame_truth(exposures: &[Exposure]) -> String {
    let mut print = Fingerprint::default();
    for exposure in exposures {
        let FrameTruth { frame, group, time, .. } = &exposure.truth;
        print.whole(*frame);
        print.word(group);
        print.whole(time.to_tai_duration().total_nanoseconds() as u64);
        let truth = &exposure.truth;
        print.number(truth.exposure_s);
        print.numbers(truth.body_from_icrs.wxyz());
        print.numbers(truth.camera_from_icrs.wxyz());
        print.numbers(truth.position_km.into());
        print.numbers(truth.velocity_km_s.into());
        print.numbers((*truth.line_of_sight.vector()).into());
        print.numbers((*truth.sun.vector()).into());
        print.numbers([truth.range_km, truth.phase_deg, truth.sunlit_fraction]);
        let at = truth.target_position.unwrap();
        print.numbers([at.x, at.y]);
        print.word(truth.shadow.code());
        print.word(truth.target_visibility.code());
    }
    print.hex()
}

fn object_truth(exposures: &[Exposure]) -> String {
    let mut print = Fingerprint::default();
    for object in exposures.iter().flat_map(|exposure| &exposure.objects) {
        let ObjectTruth { frame, kind, id, position, astrometric, magnitude, .. } = object;
        print.whole(*frame);
        print.word(kind.code());
        print.whole(u64::from(*id));
        print.numbers([position.x, position.y]);
        print.numbers(astrometric.map_or([0.0; 3], |direction| (*direction.vector()).into()));
        print.number(magnitude.unwrap_or(0.0));
        print.numbers([object.electrons, object.peak_electrons, object.snr, object.radius_px]);
        print.numbers([object.bloom_px, object.cut]);
    }
    print.hex()
}

fn telemetry(exposures: &[Exposure]) -> String {
    let mut print = Fingerprint::default();
    for exposure in exposures {
        let Telemetry { time, exposure_s, body_from_icrs, velocity_km_s } = &exposure.telemetry;
        print.whole(time.to_tai_duration().total_nanoseconds() as u64);
        print.number(*exposure_s);
        print.numbers(body_from_icrs.wxyz());
        print.numbers(velocity_km_s.unwrap().into());
    }
    print.hex()
}

fn expose(simulator: &Simulator, frames: impl IntoIterator<Item = u64>) -> Vec<Exposure> {
    let mut camera = simulator.camera().unwrap();
    frames.into_iter().map(|frame| camera.expose(frame).unwrap()).collect()
}

fn one(simulation: &Simulation, frame: u64) -> Exposure {
    expose(&simulator(simulation), [frame]).remove(0)
}

/// The simulated values themselves are frozen, with every effect on. The hashes must hold on every machine; a
/// change here changes every result and belongs in CHANGELOG.md. The four parts indicate the cause: only
/// pixels changed, a sampler; only telemetry changed, the attitude knowledge; all changed, the orbit, the
/// ephemeris or the addresses of draws.
#[test]
fn pixels_truth_and_telemetry_of_a_small_scene_are_frozen() {
    let exposures = expose(&simulator(&restless()), [0, 1, 2, 7]);
    let got = [frame_truth(&exposures), object_truth(&exposures), telemetry(&exposures), pixels(&exposures)];
    assert_eq!(got, FROZEN);
}

/// Hashes of frame truth, object truth, telemetry and pixels.
const FROZEN: [&str; 4] = [
    "9cd92280b856144efa443138b1f3ee8a5e42704f3e469558c0fabd155f920af1",
    "10417743650b4355613c60ef293838b6c7919e997a64fe351eb0980c204534f0",
    "5bdfd6e0ecaa0fa2ac1968724ae3dcd398e1d3b5e199950c98f301dce0191d16",
    "3926d34d1c71f03547a610aeab63cab1bb064991d2ec835801a31e84654bce9d",
];

/// A frozen hash of an empty scene would have no value as a test.
#[test]
fn the_frozen_scene_contains_every_effect() {
    let exposures = expose(&simulator(&restless()), [0, 1, 2, 7]);
    for exposure in &exposures {
        let count = |kind| exposure.objects.iter().filter(|object| object.kind == kind).count();
        assert_eq!(count(ObjectKind::Target), 1);
        assert_eq!(count(ObjectKind::HotPixel), 12);
        assert!(count(ObjectKind::Star) > 10, "{} stars", count(ObjectKind::Star));
        assert!(exposure.frame.windows().unwrap().len() > 2);
        // The shutter control is active and not only at a limit.
        assert!((0.0006..0.25).contains(&exposure.truth.exposure_s), "{} s", exposure.truth.exposure_s);
    }
    assert!(exposures.iter().flat_map(|e| &e.objects).any(|object| object.cut > 0.0 && object.cut < 1.0));
}

#[test]
fn a_frame_alone_is_the_frame_of_the_run_in_any_order() {
    let simulator = simulator(&restless());
    let forwards = expose(&simulator, 0..8);
    assert_eq!(expose(&simulator, [7]).remove(0), forwards[7]);
    let mut backwards = expose(&simulator, (0..8).rev());
    backwards.reverse();
    assert_eq!(backwards, forwards);
    assert_eq!(expose(&simulator, [3, 3, 900, 3])[3], forwards[3]);
}

#[test]
fn several_threads_make_the_same_frames_as_one() {
    let simulator = simulator(&restless());
    let alone = expose(&simulator, 0..12);
    let shared: Vec<Vec<Exposure>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3)
            .map(|n| {
                scope.spawn({
                    let s = &simulator;
                    move || expose(s, (n..12).step_by(3))
                })
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    for (frame, expected) in alone.iter().enumerate() {
        assert_eq!(shared[frame % 3][frame / 3], *expected);
    }
}

/// Returns the indices of the pixels that differ.
fn differing(a: &Exposure, b: &Exposure) -> Vec<usize> {
    let pairs = a.frame.dn().iter().zip(b.frame.dn()).enumerate();
    pairs.filter(|(_, (a, b))| a != b).map(|(index, _)| index).collect()
}

#[test]
fn without_hot_pixels_no_other_pixel_and_no_other_number_changes() {
    let (with, mut without) = (still(), still());
    without.sensor.hot_pixels.count = 0;
    let (with, without) = (one(&with, 5), one(&without, 5));
    let hot: Vec<usize> =
        with.objects.iter().filter(|o| o.kind == ObjectKind::HotPixel).map(|o| o.id as usize).collect();
    let differing = differing(&with, &without);
    assert!(differing.iter().all(|index| hot.contains(index)), "{differing:?} of {hot:?}");
    // With a median of 1000 e⁻ and a noise of 16 e⁻, every hot pixel changes its pixel value.
    assert_eq!(differing.len(), 12);
    assert_eq!((&with.truth, &with.telemetry), (&without.truth, &without.telemetry));
    assert_eq!(with.objects[..with.objects.len() - 12], without.objects);
}

#[test]
fn without_the_target_only_the_pixels_under_it_change() {
    let (with, mut without) = (still(), still());
    without.target = TargetConfig::LambertSphere { radius_m: 0.1, albedo: 0.0 };
    let (with, without) = (one(&with, 5), one(&without, 5));
    let target = with.objects[0].clone();
    assert_eq!((target.kind, without.objects[0].kind), (ObjectKind::Target, ObjectKind::Star));
    for index in differing(&with, &without) {
        let pixel = contract::PixelPoint::new((index % 160) as f64, (index / 160) as f64);
        // The halo, 4 px wide and with a few hundred electrons, falls below 0.01 e⁻ within 4.5 times its
        // width.
        assert!(pixel.distance(target.position) < 18.0, "{index}");
    }
    assert!(!differing(&with, &without).is_empty());
    assert_eq!(with.objects[1..], without.objects);
    assert_eq!(with.telemetry, without.telemetry);
}

/// Shot, dark and read noise are one effect with one draw per pixel: if a part of it is switched off, the
/// pixels are drawn anew, and nothing else is.
#[test]
fn without_a_part_of_the_pixel_noise_nothing_but_pixels_is_drawn_anew() {
    let base = one(&restless(), 5);
    for switch_off in [
        |s: &mut Simulation| s.sensor.noise.read = Switch::Off,
        |s: &mut Simulation| s.sensor.noise.shot = Switch::Off,
        |s: &mut Simulation| s.sensor.noise.dark = Switch::Off,
    ] {
        let mut simulation = restless();
        switch_off(&mut simulation);
        let other = one(&simulation, 5);
        assert_ne!(other.frame.dn(), base.frame.dn());
        assert_eq!(other.telemetry, base.telemetry);
        let known =
            |e: &Exposure| FrameTruth { target_visibility: base.truth.target_visibility, ..e.truth.clone() };
        assert_eq!(known(&other), base.truth);
        assert_eq!(other.objects.len(), base.objects.len());
        for (a, b) in other.objects.iter().zip(&base.objects) {
            // Values that depend on the noise itself may differ: SNR, radius, and the cut by regions that
            // were found on noisy pixels.
            let known = |o: &ObjectTruth| ObjectTruth {
                snr: 0.0,
                radius_px: 0.0,
                bloom_px: 0.0,
                cut: 0.0,
                ..o.clone()
            };
            assert_eq!(known(a), known(b));
        }
    }
}

#[test]
fn without_regions_the_pixels_in_them_are_the_same() {
    let mut whole = restless();
    whole.roi = None;
    let (cut, whole) = (one(&restless(), 5), one(&whole, 5));
    let windows = cut.frame.windows().unwrap();
    for y in 0..120 {
        for x in 0..160 {
            let sent = windows.iter().any(|window| window.contains(x, y));
            assert_eq!(cut.frame.dn_at(x, y), if sent { whole.frame.dn_at(x, y) } else { 0 });
        }
    }
    assert_eq!((&cut.truth, &cut.telemetry), (&whole.truth, &whole.telemetry));
    for (cut, whole) in cut.objects.iter().zip(&whole.objects) {
        assert_eq!(ObjectTruth { cut: 0.0, ..cut.clone() }, *whole);
    }
}

#[test]
fn errors_of_the_knowledge_change_telemetry_and_nothing_else() {
    let mut perfect = restless();
    perfect.knowledge = KnowledgeConfig::default();
    let (base, perfect) = (one(&restless(), 5), one(&perfect, 5));
    assert_eq!(perfect.telemetry.body_from_icrs, perfect.truth.body_from_icrs);
    assert_ne!(base.telemetry.body_from_icrs, base.truth.body_from_icrs);
    assert_eq!((&base.frame, &base.truth, &base.objects), (&perfect.frame, &perfect.truth, &perfect.objects));
}

#[test]
fn errors_of_the_control_leave_the_draws_of_the_knowledge_as_they_were() {
    // Latency is off: the error due to a time tag depends on the control errors as well, and is not a draw.
    let with = |control: Option<ControlConfig>| {
        let mut simulation = restless();
        simulation.knowledge.latency_s = 0.0;
        simulation.attitude.control = control.unwrap_or(simulation.attitude.control);
        let exposure = one(&simulation, 5);
        (
            exposure.telemetry.body_from_icrs * exposure.truth.body_from_icrs.inverse(),
            exposure.truth.body_from_icrs,
        )
    };
    let (restless, still) = (with(None), with(Some(ControlConfig::default())));
    // The rounding error of quaternion products is 1e-16.
    assert!(restless.0.angle_to(&still.0).radians() < 1e-15);
    assert!(restless.1.angle_to(&still.1).radians() > 1e-5);
}

#[test]
fn another_seed_draws_other_noise_and_keeps_the_detector() {
    let other = Simulation { seed: 1, ..still() };
    let (a, b) = (one(&still(), 5), one(&other, 5));
    assert_eq!((&a.truth, &a.objects), (&b.truth, &b.objects));
    // Two draws of a distribution with a standard deviation of 1.6 DN are equal in one case of five or six.
    let share = differing(&a, &b).len() as f64 / a.frame.dn().len() as f64;
    assert!((0.75..0.9).contains(&share), "{share}");
}
