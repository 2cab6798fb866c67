//! The shell blocks of README and of the guide, in the order of its chapters, in one folder that is empty at first.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{PROGRAM, Workplace, program};

/// A block: the chapter, the line in it, what stands behind `sh` in its first line, and its commands.
struct Block {
    chapter: String,
    line: usize,
    mark: Option<String>,
    commands: String,
}

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src")
}

/// README, and the chapters of the guide as the summary of the book has them.
fn chapters() -> Vec<String> {
    let summary = fs::read_to_string(source().join("SUMMARY.md")).unwrap();
    let links =
        summary.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link.to_owned());
    let guide = links.filter(|link| link.starts_with("guide/"));
    std::iter::once("../../README.md".to_owned()).chain(guide).collect()
}

fn blocks() -> Vec<Block> {
    let mut blocks = Vec::new();
    for chapter in chapters() {
        let text = fs::read_to_string(source().join(&chapter)).unwrap();
        let mut lines = text.lines().enumerate();
        while let Some((line, opening)) = lines.next() {
            let mark = match opening.strip_prefix("```sh") {
                Some("") => None,
                Some(mark) if mark.starts_with(',') => Some(mark[1..].to_owned()),
                _ => continue,
            };
            let commands = lines.by_ref().map(|(_, text)| text).take_while(|text| *text != "```");
            let commands = commands.map(|text| format!("{text}\n")).collect();
            blocks.push(Block { chapter: chapter.clone(), line: line + 1, mark, commands });
        }
    }
    blocks
}

/// Runs the blocks that have no mark, and those of some marks.
fn run_blocks(marks: &[&str]) {
    let workplace = Workplace::new();
    fs::remove_file(workplace.path("fast.toml")).unwrap();
    let own = tempfile::tempdir().unwrap();
    // The program has a cache of its name beside other programs' caches, so the link to it has a folder of its own.
    let programs = own.path().join("programs");
    fs::create_dir(&programs).unwrap();
    std::os::unix::fs::symlink(PROGRAM, programs.join("meshtone")).unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    for Block { chapter, line, mark, commands } in blocks() {
        if mark.is_some_and(|mark| !marks.contains(&mark.as_str())) {
            continue;
        }
        let mut shell = Command::new("sh");
        shell.args(["-e", "-c", &commands]).current_dir(workplace.path("."));
        // As a terminal of some width, without colours; and nothing is kept in the home of whoever runs the tests.
        shell.envs(program().get_envs().filter_map(|(name, value)| Some((name, value?))));
        shell.env("PATH", &path).env("XDG_CACHE_HOME", own.path());
        let output = shell.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{chapter}, line {line}:\n{commands}{said}");
    }
}

#[test]
fn every_quick_block_runs() {
    run_blocks(&[]);
}

#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn every_block_runs() {
    run_blocks(&["slow"]);
}

/// A block that is `unrun` installs something, opens a browser, takes far over a quarter of an hour, or needs a cluster, a release or the
/// repository: whoever adds one counts it here.
#[test]
fn blocks_are_counted_by_their_marks() {
    let count = |mark: Option<&str>| blocks().iter().filter(|block| block.mark.as_deref() == mark).count();
    assert_eq!([None, Some("slow"), Some("unrun")].map(count), [13, 5, 9]);
    assert_eq!(blocks().len(), 27, "a mark is not known");
}
