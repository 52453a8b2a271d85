//! Subset of Thrift's compact protocol that is needed to read the sizes that a Parquet file claims.
//!
//! Methods return `None` for data that end early or violate the protocol. Nothing is allocated, and claimed
//! sizes are accepted only if the available bytes can contain them.

/// Deepest nesting that is skipped: Parquet's own structures have six levels.
const MAX_DEPTH: u8 = 16;

/// Kinds of a field's value.
pub(crate) mod kind {
    pub(crate) const I32: u8 = 5;
    pub(crate) const LIST: u8 = 9;
    pub(crate) const STRUCT: u8 = 12;
}

/// Header of a struct field: its number and the kind of its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FieldHead {
    pub(crate) id: i64,
    pub(crate) kind: u8,
}

/// Remaining bytes, read from the front.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compact<'a>(pub(crate) &'a [u8]);

impl Compact<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    fn pass(&mut self, bytes: u64) -> Option<()> {
        self.0 = self.0.get(usize::try_from(bytes).ok()?..)?;
        Some(())
    }

    /// Reads an unsigned number, seven bits per byte, lowest bits first.
    fn varint(&mut self) -> Option<u64> {
        let mut number = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }

    /// Reads a signed number, whose sign is the lowest bit.
    pub(crate) fn integer(&mut self) -> Option<i64> {
        let number = self.varint()?;
        Some((number >> 1) as i64 ^ -((number & 1) as i64))
    }

    /// Reads the header of the field after the field number `before` (0 at first); the inner `None` is the
    /// end of the struct.
    pub(crate) fn field(&mut self, before: i64) -> Option<Option<FieldHead>> {
        let byte = self.byte()?;
        let (step, kind) = (byte >> 4, byte & 0x0f);
        if byte == 0 {
            return Some(None);
        }
        let id = if step == 0 { self.integer()? } else { before.checked_add(i64::from(step))? };
        Some(Some(FieldHead { id, kind }))
    }

    /// Reads the kind of a list's elements and their number, which must not exceed the number of remaining
    /// bytes.
    pub(crate) fn list(&mut self) -> Option<(u8, usize)> {
        let byte = self.byte()?;
        let size = if byte >> 4 == 15 { self.varint()? } else { u64::from(byte >> 4) };
        let size = usize::try_from(size).ok().filter(|&size| size <= self.0.len())?;
        Some((byte & 0x0f, size))
    }

    /// Skips the value of a field.
    pub(crate) fn skip(&mut self, kind: u8) -> Option<()> {
        self.skip_nested(kind, MAX_DEPTH)
    }

    fn skip_nested(&mut self, kind: u8, depth: u8) -> Option<()> {
        let inner = depth.checked_sub(1)?;
        match kind {
            // The value of a Boolean field is encoded in its kind.
            1 | 2 => Some(()),
            3 => self.pass(1),
            4..=6 => self.varint().map(|_| ()),
            7 => self.pass(8),
            8 => {
                let length = self.varint()?;
                self.pass(length)
            }
            9 | 10 => {
                let (element, size) = self.list()?;
                (0..size).try_for_each(|_| self.skip_element(element, inner))
            }
            11 => {
                let size = usize::try_from(self.varint()?).ok().filter(|&size| size <= self.0.len())?;
                if size == 0 {
                    return Some(());
                }
                let kinds = self.byte()?;
                (0..size).try_for_each(|_| {
                    self.skip_element(kinds >> 4, inner)?;
                    self.skip_element(kinds & 0x0f, inner)
                })
            }
            12 => {
                let mut before = 0;
                while let Some(field) = self.field(before)? {
                    self.skip_nested(field.kind, inner)?;
                    before = field.id;
                }
                Some(())
            }
            _ => None,
        }
    }

    /// Skips an element of a list, in which a Boolean takes one byte.
    fn skip_element(&mut self, kind: u8, depth: u8) -> Option<()> {
        if matches!(kind, 1 | 2) { self.pass(1) } else { self.skip_nested(kind, depth) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_the_protocol_writes_them() {
        let read = |bytes: &[u8]| Compact(bytes).integer();
        assert_eq!(read(&[0x00]), Some(0));
        assert_eq!(read(&[0x01]), Some(-1));
        assert_eq!(read(&[0x02]), Some(1));
        assert_eq!(read(&[0xac, 0x02]), Some(150));
        assert_eq!(read(&[0xff, 0xff, 0xff, 0xff, 0x0f]), Some(i64::from(i32::MIN)));
        assert_eq!(read(&[0xff, 0xff]), None);
        assert_eq!(read(&[0xff; 20]), None);
    }

    #[test]
    fn a_skipped_field_ends_where_the_next_begins() {
        // {1: true, 2: "ab", 3: [1, 2], 4: {1: 5 (double)}, 5: {7: 8}}, followed by one byte.
        let bytes = [
            0x11, 0x18, 2, b'a', b'b', 0x19, 0x25, 2, 4, 0x1c, 0x17, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x1b, 1,
            0x55, 14, 16, 0, 0x7f,
        ];
        let mut compact = Compact(&bytes);
        assert_eq!(compact.skip(kind::STRUCT), Some(()));
        assert_eq!(compact.0, [0x7f]);
    }

    #[test]
    fn claims_beyond_the_bytes_are_refused() {
        // A list of 2^35 elements, a text of 2^35 bytes, structs nested in each other without end.
        let huge = [0xff, 0xff, 0xff, 0xff, 0x7f];
        assert_eq!(Compact(&[&[0xf5], &huge[..]].concat()).skip(kind::LIST), None);
        assert_eq!(Compact(&huge).skip(8), None);
        assert_eq!(Compact(&[0x1c; 100_000]).skip(kind::STRUCT), None);
    }
}
