//! The files that the experiment of `meshtone init experiment` names: its scenario, and recordings of a simulated rig.

use std::path::{Path, PathBuf};

use meshtone::scenario::{Scenario, template};
use meshtone::sensor::{ChannelKind, Channels, NamedSignal};
use meshtone::signal::{Edge, resample_to};
use meshtone_io::atomic_file::StagedFile;
use meshtone_io::signals::SignalTable;

use crate::failure::Failure;

/// The scenario that the experiment names.
const SCENARIO: &str = "rig.toml";
/// The torque of the template, and one under which teeth do not part, so that small changes of the rig change little.
const TORQUES: [&str; 2] = ["brake_torque_nm = 10.0 ", "brake_torque_nm = 250.0"];
/// The difference between the rig and the scenario, which has other supports and no sensor with noise; and the length of the recordings.
const RIG: &str = "
[rig]
support = { base_hz = 520.0 }

[[sensor]]
at = \"support\"
noise_density_g_per_rthz = 2e-2

[solver]
duration_s = 4.8
";
/// The recordings, and the severity of the broken tooth in each.
const RECORDINGS: [(&str, Option<f64>); 4] = [
    ("healthy.parquet", None),
    ("chipped_1.parquet", Some(0.5)),
    ("chipped_2.parquet", Some(0.65)),
    ("chipped_3.parquet", Some(0.8)),
];
/// (S/s) Sampling rate of the recordings.
const SAMPLING_RATE_HZ: f64 = 25e3;

/// The places of these files.
///
/// # Arguments
/// * `directory` - of the experiment
pub fn paths(directory: &Path) -> Vec<PathBuf> {
    let recordings = RECORDINGS.map(|(name, _)| name);
    [&[SCENARIO], &recordings[..]].concat().into_iter().map(|name| directory.join(name)).collect()
}

/// Writes these files beside the experiment, where they appear once they are committed.
///
/// # Arguments
/// * `directory` - of the experiment
pub fn stage(directory: &Path) -> Result<Vec<StagedFile>, Failure> {
    let healthy = template("healthy").ok_or_else(|| Failure::failed("there is no scenario of the rig"))?;
    let (before, after) = healthy
        .split_once(TORQUES[0])
        .ok_or_else(|| Failure::failed(format!("the scenario of the rig has no '{}'", TORQUES[0])))?;
    let scenario = [before, TORQUES[1], after].concat();
    let write = |name: &str, bytes: &[u8]| {
        StagedFile::write(&directory.join(name), |file| std::io::Write::write_all(file, bytes))
    };
    let mut staged = vec![write(SCENARIO, scenario.as_bytes())?];
    for (name, severity) in RECORDINGS {
        let fault = severity.map_or_else(String::new, |severity| {
            format!("\n[[fault]]\nkind = \"tooth-breakage\"\nseverity = {severity:?}\n")
        });
        let recording = recording(&format!("{scenario}{fault}{RIG}"));
        let recording = recording.map_err(|error| Failure::failed(format!("{name}: {error}")))?;
        staged.push(write(name, &recording)?);
    }
    Ok(staged)
}

/// The recording of the sensor on a rig, as Parquet.
fn recording(scenario: &str) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let channels = meshtone::simulate(&Scenario::from_toml(scenario)?)?.channels;
    let simulated = channels.leading().map_or(&[][..], |signal| &signal.values);
    let mut measured = NamedSignal::from(ChannelKind::Vertical);
    measured.values = resample_to(simulated, channels.sampling_rate_hz, SAMPLING_RATE_HZ, Edge::Reflect)?;
    let measured = Channels::new(SAMPLING_RATE_HZ, 0.0, vec![measured]);
    let mut file = Vec::new();
    SignalTable::without_scenario(&measured).write_parquet(&mut file)?;
    Ok(file)
}
