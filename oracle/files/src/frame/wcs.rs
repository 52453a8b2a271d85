//! World coordinates of a frame: a gnomonic projection with SIP distortion, fitted to any mapping.

use contract::{Angle, Direction, Icrs, PixelPoint};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2, Vector3};
use thiserror::Error;

/// Reason why no world coordinates fit a mapping.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WcsError {
    /// No direction maps to a pixel.
    #[error("no direction near the boresight maps to the pixel ({x:.1}, {y:.1})")]
    NotMapped {
        /// Column of the pixel; the first is 0.
        x: f64,
        /// Row of the pixel; the first is 0.
        y: f64,
    },
}

/// One term of a SIP polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SipTerm {
    /// Exponent of the first variable, along columns.
    pub u_power: usize,
    /// Exponent of the second variable, along rows.
    pub v_power: usize,
    /// Coefficient, px^(1 − u_power − v_power).
    pub coefficient: f64,
}

/// Distortion in the SIP convention.
#[derive(Debug, Clone, PartialEq)]
pub struct Sip {
    /// Order of the four polynomials, 3 to 9.
    pub order: usize,
    /// Polynomial A from distorted to undistorted offsets along columns; terms of order 2 and higher.
    pub a: Vec<SipTerm>,
    /// Polynomial B from distorted to undistorted offsets along rows.
    pub b: Vec<SipTerm>,
    /// Polynomial AP from undistorted to distorted offsets along columns; terms of order 1 and higher.
    pub ap: Vec<SipTerm>,
    /// Polynomial BP from undistorted to distorted offsets along rows.
    pub bp: Vec<SipTerm>,
    /// Largest difference between the fit and the mapping over the detector, in either direction, px.
    pub residual_px: f64,
}

/// World coordinates TAN-SIP (Calabretta & Greisen 2002, A&A 395, 1077; Shupe et al. 2005, ASP Conf. Ser.
/// 347, 491).
///
/// With (u, v) the offset of a pixel from CRPIX, the undistorted offset is (u + A(u, v), v + B(u, v)); CD
/// transforms it to the tangent plane at CRVAL, x to the east and y to the north, degrees. AP and BP invert A
/// and B. CRPIX is the principal point and CD the Jacobian there, so a reader without SIP support is correct
/// near the centre.
#[derive(Debug, Clone, PartialEq)]
pub struct TanSip {
    /// ICRS right ascension and declination of the direction that maps to CRPIX, degrees.
    pub crval_deg: [f64; 2],
    /// Principal point; the centre of the first pixel is (1, 1).
    pub crpix: [f64; 2],
    /// Matrix from pixels to the tangent plane, degrees per pixel; its rows are east and north, its columns
    /// detector columns and rows.
    pub cd_deg_per_px: [[f64; 2]; 2],
    /// Distortion; `None` if no SIP follows it to the corners of the detector: the coordinates are then
    /// correct only at the principal point.
    pub sip: Option<Sip>,
}

/// Number of bisections of the detector's size in the search for the radius that SIP reaches.
const HALVINGS: usize = 8;
/// Residual below which no higher order is tried, px: a tenth of the guaranteed residual.
const GOOD_ENOUGH_PX: f64 = 0.001;
/// Guaranteed residual, px.
const PROMISED_PX: f64 = 0.01;

