//! One part at a time: outlined, laid over what lies behind it, shaded, lit by the lamp.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Vector3;

use super::coverage::{Coverage, Run, Window};
use super::lamp::{LampGrid, LampOnPlane};
use super::planes::{Plane, PreparedPart};
use super::shadow::Shadows;
use super::view::{Bounds, Outlines, View};
use crate::scene::docking::{Floodlight, Lighting, Part, Sun};

/// What a part is painted on.
pub(super) struct Canvas<'a> {
    pub(super) view: View<'a>,
    pub(super) planes: &'a [Plane],
    pub(super) coverage: &'a mut Coverage,
    pub(super) radiance: &'a mut [f32],
    pub(super) columns: usize,
}

/// A facet in the image.
#[derive(Debug, Clone)]
struct SeenFacet {
    /// Its place in the part.
    facet: usize,
    /// Its polygons among the outlines.
    polygons: Range<usize>,
    bounds: Bounds,
}

/// A plane of the part that shows its front and has facets in the image.
#[derive(Debug, Clone)]
struct SeenPlane {
    /// Its place in the scene.
    plane: usize,
    facets: Range<usize>,
    bounds: Bounds,
}

/// The part being painted, as it is seen.
#[derive(Debug, Clone, Default)]
pub(super) struct Painting {
    outlines: Outlines,
    facets: Vec<SeenFacet>,
    planes: Vec<SeenPlane>,
    shadow: Outlines,
    lamp_grid: LampGrid,
}

impl Painting {
    /// Projects the facets of a part that show their front and reach into the image.
    pub(super) fn outline(&mut self, part: &Part, ready: &PreparedPart, canvas: &Canvas<'_>) {
        self.outlines.clear();
        self.facets.clear();
        self.planes.clear();
        let view = &canvas.view;
        if !view.may_see(&ready.sphere) {
            return;
        }
        for index in ready.planes.clone() {
            let plane = &canvas.planes[index];
            // Not "at most zero": a height that is no number sees nothing either.
            if !(plane.height(&view.position) > 0.0) {
                continue;
            }
            let first = self.facets.len();
            let mut bounds_of_plane = Bounds::EMPTY;
            for facet in &plane.facets {
                let start = self.outlines.len();
                let bounds = self.outlines.push(view, &part.facets[*facet].outer);
                if bounds.window(canvas.coverage.whole()).is_none() {
                    self.outlines.truncate(start);
                    continue;
                }
                for hole in &part.facets[*facet].holes {
                    self.outlines.push(view, hole);
                }
                bounds_of_plane = bounds_of_plane.with(bounds);
                self.facets.push(SeenFacet { facet: *facet, polygons: start..self.outlines.len(), bounds });
            }
            if self.facets.len() > first {
                let facets = first..self.facets.len();
                self.planes.push(SeenPlane { plane: index, facets, bounds: bounds_of_plane });
            }
        }
    }

    /// Lays the part over the image, lit by the Sun and from everywhere, as if nothing cast shadows on it.
    pub(super) fn lay(&self, part: &Part, lighting: &Lighting, canvas: &mut Canvas<'_>) {
        if self.planes.is_empty() {
            return;
        }
        canvas.coverage.open(canvas.coverage.whole());
        for seen in &self.planes {
            let plane = &canvas.planes[seen.plane];
            let light =
                lighting.fill_radiance + lighting.sun.map_or(0.0, |sun| sunlight(&sun, &plane.normal));
            for facet in &self.facets[seen.facets.clone()] {
                let radiance = part.facets[facet.facet].reflectance * light;
                self.add(facet, canvas.coverage, [1.0, radiance as f32]);
            }
        }
        let (columns, image) = (canvas.columns, &mut *canvas.radiance);
        canvas.coverage.sweep(|row, column, run| {
            let start = row * columns + column;
            match run {
                Run::Each(sums) => {
                    for (pixel, [covered, light]) in image[start..start + sums.len()].iter_mut().zip(sums) {
                        *pixel = *pixel * (1.0 - covered).clamp(0.0, 1.0) + light;
                    }
                }
                Run::Same([covered, light], length) => {
                    let left = if covered > 1.0 - Coverage::RESIDUE { 0.0 } else { (1.0 - covered).max(0.0) };
                    for pixel in &mut image[start..start + length] {
                        *pixel = *pixel * left + light;
                    }
                }
            }
        });
    }

