//! The shell blocks of the guide, in the order of its chapters, in one folder that is empty at first.
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

/// The chapters of the guide, as the summary of the book has them.
fn chapters() -> Vec<String> {
    let summary = fs::read_to_string(source().join("SUMMARY.md")).unwrap();
    let links =
        summary.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link.to_owned());
    links.filter(|link| link.starts_with("guide/")).collect()
}

fn blocks() -> Vec<Block> {
    let mut blocks = Vec::new();
    for chapter in chapters() {
        let text = fs::read_to_string(source().join(&chapter)).unwrap();
        let mut lines = text.lines().enumerate();
        while let Some((line, opening)) = lines.next() {
            let Some(mark) = opening.strip_prefix("```sh") else { continue };
            let mark = mark.strip_prefix(',').map(str::to_owned);
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
    std::os::unix::fs::symlink(PROGRAM, own.path().join("meshtone")).unwrap();
    let path = format!("{}:{}", own.path().display(), std::env::var("PATH").unwrap());
    let mut run = 0;
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
        run += 1;
    }
    assert!(run >= 10, "only {run} blocks were found");
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

/// What is not run says why by its kind: it installs something, opens a browser, or needs a cluster, a release or the repository.
#[test]
fn marks_are_known() {
    for Block { chapter, line, mark, .. } in blocks() {
        let is_known = mark.as_deref().is_none_or(|mark| ["slow", "unrun"].contains(&mark));
        assert!(is_known, "{chapter}, line {line}: {mark:?}");
    }
}
