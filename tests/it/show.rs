//! `boresight show`: annotated pictures of frames, in both worlds.

use std::fs;
use std::path::Path;

use contract::PixelPoint;
use image::RgbImage;
use serde_json::Value;
use sim::truth::{ObjectKind, Visibility};

use crate::support::Bench;

/// Colours of marks, as in the legend.
const ORANGE: [u8; 3] = [255, 176, 64];
const GREEN: [u8; 3] = [110, 236, 130];
const BLUE: [u8; 3] = [96, 200, 255];
const SLATE: [u8; 3] = [122, 134, 158];
/// Colour of pixels that were not transmitted.
const NO_DATA: [u8; 3] = [17, 19, 27];

fn run_argon(bench: &Bench) {
    bench.boresight("run argon --frames 10200..10203 --out run --no-report").done();
}

/// Draws a picture, and returns it with its document.
fn draw(bench: &Bench, words: &str) -> (RgbImage, Value) {
    let document = bench.boresight(&format!("{words} --json")).done().json();
    let file = bench.path(document["file"].as_str().unwrap());
    let image = image::open(file).unwrap().to_rgb8();
    let size = ["width", "height"].map(|side| document[side].as_u64().unwrap());
    assert_eq!(size, [u64::from(image.width()), u64::from(image.height())]);
    (image, document)
}

/// Position of a panel or a close-up in its picture.
struct PanelLocation(Value);

impl PanelLocation {
    fn number(&self, name: &str) -> f64 {
        self.0[name].as_f64().unwrap()
    }

    /// Returns the range of columns (or rows) in the picture.
    fn side(&self, first: &str, length: &str) -> std::ops::Range<u32> {
        let first = self.number(first) as u32;
        first..first + self.number(length) as u32
    }

    /// Returns the position in the picture of a point of the frame; 0 is the edge of its first pixel.
    fn picture_position(&self, at: PixelPoint) -> (f64, f64) {
        let zoom = self.number("zoom");
        let panel =
            |edge: &str, at: f64, first: &str| self.number(edge) + (at - self.number(first) + 0.5) * zoom;
        (panel("left", at.x, "first_column"), panel("top", at.y, "first_row"))
    }

    /// Returns the centroid, in the picture, of the pixels of a colour within `reach` pixels of a point.
    fn centre(
        &self,
        image: &RgbImage,
        colour: [u8; 3],
        around: (f64, f64),
        reach: f64,
    ) -> Option<(f64, f64)> {
        let (mut count, mut sums) = (0.0, (0.0, 0.0));
        for y in self.side("top", "height") {
            for x in self.side("left", "width") {
                let (dx, dy) = (f64::from(x) + 0.5 - around.0, f64::from(y) + 0.5 - around.1);
                if dx.abs().max(dy.abs()) <= reach && is_near(image.get_pixel(x, y).0, colour) {
                    count += 1.0;
                    sums = (sums.0 + f64::from(x) + 0.5, sums.1 + f64::from(y) + 0.5);
                }
            }
        }
        (count > 3.0).then(|| (sums.0 / count, sums.1 / count))
    }
}

/// Returns true if a pixel has a colour, with a tolerance for smooth edges.
fn is_near(pixel: [u8; 3], colour: [u8; 3]) -> bool {
    pixel.iter().zip(colour).all(|(a, b)| a.abs_diff(b) <= 40)
}

/// Checks that a position agrees within a pixel of the picture.
fn check_at(got: Option<(f64, f64)>, expected: (f64, f64), what: &str) {
    let (x, y) = got.unwrap_or_else(|| panic!("{what}: nothing is drawn"));
    assert!(
        (x - expected.0).abs() < 1.0 && (y - expected.1).abs() < 1.0,
        "{what}: ({x}, {y}), expected {expected:?}"
    );
}

