//! `meshtone completions`

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;
use clap_mangen::Man;

use crate::Arguments;
use crate::failure::Failure;
use crate::terminal;

/// Print the completion script of a shell, or the manual page
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Completions {
    /// The shell; `man`: the manual page
    #[arg(value_parser = kinds())]
    kind: String,
}

const EXAMPLES: &str = "\
Examples:
  meshtone completions bash > ~/.local/share/bash-completion/completions/meshtone
  meshtone completions zsh > ~/.zfunc/_meshtone          a folder of your $fpath
  meshtone completions fish > ~/.config/fish/completions/meshtone.fish
  meshtone completions man > ~/.local/share/man/man1/meshtone.1";

const MANUAL: &str = "man";

/// Names of the shells, and of the manual page.
fn kinds() -> PossibleValuesParser {
    let shells = Shell::value_variants().iter().filter_map(Shell::to_possible_value);
    PossibleValuesParser::new(shells.chain([PossibleValue::new(MANUAL)]))
}

impl Completions {
    pub fn run(&self) -> Result<(), Failure> {
        let mut program = Arguments::command();
        let mut text = Vec::new();
        match Shell::from_str(&self.kind, false) {
            Ok(shell) => clap_complete::generate(shell, &mut program, "meshtone", &mut text),
            Err(_) => manual(program, &mut text).map_err(|error| Failure::failed(error.to_string()))?,
        }
        terminal::print(&String::from_utf8_lossy(&text))
    }
}

/// The manual page of the program, with a section for each command.
fn manual(mut program: clap::Command, text: &mut Vec<u8>) -> std::io::Result<()> {
    // Names are then those that are typed, such as `meshtone simulate`.
    program.build();
    let page = Man::new(program.clone()).manual("Meshtone");
    page.render_title(text)?;
    page.render_name_section(text)?;
    page.render_synopsis_section(text)?;
    page.render_description_section(text)?;
    page.render_options_section(text)?;
    for command in described(&program) {
        let name = command.get_bin_name().unwrap_or(command.get_name()).to_uppercase();
        let (page, mut sections) = (Man::new(command.clone()), Vec::new());
        page.render_synopsis_section(&mut sections)?;
        page.render_description_section(&mut sections)?;
        page.render_options_section(&mut sections)?;
        let sections = String::from_utf8_lossy(&sections).replace(".SH ", ".SS ");
        text.extend_from_slice(format!(".SH \"{name}\"\n{sections}").as_bytes());
    }
    page.render_extra_section(text)?;
    page.render_version_section(text)
}

/// All commands, those of commands behind them; without `help`.
fn described(program: &clap::Command) -> Vec<&clap::Command> {
    let own = program.get_subcommands().filter(|command| command.get_name() != "help");
    own.flat_map(|command| std::iter::once(command).chain(described(command))).collect()
}
