//! `meshtone adapt`

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use meshtone::tuning::PathEstimate;
use meshtone_dataset::adapt::{AdaptSettings, Adaptation, KnownMachine, adapt, tooth_classes};
use meshtone_dataset::counted;
use meshtone_dataset::generate::GenerateControl;
use meshtone_dataset::store::Destination;

use super::dataset::warn_after_generating;
use crate::failure::Failure;
use crate::healthy::{HealthyMachine, HealthyRecordings};
use crate::progress::with_bar;
use crate::shown::Shown;
use crate::terminal::warn;

/// Make a labelled data set for a machine from its healthy recordings
///
/// Estimates from recordings of the healthy machine the path to the sensor, the wander of the speed, the random forces and the sidebands, as
/// `meshtone path` does, and simulates that machine with every class of damage. A classifier that is learnt from the simulations judges each window of
/// the healthy recordings beside the others: at most one in twenty of these, and of healthy simulations, is above its threshold. Machines that differ from the scenario, as real ones do,
/// are simulated too, and say what may be expected. Writes the data set, and adaptation.json beside it. An interrupted run goes on where it was.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Adapt {
    #[command(flatten)]
    healthy: HealthyRecordings,
    /// Classes beside the healthy one: kinds of damage, or outer, inner or element of a bearing, behind @ the wheel or the bearing's seat, such as
    /// pits@z3,outer@input:0; of a pair the gear's. [default: every kind on every wheel]
    #[arg(long, value_name = "CLASS,…", value_delimiter = ',')]
    classes: Vec<String>,
    /// Units, at least 16: pairs of wheels, or gearboxes, each with one record of every class and three healthy ones
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u64).range(16..=1 << 20))]
    units: u64,
    /// Directory of the data set
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    shown: Shown,
}

const EXAMPLES: &str = "\
Examples:
  meshtone adapt run_up.csv first.csv -c bearing --tach tacho --scenario rig.toml --classes pits,tooth-breakage -o set
  meshtone adapt monday.csv friday.csv -c bearing --tach tacho --scenario gearbox.toml --classes pits@z3,outer@input:0 -o set";

impl Adapt {
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.healthy.read(&self.output)?;
        let HealthyMachine { scenario, recordings, .. } = &machine;
        let classes = if self.classes.is_empty() { tooth_classes(scenario) } else { self.classes.clone() };
        let settings = AdaptSettings { classes, units: self.units, seed: self.healthy.seed };
        let to = Destination::directory(&self.output);
        settings.check(scenario)?;
        let estimate = self.healthy.estimate(&machine, self.shown.quiet)?;
        let known = KnownMachine { scenario, recordings, estimate: &estimate };
        let adaptation = with_bar("records", !self.shown.quiet, |progress| {
            adapt(&known, &settings, &to, &GenerateControl { progress, cancelled: &AtomicBool::new(false) })
        })?;
        warn_after_generating(&adaptation.generated);
        adaptation.doubts.iter().for_each(warn);
        self.shown.print(
            &self.output.display(),
            || table(&adaptation, &estimate, &to),
            || adaptation.to_json(),
        )
    }
}

/// What was made, and what may be expected of it.
fn table(adaptation: &Adaptation, estimate: &PathEstimate, to: &Destination) -> String {
    let Adaptation { plan, threshold, healthy, expected, .. } = adaptation;
    let [from_hz, to_hz] = estimate.compared_hz;
    let windows = counted(healthy.len() as u64, "window");
    let row = |name: &str, [mean, least, largest]: [f64; 3], chance: f64| {
        format!("  {name:<40}  {mean:>5.2}  {least:>5.2}  {largest:>5.2}  {chance:>6.2}\n")
    };
    let head = format!(
        "  {} of {} classes: {}\n  the path was compared from {from_hz:.0} to {to_hz:.0} Hz\n  called damaged above a probability of {threshold:.3}, by {windows} of the healthy recordings and by healthy simulations\n",
        counted(plan.records(), "record"),
        adaptation.classes().len(),
        adaptation.classes().join(", ")
    );
    let expected = format!(
        "\n  expected, of {} simulated machines that differ from the scenario\n  {:<40}  {:>5}  {:>5}  {:>5}  chance\n{}{}{}",
        expected.machines,
        "",
        "mean",
        "least",
        "most",
        row("area under the curve of damage", expected.area, 0.5),
        row("balanced accuracy of detection", expected.detection, 0.5),
        row("mean recall of all classes", expected.recall, 1.0 / adaptation.classes().len() as f64)
    );
    format!("{head}{expected}\n{to}\n")
}
