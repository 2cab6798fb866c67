//! The program `meshtone`.
//!
//! Exit codes: 0, 1 (something failed, such as a full disk, or may not be written) or 2 (bad input: a scenario, an argument, a name
//! that leads nowhere, a file that cannot be read).

mod bench;
mod check;
mod choice;
mod commands;
mod diagnose;
mod experiment_files;
mod failure;
mod healthy;
mod indicators;
mod other_kind;
mod other_option;
mod output_directory;
mod progress;
mod replacement;
mod report;
mod results;
mod same_file;
mod shown;
mod table;
mod terminal;
mod termination;
mod warnings;

use std::process::ExitCode;

use clap::Parser;
use meshtone::InstructionSet;
use meshtone::scenario::MemoryLimit;
use meshtone_io::memory::parse_bytes;

use crate::commands::Command;
use crate::failure::Failure;

/// Simulates the vibration of gears, healthy or with damaged teeth, and computes indicators of
/// recordings.
#[derive(Debug, Parser)]
#[command(name = "meshtone", version, after_help = examples(), arg_required_else_help = true)]
struct Arguments {
    /// Most memory for one simulation, and for what is read of one file, such as 2GB. [default: what is free, at most 8GiB]
    #[arg(long, global = true, value_name = "SIZE", value_parser = parse_bytes)]
    memory_limit: Option<u64>,
    #[command(subcommand)]
    command: Command,
}

impl Arguments {
    fn run(&self) -> Result<(), Failure> {
        MemoryLimit::set(self.memory_limit);
        InstructionSet::from_environment().map_err(|error| Failure::bad_input(error.to_string()))?;
        self.command.run()
    }
}

const EXAMPLES: &str = "\
Examples:
  meshtone init tooth-breakage > broken.toml   a commented scenario file to start from
  meshtone simulate broken.toml -o broken      signals, summary and results panel in the folder broken
  meshtone explore broken.toml                 change it on a page in the browser and see the effect
  meshtone indicators broken                   their condition indicators, as of any recording
  meshtone diagnose run.csv --scenario rig.toml   kinds of damage of the gear, with their probabilities
  meshtone dataset plan.toml -o gears          a labelled data set (a plan: meshtone init dataset)
  meshtone simulate --help                     more on one command

Exit codes: 0 success, 1 the command could not be carried out, 2 the input is wrong.";

/// The examples, without the page's where this build has no page.
fn examples() -> String {
    let is_there = |line: &&str| cfg!(feature = "explore") || !line.contains("meshtone explore");
    EXAMPLES.split_inclusive('\n').filter(is_there).collect()
}

fn main() -> ExitCode {
    let arguments = Arguments::try_parse();
    let arguments = arguments.or_else(|error| -> Result<_, Failure> {
        // Help and the version are printed.
        if error.exit_code() == 0 {
            terminal::check_output()?;
        }
        other_option::with_tip(error, std::env::args_os()).exit()
    });
    termination::remove_unfinished_files_at_end();
    match arguments.and_then(|arguments| arguments.run()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let code = ExitCode::from(failure.exit_code);
            report::print(&failure);
            code
        }
    }
}
