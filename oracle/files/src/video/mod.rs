//! Digitised sequences of television, in and out.
//!
//! In: folders of images, AVI (uncompressed and Motion-JPEG), Y4M, raw frames, from files or from standard input; a
//! [`FieldSource`] gives the fields of any of them, one whole frame in memory at a time. Out: AVI and Y4M
//! ([`AviWriter`], [`Y4mWriter`]); fields as images are written one by one ([`write_field`]).
//!
//! A file of another size than the camera is refused before a frame is allocated. Of a file that is cut short every
//! whole frame is given, then an error that names the chunk and its place.

mod avi;
mod avi_header;
mod avi_writer;
mod folder;
mod input;
mod listed_video;
mod luma;
mod riff;
mod source;
mod stream;
#[cfg(test)]
mod tests;
mod video_frame;
mod weaver;
mod y4m_writer;

pub use avi_writer::{AviCoding, AviWriter};
pub use folder::read_listed_field;
pub use source::{FieldSource, FrameSize, SequenceOptions};
pub use video_frame::{FieldOrder, Scan};
pub use y4m_writer::Y4mWriter;

use std::path::Path;

use contract::docking::Field;

use crate::FileError;
use crate::frame::image16;

/// Writes the image of a field as grey PNG: of 8 bits where its digitiser has no more, otherwise of 16; values in DN
/// and not stretched.
///
/// # Errors
/// [`FileError::Io`] when the file exists or cannot be written.
pub fn write_field(path: &Path, field: &Field) -> Result<(), FileError> {
    image16::write_png_of_depth(path, field.image())
}
