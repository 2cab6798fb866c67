//! The texts of a plan.

/// A text that belongs to a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanFile {
    /// Its name beside the data.
    pub name: &'static str,
    /// Its text.
    pub text: String,
}

impl PlanFile {
    /// Names that such files have: the plan, its base scenario, what was tuned.
    pub const NAMES: [&'static str; 3] = ["plan.toml", "scenario.toml", "tuned.toml"];
}
