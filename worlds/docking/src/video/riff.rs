//! RIFF files: chunks and lists of chunks, read from front to back.
//!
//! The size of a chunk must fit in the list around it, so no chunk extends beyond its list. The walker
//! allocates no memory: the caller that requests the bytes of a chunk limits their number.

use files::FileError;

use super::input::Input;

/// Four letters that identify a chunk or a kind of list.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct FourCc(pub(super) [u8; 4]);

impl std::fmt::Display for FourCc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.0.escape_ascii())
    }
}

/// A chunk whose bytes have not been read yet.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) id: FourCc,
    /// Position of the chunk's header in the file, bytes.
    pub(super) offset: u64,
    /// Number of bytes after the header, without padding.
    pub(super) size: u32,
}

/// Next element of a RIFF file.
pub(super) enum Item {
    /// Beginning of a list (`RIFF` or `LIST`) of this kind.
    List(FourCc),
    /// A chunk.
    Chunk(Chunk),
    /// End of the file, at the end of a list of the outermost level.
    End,
}

struct OpenList {
    kind: FourCc,
    offset: u64,
    end: u64,
}

/// Reading position in a RIFF file.
pub(super) struct Walker {
    input: Input,
    lists: Vec<OpenList>,
    /// Position of the next header, bytes.
    next: u64,
}

impl Walker {
    /// Deepest nesting of lists; deeper than in any AVI file.
    const MAX_DEPTH: usize = 8;

    pub(super) fn new(input: Input) -> Self {
        Self { input, lists: Vec::new(), next: 0 }
    }

    pub(super) fn input(&self) -> &Input {
        &self.input
    }

    /// Creates the error of a chunk.
    pub(super) fn error(&self, chunk: &Chunk, reason: impl std::fmt::Display) -> FileError {
        self.input.error("AVI", format!("chunk `{}` at byte {}: {reason}", chunk.id, chunk.offset))
    }

    /// Advances to the next header; unread bytes of a chunk are skipped.
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
            return Err(self.cut_list("has bytes left, but too few for another chunk"));
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
            // Bytes after the last RIFF chunk are padding of some recorder; bytes before the first are an
            // error.
            return if offset == 0 {
                Err(self.input.error("AVI", "it does not begin with RIFF"))
            } else {
                Ok(Item::End)
            };
        }
        if u64::from(chunk.size) > room - 8 {
            let left = room - 8;
            return Err(self
                .error(&chunk, format!("it states {} bytes, but {left} are left in its list", chunk.size)));
        }
        if outermost || &id.0 == b"LIST" {
            self.open(&chunk)
        } else {
            // Chunks begin at even bytes; the padding of the last chunk in a list may be missing.
            let end = offset + 8 + u64::from(chunk.size);
            self.next = (end + end % 2).min(self.lists.last().map_or(u64::MAX, |list| list.end));
            Ok(Item::Chunk(chunk))
        }
    }

    fn open(&mut self, chunk: &Chunk) -> Result<Item, FileError> {
        if chunk.size < 4 {
            // Left by a recorder that was stopped before it could write the size.
            return Err(self.error(
                chunk,
                format!(
                    "a list of {} bytes, expected at least 4; the recording was not completed",
                    chunk.size
                ),
            ));
        }
        if self.lists.len() == Self::MAX_DEPTH {
            return Err(self.error(chunk, format!("lists are nested deeper than {}", Self::MAX_DEPTH)));
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

    /// Reads the bytes of the chunk that [`Walker::step`] returned last; the buffer is resized to the size of
    /// the chunk.
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
        self.cut_list("is incomplete: the file ends there")
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
