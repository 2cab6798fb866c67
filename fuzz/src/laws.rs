//! Legal scenarios, plans and experiments, and odd signals, made from the bytes of an input, with the laws that hold for them.

use std::sync::OnceLock;

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use meshtone::StepJudgement;
use meshtone::scenario::{GearboxRig, Scenario, damage_kinds, gearbox_template};
use meshtone_dataset::draw::Sampler;
use meshtone_dataset::plan::{self, Plan};
use meshtone_io::experiment::read_experiment;
use toml::{Table, Value};

use crate::{guarded, written};

mod signal;

pub use signal::signal;

/// Most samples of a simulation that is made: some milliseconds.
const MOST_SAMPLES: usize = 20_000;

/// A scenario: whatever it is, it is refused with words, or its signals are numbers, and the same ones again.
pub fn scenario(bytes: &[u8]) {
    guarded(|| {
        let mut input = Unstructured::new(bytes);
        let Some(scenario) = legal(&mut input).ok().flatten() else { return };
        let again = Scenario::from_toml(&scenario.to_toml());
        assert_eq!(again.as_ref(), Ok(&scenario), "what is written is read");
        if scenario.time_grid().kept_samples() > MOST_SAMPLES {
            return;
        }
        let simulation = match meshtone::simulate(&scenario) {
            Ok(simulation) => simulation,
            Err(error) => return assert!(!error.to_string().is_empty()),
        };
        let signals = &simulation.channels.signals;
        for signal in signals {
            let is_finite = signal.values.iter().all(|value| value.is_finite());
            assert!(is_finite && signal.values.len() == simulation.channels.len(), "{}", signal.name);
        }
        simulation.stages.warnings();
        simulation.warnings_of_signals(StepJudgement::Repeated);
        let again = meshtone::simulate(&scenario).unwrap_or_else(|error| panic!("the second time: {error}"));
        assert_eq!(again.channels, simulation.channels, "the same bits");
    });
}

/// A scenario that is read without an error.
fn legal(input: &mut Unstructured) -> Result<Option<Scenario>> {
    static BASES: OnceLock<Vec<Table>> = OnceLock::new();
    let bases = BASES.get_or_init(|| {
        let presets = meshtone_explore::presets().into_iter().map(|preset| preset.toml.to_owned());
        let gearboxes = [None, Some(GearboxRig::ALL[0])].into_iter().map(gearbox_template);
        presets.chain(gearboxes).map(|text| text.parse().unwrap()).collect()
    });
    let mut table = input.choose(bases)?.clone();
    // Short, unless the input says otherwise.
    let solver = table.entry("solver").or_insert(Value::Table(Table::new()));
    if let Value::Table(solver) = solver {
        solver.insert("sampling_rate_hz".to_owned(), Value::Float(1e4));
        solver.insert("duration_s".to_owned(), Value::Float(0.05));
    }
    Ok(Scenario::from_toml(&changed(table, input)?).ok())
}

/// A plan: what it draws is legal.
pub fn plan(bytes: &[u8]) {
    guarded(|| {
        let table = plan::template().parse().unwrap();
        if let Ok(text) = changed(table, &mut Unstructured::new(bytes))
            && let Ok(plan) = Plan::read_text(text, "plan.toml".as_ref())
        {
            follows_plan(&plan);
        }
    });
}

/// Draws some records of a plan: each is the same the second time, and its scenario is legal.
pub(crate) fn follows_plan(plan: &Plan) {
    let Ok(sampler) = Sampler::new(&plan.content) else { return };
    let last = sampler.records().saturating_sub(1);
    for index in [0, last / 2, last] {
        let Ok(record) = sampler.record(index) else { continue };
        assert_eq!(sampler.record(index).ok().as_ref(), Some(&record));
        if let Ok(scenario) = sampler.scenario(&record) {
            assert!(scenario.validate().is_ok(), "record {index}");
        }
    }
}

/// An experiment: what is read obeys its own check.
pub fn experiment(bytes: &[u8]) {
    files_of_experiments();
    guarded(|| {
        let table = include_str!("../../examples/experiments/breakage.toml").parse().unwrap();
        if let Ok(text) = changed(table, &mut Unstructured::new(bytes))
            && let Ok(read) = read_experiment(&written("experiment.toml", text.as_bytes()))
        {
            read.experiment.check().unwrap_or_else(|error| panic!("{error}"));
        }
    });
}

/// Writes the files that experiments name.
pub(crate) fn files_of_experiments() {
    static PREPARED: OnceLock<()> = OnceLock::new();
    PREPARED.get_or_init(|| {
        let rig = include_bytes!("../../examples/experiments/rig_17_38.toml");
        ["rig.toml", "rig_17_38.toml"].iter().for_each(|name| drop(written(name, rig)));
        let measured = include_str!("../../examples/experiments/fig6_indicators.csv");
        let few: Vec<&str> = measured.lines().step_by(50).collect();
        written("fig6_indicators.csv", few.join("\n").as_bytes());
    });
}

/// A file with some entries changed, which is shown where the variable `SHOW` is set.
fn changed(mut table: Table, input: &mut Unstructured) -> Result<String> {
    for _ in 0..input.int_in_range(1..=8)? {
        let mut leaves = Vec::new();
        collect(&mut table, &mut leaves);
        let at = input.choose_index(leaves.len())?;
        change_value(leaves.swap_remove(at), input)?;
    }
    let text = table.to_string();
    if std::env::var_os("SHOW").is_some() {
        println!("{text}");
    }
    Ok(text)
}

/// All values that are no tables.
fn collect<'t>(table: &'t mut Table, leaves: &mut Vec<&'t mut Value>) {
    for (_, value) in table.iter_mut() {
        let is_list = value.as_array().is_some_and(|entries| entries.iter().all(Value::is_table));
        if !is_list && !value.is_table() {
            leaves.push(value);
            continue;
        }
        match value {
            Value::Table(table) => collect(table, leaves),
            Value::Array(entries) => {
                entries.iter_mut().filter_map(Value::as_table_mut).for_each(|table| collect(table, leaves));
            }
            _ => {}
        }
    }
}

/// Another value of the same kind, for numbers most often one of the same order of magnitude.
fn change_value(value: &mut Value, input: &mut Unstructured) -> Result<()> {
    match value {
        Value::Float(number) => {
            *number = match input.int_in_range(0..=4)? {
                0 => f64::from(input.arbitrary::<i8>()?),
                1 => input.arbitrary()?,
                _ => *number * 10_f64.powf(f64::from(input.arbitrary::<i8>()?) / 64.0),
            }
        }
        Value::Integer(number) => *number = number.saturating_add(i64::from(input.arbitrary::<i8>()?)),
        Value::Boolean(is) => *is = !*is,
        Value::String(text) => {
            let kinds: Vec<&str> = damage_kinds().iter().map(|kind| kind.name).collect();
            if kinds.contains(&text.as_str()) {
                *text = (*input.choose(&kinds)?).to_owned();
            }
        }
        Value::Array(entries) if !entries.is_empty() => {
            let at = input.choose_index(entries.len())?;
            match input.int_in_range(0..=3)? {
                0 => drop(entries.remove(at)),
                1 => entries.insert(at, entries[at].clone()),
                _ => change_value(&mut entries[at], input)?,
            }
        }
        _ => {}
    }
    Ok(())
}
