//! The limit of memory.

use std::sync::atomic::{AtomicU64, Ordering};

/// (bytes) Most memory that one simulation, or what is read of one file, may take unless another limit is
/// [set](MemoryLimit::set): 8 GiB. A scenario that needs more most likely has a typing error in a tooth count, a speed or a sampling rate.
pub const MEMORY_LIMIT_BYTES: u64 = 8 << 30;

/// (bytes) What was set for the whole program; 0 for nothing.
static OF_PROGRAM: AtomicU64 = AtomicU64::new(0);

/// Limit of the memory for a simulation, or for what is read from a file, and its reason.
///
/// ```
/// use meshtone::scenario::{MEMORY_LIMIT_BYTES, MemoryLimit};
///
/// assert_eq!(MemoryLimit::Machine { free_bytes: 1 << 30 }.bytes(), 1 << 30);
/// assert_eq!(MemoryLimit::Machine { free_bytes: 1 << 40 }.bytes(), MEMORY_LIMIT_BYTES);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MemoryLimit {
    /// A limit by itself. The default is what was [set](MemoryLimit::set), or else [`MEMORY_LIMIT_BYTES`].
    Given {
        /// (bytes) The limit.
        bytes: u64,
    },
    /// The free memory of the machine that simulates, at most [`MEMORY_LIMIT_BYTES`].
    Machine {
        /// (bytes) Free memory.
        free_bytes: u64,
    },
}

impl Default for MemoryLimit {
    fn default() -> Self {
        Self::of_program().unwrap_or(Self::Given { bytes: MEMORY_LIMIT_BYTES })
    }
}

impl MemoryLimit {
    /// Sets the limit of the whole program, whose memory is one: for everything that is checked from then on without a limit of
    /// its own.
    ///
    /// # Arguments
    /// * `bytes` - (bytes) the limit, above 0; none for the default
    ///
    /// ```
    /// use meshtone::scenario::{MEMORY_LIMIT_BYTES, MemoryLimit};
    ///
    /// MemoryLimit::set(Some(2 << 30));
    /// assert_eq!(MemoryLimit::default().bytes(), 2 << 30);
    /// MemoryLimit::set(None);
    /// assert_eq!(MemoryLimit::default().bytes(), MEMORY_LIMIT_BYTES);
    /// ```
    pub fn set(bytes: Option<u64>) {
        OF_PROGRAM.store(bytes.unwrap_or(0), Ordering::Relaxed);
    }

    /// The limit that was set for the whole program, if one was.
    pub fn of_program() -> Option<Self> {
        let bytes = OF_PROGRAM.load(Ordering::Relaxed);
        (bytes > 0).then_some(Self::Given { bytes })
    }

    /// Objection to something that needs more; none where it does not.
    ///
    /// # Arguments
    /// * `needed_bytes` - (bytes) what it takes
    ///
    /// ```
    /// use meshtone::scenario::MemoryLimit;
    ///
    /// let limit = MemoryLimit::Given { bytes: 1 << 30 };
    /// assert_eq!(limit.objection(1 << 30), None);
    /// assert_eq!(limit.objection(3 << 30).unwrap(), "would take 3.0 GiB of memory; at most 1.0 GiB are allowed");
    /// ```
    pub fn objection(self, needed_bytes: u64) -> Option<String> {
        (needed_bytes > self.bytes())
            .then(|| format!("would take {} of memory; {}", in_words(needed_bytes), self.allows()))
    }

    /// (bytes) The limit.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Given { bytes } => bytes,
            Self::Machine { free_bytes } => free_bytes.min(MEMORY_LIMIT_BYTES),
        }
    }

    /// The limit, for a message about a simulation that needs more.
    pub(super) fn allows(self) -> String {
        let most = in_words(self.bytes());
        match self {
            Self::Machine { free_bytes } if free_bytes <= MEMORY_LIMIT_BYTES => {
                format!("only {most} are free on this machine")
            }
            Self::Machine { free_bytes } => {
                format!(
                    "at most {most} are allowed, of the {} that are free on this machine",
                    in_words(free_bytes)
                )
            }
            Self::Given { .. } => format!("at most {most} are allowed"),
        }
    }
}

/// An amount of memory as one reads it.
pub(super) fn in_words(bytes: u64) -> String {
    let mebibytes = bytes as f64 / (1u64 << 20) as f64;
    let gibibytes = mebibytes / 1024.0;
    match gibibytes {
        _ if bytes == u64::MAX => "more than 1e10 GiB".to_string(),
        _ if gibibytes >= 1e6 => format!("{gibibytes:.1e} GiB"),
        _ if gibibytes >= 1.0 => format!("{gibibytes:.1} GiB"),
        _ => format!("{mebibytes:.1} MiB"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_allowed_names_the_machine_only_where_it_is_known() {
        assert_eq!(MemoryLimit::default().allows(), "at most 8.0 GiB are allowed");
        let machine = |free_bytes| MemoryLimit::Machine { free_bytes }.allows();
        assert_eq!(machine(3 << 29), "only 1.5 GiB are free on this machine");
        assert_eq!(machine(100 << 20), "only 100.0 MiB are free on this machine");
        assert_eq!(
            machine(20 << 30),
            "at most 8.0 GiB are allowed, of the 20.0 GiB that are free on this machine"
        );
    }

    #[test]
    fn amounts_of_any_size_are_short() {
        assert_eq!(in_words(u64::MAX), "more than 1e10 GiB");
        assert_eq!(in_words(1 << 60), "1.1e9 GiB");
    }
}
