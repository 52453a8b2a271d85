//! Five real frames of a star camera, by their sources.
//!
//! `real_sky.csv` has the sixty most significant sources of each frame, found by [`find_sources`] in img0,
//! img1, img3, img4 and img6 of the public repository UBNanosatLab/openstartracker,
//! `tests/science_cam_may8_0.05sec_gain40`, MIT licence, Copyright (c) 2018 UB Nanosatellite Laboratory (1392
//! × 1040 pixels, 0.05 s, gain 40; about 8 May 2016). `BORESIGHT_REAL_SKY=FOLDER cargo test -p
//! boresight-camera-fit --test real_sky -- --ignored` makes it anew.

use std::fmt::Write as _;
use std::path::Path;

use boresight_camera_fit::solution::{FrameSolution, solve_frames};
use boresight_camera_fit::sources::{ImageSources, Source, find_sources};
use contract::{Camera, Direction, Icrs, ListedStar, PixelPoint};
use files::read_grey_image;
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::catalog::Catalog;
use sim::truth::{Observer, StarMotion};

const TABLE: &str = include_str!("real_sky.csv");

/// Frames with the right ascension and declination of the image's centre, degrees, by an independent solver:
/// tetra3rs 0.14 with Gaia, centroids by SEP, a field of 6.1° ± 0.5°, without aberration. It has none for
/// img1.
const SOLVED: [(&str, Option<[f64; 2]>); 5] = [
    ("img0", Some([181.1716, 16.8348])),
    ("img1", None),
    ("img3", Some([169.9865, 13.7502])),
    ("img4", Some([179.8211, 15.7372])),
    ("img6", Some([151.9654, 19.1509])),
];

/// Returns the sources of the frames, in the order of [`SOLVED`].
fn frames() -> Vec<ImageSources> {
    let mut frames = Vec::new();
    for (name, _) in SOLVED {
        let mut sources = Vec::new();
        for line in TABLE.lines().filter(|line| line.starts_with(name)) {
            let cells: Vec<f64> =
                line.split(',').skip(1).map(|cell| cell.parse().expect("a number")).collect();
            sources.push(Source {
                position: PixelPoint::new(cells[0], cells[1]),
                flux_dn: cells[2],
                significance: cells[2],
                sigma_px: 0.1,
                width_px: 1.0,
                elongation: [0.0; 2],
                peak: [cells[0].round() as usize, cells[1].round() as usize],
                is_spike: cells[3] == 1.0,
                is_saturated: false,
            });
        }
        assert!(sources.len() > 20, "{name}");
        frames.push(ImageSources { sources, background_dn: 1.0, noise_dn: 1.0 });
    }
    frames
}

/// Solves the frames by a camera of a field, degrees, wrong by up to 15 %.
fn solve(field_deg: f64, is_mirrored: bool) -> Vec<Option<FrameSolution>> {
    let time = Epoch::from_gregorian_utc_at_midnight(2016, 5, 8);
    let observer =
        Observer::new(time, Vector3::zeros(), Vector3::zeros()).expect("a time of the ephemerides");
    let catalog = Catalog::hipparcos2();
    let stars: Vec<ListedStar> = catalog
        .stars()
        .iter()
        .filter(|star| star.v_mag() < 10.0)
        .map(|star| ListedStar {
            id: star.id,
            direction: observer.apparent(&StarMotion::new(star)),
            magnitude: star.v_mag(),
        })
        .collect();
    let camera = Camera {
        columns: 1392,
        rows: 1040,
        focal_length_mm: 0.5 * 1392.0 * 5e-3 / libm::tan(0.5 * field_deg.to_radians()),
        pixel_width_um: 5.0,
        pixel_height_um: 5.0,
        principal_x_px: 695.5,
        principal_y_px: 519.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    };
    let mut frames = frames();
    if is_mirrored {
        for source in frames.iter_mut().flat_map(|frame| &mut frame.sources) {
            source.position.x = 1391.0 - source.position.x;
        }
    }
    solve_frames(&frames, &stars, &camera, 0.15).expect("a possible camera")
}

/// The four frames that the independent solver solves are solved at a field told within ± 10 %, and none
/// falsely.
#[test]
fn real_frames_are_solved_without_their_focal_length() {
    for field_deg in [5.55, 6.1, 6.65] {
        let solutions = solve(field_deg, false);
        for ((name, expected), solution) in SOLVED.iter().zip(&solutions) {
            assert_eq!(solution.is_some(), expected.is_some(), "{name} at {field_deg}°");
            let (Some(solution), Some([ra_deg, dec_deg])) = (solution, expected) else { continue };
            let ahead: Direction<Icrs> = solution.camera_from_icrs.inverse() * Direction::z();
            let expected = Direction::from_ra_dec(
                contract::Angle::from_degrees(*ra_deg),
                contract::Angle::from_degrees(*dec_deg),
            );
            // Aberration in May at these places is 10″ to 19″, and a pixel 16″.
            let apart_arcsec = ahead.separation(&expected).degrees() * 3600.0;
            assert!(apart_arcsec < 45.0, "{name} at {field_deg}°: {apart_arcsec:.1}″");
            // The independent field is 6.0736° to 6.0765°.
            let ratio = libm::tan(0.5 * field_deg.to_radians()) / solution.focal_ratio;
            let found_deg = 2.0 * libm::atan(ratio).to_degrees();
            assert!((6.05..6.10).contains(&found_deg), "{name} at {field_deg}°: {found_deg}°");
        }
    }
}

#[test]
fn mirrored_frames_have_no_attitude() {
    assert!(solve(6.1, true).iter().all(Option::is_none));
}

#[test]
#[ignore = "writes the table from the frames in the folder BORESIGHT_REAL_SKY"]
fn write_the_table() {
    let folder = std::env::var("BORESIGHT_REAL_SKY").unwrap();
    let mut text = "# frame, x px, y px, significance, 1 for a spike; origin: real_sky.rs\n".to_owned();
    for (name, _) in SOLVED {
        let image = read_grey_image(&Path::new(&folder).join(format!("{name}.png"))).unwrap();
        for source in find_sources(&image, image.full_scale).sources.iter().take(60) {
            let PixelPoint { x, y } = source.position;
            let spike = u8::from(source.is_spike);
            writeln!(text, "{name},{x:.3},{y:.3},{:.2},{spike}", source.significance).unwrap();
        }
    }
    std::fs::write(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/real_sky.csv"), text).unwrap();
}
