//! Parts of the target that a camera sees and that the Sun illuminates, by exact projections and rays.

use std::f64::consts::PI;

use contract::docking::{Pose, TargetModel};
use contract::{Camera, Direction, PixelPoint};
use nalgebra::Vector3;
use optics::Projection;
use scene::docking::{DockingScene, Floodlight, Lighting, Sun};
use sensor::television::SunImage;
use truth::SimError;
use truth::approach::target_from_camera;

use super::glint::{GlintConfig, GlintImage};
use super::occlusion::{NearbyOccluders, Occluders, Region};

/// Angular radius of the Sun at 1 au, rad (959.63″, Auwers 1891, as in the Astronomical Almanac).
const SUN_RADIUS_RAD: f64 = 959.63 / 3600.0 * PI / 180.0;
/// Number of projected points on the rim of a circle.
const RIM_POINTS: u32 = 32;
/// Number of points along each side of a mark at which its lighting is evaluated.
const MARK_SAMPLES: u32 = 5;
/// Number of points across the Sun's disk that are tested for occlusion.
const SUN_SAMPLES: i32 = 7;

/// Camera with its exact projection.
#[derive(Debug, Clone)]
pub(super) struct Eye {
    projection: Projection,
    focal_px: f64,
    columns: f64,
    rows: f64,
    principal: PixelPoint,
}

impl Eye {
    pub(super) fn new(camera: &Camera) -> Result<Self, SimError> {
        Ok(Self {
            projection: Projection::new(camera)?,
            focal_px: camera.focal_length_px().0,
            columns: camera.columns as f64,
            rows: camera.rows as f64,
            principal: PixelPoint::new(camera.principal_x_px, camera.principal_y_px),
        })
    }

    /// Pixel position of a direction given in the target frame.
    fn image_of_direction(&self, pose: &Pose, direction: &Vector3<f64>) -> Option<PixelPoint> {
        let seen = target_from_camera(pose).transpose() * direction;
        self.projection.project(&Direction::from_vector(seen).ok()?)
    }

    /// Pixel position of a point given in the target frame.
    pub(super) fn image_of(&self, pose: &Pose, point_m: &Vector3<f64>) -> Option<PixelPoint> {
        self.image_of_direction(pose, &(point_m - pose.position_m))
    }

    /// Images of the glints that shine and whose centres are in the picture.
    pub(super) fn glints(&self, glints: &[GlintConfig], sun: &Sun, pose: &Pose) -> Vec<GlintImage> {
        let of = |(index, glint): (usize, &GlintConfig)| {
            let centre = self.image_of(pose, &Vector3::from(glint.position_m));
            let light = glint.intensity_at(sun, &pose.position_m) * self.focal_px * self.focal_px;
            let centre = centre.filter(|_| light > 0.0 && self.is_in_field(centre, 0.0))?;
            Some(GlintImage { index, centre, light })
        };
        glints.iter().enumerate().filter_map(of).collect()
    }

    fn is_in_field(&self, point: Option<PixelPoint>, margin_px: f64) -> bool {
        point.is_some_and(|p| {
            (-0.5 - margin_px..=self.columns - 0.5 + margin_px).contains(&p.x)
                && (-0.5 - margin_px..=self.rows - 0.5 + margin_px).contains(&p.y)
        })
    }

    fn are_all_in_field(&self, pose: &Pose, points: &[Vector3<f64>]) -> bool {
        points.iter().all(|point| self.is_in_field(self.image_of(pose, point), 0.0))
    }
}

/// Points of the target, and the facets that block light.
#[derive(Debug, Clone)]
pub(super) struct TargetGeometry {
    mark_circle_radius_m: f64,
    cross_centre: Vector3<f64>,
    marks: Vec<[Vector3<f64>; 4]>,
    cross_ends: Vec<Vector3<f64>>,
    plate_rim: Vec<Vector3<f64>>,
    plate_points_m: Vec<Vector3<f64>>,
    /// Region around the marks and the plate.
    region: Region,
    shading: Occluders,
    hiding: Occluders,
    /// Facets that face the open side, and their largest extent along y3, m.
    fronts: Occluders,
    front_m: f64,
}

