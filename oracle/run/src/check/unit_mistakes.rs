//! Permitted values that suggest a unit mistaken by a factor of a thousand.

use serde_json::Value;

/// Keys of scenarios with the lower and upper limit of their usual values.
const USUAL_RANGES: [(&str, f64, f64); 12] = [
    ("aperture_diameter_mm", 0.5, 1e4),
    ("cadence_s", 1e-3, 1e5),
    ("exposure_s", 1e-5, 100.0),
    ("focal_length_mm", 1.0, 2e4),
    ("frame_rate_hz", 1.0, 1000.0),
    ("full_well_e", 1000.0, 1e7),
    ("max_s", 1e-5, 100.0),
    ("min_s", 1e-6, 10.0),
    ("pixel_height_um", 1.0, 200.0),
    ("pixel_width_um", 1.0, 200.0),
    ("radius_m", 0.02, 100.0),
    ("readout_s", 1e-5, 100.0),
];

/// Returns remarks on the unusual values of a scenario that would be usual if they were a thousand times
/// larger or smaller.
pub(crate) fn unit_mistakes(scenario: &Value) -> Vec<String> {
    let mut remarks = Vec::new();
    collect(scenario, "", &mut remarks);
    remarks
}

fn collect(value: &Value, path: &str, remarks: &mut Vec<String>) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                remarks.extend(value.as_f64().and_then(|number| remark(key, &path, number)));
                collect(value, &path, remarks);
            }
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| collect(item, &format!("{path}[{i}]"), remarks));
        }
        _ => {}
    }
}

fn remark(key: &str, path: &str, number: f64) -> Option<String> {
    let &(_, low, high) = USUAL_RANGES.iter().find(|(usual, ..)| *usual == key)?;
    let is_usual = |number: &f64| (low..=high).contains(number);
    let meant =
        [number * 1000.0, number / 1000.0].into_iter().find(is_usual).filter(|_| !is_usual(&number))?;
    Some(format!("{path} is {number}, usually {low} to {high}; was {meant} meant?"))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn only_a_factor_of_a_thousand_is_reported() {
        let scenario = json!({
            "camera": { "focal_length_mm": 0.020187, "pixel_width_um": 8.6 },
            "shutter": { "max_s": 250.0, "min_s": 0.001 },
            // Unusual values that a factor of a thousand does not explain.
            "cameras": [{ "camera": { "focal_length_mm": 1e8 } }, { "camera": { "focal_length_mm": 24211.1 } }],
            "sensor": { "cosmic_rays": { "readout_s": 0.0 } },
        });
        let remarks = unit_mistakes(&scenario);
        assert_eq!(remarks.len(), 3, "{remarks:?}");
        assert_eq!(remarks[0], "camera.focal_length_mm is 0.020187, usually 1 to 20000; was 20.187 meant?");
        assert!(remarks[1].starts_with("cameras[1].camera.focal_length_mm is 24211.1"), "{remarks:?}");
        assert_eq!(remarks[2], "shutter.max_s is 250, usually 0.00001 to 100; was 0.25 meant?");
    }
}
