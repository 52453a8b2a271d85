//! Rendering: the image of a scene on the detector, in photoelectrons for a star field ([`draw`]), as
//! radiance for a scene of facets ([`vector`], and [`mitsuba`] as its reference).

pub mod draw;
pub mod mitsuba;
pub mod painter;
pub mod vector;
