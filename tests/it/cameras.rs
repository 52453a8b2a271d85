//! The built-in cameras: a frame of each, against the figures that its data sheet states or that follow from
//! them.

use boresight::files::read_frame;
use boresight::scenario::CAMERAS;
use serde_json::Value;

use crate::support::Bench;

/// Figures of a camera in its source, which the preset does not contain: they follow from its values.
struct DataSheet {
    name: &'static str,
    /// Stated field across columns, degrees; `None` for a camera without a lens of its own.
    field_deg: Option<f64>,
    /// Largest difference of the field from the stated one, as a fraction, by the rounding in the source.
    field_tolerance: f64,
    /// Stated angle of a pixel, arcsec.
    pixel_arcsec: Option<f64>,
    /// Stated ratio of the full well to the noise of a dark pixel, dB: 20 log10.
    dynamic_range_db: Option<f64>,
    /// Stated largest ratio of signal to noise, dB: 20 log10 of the square root of the full well.
    signal_to_noise_db: Option<f64>,
}

/// Arcseconds of a microradian.
const ARCSEC_PER_URAD: f64 = 0.206_264_8;

/// Data sheets with the rounding of their fields: half of the last digit, or the reason beside it.
const DATA_SHEETS: [DataSheet; 12] = [
    with_field("rosetta-navcam", 5.0, 0.01, Some(17.6)),
    with_dynamic_range("new-horizons-lorri", 0.29, 0.02, 4.95 * ARCSEC_PER_URAD, 70.88), // 3500
    with_field("hayabusa2-onc-t", 6.35, 0.02, Some(22.14)), // and 22.14″ × 1024 = 6.30°
    with_field("dawn-fc", 5.5, 0.01, Some(93.7 * ARCSEC_PER_URAD)),
    with_field("tess-ccd", 12.0, 0.02, Some(21.0)), // half of 24°
    with_field("cassini-nac", 0.35, 0.02, Some(6.0 * ARCSEC_PER_URAD)),
    with_field("clementine-star-tracker", 43.0, 0.05, None), // 41.5° by its own focal length
    with_field("sstl-rigel-l", 22.6, 0.04, None),            // 21.9° by its own focal length
    with_field("sstl-altair-hb", 15.5, 0.02, None),
    machine_vision("genie-nano-m2450", 75.46, None),
    machine_vision("mvbluefox3-2024a", 73.0, Some(45.1)),
    machine_vision("balluff-ca-gt1-0124", 69.8, Some(39.7)),
];

const fn with_field(
    name: &'static str,
    field_deg: f64,
    field_tolerance: f64,
    pixel_arcsec: Option<f64>,
) -> DataSheet {
    let field_deg = Some(field_deg);
    DataSheet {
        name,
        field_deg,
        field_tolerance,
        pixel_arcsec,
        dynamic_range_db: None,
        signal_to_noise_db: None,
    }
}

const fn with_dynamic_range(
    name: &'static str,
    field_deg: f64,
    field_tolerance: f64,
    pixel_arcsec: f64,
    dynamic_range_db: f64,
) -> DataSheet {
    let sheet = with_field(name, field_deg, field_tolerance, Some(pixel_arcsec));
    DataSheet { dynamic_range_db: Some(dynamic_range_db), ..sheet }
}

const fn machine_vision(
    name: &'static str,
    dynamic_range_db: f64,
    signal_to_noise_db: Option<f64>,
) -> DataSheet {
    DataSheet {
        name,
        field_deg: None,
        field_tolerance: 0.0,
        pixel_arcsec: None,
        dynamic_range_db: Some(dynamic_range_db),
        signal_to_noise_db,
    }
}

/// A preset as a table of TOML.
struct Preset(toml::Table);

impl Preset {
    fn new(name: &str) -> Self {
        let camera = CAMERAS.iter().find(|camera| camera.name == name);
        Self(camera.unwrap_or_else(|| panic!("{name}")).text.parse().unwrap())
    }

    fn number(&self, table: &str, key: &str) -> f64 {
        let value = &self.0[table][key];
        value.as_float().unwrap_or_else(|| value.as_integer().unwrap() as f64)
    }
}

/// Returns the angle, degrees, between the edges of the detector along columns: the sum of atan(n p / f) over
/// the n pixels of size p on either side of the principal point.
fn field_deg(preset: &Preset) -> f64 {
    let pixel =
        preset.number("camera", "pixel_width_um") / (1000.0 * preset.number("camera", "focal_length_mm"));
    let left = preset.number("camera", "principal_x_px") + 0.5;
    let right = preset.number("camera", "columns") - left;
    (libm::atan(left * pixel) + libm::atan(right * pixel)).to_degrees()
}

