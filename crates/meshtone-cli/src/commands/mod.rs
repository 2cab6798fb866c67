//! The commands, one file each.

mod adapt;
mod bench;
mod completions;
mod dataset;
mod diagnose;
mod enhance;
#[cfg(feature = "explore")]
mod explore;
mod indicators;
mod init;
mod panel;
mod path;
mod simulate;
mod tune;
mod wheels;

use clap::Subcommand;

use crate::failure::Failure;

/// A command with its arguments.
#[derive(Debug, Subcommand)]
pub enum Command {
    Simulate(simulate::Simulate),
    // These have many more options than the others.
    Indicators(Box<indicators::Indicators>),
    Diagnose(Box<diagnose::Diagnose>),
    Path(Box<path::Path>),
    Adapt(Box<adapt::Adapt>),
    #[cfg(feature = "explore")]
    Explore(explore::Explore),
    Init(init::Init),
    Wheels(wheels::Wheels),
    Panel(panel::Panel),
    Tune(tune::Tune),
    Enhance(enhance::Enhance),
    Dataset(dataset::Dataset),
    Bench(bench::Bench),
    Completions(completions::Completions),
}

impl Command {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Simulate(arguments) => arguments.run(),
            Self::Indicators(arguments) => arguments.run(),
            Self::Diagnose(arguments) => arguments.run(),
            Self::Path(arguments) => arguments.run(),
            Self::Adapt(arguments) => arguments.run(),
            #[cfg(feature = "explore")]
            Self::Explore(arguments) => arguments.run(),
            Self::Init(arguments) => arguments.run(),
            Self::Wheels(arguments) => arguments.run(),
            Self::Panel(arguments) => arguments.run(),
            Self::Tune(arguments) => arguments.run(),
            Self::Enhance(arguments) => arguments.run(),
            Self::Dataset(arguments) => arguments.run(),
            Self::Bench(arguments) => arguments.run(),
            Self::Completions(arguments) => arguments.run(),
        }
    }
}
