//! Which files belong to one run.

use std::fmt;
use std::str::FromStr;

use meshtone::scenario::Scenario;

/// What every file of a run carries, so that files of different runs can be distinguished.
///
/// A fingerprint of all that the results depend on: the scenario, with its model, its seed and everything that it
/// takes from other files, and the version of Meshtone. The same scenario simulated again with the same version has
/// the same identity, as it has the same results. Written as 16 hexadecimal digits.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
/// use meshtone_io::run_identity::RunIdentity;
///
/// let scenario = Scenario::new(GearPair::example());
/// let other = scenario.clone().with_seed(2);
/// let run = RunIdentity::of(&scenario);
/// assert_eq!(run, RunIdentity::of(&scenario));
/// assert_ne!(run, RunIdentity::of(&other));
/// assert_eq!(run.to_string().parse(), Ok(run));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RunIdentity(u64);

/// A text that is no [`RunIdentity`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no run's identity; must be 16 hexadecimal digits")]
pub struct ParseRunError(String);

const DIGITS: usize = 16;

impl RunIdentity {
    /// The identity of a scenario's run by this version of Meshtone.
    ///
    /// # Arguments
    /// * `scenario` - what is simulated, as the user asked for it
    pub fn of(scenario: impl Into<Scenario>) -> Self {
        Self::of_toml(&scenario.into().to_toml())
    }

    /// The identity of the run of a scenario or a gearbox that is given as a text.
    ///
    /// # Arguments
    /// * `toml` - what is simulated, with everything that it takes from other files
    pub fn of_toml(toml: &str) -> Self {
        // No text of a scenario contains the byte 0, which keeps them apart.
        let physics = meshtone::PHYSICS_VERSION.to_string();
        let text = [env!("CARGO_PKG_VERSION"), &physics, toml].join("\0");
        Self(fnv_1a(text.as_bytes()))
    }

    /// The identity as a number, for files that hold only numbers.
    pub fn number(self) -> u64 {
        self.0
    }
}

impl fmt::Display for RunIdentity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:0DIGITS$x}", self.0)
    }
}

impl FromStr for RunIdentity {
    type Err = ParseRunError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let digits = text.len() == DIGITS && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = digits.then(|| u64::from_str_radix(text, 16).ok()).flatten();
        number.map(Self).ok_or_else(|| ParseRunError(text.to_string()))
    }
}

/// The hash FNV-1a of 64 bits: two runs are confused by chance once in 2⁶⁴, and a forged one is of no use.
///
/// # Arguments
/// * `bytes` - what is hashed
///
/// Source: G. Fowler, L. Noll, K.-P. Vo, D. Eastlake, "The FNV Non-Cryptographic Hash Algorithm", RFC 9923.
pub fn fnv_1a(bytes: &[u8]) -> u64 {
    const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    bytes.iter().fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;

    // The test vectors that the hash's authors give.
    #[test]
    fn known_hashes() {
        assert_eq!(fnv_1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv_1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv_1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn identities_are_written_with_all_their_digits() {
        let small = RunIdentity(0x2a);
        assert_eq!(small.to_string(), "000000000000002a");
        assert_eq!(small.to_string().parse(), Ok(small));
        for wrong in ["", "2a", "+00000000000002a", "000000000000002g", "000000000000002a0"] {
            assert_eq!(wrong.parse::<RunIdentity>(), Err(ParseRunError(wrong.to_string())));
        }
    }
}
