//! Painting of one part at a time: outline, compositing over the image behind it, shadows, lamp illumination.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Vector3;
use scene::docking::{Floodlight, Lighting, Part, Sun};

use super::body::Body;
use super::coverage::{Coverage, Run, Window};
use super::lamp::{LampGrid, LampOnPlane};
use super::planes::{PreparedPart, PreparedScene};
use super::radiance_cache::RadianceCache;
use super::shadow::Shadows;
use super::view::{Bounds, Outlines, View};

/// Image and buffers that a part is painted on.
pub(super) struct Canvas<'a> {
    pub(super) view: View<'a>,
    pub(super) prepared: &'a PreparedScene,
    pub(super) coverage: &'a mut Coverage,
    pub(super) radiance: &'a mut [f32],
    pub(super) columns: usize,
    /// Image behind the body to which the part belongs, and the coverage of the body so far.
    pub(super) body: &'a mut Body,
    /// True if the part touches a neighbour in the scene's order and so forms one body with it.
    pub(super) in_body: bool,
}

/// A facet projected into the image.
#[derive(Debug, Clone)]
struct VisibleFacet {
    /// Index of the facet in the part.
    facet: usize,
    /// Range of its polygons in the outlines.
    polygons: Range<usize>,
    bounds: Bounds,
}

/// A plane of the part whose front faces the camera and that has facets in the image.
#[derive(Debug, Clone)]
struct VisiblePlane {
    /// Index of the plane in the scene.
    plane: usize,
    facets: Range<usize>,
    bounds: Bounds,
}

/// The part being painted, as the camera sees it.
#[derive(Debug, Clone, Default)]
pub(super) struct Painting {
    outlines: Outlines,
    facets: Vec<VisibleFacet>,
    planes: Vec<VisiblePlane>,
    shadow: Outlines,
    kept: RadianceCache,
    lamp_grid: LampGrid,
}

impl Painting {
    /// Projects the facets of a part that face the camera and reach into the image.
    pub(super) fn outline(&mut self, part: &Part, ready: &PreparedPart, canvas: &Canvas<'_>) {
        self.outlines.clear();
        self.facets.clear();
        self.planes.clear();
        let view = &canvas.view;
        if !view.may_see(&ready.sphere) {
            return;
        }
        for index in ready.planes.clone() {
            let plane = &canvas.prepared.planes[index];
            // In this form of the condition a height that is not a number also counts as not visible.
            let shows_front = plane.surface.height(&view.position) > 0.0;
            if !shows_front {
                continue;
            }
            let first = self.facets.len();
            let mut bounds_of_plane = Bounds::EMPTY;
            for facet in &plane.facets {
                let start = self.outlines.len();
                let bounds = self.outlines.push(view, &part.facets[*facet].outer);
                if bounds.window(canvas.coverage.full_window()).is_none() {
                    self.outlines.truncate(start);
                    continue;
                }
                for hole in &part.facets[*facet].holes {
                    self.outlines.push(view, hole);
                }
                bounds_of_plane = bounds_of_plane.with(bounds);
                self.facets.push(VisibleFacet {
                    facet: *facet,
                    polygons: start..self.outlines.len(),
                    bounds,
                });
            }
            if self.facets.len() > first {
                let facets = first..self.facets.len();
                self.planes.push(VisiblePlane { plane: index, facets, bounds: bounds_of_plane });
            }
        }
    }

    /// Finds the Sun's shadows on a part that shows a single plane, and makes [`Painting::lay`] keep the
    /// radiance there.
    pub(super) fn prepare_shadows(&mut self, sun: &Sun, shadows: &mut Shadows, canvas: &Canvas<'_>) {
        let window = match &self.planes[..] {
            [seen] if sunlight(sun, &canvas.prepared.planes[seen.plane].surface.normal) > 0.0 => {
                let (plane, within) = (seen.plane, seen.bounds.window(canvas.coverage.full_window()));
                within.and_then(|within| self.outline_shadows(shadows, plane, within, canvas))
            }
            _ => None,
        };
        self.kept.open(window, canvas.columns);
    }

