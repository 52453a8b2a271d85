//! `boresight sky`: one picture of the sky.

use boresight::files::read_frame;
use contract::Frame;

use crate::support::Bench;

/// Words of the command for a picture of Orion, without the file.
const ORION: &str = "sky --ra 83.6 --dec -5.4 --camera uasc-far-range";

/// A star of Orion with its position of SIMBAD, ICRS at J2000. Proper motion is below 0.01 px in 26 years.
struct Star {
    name: &'static str,
    ra_h_min_s: [f64; 3],
    dec_d_min_s: [f64; 3],
}

const STARS: [Star; 5] = [
    Star { name: "Rigel", ra_h_min_s: [5.0, 14.0, 32.272], dec_d_min_s: [8.0, 12.0, 5.90] },
    Star { name: "Saiph", ra_h_min_s: [5.0, 47.0, 45.389], dec_d_min_s: [9.0, 40.0, 10.58] },
    Star { name: "Alnitak", ra_h_min_s: [5.0, 40.0, 45.527], dec_d_min_s: [1.0, 56.0, 34.26] },
    Star { name: "Alnilam", ra_h_min_s: [5.0, 36.0, 12.813], dec_d_min_s: [1.0, 12.0, 6.91] },
    Star { name: "Mintaka", ra_h_min_s: [5.0, 32.0, 0.400], dec_d_min_s: [0.0, 17.0, 56.74] },
];

impl Star {
    /// Returns the pixel by the gnomonic projection about the boresight (83.6°, −5.4°), north up and east
    /// left, and the radial distortion of the camera, without aberration.
    fn pixel(&self) -> [f64; 2] {
        let sexagesimal = |[whole, minutes, seconds]: [f64; 3]| whole + minutes / 60.0 + seconds / 3600.0;
        let ra = (15.0 * sexagesimal(self.ra_h_min_s) - 83.6).to_radians();
        // All five are south of the equator.
        let dec = -sexagesimal(self.dec_d_min_s).to_radians();
        let dec0 = (-5.4_f64).to_radians();
        let ahead = libm::sin(dec0) * libm::sin(dec) + libm::cos(dec0) * libm::cos(dec) * libm::cos(ra);
        let east = libm::cos(dec) * libm::sin(ra) / ahead;
        let north =
            (libm::cos(dec0) * libm::sin(dec) - libm::sin(dec0) * libm::cos(dec) * libm::cos(ra)) / ahead;
        // 20.187 mm in pixels of 8.6 × 8.3 µm.
        let (u, v) = (-east * 20_187.0 / 8.6, -north * 20_187.0 / 8.3);
        let factor = 1.0 + 2.6e-8 * (u * u + v * v);
        [395.0 + u * factor, 288.0 + v * factor]
    }
}

/// Returns the centre of brightness within 4 px of a point.
fn centroid(frame: &Frame, [x, y]: [f64; 2]) -> [f64; 2] {
    let (mut light, mut sums) = (0.0, [0.0; 2]);
    for row in y.round() as usize - 4..=y.round() as usize + 4 {
        for column in x.round() as usize - 4..=x.round() as usize + 4 {
            // Bias, dark current and noise of this camera are below 46 DN.
            let dn = (f64::from(frame.dn()[row * frame.columns() + column]) - 48.0).max(0.0);
            light += dn;
            sums = [sums[0] + dn * column as f64, sums[1] + dn * row as f64];
        }
    }
    assert!(light > 100.0, "no star at {x}, {y}");
    sums.map(|sum| sum / light)
}

/// The stars of the picture are where the catalogue of another source has them, north up and east left.
#[test]
fn the_stars_of_orion_are_where_they_should_be() {
    let bench = Bench::new();
    let answer = bench.boresight(&format!("{ORION} --exposure 0.05 -o orion.fits --json")).done().json();
    assert_eq!(answer["north"], "north up, east left");
    let frame = read_frame(&bench.path("orion.fits"), 0, 12, None).unwrap();
    let listed = answer["brightest"].as_array().unwrap();
    for star in STARS {
        let expected = star.pixel();
        let found = centroid(&frame, expected);
        let error = libm::hypot(found[0] - expected[0], found[1] - expected[1]);
        // The largest aberration, 20.5″ by the Earth's motion and 1.6″ by the orbit, is 0.26 px of 85″.
        assert!(error < 0.35, "{}: {found:?}, expected {expected:?}", star.name);
        // The answer lists the same star there, to the noise of the centroid.
        let entry = listed.iter().find(|entry| entry["name"] == star.name).unwrap();
        let [x, y] = ["x_px", "y_px"].map(|key| entry[key].as_f64().unwrap());
        assert!(libm::hypot(x - found[0], y - found[1]) < 0.1, "{}: {x}, {y}, {found:?}", star.name);
    }
    let header =
        String::from_utf8_lossy(&std::fs::read(bench.path("orion.fits")).unwrap()[..14_400]).into_owned();
    for card in ["RA---TAN-SIP", "CRVAL1", "EXPTIME", "2026-01-01T00:00:00"] {
        assert!(header.contains(card), "{card}");
    }
}

