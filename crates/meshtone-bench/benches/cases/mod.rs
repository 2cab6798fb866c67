//! The scenarios that are timed: the examples, one for each fault, 17/38 teeth at 40 Hz.
#![allow(dead_code, clippy::expect_used)]

use meshtone::scenario::{Model, Scenario};

/// Name and scenario file of every example.
const EXAMPLES: [(&str, &str); 6] = [
    ("healthy", include_str!("../../../../examples/healthy.toml")),
    ("missing-tooth", include_str!("../../../../examples/missing_tooth.toml")),
    ("tooth-breakage", include_str!("../../../../examples/tooth_breakage.toml")),
    ("partial-face", include_str!("../../../../examples/partial_face.toml")),
    ("through-face", include_str!("../../../../examples/through_face.toml")),
    ("tooth-destruction", include_str!("../../../../examples/tooth_destruction.toml")),
];

/// Every example, with its full settling: 490 960 steps.
pub fn with_full_settling(model: Model) -> Vec<(&'static str, Scenario)> {
    EXAMPLES
        .iter()
        .map(|(name, text)| {
            let mut scenario = Scenario::from_toml(text).expect("an example is valid");
            scenario.model = model;
            scenario.solver.settle_tolerance = 0.0;
            (*name, scenario)
        })
        .collect()
}

/// The healthy example, with its full settling.
pub fn healthy(model: Model) -> Scenario {
    with_full_settling(model).swap_remove(0).1
}
