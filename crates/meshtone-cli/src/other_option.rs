//! Options that there are not, but that users may well try: what to write instead.

use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// The error with a tip, where an option is one of those.
///
/// # Arguments
/// * `error` - of the command line
/// * `arguments` - the command line
pub fn with_tip(mut error: clap::Error, arguments: impl Iterator<Item = OsString>) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument {
        return error;
    }
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else { return error };
    let arguments: Vec<String> = arguments.map(|argument| argument.to_string_lossy().into_owned()).collect();
    let command = arguments.iter().skip(1).find(|argument| !argument.starts_with('-'));
    let value = value(option, &arguments);
    let tip = match (option.as_str(), command.map(String::as_str)) {
        ("--shaft-rpm", _) | ("--rpm" | "--speed-rpm", Some("indicators")) => rpm_as_hz(&value),
        ("--rpm" | "--speed-rpm" | "--pinion-speed-rpm", _) => speed_of_scenario(&value),
        ("--seed", Some("dataset")) => seed_of("plan", &value),
        ("--seed", Some("simulate" | "explore" | "panel" | "wheels")) => seed_of("scenario", &value),
        _ => return error,
    };
    // What is only spelt like it would be a second tip.
    error.remove(ContextKind::SuggestedArg);
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    error
}

/// Value behind an option; empty where there is none.
fn value(option: &str, arguments: &[String]) -> String {
    let mut rest = arguments.iter().skip_while(|argument| argument.split('=').next() != Some(option));
    let named = rest.next().map(String::as_str).unwrap_or_default();
    match named.split_once('=') {
        Some((_, value)) => value.to_owned(),
        None => rest.next().cloned().unwrap_or_default(),
    }
}

fn rpm_as_hz(value: &str) -> String {
    let hz = in_hz(value);
    format!("speeds are in revolutions per second, a sixtieth of those per minute; write --shaft-hz {hz}")
}

fn speed_of_scenario(value: &str) -> String {
    let hz = in_hz(value);
    format!(
        "the speed is a key of the scenario, in revolutions per second; write pinion_speed_hz = {hz} below its [operation]"
    )
}

fn seed_of(file: &str, value: &str) -> String {
    let seed = value.parse::<u64>().map_or("N".to_owned(), |seed| seed.to_string());
    format!("the seed is a key of the {file}; write seed = {seed} there, above its first [section]")
}

fn in_hz(rpm: &str) -> String {
    let hz = rpm.parse().ok().filter(|rpm: &f64| rpm.is_finite() && *rpm > 0.0).map(|rpm| rpm / 60.0);
    hz.map_or("HZ".to_owned(), |hz| hz.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_what_stands_behind_the_option() {
        let of = |line: &str| value("--shaft-rpm", &line.split(' ').map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(of("meshtone indicators run.csv --shaft-rpm 1074 -q"), "1074");
        assert_eq!(of("meshtone indicators --shaft-rpm=1074 run.csv"), "1074");
        assert_eq!(of("meshtone indicators run.csv --shaft-rpm"), "");
        assert!(rpm_as_hz("1074").ends_with("--shaft-hz 17.9"));
    }
}
