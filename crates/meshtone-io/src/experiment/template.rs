//! A commented experiment to start from.

/// A commented experiment file: every key with its meaning. It names files that a user has: `rig.toml` and recordings.
///
/// ```
/// assert!(meshtone_io::experiment::template().contains("[[case]]"));
/// ```
pub fn template() -> &'static str {
    include_str!("template.toml")
}
