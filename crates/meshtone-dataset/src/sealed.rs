//! JSON files that prove themselves complete: their last entry is the SHA-256 of the text before it.

use std::io::{self, Write};

use serde_json::Value;

use crate::digest::{Digest, Hashing};

/// Writes an object and its seal.
///
/// # Arguments
/// * `to` - where it is written to; it needs a buffer
/// * `head` - an object of the first entries, at least one
/// * `rest` - writes further entries, each after a comma
pub(crate) fn write<W: Write>(
    to: W,
    head: &Value,
    rest: impl FnOnce(&mut Hashing<W>) -> io::Result<()>,
) -> io::Result<()> {
    let mut to = Hashing::new(to);
    let text = serde_json::to_string_pretty(head)?;
    to.write_all(text.strip_suffix("\n}").unwrap_or(&text).as_bytes())?;
    rest(&mut to)?;
    let seal = seal(&to.digest());
    to.write_all(seal.as_bytes())?;
    to.flush()
}

/// Returns whether a text is as it was written.
pub(crate) fn is_whole(text: &str) -> bool {
    let length = seal(&Digest::of(b"")).len();
    let place = text.len().checked_sub(length).filter(|&place| text.is_char_boundary(place));
    place.is_some_and(|place| text[place..] == seal(&Digest::of(&text.as_bytes()[..place])))
}

fn seal(before: &Digest) -> String {
    format!(",\n  \"sha256\": \"{}\"\n}}\n", before.sha256)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    #[test]
    fn every_flipped_bit_shows() {
        let head = json!({ "complete": false, "files": {"a": [1, 2]} });
        let mut text = Vec::new();
        write(&mut text, &head, |to| to.write_all(b",\n  \"more\": []")).unwrap();
        let value: Value = serde_json::from_slice(&text).unwrap();
        assert_eq!((&value["files"]["a"][1], &value["more"]), (&json!(2), &json!([])));
        assert!(is_whole(std::str::from_utf8(&text).unwrap()));
        for bit in 0..8 * text.len() {
            let mut flipped = text.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(!std::str::from_utf8(&flipped).is_ok_and(is_whole), "bit {bit}");
        }
        assert!(!is_whole("") && !is_whole("{}"));
    }
}
