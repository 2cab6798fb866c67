//! The numbers of a tuning.

use meshtone::tuning::{Experiment, ExperimentResult, Tuning};
use serde_json::{Map, Value, json};

use super::ExperimentFile;

/// The content of a `tuning.json`.
///
/// # Arguments
/// * `file` - the experiment
/// * `result` - as of [`meshtone::tuning::run_experiment`]
///
/// `parameters`, `intervals` and `error` are those of the best that was found; where keys of the scenario were tuned,
/// `enhancement_alone` holds what the three parameters reach without them.
pub fn tuning_json(file: &ExperimentFile, result: &ExperimentResult) -> String {
    let experiment = &file.experiment;
    let mut all = tuning(experiment, result.tuning());
    all.insert("warnings".into(), json!(warnings(file, result)));
    all.insert("meshtone_version".into(), json!(env!("CARGO_PKG_VERSION")));
    all.insert("seed".into(), json!(experiment.seed));
    all.insert("wheel".into(), json!(experiment.chain.wheel.name()));
    all.insert("centre_rev".into(), json!(result.simulated().centre_rev()));
    if let Some(keys) = &result.with_keys {
        let values = experiment.keys.iter().zip(&keys.values);
        let values: Map<String, Value> = values.map(|(key, value)| (key.key.clone(), json!(value))).collect();
        all.insert("scenario_keys".into(), Value::Object(values));
        all.insert(
            "candidates".into(),
            json!({
                "simulated": keys.candidates,
                "failed": keys.failed,
                "first_failure": keys.first_failure,
            }),
        );
        let alone = tuning(experiment, &result.enhancement_alone);
        all.insert("enhancement_alone".into(), Value::Object(alone));
    }
    // Alternate: indented.
    format!("{:#}\n", Value::Object(all))
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

fn tuning(experiment: &Experiment, tuning: &Tuning) -> Map<String, Value> {
    let parameters = tuning.enhancement;
    let intervals = tuning.intervals;
    let measured = &experiment.measured;
    let cases: Vec<Value> = experiment
        .cases
        .iter()
        .enumerate()
        .map(|(number, case)| {
            let indicators: Map<String, Value> = measured
                .indicators()
                .iter()
                .enumerate()
                .map(|(j, indicator)| {
                    let (original, enhanced) = (tuning.original[number][j], tuning.enhanced[number][j]);
                    let value = json!({
                        "logarithmic": indicator.is_logarithmic(),
                        "measured_median": measured.median(number, j),
                        "records": measured.records(number, j).len(),
                        "original": original,
                        "enhanced": enhanced,
                        "error": {
                            "original": measured.error(number, j, original),
                            "enhanced": measured.error(number, j, enhanced),
                        },
                    });
                    (indicator.name().to_owned(), value)
                })
                .collect();
            json!({
                "label": case.label,
                "severity": case.severity,
                "indicators": indicators,
                "error": {
                    "original": measured.case_error(number, &tuning.original[number]),
                    "enhanced": measured.case_error(number, &tuning.enhanced[number]),
                    "leave_one_out": tuning.leave_one_out_error[number],
                },
            })
        })
        .collect();
    let warnings: Vec<String> = tuning.warnings.iter().map(ToString::to_string).collect();
    let value = json!({
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
        "cases": cases,
        "warnings": warnings,
    });
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}
