//! The data card: README.md.

use std::fmt::{Result, Write};

use meshtone::scenario::WarningKind;

use crate::finish::Finished;
use crate::manifest::PREVIEW;
use crate::plan::{Class, Growth, PlanFile, Severity, SplitBy, kinds};
use crate::sampling::Design;
use crate::shard::{Column, Topic, WARNINGS, column_name, varied_keys};
use crate::words::counted;

/// The data card's text.
pub(crate) fn card(set: &Finished) -> String {
    let mut text = String::new();
    for section in [head, counts, warnings, classes, draws, questions, columns, files] {
        // Writing to a text cannot fail.
        let _ = section(&mut text, set);
    }
    text + &loading(set)
}

fn head(text: &mut String, set: &Finished) -> Result {
    let (about, keep) = (&set.plan.about, &set.plan.content.keep);
    writeln!(text, "# {}\n", about.title)?;
    if !about.description.is_empty() {
        writeln!(text, "{}\n", about.description.trim())?;
    }
    let rate = format!("{} S/s", keep.sampling_rate_hz);
    let channels = match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => format!(
            "raw channels over {} of the {} at {} points each, of a sampling rate of {rate}",
            counted(angle.revolutions as u64, "revolution"),
            keep.wheel.name(),
            angle.points_per_revolution,
        ),
        (None, Some(seconds)) => format!("raw channels at {rate} over {seconds} s"),
        (None, None) => {
            format!("raw channels at {rate} over one hunting period, after which the same teeth meet again")
        }
    };
    let mountings = set.plan.content.mountings;
    let mounted = if mountings > 1 { format!(", each mounted {mountings} times") } else { String::new() };
    writeln!(
        text,
        "{} of spur gear vibration from {} (pairs of wheels){mounted}, {channels}. \
         Made with Meshtone {} from `{}`, which makes the same bytes again; the base scenario \
         is `{}`.\n",
        counted(set.records(), "simulated record"),
        counted(set.plan.content.units, "unit"),
        env!("CARGO_PKG_VERSION"),
        PlanFile::NAMES[0],
        PlanFile::NAMES[1]
    )?;
    writeln!(text, "**Licence of the data: {}.**\n", about.licence)?;
    writeln!(
        text,
        "![Examples of each class, distributions of the keys, indicators by class]({})\n",
        PREVIEW[1]
    )
}

fn counts(text: &mut String, set: &Finished) -> Result {
    let (plan, contents) = (set.plan, set.contents);
    writeln!(text, "## What is in it\n")?;
    let units_of_split = plan.content.units_of_split();
    let splits = plan.content.splits.names_in(&units_of_split);
    writeln!(text, "| class | {} | all |", splits.join(" | "))?;
    writeln!(text, "|---|{}---:|", "---:|".repeat(splits.len()))?;
    let count = |split: &str, label: &str| {
        contents.counts.get(split).and_then(|labels| labels.get(label)).copied().unwrap_or(0)
    };
    let row = |name: &str, numbers: Vec<u64>| {
        let all: u64 = numbers.iter().sum();
        let cells: Vec<String> = numbers.iter().map(u64::to_string).collect();
        format!("| {name} | {} | {all} |", cells.join(" | "))
    };
    for class in &plan.content.classes {
        let numbers = splits.iter().map(|split| count(split, &class.label)).collect();
        writeln!(text, "{}", row(&class.label, numbers))?;
    }
    let units = splits.iter().map(|split| units_of_split.get(*split).copied().unwrap_or(0)).collect();
    let (divided, meaning) = match plan.content.splits.by {
        SplitBy::Unit => (
            "unit",
            "all records of a pair of wheels are in one split, so that nothing about particular wheels that was learned in training \
             helps in the test",
        ),
        SplitBy::Mounting => (
            "mounting",
            "all records of a pair of wheels as it was put together once are in one split, which may share the wheels with others, \
             mounted anew: what was learned in training about particular wheels helps in the test, about a mounting it does not",
        ),
    };
    writeln!(text, "{}\n", row(&format!("*{divided}s*"), units))?;
    writeln!(text, "**Splits are by {divided}**: {meaning}.")?;
    for shift in &plan.content.splits.shifts {
        let when: Vec<String> = shift.when.iter().map(|condition| format!("`{condition}`")).collect();
        writeln!(
            text,
            "The split `{}` is unlike the training: {} holds for its records and for no other ones, in every class that has \
             such a number.",
            shift.name,
            when.join(" and ")
        )?;
    }
    writeln!(text)?;
    if !contents.failures.is_empty() {
        writeln!(
            text,
            "Of the plan's {} records {} could not be simulated and are missing; `manifest.json` lists them with the reasons.\n",
            plan.records(),
            contents.failures.len()
        )?;
    }
    Ok(())
}

/// What is doubtful, and of how many records.
fn warnings(text: &mut String, set: &Finished) -> Result {
    let warnings = &set.contents.warnings;
    if warnings.is_empty() {
        return Ok(());
    }
    writeln!(
        text,
        "## Warnings\n\nWhat is doubtful about the simulations, by its code in the column `{WARNINGS}`, of {}.\n",
        counted(set.records(), "record")
    )?;
    writeln!(text, "| code | records | meaning |\n|---|---:|---|")?;
    for (code, count) in warnings {
        let meaning = WarningKind::of_code(code).map_or("", WarningKind::meaning);
        writeln!(text, "| `{code}` | {count} | {meaning} |")?;
    }
    writeln!(text)
}

