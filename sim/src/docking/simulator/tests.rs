use contract::docking::Pose;
use contract::{Camera, PixelPoint};
use nalgebra::Vector3;
use sensor::television::{Interlace, VideoNoiseConfig};
use truth::approach::{ApproachConfig, ConstantVelocityConfig};

use super::*;
use crate::docking::{FloodlightConfig, GlintConfig, LensConfig, ShadeConfig, SunConfig};

const FOCAL_PX: f64 = 1000.0;

fn camera() -> Camera {
    Camera {
        columns: 384,
        rows: 288,
        focal_length_mm: 10.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 191.5,
        principal_y_px: 143.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

fn sun(azimuth_deg: f64, elevation_deg: f64) -> Option<SunConfig> {
    Some(SunConfig {
        azimuth_deg,
        elevation_deg,
        rate_deg_s: 0.0,
        rate_axis: [0.0, 1.0, 0.0],
        irradiance: std::f64::consts::PI,
    })
}

fn simulation() -> DockingSimulation {
    let use_of =
        |name: &str, until_range_m| CameraConfig { name: name.into(), until_range_m, camera: camera() };
    DockingSimulation {
        seed: 7,
        start_utc: "2004-01-31T13:00:00Z".into(),
        target: "progress".into(),
        approach: ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
            position_m: [0.02, -0.03, 4.0],
            velocity_m_s: [0.05, 0.1, -0.5],
            phi_deg: [0.5, -0.3, 2.0],
            phi_rate_deg_s: [0.1, 0.2, 1.0],
            duration_s: 4.0,
        }),
        cameras: vec![use_of("TV-1", 3.0), use_of("TV-2", 0.0)],
        lens: LensConfig::default(),
        lighting: LightingConfig { sun: sun(25.0, 20.0), fill_radiance: 0.1, ..LightingConfig::default() },
        television: TelevisionConfig::default(),
    }
}

fn simulator(simulation: &DockingSimulation) -> DockingSimulator {
    DockingSimulator::new(simulation, Path::new(".")).unwrap()
}

fn at_rest(position_m: [f64; 3], phi_deg: [f64; 3]) -> ApproachConfig {
    ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
        position_m,
        velocity_m_s: [0.0; 3],
        phi_deg,
        phi_rate_deg_s: [0.0; 3],
        duration_s: 0.0,
    })
}

fn exposed(simulation: &DockingSimulation, field: u64) -> FieldExposure {
    let simulator = simulator(simulation);
    simulator.expose(&mut simulator.workspace().unwrap(), field).unwrap()
}

#[test]
fn a_field_alone_is_the_field_of_the_run() {
    let simulation = DockingSimulation { television: TelevisionConfig::all(), ..simulation() };
    let simulator = simulator(&simulation);
    assert_eq!(simulator.field_count(), 201);
    let mut workspace = simulator.workspace().unwrap();
    let run: Vec<_> = [99, 100, 101, 102].map(|k| simulator.expose(&mut workspace, k).unwrap()).into();
    for (i, k) in [(3, 102), (0, 99)] {
        assert_eq!(exposed(&simulation, k), run[i]);
    }
    assert!(simulator.expose(&mut workspace, 201).is_err());
}

#[test]
fn each_field_shows_its_rows_at_its_own_time() {
    let mut interlaced = simulation();
    interlaced.television.noise = VideoNoiseConfig { sigma_dn8: 0.0 };
    let mut progressive = interlaced.clone();
    progressive.television.interlace = Interlace::Off;
    progressive.television.frame_rate_hz = 50.0;
    for k in [20, 21] {
        let (field, frame) = (exposed(&interlaced, k), exposed(&progressive, k));
        assert_eq!(field.truth.time_s, k as f64 / 50.0);
        assert_eq!(field.truth.pose, frame.truth.pose);
        for (row, signal) in field.video.signal().chunks_exact(384).enumerate() {
            let y = field.truth.lines.camera_row(row);
            assert_eq!(signal, &frame.video.signal()[y * 384..(y + 1) * 384]);
        }
    }
    // 20 ms at a velocity of (0.05, 0.1, −0.5) m/s.
    let moved =
        exposed(&interlaced, 21).truth.pose.position_m - exposed(&interlaced, 20).truth.pose.position_m;
    assert!((moved - Vector3::new(0.001, 0.002, -0.01)).norm() < 1e-12);
}

