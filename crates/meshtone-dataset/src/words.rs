//! Numbers in sentences.

/// `1 shard`, `2 shards`.
///
/// # Arguments
/// * `count` - how many
/// * `name` - of one of them
///
/// ```
/// assert_eq!(meshtone_dataset::counted(1, "shard"), "1 shard");
/// ```
pub fn counted(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}
