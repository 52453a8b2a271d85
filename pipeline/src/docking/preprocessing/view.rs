//! Field as used by the processing steps: grey values at camera positions.

use std::ops::Range;

use contract::docking::Field;
use contract::{Camera, ContractError, PixelPoint};
use imageproc::image::GrayImage;
use nalgebra::Vector2;

use crate::CameraModel;

/// Grey values of a field, 0 to [`View::WHITE`], addressed by camera pixels.
///
/// A field contains every second row of the camera, so its image is compressed vertically: all steps use
/// camera pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    field: &'a Field,
    first_row: f64,
    step: f64,
    scale: f64,
}

impl<'a> View<'a> {
    /// Grey value of the digitiser's full scale.
    pub(crate) const WHITE: f64 = 255.0;

    pub(crate) fn new(field: &'a Field) -> Self {
        Self {
            field,
            first_row: field.lines().camera_row(0) as f64,
            step: field.lines().step() as f64,
            scale: Self::WHITE / f64::from(field.image().full_scale_dn()),
        }
    }

    pub(crate) fn columns(&self) -> usize {
        self.field.image().columns()
    }

    pub(crate) fn rows(&self) -> usize {
        self.field.image().rows()
    }

    /// Returns the number of camera rows from one row of the image to the next.
    pub(crate) fn step(&self) -> f64 {
        self.step
    }

    /// Returns the camera row of the image's row `row`.
    pub(crate) fn camera_row(&self, row: usize) -> f64 {
        self.first_row + self.step * row as f64
    }

    /// Returns the fractional row of the image at the camera's row `y`.
    pub(crate) fn image_row(&self, y: f64) -> f64 {
        (y - self.first_row) / self.step
    }

    /// Returns the grey values of every `stride`-th pixel of an image row, within the given columns. Empty
    /// for columns outside the image.
    pub(crate) fn line(&self, row: usize, columns: Range<usize>, stride: usize) -> impl Iterator<Item = f64> {
        let start = row * self.columns();
        let line = self.field.image().dn().get(start + columns.start..start + columns.end);
        line.unwrap_or_default().iter().step_by(stride).map(|dn| f64::from(*dn) * self.scale)
    }

    /// Returns the grey value of a pixel of the image.
    pub(crate) fn grey_at(&self, column: usize, row: usize) -> f64 {
        f64::from(self.field.image().dn_at(column, row)) * self.scale
    }

    /// Returns the grey value at a position, bilinear between pixels; `None` beyond the centres of the outer
    /// pixels.
    pub(crate) fn sample(&self, point: PixelPoint) -> Option<f64> {
        let (x, row) = (point.x, self.image_row(point.y));
        let (last_x, last_row) = (self.columns() as f64 - 1.0, self.rows() as f64 - 1.0);
        if !(x >= 0.0 && row >= 0.0 && x <= last_x && row <= last_row) {
            return None;
        }
        let (x0, y0) = (x as usize, row as usize);
        let (fx, fy) = (x - x0 as f64, row - y0 as f64);
        let (x1, y1) = ((x0 + 1).min(self.columns() - 1), (y0 + 1).min(self.rows() - 1));
        let upper = self.grey_at(x0, y0) * (1.0 - fx) + self.grey_at(x1, y0) * fx;
        let lower = self.grey_at(x0, y1) * (1.0 - fx) + self.grey_at(x1, y1) * fx;
        Some(upper * (1.0 - fy) + lower * fy)
    }

    /// Returns true if a position is in the image, at least `margin` camera pixels from its border.
    pub(crate) fn contains(&self, point: PixelPoint, margin: f64) -> bool {
        let bottom = self.camera_row(self.rows().saturating_sub(1));
        point.x >= margin
            && point.y >= self.first_row + margin
            && point.x <= self.columns() as f64 - 1.0 - margin
            && point.y <= bottom - margin
    }

