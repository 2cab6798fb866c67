//! The simulations that a diagnosis compares with.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use meshtone::batch::Control;
use meshtone_diagnose::{
    Answer, Learned, Prior, Question, REFINED_RECORDS, ReferenceSet, ReferenceStore, diagnose, refine,
};

use crate::failure::Failure;
use crate::progress::with_bar;
use crate::terminal::print_error_line;

/// Where the simulations are kept, and how many there are.
#[derive(Debug, Args)]
pub struct ReferenceOptions {
    /// Folder in which the simulations are kept. [default: in the user's cache directory, see `meshtone diagnose --help`]
    #[arg(long, value_name = "DIR")]
    pub reference: Option<PathBuf>,
    /// Simulations to learn from, in batches of 512, up to 20480: twice as many take four times as long to compare
    #[arg(long, value_name = "N", default_value_t = ReferenceStore::USUAL_RECORDS,
        value_parser = clap::value_parser!(u64).range(ReferenceStore::BATCH..=ReferenceStore::MOST_RECORDS))]
    pub records: u64,
}

impl ReferenceOptions {
    /// Where simulations are kept.
    pub fn store(&self) -> Result<ReferenceStore, Failure> {
        let folder = self.reference.clone().or_else(ReferenceStore::default_folder).ok_or_else(|| {
            Failure::bad_input(
                "there is no folder for the simulations: the environment names no home directory",
            )
            .with_help("name one with --reference DIR")
        })?;
        Ok(ReferenceStore::new(folder))
    }

    /// The simulations of a rig, which are made where they are not there.
    ///
    /// # Arguments
    /// * `store` - where they are kept
    /// * `prior` - what may be about the rig
    /// * `of` - the rig in words
    /// * `quiet` - whether no progress is to be shown
    pub fn simulations(
        &self,
        store: &ReferenceStore,
        prior: &Prior,
        of: &str,
        quiet: bool,
    ) -> Result<ReferenceSet, Failure> {
        let (folder, since) = (store.folder_of(prior), Instant::now());
        let kept = fs::read_dir(&folder).map_or(0, Iterator::count) as u64;
        let shows_progress = !quiet && kept < self.records.div_ceil(ReferenceStore::BATCH);
        if shows_progress {
            // Also where no bar can be drawn.
            print_error_line(format_args!(
                "simulating {of} with every kind of damage, up to {} times; what is finished is kept in {}, also when stopped",
                self.records,
                folder.display()
            ));
        }
        let reference =
            simulate(self.records, "simulations", quiet, |control| store.get(prior, self.records, control))?;
        if shows_progress {
            print_error_line(format!("simulated in {:.0} s", since.elapsed().as_secs_f64()));
        }
        Ok(reference)
    }
}

/// Answers a question, with more simulations of what is likely.
///
/// # Arguments
/// * `reference` - simulations of the rig
/// * `question` - the recordings
/// * `quiet` - whether no progress is to be shown
pub fn answer(reference: &ReferenceSet, question: &Question, quiet: bool) -> Result<Answer, Failure> {
    let learned = Learned::new(reference, question)?;
    let simulations = "simulations, of the likeliest damage";
    let refined =
        simulate(REFINED_RECORDS, simulations, quiet, |control| refine(&learned, question, control))?;
    Ok(diagnose(&learned, question, refined.as_ref())?)
}

/// Simulates with a progress bar.
fn simulate<T>(length: u64, counted: &str, quiet: bool, simulate: impl FnOnce(&Control) -> T) -> T {
    with_bar(counted, !quiet, |show| {
        show(0, length);
        let progress = |finished: usize| show(finished as u64, length);
        simulate(&Control { progress: &progress, ..Control::default() })
    })
}
