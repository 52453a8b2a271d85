//! Sums of circular Gaussians, each integrated exactly over every pixel.
//!
//! A Gaussian over a rectangle is the product of two differences of error functions, one per column and one
//! per row, so an image costs as many error functions as it has columns and rows. Most values come from a
//! table for the width ([`ShareTable`]); if the width grows over the field, each image computes its error
//! functions.

use std::borrow::Cow;
use std::sync::Arc;

use pulp::Simd;

use super::condense::condensed;
use super::error_function::ErrorFunction;
use super::pixels_within::pixels_within;
use super::share_table::ShareTable;
use crate::simd_kernel::{F64x8, LANES, SimdKernel, run_widest};
use crate::{ImagePoint, Stamp};

/// Number of points whose images are added together.
const TOGETHER: usize = 4;

/// Sum of circular Gaussians about one centre.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gaussians {
    /// Components in order of increasing width.
    components: Vec<Component>,
    /// Fraction of the floor below which a single component is not drawn.
    floor_share: f64,
}

/// Fractions of the flux by column and by row for some points, reused from stamp to stamp.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Profiles {
    x: [Vec<f64>; TOGETHER],
    y: [Vec<f64>; TOGETHER],
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    weight: f64,
    sigma_px: f64,
    /// Fraction of the flux in the column, or the row, of pixels around the centre, if the centre is in the
    /// middle of a pixel.
    central_share: f64,
    /// Natural logarithm of an upper bound of the flux fraction in a pixel: weight · n(0) · `central_share`,
    /// with the normal density n.
    log_bound: f64,
    /// Flux fractions of other pixels; `None`: computed from error functions.
    table: Option<Arc<ShareTable>>,
}

impl Gaussians {
    pub(super) fn single(sigma_px: f64) -> Self {
        Self { components: vec![Component::new(1.0, sigma_px)], floor_share: 1.0 }
    }

    /// Creates a core and a wider halo that holds `halo_fraction` of the flux.
    pub(super) fn halo(sigma_px: f64, halo_sigma_px: f64, halo_fraction: f64) -> Self {
        let core = Component::new(1.0 - halo_fraction, sigma_px);
        let halo = Component::new(halo_fraction, halo_sigma_px);
        Self { components: vec![core, halo], floor_share: 1.0 }
    }

    /// Creates a smooth profile from many components; the sum of all omitted parts stays below the floor.
    pub(super) fn mixture(components: Vec<Component>) -> Self {
        let floor_share = 1.0 / components.len() as f64;
        Self { components, floor_share }
    }

    /// Distance from the centre beyond which no component is drawn, px; 0 if no pixel is drawn.
    pub(super) fn reach_px(&self, electrons: f64, floor_e: f64, scale: f64) -> f64 {
        let log_floor = libm::log(electrons / (floor_e * self.floor_share));
        self.components
            .iter()
            .map(|component| component.scaled(scale).reach_px(log_floor))
            .fold(0.0, f64::max)
    }

    /// Adds the images of `points`, `scale` times as wide, to a stamp that covers them.
    pub(super) fn draw(
        &self,
        points: &[ImagePoint],
        electrons: f64,
        floor_e: f64,
        scale: f64,
        profiles: &mut Profiles,
        stamp: &mut Stamp,
    ) {
        let log_floor = libm::log(electrons / (floor_e * self.floor_share));
        for component in &self.components {
            let component = component.scaled(scale);
            let own_px = component.reach_px(log_floor);
            if own_px > 0.0 {
                let condensed = condensed(points, component.sigma_px);
                let points = condensed.as_ref().map_or(points, |(few, count)| &few[..*count]);
                run_widest(Images { component: &component, points, electrons, own_px, profiles, stamp });
            }
        }
    }

    /// Fraction of the flux in the pixel under the centre.
    pub(super) fn peak_share(&self) -> f64 {
        self.components
            .iter()
            .map(|component| component.weight * component.central_share * component.central_share)
            .sum()
    }
}

/// Adds the images of points to a stamp, each with its fraction of the electrons, drawn out to `own_px`.
struct Images<'a> {
    component: &'a Component,
    points: &'a [ImagePoint],
    electrons: f64,
    own_px: f64,
    profiles: &'a mut Profiles,
    stamp: &'a mut Stamp,
}