#[test]
fn the_lens_is_a_function_of_the_range() {
    let simulator = simulator(&simulation());
    for k in 0..simulator.field_count() {
        let field_state = simulator.field_state(k).unwrap();
        assert_eq!(field_state.camera, usize::from(field_state.state.range_m() < 3.0));
    }
    assert_eq!(simulator.field_state(0).unwrap().camera, 0);
    assert_eq!(simulator.field_state(200).unwrap().camera, 1);
    assert_eq!(simulator.setup().cameras.len(), 2);
}

#[test]
fn projected_centres_are_those_of_the_geometry() {
    // Without rotation the paper's formulas (3.1) are exact.
    let (d1, d2, d3, b) = (0.1, -0.2, 5.0, 0.30);
    let straight = DockingSimulation { approach: at_rest([d1, d2, d3], [0.0; 3]), ..simulation() };
    let truth = exposed(&straight, 0).truth;
    let disk = PixelPoint::new(191.5 - FOCAL_PX * d1 / d3, 143.5 + FOCAL_PX * d2 / d3);
    let cross = PixelPoint::new(191.5 - FOCAL_PX * d1 / (d3 - b), 143.5 + FOCAL_PX * d2 / (d3 - b));
    assert!(truth.disk_centre.unwrap().distance(disk) < 1e-9);
    assert!(truth.cross_centre.unwrap().distance(cross) < 1e-9);
    assert!((truth.circle_radius_px.unwrap() - FOCAL_PX * 0.25 / d3).abs() < 1e-9);
    // A pitch about x1 raises the axis: points on the axis move by exactly f tan φ1 in the image.
    let pitched = DockingSimulation { approach: at_rest([0.0, 0.0, d3], [2.0, 0.0, 0.0]), ..simulation() };
    let centre = exposed(&pitched, 0).truth.disk_centre.unwrap();
    let shift = FOCAL_PX * libm::tan(2.0_f64.to_radians());
    assert!(centre.distance(PixelPoint::new(191.5, 143.5 + shift)) < 1e-9, "{centre:?}");
}

#[test]
fn the_target_is_drawn_at_its_true_position() {
    let mut simulation = DockingSimulation {
        approach: at_rest([0.0, 0.0, 3.5], [0.0, 0.0, 0.0]),
        lighting: LightingConfig { sun: sun(0.0, 0.0), ..LightingConfig::default() },
        ..simulation()
    };
    simulation.television.interlace = Interlace::Off;
    simulation.television.noise = VideoNoiseConfig { sigma_dn8: 0.0 };
    let exposure = exposed(&simulation, 0);
    let centre = exposure.truth.cross_centre.unwrap();
    // The cross's bars, white (0.80) on the plate (0.04), pass through the centre: 15 mm at 3.2 m are 4.7 px.
    let signal = |dx: f64, dy: f64| {
        let (x, y) = ((centre.x + dx).round() as usize, (centre.y + dy).round() as usize);
        exposure.video.signal()[y * 384 + x] - 0.05
    };
    for (dx, dy) in [(0.0, 0.0), (30.0, 0.0), (-30.0, 0.0), (0.0, 30.0), (0.0, -30.0)] {
        assert!((signal(dx, dy) - 0.80).abs() < 0.01, "{dx} {dy}: {}", signal(dx, dy));
    }
    for (dx, dy) in [(20.0, 20.0), (-20.0, 20.0), (20.0, -20.0)] {
        assert!((signal(dx, dy) - 0.04).abs() < 0.01, "{dx} {dy}: {}", signal(dx, dy));
    }
    assert!(exposure.truth.target_in_field && exposure.truth.cross_in_field);
    assert_eq!(exposure.truth.marks_in_field, 0xfff);
}

