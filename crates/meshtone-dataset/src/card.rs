//! The data card: README.md.

use meshtone::scenario::{Fault, WarningKind};
use meshtone_io::table::CellType;
use serde_json::json;

use crate::croissant::citation;
use crate::finish::Finished;
use crate::manifest::PREVIEW;
use crate::plan::{AveragedWheels, Class, ClassFault, Growth, PlanFile, Severity, SplitBy, wheel_words};
use crate::sampling::Design;
use crate::shard::{Column, Topic, WARNINGS, column_name, varied_keys};
use crate::words::counted;

/// Writes the data card.
pub(crate) fn card(set: &Finished) -> String {
    let sections = [front_matter, head, counts, warnings, classes, draws, questions, columns, files, loading];
    sections.map(|section| section(set)).concat()
}

/// Writes what Hugging Face's `datasets` and its website read of a card: licence, title, tags, and the files of each split.
fn front_matter(set: &Finished) -> String {
    let about = &set.plan.about;
    let licence = match about.licence.as_str() {
        words if words.contains(char::is_whitespace) => format!("other\nlicense_name: {}", json!(words)),
        identifier => json!(identifier.to_lowercase()).to_string(),
    };
    // Names of splits are words there.
    let files_of = |(split, _): (&str, u64)| {
        format!("  - split: {:?}\n    path: {:?}\n", split.replace('-', "_"), set.shards.pattern(split))
    };
    format!(
        "---\nlicense: {licence}\npretty_name: {}\ntags: [vibration, gears, condition-monitoring, simulation]\nconfigs:\n- config_name: default\n  data_files:\n{}dataset_info:\n  features:\n{}---\n\n",
        json!(about.title),
        set.plan.content.units_of_split().into_iter().map(files_of).collect::<String>(),
        set.columns.iter().map(|column| feature(set, column)).collect::<String>()
    )
}

/// Writes a column as `datasets` reads it: labels as classes, whose numbers are those of Python's `to_torch`.
fn feature(set: &Finished, column: &Column) -> String {
    let kind = match column.cell_type {
        _ if column.name == "label" => {
            let mut labels: Vec<&str> = set.plan.content.classes.iter().map(|class| &*class.label).collect();
            labels.sort_unstable();
            labels.dedup();
            let name = |(number, label)| format!("\n          '{number}': {}", json!(label));
            format!(
                "dtype:\n      class_label:\n        names:{}",
                labels.into_iter().enumerate().map(name).collect::<String>()
            )
        }
        CellType::Int32 => "dtype: int32".to_owned(),
        CellType::Int64 => "dtype: int64".to_owned(),
        CellType::Float64 => "dtype: float64".to_owned(),
        CellType::Text => "dtype: string".to_owned(),
        CellType::Float32List => "sequence: float32".to_owned(),
    };
    format!("  - name: {}\n    {kind}\n", column.name)
}

fn head(set: &Finished) -> String {
    let (about, keep) = (&set.plan.about, &set.plan.content.keep);
    let title = format!("# {}\n\n", about.title);
    let description = match about.description.as_str() {
        "" => String::new(),
        text => format!("{}\n\n", text.trim()),
    };
    let rate = format!("{} S/s", keep.sampling_rate_hz);
    let channels = match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => format!(
            "raw channels over {} of the {} at {} points each, of a sampling rate of {rate}",
            counted(angle.revolutions as u64, "revolution"),
            keep.wheel.all()[0],
            angle.points_per_revolution,
        ),
        (None, Some(seconds)) => format!("raw channels at {rate} over {seconds} s"),
        (None, None) => format!("raw channels at {rate} over one hunting-tooth period"),
    };
    let mountings = set.plan.content.mountings;
    let mounted = if mountings > 1 { format!(", each mounted {mountings} times") } else { String::new() };
    let records = counted(set.records(), "simulated record");
    let units = counted(set.plan.content.units, "unit");
    let [_, kind] = set.plan.content.base.words().nouns;
    let ([plan, scenario, ..], made_by) = (PlanFile::NAMES, meshtone::made_by());
    format!(
        "{title}{description}{records} of gear vibration from {units} ({kind}){mounted}, {channels}. Made from \
         `{plan}` by {made_by}, by which the plan makes the same bytes again; the base scenario is `{scenario}`.\n\n\
         **Licence of the data: {}.** Cite as: {}.\n\n\
         ![Examples of each class, distributions of the keys, indicators by class]({})\n\n",
        about.licence,
        citation(about).trim_end_matches('.'),
        PREVIEW[1]
    )
}