    /// Composites the part over the image, lit by the Sun and by the uniform fill, without shadows.
    ///
    /// Here and below, values that rounding makes negative are set to zero, because radiance is never
    /// negative.
    pub(super) fn paint_part(&mut self, part: &Part, lighting: &Lighting, canvas: &mut Canvas<'_>) {
        if self.planes.is_empty() {
            return;
        }
        canvas.coverage.open(canvas.coverage.full_window());
        for seen in &self.planes {
            let plane = &canvas.prepared.planes[seen.plane];
            let light = lighting.fill_radiance
                + lighting.sun.map_or(0.0, |sun| sunlight(&sun, &plane.surface.normal));
            for facet in &self.facets[seen.facets.clone()] {
                let radiance = part.facets[facet.facet].reflectance * light;
                self.add(facet, canvas.coverage, [1.0, radiance as f32]);
            }
        }
        let columns = canvas.columns;
        let image = &mut *canvas.radiance;
        let kept = &mut self.kept;
        if canvas.in_body {
            let body = &mut *canvas.body;
            canvas.coverage.sweep(|row, column, run| {
                kept.store(row, column, &run);
                match run {
                    Run::Each(sums) => body.join(image, row, column, sums.iter().copied()),
                    Run::Same(sums, length) => {
                        body.join(image, row, column, std::iter::repeat_n(sums, length));
                    }
                }
            });
            return;
        }
        canvas.coverage.sweep(|row, column, run| {
            kept.store(row, column, &run);
            let start = row * columns + column;
            match run {
                Run::Each(sums) => {
                    for (pixel, [covered, light]) in image[start..start + sums.len()].iter_mut().zip(sums) {
                        *pixel = (*pixel * (1.0 - covered).clamp(0.0, 1.0) + light).max(0.0);
                    }
                }
                Run::Same([covered, light], length) => {
                    let left = if covered > 1.0 - Coverage::RESIDUE { 0.0 } else { 1.0 - covered };
                    let pixels = &mut image[start..start + length];
                    if left == 0.0 {
                        pixels.fill(light.max(0.0));
                    } else {
                        pixels.iter_mut().for_each(|pixel| *pixel = (*pixel * left + light).max(0.0));
                    }
                }
            }
        });
    }