impl TanSip {
    /// Fits the mapping `pixel_from_sky` from astrometric directions to pixels. The result includes all
    /// effects of the mapping: aberration, rotation, projection and distortion. The mapping must be smooth
    /// and accurate to about 1e-6 px; it returns `None` for a direction behind the camera.
    ///
    /// `boresight` is a direction within some degrees of the one that maps to `principal`. The fit uses the
    /// lowest order from 3 to 9 that leaves at most 0.001 px; if order 9 leaves more than 0.01 px, there is
    /// no SIP.
    ///
    /// # Errors
    /// [`WcsError::NotMapped`] if the principal point cannot be reached from the boresight.
    pub fn fit(
        columns: usize,
        rows: usize,
        principal: PixelPoint,
        boresight: Direction<Icrs>,
        pixel_from_sky: impl Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> Result<Self, WcsError> {
        Self::fit_part(columns, rows, principal, boresight, 1.0, &pixel_from_sky)
    }

    /// Returns the distance from the principal point, px, up to which SIP follows a mapping, accurate to some
    /// pixels; infinite if SIP covers the whole detector.
    ///
    /// # Errors
    /// Those of [`TanSip::fit`].
    pub fn reach_px(
        columns: usize,
        rows: usize,
        principal: PixelPoint,
        boresight: Direction<Icrs>,
        pixel_from_sky: impl Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> Result<f64, WcsError> {
        let follows = |share: f64| {
            let wcs = Self::fit_part(columns, rows, principal, boresight, share, &pixel_from_sky)?;
            Ok(wcs.sip.is_some())
        };
        if follows(1.0)? {
            return Ok(f64::INFINITY);
        }
        let (mut reached, mut step) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            step *= 0.5;
            if follows(reached + step)? {
                reached += step;
            }
        }
        let farthest = grid(columns, rows).map(|[x, y]| principal.distance(PixelPoint::new(x, y)));
        Ok(reached * farthest.fold(0.0, f64::max))
    }

    fn fit_part(
        columns: usize,
        rows: usize,
        principal: PixelPoint,
        boresight: Direction<Icrs>,
        share: f64,
        pixel_from_sky: &impl Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> Result<Self, WcsError> {
        let center = direction_of_pixel(principal, boresight, pixel_from_sky)?;
        let plane = TangentPlane::from_center(&center);
        let offset = |tangent: Vector2<f64>| {
            pixel_from_sky(&plane.direction(tangent))
                .map(|p| Vector2::new(p.x - principal.x, p.y - principal.y))
        };
        let not_mapped = WcsError::NotMapped { x: principal.x, y: principal.y };
        let cd = jacobian(&offset).and_then(|jacobian| jacobian.try_inverse()).ok_or(not_mapped)?;

        let cd_deg = cd.map(|c| Angle::from_radians(c).degrees());
        let (x, y) = principal.to_fits();
        Ok(Self {
            crval_deg: [center.ra().degrees(), center.dec().degrees()],
            crpix: [x, y],
            cd_deg_per_px: [[cd_deg.m11, cd_deg.m12], [cd_deg.m21, cd_deg.m22]],
            sip: Sip::fit(columns, rows, principal, share, |ideal| offset(cd * ideal)),
        })
    }
}

impl Sip {
    /// Fits `distort`, from undistorted to distorted offsets from the principal point, px, over a part of the
    /// detector: the detector shrunk about the principal point to the fraction `share` of its size. Returns
    /// `None` if order 9 leaves more than 0.01 px, or if the distortion is too steep for the fixed-point
    /// inversion.
    fn fit(
        columns: usize,
        rows: usize,
        principal: PixelPoint,
        share: f64,
        distort: impl Fn(Vector2<f64>) -> Option<Vector2<f64>>,
    ) -> Option<Self> {
        let offsets = grid(columns, rows).map(|[x, y]| Vector2::new(x - principal.x, y - principal.y));
        let samples = offsets
            .map(|offset| offset * share)
            .map(|distorted| Some(Sample { distorted, ideal: undistort(distorted, &distort)? }))
            .collect::<Option<Vec<_>>>()?;

        // Scaling offsets to about 1 at the border keeps the powers in the fit near 1.
        let scale = columns.max(rows) as f64 * share;
        let mut best: Option<Self> = None;
        for order in 3..=9 {
            let forward = Distortion::fit(&samples, 2, order, scale, |s| (s.distorted, s.ideal));
            let inverse = Distortion::fit(&samples, 1, order, scale, |s| (s.ideal, s.distorted));
            let Some((forward, inverse)) = forward.zip(inverse) else { break };
            let residual_px = samples.iter().fold(0.0_f64, |worst, s| {
                let there = (forward.apply(s.distorted) - s.ideal).norm();
                let back = (inverse.apply(s.ideal) - s.distorted).norm();
                worst.max(there).max(back)
            });
            if best.as_ref().is_none_or(|best| residual_px < best.residual_px) {
                let (a, b, ap, bp) = (forward.u, forward.v, inverse.u, inverse.v);
                best = Some(Self { order, a, b, ap, bp, residual_px });
            }
            if residual_px < GOOD_ENOUGH_PX {
                break;
            }
        }
        best.filter(|best| best.residual_px <= PROMISED_PX)
    }
}

/// Tangent plane of the sphere at a direction, with axes to the east and to the north.
struct TangentPlane {
    center: Vector3<f64>,
    east: Vector3<f64>,
    north: Vector3<f64>,
}

impl TangentPlane {
    fn from_center(center: &Direction<Icrs>) -> Self {
        let (sin_ra, cos_ra) = libm::sincos(center.ra().radians());
        let (sin_dec, cos_dec) = libm::sincos(center.dec().radians());
        Self {
            center: *center.vector(),
            east: Vector3::new(-sin_ra, cos_ra, 0.0),
            north: Vector3::new(-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec),
        }
    }

    /// Returns the direction of a point of the plane, radians; the length of the sum is at least 1.
    fn direction(&self, tangent: Vector2<f64>) -> Direction<Icrs> {
        Direction::from_unit((self.center + self.east * tangent.x + self.north * tangent.y).normalize())
    }
}

/// Returns the direction that maps to a pixel, by Newton's method from a nearby direction.
fn direction_of_pixel(
    pixel: PixelPoint,
    near: Direction<Icrs>,
    pixel_from_sky: &impl Fn(&Direction<Icrs>) -> Option<PixelPoint>,
) -> Result<Direction<Icrs>, WcsError> {
    let not_mapped = WcsError::NotMapped { x: pixel.x, y: pixel.y };
    let mut direction = near;
    // A few steps suffice; an iteration that has not converged after twenty steps never converges.
    for _ in 0..20 {
        let plane = TangentPlane::from_center(&direction);
        let offset = |tangent: Vector2<f64>| {
            pixel_from_sky(&plane.direction(tangent)).map(|p| Vector2::new(p.x - pixel.x, p.y - pixel.y))
        };
        let miss = offset(Vector2::zeros());
        if miss.is_some_and(|miss| miss.norm() < 1e-9) {
            return Ok(direction);
        }
        let step = miss
            .zip(jacobian(&offset).and_then(|jacobian| jacobian.try_inverse()))
            .map(|(miss, inverse)| -inverse * miss)
            .filter(|step| step.iter().all(|s| s.is_finite()));
        direction = plane.direction(step.ok_or_else(|| not_mapped.clone())?);
    }
    Err(not_mapped)
}

/// Returns the derivative at zero, px/rad. The step is about a quarter of a pixel of a wide-angle camera:
/// both the error of the central difference, step² times the third derivative, and the rounding error are
/// then below 1e-8 of the result.
fn jacobian(offset: &impl Fn(Vector2<f64>) -> Option<Vector2<f64>>) -> Option<Matrix2<f64>> {
    const STEP_RAD: f64 = 1e-4;
    let along = |step: Vector2<f64>| Some((offset(step)? - offset(-step)?) / (2.0 * STEP_RAD));
    let columns = [along(Vector2::new(STEP_RAD, 0.0))?, along(Vector2::new(0.0, STEP_RAD))?];
    Some(Matrix2::from_columns(&columns)).filter(|jacobian| jacobian.iter().all(|v| v.is_finite()))
}

/// Returns the undistorted offset of a distorted one, by fixed-point iteration: the derivative of the
/// distortion is well below 1 for every camera that SIP can describe.
fn undistort(
    distorted: Vector2<f64>,
    distort: impl Fn(Vector2<f64>) -> Option<Vector2<f64>>,
) -> Option<Vector2<f64>> {
    let mut ideal = distorted;
    for _ in 0..200 {
        let miss = distorted - distort(ideal)?;
        if miss.norm() < 1e-8 {
            return Some(ideal);
        }
        ideal += miss;
    }
    None
}

/// Returns points over the whole detector, including its borders.
fn grid(columns: usize, rows: usize) -> impl Iterator<Item = [f64; 2]> {
    const POINTS: usize = 19;
    let place = |i: usize, n: usize| i as f64 / (POINTS - 1) as f64 * n as f64 - 0.5;
    (0..POINTS * POINTS).map(move |i| [place(i % POINTS, columns), place(i / POINTS, rows)])
}

/// Offsets of one direction from the principal point, px.
struct Sample {
    distorted: Vector2<f64>,
    ideal: Vector2<f64>,
}

/// Pair of polynomials that are added to an offset.
struct Distortion {
    u: Vec<SipTerm>,
    v: Vec<SipTerm>,
}

impl Distortion {
    /// Fits by least squares (QR) over every second sample; the other samples only evaluate the fit.
    #[expect(
        clippy::indexing_slicing,
        reason = "rows are those of `fitted`, columns those of `powers`, axes two"
    )]
    fn fit(
        samples: &[Sample],
        lowest_order: usize,
        order: usize,
        scale: f64,
        from_to: impl Fn(&Sample) -> (Vector2<f64>, Vector2<f64>),
    ) -> Option<Self> {
        let powers: Vec<(usize, usize)> = (lowest_order..=order)
            .flat_map(|total| (0..=total).map(move |v_power| (total - v_power, v_power)))
            .collect();
        let fitted: Vec<_> = samples.iter().step_by(2).map(from_to).collect();
        let design = DMatrix::from_fn(fitted.len(), powers.len(), |i, j| {
            let from = fitted[i].0 / scale;
            power(from.x, powers[j].0) * power(from.y, powers[j].1)
        });
        let qr = design.qr();
        let (q_transposed, r) = (qr.q().transpose(), qr.r());
        let solve = |axis: usize| {
            let wanted = DVector::from_fn(fitted.len(), |i, _| fitted[i].1[axis] - fitted[i].0[axis]);
            let coefficients = r.solve_upper_triangular(&(&q_transposed * wanted))?;
            let term = |(&(u_power, v_power), &c): (&(usize, usize), &f64)| SipTerm {
                u_power,
                v_power,
                coefficient: c / power(scale, u_power + v_power),
            };
            let terms: Vec<SipTerm> = powers.iter().zip(coefficients.iter()).map(term).collect();
            terms.iter().all(|term| term.coefficient.is_finite()).then_some(terms)
        };
        Some(Self { u: solve(0)?, v: solve(1)? })
    }