#[test]
fn truth_and_answer_are_drawn_where_the_files_have_them() {
    let bench = Bench::new();
    run_argon(&bench);
    let objects = bench.objects("run");
    let target = objects.iter().find(|o| o.frame == 10201 && o.kind == ObjectKind::Target).unwrap();
    // An external measurement, with an error of three pixels.
    let answer = PixelPoint::new(target.position.x + 0.3, target.position.y - 3.2);
    let row = format!("10201,detected,{},{}", answer.x, answer.y);
    bench.write("theirs/measurements.csv", format!("frame,status,x_px,y_px\n{row}\n"));
    let (image, document) = draw(&bench, "show run 10201 --measurements theirs/measurements.csv");
    assert!(bench.path("run/show/010201.png").is_file());
    let frame = &document["frames"][0];
    assert_eq!((&frame["pixels"], &frame["stretch"]), (&"drawn_again".into(), &"asinh".into()));
    assert_eq!((&frame["verdict"], &frame["cause"]), (&"correct".into(), &Value::Null));
    for name in ["panel", "close_up"] {
        let panel = PanelLocation(frame[name].clone());
        let at = panel.picture_position(target.position);
        check_at(panel.centre(&image, GREEN, at, 40.0), at, "target");
        let at = panel.picture_position(answer);
        check_at(panel.centre(&image, ORANGE, at, 14.0), at, "answer");
    }
    // A star without neighbours.
    let panel = PanelLocation(frame["panel"].clone());
    let shown = |o: &&sim::truth::ObjectTruth| {
        o.frame == 10201 && o.cut < 0.99 && Visibility::from_snr(o.snr) == Visibility::Detectable
    };
    let alone = objects.iter().filter(shown).find(|star| {
        let near = objects.iter().filter(shown).filter(|o| o.position.distance(star.position) < 30.0).count();
        star.kind == ObjectKind::Star
            && near == 1
            && (20.0..500.0).contains(&star.position.y)
            && star.position.x > 20.0
    });
    let at = panel.picture_position(alone.unwrap().position);
    check_at(panel.centre(&image, BLUE, at, 8.0), at, "star");
    // The counts in the document agree with the truth.
    let stars = objects
        .iter()
        .filter(shown)
        .filter(|o| o.kind == ObjectKind::Star && o.position.is_on_detector(752, 580));
    assert_eq!(frame["drawn"]["star"].as_u64().unwrap() as usize, stars.count());
    assert_eq!((frame["drawn"]["target"].as_u64(), frame["drawn"]["answer"].as_u64()), (Some(1), Some(1)));
}

/// The verdict is that of the score.
#[test]
fn the_verdict_is_that_of_the_score() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 298..304 --out run --no-report").done();
    let score = bench.json("run/score.json");
    let (_, document) = draw(&bench, "show run 298 299 300 301 302 303");
    let frames = document["frames"].as_array().unwrap();
    for verdict in ["correct", "wrong"] {
        let count = frames.iter().filter(|frame| frame["verdict"] == verdict).count() as u64;
        assert_eq!(score["figures"][format!("{verdict}_rate")]["count"], count, "{verdict}");
    }
    for (kind, verdict) in [("misses", "missed"), ("wrong", "wrong")] {
        for (cause, count) in score[kind].as_object().unwrap() {
            let of = frames.iter().filter(|f| f["verdict"] == verdict && f["cause"] == cause.as_str());
            assert_eq!(of.count() as u64, count.as_u64().unwrap(), "{cause}");
        }
    }
}

