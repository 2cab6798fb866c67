//! URLs of directories on this machine.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;

/// Returns whether a text can stand before the `://` of a URL (RFC 3986, section 3.1).
pub(super) fn is_scheme(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

/// The path that stands behind `file://`; none where another machine is named before it.
pub(super) fn path(behind: &str) -> Option<PathBuf> {
    let behind = behind.split(['?', '#']).next()?;
    let path = behind.strip_prefix("localhost").unwrap_or(behind);
    path.starts_with('/').then(|| native(percent_decode_str(path).collect()))?
}

/// Names of files are bytes.
#[cfg(unix)]
fn native(path: Vec<u8>) -> Option<PathBuf> {
    use std::ffi::OsString;
    use std::os::unix::ffi::OsStringExt;

    Some(PathBuf::from(OsString::from_vec(path)))
}

/// Before the letter of a drive stands a `/` in a URL.
#[cfg(not(unix))]
fn native(path: Vec<u8>) -> Option<PathBuf> {
    let path = String::from_utf8(path).ok()?;
    let with_drive = path[1..].split('/').next().is_some_and(|first| first.ends_with(':'));
    Some(PathBuf::from(if with_drive { &path[1..] } else { &path }))
}

#[cfg(test)]
mod tests {
    use super::{is_scheme, path};

    #[test]
    #[cfg(unix)]
    fn directories_of_this_machine_have_a_path() {
        for (behind, expected) in [
            ("/tmp/gears", Some("/tmp/gears")),
            ("localhost/tmp/gears/", Some("/tmp/gears/")),
            ("/tmp/two%20words/%C3%A4", Some("/tmp/two words/ä")),
            ("/tmp/gears?part=1#first", Some("/tmp/gears")),
            ("other/tmp/gears", None),
            ("localhosts/tmp", None),
            ("", None),
        ] {
            assert_eq!(path(behind).as_deref(), expected.map(std::path::Path::new), "{behind}");
        }
    }

    #[test]
    fn schemes_are_known() {
        assert!(["s3", "https", "a+b-c.d"].into_iter().all(is_scheme));
        assert!(!["", "3s", "s 3", "ä"].into_iter().any(is_scheme));
    }
}
