//! Effects switched one by one: the draws of all other effects stay the same to the bit.

use std::collections::BTreeSet;

use boresight_sim::scene::{BackgroundConfig, BoxConfig, SurfaceConfig, TargetConfig};
use boresight_sim::sensor::{InterlaceConfig, LineNoiseConfig, RollingShutterConfig, RowParity, Switch};
use boresight_sim::truth::ObjectKind::{self, CosmicRay, HotPixel, Moon, Planet, Star, Target};
use boresight_sim::truth::TargetAttitudeConfig;
use boresight_sim::{Exposure, Simulation};

use crate::small_scene::{cosmic_rays, defective, looking_at, simulator, still};

fn one(simulation: &Simulation, frame: u64) -> Exposure {
    simulator(simulation).camera().unwrap().expose(frame).unwrap()
}

/// Returns number, position and electrons of all objects of a kind.
fn positions_and_electrons(exposure: &Exposure, kind: ObjectKind) -> Vec<(u32, [f64; 4])> {
    let of_kind = exposure.objects.iter().filter(|object| object.kind == kind);
    of_kind.map(|o| (o.id, [o.position.x, o.position.y, o.electrons, o.peak_electrons])).collect()
}

fn positions(exposure: &Exposure, kind: ObjectKind) -> BTreeSet<(u32, [u64; 2])> {
    let of_kind = exposure.objects.iter().filter(|object| object.kind == kind);
    of_kind.map(|o| (o.id, [o.position.x.to_bits(), o.position.y.to_bits()])).collect()
}

/// Checks that the switch changes the frame, and in its truth only the objects of the kinds `touched`.
fn check(all: &Simulation, name: &str, switch: fn(&mut Simulation), touched: &[ObjectKind]) {
    let mut simulation = all.clone();
    switch(&mut simulation);
    let (base, other) = (one(all, 4), one(&simulation, 4));
    assert_ne!(other.frame, base.frame, "{name} does nothing");
    assert_eq!(other.telemetry, base.telemetry, "{name}");
    let (was, is) = (&base.truth, &other.truth);
    assert_eq!(
        (is.body_from_icrs, is.camera_from_icrs),
        (was.body_from_icrs, was.camera_from_icrs),
        "{name}"
    );
    assert_eq!(
        (is.exposure_s, is.line_of_sight, is.sun),
        (was.exposure_s, was.line_of_sight, was.sun),
        "{name}"
    );
    for kind in [Target, Star, Planet, Moon, HotPixel, CosmicRay] {
        if !touched.contains(&kind) {
            assert_eq!(
                positions_and_electrons(&other, kind),
                positions_and_electrons(&base, kind),
                "{name}: {kind:?}"
            );
        }
    }
    // Positions are drawn independently of all effects on the charge; a dead pixel hides an object at its
    // position.
    let kept = |kind| positions(&other, kind).is_superset(&positions(&base, kind));
    assert!(kept(HotPixel), "{name}");
    assert!(kept(CosmicRay) || name == "cosmic rays", "{name}");
}

/// A white cube with sides of half a metre.
fn cube() -> TargetConfig {
    let surface = SurfaceConfig { diffuse: 0.8, specular: 0.0, roughness: 0.1 };
    TargetConfig::Plates {
        attitude: TargetAttitudeConfig::default(),
        boxes: vec![BoxConfig { centre_m: [0.0; 3], size_m: [0.5; 3], surface }],
        plates: vec![],
    }
}

