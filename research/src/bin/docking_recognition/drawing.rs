//! Pictures of fields with the recognised features drawn over them.

use std::error::Error;
use std::path::Path;

use contract::PixelPoint;
use contract::docking::{Circle, DockingOutcome, Field, MarkUse};
use image::{Rgb, RgbImage};

/// Writes a field as a picture of the whole camera; every line is repeated for the rows that it represents.
pub(crate) fn write(path: &Path, field: &Field, outcome: &DockingOutcome) -> Result<(), Box<dyn Error>> {
    let (columns, rows, step) = (field.image().columns(), field.camera_rows(), field.lines().step());
    let mut picture = RgbImage::from_fn(columns as u32, rows as u32, |x, y| {
        let row = (y as usize / step).min(field.image().rows() - 1);
        let grey = (255 * u32::from(field.image().dn_at(x as usize, row))
            / u32::from(field.image().full_scale_dn())) as u8;
        Rgb([grey; 3])
    });
    let features = &outcome.features;
    for (circle, colour) in [
        (&features.circle, [0, 255, 0]),
        (&features.station, [255, 128, 0]),
        (&features.docking_unit, [0, 160, 255]),
    ] {
        if let Some(circle) = circle {
            ring(&mut picture, circle, Rgb(colour));
        }
    }
    for mark in &features.marks {
        let colour = match mark.usage {
            MarkUse::Used => [0, 255, 0],
            MarkUse::Rejected => [255, 0, 0],
            MarkUse::Missing => [255, 255, 0],
            MarkUse::OutOfField => continue,
        };
        dot(&mut picture, mark.position, Rgb(colour));
    }
    if let Some(cross) = &features.cross {
        dot(&mut picture, cross.centre, Rgb([255, 0, 255]));
    }
    picture.save(path)?;
    Ok(())
}

fn dot(picture: &mut RgbImage, at: PixelPoint, colour: Rgb<u8>) {
    for offset in -3..=3 {
        put(picture, at.x + f64::from(offset), at.y, colour);
        put(picture, at.x, at.y + f64::from(offset), colour);
    }
}

fn ring(picture: &mut RgbImage, circle: &Circle, colour: Rgb<u8>) {
    for i in 0..720 {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 720.0);
        put(
            picture,
            circle.centre.x + circle.radius_px * cos,
            circle.centre.y + circle.radius_px * sin,
            colour,
        );
    }
}

fn put(picture: &mut RgbImage, x: f64, y: f64, colour: Rgb<u8>) {
    let (x, y) = (x.round(), y.round());
    if x >= 0.0 && y >= 0.0 && x < f64::from(picture.width()) && y < f64::from(picture.height()) {
        picture.put_pixel(x as u32, y as u32, colour);
    }
}