#[test]
#[ignore = "needs Python with tests/python/requirements.txt; BORESIGHT_PYTHON names it, python3 otherwise"]
fn astropy_finds_the_stars_of_orion() {
    let bench = Bench::new();
    bench.boresight(&format!("{ORION} --exposure 0.05 -o orion.fits")).done();
    let python = std::env::var("BORESIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/python/check_sky.py");
    let output =
        std::process::Command::new(python).arg(script).arg(bench.path("orion.fits")).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("5 stars within") && text.contains("north up"), "{text}");
}

/// Rolled by half a turn, the stars are opposite; with another time, Rigel moves by the change of aberration
/// only.
#[test]
fn roll_and_time_move_the_stars() {
    let bench = Bench::new();
    let rigel = |words: &str, file: &str| -> [f64; 2] {
        let answer = bench.boresight(&format!("{ORION} {words} -o {file} --json")).done().json();
        let stars = answer["brightest"].as_array().unwrap();
        let entry = stars.iter().find(|entry| entry["name"] == "Rigel").unwrap();
        ["x_px", "y_px"].map(|key| entry[key].as_f64().unwrap())
    };
    let upright = rigel("", "a.png");
    let turned = rigel("--roll 180", "b.png");
    // The aberration, up to 0.26 px, has another direction in the turned picture.
    assert!((upright[0] + turned[0] - 790.0).abs() < 0.6, "{upright:?}, {turned:?}");
    assert!((upright[1] + turned[1] - 576.0).abs() < 0.6, "{upright:?}, {turned:?}");
    let half_a_year_later = rigel("--time 2026-07-01T00:00:00Z", "c.png");
    let moved = libm::hypot(half_a_year_later[0] - upright[0], half_a_year_later[1] - upright[1]);
    assert!((0.1..0.55).contains(&moved), "{moved} px");
}

/// The picture is grey and as large as the detector; with labels some pixels have the colour of the labels.
/// The raw file has the digital numbers of the FITS file.
#[test]
fn each_kind_of_file_has_its_pixels() {
    let bench = Bench::new();
    let text = bench.boresight(&format!("{ORION} -o orion.png")).done().stdout;
    for part in ["orion.png: 752 × 580 px, 18.", "north up, east left", "Rigel (V 0.2) at 597, 408"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    let open = |name: &str| image::open(bench.path(name)).unwrap();
    let plain = open("orion.png").to_rgb8();
    assert_eq!(plain.dimensions(), (752, 580));
    assert!(plain.pixels().all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]));
    // Stretched so that Rigel is white and the sky is dark, but not black everywhere.
    assert!(plain.get_pixel(597, 408)[0] > 250);
    let mean = plain.pixels().map(|pixel| f64::from(pixel[0])).sum::<f64>() / f64::from(752 * 580);
    assert!((2.0..60.0).contains(&mean), "{mean}");

    // An earlier picture is replaced.
    bench.boresight(&format!("{ORION} --label -o orion.png")).done();
    let labelled = open("orion.png").to_rgb8();
    let coloured = labelled.pixels().filter(|pixel| pixel[0] != pixel[2]).count();
    assert!(coloured > 500, "{coloured}");

    bench.boresight(&format!("{ORION} -o orion.fits")).done();
    bench.boresight(&format!("{ORION} --raw -o raw.png")).done();
    let raw = open("raw.png").into_luma16().into_raw();
    assert_eq!(raw, read_frame(&bench.path("orion.fits"), 0, 12, None).unwrap().dn());
    bench.boresight(&format!("{ORION} --seed 2 --raw -o other.png")).done();
    assert_ne!(raw, open("other.png").into_luma16().into_raw());
    bench.boresight(&format!("{ORION} --seed 1 --raw -o again.png")).done();
    bench.check_same("raw.png", "again.png");
}