impl TargetGeometry {
    pub(super) fn new(model: &TargetModel, scene: &DockingScene) -> Self {
        let visible = || scene.parts.iter().filter(|part| part.visible);
        let cross = &model.cross;
        let (length, half, height) = (cross.half_length_m, 0.5 * cross.width_m, cross.height_m);
        let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let cross_ends = signs
            .iter()
            .flat_map(|(s, t)| [[s * length, t * half], [s * half, t * length]])
            .map(|[y1, y2]| Vector3::new(y1, y2, height))
            .collect();
        let radius = model.plate_radius_m;
        let marks: Vec<[Vector3<f64>; 4]> =
            model.marks.iter().map(|mark| mark.map(|[y1, y2]| Vector3::new(y1, y2, 0.0))).collect();
        let farthest = marks.iter().flatten().map(|corner| corner.norm()).fold(radius, f64::max);
        // Rings whose numbers of points are proportional to their circumferences, so that each point
        // represents the same area; 96 in all.
        let rings =
            [(0.25, 10), (0.5, 20), (0.75, 30), (0.95, 36)].map(|(share, n)| circle(share * radius, n));
        Self {
            mark_circle_radius_m: model.mark_circle_radius_m,
            cross_centre: Vector3::new(0.0, 0.0, height),
            marks,
            cross_ends,
            plate_rim: circle(radius, RIM_POINTS),
            plate_points_m: rings.into_iter().flatten().collect(),
            region: Region { centre: Vector3::zeros(), radius_m: farthest },
            // Facets in or behind the plate's plane cannot shade the plate.
            shading: Occluders::new(scene.parts.iter().filter(|part| part.casts_shadow), |facet| {
                facet.outer.iter().any(|corner| corner.z > 1e-6)
            }),
            hiding: Occluders::new(visible(), |_| true),
            fronts: Occluders::new(visible(), |facet| facet.normal.z > 0.0),
            front_m: visible()
                .flat_map(|part| part.facets.iter().flat_map(|facet| &facet.outer))
                .map(|corner| corner.z)
                .fold(0.0, f64::max),
        }
    }

    /// Returns true if a camera at a position in the target frame is in front of all drawn parts. A front
    /// facet between the camera and the open side belongs to a body that the camera is in or behind.
    pub(super) fn is_unobstructed(&self, plate_point_m: &Vector3<f64>) -> bool {
        let (camera, ahead) = (Region { centre: *plate_point_m, radius_m: 0.0 }, Vector3::z());
        plate_point_m.z > self.front_m
            || !self.fronts.along_direction(&camera, &ahead).hide(plate_point_m, &ahead)
    }

    /// Images of the centre of the cross and of the centre of the disk, and f r/x3.
    pub(super) fn centres(
        &self,
        eye: &Eye,
        pose: &Pose,
    ) -> (Option<PixelPoint>, Option<PixelPoint>, Option<f64>) {
        let depth_m = -pose.position_m.dot(&target_from_camera(pose).column(2));
        let radius_px = (depth_m > 0.0).then(|| eye.focal_px * self.mark_circle_radius_m / depth_m);
        (eye.image_of(pose, &self.cross_centre), eye.image_of(pose, &Vector3::zeros()), radius_px)
    }

    /// Bit i is set if mark i is wholly in the picture.
    pub(super) fn marks_in_field(&self, eye: &Eye, pose: &Pose) -> u64 {
        self.bits(|mark| eye.are_all_in_field(pose, mark))
    }

    pub(super) fn cross_in_field(&self, eye: &Eye, pose: &Pose) -> bool {
        eye.are_all_in_field(pose, &self.cross_ends)
    }

    /// Returns true if plate, marks and cross are in the picture.
    pub(super) fn target_in_field(&self, eye: &Eye, pose: &Pose) -> bool {
        self.cross_in_field(eye, pose)
            && eye.are_all_in_field(pose, &self.plate_rim)
            && self.marks.iter().all(|mark| eye.are_all_in_field(pose, mark))
    }

    /// Bit i is set if part of mark i is shadowed from a source that shines on the target's side.
    pub(super) fn marks_shadowed(&self, lighting: &Lighting) -> u64 {
        let light = self.plate_lighting(lighting);
        self.bits(|mark| sample_points(mark).any(|plate_point_m| light.is_partly_shadowed(&plate_point_m)))
    }

    /// Bit i is set if neither the Sun nor the lamp shines on any part of mark i.
    pub(super) fn marks_dark(&self, lighting: &Lighting) -> u64 {
        let light = self.plate_lighting(lighting);
        self.bits(|mark| !sample_points(mark).any(|plate_point_m| light.is_lit(&plate_point_m)))
    }

    /// Bit i is set if an object between the camera and mark i hides part of the mark.
    pub(super) fn marks_hidden(&self, pose: &Pose) -> u64 {
        let hiding = self.hiding.between_region_and_point(&self.region, &pose.position_m);
        self.bits(|mark| {
            sample_points(mark).any(|plate_point_m| hiding.separate(&plate_point_m, &pose.position_m))
        })
    }

    /// Returns true if an object lies between the camera and a point of the target frame, m.
    pub(super) fn is_hidden(&self, pose: &Pose, point_m: &Vector3<f64>) -> bool {
        let point = Region { centre: *point_m, radius_m: 0.0 };
        self.hiding.between_region_and_point(&point, &pose.position_m).separate(point_m, &pose.position_m)
    }

    /// Fraction of the plate illuminated by the Sun or the lamp.
    pub(super) fn plate_lit(&self, lighting: &Lighting) -> f64 {
        let light = self.plate_lighting(lighting);
        let lit = self.plate_points_m.iter().filter(|plate_point_m| light.is_lit(plate_point_m)).count();
        lit as f64 / self.plate_points_m.len().max(1) as f64
    }

