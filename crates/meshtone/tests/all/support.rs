//! What the tests of scenario files share.
#![allow(clippy::expect_used)]

use meshtone::scenario::{Scenario, ScenarioError};

/// The required keys; `[gears]` is line 1, `[operation]` line 6, and the text ends after line 8.
pub const REQUIRED: &str = "[gears]\nmodule_mm = 3.0\npinion_teeth = 17\ngear_teeth = 38\nface_width_mm = 15.0\n\
                            [operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 10.0\n";

/// The required keys with one line replaced by another.
pub fn replaced(old: &str, new: &str) -> String {
    assert!(REQUIRED.contains(old), "{old}");
    REQUIRED.replace(old, new)
}

/// The required keys with further keys of `[gears]`, from line 6 on.
pub fn gears(keys: &str) -> String {
    replaced("[operation]", &format!("{keys}\n[operation]"))
}

/// The required keys and more: keys of `[operation]`, or sections, from line 9 on.
pub fn appended(text: &str) -> String {
    format!("{REQUIRED}{text}\n")
}

/// Asserts that a text is refused for `key` on `line`, in words that contain all of `words`.
#[track_caller]
pub fn assert_refused(text: &str, key: &str, line: usize, words: &[&str]) -> ScenarioError {
    let error = Scenario::from_toml(text).expect_err("must be refused");
    assert_eq!((error.key.as_str(), error.line), (key, Some(line)), "{error} in\n{text}");
    let message = format!("{error} {}", error.help.as_deref().unwrap_or_default());
    for word in words {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
    error
}
