//! Mistakes in the inputs that explain frames in which no star fits.
//!
//! The stars of such frames are identified without the telemetry ([`LostInSpace`]), as stated, with reversed
//! rows or columns, and with other focal lengths. The attitudes that follow are compared with those of the
//! telemetry, as stated and in other conventions.

use std::fmt;

use contract::{Angle, Body, Camera, CameraFrame, Icrs, PixelPoint, Rotation, Setup};
use nalgebra::{Vector2, Vector3};

use super::lost_in_space::LostInSpace;
use crate::CameraModel;

/// Frame in which no star fits.
#[derive(Debug, Clone)]
pub struct UnmatchedFrame {
    /// Clusters: position, px, and brightness in any unit.
    pub sources: Vec<(PixelPoint, f64)>,
    /// Attitude of the telemetry.
    pub body_from_icrs: Rotation<Body, Icrs>,
}

/// Inputs with which the stars fit, where they are not as stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputMistake {
    /// Order of the pixels.
    pub image: PixelOrder,
    /// Convention of the quaternions in the telemetry.
    pub quaternion: QuaternionForm,
    /// Focal length over that of the camera; `None` if that fits.
    pub focal_length_ratio: Option<f64>,
    /// Mounting of the camera.
    pub mounting: Mounting,
    /// Number of frames whose stars fit.
    pub fitting: usize,
    /// Number of frames that were tried.
    pub tried: usize,
}

/// Order of the pixels in an image, relative to that expected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelOrder {
    /// As expected: the first row at the top, columns from left to right.
    AsExpected,
    /// The first row at the bottom.
    RowsReversed,
    /// Columns from right to left: a mirror in the optics, for instance.
    ColumnsReversed,
    /// Turned by 180°.
    Turned,
}

/// Convention of a quaternion, relative to that expected: scalar first, from ICRS to body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QuaternionForm {
    /// Order of the components.
    pub order: QuaternionOrder,
    /// True for the rotation from body to ICRS.
    pub is_inverse: bool,
}

/// Order of a quaternion's components, relative to that expected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QuaternionOrder {
    /// As expected.
    AsExpected,
    /// The scalar part stands in the place of the third vector component, x, y, z in those before.
    ScalarLast,
    /// The third vector component stands in the place of the scalar part: the components were moved back.
    MovedBack,
}

/// Mounting of a camera, relative to the stated one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mounting {
    /// As stated.
    AsStated,
    /// Another one, constant in the frames that were tried.
    Other(Rotation<CameraFrame, Body>),
    /// None: the attitudes of the telemetry do not follow the images.
    None,
}

/// Largest number of frames that are tried.
const MAX_FRAMES: usize = 8;

/// Number of frames tried with every focal length.
const FOCAL_FRAMES: usize = 2;

/// Largest relative error of the focal length, and step of the search: the solver accepts half a step.
const MAX_FOCAL_ERROR: f64 = 0.05;
const FOCAL_STEP: f64 = 0.0025;

/// Relative error of the focal length that is reported.
const REPORTED_FOCAL_ERROR: f64 = 5e-4;

/// Largest angle between an attitude by stars and one of telemetry in the right convention: the error of the
/// mounting. The angle of a wrong convention is random: below θ = 3° with the probability (θ − sin θ)/π =
/// 8e-6.
const MAX_MOUNTING_ERROR_DEG: f64 = 3.0;

/// Angle above which the mounting counts as another one, and largest scatter of a constant mounting.
const REPORTED_MOUNTING_DEG: f64 = 0.3;
const MOUNTING_SCATTER_DEG: f64 = 0.5;

const PIXEL_ORDERS: [PixelOrder; 4] =
    [PixelOrder::AsExpected, PixelOrder::RowsReversed, PixelOrder::ColumnsReversed, PixelOrder::Turned];

