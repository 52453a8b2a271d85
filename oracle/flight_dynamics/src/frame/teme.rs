//! True equator, mean equinox of date: precession of 1976 and nutation of 1980 (Lieske et al. 1977;
//! Seidelmann 1982; both in Vallado et al., AIAA 2006-6753).

use nalgebra::Matrix3;

use super::turn::{ARCSEC, turn};

/// A term of the nutation of 1980: multiples of l, l', F, D, Ω; coefficients of Δψ and its rate, of Δε and
/// its rate, 0.1 mas and 0.1 mas per century.
type Term = ([f64; 5], [f64; 4]);

/// The 31 terms with Δψ of 1.5 mas or more. The other 75 add up to less than 20 mas.
const TERMS: [Term; 31] = [
    ([0.0, 0.0, 0.0, 0.0, 1.0], [-171_996.0, -174.2, 92_025.0, 8.9]),
    ([0.0, 0.0, 2.0, -2.0, 2.0], [-13_187.0, -1.6, 5_736.0, -3.1]),
    ([0.0, 0.0, 2.0, 0.0, 2.0], [-2_274.0, -0.2, 977.0, -0.5]),
    ([0.0, 0.0, 0.0, 0.0, 2.0], [2_062.0, 0.2, -895.0, 0.5]),
    ([0.0, 1.0, 0.0, 0.0, 0.0], [1_426.0, -3.4, 54.0, -0.1]),
    ([1.0, 0.0, 0.0, 0.0, 0.0], [712.0, 0.1, -7.0, 0.0]),
    ([0.0, 1.0, 2.0, -2.0, 2.0], [-517.0, 1.2, 224.0, -0.6]),
    ([0.0, 0.0, 2.0, 0.0, 1.0], [-386.0, -0.4, 200.0, 0.0]),
    ([1.0, 0.0, 2.0, 0.0, 2.0], [-301.0, 0.0, 129.0, -0.1]),
    ([0.0, -1.0, 2.0, -2.0, 2.0], [217.0, -0.5, -95.0, 0.3]),
    ([1.0, 0.0, 0.0, -2.0, 0.0], [-158.0, 0.0, -1.0, 0.0]),
    ([0.0, 0.0, 2.0, -2.0, 1.0], [129.0, 0.1, -70.0, 0.0]),
    ([-1.0, 0.0, 2.0, 0.0, 2.0], [123.0, 0.0, -53.0, 0.0]),
    ([1.0, 0.0, 0.0, 0.0, 1.0], [63.0, 0.1, -33.0, 0.0]),
    ([0.0, 0.0, 0.0, 2.0, 0.0], [63.0, 0.0, -2.0, 0.0]),
    ([-1.0, 0.0, 2.0, 2.0, 2.0], [-59.0, 0.0, 26.0, 0.0]),
    ([-1.0, 0.0, 0.0, 0.0, 1.0], [-58.0, -0.1, 32.0, 0.0]),
    ([1.0, 0.0, 2.0, 0.0, 1.0], [-51.0, 0.0, 27.0, 0.0]),
    ([2.0, 0.0, 0.0, -2.0, 0.0], [48.0, 0.0, 1.0, 0.0]),
    ([-2.0, 0.0, 2.0, 0.0, 1.0], [46.0, 0.0, -24.0, 0.0]),
    ([0.0, 0.0, 2.0, 2.0, 2.0], [-38.0, 0.0, 16.0, 0.0]),
    ([2.0, 0.0, 2.0, 0.0, 2.0], [-31.0, 0.0, 13.0, 0.0]),
    ([2.0, 0.0, 0.0, 0.0, 0.0], [29.0, 0.0, -1.0, 0.0]),
    ([1.0, 0.0, 2.0, -2.0, 2.0], [29.0, 0.0, -12.0, 0.0]),
    ([0.0, 0.0, 2.0, 0.0, 0.0], [26.0, 0.0, -1.0, 0.0]),
    ([0.0, 0.0, 2.0, -2.0, 0.0], [-22.0, 0.0, 0.0, 0.0]),
    ([-1.0, 0.0, 2.0, 0.0, 1.0], [21.0, 0.0, -10.0, 0.0]),
    ([0.0, 2.0, 0.0, 0.0, 0.0], [17.0, -0.1, 0.0, 0.0]),
    ([0.0, 2.0, 2.0, -2.0, 2.0], [-16.0, 0.1, 7.0, 0.0]),
    ([-1.0, 0.0, 0.0, 2.0, 1.0], [16.0, 0.0, -8.0, 0.0]),
    ([0.0, 1.0, 0.0, 0.0, 1.0], [-15.0, 0.0, 9.0, 0.0]),
];

/// Matrix from the true equator and mean equinox of date to the mean equator and equinox of J2000.0, at a TT
/// since J2000.0, s. TT is used for TDB; they differ by 2 ms.
pub(super) fn eme2000_from_teme(tt_j2000_s: f64) -> Matrix3<f64> {
    let t = tt_j2000_s / (36_525.0 * 86_400.0);
    let (psi, epsilon) = nutation(t);
    let obliquity = mean_obliquity(t);
    let equation_of_equinoxes = psi * libm::cos(obliquity);
    let mod_from_tod = (turn(0, -obliquity - epsilon) * turn(2, -psi) * turn(0, obliquity)).transpose();
    precession(t).transpose() * mod_from_tod * turn(2, -equation_of_equinoxes)
}

