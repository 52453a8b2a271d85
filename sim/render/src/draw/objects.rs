//! Images of the objects of a frame, and the pixels that they cover.

use optics::Stamp;

/// Images of the objects of a frame, by number, and the parts of rows that they cover. Reused from frame to
/// frame.
#[derive(Debug, Clone)]
pub(super) struct Objects {
    /// Stamps after the first `count` are left over from earlier frames.
    stamps: Vec<Stamp>,
    count: usize,
    /// Objects that cover part of each row, by number.
    in_row: Vec<Vec<RowSpan>>,
}

/// Part of a row that an object covers.
#[derive(Debug, Clone, Copy)]
struct RowSpan {
    object: usize,
    from: usize,
    to: usize,
}

impl Objects {
    pub(super) fn new(rows: usize) -> Self {
        Self { stamps: Vec::new(), count: 0, in_row: vec![Vec::new(); rows] }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.in_row.iter_mut().for_each(Vec::clear);
    }

    pub(super) fn stamps(&self) -> &[Stamp] {
        &self.stamps[..self.count]
    }

    /// Takes an old stamp, to be reused for the image of the next object.
    pub(super) fn reuse_stamp(&mut self) -> Stamp {
        self.stamps.get_mut(self.count).map(std::mem::take).unwrap_or_default()
    }

    /// Adds the image of the next object; [`Self::add_span`] must have been called before for each part of a
    /// row that the image covers.
    pub(super) fn push(&mut self, stamp: Stamp) -> &Stamp {
        let object = self.count;
        match self.stamps.get_mut(object) {
            Some(slot) => *slot = stamp,
            None => self.stamps.push(stamp),
        }
        self.count += 1;
        &self.stamps[object]
    }

    /// Records that the next object covers columns `from..to` of a row.
    #[inline(always)]
    pub(super) fn add_span(&mut self, y: usize, from: usize, to: usize) {
        self.in_row[y].push(RowSpan { object: self.count, from, to });
    }

    /// Adds the electrons of all objects to the pixels of row `y` from column `x` on.
    #[inline(always)]
    pub(super) fn add_to(&self, x: usize, y: usize, out: &mut [f64]) {
        let end = x + out.len();
        for part in &self.in_row[y] {
            let (from, to) = (part.from.max(x), part.to.min(end));
            if from >= to {
                continue;
            }
            let light = &self.stamps[part.object].row(y)[from - part.from..to - part.from];
            for (out, light) in out[from - x..to - x].iter_mut().zip(light) {
                *out += light;
            }
        }
    }

    /// Removes the electrons of all objects from a pixel.
    pub(super) fn empty(&mut self, x: usize, y: usize) {
        let Self { stamps, in_row, .. } = self;
        for part in in_row[y].iter().filter(|part| (part.from..part.to).contains(&x)) {
            stamps[part.object].empty(x, y);
        }
    }
}
