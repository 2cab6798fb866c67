//! Results that take the place of earlier ones, each file whole or not at all.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::thread;

use meshtone_io::atomic_file::{StagedFile, WriteFileError};
use meshtone_plot::{Figure, PlotError};

use crate::failure::Failure;

/// Writes a figure as SVG and PNG beside its targets.
///
/// # Arguments
/// * `directory`, `names` - the targets
/// * `figure` - what is drawn
pub fn stage_figure(directory: &Path, names: [&str; 2], figure: &Figure) -> Result<Vec<StagedFile>, Failure> {
    let [svg_path, png_path] = names.map(|name| directory.join(name));
    thread::scope(|scope| {
        // The PNG can be encoded while the SVG is written to the disk.
        let svg = scope.spawn(|| stage_text(&svg_path, figure.svg()));
        let png = figure.png().map_err(cannot_draw)?;
        let png = StagedFile::write(&png_path, |file| file.write_all(&png))?;
        let svg = svg.join().map_err(|_| Failure::failed("cannot write the figure"))??;
        Ok(vec![svg, png])
    })
}

/// Writes a text beside its target.
pub fn stage_text(path: &Path, text: &str) -> Result<StagedFile, WriteFileError> {
    StagedFile::write(path, |file| file.write_all(text.as_bytes()))
}

/// The failure of a figure that cannot be drawn.
pub fn cannot_draw(error: PlotError) -> Failure {
    Failure::failed(format!("cannot draw the figure: {error}"))
        .with_help("--no-figure writes the other results without it")
}

/// Folders of new results: in which they are gathered, are whole, and take their names.
const STAGES: [&str; 3] = [".meshtone-new", ".meshtone-whole", ".meshtone-naming"];

/// Gives files their names, in the place of earlier results.
///
/// No system renames several files at once. So all are gathered in a folder, whose renaming makes them the results: whoever writes there
/// next [finishes](finish) what was interrupted behind that.
///
/// # Arguments
/// * `directory` - of the results
/// * `names` - all files that may stand there, the main one first
/// * `earlier` - those of them that are an earlier run's
/// * `staged` - the new files
pub fn replace(
    directory: &Path,
    names: &[&str],
    earlier: &[&str],
    staged: Vec<StagedFile>,
) -> Result<(), WriteFileError> {
    finish(directory, names, earlier)?;
    let [gathered, whole, _] = STAGES.map(|stage| directory.join(stage));
    let failed = |source| WriteFileError { path: directory.to_path_buf(), source };
    let gather = |mut file: StagedFile| {
        file.path = gathered.join(file.path.file_name().unwrap_or_default());
        file.commit()
    };
    let _ = fs::remove_dir_all(&gathered);
    fs::create_dir(&gathered).map_err(failed)?;
    if let Err(error) = staged.into_iter().try_for_each(gather) {
        let _ = fs::remove_dir_all(&gathered);
        return Err(error);
    }
    fs::rename(&gathered, whole).map_err(failed)?;
    finish(directory, names, earlier).map(drop)
}

/// Gives results that are whole their names, where that was interrupted; interrupted itself, it can be done again. A directory without a
/// main file is one in which it was interrupted.
///
/// # Arguments
/// * `directory`, `names`, `earlier` - as of [`replace`]
///
/// Returns whether there was anything to do.
pub fn finish(directory: &Path, names: &[&str], earlier: &[&str]) -> Result<bool, WriteFileError> {
    let [_, whole, naming] = STAGES.map(|stage| directory.join(stage));
    let failed = |source| WriteFileError { path: directory.to_path_buf(), source };
    if whole.exists() {
        // Earlier files that have no successor would show something else. The main one goes last, as it says which they are.
        let is_obsolete = |name: &&&str| **name == names[0] || !whole.join(name).exists();
        let obsolete = earlier.iter().rev().filter(is_obsolete).map(|name| directory.join(name));
        obsolete.map(fs::remove_file).try_for_each(unless_absent).map_err(failed)?;
        fs::rename(&whole, &naming).map_err(failed)?;
    }
    if !naming.exists() {
        return Ok(false);
    }
    let take = |name: &&str| unless_absent(fs::rename(naming.join(name), directory.join(name)));
    names.iter().rev().try_for_each(take).and_then(|()| fs::remove_dir(&naming)).map_err(failed)?;
    Ok(true)
}

/// A result of which it is no error that a file does not exist.
fn unless_absent(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const NAMES: [&str; 3] = ["summary", "signals", "panel"];

    /// A run writes no panel, and is killed behind each step.
    #[test]
    fn a_run_killed_at_any_step_is_finished_or_was_none() {
        for done in 0..=6 {
            let directory = tempfile::tempdir().unwrap();
            let path = |name: &str| directory.path().join(name);
            let [gathered, whole, naming] = STAGES.map(path);
            NAMES.iter().chain(&["notes"]).for_each(|name| fs::write(path(name), "old").unwrap());
            fs::create_dir(&gathered).unwrap();
            NAMES[..2].iter().for_each(|name| fs::write(gathered.join(name), "new").unwrap());
            let steps: [&dyn Fn() -> io::Result<()>; 6] = [
                &|| fs::rename(&gathered, &whole),
                &|| fs::remove_file(path("panel")),
                &|| fs::remove_file(path("summary")),
                &|| fs::rename(&whole, &naming),
                &|| fs::rename(naming.join("signals"), path("signals")),
                &|| fs::rename(naming.join("summary"), path("summary")),
            ];
            steps[..done].iter().for_each(|step| step().unwrap());
            assert_eq!(finish(directory.path(), &NAMES, &NAMES).unwrap(), done > 0);
            let read = |name| fs::read_to_string(path(name)).unwrap();
            let expected = if done > 0 { "new" } else { "old" };
            assert_eq!(["signals", "summary", "notes"].map(read), [expected, expected, "old"], "{done}");
            assert_eq!(path("panel").exists(), done == 0);
            // The next run clears away what was not yet whole.
            let staged = stage_text(&path("summary"), "next").unwrap();
            replace(directory.path(), &NAMES, &NAMES, vec![staged]).unwrap();
            let mut left: Vec<_> =
                fs::read_dir(&directory).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            left.sort();
            assert_eq!((left, read("summary").as_str()), (vec!["notes".into(), "summary".into()], "next"));
        }
    }
}
