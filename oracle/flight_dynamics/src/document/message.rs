//! Parts of a message.

use super::record::Record;

/// A message: header and segments.
#[derive(Debug)]
pub(crate) struct Document<'a> {
    pub(crate) header: Record<'a>,
    pub(crate) segments: Vec<Segment<'a>>,
}

/// Metadata with the data that they describe.
#[derive(Debug)]
pub(crate) struct Segment<'a> {
    pub(crate) metadata: Record<'a>,
    pub(crate) data: Vec<Record<'a>>,
}
