//! The plan of a data set for one machine.

use std::fmt::Write;
use std::fs;

use meshtone::damage::damage_kinds;
use meshtone::scenario::Scenario;
use meshtone::tuning::PathEstimate;
use tempfile::TempDir;

use crate::error::DatasetError;
use crate::plan::{Distribution, Plan, Variation};

/// (S/s) Sampling rate of the set, if recordings and scenario have that much.
const USUAL_RATE_HZ: f64 = 25e3;
/// (-) Severities that are drawn.
const SEVERITY: [f64; 2] = [0.1, 1.0];
/// (dB) Noise of a sensor whose noise is not known.
const SNR_DB: [f64; 2] = [9.0, 24.0];
/// (-) Standard deviations on either side that hold 90 %.
const NINETY_PERCENT: f64 = 1.645;
/// Races of a bearing that may have a spall.
const RACES: [&str; 3] = ["outer", "inner", "element"];

/// What a data set is made of for a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptSettings {
    /// Classes beside the healthy one: a kind of damage, or a race of a bearing, and behind `@` the wheel or the bearing's seat; without it the
    /// gear of a pair. Empty for every kind on every wheel.
    pub classes: Vec<String>,
    /// Units, that is pairs of wheels or gearboxes, each with a record of every class and three healthy ones.
    pub units: u64,
    /// Seed of all draws.
    pub seed: u64,
}

impl AdaptSettings {
    /// Checks whether a machine can have the classes.
    ///
    /// # Arguments
    /// * `scenario` - of the machine
    ///
    /// # Errors
    /// No class, or one twice; a kind of damage, a wheel or a bearing that there is not.
    pub fn check(&self, scenario: &Scenario) -> Result<(), DatasetError> {
        if self.classes.is_empty() {
            return Err(DatasetError::refused("there is no class of damage", "name one, such as pits@gear"));
        }
        if let Some(class) = self
            .classes
            .iter()
            .enumerate()
            .find_map(|(at, class)| self.classes[..at].contains(class).then_some(class))
        {
            return Err(DatasetError::refused(
                format!("class {class:?} is named twice"),
                "name each class once",
            ));
        }
        self.classes.iter().try_for_each(|class| fault_of(scenario, class).map(drop))
    }
}

/// The classes of a machine in the words of [`AdaptSettings::classes`], without spalls of bearings.
///
/// # Arguments
/// * `scenario` - of the machine
pub fn tooth_classes(scenario: &Scenario) -> Vec<String> {
    let kinds = damage_kinds();
    let of_wheel =
        |wheel: &str| kinds.iter().map(|kind| format!("{}@{wheel}", kind.name)).collect::<Vec<_>>();
    let wheels = scenario.wheel_names();
    let all = wheels.iter().flat_map(|wheel| of_wheel(wheel));
    all.filter(|class| fault_of(scenario, class).is_ok()).collect()
}

/// The fault of a class as a plan has it, with the key of its severity, if it has one.
fn fault_of(scenario: &Scenario, class: &str) -> Result<(String, bool), DatasetError> {
    let (kind, part) = class.split_once('@').map_or((class, None), |(kind, part)| (kind, Some(part)));
    let refused = |problem: String, help: String| {
        Err(DatasetError::refused(format!("class {class:?}: {problem}"), help))
    };
    if RACES.contains(&kind) {
        let rolling = scenario.bearings().iter().filter(|bearing| matches!(bearing.rolling(), Ok(Some(_))));
        let seats: Vec<String> = rolling.map(|bearing| bearing.seat_name()).collect();
        return match part.filter(|part| seats.iter().any(|seat| seat == part)) {
            Some(seat) => Ok((format!("{{ bearing = {seat:?}, race = {kind:?}, severity = 0.5 }}"), true)),
            None if seats.is_empty() => refused(
                "the scenario has no ball or roller bearing".into(),
                "state kind = \"ball\" of a [[bearing]], of a pair as a gearbox: meshtone init gearbox"
                    .into(),
            ),
            None => refused(
                "no such bearing".into(),
                format!("write {kind}@SEAT with a seat of {}", seats.join(", ")),
            ),
        };
    }
    let Some(known) = damage_kinds().into_iter().find(|known| known.name == kind) else {
        let names: Vec<&str> = damage_kinds().iter().map(|kind| kind.name).chain(RACES).collect();
        let help = format!("there are {}, beside healthy records, which every set has", names.join(", "));
        return refused("no such kind of damage".into(), help);
    };
    let wheels = scenario.wheel_names();
    let wheel = match part {
        Some(part) => part,
        None if scenario.rig().is_some() => wheels.last().copied().unwrap_or_default(),
        None => {
            return refused(
                "which wheel?".into(),
                format!("write {kind}@WHEEL with a wheel of {}", wheels.join(", ")),
            );
        }
    };
    if !wheels.contains(&wheel) {
        return refused(format!("no wheel {wheel:?}"), format!("the wheels are {}", wheels.join(", ")));
    }
    let has_severity = !known.sizes.is_empty();
    let severity = if has_severity { ", severity = 0.5" } else { "" };
    Ok((format!("{{ wheel = {wheel:?}, kind = {kind:?}{severity} }}"), has_severity))
}

