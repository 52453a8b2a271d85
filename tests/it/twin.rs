//! `boresight twin` and `boresight compare`: the simulated twin of a camera, and its likeness.

use serde_json::Value;

use crate::support::Bench;

/// Draws three frames of a camera and writes its twin.
fn bench_with_twin() -> Bench {
    let bench = Bench::new();
    for number in 0..3 {
        let (ra, dec, roll) = (30 + 70 * number, 10 * number, 50 * number);
        let words = format!(
            "sky --ra {ra} --dec {dec} --roll {roll} --camera uasc-far-range --exposure 0.25 --raw -o \
             frames/{number}.png"
        );
        bench.boresight(&words).done();
    }
    let words =
        "twin frames --field-deg 17 --pixel-um 8.6 --pixel-height-um 8.3 --exposure 0.25 -o twin.toml";
    let answer = bench.boresight(words).done();
    assert!(answer.stdout.contains("next: boresight compare frames twin.toml"), "{}", answer.stdout);
    bench
}

fn figure<'a>(document: &'a Value, code: &str) -> &'a Value {
    let figures = document["figures"].as_array().unwrap();
    figures.iter().find(|figure| figure["code"] == code).unwrap_or_else(|| panic!("{code}: {document}"))
}

fn is_alike(figure: &Value) -> bool {
    figure["difference"].as_f64().unwrap().abs() <= figure["limit"].as_f64().unwrap()
}

/// The twin has the pointings, the stars and the noise of the camera; what is changed in it is named.
#[test]
fn a_twin_is_compared_with_its_camera() {
    let bench = bench_with_twin();
    bench.boresight("scenario check twin.toml").done();
    let document = bench.boresight("compare frames twin.toml --json --report likeness.html").json();
    assert_eq!(document["frames"], serde_json::json!([3, 3]), "{document}");
    for code in ["background", "noise", "star_flux", "star_width", "focal_length", "hot_pixels"] {
        assert!(is_alike(figure(&document, code)), "{code}: {document}");
    }
    let page = bench.read("likeness.html");
    assert!(page.contains("Spectra of the noise") && page.contains("frames and its twin"), "no page");

    let text = bench.read("twin.toml");
    let focal = text.lines().find(|line| line.starts_with("focal_length_mm")).unwrap();
    let value: f64 = focal.split([' ', '#']).nth(2).unwrap().parse().unwrap();
    let longer = text.replace(focal, &format!("focal_length_mm = {}", value * 1.003));
    let level = longer.lines().find(|line| line.starts_with("bias_dn")).unwrap();
    let brighter = longer.replace(level, "bias_dn = 80.0");
    bench.write("other.toml", &brighter);
    let answer = bench.boresight("compare frames other.toml").found(&["differs"]);
    assert!(answer.stdout.contains("background level"), "{}", answer.stdout);
    let document = bench.boresight("compare frames other.toml --json").json();
    assert!(!is_alike(figure(&document, "focal_length")) && !is_alike(figure(&document, "background")));
    assert_eq!(document["ok"], false);

    // A gate on the simulator: the comparison is as it was, or not.
    let kept = bench.boresight("compare frames twin.toml --json").stdout;
    bench.write("kept.json", &kept);
    bench.boresight("compare frames twin.toml --baseline kept.json").done();
    bench.boresight("compare frames other.toml --baseline kept.json").found(&["changed: background", "was"]);
    bench.write("kept.json", "{}");
    bench.boresight("compare frames twin.toml --baseline kept.json").refused(&["kept.json", "figures"]);
}

#[test]
fn a_fit_has_a_page() {
    let bench = bench_with_twin();
    let words = "camera fit frames --field-deg 17 --pixel-um 8.6 --pixel-height-um 8.3 --report fit.html";
    bench.boresight(words).done();
    let page = bench.read("fit.html");
    assert!(page.contains("Residuals") && page.contains("Brightness of the stars"), "no page");
    bench.write("notes.html", "my own page");
    let other = "camera fit frames --field-deg 17 --pixel-um 8.6 --report notes.html";
    bench.boresight(other).refused(&["notes.html"]);
    assert_eq!(bench.read("notes.html"), "my own page");
}

#[test]
fn scenarios_that_are_no_twin_are_refused() {
    let bench = bench_with_twin();
    bench.boresight("twin frames --field-deg 17 -o twin.toml").refused(&["twin.toml", "exists"]);
    bench.boresight("compare frames nowhere.toml").refused(&["nowhere.toml"]);
    bench.boresight("compare frames docking").refused(&["another world", "far_range"]);
    bench.boresight("compare frames argon").refused(&["[roi]", "whole images"]);
    bench.write("empty/notes.txt", "no image");
    bench.boresight("compare empty twin.toml").refused(&["0 images in it"]);
    std::fs::remove_file(bench.path("twin.aem")).unwrap();
    bench.boresight("compare frames twin.toml").refused(&["twin.aem"]);
}