impl SimdKernel for Images<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { component, points, electrons, own_px, profiles, stamp } = self;
        for points in points.chunks(TOGETHER) {
            let span = |of: fn(&ImagePoint) -> f64| {
                let from_to = points
                    .iter()
                    .map(of)
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), at| (from.min(at), to.max(at)));
                // NaN lies outside the image, like an infinite position.
                if points.iter().map(of).all(f64::is_finite) { from_to } else { (f64::NAN, f64::NAN) }
            };
            let own_x = pixels_within(span(|point| point.position.x), own_px, stamp.x + stamp.columns);
            let own_y = pixels_within(span(|point| point.position.y), own_px, stamp.y + stamp.rows);
            let (own_x, own_y) = ((own_x.0.max(stamp.x), own_x.1), (own_y.0.max(stamp.y), own_y.1));
            if own_x.0 >= own_x.1 || own_y.0 >= own_y.1 {
                continue;
            }
            // Columns in whole lanes of the stamp; values after its last column stay 0.
            let first = (own_x.0 - stamp.x) / LANES * LANES;
            let width = (own_x.1 - stamp.x - first).next_multiple_of(LANES);
            let padding = (first + width).saturating_sub(stamp.columns);
            let mut fluxes = [0.0; TOGETHER];
            for (i, point) in points.iter().enumerate() {
                component.shares(simd, point.position.x, stamp.x + first, width, &mut profiles.x[i]);
                profiles.x[i][width - padding..].fill(0.0);
                component.shares(simd, point.position.y, own_y.0, own_y.1 - own_y.0, &mut profiles.y[i]);
                fluxes[i] = electrons * component.weight * point.share;
            }
            let stride = stamp.stride;
            let rows =
                stamp.electrons.chunks_exact_mut(stride).skip(own_y.0 - stamp.y).take(own_y.1 - own_y.0);
            let rows = rows.map(|row| row[first..first + width].as_chunks_mut::<LANES>().0);
            match points.len() {
                1 => add_products::<S, 1>(simd, rows, fluxes, profiles),
                2 => add_products::<S, 2>(simd, rows, fluxes, profiles),
                3 => add_products::<S, 3>(simd, rows, fluxes, profiles),
                _ => add_products::<S, 4>(simd, rows, fluxes, profiles),
            }
        }
    }
}

/// Adds the electrons of `N` points to each pixel: flux times row fraction times column fraction.
#[inline(always)]
fn add_products<'a, S: Simd, const N: usize>(
    simd: S,
    rows: impl Iterator<Item = &'a mut [[f64; LANES]]>,
    fluxes: [f64; TOGETHER],
    profiles: &Profiles,
) {
    let columns: [&[[f64; LANES]]; N] = std::array::from_fn(|k| profiles.x[k].as_chunks::<LANES>().0);
    for (j, row) in rows.enumerate() {
        let of_row: [F64x8<S>; N] = std::array::from_fn(|k| F64x8::splat(simd, fluxes[k] * profiles.y[k][j]));
        for (i, pixels) in row.iter_mut().enumerate() {
            let mut sum = F64x8::from_array(simd, pixels);
            for k in 0..N {
                sum = sum.plus(of_row[k].times(F64x8::from_array(simd, &columns[k][i])));
            }
            sum.store(pixels);
        }
    }
}

impl Component {
    pub(super) fn new(weight: f64, sigma_px: f64) -> Self {
        let table = ShareTable::new(sigma_px).map(Arc::new);
        Self { table, ..Self::from_width(weight, sigma_px) }
    }

    /// Creates a component without a table.
    fn from_width(weight: f64, sigma_px: f64) -> Self {
        let central_share = libm::erf(0.5 / (sigma_px * std::f64::consts::SQRT_2));
        let density = 1.0 / (sigma_px * (2.0 * std::f64::consts::PI).sqrt());
        Self {
            weight,
            sigma_px,
            central_share,
            log_bound: libm::log(weight * density * central_share),
            table: None,
        }
    }

    fn scaled(&self, scale: f64) -> Cow<'_, Self> {
        if scale == 1.0 {
            Cow::Borrowed(self)
        } else {
            Cow::Owned(Self::from_width(self.weight, self.sigma_px * scale))
        }
    }

    /// Distance from the centre beyond which, along a column or a row, no pixel reaches the floor, px; 0 if
    /// no pixel does. `log_floor` is the natural logarithm of flux over floor. A pixel whose nearer edge is
    /// at distance d holds at most flux · n(d) · share(±0.5).
    fn reach_px(&self, log_floor: f64) -> f64 {
        let above = log_floor + self.log_bound;
        if above > 0.0 { 0.5 + self.sigma_px * (2.0 * above).sqrt() } else { 0.0 }
    }

    /// Computes the flux fractions of `count` pixels from `first` on along one axis, for a Gaussian about
    /// `centre`.
    #[inline(always)]
    fn shares<S: Simd>(&self, simd: S, centre: f64, first: usize, count: usize, shares: &mut Vec<f64>) {
        shares.clear();
        if let Some(table) = &self.table {
            shares.resize(count.next_multiple_of(LANES), 0.0);
            return table.fill(simd, centre, first, shares);
        }
        let scale = 1.0 / (self.sigma_px * std::f64::consts::SQRT_2);
        let erf = ErrorFunction::shared();
        let edge = |i: usize| erf.value_at((i as f64 - 0.5 - centre) * scale);
        // First computes the error function at every edge independently, then the differences in place.
        shares.resize(count + 1, 0.0);
        for (share, i) in shares.iter_mut().zip(first..) {
            *share = edge(i);
        }
        for i in 1..shares.len() {
            shares[i - 1] = 0.5 * (shares[i] - shares[i - 1]);
        }
        shares.pop();
    }
}