/// Returns the digital numbers of a frame of the shortest exposure, which is dark.
fn dark_frame(bench: &Bench, name: &str, seed: u32) -> (Vec<u16>, Value) {
    let file = format!("{name}-{seed}.fits");
    let words =
        format!("sky --ra 200 --dec 30 --camera {name} --exposure 1e-6 --seed {seed} -o {file} --json");
    let answer = bench.boresight(&words).done().json();
    let bits = Preset::new(name).number("sensor", "bit_depth") as u8;
    (read_frame(&bench.path(&file), 0, bits, None).unwrap().dn().to_vec(), answer)
}

/// Each camera draws frames whose field and noise are those of its data sheet.
#[test]
fn frames_of_a_camera_have_the_figures_of_its_data_sheet() {
    for sheet in DATA_SHEETS {
        let (name, preset) = (sheet.name, Preset::new(sheet.name));
        let bench = Bench::new();
        let (first, answer) = dark_frame(&bench, name, 1);
        let (second, _) = dark_frame(&bench, name, 2);

        // The simulator's field is that of pixels and focal length, and that of the data sheet.
        let field = field_deg(&preset);
        let simulated = answer["field_deg"][0].as_f64().unwrap();
        // The simulator measures between the centres of the outer pixels or their edges: a pixel at most.
        assert!(
            (simulated / field - 1.0).abs() < 2.0 / preset.number("camera", "columns"),
            "{name}: {simulated}"
        );
        if let Some(stated) = sheet.field_deg {
            assert!(
                (field / stated - 1.0).abs() < sheet.field_tolerance,
                "{name}: {field}°, stated {stated}°"
            );
        }
        if let Some(stated) = sheet.pixel_arcsec {
            let pixel_rad = preset.number("camera", "pixel_width_um")
                / (1000.0 * preset.number("camera", "focal_length_mm"));
            let arcsec = pixel_rad.to_degrees() * 3600.0;
            assert!((arcsec / stated - 1.0).abs() < 0.01, "{name}: {arcsec}″, stated {stated}″");
        }

        // Noise of a dark pixel: the difference of two frames has twice its variance.
        let count = first.len() as f64;
        let squares: f64 = first
            .iter()
            .zip(&second)
            .map(|(a, b)| (f64::from(*a) - f64::from(*b)) * (f64::from(*a) - f64::from(*b)))
            .sum();
        let gain = preset.number("sensor", "gain_e_per_dn");
        let read_e = preset.number("sensor", "read_noise_e");
        // Rounding to digital numbers has a variance of a twelfth.
        let noise_e = gain * (0.5 * squares / count - 1.0 / 12.0).max(0.0).sqrt();
        // Noise of less than half a digital number is not rounded like a uniform one.
        let tolerance = if read_e > 0.6 * gain { 0.03 } else { 0.15 };
        assert!((noise_e / read_e - 1.0).abs() < tolerance, "{name}: {noise_e} e⁻, preset {read_e} e⁻");

        let full_well_e = preset.number("sensor", "full_well_e");
        if let Some(stated) = sheet.dynamic_range_db {
            let range_db = 20.0 * libm::log10(full_well_e / noise_e);
            // 0.3 dB is 3.5 %, the tolerance of the noise; 1.3 dB the other one.
            let within = if tolerance < 0.1 { 0.3 } else { 1.3 };
            assert!((range_db - stated).abs() < within, "{name}: {range_db} dB, stated {stated} dB");
        }
        if let Some(stated) = sheet.signal_to_noise_db {
            let ratio_db = 10.0 * libm::log10(full_well_e);
            assert!((ratio_db - stated).abs() < 0.05, "{name}: {ratio_db} dB, stated {stated} dB");
        }
    }
}

/// Each value of the new cameras has a source or is marked as assumed, and each table of the documentation
/// lists them all.
#[test]
fn every_camera_is_documented() {
    let page = include_str!("../../docs/cameras.md");
    for camera in CAMERAS {
        assert!(page.contains(&format!("| `{}` |", camera.name)), "{} in docs/cameras.md", camera.name);
        assert!(camera.text.to_lowercase().contains("assumed"), "{}", camera.name);
    }
    for sheet in DATA_SHEETS {
        let field = field_deg(&Preset::new(sheet.name));
        let row = page.lines().find(|line| line.starts_with(&format!("| `{}` |", sheet.name))).unwrap();
        let stated: f64 = row.split('|').nth(3).unwrap().trim().split('°').next().unwrap().parse().unwrap();
        // Half of the last digit of the page.
        assert!(
            (field - stated).abs() < if field < 1.0 { 0.0051 } else { 0.051 },
            "{}: {field}°",
            sheet.name
        );
    }
}