const QUATERNION_FORMS: [QuaternionForm; 6] = [
    QuaternionForm { order: QuaternionOrder::AsExpected, is_inverse: false },
    QuaternionForm { order: QuaternionOrder::AsExpected, is_inverse: true },
    QuaternionForm { order: QuaternionOrder::ScalarLast, is_inverse: false },
    QuaternionForm { order: QuaternionOrder::ScalarLast, is_inverse: true },
    QuaternionForm { order: QuaternionOrder::MovedBack, is_inverse: false },
    QuaternionForm { order: QuaternionOrder::MovedBack, is_inverse: true },
];

/// Attitude by the stars of a frame, with the attitude of its telemetry.
struct SolvedFrame {
    camera_from_icrs: Rotation<CameraFrame, Icrs>,
    body_from_icrs: Rotation<Body, Icrs>,
    /// Focal length over that of the model, from the distances of the stars.
    focal_length_ratio: f64,
}

/// Returns the inputs with which the stars of frames fit; `None` if none of those tried does, or if all are
/// as stated.
pub fn find_mistake(setup: &Setup, frames: &[UnmatchedFrame]) -> Option<InputMistake> {
    let frames = frames.get(..MAX_FRAMES).unwrap_or(frames);
    let (camera, ratio) = fitting_camera(setup, frames)?;
    let model = CameraModel::new(&camera).ok()?;
    let solver = LostInSpace::new(&setup.stars, &model, f64::INFINITY, 0.0);
    let solved = PIXEL_ORDERS.map(|image| (image, solve_all(&solver, &model, frames, image)));
    let most = solved.iter().map(|(_, frames)| frames.len()).max().filter(|most| *most > 0)?;
    // A mirrored image never fits together with one that is not.
    let possible = || solved.iter().filter(|(_, frames)| 2 * frames.len() > most);

    let with = |image, quaternion, mounting, solved: &[SolvedFrame]| {
        let of_stars = ratio * median_ratio(solved);
        InputMistake {
            image,
            quaternion,
            focal_length_ratio: Some(of_stars).filter(|ratio| (ratio - 1.0).abs() > REPORTED_FOCAL_ERROR),
            mounting,
            fitting: solved.len(),
            tried: frames.len(),
        }
    };
    let [as_stated, ..] = QUATERNION_FORMS;
    if frames.iter().all(|frame| frame.body_from_icrs == Rotation::identity()) {
        // A table without attitudes: the format requires one, and the identity stands in its place.
        let (image, solved) = possible().next()?;
        return Some(with(*image, as_stated, Mounting::AsStated, solved)).filter(InputMistake::is_one);
    }
    for quaternion in QUATERNION_FORMS {
        for (image, solved) in possible() {
            if let Some(mounting) = constant_mounting(solved, quaternion)
                && mounting.angle_to(&setup.camera_from_body).degrees() < MAX_MOUNTING_ERROR_DEG
            {
                let error_deg = mounting.angle_to(&setup.camera_from_body).degrees();
                let mounting = if error_deg > REPORTED_MOUNTING_DEG {
                    Mounting::Other(mounting)
                } else {
                    Mounting::AsStated
                };
                return Some(with(*image, quaternion, mounting, solved)).filter(InputMistake::is_one);
            }
        }
    }
    let (image, solved) = possible().next()?;
    let mounting = constant_mounting(solved, as_stated).filter(|_| solved.len() > 1);
    Some(with(*image, as_stated, mounting.map_or(Mounting::None, Mounting::Other), solved))
}

