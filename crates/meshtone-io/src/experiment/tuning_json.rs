//! The numbers of a tuning.

use meshtone::tuning::{Case, Experiment, ExperimentResult, Tuning, TuningIndicator};
use serde_json::{Value, json};

use super::ExperimentFile;

/// The content of a `tuning.json`.
///
/// # Arguments
/// * `file` - the experiment
/// * `result` - as of [`meshtone::tuning::run_experiment`]
///
/// `parameters`, `intervals` and `error` are those of the best that was found; where keys of the scenario were tuned,
/// `enhancement_alone` holds what the three parameters reach without them.
pub fn tuning_json(file: &ExperimentFile, result: &ExperimentResult) -> Value {
    let experiment = &file.experiment;
    let mut all = tuning(experiment, result.tuning());
    all["warnings"] = json!(warnings(file, result));
    all["meshtone_version"] = json!(env!("CARGO_PKG_VERSION"));
    all["seed"] = json!(experiment.seed);
    all["wheel"] = json!(experiment.chain.wheel);
    all["centre_rev"] = json!(result.simulated().centre_rev());
    if let Some(keys) = &result.with_keys {
        let values = experiment.keys.iter().zip(&keys.values);
        all["scenario_keys"] = values.map(|(key, value)| (key.key.clone(), json!(value))).collect();
        all["candidates"] = json!({
            "simulated": keys.candidates,
            "failed": keys.failed,
            "first_failure": keys.first_failure,
        });
        all["enhancement_alone"] = tuning(experiment, &result.enhancement_alone);
    }
    all
}

/// What is doubtful about a tuning: about its recordings, then about what was found.
///
/// # Arguments
/// * `file` - the experiment
/// * `result` - as of [`meshtone::tuning::run_experiment`]
pub fn warnings(file: &ExperimentFile, result: &ExperimentResult) -> Vec<String> {
    let of_tuning = result.tuning().warnings.iter().map(ToString::to_string);
    file.warnings.iter().cloned().chain(of_tuning).collect()
}

/// The numbers of one tuning: parameters with their intervals, errors, and the indicators of every case as measured and as simulated.
///
/// Each indicator stands with its own error before and after, so that a reader sees which of them the tuning improves.
fn tuning(experiment: &Experiment, tuning: &Tuning) -> Value {
    let parameters = tuning.enhancement;
    let intervals = tuning.intervals;
    let measured = &experiment.measured;
    let left_out = |number: usize, j: usize| {
        let case = &tuning.left_out[number];
        let [least, largest] = case.intervals[j];
        let is_held = |record: &&f64| (least..=largest).contains(*record);
        json!({
            "predicted": case.predicted[j],
            "interval": case.intervals[j],
            "records_in_interval": measured.records(number, j).iter().filter(is_held).count(),
        })
    };
    let indicator = |number: usize, j: usize, indicator: &TuningIndicator| {
        let (original, enhanced) = (tuning.original[number][j], tuning.enhanced[number][j]);
        let value = json!({
            "logarithmic": indicator.is_logarithmic(),
            "measured_median": measured.median(number, j),
            "records": measured.records(number, j).len(),
            "original": original,
            "enhanced": enhanced,
            "left_out": left_out(number, j),
            "error": {
                "original": measured.error(number, j, original),
                "enhanced": measured.error(number, j, enhanced),
            },
        });
        (indicator.name().to_owned(), value)
    };
    let case = |(number, case): (usize, &Case)| {
        let indicators = measured.indicators().iter().enumerate();
        let indicators: Value = indicators.map(|(j, name)| indicator(number, j, name)).collect();
        json!({
            "label": case.label,
            "severity": case.severity,
            "indicators": indicators,
            "error": {
                "original": measured.case_error(number, &tuning.original[number]),
                "enhanced": measured.case_error(number, &tuning.enhanced[number]),
                "leave_one_out": tuning.left_out[number].error,
            },
        })
    };
    json!({
        "parameters": {
            "width_ratio": parameters.width_ratio,
            "fault_to_harmonics_ratio": parameters.fault_to_harmonics_ratio,
            "noise_level": parameters.noise_level,
        },
        "intervals": {
            "confidence": 0.95,
            "width_ratio": intervals.width_ratio,
            "fault_to_harmonics_ratio": intervals.fault_to_harmonics_ratio,
            "noise_level": intervals.noise_level,
        },
        "error": {
            "original": tuning.original_error,
            "enhanced": tuning.enhanced_error,
            "leave_one_out": tuning.mean_leave_one_out_error(),
            "measurements_own_scatter": tuning.scatter,
        },
        "cases": experiment.cases.iter().enumerate().map(case).collect::<Vec<_>>(),
        "warnings": tuning.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}
