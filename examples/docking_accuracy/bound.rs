//! The Cramér–Rao bound of a frame's pose.
//!
//! The Fisher information is J = Σ ∂I/∂p ∂I/∂pᵀ/σ² over all pixels, with the noise-free image I in DN behind blur and pixel,
//! σ² = (video noise)² + 1/12 for the rounding, and p the six parameters of the pose; the bound is J⁻¹. What moves with the
//! pose are the plate, its marks, the cross with its sides and its post; the station behind stands still. Their brightness is
//! that of the frame's own light and is known, as is the blur, and does not change with the pose; cast shadows are left out.
//! So the bound knows more than any estimator can (levels, blur and what lies behind the plate's rim), and is a little too low.
//! A second bound has no rim: the plate goes on for ever, and marks and cross are all that moves.

use contract::Camera;
use contract::docking::{Lines, Pose};
use nalgebra::{Matrix6, Vector3, Vector6};
use sim::SimError;
use sim::optics::ImageBlur;
use sim::scene::docking::{DockingScene, Lighting};
use sim::truth::approach::target_from_camera;
use sim::vector::{Drawer, RadianceImage};

use crate::frames::{BLUR_PX, NOISE_DN};

/// How far a step moves the image, px: small against the blur, large against the rounding of the image's numbers.
const STEP_PX: f64 = 0.02;

/// Variances that no unbiased estimator is below.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bound {
    /// Of the range, as parts of it, squared.
    pub(crate) range: f64,
    /// Mean of those of d1 and d2, m².
    pub(crate) lateral_m2: f64,
    /// Mean of those of φ1 and φ2, rad².
    pub(crate) angle_rad2: f64,
}

/// What the bound takes information from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Features {
    /// Marks, cross and the rim of the plate.
    All,
    /// Marks and cross.
    WithoutRim,
}

/// How many times larger the plate is made to have no rim in the image.
const ENDLESS: f64 = 1000.0;

/// The bound of a pose in a scene under a light.
pub(crate) fn of(
    camera: &Camera,
    scene: &DockingScene,
    lighting: &Lighting,
    pose: &Pose,
    features: Features,
) -> Result<Bound, SimError> {
    let mut drawing = Drawing {
        drawer: Drawer::new(camera)?,
        blur: ImageBlur::new(BLUR_PX),
        image: RadianceImage::default(),
        pose: *pose,
        scene: match features {
            Features::All => lit(scene, lighting),
            Features::WithoutRim => without_rim(lit(scene, lighting)),
        },
        light: Lighting {
            sun: None,
            floodlight: None,
            fill_radiance: 1.0,
            sky_radiance: lighting.sky_radiance,
        },
    };
    let (focal_px, _) = camera.focal_length_px();
    let d3 = pose.position_m.z;
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
            drawing.expected_dn(&moved)
        });
        let slope = |(after, before): (f32, f32)| (f64::from(after) - f64::from(before)) / (2.0 * step);
        derivatives.push(after.into_iter().zip(before).map(slope).collect::<Vec<f64>>());
    }
    let variance = NOISE_DN * NOISE_DN + 1.0 / 12.0;
    let information = Matrix6::from_fn(|i, j| {
        derivatives[i].iter().zip(&derivatives[j]).map(|(a, b)| a * b).sum::<f64>() / variance
    });
    let covariance = information.try_inverse().ok_or(SimError::Parameter {
        field: "pose",
        value: format!("{pose:?}"),
        expected: "one that the image determines",
    })?;
    let towards = pose.position_m.normalize();
    let range_m2 = (towards.transpose() * covariance.fixed_view::<3, 3>(0, 0) * towards)[0];
    Ok(Bound {
        range: range_m2 / pose.position_m.norm_squared(),
        lateral_m2: 0.5 * (covariance[(0, 0)] + covariance[(1, 1)]),
        angle_rad2: 0.5 * (covariance[(3, 3)] + covariance[(4, 4)]),
    })
}

/// A scene whose facets shine as the light makes them: ρ (fill + E cos θ/π) in the place of their reflectance, without cast
/// shadows. Moved, they keep their brightness.
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

/// The scene with the plate's black face made endless. It is the facet with the marks as holes.
fn without_rim(mut scene: DockingScene) -> DockingScene {
    for facet in scene.parts.iter_mut().filter(|part| part.name == "plate").flat_map(|part| &mut part.facets)
    {
        if !facet.holes.is_empty() {
            facet.outer.iter_mut().for_each(|point| *point *= ENDLESS);
        }
    }
    scene
}

struct Drawing {
    drawer: Drawer,
    blur: ImageBlur,
    image: RadianceImage,
    pose: Pose,
    scene: DockingScene,
    light: Lighting,
}

impl Drawing {
    /// The expected image when the target looks as from a pose that is `step` away, and all else as from the pose itself.
    fn expected_dn(&mut self, step: &Vector6<f64>) -> Vec<f32> {
        let there = Pose {
            position_m: self.pose.position_m + step.fixed_rows::<3>(0),
            phi_rad: self.pose.phi_rad + step.fixed_rows::<3>(3),
        };
        // The same camera coordinates from here as the point has from there: y = d + A A'ᵀ (y' − d').
        let turn = target_from_camera(&self.pose) * target_from_camera(&there).transpose();
        let mut scene = self.scene.clone();
        let first = scene.parts.iter().position(|part| part.name == "plate").unwrap_or(0);
        for facet in scene.parts[first..].iter_mut().flat_map(|part| &mut part.facets) {
            let move_point =
                |y: &mut Vector3<f64>| *y = self.pose.position_m + turn * (*y - there.position_m);
            facet.outer.iter_mut().chain(facet.holes.iter_mut().flatten()).for_each(move_point);
            facet.normal = turn * facet.normal;
        }
        self.drawer.draw(&scene, &self.light, &self.pose, &mut self.image);
        let mut blurred = Vec::new();
        self.blur.blur(&self.image.radiance, self.image.columns, Lines::All, &mut blurred);
        blurred.iter_mut().for_each(|value| *value *= 255.0);
        blurred
    }
}
