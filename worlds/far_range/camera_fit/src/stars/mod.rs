//! Brightness and width of the stars.

pub(crate) mod photometry;
pub(crate) mod profile;
