//! `meshtone init`

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use meshtone::scenario::{
    GearboxRig, gearbox_template, gearbox_template_of_all_keys, template, template_kinds,
    template_of_all_keys,
};
use meshtone_dataset::plan;
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::{experiment, recording_files};

use crate::experiment_files;
use crate::failure::Failure;
use crate::progress;
use crate::replacement::stage_text;
use crate::terminal;

/// The kind that is a data set's plan and no scenario.
const DATASET: &str = "dataset";
/// The kind that is a gearbox.
const GEARBOX: &str = "gearbox";
/// The kind that is an experiment.
const EXPERIMENT: &str = "experiment";

/// The kind that is a folder of recordings.
const RECORDINGS: &str = "recordings";

/// Print a commented scenario file to start from, a gearbox, a data set's plan, or an experiment to tune by; or write recordings to try
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Init {
    /// A healthy pair, or a kind of damage, on the gear's first tooth; a gearbox; the plan of a data set; an experiment; or recordings of
    /// simulated machines, to try the other commands on
    #[arg(default_value = "healthy", value_parser = PossibleValuesParser::new(template_kinds().into_iter().chain([GEARBOX, DATASET, EXPERIMENT, RECORDINGS])))]
    kind: String,
    /// Print every key of a scenario with its meaning, unit and default, instead of those that matter
    #[arg(long)]
    all: bool,
    /// Print the published data of a rig with a gearbox; assumptions are marked
    #[arg(long, value_name = "RIG", value_parser = PossibleValuesParser::new(GearboxRig::ALL.map(GearboxRig::name)))]
    rig: Option<String>,
    /// Print the plan of a data set of a gearbox, instead of one pair
    #[arg(long)]
    gearbox: bool,
    /// Print the plan of a data set of a planetary set
    #[arg(long, conflicts_with = "gearbox")]
    planetary: bool,
    /// Write the files that an experiment names beside it: its scenario, and recordings of a simulated rig
    #[arg(long, requires = "output")]
    files: bool,
    /// File to write, instead of standard output; of recordings the folder [default: recordings]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

const EXAMPLES: &str = "\
Examples:
  meshtone init
  meshtone init healthy --all
  meshtone init tooth-breakage -o broken.toml
  meshtone init gearbox -o gearbox.toml
  meshtone init gearbox --rig phm2009-spur
  meshtone init gearbox --all
  meshtone init dataset -o plan.toml
  meshtone init dataset --gearbox -o plan.toml
  meshtone init dataset --planetary -o plan.toml
  meshtone init experiment --files -o experiment.toml   with recordings, for `meshtone tune experiment.toml`
  meshtone init recordings                              a folder of recordings, with a list of what is in them";

impl Init {
    pub fn run(&self) -> Result<(), Failure> {
        let unknown = || Failure::bad_input(format!("there is no template {}", self.kind));
        self.refuse_needless()?;
        if self.kind == RECORDINGS {
            return self.write_recordings();
        }
        let rig = GearboxRig::ALL.into_iter().find(|rig| self.rig.as_deref() == Some(rig.name()));
        let text = match self.kind.as_str() {
            GEARBOX if self.all => {
                gearbox_template_of_all_keys(rig).map_err(|error| Failure::bad_input(error.to_string()))?
            }
            GEARBOX => gearbox_template(rig),
            DATASET if self.gearbox => plan::gearbox_template(),
            DATASET if self.planetary => plan::planetary_template(),
            DATASET => plan::template().to_owned(),
            EXPERIMENT => experiment::template().to_owned(),
            kind if self.all => template_of_all_keys(kind).ok_or_else(unknown)?,
            kind => template(kind).ok_or_else(unknown)?,
        };
        match &self.output {
            None => terminal::print(&text),
            Some(path) => self.write(path, &text),
        }
    }

    /// Refuses options that belong to another kind.
    fn refuse_needless(&self) -> Result<(), Failure> {
        let is_scenario = ![DATASET, EXPERIMENT, RECORDINGS].contains(&self.kind.as_str());
        let is_written = self.output.is_some() || self.kind == RECORDINGS;
        let options = [
            ("--force", self.force, is_written, "only a file that is written with -o is replaced"),
            ("--rig", self.rig.is_some(), self.kind == GEARBOX, "only a gearbox has published rigs"),
            ("--files", self.files, self.kind == EXPERIMENT, "only an experiment names files"),
            ("--gearbox", self.gearbox, self.kind == DATASET, "only a data set is of a pair or of a gearbox"),
            ("--planetary", self.planetary, self.kind == DATASET, "only a data set has a plan"),
            ("--all", self.all, is_scenario, "only a scenario has a longer form"),
        ];
        match options.into_iter().find(|(_, is_given, fits, _)| *is_given && !fits) {
            None => Ok(()),
            Some((option, .., why)) => {
                let problem = format!("{option}: given with {}; {why}", self.kind);
                Failure::refuse(problem, format!("leave {option} out, or name another kind"))
            }
        }
    }

    /// Writes the file, and those that it names where they are asked for: all or none.
    fn write(&self, path: &Path, text: &str) -> Result<(), Failure> {
        let directory = path.parent().filter(|_| self.files);
        let named: Vec<PathBuf> = directory.into_iter().flat_map(experiment_files::paths).collect();
        let of_experiment = path.parent().filter(|_| self.kind == EXPERIMENT).into_iter();
        if of_experiment.flat_map(experiment_files::paths).any(|file| file == *path) {
            let problem = format!("-o {}: is the name of a file that the experiment needs", path.display());
            return Failure::refuse(
                problem,
                "write the experiment under another name, such as experiment.toml",
            );
        }
        let exists = |path: &PathBuf| !self.force && path.exists();
        if let Some(earlier) = named.into_iter().chain([path.to_owned()]).find(exists) {
            return Err(already_exists(&earlier));
        }
        let mut staged = directory.map(experiment_files::stage).transpose()?.unwrap_or_default();
        staged.push(stage_text(path, text)?);
        self.commit(staged)
    }

    /// Simulates the recordings and writes them into their folder: all or none.
    fn write_recordings(&self) -> Result<(), Failure> {
        let directory = self.output.as_deref().unwrap_or(Path::new(RECORDINGS));
        let list = directory.join(recording_files::LIST);
        let cannot = |error: std::io::Error| {
            let problem = format!("cannot use {} as a folder: {error}", directory.display());
            Failure::of_writing(error.kind(), problem).with_help("name another folder with -o")
        };
        std::fs::create_dir_all(directory).map_err(cannot)?;
        if !self.force && std::fs::read_dir(directory).map_err(cannot)?.next().is_some() {
            return Failure::refuse(
                format!("{} has files in it", directory.display()),
                "name another folder with -o, or replace files of these names with --force",
            );
        }
        let message = format!("simulating recordings for {}", directory.display());
        let files = progress::with_spinner(message, true, recording_files::recording_files);
        let stage = |(name, bytes): (String, Vec<u8>)| {
            StagedFile::write(&directory.join(name), |file| file.write_all(&bytes))
        };
        let staged = files.map_err(|error| Failure::failed(error.to_string()))?.into_iter().map(stage);
        self.commit(staged.collect::<Result<_, _>>()?)?;
        terminal::print(&format!("{}: what is in the recordings beside it\n", list.display()))
    }

    /// Gives staged files their names; without `--force` none that another file has.
    fn commit(&self, staged: Vec<StagedFile>) -> Result<(), Failure> {
        if self.force {
            return Ok(staged.into_iter().try_for_each(StagedFile::commit)?);
        }
        staged.into_iter().try_for_each(|file| {
            let path = file.path.clone();
            file.commit_new().map_err(|error| match error.source.kind() {
                ErrorKind::AlreadyExists => already_exists(&path),
                _ => error.into(),
            })
        })
    }
}

fn already_exists(path: &Path) -> Failure {
    Failure::bad_input(format!("{} exists already", path.display()))
        .with_help("name another file with -o, or replace it with --force")
}
