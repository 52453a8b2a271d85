//! Groups of a docking score: bins of the true range, and lenses.

use contract::Camera;

/// Limits of the bins, m. A bin excludes its lower limit and includes its upper one. The farthest bin has no
/// upper limit: an approach from d3 = 500 m begins a few centimetres beyond 500 m.
pub const RANGE_BINS_M: [f64; 9] = [200.0, 100.0, 50.0, 30.0, 20.0, 10.0, 5.0, 3.0, 1.5];

/// Returns the bin of a range, counted from the farthest: 0 is beyond 200 m, 9 is 1.5 m or less.
pub(super) fn bin(range_m: f64) -> usize {
    RANGE_BINS_M.iter().filter(|limit| range_m <= **limit).count()
}

/// Returns the name of the group of a bin and a lens: `20–10 m, 15.0°`.
pub fn group_name(bin: usize, lens: &str) -> String {
    let upper = bin.checked_sub(1).and_then(|before| RANGE_BINS_M.get(before));
    match (upper, RANGE_BINS_M.get(bin)) {
        (Some(upper), Some(lower)) => format!("{upper}–{lower} m, {lens}"),
        (None, Some(lower)) => format!("> {lower} m, {lens}"),
        (Some(upper), None) => format!("< {upper} m, {lens}"),
        (None, None) => lens.to_owned(),
    }
}

/// Returns a name for each lens: its field of view along columns, 2 atan(columns/2f), followed by its number
/// if two lenses have the same field of view.
pub fn lens_names(cameras: &[Camera]) -> Vec<String> {
    let field_of_view = |camera: &Camera| {
        let half_width = 0.5 * camera.columns as f64 / camera.focal_length_px().0;
        format!("{:.1}°", 2.0 * libm::atan(half_width).to_degrees())
    };
    let plain: Vec<String> = cameras.iter().map(field_of_view).collect();
    plain
        .iter()
        .enumerate()
        .map(|(number, name)| {
            let alone = plain.iter().filter(|other| *other == name).count() == 1;
            if alone { name.clone() } else { format!("{name} ({number})") }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::camera;

    #[test]
    fn a_limit_belongs_to_the_bin_below_it() {
        for (range_m, name) in [
            (500.03, "> 200 m, w"),
            (200.1, "> 200 m, w"),
            (200.0, "200–100 m, w"),
            (3.0, "3–1.5 m, w"),
            (1.5, "< 1.5 m, w"),
            (0.4, "< 1.5 m, w"),
        ] {
            assert_eq!(group_name(bin(range_m), "w"), name, "{range_m} m");
        }
    }

    #[test]
    fn a_lens_is_named_by_its_field_of_view() {
        let (narrow, wide) = (camera(2917.0), camera(1055.0));
        assert_eq!(lens_names(&[narrow.clone(), wide.clone()]), ["15.0°", "40.0°"]);
        assert_eq!(lens_names(&[narrow.clone(), narrow.clone()]), ["15.0° (0)", "15.0° (1)"]);
        assert_eq!(lens_names(&[narrow.clone(), wide, narrow]), ["15.0° (0)", "40.0°", "15.0° (2)"]);
    }
}
