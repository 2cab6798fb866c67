//! Wrong input from right input.

/// Draws that depend on a seed, a reader and the number of an input alone.
pub struct Draws(u64);

impl Draws {
    pub fn new(seed: u64, reader: &str, number: u64) -> Self {
        let mut draws = Self(seed);
        for part in reader.bytes().map(u64::from).chain([number]) {
            draws.0 = draws.next() ^ part;
        }
        draws
    }

    /// Source: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// From 0 to one less than `end`; 0 where that is 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn one_of<'a, T: ?Sized>(&mut self, all: &[&'a T]) -> &'a T {
        all[self.below(all.len())]
    }
}

/// What numbers are replaced by.
const NUMBERS: [&str; 22] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "7",
    "17",
    "1000000",
    "4294967295",
    "-2147483648",
    "9223372036854775807",
    "18446744073709551616",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "inf",
    "-inf",
    "nan",
    "1e999",
    "0x10",
];

/// What is put between or instead of other things.
const SNIPPETS: [&str; 24] = [
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "\\",
    "=",
    ",",
    ";",
    "\n",
    "\r\n",
    "\t",
    "#",
    "true",
    "[[fault]]\n",
    "\u{feff}",
    "\u{0}",
    "é",
    "\u{202e}",
    "''' ",
    "1979-05-27",
    "all",
    "null",
];

/// One to four changes of `seed`, one after the other.
///
/// # Arguments
/// * `seed` - a right input
/// * `other` - another one of the same reader
/// * `draws` - what is changed
pub fn mutated(seed: &[u8], other: &[u8], draws: &mut Draws) -> Vec<u8> {
    let mut input = seed.to_vec();
    for _ in 0..=draws.below(4) {
        let is_text = std::str::from_utf8(&input).is_ok();
        input = match draws.below(if is_text { 14 } else { 8 }) {
            0 => bits(input, draws),
            1 => run(input, draws),
            2 => cut(input, draws),
            3 => removed(input, draws),
            4 => repeated(input, draws),
            5 => spliced(&input, other, draws),
            6 => number_of_bytes(input, draws),
            7 => exchanged(input, draws),
            8..=10 => number(&input, draws),
            11 => word(&input, draws),
            12 => line(&input, draws),
            _ => snippet(input, draws),
        };
    }
    input
}

/// Some bits turned over.
fn bits(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    for _ in 0..=draws.below(8) {
        let at = draws.below(input.len());
        if let Some(byte) = input.get_mut(at) {
            *byte ^= 1 << draws.below(8);
        }
    }
    input
}

/// Some bytes all the same, which makes large numbers of lengths.
fn run(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let (from, to) = part(&input, 16, draws);
    let byte = [0, 0x7f, 0x80, 0xff][draws.below(4)];
    input[from..to].fill(byte);
    input
}

fn cut(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    input.truncate(draws.below(input.len() + 1));
    input
}

fn removed(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let (from, to) = part(&input, 1000, draws);
    input.drain(from..to);
    input
}

/// A part that stands there several times.
fn repeated(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let (from, to) = part(&input, 1000, draws);
    let again = input[from..to].repeat(1 + draws.below(40));
    input.splice(to..to, again);
    input
}

/// The start of one input and the end of another.
fn spliced(input: &[u8], other: &[u8], draws: &mut Draws) -> Vec<u8> {
    let (start, end) = (draws.below(input.len() + 1), draws.below(other.len() + 1));
    [&input[..start], &other[end..]].concat()
}

/// A whole number of four or eight bytes, or a floating-point one.
fn number_of_bytes(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let whole = [0, 1, 255, 1 << 16, (1 << 31) - 1, 1 << 32, 1 << 40, u64::MAX / 2, u64::MAX][draws.below(9)];
    let real = [f64::NAN, f64::INFINITY, -1.0, 1e308, 5e-324, 0.0][draws.below(6)];
    let bytes = if draws.below(3) == 0 { real.to_le_bytes() } else { whole.to_le_bytes() };
    let bytes = &bytes[..[2, 4, 8][draws.below(3)]];
    let at = draws.below(input.len().saturating_sub(bytes.len()));
    let end = (at + bytes.len()).min(input.len());
    input[at..end].copy_from_slice(&bytes[..end - at]);
    input
}

/// Two parts in each other's place.
fn exchanged(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let (from, to) = part(&input, 64, draws);
    let moved: Vec<u8> = input.drain(from..to).collect();
    let at = draws.below(input.len() + 1);
    input.splice(at..at, moved);
    input
}

/// A number of the text, replaced.
fn number(input: &[u8], draws: &mut Draws) -> Vec<u8> {
    let is_of_number = |byte: u8| byte.is_ascii_digit() || b".eE+-".contains(&byte);
    let with = draws.one_of(&NUMBERS).as_bytes();
    replaced(
        input,
        |token| is_of_number(token[0]) && token.iter().any(u8::is_ascii_digit),
        is_of_number,
        with,
        draws,
    )
}

/// A word of the text, replaced by another of its words or misspelt.
fn word(input: &[u8], draws: &mut Draws) -> Vec<u8> {
    let is_of_word = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_';
    let words: Vec<&[u8]> = input.split(|&byte| !is_of_word(byte)).filter(|word| word.len() > 2).collect();
    if words.is_empty() {
        return input.to_vec();
    }
    let mut with = draws.one_of(&words).to_vec();
    if draws.below(2) == 0 {
        let at = draws.below(with.len());
        with[at] = b'a' + draws.below(26) as u8;
    }
    replaced(input, |token| token.len() > 2 && is_of_word(token[0]), is_of_word, &with, draws)
}

/// One of the tokens of a text replaced by something else.
///
/// # Arguments
/// * `is_one` - whether a token may be
/// * `is_of` - whether a byte belongs to such tokens
/// * `with` - what it is replaced by
fn replaced(
    input: &[u8],
    is_one: impl Fn(&[u8]) -> bool,
    is_of: impl Fn(u8) -> bool,
    with: &[u8],
    draws: &mut Draws,
) -> Vec<u8> {
    let tokens: Vec<&[u8]> = input.chunk_by(|a, b| is_of(*a) && is_of(*b)).collect();
    let places: Vec<usize> = (0..tokens.len()).filter(|&place| is_one(tokens[place])).collect();
    let Some(&place) = places.get(draws.below(places.len())) else { return input.to_vec() };
    [tokens[..place].concat(), with.to_vec(), tokens[place + 1..].concat()].concat()
}

/// A line left out, doubled, or moved elsewhere.
fn line(input: &[u8], draws: &mut Draws) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = input.split_inclusive(|&byte| byte == b'\n').collect();
    let taken = draws.below(lines.len());
    if let Some(&line) = lines.get(taken) {
        if draws.below(2) == 0 {
            lines.remove(taken);
        }
        if draws.below(3) > 0 {
            lines.insert(draws.below(lines.len() + 1), line);
        }
    }
    lines.concat()
}

fn snippet(mut input: Vec<u8>, draws: &mut Draws) -> Vec<u8> {
    let (from, to) = part(&input, 3, draws);
    let from = if draws.below(2) == 0 { from } else { to };
    input.splice(from..to, draws.one_of(&SNIPPETS).bytes());
    input
}

/// Start and end of a part.
fn part(input: &[u8], longest: usize, draws: &mut Draws) -> (usize, usize) {
    let from = draws.below(input.len());
    (from, (from + 1 + draws.below(longest)).min(input.len()))
}