#[test]
fn a_camera_may_be_a_file_whose_mistakes_are_located() {
    let bench = Bench::new();
    let camera = bench.boresight("scenario camera uasc-far-range").done().stdout;
    bench.write("mine.toml", &camera);
    bench.boresight("sky --ra 83.6 --dec -5.4 --camera mine.toml --raw -o a.png").done();
    bench.boresight(&format!("{ORION} --raw -o b.png")).done();
    bench.check_same("a.png", "b.png");
    let refused = |old: &str, new: &str, parts: &[&str]| {
        bench.write("mine.toml", camera.replacen(old, new, 1));
        bench.boresight("sky --ra 83.6 --dec -5.4 --camera mine.toml -o c.png").refused(parts);
    };
    refused("columns = 752", "columns = 0", &["mine.toml:", "camera.columns", "1 to 16384"]);
    refused("sigma_px = 0.8", "sigma = 0.8", &["mine.toml:", "sigma"]);
    refused("read_noise_e = 15.0", "read_noise_e = -1.0", &["mine.toml:", "sensor.read_noise_e"]);
    refused("[radiometry]", "[radiometri]", &["mine.toml", "radiometr"]);
    assert!(!bench.path("c.png").exists());
}

#[test]
fn wrong_arguments_name_option_value_and_expectation() {
    let bench = Bench::new();
    let orion = |rest: &str| format!("{ORION} {rest}");
    let camera = |name: &str| format!("sky --ra 1 --dec 2 --camera {name} -o a.png");
    let pointing = |words: &str| format!("sky {words} --camera uasc-far-range -o a.png");
    bench.write("mine.png", "mine");
    bench.write("mine.fits", "mine");
    for (words, parts) in [
        (pointing("--ra 360.5 --dec 0"), &["--ra", "360.5", "0 to 360"][..]),
        (pointing("--ra east --dec 0"), &["--ra", "east", "0 to 360"]),
        (pointing("--ra NaN --dec 0"), &["--ra", "NaN", "0 to 360"]),
        (pointing("--ra 0 --dec -90.1"), &["--dec", "-90.1", "-90 to 90"]),
        (pointing("--ra 0 --dec 0 --roll 361"), &["--roll", "361", "-360 to 360"]),
        (pointing("--ra 0 --dec 0 --exposure 0"), &["--exposure", "'0'", "0.000001 to 1000"]),
        (pointing("--ra 0 --dec 0 --time noon"), &["--time", "noon", "UTC"]),
        (pointing("--ra 0 --dec 0 --time 2051-01-01T00:00:00Z"), &["--time", "2051", "2050-01-05"]),
        (camera("uasc-far-rang"), &["--camera", "`uasc-far-rang`", "did you mean `uasc-far-range`?"]),
        (camera("nowhere.toml"), &["--camera", "`nowhere.toml`", "cmos-star-tracker"]),
        (orion("-o a.gif"), &["--out is a.gif", ".png or .fits"]),
        (orion("-o a"), &["--out is a,", ".png or .fits"]),
        (orion("-o -"), &["--out", "path"]),
        (orion("-o a.fits --label"), &["--out is a.fits", "--label", ".png"]),
        (orion("-o a.png --raw --stretch full"), &["--raw", "--stretch"]),
        (orion("-o a.png --stretch log"), &["--stretch", "log", "asinh, linear or full"]),
        (orion("-o mine.fits/a.png"), &["mine.fits/a.png", "cannot create"]),
        (orion("-o mine.png/a.fits"), &["mine.png/a.fits", "cannot create"]),
        (orion("-o mine.png"), &["mine.png", "another kind", "unused name"]),
        (orion("-o mine.png --raw"), &["mine.png", "nothing is overwritten"]),
        (orion("-o mine.fits"), &["mine.fits", "nothing is overwritten"]),
    ] {
        bench.boresight(&words).refused(parts);
    }
    assert_eq!((bench.read("mine.png"), bench.read("mine.fits")), ("mine".to_owned(), "mine".to_owned()));
    assert_eq!(bench.tree(".").len(), 2);
}