    /// Returns the field with square pixels of 2 × 2 camera pixels, in which regions and edges are searched
    /// for.
    pub(crate) fn overview(&self) -> Overview {
        let rows_each = if self.step > 1.5 { 1 } else { 2 };
        let (width, height) = (self.columns() / 2, self.rows() / rows_each);
        let weight = self.scale / (2 * rows_each) as f64;
        let dn = self.field.image().dn();
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let first = rows_each * y * self.columns();
            let upper = &dn[first..first + 2 * width];
            let last = first + (rows_each - 1) * self.columns();
            let lower = &dn[last..last + 2 * width];
            pixels.extend(upper.chunks_exact(2).zip(lower.chunks_exact(2)).map(|(upper, lower)| {
                let sum: u32 = upper.iter().map(|v| u32::from(*v)).sum();
                let below: u32 = lower.iter().map(|v| u32::from(*v)).sum();
                let sum = if rows_each == 1 { sum } else { sum + below };
                (f64::from(sum) * weight + 0.5) as u8
            }));
        }
        let grey = GrayImage::from_raw(width as u32, height as u32, pixels).unwrap_or_default();
        let first_y = if rows_each == 1 { self.first_row } else { 0.5 };
        Overview { grey, first_x: 0.5, first_y }
    }
}

/// Field with square pixels, each [`Overview::PIXEL`] camera pixels wide and high.
#[derive(Debug, Clone)]
pub(crate) struct Overview {
    /// Grey values.
    pub(crate) grey: GrayImage,
    first_x: f64,
    first_y: f64,
}

impl Overview {
    /// Side of an overview pixel, camera pixels.
    pub(crate) const PIXEL: f64 = 2.0;

    /// Returns the part within `half_side` camera pixels of a position, along columns and rows.
    pub(crate) fn around(&self, centre: PixelPoint, half_side: f64) -> Self {
        let span = |middle: f64, first: f64, n: u32| {
            let at = |v: f64| ((v - first) / Self::PIXEL).clamp(0.0, f64::from(n)) as u32;
            (at((middle - half_side).floor()), at((middle + half_side).ceil()))
        };
        let (left, right) = span(centre.x, self.first_x, self.grey.width());
        let (top, bottom) = span(centre.y, self.first_y, self.grey.height());
        let grey = GrayImage::from_fn(right.saturating_sub(left), bottom.saturating_sub(top), |x, y| {
            *self.grey.get_pixel(left + x, top + y)
        });
        let corner = self.to_camera(f64::from(left), f64::from(top));
        Self { grey, first_x: corner.x, first_y: corner.y }
    }

    /// Converts a position in the overview (centre of its first pixel: (0, 0)) to camera pixels.
    pub(crate) fn to_camera(&self, x: f64, y: f64) -> PixelPoint {
        PixelPoint::new(self.first_x + Self::PIXEL * x, self.first_y + Self::PIXEL * y)
    }
}

/// Conversion between the camera's pixels and the ideal image of the paper's formulas: (f x1/x3, f x2/x3),
/// px, relative to the principal point, with f along columns.
#[derive(Debug, Clone)]
pub(crate) struct Lens {
    model: CameraModel,
    focal_px: f64,
    /// Height of a row in columns: 1 where pixels are square.
    row_px: f64,
}

impl Lens {
    pub(crate) fn new(camera: &Camera) -> Result<Self, ContractError> {
        let (focal_px, focal_y_px) = camera.focal_length_px();
        Ok(Self { model: CameraModel::new(camera)?, focal_px, row_px: focal_px / focal_y_px })
    }

    /// Returns the camera's model.
    pub(crate) fn model(&self) -> &CameraModel {
        &self.model
    }

    /// Returns the focal length f, px.
    pub(crate) fn focal_px(&self) -> f64 {
        self.focal_px
    }

    /// Converts a camera position to the ideal image, without distortion; `None` where the lens model has no
    /// inverse.
    pub(crate) fn to_ideal(&self, point: PixelPoint) -> Option<Vector2<f64>> {
        let (u, v) = self.model.to_ideal(point)?;
        Some(Vector2::new(u, v * self.row_px))
    }

    /// Converts an ideal position to camera pixels, with distortion; `None` beyond the fold of the
    /// distortion.
    pub(crate) fn to_camera(&self, ideal: Vector2<f64>) -> Option<PixelPoint> {
        self.model.pixel_from_ideal(ideal.x, ideal.y / self.row_px)
    }
}