/// What the simulations of a data set have in common.
pub(super) struct Machine<'a> {
    /// The scenario with what the recordings told.
    pub scenario: &'a Scenario,
    /// The path that is in it.
    pub estimate: &'a PathEstimate,
    /// (S/s) The lowest sampling rate of the recordings.
    pub recorded_rate_hz: f64,
}

impl Machine<'_> {
    /// The plan of records of this machine.
    ///
    /// The path scatters by what it is known to: its standard deviation is the median over frequency.
    ///
    /// # Arguments
    /// * `settings` - classes, units, seed
    /// * `variation` - what is not known of the rig, as plans name it
    /// * `of_unit` - healthy records of each unit, and those of every other class
    ///
    /// # Errors
    /// A class that the machine cannot have; a scenario that no plan takes.
    pub fn plan(
        &self,
        settings: &AdaptSettings,
        variation: &str,
        of_unit: [u64; 2],
    ) -> Result<Plan, DatasetError> {
        let Self { scenario, estimate, recorded_rate_hz } = self;
        let rate_hz = USUAL_RATE_HZ.min(scenario.solver.sampling_rate_hz).min(*recorded_rate_hz);
        let mut half_db: Vec<f64> =
            estimate.high_db.iter().zip(&estimate.low_db).map(|(high, low)| (high - low) / 2.0).collect();
        half_db.sort_by(f64::total_cmp);
        let ripple_db = half_db.get(half_db.len() / 2).map_or(0.0, |half| half / NINETY_PERCENT);
        let AdaptSettings { classes, units, seed } = settings;
        let [healthy, damaged] = of_unit.map(|records| records * units);
        let mut text = format!(
            "title = \"Vibration of one machine, simulated\"\n\
             description = \"Simulations of a machine whose path and drive were estimated from its healthy recordings.\"\n\
             scenario = \"scenario.toml\"\nseed = {seed}\nunits = {units}\nvariation = {variation:?}\n\
             questions = [\"detection\", \"diagnosis\", \"severity\"]\n\n\
             [[class]]\nlabel = \"healthy\"\ncount = {healthy}\n"
        );
        for class in classes {
            let (fault, has_severity) = fault_of(scenario, class)?;
            // Writing to a string does not fail.
            let _ = writeln!(text, "\n[[class]]\nlabel = {class:?}\ncount = {damaged}\nfault = {fault}");
            if has_severity {
                let _ = writeln!(text, "[[class.vary]]\nkey = \"fault.severity\"\nuniform = {SEVERITY:?}");
            }
        }
        let _ = write!(
            text,
            "\n[[vary]]\nkey = \"noise.snr_db\"\nuniform = {SNR_DB:?}\n\n\
             [[vary]]\nkey = \"path.ripple_db\"\nfixed = {ripple_db:?}\nper = \"mounting\"\n\n\
             [keep]\nsampling_rate_hz = {rate_hz:?}\n"
        );
        // The machine that is asked about later turns as it did and has about its load, however little is known of the rest.
        for rule in Variation::KnownRig.rules(scenario) {
            let (Distribution::Uniform(range) | Distribution::LogUniform(range)) = rule.distribution else {
                continue;
            };
            if let Some(key) = rule.keys.iter().find(|key| key.starts_with("operation.")) {
                let name = rule.distribution.name();
                let _ = writeln!(text, "\n[[vary]]\nkey = {key:?}\n{name} = {range:?}");
            }
        }
        // A plan names its scenario as a file; its copies stand beside the data.
        let folder = TempDir::new().map_err(DatasetError::write("a plan"))?;
        let path = folder.path().join("plan.toml");
        let written = fs::write(folder.path().join("scenario.toml"), scenario.to_toml());
        written.map_err(DatasetError::write("a plan"))?;
        Ok(Plan::read_text(text, &path)?)
    }
}