#[test]
fn switching_an_effect_leaves_every_other_draw_as_it_was() {
    let mut all = defective(still());
    // Some dead pixels lie in the images of stars, and some wells are full.
    all.sensor.fixed_pattern.dead_pixels = 1500;
    all.sensor.full_well_e = 10_000.0;
    all.sensor.interlace = Some(InterlaceConfig { field_interval_s: 0.02, first_field: RowParity::Even });
    all.background.faint_stars_s10 = 100.0;
    // Objects whose signal falls on the pixels, and those that also arise in the pixels.
    let sky = [Target, Star, Planet, Moon];
    let charge = [Target, Star, Planet, Moon, HotPixel, CosmicRay];
    type Switching = fn(&mut Simulation);
    let switches: [(&str, Switching, &[ObjectKind]); 16] = [
        ("cosmic rays", |s| s.sensor.cosmic_rays = None, &[CosmicRay]),
        ("telegraph", |s| s.sensor.hot_pixels.telegraph = None, &[HotPixel]),
        ("lines", |s| s.sensor.line_noise = LineNoiseConfig::default(), &[]),
        ("blooming", |s| s.sensor.blooming = None, &[]),
        ("bent", |s| s.sensor.non_linearity = 0.0, &[]),
        ("read noise", |s| s.sensor.noise.read = Switch::Off, &[]),
        ("shot noise", |s| s.sensor.noise.shot = Switch::Off, &[]),
        ("PRNU", |s| s.sensor.fixed_pattern.prnu_fraction = 0.0, &sky),
        ("DSNU", |s| s.sensor.fixed_pattern.dsnu_fraction = 0.0, &[]),
        ("column offsets", |s| s.sensor.fixed_pattern.column_offset_e = 0.0, &[]),
        (
            "dead pixels",
            |s| (s.sensor.fixed_pattern.dead_pixels, s.sensor.fixed_pattern.dead_columns) = (0, 0),
            &charge,
        ),
        ("frame transfer", |s| s.sensor.frame_transfer_s = 0.0, &[]),
        // For hot pixels, the times at which they switch change.
        ("interlace", |s| s.sensor.interlace = None, &[Target, Star, Planet, Moon, HotPixel]),
        ("background", |s| s.background = BackgroundConfig::default(), &[]),
        ("a beacon", |s| s.target = TargetConfig::Beacon { magnitude_at_1_km: 1.0 }, &[Target]),
        ("plates", |s| s.target = cube(), &[Target]),
    ];
    for (name, switch, touched) in switches {
        check(&all, name, switch, touched);
    }
    let mut vibrating = all.clone();
    vibrating.attitude.control.vibration_arcsec = [60.0; 3];
    check(&vibrating, "vibration", |s| s.attitude.control.vibration_arcsec = [0.0; 3], &sky);
    let mut rolling = all.clone();
    rolling.sensor.interlace = None;
    rolling.sensor.frame_transfer_s = 0.0;
    rolling.sensor.rolling_shutter = Some(RollingShutterConfig { row_time_s: 0.001 });
    let touched = [Target, Star, Planet, Moon, HotPixel];
    check(&rolling, "rolling shutter", |s| s.sensor.rolling_shutter = None, &touched);
    // Direction of Saturn in that spring.
    all.solar_system = Switch::On;
    all.attitude = looking_at(203.4, -6.8);
    check(&all, "solar system", |s| s.solar_system = Switch::Off, &[Planet, Moon]);
}

/// Strengths far below what any pixel's distribution can show.
#[test]
fn an_effect_of_zero_strength_changes_no_pixel() {
    let plain = still();
    type Change = fn(&mut Simulation);
    let effects: [(&str, Change); 7] = [
        ("background", |s| s.background.faint_stars_s10 = 1e-12),
        ("vibration", |s| s.attitude.control.vibration_arcsec = [1e-9; 3]),
        ("rolling shutter", |s| s.sensor.rolling_shutter = Some(RollingShutterConfig { row_time_s: 1e-15 })),
        ("PRNU", |s| s.sensor.fixed_pattern.prnu_fraction = 1e-13),
        ("DSNU", |s| s.sensor.fixed_pattern.dsnu_fraction = 1e-13),
        ("frame transfer", |s| s.sensor.frame_transfer_s = 1e-15),
        ("lines", |s| s.sensor.line_noise = LineNoiseConfig::default()),
    ];
    let frame = one(&plain, 4).frame;
    for (name, change) in effects {
        let mut simulation = plain.clone();
        change(&mut simulation);
        assert!(one(&simulation, 4).frame == frame, "{name}");
    }
}

#[test]
fn without_the_rays_only_the_pixels_of_their_tracks_change() {
    let mut still_struck = still();
    still_struck.sensor.cosmic_rays = Some(cosmic_rays(1000.0));
    let (struck, plain) = (one(&still_struck, 4), one(&still(), 4));
    let tracks: Vec<_> = struck.objects.iter().filter(|object| object.kind == CosmicRay).collect();
    assert!(!tracks.is_empty());
    let pairs = struck.frame.dn().iter().zip(plain.frame.dn()).enumerate();
    for (index, _) in pairs.filter(|(_, (a, b))| a != b) {
        let pixel = contract::PixelPoint::new((index % 160) as f64, (index / 160) as f64);
        assert!(
            tracks.iter().any(|track| pixel.distance(track.position) <= track.radius_px.max(1.5)),
            "{index}"
        );
    }
}
