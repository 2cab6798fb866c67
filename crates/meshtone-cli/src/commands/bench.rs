//! `meshtone bench`

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use meshtone_io::own_file::undisturbed;
use serde_json::{Value, json};

use crate::bench::adaptation::Adapter;
use crate::bench::checksums::{self, Checksums};
use crate::bench::preset::{Label, Machine, Preset, Recorded};
use crate::bench::{bearings, gears};
use crate::diagnose::reference::ReferenceOptions;
use crate::failure::Failure;
use crate::output_directory::{OutputDirectory, named_after};
use crate::replacement::{replace, stage_text};
use crate::shown::Shown;
use crate::terminal::warn;

const JSON: &str = "bench.json";
const FILES: [&str; 2] = [JSON, checksums::FILE];

/// Score what is said about a public set of recordings
///
/// Finds the set by the names of the files in a folder and in those within it, and compares what `meshtone indicators` says with what
/// is published of each. Known are the bearings of Case Western Reserve University (cwru) and of the MFPT Society (mfpt), and the gearbox of OEDI
/// submission 623 (oedi-623): machine, rates and speeds, with the source of each number. Nothing is fetched.
///
/// Of a bearing: the race that is named, and beside it a simple rule, whose race has the strongest line of the squared envelope of the
/// whole band, at least 10 times the median beside it. Of a gearbox: FM0 and FM4 of each wheel, the distance of their logarithms from the healthy
/// recordings at other loads (rms), and the areas under the curve, healthy against damaged.
///
/// Writes bench.json, and SHA256SUMS with the checksums at the first use, so that a file that has changed is noticed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, mut_arg("reference", |of| of.requires("diagnose")), mut_arg("records", |of| of.requires("diagnose")))]
pub struct Bench {
    /// Folder with the set, unpacked
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// The set: cwru, mfpt or oedi-623. [default: the one that most names of files are of]
    #[arg(long, value_name = "NAME")]
    set: Option<String>,
    /// Diagnose a gearbox too, each recording beside the healthy one of its load, a healthy one's second half beside its first; the first time this
    /// simulates for long
    #[arg(long)]
    diagnose: bool,
    #[command(flatten)]
    kept: ReferenceOptions,
    /// Judge each recording of a gearbox by a data set of its channel, adapted to the first half of each healthy recording; this simulates for some
    /// minutes a channel. The sets are kept in the folder `adapted` of the results
    #[arg(long)]
    adapt: bool,
    /// Directory to write to. [default: <name of the folder>_bench in the current directory]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    shown: Shown,
}

const EXAMPLES: &str = "\
Examples:
  meshtone bench cwru
  meshtone bench downloads --set mfpt --json
  meshtone bench oedi --diagnose --records 2048
  meshtone bench oedi --adapt";

impl Bench {
    /// Finds the set, scores its recordings, and writes and prints what came out. Checksums are taken first, so that a file that changes meanwhile is noticed the
    /// next time; and what could not be scored fails the command only where that is everything.
    pub fn run(&self) -> Result<(), Failure> {
        let (set, recordings) = Preset::find(&self.directory, self.set.as_deref())?;
        let directory = self.output.clone().unwrap_or_else(|| named_after(&self.directory, "bench"));
        let read: Vec<&Path> = recordings.iter().map(|recording| &*recording.path).collect();
        let output = OutputDirectory::for_files(&directory, &FILES, &read)?;
        if output.path.join(checksums::FILE).exists() && !output.path.join(JSON).exists() {
            let problem = format!("{} has a {} of another program", directory.display(), checksums::FILE);
            return Failure::refuse(problem, "name another directory with -o");
        }
        let Preset { name, title, reference, sources, machine, .. } = &set;
        let mut checksums = Checksums::recorded(&output.path);
        let files = self.files(&recordings, &mut checksums, &directory);
        let quiet = self.shown.quiet;
        let scores = match machine {
            Machine::Bearing(_) if self.diagnose || self.adapt => {
                let option = if self.diagnose { "--diagnose" } else { "--adapt" };
                let problem =
                    format!("{option}: {name} is of a bearing without gears, which is not simulated");
                return Failure::refuse(problem, "leave it out");
            }
            Machine::Bearing(bearing) => bearings::score(&recordings, bearing, quiet),
            Machine::Gearbox(scenario, classes) => {
                let folder = output.path.join("adapted");
                let adapter = self.adapt.then_some(Adapter { scenario, classes, folder, quiet });
                let kept = self.diagnose.then_some(&self.kept);
                gears::score(&recordings, scenario, kept, adapter.as_ref(), quiet)?
            }
        };
        let values = files.into_iter().zip(scores.values()).map(|(file, found)| joined(file, found));
        let scored = scores.each.iter().flatten().count();
        let json = json!({
            "set": name, "title": title, "reference": reference, "sources": sources, "scored": scored,
            "scores": scores.sums, "recordings": values.collect::<Vec<_>>(), "meshtone_version": env!("CARGO_PKG_VERSION"),
        });
        let texts = [format!("{json:#}\n"), checksums.text()];
        let staged = FILES.iter().zip(texts).map(|(name, text)| stage_text(&output.path.join(name), &text));
        let staged = staged.collect::<Result<Vec<_>, _>>()?;
        undisturbed(|| replace(&output.path, &FILES, &FILES, staged))?;
        let to = directory.display();
        let table = || format!("{title} -> {to}\n\n{}", scores.in_words(&recordings));
        self.shown.print(&to, table, || json)?;
        if scored > 0 {
            return Ok(());
        }
        let problem = format!("none of {} recordings could be scored", recordings.len());
        Err(Failure::failed(problem).with_help(format!("the reasons stand in {to}/{JSON}")))
    }

    /// What is known of each recording, with the checksum of its file; says which files have changed.
    fn files(&self, recordings: &[Recorded], recorded: &mut Checksums, directory: &Path) -> Vec<Value> {
        let mut known: BTreeMap<&Path, Value> = BTreeMap::new();
        let mut of_each = Vec::new();
        for Recorded { path, channel, label: Label { is, size, shaft_hz, sampling_rate_hz }, .. } in
            recordings
        {
            let file = known.entry(path).or_insert_with(|| {
                let parts = path.strip_prefix(&self.directory).unwrap_or(path).iter();
                let name = parts.map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
                let (sha256, has_changed) = recorded.check(&name, path);
                if has_changed {
                    let of = directory.join(checksums::FILE);
                    warn(format_args!(
                        "{name} is not what it was at its first use; its line in {} may be removed",
                        of.display()
                    ));
                }
                json!({ "file": name, "sha256": sha256, "has_changed": has_changed })
            });
            let label = json!({ "channel": channel, "is": is, "size": size, "shaft_hz": shaft_hz, "stated_sampling_rate_hz": sampling_rate_hz });
            of_each.push(joined(file.clone(), label));
        }
        of_each
    }
}

/// The keys of both objects.
fn joined(mut first: Value, second: Value) -> Value {
    if let (Value::Object(all), Value::Object(more)) = (&mut first, second) {
        all.extend(more);
    }
    first
}