/// Mean obliquity of the ecliptic of 1980, rad, at Julian centuries since J2000.0.
fn mean_obliquity(t: f64) -> f64 {
    (84_381.448 + (-46.815 + (-0.000_59 + 0.001_813 * t) * t) * t) * ARCSEC
}

/// Matrix from the mean equator and equinox of J2000.0 to those of date (Lieske et al. 1977).
fn precession(t: f64) -> Matrix3<f64> {
    let zeta = (2_306.218_1 + (0.301_88 + 0.017_998 * t) * t) * t * ARCSEC;
    let z = (2_306.218_1 + (1.094_68 + 0.018_203 * t) * t) * t * ARCSEC;
    let theta = (2_004.310_9 + (-0.426_65 - 0.041_833 * t) * t) * t * ARCSEC;
    turn(2, -z) * turn(1, theta) * turn(2, -zeta)
}

/// Nutation in longitude and obliquity (Δψ, Δε), rad.
fn nutation(t: f64) -> (f64, f64) {
    // Fundamental arguments of the theory of 1980: turns per century, and arcseconds.
    let argument = |turns: f64, a: [f64; 4]| {
        let [a0, a1, a2, a3] = a;
        let whole = turns * t;
        (whole - libm::floor(whole)) * 1_296_000.0 + a0 + (a1 + (a2 + a3 * t) * t) * t
    };
    let arguments = [
        argument(1_325.0, [485_866.733, 715_922.633, 31.310, 0.064]),
        argument(99.0, [1_287_099.804, 1_292_581.224, -0.577, -0.012]),
        argument(1_342.0, [335_778.877, 295_263.137, -13.257, 0.011]),
        argument(1_236.0, [1_072_261.307, 1_105_601.328, -6.891, 0.019]),
        argument(-5.0, [450_160.280, -482_890.539, 7.455, 0.008]),
    ];
    let (mut psi, mut epsilon) = (0.0, 0.0);
    // The smallest terms first.
    for (multiples, [psi_0, psi_1, epsilon_0, epsilon_1]) in TERMS.iter().rev() {
        let angle: f64 =
            multiples.iter().zip(&arguments).map(|(multiple, argument)| multiple * argument).sum();
        let (sin, cos) = libm::sincos(angle * ARCSEC);
        psi += (psi_0 + psi_1 * t) * sin;
        epsilon += (epsilon_0 + epsilon_1 * t) * cos;
    }
    (psi * 1e-4 * ARCSEC, epsilon * 1e-4 * ARCSEC)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times from 1990 to 2050, s of TT since J2000.0.
    fn times() -> impl Iterator<Item = f64> {
        (0..600).map(|step| -3_652.5 * 86_400.0 + f64::from(step) * 36.4321 * 86_400.0)
    }

    /// SOFA's `iauNut80`, all 106 terms, by the crate `sofars`.
    #[test]
    fn the_nutation_is_that_of_sofa_to_20_mas() {
        let mut worst = [0.0_f64; 2];
        for tt_s in times() {
            let (psi, epsilon) = nutation(tt_s / 86_400.0 / 36_525.0);
            let (psi_sofa, epsilon_sofa) = sofars::pnp::nut80(2_451_545.0, tt_s / 86_400.0);
            worst[0] = worst[0].max((psi - psi_sofa).abs() / ARCSEC);
            worst[1] = worst[1].max((epsilon - epsilon_sofa).abs() / ARCSEC);
        }
        assert!(worst[0] < 0.020 && worst[1] < 0.010, "{worst:?}");
        // Not zero: SOFA has the terms that this table lacks.
        assert!(worst[0] > 1e-4, "{worst:?}");
    }

    #[test]
    fn the_precession_is_that_of_sofa() {
        for tt_s in times() {
            let sofa = sofars::pnp::pmat76(2_451_545.0, tt_s / 86_400.0);
            let ours = precession(tt_s / 86_400.0 / 36_525.0);
            for row in 0..3 {
                for column in 0..3 {
                    assert!((ours[(row, column)] - sofa[row][column]).abs() < 1e-14);
                }
            }
        }
    }

    /// Vallado et al. 2006, appendix C: the state of satellite 00005 in TEME and in FK5 J2000 (its "ECI").
    #[test]
    fn the_published_example_is_met() {
        use nalgebra::Vector3;
        // 2000-06-27 (day 182.78495062 of 2000), three days after the epoch of the elements.
        let days = 182.784_950_62 - 1.5 + 64.184 / 86_400.0;
        let teme = Vector3::new(-9_060.473_735_69, 4_658.709_525_02, 813.686_731_53);
        let published = Vector3::new(-9_059.941_378_6, 4_659.697_200_0, 813.958_887_5);
        let ours = eme2000_from_teme(days * 86_400.0) * teme;
        // 1 m is 0.02″ at this distance.
        assert!((ours - published).norm() < 1.5e-3, "{ours} {}", (ours - published).norm());
    }
}
