//! Unusable star catalogues from a user.

use super::check_refused;
use crate::support::Bench;

/// Checks the rejection of a scenario whose catalogue is the file `stars.EXTENSION` with the given text.
fn check(extension: &str, text: Option<&str>, parts: &[&str]) {
    let bench = Bench::new();
    let file = format!("stars.{extension}");
    bench.scenario("mine.toml", "starting-point", |scenario| {
        scenario["catalog"]["source"] = file.clone().into();
    });
    if let Some(text) = text {
        bench.write(&file, text);
    }
    let parts = [&[file.as_str()], parts].concat();
    check_refused(&bench, "run mine.toml --frames 0..2 --out run", &parts);
    bench.boresight("scenario check mine.toml").found(&parts);
}

#[test]
fn a_missing_catalogue_is_named() {
    check("csv", None, &["No such file"]);
    check("dat", None, &["No such file"]);
}

#[test]
fn a_catalogue_of_no_known_format_is_refused() {
    check("dat", Some("Sirius, Canopus, Arcturus\n"), &["unknown format", "hip2.dat"]);
    check("dat", Some(""), &["unknown format"]);
}

#[test]
fn a_malformed_cell_is_named_by_line_and_column() {
    let good = "id,ra_deg,dec_deg,v_mag\n1,10.0,20.0,5.0\n";
    check("csv", Some(&format!("{good}2,10.0,120.0,5.0\n")), &["line 3", "column 8", "`120.0`", "expected"]);
    check("csv", Some(&format!("{good}2,east,20.0,5.0\n")), &["line 3", "column 3", "`east`", "expected"]);
    check("csv", Some(&format!("{good}1,10.0,20.0,5.0\n")), &["line 3", "id 1", "line 2"]);
    check("csv", Some("id,ra_deg,v_mag\n"), &["dec_deg", "missing"]);
}
