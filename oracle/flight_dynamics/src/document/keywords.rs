//! Keywords that both notations share.

/// Keywords of the lower triangle of a covariance, row by row.
pub(crate) const COVARIANCE: [&str; 21] = [
    "CX_X",
    "CY_X",
    "CY_Y",
    "CZ_X",
    "CZ_Y",
    "CZ_Z",
    "CX_DOT_X",
    "CX_DOT_Y",
    "CX_DOT_Z",
    "CX_DOT_X_DOT",
    "CY_DOT_X",
    "CY_DOT_Y",
    "CY_DOT_Z",
    "CY_DOT_X_DOT",
    "CY_DOT_Y_DOT",
    "CZ_DOT_X",
    "CZ_DOT_Y",
    "CZ_DOT_Z",
    "CZ_DOT_X_DOT",
    "CZ_DOT_Y_DOT",
    "CZ_DOT_Z_DOT",
];

/// Returns the element of an OPM's data that holds a keyword.
pub(super) fn opm_element(keyword: &str) -> &'static str {
    match keyword {
        "EPOCH" | "X" | "Y" | "Z" | "X_DOT" | "Y_DOT" | "Z_DOT" => "stateVector",
        "SEMI_MAJOR_AXIS" | "ECCENTRICITY" | "INCLINATION" | "RA_OF_ASC_NODE" | "ARG_OF_PERICENTER"
        | "TRUE_ANOMALY" | "MEAN_ANOMALY" | "GM" => "keplerianElements",
        "MASS" | "SOLAR_RAD_AREA" | "SOLAR_RAD_COEFF" | "DRAG_AREA" | "DRAG_COEFF" => "spacecraftParameters",
        keyword if keyword.starts_with("MAN_") => "maneuverParameters",
        keyword if keyword.starts_with("USER_DEFINED_") => "userDefinedParameters",
        keyword if keyword == "COV_REF_FRAME" || COVARIANCE.contains(&keyword) => "covarianceMatrix",
        _ => "unknown",
    }
}