    fn apply(&self, from: Vector2<f64>) -> Vector2<f64> {
        let sum = |terms: &[SipTerm]| -> f64 {
            terms.iter().map(|t| t.coefficient * power(from.x, t.u_power) * power(from.y, t.v_power)).sum()
        };
        from + Vector2::new(sum(&self.u), sum(&self.v))
    }
}

fn power(base: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

#[cfg(test)]
pub(crate) mod tests {
    use contract::{Camera, CameraFrame, Rotation};

    use super::*;

    /// Camera of Table 1 of the far-range paper.
    pub(crate) fn camera() -> Camera {
        Camera {
            columns: 752,
            rows: 580,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 395.0,
            principal_y_px: 288.0,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [0.0; 2],
        }
    }

    fn camera_from_icrs(ra_deg: f64, dec_deg: f64) -> Rotation<CameraFrame, Icrs> {
        let z = *Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg)).vector();
        let x = z.cross(&Vector3::new(0.3, -0.2, 0.5)).normalize();
        Rotation::from_axes(&x, &z.cross(&x), &z)
    }

    /// Complete mapping: first-order aberration, rotation, projection, radial distortion.
    pub(crate) fn mapping(
        camera: &Camera,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
    ) -> impl Fn(&Direction<Icrs>) -> Option<PixelPoint> + use<> {
        let (fx, fy) = camera.focal_length_px();
        let (x0, y0, k) = (camera.principal_x_px, camera.principal_y_px, camera.radial);
        move |sky| {
            let apparent = sky.vector() + Vector3::new(-17.0, 22.0, 9.5) / 299_792.458;
            let v = camera_from_icrs.rotate(&apparent.normalize());
            let (x, y) = (fx * v.x / v.z, fy * v.y / v.z);
            let r2 = x * x + y * y;
            let factor = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
            (v.z > 0.0).then(|| PixelPoint::new(x0 + factor * x, y0 + factor * y))
        }
    }

    fn fit(camera: &Camera, ra_deg: f64, dec_deg: f64) -> Result<TanSip, WcsError> {
        let rotation = camera_from_icrs(ra_deg, dec_deg);
        let boresight = rotation.inverse() * Direction::z();
        let principal = PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
        TanSip::fit(camera.columns, camera.rows, principal, boresight, mapping(camera, rotation))
    }

    #[test]
    fn the_flight_camera_is_fitted_well_below_the_stated_error_everywhere_on_the_sky() {
        for (ra, dec) in [(0.0, 0.0), (10.0, 80.0), (200.0, -89.999), (359.9999, 45.0), (77.0, 90.0)] {
            let wcs = fit(&camera(), ra, dec).unwrap();
            // A residual of 0.01 px is guaranteed; orders from 5 up are tried until it is 0.001 px.
            let sip = wcs.sip.unwrap();
            assert!(sip.residual_px < GOOD_ENOUGH_PX, "{}", sip.residual_px);
            assert_eq!(sip.order, 5);
            assert_eq!(wcs.crpix, [396.0, 289.0]);
        }
    }

    /// Compares the mapping with an independent evaluation of the TAN-SIP definition, from the sky to the
    /// detector.
    #[test]
    fn the_published_definition_gives_the_pixel() {
        let camera = camera();
        let wcs = fit(&camera, 83.0, -5.0).unwrap();
        let map = mapping(&camera, camera_from_icrs(83.0, -5.0));
        let center = wcs.crval_deg.map(f64::to_radians);
        for (dra, ddec) in [(0.0, 0.0), (4.0, 3.0), (-5.0, 2.0), (3.0, -5.0)] {
            let (ra, dec) = (center[0] + f64::to_radians(dra), center[1] + f64::to_radians(ddec));
            let sky = Direction::from_ra_dec(Angle::from_radians(ra), Angle::from_radians(dec));
            let ((sd, cd), (s0, c0)) = (libm::sincos(dec), libm::sincos(center[1]));
            let (sa, ca) = libm::sincos(ra - center[0]);
            let w = sd * s0 + cd * c0 * ca;
            let plane = Vector2::new(cd * sa / w, (c0 * sd - s0 * cd * ca) / w).map(f64::to_degrees);
            let [[cd11, cd12], [cd21, cd22]] = wcs.cd_deg_per_px;
            let ideal = Matrix2::new(cd11, cd12, cd21, cd22).try_inverse().unwrap() * plane;
            let sip = wcs.sip.clone().unwrap();
            let inverse = Distortion { u: sip.ap, v: sip.bp };
            let offset = inverse.apply(ideal);
            let got = PixelPoint::from_fits(wcs.crpix[0] + offset.x, wcs.crpix[1] + offset.y);
            let expected = map(&sky).unwrap();
            assert!(expected.is_on_detector(752, 580));
            // The difference is only the residual of the fit.
            assert!(got.distance(expected) < 0.002, "{got:?} {expected:?}");
        }
    }

    #[test]
    fn aberration_is_in_the_reference_direction() {
        let wcs = fit(&camera(), 83.0, -5.0).unwrap();
        let [ra, dec] = wcs.crval_deg.map(Angle::from_degrees);
        let boresight = camera_from_icrs(83.0, -5.0).inverse() * Direction::z();
        let shift = Direction::from_ra_dec(ra, dec).separation(&boresight).arcsec();
        // The whole 29 km/s perpendicular to the boresight would cause 20.5″.
        assert!(shift > 5.0 && shift < 20.6, "{shift}");
    }

    /// A barrel distortion that order 9 no longer follows at the corners, pincushion distortions that are too
    /// steep, and a barrel distortion that folds.
    #[test]
    fn a_distortion_beyond_sip_keeps_the_plane_and_reports_its_size() {
        let reach = |k1: f64| {
            let camera = Camera { radial: [k1, 0.0, 0.0], ..camera() };
            let wcs = fit(&camera, 0.0, 0.0).unwrap();
            assert_eq!(wcs.crpix, [396.0, 289.0]);
            let rotation = camera_from_icrs(0.0, 0.0);
            let boresight = rotation.inverse() * Direction::z();
            let principal = PixelPoint::new(camera.principal_x_px, camera.principal_y_px);
            let map = mapping(&camera, rotation);
            let reach_px = TanSip::reach_px(camera.columns, camera.rows, principal, boresight, map).unwrap();
            assert_eq!(wcs.sip.is_some(), reach_px.is_infinite());
            reach_px
        };
        assert_eq!(reach(2.6e-8), f64::INFINITY);
        let corner_px = libm::hypot(395.5, 291.5);
        for steeper in [[-4e-7, -6e-7, -4e-6], [2e-6, 5e-6, 2e-5]] {
            let reached = steeper.map(reach);
            assert!(reached.is_sorted_by(|a, b| a > b), "{reached:?}");
            assert!(reached[0] < corner_px && reached[0] > 300.0 && reached[2] > 10.0, "{reached:?}");
        }
    }

    #[test]
    fn a_mapping_that_cannot_be_fitted_is_an_error() {
        let nowhere = TanSip::fit(9, 9, PixelPoint::default(), Direction::from_unit(Vector3::x()), |_| None);
        assert!(matches!(nowhere, Err(WcsError::NotMapped { .. })));
        let nan = |_: &Direction<Icrs>| Some(PixelPoint::new(f64::NAN, 0.0));
        assert!(TanSip::fit(9, 9, PixelPoint::default(), Direction::from_unit(Vector3::x()), nan).is_err());
    }
}