/// The bars' shadows are shifted by −b (s1, s2)/s3. With a shift of 0.2 m along y1, the horizontal bar's
/// shadow falls on the mark at 0° and the vertical bar's shadow on the marks at ±30°, and on no other.
#[test]
fn marks_in_the_shadow_of_the_cross_are_reported() {
    let azimuth = libm::atan(-0.2 / 0.30).to_degrees();
    let lighting = LightingConfig { sun: sun(azimuth, 0.0), ..LightingConfig::default() };
    let simulation = DockingSimulation { lighting, ..simulation() };
    let truth = exposed(&simulation, 0).truth;
    let marks = simulator(&simulation).setup().target.marks;
    for (i, mark) in marks.iter().enumerate() {
        let centre =
            mark.iter().fold([0.0, 0.0], |sum, corner| [sum[0] + corner[0] / 4.0, sum[1] + corner[1] / 4.0]);
        let angle = libm::atan2(centre[1], centre[0]).to_degrees();
        assert_eq!(truth.marks_shadowed >> i & 1 == 1, angle.abs() < 31.0, "mark at {angle}°");
    }
    assert!(truth.plate_lit > 0.6 && truth.plate_lit < 1.0, "{}", truth.plate_lit);
}

#[test]
fn a_shade_puts_half_of_the_target_into_shadow() {
    let corners_m = vec![[0.0, -1.0, 2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [0.0, 1.0, 2.0]];
    let lighting = LightingConfig {
        sun: sun(0.0, 0.0),
        shades: vec![ShadeConfig { corners_m }],
        ..LightingConfig::default()
    };
    let mut simulation =
        DockingSimulation { approach: at_rest([0.0, 0.0, 3.5], [0.0; 3]), lighting, ..simulation() };
    simulation.television.interlace = Interlace::Off;
    simulation.television.noise = VideoNoiseConfig { sigma_dn8: 0.0 };
    let exposure = exposed(&simulation, 0);
    let lit = exposure.truth.plate_lit;
    assert!(lit > 0.3 && lit < 0.5, "half of the plate less the cross's shadow: {lit}");
    let right = exposure.truth.cross_centre.unwrap();
    let at =
        |dx: f64| exposure.video.signal()[right.y.round() as usize * 384 + (right.x + dx).round() as usize];
    assert!(at(-30.0) > 0.8 && at(30.0) < 0.06, "{} {}", at(-30.0), at(30.0));
}

#[test]
fn at_night_the_lamp_lights_the_target() {
    let at_night = |floodlight| {
        let lighting = LightingConfig { floodlight, ..LightingConfig::default() };
        exposed(&DockingSimulation { lighting, ..simulation() }, 0)
    };
    let (dark, lit) = (at_night(None), at_night(Some(FloodlightConfig::default())));
    let mean = |exposure: &FieldExposure| {
        exposure.video.signal().iter().sum::<f32>() / exposure.video.signal().len() as f32
    };
    // Only the pedestal; the noise is 2 DN in 55 000 pixels.
    assert!((mean(&dark) - 0.05).abs() < 2e-4, "{}", mean(&dark));
    assert!(mean(&lit) > 0.1, "{}", mean(&lit));
    assert_eq!((dark.truth.sun, dark.truth.plate_lit, dark.truth.floodlight), (None, 0.0, false));
    assert!(lit.truth.floodlight);
}

#[test]
fn the_sun_in_the_field_is_reported_unless_the_station_hides_it() {
    let with = |azimuth, elevation, d| {
        let mut simulation = DockingSimulation {
            approach: at_rest([0.0, 0.0, d], [0.0; 3]),
            lighting: LightingConfig { sun: sun(azimuth, elevation), ..LightingConfig::default() },
            ..simulation()
        };
        simulation.television.sun_glare = Some(sensor::television::SunGlareConfig::default());
        exposed(&simulation, 0)
    };
    // The Sun is behind the station, 7° to the side and 5° above the axis; from 1500 m the station extends 2°
    // to each side.
    let free = with(173.0, 5.0, 1500.0);
    let image = free.truth.sun_image.unwrap();
    let shift = FOCAL_PX * libm::tan(7.0_f64.to_radians());
    assert!((image.x - 191.5 - shift).abs() < 1e-6, "{image:?}");
    assert_eq!(free.truth.sun_visible, 1.0);
    let at =
        |exposure: &FieldExposure| exposure.video.signal()[(image.y / 2.0) as usize * 384 + image.x as usize];
    assert!(at(&free) > 1.2, "saturated: {}", at(&free));
    let hidden = with(180.0, 0.0, 8.0);
    assert_eq!((hidden.truth.sun_image, hidden.truth.sun_visible), (None, 0.0));
    assert_eq!(with(20.0, 0.0, 8.0).truth.sun_image, None);
}

#[test]
fn a_glint_is_drawn_at_its_true_position_and_blooms() {
    let glint = GlintConfig {
        position_m: [0.1, 0.1, 0.0],
        normal: [0.0, 0.0, 1.0],
        strength_m2: 1e-4,
        lobe_deg: 5.0,
    };
    let with = |glints: Vec<GlintConfig>, bloom| {
        let mut simulation = DockingSimulation {
            approach: at_rest([0.0, 0.0, 3.5], [0.0; 3]),
            lighting: LightingConfig { sun: sun(0.0, 0.0), glints, ..LightingConfig::default() },
            ..simulation()
        };
        simulation.television.interlace = Interlace::Off;
        simulation.television.noise = VideoNoiseConfig { sigma_dn8: 0.0 };
        simulation.television.bloom = bloom;
        exposed(&simulation, 0)
    };
    let (plain, shining) = (with(vec![], None), with(vec![glint], None));
    let image = shining.truth.glint.unwrap();
    // 0.1 m at 3.5 m is 28.6 px to the right of the disk's centre and 28.6 px above it; the signal is π 1e-4
    // m² × (1000 px/3.5 m)², less 3 % for 1.2°.
    assert!(image.centre.distance(PixelPoint::new(191.5 + 1e2 / 3.5, 143.5 - 1e2 / 3.5)) < 1e-9);
    assert!(image.light > 20.0 && image.light < 26.0, "{}", image.light);
    let at = |exposure: &FieldExposure, dx: usize| exposure.video.signal()[115 * 384 + 220 + dx];
    assert!(at(&plain, 0) < 0.1 && at(&shining, 0) > 1.2);
    assert_eq!(at(&plain, 12), at(&shining, 12));
    let blooming = with(vec![glint], Some(sensor::television::BloomConfig::default()));
    assert!(at(&blooming, 12) > at(&shining, 12));
}

#[test]
fn an_image_drawn_elsewhere_goes_through_the_same_chain() {
    let simulator = simulator(&simulation());
    let mut workspace = simulator.workspace().unwrap();
    let expected = simulator.expose(&mut workspace, 5).unwrap();
    let image = workspace.radiance().clone();
    let mut other = simulator.workspace().unwrap();
    assert_eq!(simulator.expose_image(&mut other, 5, &image).unwrap(), expected);
    let small = RadianceImage { columns: 2, rows: 2, radiance: vec![0.0; 4] };
    assert!(simulator.expose_image(&mut other, 5, &small).is_err());
}

#[test]
fn the_digitiser_acts_on_a_field_that_is_drawn_already() {
    let exposure = exposed(&simulation(), 3);
    let plain = exposure.video.digitise(&Digitiser::default());
    let stretched = exposure.video.digitise(&Digitiser { contrast: 2.0, brightness: -0.1 });
    assert_eq!(plain.image().full_scale_dn(), 255);
    for ((signal, a), b) in exposure.video.signal().iter().zip(plain.image().dn()).zip(stretched.image().dn())
    {
        let dn = |v: f32| (255.0 * v).clamp(0.0, 255.0);
        assert!((f32::from(*a) - dn(*signal)).abs() < 0.501);
        assert!((f32::from(*b) - dn(2.0 * signal - 0.1)).abs() < 0.501);
    }
}

#[test]
fn bad_values_are_refused_with_their_path() {
    let refused = |path: &str, change: &dyn Fn(&mut DockingSimulation)| {
        let mut simulation = simulation();
        change(&mut simulation);
        let message = DockingSimulator::new(&simulation, Path::new(".")).unwrap_err().to_string();
        assert!(message.starts_with(path), "{message}");
    };
    refused("start_utc", &|s| s.start_utc = "yesterday".into());
    refused("target \"nowhere.toml\"", &|s| s.target = "nowhere.toml".into());
    refused("cameras", &|s| s.cameras.clear());
    refused("cameras[0].name", &|s| s.cameras[0].name = "Kamera ü".into());
    refused("cameras[1].until_range_m", &|s| s.cameras[1].until_range_m = 1.0);
    refused("cameras[0].until_range_m", &|s| s.cameras[0].until_range_m = 0.0);
    refused("cameras[1].camera.focal_length_mm", &|s| s.cameras[1].camera.focal_length_mm = -1.0);
    refused("cameras[1].camera", &|s| s.cameras[1].camera.rows = 100);
    refused("lens.blur_sigma_px", &|s| s.lens.blur_sigma_px = f64::NAN);
    refused("lighting.sun.azimuth_deg", &|s| s.lighting.sun = sun(400.0, 0.0));
    let bad = GlintConfig { position_m: [0.0; 3], normal: [0.0; 3], strength_m2: 0.1, lobe_deg: 1.0 };
    refused("lighting.glints[0].normal", &|s| s.lighting.glints = vec![bad]);
    refused("television.frame_rate_hz", &|s| s.television.frame_rate_hz = 0.0);
    refused("approach.position_m", &|s| s.approach = at_rest([0.0, 0.0, -1.0], [0.0; 3]));
}

/// Built-in scenario without the keys that only the oracle reads.
fn built_in() -> DockingSimulation {
    let mut table: toml::Table = toml::from_str(include_str!("../../../../scenarios/docking.toml")).unwrap();
    for key in ["world", "title", "docking"] {
        table.remove(key);
    }
    table.try_into().unwrap()
}

/// With the lamp no mark is dark; without Sun and lamp all marks are dark.
#[test]
fn at_night_the_lamp_determines_the_dark_marks() {
    let truth = |floodlight| {
        let lighting = LightingConfig { floodlight, ..LightingConfig::default() };
        exposed(&DockingSimulation { lighting, ..simulation() }, 0).truth
    };
    let night = truth(None);
    assert_eq!((night.marks_shadowed, night.marks_dark, night.plate_lit), (0, 0xfff, 0.0));
    let lit = truth(Some(FloodlightConfig::default()));
    assert_eq!(lit.marks_dark, 0);
    assert!(lit.plate_lit > 0.8, "{}", lit.plate_lit);
}

/// Seen from d3, the bars at b = 0.30 m cover the circle of the marks, r = 0.25 m, out to 0.15 d3/(d3 − b):
/// beyond r − 0.02 m for d3 < 0.86 m.
#[test]
fn near_the_target_the_cross_hides_four_marks() {
    let hidden = |d3| {
        let approach = at_rest([0.0, 0.0, d3], [0.0; 3]);
        exposed(&DockingSimulation { approach, ..simulation() }, 0).truth.marks_hidden
    };
    assert_eq!(hidden(0.95), 0);
    assert_eq!(hidden(0.80).count_ones(), 4);
}

#[test]
fn the_built_in_approach_goes_from_500_m_to_contact_in_eight_to_ten_minutes() {
    let simulation = built_in();
    let simulator = simulator(&simulation);
    let count = simulator.field_count();
    assert!((25_000..=30_000).contains(&count), "{count}");
    let (first, last) = (simulator.field_state(0).unwrap(), simulator.field_state(count - 1).unwrap());
    assert!((first.state.pose.position_m.z - 500.0).abs() < 1e-9);
    assert!((last.state.pose.position_m.z - 0.5).abs() < 0.1 / 50.0);
    assert!((last.state.velocity_m_s.z + 0.1).abs() < 1e-9);
    assert_eq!((first.camera, last.camera), (0, 1));
    // Every artefact is on, at its default size.
    let all = TelevisionConfig { white_radiance: 0.9, ..TelevisionConfig::all() };
    assert_eq!(simulation.television, all);
}

#[test]
fn the_marks_stay_in_the_field_of_the_built_in_approach_down_to_3_m_and_1_15_m() {
    let simulator = simulator(&built_in());
    for k in (0..simulator.field_count()).step_by(25) {
        let field_state = simulator.field_state(k).unwrap();
        let pose: &Pose = &field_state.state.pose;
        // Range below which the narrow and the wide lens lose marks.
        let least_m = [3.0, 1.15][field_state.camera];
        if pose.position_m.z > least_m {
            let eye = &simulator.eyes[field_state.camera];
            let inside = simulator.geometry.marks_in_field(eye, pose);
            assert_eq!(inside, 0xfff, "at {:.3} m, field {k}", pose.position_m.z);
        }
    }
}

#[test]
fn a_simulation_reads_back_as_it_was_written() {
    for simulation in [simulation(), built_in()] {
        let text = toml::to_string(&simulation).unwrap();
        assert_eq!(toml::from_str::<DockingSimulation>(&text).unwrap(), simulation);
    }
}
