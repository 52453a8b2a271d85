//! Cramér–Rao bound of the pose of one frame.
//!
//! The Fisher information is J = Σ ∂I/∂p ∂I/∂pᵀ/σ² over all pixels, with the noise-free image I in DN behind
//! blur and pixel, σ² = (video noise)² + 1/12 for the rounding, and the unknown parameters p. The bound is
//! the block of J⁻¹ for the six parameters of the pose. The plate, its marks, the cross with its sides and
//! its post move with the pose; the station behind is stationary. Cast shadows are left out. There are three
//! bounds, each with fewer known quantities:
//! 1. plate, marks and cross, with known brightness and blur: too low for any estimator, which must estimate
//!    these as well;
//! 2. like 1, without a rim (the plate is infinite): only marks and cross move;
//! 3. as posed, the reference: marks and cross; besides the pose, the free parameters are the brightness of
//!    each mark, of the cross's face and of its side faces by their direction, the plate's brightness with a
//!    slope along columns and rows, and the blur.

use contract::Camera;
use contract::docking::{Lines, Pose};
use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};
use sim::SimError;
use sim::optics::ImageBlur;
use sim::scene::docking::{DockingScene, Facet, Lighting};
use sim::truth::approach::target_from_camera;
use sim::vector::{Drawer, RadianceImage};

use boresight_research::docking_random::still::{BLUR_PX, NOISE_DN};

/// Image displacement of a derivative step, px: small against the blur, large against the rounding of the
/// image's numbers.
const STEP_PX: f64 = 0.02;

/// Lower bounds of the variances of unbiased estimators.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bound {
    /// Relative variance of the range: variance over the squared range.
    pub(crate) range: f64,
    /// Mean of the variances of d1 and d2, m².
    pub(crate) lateral_m2: f64,
    /// Mean of the variances of φ1 and φ2, rad².
    pub(crate) angle_rad2: f64,
}

/// Enlargement factor of the plate that removes its rim from the image.
const ENDLESS: f64 = 1000.0;

/// Step of the blur for its derivative, px.
const BLUR_STEP_PX: f64 = 0.01;

/// Returns the three bounds of a pose in a scene under given lighting, in ascending order.
pub(crate) fn bounds_of_pose(
    camera: &Camera,
    scene: &DockingScene,
    lighting: &Lighting,
    pose: &Pose,
) -> Result<[Bound; 3], SimError> {
    let shining = lit(scene, lighting);
    let target_alone = without_rim(shining.clone());
    let window = Window::around(camera, scene, pose)?;
    let mut drawing = Drawing {
        drawer: Drawer::new(camera)?,
        image: RadianceImage::default(),
        pose: *pose,
        window,
        light: Lighting { sun: None, floodlight: None, fill_radiance: 1.0, sky_radiance: 0.0 },
    };
    let with_rim = drawing.by_pose(&shining, camera);
    let mut columns = drawing.by_pose(&target_alone, camera);
    let known = [covariance(pose, &with_rim)?, covariance(pose, &columns)?];
    columns.extend(drawing.by_levels(&target_alone));
    columns.push(drawing.by_blur(&target_alone));
    let posed = covariance(pose, &columns)?;
    Ok([known[0], known[1], posed].map(|covariance| Bound::from_covariance(pose, &covariance)))
}

impl Bound {
    fn from_covariance(pose: &Pose, covariance: &Matrix6<f64>) -> Self {
        let towards = pose.position_m.normalize();
        let range_m2 = (towards.transpose() * covariance.fixed_view::<3, 3>(0, 0) * towards)[0];
        Self {
            range: range_m2 / pose.position_m.norm_squared(),
            lateral_m2: 0.5 * (covariance[(0, 0)] + covariance[(1, 1)]),
            angle_rad2: 0.5 * (covariance[(3, 3)] + covariance[(4, 4)]),
        }
    }
}

