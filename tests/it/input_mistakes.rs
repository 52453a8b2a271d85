//! Inputs in another convention than stated: no line of sight is asserted, and `process` says with which
//! inputs the stars fit.

use crate::support::Bench;

const FRAMES: &str = "100..106";

/// Renders frames with bright stars into `set`.
fn dataset() -> Bench {
    let bench = Bench::new();
    bench.scenario("sky.toml", "starting-point", |scenario| {
        scenario["shutter"] = toml::Table::from_iter([
            ("mode".to_owned(), "fixed".into()),
            ("exposure_s".to_owned(), 0.25.into()),
        ])
        .into();
    });
    bench.boresight(&format!("render sky.toml --frames {FRAMES} --format png --out set")).done();
    bench.unseal("set");
    bench
}

/// Processes the dataset. Checks that no line of sight is stated without stars, and that the output has a
/// sentence.
fn check_mistake(bench: &Bench, sentence: &str) {
    let output = bench.boresight("process set --out answers.csv").done().stdout;
    assert!(output.contains(&format!("the stars fit in 6 of 6 frames if {sentence}")), "{output}");
    for row in bench.csv("answers.csv") {
        assert_eq!(row["attitude"], "no_match", "{row:?}");
        assert!(row["sigma_ra_deg"].is_empty() && row["los_j2000_x"].is_empty(), "{row:?}");
    }
}

/// Changes every image of the dataset.
fn change_images(bench: &Bench, change: impl Fn(&image::DynamicImage) -> image::DynamicImage) {
    for row in bench.csv("set/telemetry.csv") {
        let path = bench.path("set").join(&row["file"]);
        change(&image::open(&path).unwrap()).save(&path).unwrap();
    }
}

/// Changes the quaternion, x, y, z, w, of every row of the telemetry.
fn change_quaternions(bench: &Bench, change: impl Fn([f64; 4]) -> [f64; 4]) {
    let mut reader = csv::Reader::from_path(bench.path("set/telemetry.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let columns = ["x", "y", "z", "w"].map(|axis| {
        let name = format!("q_sc_j2000_{axis}");
        header.iter().position(|column| column == name).unwrap()
    });
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header).unwrap();
    for record in reader.records() {
        let mut fields: Vec<String> = record.unwrap().iter().map(str::to_owned).collect();
        let changed = change(columns.map(|column| fields[column].parse().unwrap()));
        for (column, value) in columns.into_iter().zip(changed) {
            fields[column] = format!("{value:.17}");
        }
        writer.write_record(&fields).unwrap();
    }
    bench.write("set/telemetry.csv", writer.into_inner().unwrap());
}

#[test]
fn stars_that_fit_need_no_sentence() {
    let bench = dataset();
    let output = bench.boresight("process set --out answers.csv").done().stdout;
    assert!(output.contains("attitude from stars in 6 of 6 frames"), "{output}");
    assert!(!output.contains("the stars fit"), "{output}");
}

#[test]
fn rows_in_reverse_order_are_recognised() {
    let bench = dataset();
    change_images(&bench, image::DynamicImage::flipv);
    check_mistake(&bench, "the rows of the images are in reverse order\n");
}

#[test]
fn columns_in_reverse_order_are_recognised() {
    let bench = dataset();
    change_images(&bench, image::DynamicImage::fliph);
    check_mistake(&bench, "the columns of the images are in reverse order\n");
}

#[test]
fn images_turned_by_180_degrees_are_recognised() {
    let bench = dataset();
    change_images(&bench, image::DynamicImage::rotate180);
    check_mistake(&bench, "the images are turned by 180°\n");
}

#[test]
fn other_conventions_of_the_quaternion_are_recognised() {
    let bench = dataset();
    let stated = bench.read("set/telemetry.csv");
    // Files with the scalar first, read as if it were last, and the reverse.
    change_quaternions(&bench, |[x, y, z, w]| [w, x, y, z]);
    check_mistake(&bench, "the first component of the telemetry's quaternions is their last\n");
    bench.write("set/telemetry.csv", &stated);
    std::fs::remove_file(bench.path("answers.csv")).unwrap();
    std::fs::remove_file(bench.path("answers.clusters.parquet")).unwrap();
    change_quaternions(&bench, |[x, y, z, w]| [-x, -y, -z, w]);
    check_mistake(&bench, "the quaternions of the telemetry are those of the inverse rotation\n");
}

#[test]
fn another_mounting_is_recognised() {
    let bench = dataset();
    let camera = bench.read("set/camera.toml");
    let line = camera.lines().find(|line| line.starts_with("phi_deg")).unwrap().to_owned();
    bench.edit("set/camera.toml", &line, "phi_deg = -60.0");
    check_mistake(&bench, "the mounting of the camera is phi_deg = -89.9");
}

#[test]
fn another_focal_length_is_recognised() {
    let bench = dataset();
    bench.edit("set/camera.toml", "focal_length_mm = 20.187", "focal_length_mm = 20.9945");
    let output = bench.boresight("process set --out answers.csv").done().stdout;
    // 20.187/20.9945 = 0.9615.
    assert!(output.contains("if the focal length is 0.961"), "{output}");
}
