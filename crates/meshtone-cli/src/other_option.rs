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
    let tip = match option.as_str() {
        "--convention" => renamed_to_model(&value(option, arguments)),
        "--shaft-rpm" => rpm_as_hz(&value(option, arguments)),
        _ => return error,
    };
    // What is only spelt like it would be a second tip.
    error.remove(ContextKind::SuggestedArg);
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    error
}

/// What stands behind an option; nothing where nothing does.
fn value(option: &str, arguments: impl Iterator<Item = OsString>) -> String {
    let mut rest = arguments
        .map(|argument| argument.to_string_lossy().into_owned())
        .skip_while(|argument| argument.split('=').next() != Some(option));
    let named = rest.next().unwrap_or_default();
    match named.split_once('=') {
        Some((_, value)) => value.to_owned(),
        None => rest.next().unwrap_or_default(),
    }
}

fn renamed_to_model(value: &str) -> String {
    let model = if value == "published" { value } else { "linear" };
    format!("the option is called --model now; write --model {model}")
}

fn rpm_as_hz(value: &str) -> String {
    let hz = value.parse().ok().filter(|rpm: &f64| rpm.is_finite() && *rpm > 0.0).map(|rpm| rpm / 60.0);
    let hz = hz.map_or("HZ".to_owned(), |hz| hz.to_string());
    format!("speeds are in revolutions per second, a sixtieth of those per minute; write --shaft-hz {hz}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_what_stands_behind_the_option() {
        let of = |line: &str| value("--shaft-rpm", line.split(' ').map(OsString::from));
        assert_eq!(of("meshtone indicators run.csv --shaft-rpm 1074 -q"), "1074");
        assert_eq!(of("meshtone indicators --shaft-rpm=1074 run.csv"), "1074");
        assert_eq!(of("meshtone indicators run.csv --shaft-rpm"), "");
        assert!(rpm_as_hz("1074").ends_with("--shaft-hz 17.9"));
    }
}
