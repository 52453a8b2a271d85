//! Camera and star list of a dataset.

use super::{check_refused, dataset};

fn check(old: &str, new: &str, parts: &[&str]) {
    let bench = dataset();
    bench.edit("set/camera.toml", old, new);
    check_refused(&bench, "process set", &[&["set/camera.toml"], parts].concat());
}

#[test]
fn a_mistake_in_the_camera_is_named() {
    check("columns = 752", "columns = ", &["camera.toml:", ":11: string values must be quoted"]);
    check("focal_length_mm", "focal_length", &["`focal_length`", "did you mean `focal_length_mm`?"]);
    check(
        "focal_length_mm = 20.187",
        "focal_length_mm = 0.0",
        &["camera.focal_length_mm", "is 0, expected 0.01"],
    );
    check("bit_depth = 12", "bit_depth = 20", &["camera.toml:1:", "bit_depth: is 20", "1 to 16"]);
    check("magnitude_limit = 7.5", "magnitude_limit = 70.0", &["magnitude_limit: is 70", "-2 to 15"]);
    check("star_epoch_utc = \"2012", "star_epoch_utc = \"20-12", &["star_epoch_utc: is 20-12"]);
    check(
        "tangential = [",
        "tangential = [0.1, ",
        &["camera.tangential", "3, expected an array of length 2"],
    );
    check("low_sigmas = 3.0", "low_sigmas = -3.0", &["low_sigmas", "-3", "expected"]);
}

#[test]
fn a_star_list_with_a_mistake_is_named() {
    let bench = dataset();
    bench.write("set/stars.csv", "id,ra_deg,dec_deg,magnitude\n1,10,20,5\n2,10,95,5\n");
    check_refused(&bench, "process set", &["set/stars.csv, line 3", "`dec_deg` is `95`", "expected"]);
}