/// Returns the camera with the focal length with which the stars of the first frames fit, and its ratio to
/// the stated one: the nearest to it.
fn fitting_camera(setup: &Setup, frames: &[UnmatchedFrame]) -> Option<(Camera, f64)> {
    let frames = frames.get(..FOCAL_FRAMES).unwrap_or(frames);
    let steps = (MAX_FOCAL_ERROR / FOCAL_STEP).round() as i32;
    let errors = (0..=steps).flat_map(|step| [step, -step]).skip(1);
    for ratio in errors.map(|step| 1.0 + f64::from(step) * FOCAL_STEP) {
        let mut camera = setup.camera.clone();
        camera.focal_length_mm *= ratio;
        let model = CameraModel::new(&camera).ok()?;
        let solver = LostInSpace::new(&setup.stars, &model, f64::INFINITY, 0.0);
        // An image in any other order is one of these, turned.
        for image in [PixelOrder::AsExpected, PixelOrder::RowsReversed] {
            let solved = solve_all(&solver, &model, frames, image);
            if !solved.is_empty() {
                // The first focal length found fits stars of a part of the image.
                let of_stars = median_ratio(&solved);
                camera.focal_length_mm *= of_stars;
                return Some((camera, ratio * of_stars));
            }
        }
    }
    None
}

/// Returns the frames whose stars are identified.
fn solve_all(
    solver: &LostInSpace,
    model: &CameraModel,
    frames: &[UnmatchedFrame],
    image: PixelOrder,
) -> Vec<SolvedFrame> {
    let mut solved = Vec::new();
    for frame in frames {
        let sources: Vec<(PixelPoint, f64)> =
            frame.sources.iter().map(|(at, flux)| (image.position(*at, model.size_px()), *flux)).collect();
        if let Some(found) = solver.solve(&sources) {
            let positions: Vec<[Vector2<f64>; 2]> = found
                .matched
                .iter()
                .filter_map(|(source, star)| {
                    let (position, _) = sources.get(*source)?;
                    let direction = found.camera_from_icrs.rotate(star.direction.vector());
                    positions(model, *position, &direction)
                })
                .collect();
            solved.push(SolvedFrame {
                camera_from_icrs: found.camera_from_icrs,
                body_from_icrs: frame.body_from_icrs,
                focal_length_ratio: scale(&positions),
            });
        }
    }
    solved
}

/// Returns the measured and the expected position of a star in the image without distortion, px.
fn positions(
    model: &CameraModel,
    position: PixelPoint,
    direction: &Vector3<f64>,
) -> Option<[Vector2<f64>; 2]> {
    let (u, v) = model.to_ideal(position)?;
    let (fx, fy) = model.focal_px();
    let expected = Vector2::new(fx * direction.x / direction.z, fy * direction.y / direction.z);
    Some([Vector2::new(u, v), expected])
}

/// Returns the scale of measured positions u relative to expected ones p about their means, by least squares:
/// Σ (u − ū)·(p − p̄)/Σ |p − p̄|². The attitude has absorbed a shift.
fn scale(positions: &[[Vector2<f64>; 2]]) -> f64 {
    let count = positions.len().max(1) as f64;
    let [mut mean_measured, mut mean_expected] = [Vector2::zeros(); 2];
    for [measured, expected] in positions {
        mean_measured += measured / count;
        mean_expected += expected / count;
    }
    let (mut products, mut squares) = (0.0, 0.0);
    for [measured, expected] in positions {
        let about_mean = expected - mean_expected;
        products += (measured - mean_measured).dot(&about_mean);
        squares += about_mean.norm_squared();
    }
    if squares > 0.0 { products / squares } else { 1.0 }
}

/// Returns the median of the ratios of the focal lengths.
fn median_ratio(solved: &[SolvedFrame]) -> f64 {
    let mut ratios: Vec<f64> = solved.iter().map(|frame| frame.focal_length_ratio).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
}

/// Returns the mounting of the camera if it is the same in all frames with a convention of the quaternion.
fn constant_mounting(
    solved: &[SolvedFrame],
    quaternion: QuaternionForm,
) -> Option<Rotation<CameraFrame, Body>> {
    let mountings: Vec<Rotation<CameraFrame, Body>> = solved
        .iter()
        .map(|frame| frame.camera_from_icrs * quaternion.rotation(&frame.body_from_icrs).inverse())
        .collect();
    let first = *mountings.first()?;
    let is_constant =
        mountings.iter().all(|mounting| mounting.angle_to(&first).degrees() < MOUNTING_SCATTER_DEG);
    is_constant.then_some(first)
}

