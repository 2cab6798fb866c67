//! Results that take the place of earlier ones, each file whole or not at all.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
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

/// Gives files their names, in the place of earlier results.
///
/// The main file of the earlier results is removed first and that of these results is named last, so that a directory without
/// a main file is one in which a run was interrupted. Earlier files that have no successor are removed: they would show
/// something else.
///
/// # Arguments
/// * `directory` - of the results
/// * `names` - all files that may stand there, the main one first
/// * `staged` - the new files, without the main one
/// * `main` - the new main file
pub fn replace(
    directory: &Path,
    names: &[&str],
    staged: Vec<StagedFile>,
    main: StagedFile,
) -> Result<(), WriteFileError> {
    let has_successor = |path: &PathBuf| staged.iter().any(|file| file.path == *path);
    let paths = names.iter().map(|name| directory.join(name));
    paths.filter(|path| !has_successor(path)).try_for_each(remove)?;
    staged.into_iter().chain([main]).try_for_each(StagedFile::commit)
}

fn remove(path: PathBuf) -> Result<(), WriteFileError> {
    unless_absent(fs::remove_file(&path)).map_err(|source| WriteFileError { path, source })
}

/// A result of which it is no error that a file does not exist.
pub fn unless_absent(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })
}
