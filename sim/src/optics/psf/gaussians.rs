//! Sums of circular Gaussians, each integrated exactly over every pixel.
//!
//! A Gaussian over a rectangle is the product of two differences of error functions, one a column and one a row,
//! so that an image costs as many error functions as it has columns and rows.

use super::condense::condensed;
use super::error_function::ErrorFunction;
use super::pixels_within;
use crate::optics::{ImagePoint, Stamp};
use crate::widest::{Work, by_eights, widest};

/// A sum of circular Gaussians about one centre.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gaussians {
    /// In order of growing width.
    components: Vec<Component>,
    /// The part of the floor below which a single component is not followed.
    floor_share: f64,
}

/// Shares of flux a column and a row, reused from stamp to stamp.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Profiles {
    x: Vec<f64>,
    y: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Component {
    weight: f64,
    sigma_px: f64,
    /// Share of its light in the column, or the row, of pixels about its centre, when that is in their middle.
    central_share: f64,
}

impl Gaussians {
    pub(super) fn one(sigma_px: f64) -> Self {
        Self { components: vec![Component::new(1.0, sigma_px)], floor_share: 1.0 }
    }

    /// A core and a wider halo that holds `halo_fraction` of the light.
    pub(super) fn halo(sigma_px: f64, halo_sigma_px: f64, halo_fraction: f64) -> Self {
        let core = Component::new(1.0 - halo_fraction, sigma_px);
        let halo = Component::new(halo_fraction, halo_sigma_px);
        Self { components: vec![core, halo], floor_share: 1.0 }
    }

    /// Many components that stand for one smooth profile: what is left out of all of them together stays below the
    /// floor.
    pub(super) fn mixture(components: Vec<Component>) -> Self {
        let floor_share = 1.0 / components.len() as f64;
        Self { components, floor_share }
    }

    /// Distance from the centre beyond which no component is followed, px; 0 when there is nothing to draw.
    pub(super) fn reach_px(&self, electrons: f64, floor_e: f64, scale: f64) -> f64 {
        let floor_e = floor_e * self.floor_share;
        self.components
            .iter()
            .map(|component| component.scaled(scale).reach_px(electrons, floor_e))
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
        for component in self.components.iter().map(|component| component.scaled(scale)) {
            let own_px = component.reach_px(electrons, floor_e * self.floor_share);
            if own_px > 0.0 {
                let condensed = condensed(points, component.sigma_px);
                let points = condensed.as_ref().map_or(points, |(few, count)| &few[..*count]);
                widest(Images { component, points, electrons, own_px, profiles, stamp });
            }
        }
    }

    /// The share of the light in the pixel under the centre.
    pub(super) fn peak_share(&self) -> f64 {
        self.components
            .iter()
            .map(|component| component.weight * component.central_share * component.central_share)
            .sum()
    }
}

/// The images of points, added to a stamp: each of its share of the electrons, followed to `own_px`.
struct Images<'a> {
    component: Component,
    points: &'a [ImagePoint],
    electrons: f64,
    own_px: f64,
    profiles: &'a mut Profiles,
    stamp: &'a mut Stamp,
}

impl Work for Images<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { component, points, electrons, own_px, profiles, stamp } = self;
        let (right, bottom) = (stamp.x + stamp.columns, stamp.y + stamp.rows);
        for point in points {
            let own_x = pixels_within((point.position.x, point.position.x), own_px, right);
            let own_y = pixels_within((point.position.y, point.position.y), own_px, bottom);
            let (own_x, own_y) = ((own_x.0.max(stamp.x), own_x.1), (own_y.0.max(stamp.y), own_y.1));
            if own_x.0 >= own_x.1 || own_y.0 >= own_y.1 {
                continue;
            }
            component.profile(point.position.x, own_x, &mut profiles.x);
            component.profile(point.position.y, own_y, &mut profiles.y);
            let flux = electrons * component.weight * point.share;
            let (left, width) = (own_x.0 - stamp.x, own_x.1 - own_x.0);
            let rows = stamp.electrons.chunks_exact_mut(stamp.columns).skip(own_y.0 - stamp.y);
            for (row, share_y) in rows.zip(&profiles.y) {
                let row_flux = flux * share_y;
                by_eights(&mut row[left..left + width], &profiles.x, |pixel, share_x| {
                    *pixel += row_flux * share_x;
                });
            }
        }
    }
}

impl Component {
    pub(super) fn new(weight: f64, sigma_px: f64) -> Self {
        let half = 0.5 / (sigma_px * std::f64::consts::SQRT_2);
        Self { weight, sigma_px, central_share: libm::erf(half) }
    }

    fn scaled(self, scale: f64) -> Self {
        if scale == 1.0 { self } else { Self::new(self.weight, self.sigma_px * scale) }
    }

    /// Distance from the centre beyond which, along a column or a row, no pixel holds `floor_e`, px; 0 when no
    /// pixel at all does. A pixel whose nearer edge is d away holds at most flux · n(d) · share(±0.5), with the
    /// normal density n.
    fn reach_px(&self, electrons: f64, floor_e: f64) -> f64 {
        let density = 1.0 / (self.sigma_px * (2.0 * std::f64::consts::PI).sqrt());
        let brightest = electrons * self.weight * density * self.central_share;
        if brightest > floor_e {
            0.5 + self.sigma_px * (2.0 * libm::log(brightest / floor_e)).sqrt()
        } else {
            0.0
        }
    }

    /// Shares of the flux in each pixel of a range along one axis.
    #[inline(always)]
    fn profile(&self, centre: f64, range: (usize, usize), shares: &mut Vec<f64>) {
        let scale = 1.0 / (self.sigma_px * std::f64::consts::SQRT_2);
        let erf = ErrorFunction::shared();
        let edge = |i: usize| erf.at((i as f64 - 0.5 - centre) * scale);
        // First the error function at every edge, each by itself, then their differences in place.
        shares.clear();
        shares.resize(range.1 - range.0 + 1, 0.0);
        for (share, i) in shares.iter_mut().zip(range.0..) {
            *share = edge(i);
        }
        for i in 1..shares.len() {
            shares[i - 1] = 0.5 * (shares[i] - shares[i - 1]);
        }
        shares.pop();
    }
}
