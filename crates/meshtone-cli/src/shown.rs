//! What a command prints on standard output about what it has done.

use std::fmt::Display;

use clap::Args;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::terminal::print;

/// Whether numbers are printed as a table, as JSON or not at all.
#[derive(Debug, Args)]
pub struct Shown {
    /// Print no table and no progress; warnings and errors are still printed
    #[arg(short, long)]
    pub quiet: bool,
    /// Print the numbers as a line of JSON, in place of the table
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

impl Shown {
    /// Prints the numbers of a result, of which `output` in JSON says where its files are.
    ///
    /// # Arguments
    /// * `output` - the directory or the file that was written
    /// * `table` - for people
    /// * `numbers` - for programs, an object
    pub fn print(
        &self,
        output: &dyn Display,
        table: impl FnOnce() -> String,
        numbers: impl FnOnce() -> Value,
    ) -> Result<(), Failure> {
        if self.quiet {
            return Ok(());
        }
        if !self.json {
            return print(&table());
        }
        let mut numbers = numbers();
        numbers["output"] = json!(output.to_string());
        print(&format!("{numbers}\n"))
    }
}
