//! `boresight camera sensor`: a sensor from bias, dark and flat frames, and its use by `camera fit`.

use draws::Seed;
use sim::sensor::{ExposureInterval, FixedPatternConfig, FrameCharge, Sensor, SensorConfig};

use crate::support::Bench;

const COLUMNS: u32 = 160;
const ROWS: u32 = 120;

/// Sensor of the frames.
fn config() -> SensorConfig {
    SensorConfig {
        bit_depth: 12,
        gain_e_per_dn: 5.0,
        bias_dn: 60.0,
        full_well_e: 15_000.0,
        read_noise_e: 12.0,
        dark_current_e_per_s: 40.0,
        fixed_pattern: FixedPatternConfig { seed: 2, prnu_fraction: 0.01, ..FixedPatternConfig::default() },
        ..SensorConfig::default()
    }
}

/// Returns the digital numbers of a frame.
fn frame(number: u64, time_s: f64, light_e: f64) -> Vec<u16> {
    let sensor = Sensor::new(&config(), COLUMNS as usize, ROWS as usize).unwrap();
    let seed = Seed { seed: 7, case: 0 };
    let mut image = sensor.new_expected();
    image.clear(light_e);
    let charge = sensor.collect(&mut image, &ExposureInterval { seed, middle_s: 0.0, exposure_s: time_s });
    let mut raw = sensor.new_raw();
    let collected = FrameCharge { charge: &charge, seed, frame: number };
    sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
    raw.dn().to_vec()
}

