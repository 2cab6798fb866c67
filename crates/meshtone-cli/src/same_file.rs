//! A test whether two names are one file's.

use std::path::{Path, PathBuf};

/// Returns whether two names are one file's, which need not exist yet. Where it cannot be found out they are taken for two.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    let same = |a: Option<PathBuf>, b: Option<PathBuf>| a.is_some() && a == b;
    same(place(a), place(b)) || same(a.canonicalize().ok(), b.canonicalize().ok())
}

/// The directory's one true name, and the file's in it: a file that is written takes the place of a symbolic link.
fn place(path: &Path) -> Option<PathBuf> {
    let directory = match path.parent()? {
        here if here.as_os_str().is_empty() => Path::new("."),
        directory => directory,
    };
    Some(directory.canonicalize().ok()?.join(path.file_name()?))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs;

    use super::*;

    #[test]
    fn names_of_one_file() {
        let directory = tempfile::tempdir().unwrap();
        let [file, other] = ["a.txt", "b.txt"].map(|name| directory.path().join(name));
        let around = directory.path().join("deep/../a.txt");
        fs::create_dir(directory.path().join("deep")).unwrap();
        for _ in 0..2 {
            assert!(is_same_file(&file, &around) && !is_same_file(&file, &other));
            fs::write(&file, "").unwrap();
        }
        let absent = directory.path().join("absent/a.txt");
        assert!(!is_same_file(&absent, &absent));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_and_what_it_leads_to() {
        let directory = tempfile::tempdir().unwrap();
        let [file, link] = ["a.txt", "link.txt"].map(|name| directory.path().join(name));
        fs::write(&file, "").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert!(is_same_file(&file, &link));
    }
}