    /// Light sources on the plate's front, with the facets that may block them.
    fn plate_lighting(&self, lighting: &Lighting) -> PlateLighting<'_> {
        let sun = lighting.sun.map(|sun| sun.towards).filter(|towards| towards.z > 0.0);
        let lamp = lighting.floodlight.filter(|lamp| lamp.position_m.z > 0.0 && lamp.intensity > 0.0);
        PlateLighting {
            sun: sun.map(|towards| (towards, self.shading.along_direction(&self.region, &towards))),
            lamp: lamp
                .map(|lamp| (lamp, self.shading.between_region_and_point(&self.region, &lamp.position_m))),
        }
    }

    fn bits(&self, holds: impl Fn(&[Vector3<f64>; 4]) -> bool) -> u64 {
        self.marks.iter().enumerate().fold(0, |bits, (i, mark)| bits | u64::from(holds(mark)) << i)
    }

    /// Image of the Sun if part of its disk is in the picture and not hidden.
    pub(super) fn sun_image(&self, eye: &Eye, pose: &Pose, sun: &Vector3<f64>) -> Option<SunImage> {
        let centre = eye.image_of_direction(pose, sun)?;
        let radius_px = SUN_RADIUS_RAD * eye.focal_px;
        if !eye.is_in_field(Some(centre), radius_px) {
            return None;
        }
        let aside = sun.cross(&if sun.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() }).normalize();
        let above = sun.cross(&aside);
        let camera = Region { centre: pose.position_m, radius_m: 0.0 };
        let (mut samples, mut seen) = (0_u32, 0_u32);
        let middle = SUN_SAMPLES / 2;
        for (i, j) in (0..SUN_SAMPLES).flat_map(|i| (0..SUN_SAMPLES).map(move |j| (i - middle, j - middle))) {
            let (u, v) = (f64::from(i) / f64::from(middle), f64::from(j) / f64::from(middle));
            if u * u + v * v <= 1.0 {
                samples += 1;
                let towards = (sun + (aside * u + above * v) * SUN_RADIUS_RAD).normalize();
                let hiding = self.hiding.along_direction(&camera, &towards);
                seen += u32::from(!hiding.hide(&pose.position_m, &towards));
            }
        }
        let ghost = PixelPoint::new(2.0 * eye.principal.x - centre.x, 2.0 * eye.principal.y - centre.y);
        let visible = f64::from(seen) / f64::from(samples);
        (seen > 0).then_some(SunImage { centre, ghost, radius_px, focal_px: eye.focal_px, visible })
    }
}

/// Sun and lamp if they shine on the plate's front, each with the facets that may block it.
struct PlateLighting<'a> {
    sun: Option<(Vector3<f64>, NearbyOccluders<'a>)>,
    lamp: Option<(Floodlight, NearbyOccluders<'a>)>,
}

impl PlateLighting<'_> {
    /// Returns true if one of the sources shines on a point.
    fn is_lit(&self, plate_point_m: &Vector3<f64>) -> bool {
        self.sunlit(plate_point_m) == Some(true) || self.lamplit(plate_point_m) == Some(true)
    }

    /// Returns true if one of the sources does not shine on a point.
    fn is_partly_shadowed(&self, plate_point_m: &Vector3<f64>) -> bool {
        self.sunlit(plate_point_m) == Some(false) || self.lamplit(plate_point_m) == Some(false)
    }

    fn sunlit(&self, plate_point_m: &Vector3<f64>) -> Option<bool> {
        self.sun.as_ref().map(|(towards, shading)| !shading.hide(plate_point_m, towards))
    }

    fn lamplit(&self, plate_point_m: &Vector3<f64>) -> Option<bool> {
        self.lamp.as_ref().map(|(lamp, shading)| {
            let from_lamp = plate_point_m - lamp.position_m;
            let in_beam = from_lamp.dot(&lamp.axis) > from_lamp.norm() * libm::cos(lamp.outer_half_angle_rad);
            in_beam && !shading.separate(plate_point_m, &lamp.position_m)
        })
    }
}

fn circle(radius_m: f64, points: u32) -> Vec<Vector3<f64>> {
    (0..points)
        .map(|i| {
            let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i) / f64::from(points));
            Vector3::new(radius_m * cos, radius_m * sin, 0.0)
        })
        .collect()
}

/// Points spread over a mark, including its border.
fn sample_points(mark: &[Vector3<f64>; 4]) -> impl Iterator<Item = Vector3<f64>> {
    let [a, b, c, d] = *mark;
    let share = |i: u32| f64::from(i) / f64::from(MARK_SAMPLES - 1);
    (0..MARK_SAMPLES * MARK_SAMPLES).map(move |i| {
        let (u, v) = (share(i % MARK_SAMPLES), share(i / MARK_SAMPLES));
        (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v
    })
}