/// Says what is in the data set: a table of records by class and split, and what the splits mean.
///
/// Whether the splits divide units or mountings decides what a test result means, so that it is said in words beside the numbers, as are
/// the splits that are unlike the training and the records that are missing.
fn counts(set: &Finished) -> String {
    let (plan, contents) = (set.plan, set.contents);
    let (splits, units): (Vec<&str>, Vec<u64>) = plan.content.units_of_split().into_iter().unzip();
    let row = |name: &str, numbers: &[u64]| {
        let cells: Vec<String> = numbers.iter().map(u64::to_string).collect();
        format!("| {name} | {} | {} |\n", cells.join(" | "), numbers.iter().sum::<u64>())
    };
    let mut text = format!(
        "## What is in it\n\n| class | {} | all |\n|---|{}---:|\n",
        splits.join(" | "),
        "---:|".repeat(splits.len())
    );
    for Class { label, .. } in &plan.content.classes {
        let count = |split: &&str| contents.counts.get(*split).and_then(|labels| labels.get(label));
        text +=
            &row(label, &splits.iter().map(|split| count(split).copied().unwrap_or(0)).collect::<Vec<_>>());
    }
    let [kind, _] = plan.content.base.words().nouns;
    let (divided, meaning) = match plan.content.splits.by {
        SplitBy::Unit => (
            "unit",
            format!(
                "all records of a {kind} are in one split, so that knowledge of particular wheels from the \
                 training does not help in the test"
            ),
        ),
        SplitBy::Mounting => (
            "mounting",
            format!(
                "all records of one mounting of a {kind} are in one split, which may share the wheels with \
                 other splits: knowledge of particular wheels from the training helps in the test, knowledge \
                 of a mounting does not"
            ),
        ),
    };
    text += &row(&format!("*{divided}s*"), &units);
    text += &format!("\n**Splits are by {divided}**: {meaning}.\n");
    for shift in &plan.content.splits.shifts {
        let when: Vec<String> = shift.when.iter().map(|condition| format!("`{condition}`")).collect();
        text += &format!(
            "The split `{}` is unlike the training: {} holds for its records and for no other ones, in every class that has \
             such a number.\n",
            shift.name,
            when.join(" and ")
        );
    }
    text += "\n";
    if !contents.failures.is_empty() {
        text += &format!(
            "Of the plan's {} records {} could not be simulated and are missing; `manifest.json` lists them with the reasons.\n\n",
            plan.records(),
            contents.failures.len()
        );
    }
    text
}

/// Says what is doubtful, and of how many records.
fn warnings(set: &Finished) -> String {
    let warnings = &set.contents.warnings;
    if warnings.is_empty() {
        return String::new();
    }
    let row = |(kind, count): (&WarningKind, &u64)| {
        format!("| `{}` | {count} | {} |\n", kind.code(), kind.meaning())
    };
    format!(
        "## Warnings\n\nWarnings of the simulations, by their code in the column `{WARNINGS}`, of {}.\n\n\
         | code | records | meaning |\n|---|---:|---|\n{}\n",
        counted(set.records(), "record"),
        warnings.iter().map(row).collect::<String>()
    )
}

fn classes(set: &Finished) -> String {
    let is_pair = set.plan.content.base.rig().is_some();
    let fault = |fault: &ClassFault| match fault {
        ClassFault::Teeth(_) if is_pair => fault.kind().to_owned(),
        ClassFault::Teeth(Fault { wheel, .. }) => format!("{} of {wheel}", fault.kind()),
        ClassFault::Bearing { bearing, .. } => format!("{} of {bearing}", fault.kind()),
    };
    let row = |class: &Class| {
        let fault = match &class.faults[..] {
            [] => "none".to_owned(),
            faults => faults.iter().map(fault).collect::<Vec<_>>().join(" + "),
        };
        let grows = class.growth.as_ref().map(grows).unwrap_or_default();
        format!("| {} | {fault}{grows} | {} |\n", class.label, severity(class))
    };
    let rows: String = set.plan.content.classes.iter().map(row).collect();
    format!("## Classes\n\n| label | fault | severity |\n|---|---|---|\n{rows}\n")
}

fn draws(set: &Finished) -> String {
    let design = match set.plan.content.design {
        Design::Independent => "independent draws",
        Design::LatinHypercube => "Latin hypercube",
        Design::Sobol => "scrambled Sobol sequence",
    };
    let rows = varied_keys(&set.plan.content).into_iter().map(|(rule, key)| {
        let name = column_name(key);
        let ends = set.contents.ranges.get(&name).copied().unwrap_or([f64::NAN; 2]);
        let (level, [least, largest]) = (rule.level.name(), ends.map(short));
        format!("| `{name}` | `{key}` | {level} | {least} | {largest} |\n")
    });
    format!(
        "## How it was drawn\n\nDesign: {design}. \n\n| column | key | for each | least | largest |\n\
         |---|---|---|---:|---:|\n{}\n",
        rows.collect::<String>()
    )
}

