//! `meshtone completions`

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::Arguments;
use crate::failure::Failure;
use crate::terminal;

/// Print the completion script of a shell
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  meshtone completions bash > ~/.local/share/bash-completion/completions/meshtone
  meshtone completions zsh > ~/.zfunc/_meshtone          a folder of your $fpath
  meshtone completions fish > ~/.config/fish/completions/meshtone.fish";

impl Completions {
    pub fn run(&self) -> Result<(), Failure> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "meshtone", &mut text);
        terminal::print(&String::from_utf8_lossy(&text))
    }
}