impl PixelOrder {
    /// Returns the position that a pixel has in the expected order.
    fn position(self, at: PixelPoint, (columns, rows): (usize, usize)) -> PixelPoint {
        let x = (columns as f64 - 1.0) - at.x;
        let y = (rows as f64 - 1.0) - at.y;
        match self {
            Self::AsExpected => at,
            Self::RowsReversed => PixelPoint::new(at.x, y),
            Self::ColumnsReversed => PixelPoint::new(x, at.y),
            Self::Turned => PixelPoint::new(x, y),
        }
    }
}

impl QuaternionForm {
    /// Returns the rotation that the components of a quaternion mean in this convention.
    fn rotation(self, stated: &Rotation<Body, Icrs>) -> Rotation<Body, Icrs> {
        let [a, b, c, d] = stated.wxyz();
        let quaternion = match self.order {
            QuaternionOrder::AsExpected => nalgebra::Quaternion::new(a, b, c, d),
            QuaternionOrder::ScalarLast => nalgebra::Quaternion::new(d, a, b, c),
            QuaternionOrder::MovedBack => nalgebra::Quaternion::new(b, c, d, a),
        };
        let rotation = Rotation::from_unit_quaternion(nalgebra::UnitQuaternion::new_normalize(quaternion));
        if self.is_inverse {
            Rotation::from_unit_quaternion(*rotation.inverse().quaternion())
        } else {
            rotation
        }
    }
}

impl InputMistake {
    /// Returns true if an input is not as stated.
    fn is_one(&self) -> bool {
        let [as_expected, ..] = QUATERNION_FORMS;
        self.image != PixelOrder::AsExpected
            || self.quaternion != as_expected
            || self.focal_length_ratio.is_some()
            || self.mounting != Mounting::AsStated
    }

    /// Returns what is not as stated.
    fn parts(&self) -> Vec<String> {
        let mut parts = Vec::new();
        match self.image {
            PixelOrder::AsExpected => {}
            PixelOrder::RowsReversed => parts.push("the rows of the images are in reverse order".to_owned()),
            PixelOrder::ColumnsReversed => {
                parts.push("the columns of the images are in reverse order".to_owned());
            }
            PixelOrder::Turned => parts.push("the images are turned by 180°".to_owned()),
        }
        match self.quaternion.order {
            QuaternionOrder::AsExpected => {}
            QuaternionOrder::ScalarLast => {
                parts.push("the quaternions of the telemetry are in the order x, y, z, w".to_owned());
            }
            QuaternionOrder::MovedBack => {
                parts.push("the first component of the telemetry's quaternions is their last".to_owned());
            }
        }
        if self.quaternion.is_inverse {
            parts.push("the quaternions of the telemetry are those of the inverse rotation".to_owned());
        }
        if let Some(ratio) = self.focal_length_ratio {
            parts.push(format!("the focal length is {ratio:.4} of that stated"));
        }
        match self.mounting {
            Mounting::AsStated => {}
            Mounting::Other(camera_from_body) => {
                let [phi, theta, psi] = euler_deg(&camera_from_body);
                parts.push(format!(
                    "the mounting of the camera is phi_deg = {phi:.2}, theta_deg = {theta:.2}, \
                     psi_deg = {psi:.2}"
                ));
            }
            Mounting::None => parts.push(
                "the attitudes of the telemetry belong to other frames or to another frame of reference"
                    .to_owned(),
            ),
        }
        parts
    }
}

fn euler_deg(rotation: &Rotation<CameraFrame, Body>) -> [f64; 3] {
    let (phi, theta, psi) = rotation.euler_123();
    [phi, theta, psi].map(|angle: Angle| angle.degrees())
}

impl fmt::Display for InputMistake {
    /// Writes for instance `the stars fit in 8 of 8 frames if the rows of the images are in reverse order`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = self.parts().join(", and ");
        write!(formatter, "the stars fit in {} of {} frames if {parts}", self.fitting, self.tried)
    }
}