/// Says what the data set asks, and how answers are scored.
fn questions(set: &Finished) -> String {
    let questions = &set.plan.about.questions;
    if questions.is_empty() {
        return String::new();
    }
    let rows = questions.iter().map(|question| {
        let [target, score] = question.target_and_score();
        format!("| {} | {target} | {score} |\n", question.name())
    });
    format!(
        "## Questions\n\n| question | target | score |\n|---|---|---|\n{}\nAnswer from the signals, the \
         indicators and what is known of a machine: teeth, module, face width, speed, load. Columns of the \
         fault, seeds, numbers of records, units and mountings, and all other drawn values are not known of \
         a real gear: they serve to see where an answer fails. Train on `train`, choose on `validation`.\n\n",
        rows.collect::<String>()
    )
}

/// Says in words how a damage grows.
fn grows(growth: &Growth) -> String {
    let Growth { law, start, failure, censored, life_rev, over } = growth;
    let name = law.name();
    format!(
        ", which grows by the law `{name}` from severity {start} to failure at {failure} after a life, `{}`, that each run draws; a run \
         is stopped before with a probability of {censored}; its records are spread evenly over the {}",
        life_rev.name(),
        over.name()
    )
}

fn severity(class: &Class) -> String {
    match &class.severity {
        _ if class.faults.is_empty() => "0".to_owned(),
        Severity::Grade(grade) => grade.to_string(),
        Severity::Measured { measure, breaks } => {
            let breaks: Vec<String> = breaks.iter().map(f64::to_string).collect();
            format!("1 to {} by `{measure}`, next grade from {} on", breaks.len() + 1, breaks.join(", "))
        }
    }
}

fn columns(set: &Finished) -> String {
    let (indicators, others): (Vec<&Column>, Vec<&Column>) =
        set.columns.iter().partition(|column| matches!(column.topic, Topic::Indicator { .. }));
    let row = |column: &Column| {
        let range = set.contents.ranges.get(&column.name);
        let constant = range.filter(|[least, largest]| least == largest);
        let value = constant.map_or(String::new(), |[value, _]| format!(" (always {})", short(*value)));
        let kind = if column.is_signal() { "; list of 32-bit numbers" } else { "" };
        format!("| `{}` | {} | {}{kind}{value} |\n", column.name, column.unit, column.description)
    };
    let mut text = format!(
        "## Columns\n\nOne row per record. Units and meanings are also in the files' metadata.\n\n| column | \
         unit | meaning |\n|---|---|---|\n{}",
        others.into_iter().map(row).collect::<String>()
    );
    if !indicators.is_empty() {
        let names: Vec<String> = indicators.iter().map(|column| format!("`{}`", column.name)).collect();
        text += &match &set.plan.content.keep.wheel {
            AveragedWheels::One(wheel) => format!(
                "\nIndicators of the analysed channel over the {}'s revolutions: {}.\n",
                wheel_words(wheel),
                names.join(", ")
            ),
            AveragedWheels::Each(wheels) => format!(
                "\nIndicators of the analysed channel over the revolutions of the {}, and likewise of {}: {}.\n",
                wheel_words(&wheels[0]),
                wheels[1..].join(", "),
                names[..names.len() / wheels.len()].join(", ")
            ),
        };
    }
    let names = set.columns.iter().filter(|column| is_empty(set, column));
    let empty: Vec<String> = names.map(|column| format!("`{}`", column.name)).collect();
    if !empty.is_empty() {
        text += &format!("\nNull in every record, and left out of Python's tables: {}.\n", empty.join(", "));
    }
    text + "\n"
}

/// Returns whether a column is null in every record.
fn is_empty(set: &Finished, column: &Column) -> bool {
    match column.cell_type {
        CellType::Float32List => false,
        // Of texts, only those of a fault can be null.
        CellType::Text => {
            column.name.starts_with("fault_")
                && set.plan.content.classes.iter().all(|class| class.faults.is_empty())
        }
        _ => !set.contents.ranges.contains_key(&column.name),
    }
}

fn files(set: &Finished) -> String {
    let bytes: u64 = set.contents.files.values().map(|file| file.bytes).sum();
    format!(
        "## Files\n\n{} in `data/`, {} each at most, {:.1} MB together. Every file has records of one split, in \
         random order, so that it is a mixture of all classes. `manifest.json` has counts, failures and the SHA-256 of every file.\n\n",
        counted(set.contents.files.len() as u64, "Parquet file"),
        counted(set.shards.records_per_shard, "record"),
        bytes as f64 / 1e6
    )
}

/// Says how programs load the data set.
fn loading(set: &Finished) -> String {
    let signal = set.columns.iter().find(|column| column.is_signal()).map_or("label", |column| &column.name);
    include_str!("loading.md")
        .replace("{signal}", signal)
        .replace("{train}", &set.shards.pattern("train"))
        .replace("{first}", &set.shards.name(0))
}

/// Writes a number with four digits.
fn short(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    if value == 0.0 || value.fract() == 0.0 && value.abs() < 1e7 {
        return format!("{value}");
    }
    if (1e-3..1e5).contains(&value.abs()) {
        let decimals = (3 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
        return format!("{value:.decimals$}");
    }
    format!("{value:.3e}")
}
