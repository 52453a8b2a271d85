//! Masks: pixels whose centres a facet covers, as the camera sees it through its distortion.

use contract::docking::Lines;
use contract::{Camera, PixelPoint};
use nalgebra::Vector3;
use truth::SimError;

use super::row_spans::{RowSpans, Span};
use super::view::{Lens, Outlines, View};

/// Paints the masks of facets in the rows of an image, up to one picture's size beyond each border.
///
/// A pixel belongs to a facet if its centre lies inside the image of the facet's outline. Row k of the image
/// of a field is the camera row that [`Lines::camera_row`] gives: a field samples the camera's rows, it does
/// not average them.
#[derive(Debug, Clone)]
pub struct MaskPainter {
    lens: Lens,
    lines: Lines,
    columns: i32,
    rows: i32,
    outlines: Outlines,
    crossings: Vec<Crossing>,
    spans: Vec<Span>,
}

/// Intersection of an outline with the centre line of a row; x in px from the corner of the first pixel.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    row: i32,
    x: f64,
}

impl MaskPainter {
    /// Creates a painter for the images that hold the given lines of a camera.
    ///
    /// # Errors
    /// [`SimError`] if the camera's data are invalid.
    pub fn new(camera: &Camera, lines: Lines) -> Result<Self, SimError> {
        Ok(Self {
            lens: Lens::beyond_picture(camera)?,
            lines,
            columns: camera.columns as i32,
            rows: lines.rows(camera.rows) as i32,
            outlines: Outlines::default(),
            crossings: Vec::new(),
            spans: Vec::new(),
        })
    }

    /// Adds a flat facet to the mask: its outer boundary and its holes, camera frame, m.
    pub fn add(&mut self, outer: &[Vector3<f64>], holes: &[Vec<Vector3<f64>>]) {
        let view = View::in_camera_frame(&self.lens);
        self.outlines.clear();
        self.outlines.push(&view, outer);
        for hole in holes {
            self.outlines.push(&view, hole);
        }
        self.crossings.clear();
        for index in 0..self.outlines.len() {
            let polygon = self.outlines.polygon(index);
            let Some(mut from) = polygon.last() else { continue };
            for to in polygon {
                add_crossings(*from, *to, self.lines, self.rows, &mut self.crossings);
                from = to;
            }
        }
        // A hole adds two crossings to a row: between them, the facet is open.
        self.crossings.sort_unstable_by(|a, b| a.row.cmp(&b.row).then(a.x.total_cmp(&b.x)));
        for pair in self.crossings.chunks_exact(2) {
            let [start, end] = [pair[0].x, pair[1].x].map(|x| first_centre_from(x, self.columns));
            self.spans.push(Span { row: pair[0].row, start, end });
        }
    }

    /// Returns the pixels of all facets since the last mask, and begins the next mask.
    pub fn finish(&mut self) -> RowSpans {
        RowSpans::from_spans(std::mem::take(&mut self.spans))
    }

    /// Returns the pixel of the image in which a point of the camera's picture lies, as (column, row); `None`
    /// beyond the picture. In a field it is the nearest row that the field holds.
    pub fn pixel_of(&self, point: PixelPoint) -> Option<[i32; 2]> {
        let row = (point.y - self.lines.camera_row(0) as f64) / self.lines.step() as f64;
        let (column, row) = ((point.x + 0.5).floor(), (row + 0.5).floor());
        let is_inside =
            (0.0..f64::from(self.columns)).contains(&column) && (0.0..f64::from(self.rows)).contains(&row);
        is_inside.then_some([column as i32, row as i32])
    }
}

/// Adds the crossings of an edge with the centre lines of rows; points are px from the corner of the first
/// pixel. An edge holds its upper end and not its lower end, so that a corner counts once.
fn add_crossings(from: [f64; 2], to: [f64; 2], lines: Lines, rows: i32, crossings: &mut Vec<Crossing>) {
    // From top to bottom in either sense: neighbouring facets share their crossings bit for bit.
    let (upper, lower) = if from[1] < to[1] { (from, to) } else { (to, from) };
    if !(upper[1] < lower[1] && (upper[0] + lower[0]).is_finite()) {
        return;
    }
    let (first, step) = (lines.camera_row(0) as f64 + 0.5, lines.step() as f64);
    let row_from = |y: f64| ((y - first) / step).ceil().clamp(f64::from(-rows), f64::from(2 * rows)) as i32;
    let per_row = (lower[0] - upper[0]) / (lower[1] - upper[1]);
    for row in row_from(upper[1])..row_from(lower[1]) {
        let y = first + step * f64::from(row);
        crossings.push(Crossing { row, x: upper[0] + (y - upper[1]) * per_row });
    }
}

