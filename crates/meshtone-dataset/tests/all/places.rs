//! What users write as the place of a data set.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use meshtone_dataset::DatasetError;
use meshtone_dataset::store::Destination;

#[test]
fn directories_are_named_plainly_or_as_urls() {
    for (text, path) in [
        ("gears", "gears"),
        ("./two words", "./two words"),
        ("file:///tmp/gears", "/tmp/gears"),
        ("FILE://localhost/tmp/two%20words", "/tmp/two words"),
    ] {
        assert_eq!(Destination::parse(text).unwrap().path(), Some(Path::new(path)), "{text}");
    }
}

#[test]
fn other_places_are_refused_with_what_to_do() {
    for (text, problem, help) in [
        ("file://server/gears", "names no directory of this machine", "file:///data/gears"),
        ("memory:///gears", "would be gone with the program", "name a directory"),
        ("://gears", "is no URL", "name a directory"),
        ("gopher://gears", "gopher://gears", ""),
    ] {
        let refused = Destination::parse(text).unwrap_err();
        assert!(refused.to_string().contains(problem), "{text}: {refused}");
        let DatasetError::Refused { help: given, .. } = refused else { unreachable!("{text}") };
        assert!(given.contains(help), "{text}: {given}");
    }
}

#[test]
#[cfg(not(feature = "objects"))]
fn a_build_without_object_stores_says_so() {
    for url in ["s3://bucket/gears", "gs://bucket/gears", "az://container/gears", "https://host/gears"] {
        let refused = Destination::parse(url).unwrap_err();
        assert!(
            refused.to_string().contains(&format!("this build has no object stores, such as that of {url}"))
        );
        let DatasetError::Refused { help, .. } = refused else { unreachable!("{url}") };
        assert!(help.contains("--features cloud"));
    }
}
