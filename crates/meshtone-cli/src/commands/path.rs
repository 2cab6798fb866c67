//! `meshtone path`

use std::path::{self, PathBuf};

use clap::Args;
use meshtone::tuning::{PathEstimate, RecordedDrive, SidebandCause};
use meshtone_io::own_file::undisturbed;
use meshtone_io::path_csv::path_csv;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::healthy::HealthyRecordings;
use crate::replacement::stage_text;
use crate::shown::Shown;

/// Estimate the path to a sensor from recordings of the healthy machine
///
/// Simulates the machine at the recordings' speeds with many draws of its wheels: the path is the ratio of recordings to simulations at
/// each frequency that mesh harmonics, sidebands and the broad-band remainder have in common. Recordings at several speeds or of a
/// run-up are better than those of one speed. Writes frequency_hz, magnitude, phase_deg (of minimum phase), and in dB the magnitude and
/// its 90 % interval. The sensor of the scenario takes it by frequency_response = { file = "path.csv" }.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Path {
    #[command(flatten)]
    healthy: HealthyRecordings,
    /// File to write; it is replaced if it exists
    #[arg(short, long, value_name = "FILE.csv")]
    output: PathBuf,
    #[command(flatten)]
    shown: Shown,
}

const EXAMPLES: &str = "\
Examples:
  meshtone path run_up.csv -c bearing --tach tacho --scenario rig.toml -o path.csv
  meshtone path slow.csv fast.csv -c bearing --tach tacho --scenario rig.toml -o path.csv
  meshtone path steady.wav --unit g --scenario rig.toml -o path.csv     the speed is the scenario's, made exact by the mesh tone";

impl Path {
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.healthy.read(&self.output)?;
        let estimate = self.healthy.estimate(&machine, self.shown.quiet)?;
        let staged = stage_text(&self.output, &path_csv(&estimate))?;
        undisturbed(|| staged.commit())?;
        self.shown.print(&self.output.display(), || summary(&estimate, &self.output), || numbers(&estimate))
    }
}

/// The estimate, for programs.
fn numbers(estimate: &PathEstimate) -> Value {
    let drive = &estimate.drive;
    let sidebands = drive.sidebands.iter().map(|of| {
        let is_unexplained = of.is_unexplained();
        json!({ "shaft": of.shaft, "order": of.order, "level": of.level, "factor": of.factor, "is_unexplained": is_unexplained })
    });
    json!({
        "frequency_hz": estimate.frequency_hz,
        "magnitude_db": estimate.magnitude_db,
        "low_db": estimate.low_db,
        "high_db": estimate.high_db,
        "phase_deg": estimate.phase_deg,
        "compared_hz": estimate.compared_hz,
        "misfit": estimate.misfit,
        "failed_draws": estimate.failed_draws,
        "speed_wander_percent": drive.speed_wander_percent,
        "line_share": drive.line_share,
        "random_force_factor": drive.random_force_factor,
        "sidebands": sidebands.collect::<Vec<_>>(),
    })
}

/// The path at octaves.
fn summary(estimate: &PathEstimate, output: &path::Path) -> String {
    let [from_hz, to_hz] = estimate.compared_hz;
    let mut text = format!("  {:>10}  {:>8}  {:>18}\n", "Hz", "dB", "90 %");
    let octaves = std::iter::successors(Some(125.0), |hz| Some(2.0 * hz)).take_while(|hz| *hz <= to_hz);
    for hz in octaves.filter(|hz| *hz >= from_hz) {
        let at = estimate.frequency_hz.partition_point(|point| *point < hz);
        let [db, low, high] =
            [&estimate.magnitude_db, &estimate.low_db, &estimate.high_db].map(|values| values[at]);
        text += &format!("  {hz:>10.0}  {db:>8.1}  {:>18}\n", format!("{low:.1} to {high:.1}"));
    }
    format!(
        "{text}\n  compared from {from_hz:.0} to {to_hz:.0} Hz; the recordings differ {:.1} times as much from the simulations as draws of the \
         wheels do\n  take it by frequency_response = {{ file = \"{1}\" }}\n{2}\n{1}\n",
        estimate.misfit.into_iter().fold(0.0, f64::max).sqrt(),
        output.display(),
        drive(&estimate.drive)
    )
}

/// Says what the recordings tell of the drive, and which keys to write for it.
fn drive(found: &RecordedDrive) -> String {
    let mut text = String::new();
    if let Some([wander, low, high]) = found.speed_wander_percent {
        text += &format!(
            "  the speed wanders by {wander:.3} % (90 %: {low:.3} to {high:.3}): operation.speed_wander_percent = {wander:.3}\n"
        );
    }
    if let (Some([recorded, simulated]), Some([factor, low, high])) =
        (found.line_share, found.random_force_factor)
    {
        text += &format!(
            "  lines hold {:.0} % of the recorded power and {:.0} % of the simulated one: multiply random_force of every mesh by {factor:.2} (90 %: {low:.2} to \
             {high:.2})\n",
            100.0 * recorded,
            100.0 * simulated
        );
    }
    if found.needed_s > 0.0 {
        text += &format!(
            "  random_force and sidebands are compared from {:.1} s of one recording at this speed on\n",
            found.needed_s
        );
    }
    for of in &found.sidebands {
        let [recorded, simulated] = of.level;
        let [factor, low, high] = of.factor;
        let what = match of.cause {
            SidebandCause::Torque | SidebandCause::Wheels if low <= 1.0 && 1.0 <= high => "as simulated",
            SidebandCause::Torque => "multiply torque_ripple at this order by it",
            SidebandCause::Wheels => "multiply run_out_share and slope_wobble of the shaft's wheels by it",
            SidebandCause::Nothing if of.is_unexplained() => {
                "not explained: does the torque vary so, or is a wheel damaged?"
            }
            SidebandCause::Nothing => continue,
        };
        text += &format!(
            "  sidebands at order {} of {}: {recorded:.2} of their harmonic, simulated {simulated:.2}; factor {factor:.2} (90 %: {low:.2} to {high:.2}): {what}\n",
            of.order, of.shaft
        );
    }
    text
}
