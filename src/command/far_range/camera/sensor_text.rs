//! Words and JSON of the figures of a sensor.

use sensor_fit::{Finding, SaturationLimit, SensorFigures};
use serde_json::{Map, Value, json};

/// Figures with the names of their keys and their words.
pub(super) fn named_figures(figures: &SensorFigures) -> [(&'static str, &'static str, &Finding); 18] {
    [
        ("gain_e_per_dn", "gain, e-/DN", &figures.gain_e_per_dn),
        ("bias_dn", "bias, DN", &figures.bias_dn),
        ("read_noise_dn", "read noise, DN", &figures.read_noise_dn),
        ("read_noise_e", "read noise, e-", &figures.read_noise_e),
        ("row_noise_e", "row noise, e-", &figures.row_noise_e),
        ("column_noise_e", "column noise, e-", &figures.column_noise_e),
        ("dark_current_e_per_s", "dark current, e-/s", &figures.dark_current_e_per_s),
        ("dark_current_spread_e_per_s", "its spread, e-/s", &figures.dark_current_spread_e_per_s),
        ("dsnu_e", "DSNU1288, e-", &figures.dsnu_e),
        ("column_offset_e", "  of columns, e-", &figures.column_offset_e),
        ("row_offset_e", "  of rows, e-", &figures.row_offset_e),
        ("prnu_fraction", "PRNU1288, fraction", &figures.prnu_fraction),
        ("full_well_e", "full well, e-", &figures.full_well_e),
        ("saturation_dn", "saturation, DN", &figures.saturation_dn),
        ("saturation_e", "saturation, e-", &figures.saturation_e),
        ("largest_linear_dn", "largest linear level, DN", &figures.largest_linear_dn),
        ("linearity_error_percent", "linearity error LE, %", &figures.linearity_error_percent),
        ("non_linearity", "non-linearity", &figures.non_linearity),
    ]
}

/// Returns a value with its standard deviation, to two digits of the latter.
pub(super) fn finding_text(finding: &Finding) -> String {
    match finding {
        Finding::Value { value, sigma } if value.abs() < 1e-2 || *sigma <= 0.0 => {
            format!("{value:.3e} ± {sigma:.1e}")
        }
        Finding::Value { value, sigma } => {
            let digits = (1 - libm::log10(*sigma).floor() as i32).clamp(0, 9) as usize;
            format!("{value:.digits$} ± {sigma:.digits$}")
        }
        Finding::Below(limit) => format!("not seen: below {limit:.2e}"),
        Finding::Missing(reason) => format!("not determined: {reason}"),
    }
}

/// Returns the figures as text for a terminal.
pub(super) fn sensor_text(figures: &SensorFigures) -> String {
    let [columns, rows] = figures.size;
    let (bits, is_seen) = figures.bit_depth;
    let origin = if is_seen { "a level reaches the largest number" } else { "of the files" };
    let mut text = format!("{columns} × {rows} pixels, {bits} bits ({origin})");
    match figures.limit {
        Some(SaturationLimit::FullWell) => text.push_str(", the full wells end the response"),
        Some(SaturationLimit::Converter) => text.push_str(", the converter ends the response"),
        None => {}
    }
    for (_, words, finding) in named_figures(figures) {
        text.push_str(&format!("\n  {words:<25} {}", finding_text(finding)));
    }
    text.push_str(&defects_text(figures));
    for level in &figures.levels {
        text.push_str(&format!(
            "\n  {}: {} frames, mean {:.2} DN, noise {:.3} DN, {}",
            level.name,
            level.frames,
            level.mean_dn,
            level.variance_dn2.max(0.0).sqrt(),
            level.state
        ));
    }
    for note in &figures.notes {
        text.push_str(&format!("\n  note: {note}"));
    }
    text
}

fn defects_text(figures: &SensorFigures) -> String {
    let defects = &figures.defects;
    let share = |count: usize| 100.0 * count as f64 / defects.pixels.max(1) as f64;
    let counted = |name: &str, count: Option<usize>, needs: &str| match count {
        Some(count) => format!("\n  {name:<25} {count} ({:.3} %)", share(count)),
        None => format!("\n  {name:<25} not determined: needs {needs}"),
    };
    let mut text = counted("hot pixels", defects.hot, "dark frames of two times, or of one and bias");
    if let Some(hot) = defects.hot_currents {
        text.push_str(&format!(
            ", median {:.0} e-/s, spread {:.2} of the logarithm, from {:.0} e-/s on",
            hot.median_e_per_s, hot.spread, hot.threshold_e_per_s
        ));
    }
    let flats = "flat frames, and bias or dark frames";
    text.push_str(&counted("dead pixels", defects.dead, flats));
    if let Some(columns) = defects.dead_columns.filter(|columns| *columns > 0) {
        text.push_str(&format!(", and {columns} dead columns"));
    }
    text.push_str(&counted("pixels of odd response", defects.odd_response, flats));
    text.push_str(&counted("noisy pixels", Some(defects.noisy), ""));
    text
}

/// Returns a figure as JSON.
fn finding_document(finding: &Finding) -> Value {
    match finding {
        Finding::Value { value, sigma } => json!({ "value": value, "sigma": sigma }),
        Finding::Below(limit) => json!({ "below": limit }),
        Finding::Missing(reason) => json!({ "missing": reason }),
    }
}

/// Returns the figures as JSON.
pub(super) fn document(figures: &SensorFigures) -> Value {
    let named = named_figures(figures);
    let of_name: Map<String, Value> =
        named.iter().map(|(name, _, finding)| ((*name).to_owned(), finding_document(finding))).collect();
    let defects = &figures.defects;
    let levels: Vec<Value> = figures
        .levels
        .iter()
        .map(|level| {
            json!({
                "name": level.name, "kind": level.kind, "time_s": level.time_s, "light": level.light,
                "frames": level.frames, "mean_dn": level.mean_dn, "variance_dn2": level.variance_dn2,
                "state": level.state,
            })
        })
        .collect();
    let limit = figures.limit.map(|limit| match limit {
        SaturationLimit::FullWell => "full_well",
        SaturationLimit::Converter => "converter",
    });
    json!({
        "ok": figures.gain_e_per_dn.value().is_some(), "columns": figures.size[0], "rows": figures.size[1],
        "bit_depth": figures.bit_depth.0, "bit_depth_determined": figures.bit_depth.1,
        "shifted_bits": figures.shifted_bits, "limit": limit, "figures": of_name,
        "light_drift": figures.light_drift, "end_e": figures.end_e,
        "defects": {
            "pixels": defects.pixels, "hot": defects.hot, "dead": defects.dead,
            "dead_columns": defects.dead_columns, "odd_response": defects.odd_response, "noisy": defects.noisy,
            "hot_median_e_per_s": defects.hot_currents.map(|hot| hot.median_e_per_s),
            "hot_spread": defects.hot_currents.map(|hot| hot.spread),
            "hot_threshold_e_per_s": defects.hot_currents.map(|hot| hot.threshold_e_per_s),
        },
        "levels": levels, "notes": figures.notes,
    })
}