/// Writes a 16-bit PNG.
fn write(bench: &Bench, name: &str, columns: u32, rows: u32, dn: Vec<u16>) {
    let path = bench.path(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    image::ImageBuffer::<image::Luma<u16>, _>::from_vec(columns, rows, dn).unwrap().save(path).unwrap();
}

/// Writes two frames of a level.
fn write_pair(bench: &Bench, folder: &str, first: u64, time_s: f64, light_e: f64) {
    for number in [first, first + 1] {
        let name = format!("{folder}/{number}.png");
        write(bench, &name, COLUMNS, ROWS, frame(number, time_s, light_e));
    }
}

/// Writes bias, darks and flats of several levels.
fn write_stacks(bench: &Bench) {
    write_pair(bench, "bias", 0, 0.0, 0.0);
    write_pair(bench, "dark/2s", 2, 2.0, 0.0);
    write_pair(bench, "dark/8s", 4, 8.0, 0.0);
    for level in 1..=7_u64 {
        let (time_s, light_e) = (0.1 * level as f64, 2700.0 * level as f64);
        write_pair(bench, &format!("flat/{time_s:.1}s"), 10 + 2 * level, time_s, light_e);
    }
}

const ALL: &str = "camera sensor --bias bias --dark dark --flat flat";

#[test]
fn a_sensor_is_measured_written_and_used() {
    let bench = Bench::new();
    write_stacks(&bench);
    let document = bench.boresight(&format!("{ALL} -o sensor.toml --json")).done().json();
    for (name, truth) in [
        ("gain_e_per_dn", 5.0),
        ("bias_dn", 60.0),
        ("read_noise_e", 12.0),
        ("dark_current_e_per_s", 40.0),
        ("prnu_fraction", 0.01),
        ("full_well_e", 15_000.0),
    ] {
        let figure = &document["figures"][name];
        let (value, sigma) = (figure["value"].as_f64().unwrap(), figure["sigma"].as_f64().unwrap());
        assert!((value - truth).abs() < 4.0 * sigma && sigma < 0.05 * truth, "{name}: {figure}, {truth}");
    }
    assert_eq!(document["limit"], "full_well");
    let text = bench.boresight(ALL).done().stdout;
    assert!(text.contains("gain, e-/DN") && text.contains("beyond saturation"), "{text}");
    assert!(bench.read("sensor.toml").contains("± "), "{}", bench.read("sensor.toml"));
    bench.boresight(&format!("{ALL} -o sensor.toml")).refused(&["sensor.toml", "exists"]);

    // Frames of the sky by another camera: only the way of the file into the camera is of interest.
    for number in 0..2 {
        let words = format!(
            "sky --ra {} --dec 10 --camera uasc-far-range --exposure 0.25 --raw -o sky/{number}.png",
            30 + 70 * number
        );
        bench.boresight(&words).done();
    }
    let fit = "camera fit sky --field-deg 17 --pixel-um 8.6 --pixel-height-um 8.3 --exposure 0.25";
    bench.boresight(&format!("{fit} -o plain.toml")).done();
    bench.boresight(&format!("{fit} --sensor sensor.toml -o mine.toml")).done();
    let value = |file: &str, table: &str, key: &str| {
        let document: toml::Table = bench.read(file).parse().unwrap();
        document[table][key].as_float().unwrap()
    };
    let gain = value("mine.toml", "sensor", "gain_e_per_dn");
    assert!((gain - 5.0).abs() < 0.25 && value("mine.toml", "sensor", "bias_dn") > 50.0);
    let zero_point = |file| value(file, "radiometry", "zero_point_e_per_s");
    // The same DN are electrons by the gain of each file.
    let ratio_of_gains = gain / value("plain.toml", "sensor", "gain_e_per_dn");
    let ratio = zero_point("mine.toml") / zero_point("plain.toml") / ratio_of_gains;
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    bench.boresight("sky --ra 30 --dec 0 --camera mine.toml -o again.png").done();
    bench.write("wrong.toml", "[sensor]\nbit_depth = 99\n");
    bench.boresight(&format!("{fit} --sensor wrong.toml")).refused(&["wrong.toml"]);
}

#[test]
fn folders_that_are_no_stacks_are_named() {
    let bench = Bench::new();
    write_stacks(&bench);
    write(&bench, "single/a.png", COLUMNS, ROWS, frame(0, 0.0, 0.0));
    bench.boresight("camera sensor --bias single").refused(&["single", "1 frame", "2 or more"]);
    write_pair(&bench, "sizes", 50, 0.0, 0.0);
    write(&bench, "sizes/z.png", 64, 48, vec![60; 64 * 48]);
    bench.boresight("camera sensor --bias sizes").refused(&["z.png: is 64 × 48", "160 × 120"]);
    write_pair(&bench, "copy", 50, 0.0, 0.0);
    std::fs::copy(bench.path("copy/50.png"), bench.path("copy/51.png")).unwrap();
    bench.boresight("camera sensor --bias copy").refused(&["50.png and copy/51.png", "copies"]);
    for name in ["colour/a.png", "colour/b.png"] {
        std::fs::create_dir_all(bench.path("colour")).unwrap();
        image::RgbImage::new(COLUMNS, ROWS).save(bench.path(name)).unwrap();
    }
    bench.boresight("camera sensor --bias colour").refused(&["colour/a.png", "colour image", "grey"]);
    std::fs::create_dir_all(bench.path("jpeg")).unwrap();
    image::GrayImage::new(COLUMNS, ROWS).save(bench.path("jpeg/a.jpg")).unwrap();
    bench.boresight("camera sensor --bias jpeg").refused(&["jpeg/a.jpg", "JPEG"]);
    bench.boresight("camera sensor --bias bias --flat bias").refused(&[
        "bias/0.png",
        "no exposure time",
        "0.5s",
    ]);
    write_pair(&bench, "named/half", 60, 0.5, 100.0);
    bench.boresight("camera sensor --bias bias --flat named").refused(&["named/half", "0.5s"]);
    write_pair(&bench, "twice/0.5s", 60, 0.5, 100.0);
    write_pair(&bench, "twice/500ms", 62, 0.5, 100.0);
    bench.boresight("camera sensor --bias bias --flat twice").refused(&["same exposure time", "500ms"]);
    write_pair(&bench, "loose/0.5s", 60, 0.5, 100.0);
    write(&bench, "loose/a.png", COLUMNS, ROWS, frame(0, 0.0, 0.0));
    bench.boresight("camera sensor --bias bias --flat loose").refused(&["loose/a.png", "beside the folder"]);
    bench.boresight("camera sensor").refused(&["--bias"]);
}

#[test]
fn frames_that_contradict_give_no_figure() {
    let bench = Bench::new();
    write_stacks(&bench);
    // A flat as bias, and flats darker than the bias.
    bench
        .boresight("camera sensor --bias flat/0.7s --dark dark --flat flat")
        .refused(&["is not above", "folders exchanged"]);
    bench.boresight("camera sensor --bias bias --dark flat --flat dark").refused(&["is not above"]);
    // Only saturated flats: no gain, and no file.
    for number in 0..2 {
        write(&bench, &format!("white/1s/{number}.png"), COLUMNS, ROWS, vec![4095; 160 * 120]);
    }
    let answer = bench
        .boresight("camera sensor --bias bias --flat white -o white.toml")
        .found(&["every flat level is cut", "no file"]);
    assert!(!bench.path("white.toml").exists(), "{}", answer.stdout);
    // A lamp that drifts by 3 % between the frames of a level: the gain stands, the linearity does not.
    for (number, light) in
        [(70, 3000.0), (71, 3090.0), (80, 6000.0), (81, 5820.0), (90, 9000.0), (91, 9270.0)]
    {
        let time_s = 0.1 * (number / 10 - 6) as f64;
        let name = format!("lamp/{time_s:.1}s/{number}.png");
        write(&bench, &name, COLUMNS, ROWS, frame(number, time_s, light));
    }
    let document = bench.boresight("camera sensor --bias bias --flat lamp --json").done().json();
    let gain = &document["figures"]["gain_e_per_dn"];
    assert!((gain["value"].as_f64().unwrap() - 5.0).abs() < 4.0 * gain["sigma"].as_f64().unwrap(), "{gain}");
    assert!(document["light_drift"].as_f64().unwrap() > 0.01, "{document}");
    assert!(document["notes"].to_string().contains("light changes"), "{document}");
    assert!(document["figures"]["linearity_error_percent"]["value"].is_null(), "{document}");
}