/// Returns the first column whose centre is at or beyond x, px from the corner of the first pixel, up to one
/// picture's width beyond the picture.
fn first_centre_from(x: f64, columns: i32) -> i32 {
    (x - 0.5).ceil().clamp(f64::from(-columns), f64::from(2 * columns)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            columns: 64,
            rows: 48,
            focal_length_mm: 10.0,
            pixel_width_um: 100.0,
            pixel_height_um: 100.0,
            principal_x_px: 31.5,
            principal_y_px: 23.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    /// Rectangle 10 m ahead, where a pixel is 0.1 m: columns and rows from the principal point, px.
    fn rectangle([left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> Vec<Vector3<f64>> {
        [[left, top], [left, bottom], [right, bottom], [right, top]]
            .map(|[x, y]| Vector3::new(0.1 * x, 0.1 * y, 10.0))
            .to_vec()
    }

    #[test]
    fn a_pixel_belongs_to_the_facet_that_covers_its_centre() {
        let mut painter = MaskPainter::new(&camera(), Lines::All).unwrap();
        // From the corner of the first pixel: columns 27.6 to 36.4, rows 22.6 to 28.4.
        painter.add(&rectangle([-4.4, 4.4], [-1.4, 4.4]), &[]);
        assert_eq!(painter.finish().bounds(), Some([28..36, 23..28]));
        assert_eq!(painter.finish(), RowSpans::default());
    }

    /// Odd rows of the camera: field row k is row 2k + 1.
    #[test]
    fn a_field_holds_every_second_row() {
        let mask = |lines| {
            let mut painter = MaskPainter::new(&camera(), lines).unwrap();
            painter.add(&rectangle([-4.4, 4.4], [-1.4, 4.4]), &[rectangle([-2.4, 2.4], [-0.4, 2.4])]);
            painter.finish()
        };
        let (all, odd) = (mask(Lines::All), mask(Lines::Odd));
        let from_all = all.spans().iter().filter(|span| span.row % 2 == 1);
        let halved: Vec<Span> = from_all.map(|span| Span { row: span.row / 2, ..*span }).collect();
        assert_eq!(odd.spans(), halved);
        assert_eq!(all.count(), 8 * 5 - 4 * 2);
    }

    #[test]
    fn a_mask_reaches_beyond_the_picture_and_not_behind_the_camera() {
        let mut painter = MaskPainter::new(&camera(), Lines::All).unwrap();
        painter.add(&rectangle([-40.0, 0.0], [-30.0, -20.0]), &[]);
        let whole = painter.finish();
        assert_eq!(whole.bounds(), Some([-8..32, -6..4]));
        assert_eq!(whole.within(64, 48).bounds(), Some([0..32, 0..4]));
        let behind: Vec<_> = rectangle([-4.0, 4.0], [-4.0, 4.0]).iter().map(|corner| -corner).collect();
        painter.add(&behind, &[]);
        assert_eq!(painter.finish(), RowSpans::default());
    }

    #[test]
    fn two_halves_are_one_mask_without_a_seam() {
        let mut painter =
            MaskPainter::new(&Camera { radial: [1e-4, 0.0, 0.0], ..camera() }, Lines::All).unwrap();
        let [a, b, c, d] = rectangle([-13.3, 17.2], [-9.1, 11.7])[..] else { panic!() };
        painter.add(&[a, b, c], &[]);
        painter.add(&[a, c, d], &[]);
        let halves = painter.finish();
        painter.add(&[a, b, c, d], &[]);
        assert_eq!(halves, painter.finish());
    }

    #[test]
    fn a_point_lies_in_the_pixel_around_it() {
        let painter = MaskPainter::new(&camera(), Lines::Odd).unwrap();
        assert_eq!(painter.pixel_of(PixelPoint::new(-0.4, 1.9)), Some([0, 0]));
        assert_eq!(painter.pixel_of(PixelPoint::new(63.4, 2.1)), Some([63, 1]));
        assert_eq!(painter.pixel_of(PixelPoint::new(63.6, 2.0)), None);
    }
}