#[test]
fn regions_are_drawn_where_the_telemetry_has_them() {
    let bench = Bench::new();
    run_argon(&bench);
    let (image, document) = draw(&bench, "show run 10200");
    let panel = PanelLocation(document["frames"][0]["panel"].clone());
    let telemetry = bench.csv("run/telemetry.csv");
    let windows: Vec<[f64; 4]> = telemetry[0]["windows"]
        .split(';')
        .map(|window| {
            let numbers: Vec<f64> = window.split(' ').map(|n| n.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    assert_eq!(document["frames"][0]["drawn"]["region"].as_u64().unwrap() as usize, windows.len());
    let is = |x: f64, y: f64, colour: [u8; 3]| {
        let (x, y) = (panel.number("left") + x, panel.number("top") + y);
        let pixel = (x >= 0.0 && y >= 0.0).then(|| image.get_pixel_checked(x as u32, y as u32)).flatten();
        pixel.is_some_and(|pixel| is_near(pixel.0, colour))
    };
    let (mut edges, mut beyond) = (0, 0);
    for [x, y, columns, rows] in &windows {
        // At a scale of one to one, the line covers the pixels just outside. Tested away from the middle,
        // where circles are.
        let side = [(x - 1.0, y + 1.0), (x + columns, y + 1.0), (x + 1.0, y - 1.0), (x + 1.0, y + rows)];
        edges += side.iter().filter(|(x, y)| is(*x, *y, SLATE)).count();
        let outside = [(x - 3.0, y - 3.0), (x + columns + 2.0, y - 3.0)];
        beyond += outside.iter().filter(|(x, y)| is(*x, *y, NO_DATA)).count();
    }
    // Marks, names, the scale bar and other regions cover some of them.
    let count = windows.len();
    assert!(edges > 3 * count && beyond > count, "{edges} edges of {count} regions, {beyond} corners beyond");
}

/// A brighter pixel is never drawn darker, and the sky is dark.
#[test]
fn the_stretch_rises_with_the_pixels() {
    let bench = Bench::new();
    bench.boresight("render starting-point --frames 200..201 --format png --out data").done();
    let dn = image::open(bench.path("data/frames/000200.png")).unwrap().to_luma16();
    for stretch in ["asinh", "linear", "full"] {
        let (image, document) = draw(&bench, &format!("show data 200 --stretch {stretch}"));
        let frame = &document["frames"][0];
        assert_eq!((&frame["pixels"], &frame["stretch"]), (&"stored".into(), &stretch.into()));
        let panel = PanelLocation(frame["panel"].clone());
        let (left, top) = (panel.number("left") as u32, panel.number("top") as u32);
        let mut greys: Vec<(u16, u8)> = dn
            .enumerate_pixels()
            .map(|(x, y, pixel)| (pixel.0[0], image.get_pixel(left + x, top + y).0))
            // Away from marks, whose pixels are not grey.
            .filter(|(_, [red, green, blue])| red == green && green == blue)
            .map(|(dn, [grey, ..])| (dn, grey))
            .collect();
        greys.sort_unstable();
        let (count, black) = (greys.len(), greys.iter().filter(|(_, grey)| *grey < 60).count());
        assert!(count > 400_000 && 10 * black > 9 * count, "{stretch}: {black} of {count}");
        // Names and the scale bar also have grey pixels at their smooth edges: the median grey for a value is
        // that of its image pixels.
        let median = |dn: u16| {
            let of: Vec<u8> = greys.iter().filter(|(of, _)| *of == dn).map(|(_, grey)| *grey).collect();
            of.get(of.len() / 2).copied()
        };
        let values: std::collections::BTreeSet<u16> =
            greys.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 200).map(|same| same[0].0).collect();
        let rising: Vec<u8> = values.into_iter().filter_map(median).collect();
        assert!(
            rising.len() > 5 && rising.windows(2).all(|pair| pair[0] <= pair[1]),
            "{stretch}: {rising:?}"
        );
    }
}

#[test]
fn a_dataset_without_answers_shows_truth_and_one_without_truth_pixels() {
    let bench = Bench::new();
    bench.boresight("render starting-point --frames 200..202 --format fits --out data").done();
    let (_, document) = draw(&bench, "show data 200");
    let frame = &document["frames"][0];
    assert_eq!((&frame["verdict"], &frame["cause"]), (&Value::Null, &Value::Null));
    assert!(frame["drawn"].get("answer").is_none() && frame["drawn"]["target"] == 1, "{frame}");
    // Like the data of an external camera: no truth, no run.toml.
    for name in ["data/run.toml", "data/SHA256SUMS"] {
        fs::remove_file(bench.path(name)).unwrap();
    }
    fs::remove_dir_all(bench.path("data/truth")).unwrap();
    let (_, document) = draw(&bench, "show data 200 201");
    assert!(
        document["frames"].as_array().unwrap().iter().all(|frame| frame["drawn"] == serde_json::json!({}))
    );
    bench.boresight("process data").done();
    let (_, document) = draw(&bench, "show data 201");
    let frame = &document["frames"][0];
    assert_eq!((&frame["drawn"], &frame["verdict"]), (&serde_json::json!({ "answer": 1 }), &Value::Null));
    // Pictures are not images of the dataset.
    fs::remove_file(bench.path("data/measurements.csv")).unwrap();
    fs::remove_file(bench.path("data/clusters.parquet")).unwrap();
    bench.boresight("process data").done();
}

#[test]
fn stored_frames_and_frames_drawn_again_are_the_same_picture_but_for_their_caption() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 10200..10201 --save-frames fits --out stored --no-report").done();
    bench.boresight("run argon --frames 10200..10201 --out again --no-report").done();
    let (stored, stored_document) = draw(&bench, "show stored 10200");
    let (again, again_document) = draw(&bench, "show again 10200");
    let (a, b) = (&stored_document["frames"][0], &again_document["frames"][0]);
    assert_eq!((&a["pixels"], &b["pixels"]), (&"stored".into(), &"drawn_again".into()));
    assert_eq!((&a["panel"], &a["drawn"]), (&b["panel"], &b["drawn"]));
    for part in ["panel", "close_up"] {
        let panel = PanelLocation(a[part].clone());
        for y in panel.side("top", "height") {
            for x in panel.side("left", "width") {
                assert_eq!(stored.get_pixel(x, y), again.get_pixel(x, y), "({x}, {y})");
            }
        }
    }
}

#[test]
fn docking_features_are_drawn_at_their_positions_in_the_table() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 21170..21180 --out run --no-report").done();
    let (image, document) = draw(&bench, "show run 21179");
    let frame = &document["frames"][0];
    assert_eq!((&frame["verdict"], &frame["stretch"]), (&"success".into(), &"full".into()));
    let panel = PanelLocation(frame["panel"].clone());
    let path = bench.path("run/features.parquet");
    let rows: Vec<docking::rows::FeatureRow> =
        files::TableReader::open(&path).unwrap().flat_map(|rows| rows.unwrap().1).collect();
    let rows: Vec<_> = rows.into_iter().filter(|row| row.field == 21179).collect();
    let point = |row: &docking::rows::FeatureRow| PixelPoint::new(row.position[0], row.position[1]);
    let cross = rows.iter().find(|row| row.kind == "cross").unwrap();
    let at = panel.picture_position(point(cross));
    check_at(panel.centre(&image, ORANGE, at, 16.0), at, "cross");
    let circle = rows.iter().find(|row| row.kind == "circle").unwrap();
    let radius = circle.radius_px.unwrap();
    // The circle, at the angles between its twelve marks.
    let (x, y) = panel.picture_position(point(circle));
    let blue = (0..12).filter(|i| {
        let (sin, cos) = libm::sincos((15.0 + 30.0 * f64::from(*i)).to_radians());
        let (x, y) = ((x + radius * cos) as u32, (y + radius * sin) as u32);
        (x - 1..=x + 1).any(|x| (y - 1..=y + 1).any(|y| image.get_pixel(x, y).0 == BLUE))
    });
    assert_eq!(blue.count(), 12);
    let used = rows.iter().filter(|row| row.kind == "mark" && row.usage == "used").count();
    assert_eq!(frame["drawn"]["used_mark"].as_u64().unwrap() as usize, used);

    // From a stored image, from a stored video, and drawn again, the pixels are the same.
    let pixels = |document: &Value, image: &RgbImage| -> Vec<u8> {
        let panel = PanelLocation(document["frames"][0]["panel"].clone());
        let rows = panel.side("top", "height").start..panel.side("top", "height").start + 60;
        rows.flat_map(|y| panel.side("left", "width").map(move |x| (x, y)))
            .flat_map(|(x, y)| image.get_pixel(x, y).0)
            .collect()
    };
    let expected = pixels(&document, &image);
    for format in ["png", "avi"] {
        let run =
            format!("run docking --frames 21170..21180 --save-frames {format} --out {format} --no-report");
        bench.boresight(&run).done();
        let (image, document) = draw(&bench, &format!("show {format} 21179"));
        assert_eq!(document["frames"][0]["pixels"], "stored");
        assert!(pixels(&document, &image) == expected, "{format}");
    }
    // A dataset without measurements.
    bench.boresight("render docking --frames 21178..21180 --out data").done();
    let (_, document) = draw(&bench, "show data 21178 21179");
    let drawn_marks = &document["frames"][1]["drawn"];
    assert_eq!(drawn_marks, &serde_json::json!({ "true_centre": 2 }));
}

