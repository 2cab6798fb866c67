//! An answer on its way to the page: what is said about it as JSON, and its arrays in single precision behind that.
//!
//! Four bytes, little endian, are the length of the JSON text, which spaces fill up to a multiple of four; the numbers follow, little
//! endian. In the JSON an array is `{"array_at": first number, "length": numbers}`, so that the page looks at them where they lie.

use serde_json::{Value, json};

/// Bytes of a number, and of the length in front.
const WORD: usize = 4;

/// Arrays that are gathered while the JSON that names them is made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Packet {
    numbers: Vec<f32>,
}

impl Packet {
    /// Takes an array up, and gives what stands for it in the JSON.
    ///
    /// # Arguments
    /// * `values` - its numbers; what is not finite stays so, and is drawn as a gap
    pub fn array(&mut self, values: impl IntoIterator<Item = f64>) -> Value {
        let at = self.numbers.len();
        self.numbers.extend(values.into_iter().map(|value| value as f32));
        json!({ "array_at": at, "length": self.numbers.len() - at })
    }

    /// The bytes.
    ///
    /// # Arguments
    /// * `said` - the JSON
    ///
    /// ```
    /// use meshtone_explore::Packet;
    ///
    /// let mut packet = Packet::default();
    /// let force_n = packet.array([1.0, 2.0]);
    /// let bytes = packet.bytes(&serde_json::json!({ "force_n": force_n }));
    /// let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    /// assert_eq!(length % 4, 0);
    /// assert_eq!(bytes.len(), 4 + length + 2 * 4);
    /// ```
    pub fn bytes(&self, said: &Value) -> Vec<u8> {
        let mut text = said.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(WORD), b' ');
        let mut bytes = Vec::with_capacity(WORD + text.len() + WORD * self.numbers.len());
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text);
        bytes.extend(self.numbers.iter().flat_map(|number| number.to_le_bytes()));
        bytes
    }
}
