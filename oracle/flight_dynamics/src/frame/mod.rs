//! Reference frames of messages, and their rotation to ICRS.

mod teme;
mod turn;

use contract::Icrs;
use contract::Rotation;
use hifitime::Epoch;
use nalgebra::{Matrix3, Vector3};
use sim::truth::{State, clock};

use turn::{ARCSEC, turn};

/// Axes of the states of a message, geocentric.
///
/// Frames that rotate with the Earth (ITRF and relatives) are refused: their rotation needs measured values
/// of UT1 and of the pole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceFrame {
    /// Axes of the International Celestial Reference System: ICRF and GCRF. Written as GCRF, the geocentric
    /// one: the origin of Orekit's ICRF is the barycentre of the Solar System.
    Icrf,
    /// Mean equator and equinox of J2000.0, turned against ICRS by the frame bias of 23 mas (IERS Conventions
    /// 2010, 5.21 and 5.33).
    Eme2000,
    /// True equator and mean equinox of date: the frame of SGP4. Turned by the equation of the equinoxes, the
    /// nutation of 1980 (31 largest terms, 0.02″) and the precession of 1976, as Vallado et al., *Revisiting
    /// Spacetrack Report #3*, AIAA 2006-6753, appendix C; then the frame bias.
    Teme,
}

/// Axes of a message, as a type for rotations.
pub(crate) enum FileAxes {}

/// Frames that are read, for messages.
pub(crate) const FRAME_NAMES: &str =
    "ICRF, GCRF, EME2000 or TEME (frames fixed to the Earth need measured values of UT1 and of the pole)";

impl ReferenceFrame {
    /// Returns the keyword of CCSDS.
    pub fn code(self) -> &'static str {
        match self {
            Self::Icrf => "GCRF",
            Self::Eme2000 => "EME2000",
            Self::Teme => "TEME",
        }
    }

    /// Parses a keyword, in capitals or not; `None` for another frame.
    pub fn parse(code: &str) -> Option<Self> {
        let code = code.to_ascii_uppercase();
        match code.as_str() {
            "ICRF" | "GCRF" | "ICRF1" | "ICRF2" | "ICRF3" | "ICRS" | "GCRS" => Some(Self::Icrf),
            "EME2000" | "J2000" => Some(Self::Eme2000),
            "TEME" | "TEMEOFDATE" => Some(Self::Teme),
            _ => None,
        }
    }

    /// Returns a state with components in this frame as a state with components in ICRS.
    pub(crate) fn icrs_state(
        self,
        time: Epoch,
        position_km: &Vector3<f64>,
        velocity_km_s: &Vector3<f64>,
    ) -> State {
        let rotation = self.icrs_from_frame(time);
        // The axes of TEME turn by 50″ a year: 5e-8 km/s in a low orbit, neglected.
        State { position_km: rotation.rotate(position_km), velocity_km_s: rotation.rotate(velocity_km_s) }
    }

    /// Returns the rotation from this frame to ICRS at `time`.
    pub(crate) fn icrs_from_frame(self, time: Epoch) -> Rotation<Icrs, FileAxes> {
        let matrix = match self {
            Self::Icrf => return Rotation::identity(),
            Self::Eme2000 => icrs_from_eme2000(),
            Self::Teme => icrs_from_eme2000() * teme::eme2000_from_teme(clock::tt_j2000_s(time)),
        };
        let [x, y, z] = [0, 1, 2].map(|row| matrix.row(row).transpose());
        Rotation::from_axes(&x, &y, &z)
    }
}

/// Frame bias, transposed: from mean equator and equinox of J2000.0 to ICRS. Angles of the IERS Conventions
/// 2010, Eq. 5.21 and 5.33.
fn icrs_from_eme2000() -> Matrix3<f64> {
    let (xi, eta, alpha) = (-0.016_617 * ARCSEC, -0.006_819_2 * ARCSEC, -0.014_6 * ARCSEC);
    (turn(0, -eta) * turn(1, xi) * turn(2, alpha)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SOFA's bias matrix (`iauBp00`, IAU 2000) by the crate `sofars`, whose α0, −14.6 mas, and other angles
    /// agree with the conventions' to the 0.1 µas printed.
    #[test]
    fn the_frame_bias_is_that_of_sofa() {
        let (rb, _, _) = sofars::pnp::bp00(2_451_545.0, 0.0);
        let ours = icrs_from_eme2000().transpose();
        for row in 0..3 {
            for column in 0..3 {
                let difference = ours[(row, column)] - rb[row][column];
                assert!(difference.abs() < 1e-3 * 1e-3 * ARCSEC, "{row} {column} {difference:e}");
            }
        }
    }

    #[test]
    fn frames_fixed_to_the_earth_are_not_read() {
        for name in ["ITRF", "ITRF2000", "ITRF-97", "GRC", "TDR", "TOD", "MOD", "RTN", "", "eme"] {
            assert_eq!(ReferenceFrame::parse(name), None, "{name}");
        }
        for frame in [ReferenceFrame::Icrf, ReferenceFrame::Eme2000, ReferenceFrame::Teme] {
            assert_eq!(ReferenceFrame::parse(&frame.code().to_lowercase()), Some(frame));
        }
    }
}
