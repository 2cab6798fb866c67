//! `meshtone explore`

use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use clap::Args;
use meshtone::scenario::{Scenario, template};
use meshtone_diagnose::ReferenceStore;
use meshtone_explore::{Embedding, Server, ServerSettings};
use meshtone_io::scenario_file::ScenarioFile;

use crate::failure::Failure;
use crate::terminal;

/// Change a scenario on a page in the browser and see the effect immediately
///
/// Serves the page on this machine alone, until Ctrl-C; it needs no network. Nothing is written except what the page's buttons export
/// (the scenario as TOML or Python, the picture as SVG, the signals as Parquet) and the simulations of a diagnosis, which are kept
/// where `meshtone diagnose` keeps them.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Explore {
    /// Scenario file to begin with, of a pair or of a gearbox. [default: the healthy pair that `meshtone init healthy` prints]
    #[arg(value_name = "SCENARIO.toml")]
    scenario: Option<PathBuf>,
    /// Port of 127.0.0.1 on which the page is served. [default: any that is free]
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address without opening it in the browser
    #[arg(long)]
    no_open: bool,
}

const EXAMPLES: &str = "\
Examples:
  meshtone explore                        a healthy pair to begin with
  meshtone explore broken.toml            begin with this scenario
  meshtone explore gearbox.toml           a gearbox, on a page of its own
  meshtone explore --port 8080 --no-open  print the address only";

impl Explore {
    pub fn run(&self) -> Result<(), Failure> {
        let settings = ServerSettings {
            scenario: self.scenario()?,
            port: self.port,
            embedding: Embedding::Refused,
            reference: ReferenceStore::default_folder(),
        };
        let server = Server::start(settings).map_err(|error| self.not_served(&error))?;
        let url = server.url();
        terminal::print(&format!(
            "{url}\nOnly this machine can open it, and only with this address. Ctrl-C ends it.\n"
        ))?;
        if !self.no_open {
            open(&url);
        }
        server.wait();
        Ok(())
    }

    fn scenario(&self) -> Result<Scenario, Failure> {
        match &self.scenario {
            Some(path) => Ok(ScenarioFile::read(path)?.scenario),
            None => {
                let healthy = template("healthy").unwrap_or_default();
                Scenario::from_toml(&healthy).map_err(|error| Failure::failed(error.to_string()))
            }
        }
    }

    fn not_served(&self, error: &std::io::Error) -> Failure {
        let problem = format!("--port {}: cannot serve a page there: {error}", self.port);
        match error.kind() {
            ErrorKind::AddrInUse | ErrorKind::PermissionDenied => Failure::bad_input(problem)
                .with_help("name another port, or leave --port out for any that is free"),
            _ => Failure::failed(problem),
        }
    }
}

/// Opens an address in the browser, where the system knows one; the address is printed all the same.
fn open(url: &str) {
    let (program, before): (_, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(before).arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Whoever has no such program reads the address.
    drop(command.spawn());
}