#[test]
fn the_target_alone_fills_the_picture() {
    let bench = Bench::new();
    run_argon(&bench);
    let (_, document) = draw(&bench, "show run 10200 10201 --view target -o pair.png");
    for frame in document["frames"].as_array().unwrap() {
        assert!(frame["panel"]["zoom"].as_f64().unwrap() >= 8.0 && frame["close_up"].is_null(), "{frame}");
    }
}

#[test]
fn only_an_earlier_picture_is_replaced() {
    let bench = Bench::new();
    run_argon(&bench);
    bench.boresight("show run 10200 -o picture.png").done();
    let first = fs::read(bench.path("picture.png")).unwrap();
    bench.boresight("show run 10200 -o picture.png").done();
    assert!(fs::read(bench.path("picture.png")).unwrap() == first);
    bench.boresight("show run 10201 -o picture.png").done();
    assert!(fs::read(bench.path("picture.png")).unwrap() != first);

    image::GrayImage::new(4, 3).save(bench.path("mine.png")).unwrap();
    bench.write("text.png", "not a picture");
    bench.write("empty.png", "");
    fs::create_dir(bench.path("folder.png")).unwrap();
    for name in ["mine.png", "text.png", "empty.png"] {
        let before = fs::read(bench.path(name)).unwrap();
        bench.boresight(&format!("show run 10200 -o {name}")).refused(&[
            name,
            "a file of another kind",
            "--out",
        ]);
        assert!(fs::read(bench.path(name)).unwrap() == before);
    }
    bench.boresight("show run 10200 -o folder.png").refused(&["folder.png", "not a regular file"]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(bench.path("picture.png"), bench.path("link.png")).unwrap();
        bench.boresight("show run 10200 -o link.png").refused(&["link.png", "not a regular file"]);
    }
    bench.boresight("show run 10200 -o picture.jpg").refused(&["picture.jpg", ".png"]);
    bench
        .boresight("show run 10200 -o picture.png/picture.png")
        .refused(&["picture.png/picture.png", "cannot create"]);
    bench.boresight("show run 10200 -o new/folder/picture.png").done();
    let left: Vec<_> = bench.tree(".").into_keys().filter(|path| is_partial(path)).collect();
    assert!(left.is_empty(), "{left:?}");
}

