//! Reading and writing of digitised television sequences.
//!
//! Input: directories of images, AVI (uncompressed and Motion-JPEG), Y4M, raw frames, from files or from
//! standard input. A [`FieldSource`] returns the fields of any of them, with one whole frame in memory at a
//! time. Output: AVI and Y4M ([`AviWriter`], [`Y4mWriter`]); fields as images are written individually
//! ([`write_field`]).
//!
//! A file whose size differs from that of the camera is rejected before memory is allocated for a frame. A
//! truncated file returns every complete frame, then an error that names the chunk and its position.

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
use files::{FileError, write_png_of_depth};

/// Writes the image of a field as grey PNG, with 8 bits if its digitiser has at most 8, otherwise with 16.
/// Values are in DN and unstretched.
///
/// # Errors
/// [`FileError::Io`] if the file exists or cannot be written.
pub fn write_field(path: &Path, field: &Field) -> Result<(), FileError> {
    write_png_of_depth(path, field.image())
}
