//! Reading flat buffers: tables whose fields stand at places that the table lists.
//!
//! The crate `flatbuffers` reads them in code that a compiler of theirs writes and that trusts the places; a recording may come
//! from anywhere, so here every place is looked at.

/// A table in a buffer.
#[derive(Debug, Clone, Copy)]
pub(super) struct FlatTable<'b> {
    bytes: &'b [u8],
    /// Where it begins, with the way back to its list of places.
    start: usize,
}

/// Bytes before the first place in a table's list: the lengths of the list and of the table.
pub(super) const BEFORE_PLACES: usize = 4;

impl<'b> FlatTable<'b> {
    /// The table that a buffer is.
    pub fn root(bytes: &'b [u8]) -> Option<Self> {
        Self { bytes, start: 0 }.followed(0)
    }

    /// A table that is a field.
    pub fn table(self, field: usize) -> Option<Self> {
        self.followed(self.place(field)?)
    }

    /// The tables of a field that is a list of them; none where the field is absent.
    pub fn tables(self, field: usize) -> impl Iterator<Item = Self> {
        let list = self.place(field).and_then(|place| self.followed(place)).map(|list| list.start);
        let count = list.and_then(|list| self.u32_at(list)).unwrap_or(0) as usize;
        let first = list.unwrap_or(0).saturating_add(4);
        (0..count).map_while(move |index| self.followed(first.checked_add(index.checked_mul(4)?)?))
    }

    /// The text of a field.
    pub fn text(self, field: usize) -> Option<&'b str> {
        let text = self.table(field)?.start;
        let length = self.u32_at(text)? as usize;
        let start = text.checked_add(4)?;
        std::str::from_utf8(self.bytes.get(start..start.checked_add(length)?)?).ok()
    }

    /// The number of a field of one byte.
    pub fn u8(self, field: usize) -> Option<u8> {
        self.bytes.get(self.place(field)?).copied()
    }

    /// The number of a field of two bytes.
    pub fn u16(self, field: usize) -> Option<u16> {
        self.u16_at(self.place(field)?)
    }

    /// Where a field stands; none where the table has none.
    fn place(self, field: usize) -> Option<usize> {
        let way_back = self.u32_at(self.start)? as i32;
        let list = usize::try_from(i64::try_from(self.start).ok()? - i64::from(way_back)).ok()?;
        let entry = BEFORE_PLACES + 2 * field;
        if entry + 2 > usize::from(self.u16_at(list)?) {
            return None;
        }
        match self.u16_at(list.checked_add(entry)?)? {
            0 => None,
            place => self.start.checked_add(usize::from(place)),
        }
    }

    /// What the distance at a place leads to.
    fn followed(self, place: usize) -> Option<Self> {
        let start = place.checked_add(self.u32_at(place)? as usize)?;
        (start < self.bytes.len()).then_some(Self { start, ..self })
    }

    fn u16_at(self, place: usize) -> Option<u16> {
        let bytes = self.bytes.get(place..place.checked_add(2)?)?;
        Some(u16::from_le_bytes(bytes.try_into().ok()?))
    }

    fn u32_at(self, place: usize) -> Option<u32> {
        let bytes = self.bytes.get(place..place.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }
}
