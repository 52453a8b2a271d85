//! `boresight camera fit`: a camera from frames of the night sky, and its use.

use crate::support::Bench;

/// Draws frames of a camera at different pointings, as 16-bit PNG.
fn sky_frames(bench: &Bench, count: usize) {
    for number in 0..count {
        let (ra, dec, roll) = (30 + 70 * number, 10 * number, 50 * number);
        let words = format!(
            "sky --ra {ra} --dec {dec} --roll {roll} --camera uasc-far-range --exposure 0.25 --raw -o \
             frames/{number}.png"
        );
        bench.boresight(&words).done();
    }
}

#[test]
fn a_camera_is_fitted_written_and_used() {
    let bench = Bench::new();
    sky_frames(&bench, 3);
    let fitted = bench
        .boresight("camera fit frames --field-deg 17 --pixel-um 8.6 --pixel-height-um 8.3 --exposure 0.25 -o mine.toml --json");
    let document = fitted.done().json();
    assert_eq!(document["frames"].as_array().unwrap().len(), 3, "{document}");
    let parameter = |name: &str| {
        let parameters = document["parameters"].as_array().unwrap();
        parameters.iter().find(|parameter| parameter["name"] == name).unwrap()["value"].as_f64().unwrap()
    };
    assert!((parameter("focal length, mm") - 20.187).abs() < 0.01, "{document}");
    assert!((parameter("k1, px^-2") - 2.6e-8).abs() < 5e-9, "{document}");
    for (number, frame) in document["frames"].as_array().unwrap().iter().enumerate() {
        let ra = frame["ra_deg"].as_f64().unwrap();
        // `sky` points the principal point, which is 19.5 px, 0.48°, beside the centre of the image.
        assert!((ra - (30.0 + 70.0 * number as f64)).abs() < 0.8, "{frame}");
    }
    let text = bench
        .boresight("camera fit frames --field-deg 17 --pixel-um 8.6 --pixel-height-um 8.3")
        .done()
        .stdout;
    assert!(text.contains("3 of 3 frames have an attitude") && text.contains("focal length, mm"), "{text}");
    assert!(bench.read("mine.toml").contains("# ±"), "{}", bench.read("mine.toml"));
    bench.boresight("sky --ra 30 --dec 0 --camera mine.toml -o again.png").done();
    bench.boresight("camera fit frames --field-deg 17 -o mine.toml").refused(&["mine.toml", "exists"]);
}

#[test]
fn frames_without_a_camera_are_named_with_the_reason() {
    let bench = Bench::new();
    bench.write("empty/notes.txt", "no image");
    bench.boresight("camera fit empty --field-deg 10").refused(&["0 images in it", "png"]);
    bench.boresight("camera fit nowhere --field-deg 10").refused(&["nowhere", "No such file"]);
    bench.write("broken/a.png", "no image");
    bench.boresight("camera fit broken --field-deg 10").refused(&["broken/a.png"]);
    let black = image::RgbImage::new(64, 48);
    std::fs::create_dir(bench.path("black")).unwrap();
    black.save(bench.path("black/a.png")).unwrap();
    let answer = bench.boresight("camera fit black --field-deg 10").found(&["a.png: no star-like source"]);
    assert!(answer.stdout.contains("the stars of no frame fit the catalogue"), "{}", answer.stdout);
    image::RgbImage::new(32, 48).save(bench.path("black/b.png")).unwrap();
    bench.boresight("camera fit black --field-deg 10").refused(&["b.png: is 32 × 48 pixels", "64 × 48"]);
    for (words, parts) in [
        ("--field-deg 0.1", ["--field-deg", "0.5 to 120"]),
        ("--field-deg 10 --tolerance 0.5", ["--tolerance", "0 to 0.2"]),
        ("--field-deg 10 --pixel-um 0", ["--pixel-um", "0.01 to 10000"]),
        ("--field-deg 10 --time now", ["--time", "UTC"]),
    ] {
        bench.boresight(&format!("camera fit black {words}")).refused(&parts);
    }
}
