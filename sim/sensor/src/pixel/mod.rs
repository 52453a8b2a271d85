//! Digital number of one pixel: its distribution, and the two ways to draw from it.

mod alias;
mod direct_sampler;
pub(crate) mod distribution;
pub(crate) mod exceedance;
pub(crate) mod mean_tables;
pub(crate) mod poisson;
mod poisson_digits;
pub(crate) mod sampler;
pub(crate) mod words;
pub(crate) mod ziggurat;
