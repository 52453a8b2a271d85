//! Proposals of bright disks: each edge votes for the centres of the circles that it may belong to, bright
//! inside (Kimme, Ballard and Sklansky 1975).

use imageproc::image::GrayImage;
use nalgebra::Vector2;

/// Smallest radius of the search, overview pixels.
const MIN_RADIUS_PX: f64 = 4.5;

/// Ratio of successive radii of the search.
const RADIUS_STEP: f64 = 1.08;

/// Smallest number of votes, relative to the circle's circumference in pixels.
const MIN_VOTES: f64 = 0.3;

/// Circle proposed by votes of edges, overview pixels.
pub(crate) struct Proposal {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) radius: f64,
    /// Number of votes divided by the circle's circumference in pixels.
    pub(crate) share: f64,
}

/// Returns the best circles of each radius, bright inside, by the edges of at least `min_step` grey values.
pub(crate) fn propose(grey: &GrayImage, min_step: f64) -> Vec<Proposal> {
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    if width < 16 || height < 16 {
        return Vec::new();
    }
    let edges = edges(grey, min_step);
    let mut found = Vec::new();
    let mut radius = MIN_RADIUS_PX;
    let mut votes: Vec<u16> = Vec::new();
    while radius < 0.5 * width.min(height) as f64 {
        // The direction of an edge is accurate to about a tenth, so the votes for centres of large circles
        // scatter.
        let cells_px = 1.0 / (0.10 * radius).max(1.0);
        let (columns, rows) =
            ((width as f64 * cells_px) as usize + 1, (height as f64 * cells_px) as usize + 1);
        votes.clear();
        votes.resize(columns * rows, 0);
        for edge in &edges {
            let x = (edge.x + radius * edge.inwards.x) * cells_px;
            let y = (edge.y + radius * edge.inwards.y) * cells_px;
            if x >= 0.0 && y >= 0.0 && (x as usize) < columns && (y as usize) < rows {
                let index = y as usize * columns + x as usize;
                votes[index] = votes[index].saturating_add(1);
            }
        }
        let circumference = std::f64::consts::TAU * radius;
        let few = (MIN_VOTES * circumference) as u16;
        // Sums two by two cells, so a centre on the border between cells gets as many votes as a centre
        // within a cell.
        let mut best: Vec<Proposal> = Vec::new();
        for (row, pair) in votes.windows(2 * columns).step_by(columns).enumerate() {
            let (above, below) = pair.split_at(columns);
            for (column, (one, other)) in above.windows(2).zip(below.windows(2)).enumerate() {
                let sum = one[0].saturating_add(one[1]).saturating_add(other[0]).saturating_add(other[1]);
                if sum <= few {
                    continue;
                }
                let share = f64::from(sum) / circumference;
                if best.len() < 4 || best.last().is_some_and(|last| share > last.share) {
                    let (x, y) = ((column + 1) as f64 / cells_px, (row + 1) as f64 / cells_px);
                    let index = best.partition_point(|other| other.share >= share);
                    best.insert(index, Proposal { x, y, radius, share });
                    best.truncate(4);
                }
            }
        }
        found.append(&mut best);
        radius *= RADIUS_STEP;
    }
    found
}

/// Edge pixel, overview pixels.
struct Edge {
    x: f64,
    y: f64,
    /// Unit vector towards the brighter side.
    inwards: Vector2<f64>,
}

/// Returns the pixels of steep gradient (Sobel).
fn edges(grey: &GrayImage, min_step: f64) -> Vec<Edge> {
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let pixels = grey.as_raw();
    let mut found = Vec::new();
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let at = |dx: usize, dy: usize| i32::from(pixels[(y + dy - 1) * width + x + dx - 1]);
            let gx = at(2, 0) + 2 * at(2, 1) + at(2, 2) - at(0, 0) - 2 * at(0, 1) - at(0, 2);
            let gy = at(0, 2) + 2 * at(1, 2) + at(2, 2) - at(0, 0) - 2 * at(1, 0) - at(2, 0);
            let square = f64::from(gx * gx + gy * gy);
            // A step has four times its height in Sobel's sum.
            if square >= 16.0 * min_step * min_step {
                let length = square.sqrt();
                let inwards = Vector2::new(f64::from(gx), f64::from(gy)) / length;
                found.push(Edge { x: x as f64, y: y as f64, inwards });
            }
        }
    }
    found
}