/// Computes the pose's block of the inverse information from derivatives of the image, the first six with
/// respect to the pose.
fn covariance(pose: &Pose, derivatives: &[Vec<f64>]) -> Result<Matrix6<f64>, SimError> {
    let variance = NOISE_DN * NOISE_DN + 1.0 / 12.0;
    // A quantity without effect on any pixel (a side face that is turned away) is not a parameter.
    let shown: Vec<&Vec<f64>> = derivatives.iter().filter(|d| d.iter().any(|v| v.abs() > 1e-6)).collect();
    let mut information = DMatrix::zeros(shown.len(), shown.len());
    for i in 0..shown.len() {
        for j in i..shown.len() {
            let sum = shown[i].iter().zip(shown[j]).map(|(a, b)| a * b).sum::<f64>() / variance;
            information[(i, j)] = sum;
            information[(j, i)] = sum;
        }
    }
    // Parameters are scaled to units of their σ: metres, radians and DN differ widely in magnitude.
    let scale: Vec<f64> = (0..shown.len()).map(|i| 1.0 / information[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(shown.len(), shown.len(), |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled.try_inverse().filter(|_| shown.len() >= 6).ok_or(contract::OutOfRange::new(
        "pose",
        format!("{pose:?}"),
        "one that the image determines",
    ))?;
    Ok(Matrix6::from_fn(|i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

/// Returns a scene with reflectances replaced by the radiance under the lighting: ρ (fill + E cos θ/π),
/// without cast shadows. Facets keep this brightness when they move.
fn lit(scene: &DockingScene, lighting: &Lighting) -> DockingScene {
    let mut scene = scene.clone();
    for facet in scene.parts.iter_mut().flat_map(|part| &mut part.facets) {
        let sun = lighting.sun.map_or(0.0, |sun| {
            sun.irradiance * facet.normal.dot(&sun.towards).max(0.0) / std::f64::consts::PI
        });
        facet.reflectance *= lighting.fill_radiance + sun;
    }
    scene
}

/// Returns the target without the station, with the plate's black face made infinite. This face is the facet
/// that has the marks as holes.
fn without_rim(mut scene: DockingScene) -> DockingScene {
    scene.parts.drain(..first_of_target(&scene));
    for facet in scene.parts.iter_mut().filter(|part| part.name == "plate").flat_map(|part| &mut part.facets)
    {
        if !facet.holes.is_empty() {
            facet.outer.iter_mut().for_each(|point| *point *= ENDLESS);
        }
    }
    scene
}

/// Index of the first part of the target: the plate and the parts on it are the last parts of the scene.
fn first_of_target(scene: &DockingScene) -> usize {
    scene.parts.iter().position(|part| part.name == "plate").unwrap_or(0)
}

/// Part of the image that the target may affect: columns and rows, ends excluded.
#[derive(Debug, Clone, Copy)]
struct Window {
    left: usize,
    right: usize,
    top: usize,
    bottom: usize,
}

impl Window {
    /// Window around the whole target, with a margin for the blur.
    fn around(camera: &Camera, scene: &DockingScene, pose: &Pose) -> Result<Self, SimError> {
        let (fx, fy) = camera.focal_length_px();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let turn = target_from_camera(pose).transpose();
        let facets = scene.parts[first_of_target(scene)..].iter().flat_map(|part| &part.facets);
        for point in facets.flat_map(|facet| &facet.outer) {
            let x = turn * (point - pose.position_m);
            let at = [camera.principal_x_px + fx * x.x / x.z, camera.principal_y_px + fy * x.y / x.z];
            for axis in 0..2 {
                low[axis] = f64::min(low[axis], at[axis]);
                high[axis] = f64::max(high[axis], at[axis]);
            }
        }
        let room = 6.0;
        let begin = |v: f64, n: usize| ((v - room).max(0.0) as usize).min(n);
        let end = |v: f64, n: usize| ((v + room).max(0.0) as usize).min(n);
        Ok(Self {
            left: begin(low[0], camera.columns),
            right: end(high[0], camera.columns),
            top: begin(low[1], camera.rows),
            bottom: end(high[1], camera.rows),
        })
    }
}

struct Drawing {
    drawer: Drawer,
    image: RadianceImage,
    pose: Pose,
    window: Window,
    light: Lighting,
}

impl Drawing {
    /// Derivatives of the image with respect to the six parameters of the pose.
    fn by_pose(&mut self, scene: &DockingScene, camera: &Camera) -> Vec<Vec<f64>> {
        let (focal_px, _) = camera.focal_length_px();
        let d3 = self.pose.position_m.z;
        let lateral = STEP_PX * d3 / focal_px;
        let range = STEP_PX * d3 * d3 / (focal_px * 0.25);
        let angle = STEP_PX / focal_px;
        let roll = STEP_PX * d3 / (focal_px * 0.25);
        let steps = [lateral, lateral, range, angle, angle, roll];
        let mut derivatives = Vec::with_capacity(6);
        for (i, step) in steps.into_iter().enumerate() {
            let [before, after] = [-step, step].map(|step| {
                let mut moved = Vector6::zeros();
                moved[i] = step;
                let moved = self.seen_from(scene, &moved);
                self.expected_dn(&moved, BLUR_PX)
            });
            derivatives.push(slope(&before, &after, 2.0 * step));
        }
        derivatives
    }

    /// Derivatives with respect to the brightness of each mark, of the cross's face, of its sides by their
    /// direction, of the post, and to the plate's brightness and its slopes.
    fn by_levels(&mut self, scene: &DockingScene) -> Vec<Vec<f64>> {
        let mut groups: Vec<(String, Vec<i64>)> = Vec::new();
        let group_of = |part: &str, index: usize, facet: &Facet| {
            let key: Vec<i64> = match part {
                "plate" => vec![index as i64],
                "post" => Vec::new(),
                _ => facet.normal.iter().map(|n| (100.0 * n).round() as i64).collect(),
            };
            (part.to_owned(), key)
        };
        for part in &scene.parts {
            for (index, facet) in part.facets.iter().enumerate() {
                let group = group_of(&part.name, index, facet);
                if !groups.contains(&group) {
                    groups.push(group);
                }
            }
        }
        let mut derivatives = Vec::new();
        for group in groups {
            let mut alone = scene.clone();
            let mut is_endless = false;
            for part in &mut alone.parts {
                for (index, facet) in part.facets.iter_mut().enumerate() {
                    let is_shining = group_of(&part.name, index, facet) == group;
                    facet.reflectance = if is_shining { 1.0 } else { 0.0 };
                    is_endless |= is_shining && !facet.holes.is_empty();
                }
            }
            let level = self.expected_dn(&alone, BLUR_PX);
            if is_endless {
                let columns = self.window.right - self.window.left;
                let by = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
                    level.iter().enumerate().map(|(i, v)| f64::from(*v) * of(i)).collect()
                };
                derivatives.push(by(&|i| (i % columns) as f64 / columns as f64 - 0.5));
                derivatives.push(by(&|i| (i / columns) as f64 / columns as f64 - 0.5));
            }
            derivatives.push(level.into_iter().map(f64::from).collect());
        }
        derivatives
    }

    fn by_blur(&mut self, scene: &DockingScene) -> Vec<f64> {
        let [before, after] =
            [-BLUR_STEP_PX, BLUR_STEP_PX].map(|step| self.expected_dn(scene, BLUR_PX + step));
        slope(&before, &after, 2.0 * BLUR_STEP_PX)
    }

    /// Scene in which the target appears as from a pose that is `step` away, and everything else as from the
    /// current pose.
    fn seen_from(&self, scene: &DockingScene, step: &Vector6<f64>) -> DockingScene {
        let there = Pose {
            position_m: self.pose.position_m + step.fixed_rows::<3>(0),
            phi_rad: self.pose.phi_rad + step.fixed_rows::<3>(3),
        };
        // The point receives the camera coordinates, seen from here, that it had from there: y = d + A A'ᵀ
        // (y' − d').
        let turn = target_from_camera(&self.pose) * target_from_camera(&there).transpose();
        let mut scene = scene.clone();
        let first = first_of_target(&scene);
        for facet in scene.parts[first..].iter_mut().flat_map(|part| &mut part.facets) {
            let move_point =
                |y: &mut Vector3<f64>| *y = self.pose.position_m + turn * (*y - there.position_m);
            facet.outer.iter_mut().chain(facet.holes.iter_mut().flatten()).for_each(move_point);
            facet.normal = turn * facet.normal;
        }
        scene
    }

    /// Expected image in the window.
    fn expected_dn(&mut self, scene: &DockingScene, blur_px: f64) -> Vec<f32> {
        self.drawer.draw(scene, &self.light, &self.pose, &mut self.image);
        let Window { left, right, top, bottom } = self.window;
        let rows = self.image.radiance.chunks(self.image.columns).take(bottom).skip(top);
        let cut: Vec<f32> = rows.flat_map(|row| &row[left..right]).copied().collect();
        let mut blurred = Vec::new();
        ImageBlur::new(blur_px).blur(&cut, right - left, Lines::All, &mut blurred);
        blurred.iter_mut().for_each(|value| *value *= 255.0);
        blurred
    }
}

fn slope(before: &[f32], after: &[f32], step: f64) -> Vec<f64> {
    after.iter().zip(before).map(|(a, b)| (f64::from(*a) - f64::from(*b)) / step).collect()
}
