//! Names from files, in readable form.

/// Abbreviations that are written in capitals.
const ABBREVIATIONS: [(&str, &str); 5] =
    [("roi", "ROI"), ("psf", "PSF"), ("ccd", "CCD"), ("cmos", "CMOS"), ("snr", "SNR")];

/// Returns a name with spaces and its abbreviations in capitals: `cut by ROI`.
pub fn display_name(name: &str) -> String {
    let capitals = |word: &str| {
        let found = ABBREVIATIONS.iter().find(|(small, _)| *small == word);
        found.map_or_else(|| word.to_owned(), |(_, capitals)| (*capitals).to_owned())
    };
    name.split('_').map(capitals).collect::<Vec<_>>().join(" ")
}

/// Units at the end of a key, with their signs; the longest come first.
const UNITS: [(&str, &str); 24] = [
    ("_e_per_s_per_px", "e⁻/s per px"),
    ("_e_per_dn", "e⁻/DN"),
    ("_e_per_s", "e⁻/s"),
    ("_deg_per_s", "°/s"),
    ("_arcsec", "″"),
    ("_percent", "%"),
    ("_m_per_s", "m/s"),
    ("_m_s", "m/s"),
    ("_deg", "°"),
    ("_mag", "mag"),
    ("_px", "px"),
    ("_km", "km"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_nm", "nm"),
    ("_ms", "ms"),
    ("_us", "µs"),
    ("_dn", "DN"),
    ("_hz", "Hz"),
    ("_m2", "m²"),
    ("_s", "s"),
    ("_m", "m"),
    ("_e", "e⁻"),
    ("_k", "K"),
];

/// Returns the words for a key of a scenario: `psf.sigma_px` is `PSF sigma, px`.
pub fn setting_name(key: &str) -> String {
    let found = UNITS.iter().find_map(|(end, unit)| Some((key.strip_suffix(end)?, *unit)));
    let (key, unit) = found.unwrap_or((key, ""));
    let words = display_name(&key.replace('.', "_"));
    if unit.is_empty() { words } else { format!("{words}, {unit}") }
}

/// Returns a word with a capital first letter. A Greek letter stays as it is: it is a symbol or a prefix.
pub fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_ascii_uppercase().to_string() + letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_symbol_has_no_capital() {
        assert_eq!(["hit rate", "σ of x", ""].map(capital), ["Hit rate", "σ of x", ""]);
    }

    #[test]
    fn a_key_is_shown_in_words_with_its_unit() {
        let shown = ["psf.sigma_px", "sensor.dark_current_e_per_s", "far_range.mode", "roi.columns"]
            .map(setting_name);
        assert_eq!(shown, ["PSF sigma, px", "sensor dark current, e⁻/s", "far range mode", "ROI columns"]);
    }
}
