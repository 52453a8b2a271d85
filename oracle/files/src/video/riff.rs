//! RIFF: chunks and lists of chunks, walked from front to back.
//!
//! A size is believed only as far as the list around it goes, so no chunk reaches out of its list, and nothing is
//! allocated here: who wants a chunk's bytes knows how many they may be.

use super::input::Input;
use crate::FileError;

/// Four letters that name a chunk or a kind of list.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct FourCc(pub(super) [u8; 4]);

impl std::fmt::Display for FourCc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.0.escape_ascii())
    }
}

/// A chunk whose bytes are still to be read.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) id: FourCc,
    /// Where its header stands in the file.
    pub(super) offset: u64,
    /// Bytes after the header, without padding.
    pub(super) size: u32,
}

/// What comes next.
pub(super) enum Item {
    /// A list begins (`RIFF` or `LIST`); its kind.
    List(FourCc),
    /// A chunk.
    Chunk(Chunk),
    /// The file ends where a list of the outermost level does.
    End,
}

struct OpenList {
    kind: FourCc,
    offset: u64,
    end: u64,
}

/// A position in a RIFF file.
pub(super) struct Walker {
    input: Input,
    lists: Vec<OpenList>,
    /// Where the next header stands.
    next: u64,
}

impl Walker {
    /// Deeper than any AVI nests its lists.
    const DEEPEST: usize = 8;

    pub(super) fn new(input: Input) -> Self {
        Self { input, lists: Vec::new(), next: 0 }
    }

    pub(super) fn input(&self) -> &Input {
        &self.input
    }

    /// The error of a chunk.
    pub(super) fn error(&self, chunk: &Chunk, reason: impl std::fmt::Display) -> FileError {
        self.input.error("AVI", format!("chunk `{}` at byte {}: {reason}", chunk.id, chunk.offset))
    }

    /// Goes to the next header; bytes of a chunk that were not read are passed over.
    pub(super) fn step(&mut self) -> Result<Item, FileError> {
        self.input.skip(self.next.saturating_sub(self.input.position()))?;
        if self.input.position() < self.next {
            return Err(self.cut_short());
        }
        while self.lists.last().is_some_and(|list| list.end <= self.next) {
            self.lists.pop();
        }
        let room = self.lists.last().map_or(u64::MAX, |list| list.end - self.next);
        if room < 8 {
            return Err(self.cut_list("has no room for another chunk and is not at its end"));
        }
        let offset = self.next;
        let mut header = [0; 8];
        match self.input.fill(&mut header)? {
            8 => {}
            0 if self.lists.is_empty() && offset > 0 => return Ok(Item::End),
            _ => return Err(self.cut_short()),
        }
        let [i0, i1, i2, i3, s0, s1, s2, s3] = header;
        let id = FourCc([i0, i1, i2, i3]);
        let chunk = Chunk { id, offset, size: u32::from_le_bytes([s0, s1, s2, s3]) };
        let outermost = self.lists.is_empty();
        if outermost && &id.0 != b"RIFF" {
            // What follows the last RIFF chunk is padding of some recorder's; what comes before the first is not.
            return if offset == 0 {
                Err(self.input.error("AVI", "it does not begin with RIFF"))
            } else {
                Ok(Item::End)
            };
        }
        if u64::from(chunk.size) > room - 8 {
            let left = room - 8;
            return Err(
                self.error(&chunk, format!("{} bytes are claimed, and its list has {left} left", chunk.size))
            );
        }
        if outermost || &id.0 == b"LIST" {
            self.open(&chunk)
        } else {
            // Chunks begin at even bytes; the padding of a list's last chunk may be missing.
            let end = offset + 8 + u64::from(chunk.size);
            self.next = (end + end % 2).min(self.lists.last().map_or(u64::MAX, |list| list.end));
            Ok(Item::Chunk(chunk))
        }
    }

    fn open(&mut self, chunk: &Chunk) -> Result<Item, FileError> {
        if chunk.size < 4 {
            // What a recorder leaves that was stopped before it could write the size.
            return Err(
                self.error(chunk, format!("a list of {} bytes; the recording was not completed", chunk.size))
            );
        }
        if self.lists.len() == Self::DEEPEST {
            return Err(self.error(chunk, format!("lists are nested deeper than {}", Self::DEEPEST)));
        }
        let mut kind = [0; 4];
        if self.input.fill(&mut kind)? < 4 {
            return Err(self.cut_short());
        }
        let kind = FourCc(kind);
        self.lists.push(OpenList {
            kind,
            offset: chunk.offset,
            end: chunk.offset + 8 + u64::from(chunk.size),
        });
        self.next = chunk.offset + 12;
        Ok(Item::List(kind))
    }

    /// Reads the bytes of the chunk that [`Walker::step`] gave last into a buffer of its size.
    pub(super) fn read(&mut self, chunk: &Chunk, bytes: &mut Vec<u8>) -> Result<(), FileError> {
        bytes.resize(chunk.size as usize, 0);
        let got = self.input.fill(bytes)?;
        if got < bytes.len() {
            let reason = format!("the file ends after {got} of its {} bytes", bytes.len());
            return Err(self.error(chunk, reason));
        }
        Ok(())
    }

    fn cut_short(&self) -> FileError {
        self.cut_list("is not complete: the file ends there")
    }

    fn cut_list(&self, what: &str) -> FileError {
        let at = self.input.position();
        match self.lists.last() {
            Some(list) => self.input.error(
                "AVI",
                format!("byte {at}: list `{}`, from byte {} to {}, {what}", list.kind, list.offset, list.end),
            ),
            None => self.input.error("AVI", format!("byte {at}: the file ends within a header")),
        }
    }
}