    /// Takes the Sun's light away where the part lies in shadow.
    pub(super) fn shade(&mut self, part: &Part, sun: &Sun, shadows: &Shadows, canvas: &mut Canvas<'_>) {
        for index in 0..self.planes.len() {
            let seen = self.planes[index].clone();
            let light = sunlight(sun, &canvas.planes[seen.plane].normal);
            if light <= 0.0 {
                continue;
            }
            let Some(within) = seen.bounds.window(canvas.coverage.whole()) else { continue };
            let Some(window) = self.outline_shadows(shadows, seen.plane, within, canvas) else { continue };
            canvas.coverage.open(window);
            for polygon in 0..self.shadow.len() {
                canvas.coverage.add(self.shadow.polygon(polygon), [1.0, 0.0]);
            }
            for facet in &self.facets[seen.facets] {
                if facet.bounds.window(window).is_some() {
                    let lost = part.facets[facet.facet].reflectance * light;
                    self.add(facet, canvas.coverage, [0.0, lost as f32]);
                }
            }
            let (columns, image) = (canvas.columns, &mut *canvas.radiance);
            canvas.coverage.sweep(|row, column, run| {
                let start = row * columns + column;
                match run {
                    Run::Each(sums) => {
                        for (pixel, [shaded, lost]) in image[start..start + sums.len()].iter_mut().zip(sums) {
                            *pixel -= lost * shaded.clamp(0.0, 1.0);
                        }
                    }
                    Run::Same([shaded, lost], length) => {
                        let lost = lost * shaded.clamp(0.0, 1.0);
                        image[start..start + length].iter_mut().for_each(|pixel| *pixel -= lost);
                    }
                }
            });
        }
    }

    /// Adds the lamp's light where it reaches the part.
    pub(super) fn illuminate(
        &mut self,
        part: &Part,
        lamp: &Floodlight,
        shadows: &Shadows,
        canvas: &mut Canvas<'_>,
    ) {
        for index in 0..self.planes.len() {
            let seen = self.planes[index].clone();
            let plane = &canvas.planes[seen.plane];
            if !(plane.height(&lamp.position_m) > 0.0) {
                continue;
            }
            let Some(window) = seen.bounds.window(canvas.coverage.whole()) else { continue };
            self.outline_shadows(shadows, seen.plane, window, canvas);
            canvas.coverage.open(window);
            for facet in &self.facets[seen.facets] {
                self.add(facet, canvas.coverage, [part.facets[facet.facet].reflectance as f32, 0.0]);
            }
            for polygon in 0..self.shadow.len() {
                canvas.coverage.add(self.shadow.polygon(polygon), [0.0, 1.0]);
            }
            let grid = &mut self.lamp_grid;
            grid.fill(&LampOnPlane::new(lamp, &canvas.view, plane), window);
            let mut open_row = None;
            let (columns, image) = (canvas.columns, &mut *canvas.radiance);
            canvas.coverage.sweep(|row, column, run| {
                if open_row != Some(row) {
                    grid.open_row(window, row);
                    open_row = Some(row);
                }
                let start = row * columns + column;
                match run {
                    Run::Each(sums) => {
                        for (place, [reflected, shaded]) in sums.iter().enumerate() {
                            let light = grid.light(window, column + place);
                            image[start + place] += reflected * (1.0 - shaded.clamp(0.0, 1.0)) * light;
                        }
                    }
                    Run::Same([reflected, shaded], length) => {
                        let share = reflected * (1.0 - shaded.clamp(0.0, 1.0));
                        for place in 0..length {
                            image[start + place] += share * grid.light(window, column + place);
                        }
                    }
                }
            });
        }
    }

    fn add(&self, facet: &SeenFacet, coverage: &mut Coverage, weights: [f32; 2]) {
        for polygon in facet.polygons.clone() {
            coverage.add(self.outlines.polygon(polygon), weights);
        }
    }

    /// Projects the shadows on a plane; the pixels of a window that they may touch.
    fn outline_shadows(
        &mut self,
        shadows: &Shadows,
        plane: usize,
        within: Window,
        canvas: &Canvas<'_>,
    ) -> Option<Window> {
        self.shadow.clear();
        let mut bounds = Bounds::EMPTY;
        for polygon in shadows.on(plane) {
            let start = self.shadow.len();
            let bounds_of_polygon = self.shadow.push(&canvas.view, polygon);
            if bounds_of_polygon.window(within).is_some() {
                bounds = bounds.with(bounds_of_polygon);
            } else {
                self.shadow.truncate(start);
            }
        }
        bounds.window(within)
    }
}

/// E cos θ/π of the Sun on a plane, 0 on its dark side.
fn sunlight(sun: &Sun, normal: &Vector3<f64>) -> f64 {
    sun.irradiance * normal.dot(&sun.towards).max(0.0) / PI
}