fn classes(text: &mut String, set: &Finished) -> Result {
    writeln!(text, "## Classes\n\n| label | fault | severity |\n|---|---|---|")?;
    for class in &set.plan.content.classes {
        let fault = kinds(&class.faults).unwrap_or_else(|| "none".to_owned());
        let grows = class.growth.as_ref().map(grows).unwrap_or_default();
        writeln!(text, "| {} | {fault}{grows} | {} |", class.label, severity(class))?;
    }
    writeln!(text)
}

fn draws(text: &mut String, set: &Finished) -> Result {
    let design = match set.plan.content.design {
        Design::Independent => "independent draws",
        Design::LatinHypercube => "Latin hypercube",
        Design::Sobol => "scrambled Sobol sequence",
    };
    writeln!(text, "## How it was drawn\n\nDesign: {design}. \n")?;
    writeln!(text, "| column | key | for each | least | largest |\n|---|---|---|---:|---:|")?;
    for (rule, key) in varied_keys(&set.plan.content) {
        let name = column_name(key);
        let [least, largest] = set.contents.summary.ranges.get(&name).copied().unwrap_or([f64::NAN; 2]);
        let (level, least, largest) = (rule.level.name(), short(least), short(largest));
        writeln!(text, "| `{name}` | `{key}` | {level} | {least} | {largest} |")?;
    }
    writeln!(text)
}

/// What the data set asks, and how answers are scored.
fn questions(text: &mut String, set: &Finished) -> Result {
    let questions = &set.plan.about.questions;
    if questions.is_empty() {
        return Ok(());
    }
    writeln!(text, "## Questions\n\n| question | to be told | score |\n|---|---|---|")?;
    for question in questions {
        let [target, score] = question.target_and_score();
        writeln!(text, "| {} | {target} | {score} |", question.name())?;
    }
    writeln!(
        text,
        "\nFrom the signals, the indicators and what is known of a machine: teeth, module, face width, speed, load. Columns of the \
         fault, seeds, numbers of records, units and mountings, and all that was drawn besides are not known of a real gear: they are \
         there to see where an answer fails. Train on `train`, choose on `validation`.\n"
    )
}

/// How a damage grows, in words.
fn grows(growth: &Growth) -> String {
    let Growth { law, start, failure, censored, life_rev, .. } = growth;
    let name = law.name();
    format!(
        ", which grows by the law `{name}` from severity {start} to failure at {failure} after a life, `{}`, that each run draws; a run \
         is stopped before with a probability of {censored}",
        life_rev.name()
    )
}

fn severity(class: &Class) -> String {
    match &class.severity {
        _ if class.faults.is_empty() => "0".to_owned(),
        Severity::Grade(grade) => grade.to_string(),
        Severity::Measured { measure, breaks } => {
            let breaks: Vec<String> = breaks.iter().map(|limit| format!("{limit}")).collect();
            format!("1 to {} by `{measure}`, next grade from {} on", breaks.len() + 1, breaks.join(", "))
        }
    }
}

fn columns(text: &mut String, set: &Finished) -> Result {
    let is_indicator = |column: &Column| matches!(column.topic, Topic::Indicator(_));
    writeln!(text, "## Columns\n\nOne row a record. Units and meanings stand in the files' metadata too.\n")?;
    writeln!(text, "| column | unit | meaning |\n|---|---|---|")?;
    for column in set.columns.iter().filter(|column| !is_indicator(column)) {
        let constant =
            set.contents.summary.ranges.get(&column.name).filter(|[least, largest]| least == largest);
        let value = constant.map_or(String::new(), |[value, _]| format!(" (always {})", short(*value)));
        let kind = if column.is_signal() { "; list of 32-bit numbers" } else { "" };
        writeln!(text, "| `{}` | {} | {}{kind}{value} |", column.name, column.unit, column.description)?;
    }
    let indicators = set.columns.iter().filter(|column| is_indicator(column));
    let indicators: Vec<String> = indicators.map(|column| format!("`{}`", column.name)).collect();
    if !indicators.is_empty() {
        writeln!(
            text,
            "\nIndicators of the analysed channel over the {}'s revolutions: {}.",
            set.plan.content.keep.wheel.name(),
            indicators.join(", ")
        )?;
    }
    writeln!(text)
}

fn files(text: &mut String, set: &Finished) -> Result {
    let bytes: u64 = set.contents.files.values().map(|file| file.digest.bytes).sum();
    writeln!(
        text,
        "## Files\n\n{} in `data/`, {} each, {:.1} MB together. Records are in random order, so that every file \
         is a mixture of all classes. `manifest.json` has counts, failures and the SHA-256 of every file.\n",
        counted(set.contents.files.len() as u64, "Parquet file"),
        counted(set.shards.records_per_shard, "record"),
        bytes as f64 / 1e6
    )
}

/// How programs load the data set.
fn loading(set: &Finished) -> String {
    let signal = set.columns.iter().find(|column| column.is_signal()).map_or("label", |column| &column.name);
    include_str!("loading.md")
        .replace("{signal}", signal)
        .replace("{all}", set.shards.pattern())
        .replace("{first}", &set.shards.name(0))
}

/// Four digits.
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
