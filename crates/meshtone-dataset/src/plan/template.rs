//! A commented plan to start from.

/// A commented plan: every key with its meaning.
///
/// ```
/// use std::path::Path;
/// use meshtone_dataset::plan::{Plan, template};
///
/// let plan = Plan::read_text(template().to_owned(), Path::new("plan.toml"))?;
/// assert_eq!(plan.records(), 600);
/// # Ok::<(), meshtone_io::scenario_file::ReadScenarioError>(())
/// ```
pub fn template() -> &'static str {
    include_str!("template.toml")
}