    /// Subtracts the Sun's contribution where the part lies in shadow; to be called after
    /// [`Painting::prepare_shadows`].
    pub(super) fn shade(
        &mut self,
        part: &Part,
        lighting: &Lighting,
        shadows: &mut Shadows,
        canvas: &mut Canvas<'_>,
    ) {
        let Some(sun) = &lighting.sun else { return };
        if let [seen] = &self.planes[..] {
            let light = sunlight(sun, &canvas.prepared.planes[seen.plane].surface.normal);
            self.shade_plane(light / (lighting.fill_radiance + light), canvas);
            return;
        }
        for index in 0..self.planes.len() {
            let seen = self.planes[index].clone();
            let light = sunlight(sun, &canvas.prepared.planes[seen.plane].surface.normal);
            if light <= 0.0 {
                continue;
            }
            let Some(within) = seen.bounds.window(canvas.coverage.full_window()) else { continue };
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
                            *pixel = (*pixel - lost * shaded.clamp(0.0, 1.0)).max(0.0);
                        }
                    }
                    Run::Same([shaded, lost], length) => {
                        let lost = lost * shaded.clamp(0.0, 1.0);
                        image[start..start + length]
                            .iter_mut()
                            .for_each(|pixel| *pixel = (*pixel - lost).max(0.0));
                    }
                }
            });
        }
    }

    /// Subtracts a fraction of the kept radiance inside the expected shadows.
    fn shade_plane(&self, share: f64, canvas: &mut Canvas<'_>) {
        let Some(window) = self.kept.window() else { return };
        canvas.coverage.open(window);
        for polygon in 0..self.shadow.len() {
            canvas.coverage.add(self.shadow.polygon(polygon), [1.0, 0.0]);
        }
        let (columns, image, kept) = (canvas.columns, &mut *canvas.radiance, &self.kept);
        let share = share as f32;
        canvas.coverage.sweep(|row, column, run| {
            let pixels = image[row * columns + column..].iter_mut().zip(kept.row(row, column));
            match run {
                Run::Each(sums) => {
                    for ((pixel, light), [shaded, _]) in pixels.zip(sums) {
                        *pixel = (*pixel - share * light * shaded.clamp(0.0, 1.0)).max(0.0);
                    }
                }
                Run::Same([shaded, _], length) => {
                    let share = share * shaded.clamp(0.0, 1.0);
                    pixels.take(length).for_each(|(pixel, light)| *pixel = (*pixel - share * light).max(0.0));
                }
            }
        });
    }

    /// Adds the lamp's contribution where it reaches the part.
    pub(super) fn illuminate(
        &mut self,
        part: &Part,
        lamp: &Floodlight,
        shadows: &mut Shadows,
        canvas: &mut Canvas<'_>,
    ) {
        for index in 0..self.planes.len() {
            let seen = self.planes[index].clone();
            let plane = &canvas.prepared.planes[seen.plane];
            let is_lit = plane.surface.height(&lamp.position_m) > 0.0;
            if !is_lit {
                continue;
            }
            let Some(window) = seen.bounds.window(canvas.coverage.full_window()) else { continue };
            self.outline_shadows(shadows, seen.plane, window, canvas);
            canvas.coverage.open(window);
            for facet in &self.facets[seen.facets] {
                self.add(facet, canvas.coverage, [part.facets[facet.facet].reflectance as f32, 0.0]);
            }
            for polygon in 0..self.shadow.len() {
                canvas.coverage.add(self.shadow.polygon(polygon), [0.0, 1.0]);
            }
            let grid = &mut self.lamp_grid;
            grid.fill(&LampOnPlane::new(lamp, &canvas.view, &plane.surface), window);
            let (columns, image) = (canvas.columns, &mut *canvas.radiance);
            let mut row_of_lights = None;
            canvas.coverage.sweep(|row, column, run| {
                if row_of_lights != Some(row) {
                    row_of_lights = Some(row);
                    grid.compute_row(window, row);
                }
                let lights = &grid.row_radiances()[column - window.left..];
                let pixels = image[row * columns + column..].iter_mut().zip(lights);
                match run {
                    Run::Each(sums) => {
                        for ((pixel, light), [reflected, shaded]) in pixels.zip(sums) {
                            *pixel += reflected.max(0.0) * (1.0 - shaded.clamp(0.0, 1.0)) * light;
                        }
                    }
                    Run::Same([reflected, shaded], length) => {
                        let share = reflected * (1.0 - shaded.clamp(0.0, 1.0));
                        pixels.take(length).for_each(|(pixel, light)| *pixel += share * light);
                    }
                }
            });
        }
    }

    fn add(&self, facet: &VisibleFacet, coverage: &mut Coverage, weights: [f32; 2]) {
        for polygon in facet.polygons.clone() {
            coverage.add(self.outlines.polygon(polygon), weights);
        }
    }

    /// Projects the shadows on a plane, and returns the pixels of a window that they may touch.
    fn outline_shadows(
        &mut self,
        shadows: &mut Shadows,
        plane: usize,
        within: Window,
        canvas: &Canvas<'_>,
    ) -> Option<Window> {
        let outlines = &mut self.shadow;
        outlines.clear();
        let mut bounds = Bounds::EMPTY;
        shadows.find(&canvas.prepared.planes[plane], canvas.prepared, &canvas.view, within, |polygon| {
            let start = outlines.len();
            let bounds_of_polygon = outlines.push(&canvas.view, polygon);
            if bounds_of_polygon.window(within).is_some() {
                bounds = bounds.with(bounds_of_polygon);
            } else {
                outlines.truncate(start);
            }
        });
        bounds.window(within)
    }
}

/// Returns E cos θ/π of the Sun on a plane; 0 if the plane faces away from the Sun.
fn sunlight(sun: &Sun, normal: &Vector3<f64>) -> f64 {
    sun.irradiance * normal.dot(&sun.towards).max(0.0) / PI
}
