//! Camera models for new scenarios: the tables `[camera]`, `[sensor]`, `[psf]` and `[radiometry]`.

use super::BuiltIn;

/// Built-in cameras, by name: text to be pasted into a scenario, each value with its source.
pub const CAMERAS: &[BuiltIn] = &[
    BuiltIn {
        name: "balluff-ca-gt1-0124",
        text: include_str!("../../../scenarios/cameras/balluff-ca-gt1-0124.toml"),
    },
    BuiltIn { name: "cassini-nac", text: include_str!("../../../scenarios/cameras/cassini-nac.toml") },
    BuiltIn {
        name: "clementine-star-tracker",
        text: include_str!("../../../scenarios/cameras/clementine-star-tracker.toml"),
    },
    BuiltIn {
        name: "cmos-star-tracker",
        text: include_str!("../../../scenarios/cameras/cmos-star-tracker.toml"),
    },
    BuiltIn { name: "dawn-fc", text: include_str!("../../../scenarios/cameras/dawn-fc.toml") },
    BuiltIn {
        name: "genie-nano-m2450",
        text: include_str!("../../../scenarios/cameras/genie-nano-m2450.toml"),
    },
    BuiltIn {
        name: "hayabusa2-onc-t",
        text: include_str!("../../../scenarios/cameras/hayabusa2-onc-t.toml"),
    },
    BuiltIn {
        name: "mvbluefox3-2024a",
        text: include_str!("../../../scenarios/cameras/mvbluefox3-2024a.toml"),
    },
    BuiltIn {
        name: "new-horizons-lorri",
        text: include_str!("../../../scenarios/cameras/new-horizons-lorri.toml"),
    },
    BuiltIn { name: "rosetta-navcam", text: include_str!("../../../scenarios/cameras/rosetta-navcam.toml") },
    BuiltIn { name: "sstl-altair-hb", text: include_str!("../../../scenarios/cameras/sstl-altair-hb.toml") },
    BuiltIn { name: "sstl-rigel-l", text: include_str!("../../../scenarios/cameras/sstl-rigel-l.toml") },
    BuiltIn { name: "tess-ccd", text: include_str!("../../../scenarios/cameras/tess-ccd.toml") },
    BuiltIn { name: "tv-docking", text: include_str!("../../../scenarios/cameras/tv-docking.toml") },
    BuiltIn { name: "uasc-far-range", text: include_str!("../../../scenarios/cameras/uasc-far-range.toml") },
];

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Camera;
    use draws::Seed;
    use serde::Deserialize;
    use sim::optics::{PsfConfig, RadiometryConfig};
    use sim::sensor::{ExposureInterval, FrameCharge, Sensor, SensorConfig};

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fragment {
        camera: Camera,
        sensor: SensorConfig,
        psf: PsfConfig,
        radiometry: RadiometryConfig,
    }

    fn fragments() -> impl Iterator<Item = (&'static str, Fragment)> {
        CAMERAS.iter().map(|camera| (camera.name, toml::from_str(camera.text).unwrap()))
    }

    #[test]
    fn every_camera_is_valid_in_a_scenario() {
        assert!(fragments().count() >= 15);
        for (name, fragment) in fragments() {
            fragment.camera.check().unwrap();
            fragment.sensor.check().unwrap_or_else(|error| panic!("{name}: {error}"));
            fragment.radiometry.check().unwrap_or_else(|error| panic!("{name}: {error}"));
            let psf = fragment.psf.check();
            psf.unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }

    /// Two dark frames of each camera have the mean and the noise that follow from its parameters. The
    /// converter has half an electron per digital number, so that rounding hides nothing.
    #[test]
    fn dark_frames_have_the_figures_of_their_camera() {
        let seed = Seed { seed: 5, case: 0 };
        let exposure_s = 1.0;
        for (name, Fragment { mut sensor, .. }) in fragments() {
            sensor.hot_pixels.count = 0;
            (sensor.bit_depth, sensor.gain_e_per_dn, sensor.bias_dn) = (16, 0.5, 1000.0);
            let (columns, rows) = (400, 400);
            let device = Sensor::new(&sensor, columns, rows).unwrap();
            let (mut image, mut sampler) = (device.new_expected(), device.new_sampler());
            let frames: Vec<Vec<f64>> = (0..2)
                .map(|frame| {
                    let mut raw = device.new_raw();
                    image.clear(0.0);
                    let charge =
                        device.collect(&mut image, &ExposureInterval { seed, middle_s: 0.0, exposure_s });
                    let collected = FrameCharge { charge: &charge, seed, frame };
                    device.read_out(&collected, &mut sampler, &mut raw).unwrap();
                    raw.dn().iter().map(|dn| f64::from(*dn)).collect()
                })
                .collect();
            let n = (columns * rows) as f64;
            let mean_dn = frames[0].iter().sum::<f64>() / n;
            let (gain, dark_e) = (sensor.gain_e_per_dn, sensor.dark_current_e_per_s * exposure_s);
            let row_e = sensor.line_noise.row_e;
            // Noise that does not average out over the pixels: that of 400 rows, and the offsets of 400
            // columns.
            let lines_e = libm::hypot(row_e, sensor.fixed_pattern.column_offset_e) / 20.0;
            let error_e = (mean_dn - sensor.bias_dn) * gain - dark_e;
            // The pattern of the dark current averages out over 160,000 pixels.
            let dark_error_e = dark_e * sensor.fixed_pattern.dsnu_fraction / 400.0;
            assert!(error_e.abs() < 5.0 * (lines_e + dark_error_e) + 0.3, "{name}: {error_e} e⁻");
            let variance =
                frames[0].iter().zip(&frames[1]).map(|(a, b)| 0.5 * (a - b) * (a - b)).sum::<f64>() / n;
            let read_e = sensor.read_noise_e;
            let noise_e2 = dark_e + read_e * read_e + row_e * row_e;
            let expected = noise_e2 / (gain * gain) + 1.0 / 12.0;
            // 160,000 differences determine a variance to 0.35 %, those of 400 rows to 7 %.
            let tolerance = 5.0 * (0.0035 + 0.07 * row_e * row_e / noise_e2);
            assert!((variance / expected - 1.0).abs() < tolerance, "{name}: {variance} and {expected} DN²");
        }
    }
}