fn is_partial(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".partial"))
}

#[test]
fn bad_input_is_named() {
    let bench = Bench::new();
    run_argon(&bench);
    bench.boresight("show run 99").refused(&["telemetry.csv", "no frame 99", "3, 10200 to 10202"]);
    bench.boresight("show run 18446744073709551615").refused(&["no frame 18446744073709551615"]);
    bench.boresight("show run -- -1").refused(&["-1"]);
    bench.boresight("show run").refused(&["FRAME"]);
    bench.boresight("show nowhere 1").refused(&["nowhere", "does not exist"]);
    bench.write("plain/readme.txt", "");
    bench.boresight("show plain 1").refused(&[
        "plain",
        "no run.toml, camera.toml or setup.toml",
        "run directory",
    ]);
    bench.boresight("show plain/readme.txt 1").refused(&["is not a directory"]);
    bench.boresight("show run 10200 --stretch log").refused(&["log", "asinh, linear or full"]);
    bench.boresight("show run 10200 --measurements none.csv").refused(&["none.csv"]);
    let many = (0..17).map(|_| "10200").collect::<Vec<_>>().join(" ");
    bench.boresight(&format!("show run {many}")).refused(&["17 frames", "1 to 16"]);

    // State left by a killed run.
    fs::rename(bench.path("run/telemetry.csv"), bench.path("run/telemetry.old")).unwrap();
    bench.boresight("show run 10200").refused(&["telemetry.csv is missing", "finished"]);
    fs::rename(bench.path("run/telemetry.old"), bench.path("run/telemetry.csv")).unwrap();
    // A damaged file.
    let truth = bench.path("run/truth/objects.parquet");
    let bytes = fs::read(&truth).unwrap();
    fs::write(&truth, &bytes[..bytes.len() / 2]).unwrap();
    bench.boresight("show run 10200").refused(&["objects.parquet"]);
    fs::write(&truth, bytes).unwrap();
    // A frame that is not stored and cannot be drawn again.
    fs::remove_file(bench.path("run/SHA256SUMS")).unwrap();
    fs::remove_file(bench.path("run/run.toml")).unwrap();
    bench.boresight("show run 10200").refused(&["frame 10200", "no image", "run.toml"]);
    bench.edit("run/telemetry.csv", "\n10200,,", "\n10200,frames/../../secret.png,");
    bench.boresight("show run 10200").refused(&["file of frame 10200", "outside the dataset"]);
    bench.edit("run/telemetry.csv", "\n10200,frames/../../secret.png,", "\n10200,frames/none.png,");
    bench.boresight("show run 10200").refused(&["file of frame 10200", "none.png", "missing"]);
    assert!(!bench.path("run/show").exists());
}

#[test]
fn bad_input_of_docking_is_named() {
    let bench = Bench::new();
    bench.boresight("render docking --frames 24000..24004 --out data").done();
    bench.boresight("show data 7").refused(&["telemetry.csv", "no field 7", "4, 24000 to 24003"]);
    fs::remove_file(bench.path("data/frames/024001.png")).unwrap();
    bench.boresight("show data 24003").done();
    bench.boresight("show data 24001").refused(&["file of field 24001", "missing"]);
    fs::write(bench.path("data/frames/024003.png"), "no image").unwrap();
    bench.boresight("show data 24003").refused(&["024003.png"]);
}
