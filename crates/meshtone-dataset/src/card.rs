//! The data card: README.md.

use std::collections::BTreeMap;
use std::fmt::Write;

use meshtone::scenario::WarningKind;

use crate::contents::Contents;
use crate::manifest::PREVIEW;
use crate::plan::{Class, Growth, Plan, PlanFile, Severity, SplitBy, kinds};
use crate::shard::{Column, ColumnKind, Shards, WARNINGS};
use crate::words::counted;

/// The data card's text.
pub(crate) fn card(
    plan: &Plan,
    shards: Shards,
    contents: &Contents,
    units_of_split: &BTreeMap<String, u64>,
    columns: &[Column],
) -> String {
    let mut text = String::new();
    // Writing to a text cannot fail.
    let _ = head(&mut text, plan, contents);
    let _ = counts(&mut text, plan, contents, units_of_split);
    let _ = warnings(&mut text, plan, contents);
    let _ = classes(&mut text, plan, contents);
    let _ = questions(&mut text, plan);
    let _ = columns_table(&mut text, plan.content.keep.wheel.name(), columns, contents);
    let _ = files(&mut text, shards, contents);
    let _ = loading(&mut text, shards, columns);
    text
}

fn head(text: &mut String, plan: &Plan, contents: &Contents) -> std::fmt::Result {
    let about = &plan.about;
    writeln!(text, "# {}\n", about.title)?;
    if !about.description.is_empty() {
        writeln!(text, "{}\n", about.description.trim())?;
    }
    let rows = plan.records() - contents.failures.len() as u64;
    let keep = &plan.content.keep;
    let channels = match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => format!(
            "raw channels over {} of the {} at {} points each, of a sampling rate of {} S/s",
            counted(angle.revolutions as u64, "revolution"),
            keep.wheel.name(),
            angle.points_per_revolution,
            keep.sampling_rate_hz
        ),
        (None, Some(seconds)) => format!("raw channels at {} S/s over {seconds} s", keep.sampling_rate_hz),
        (None, None) => format!(
            "raw channels at {} S/s over one hunting period, after which the same teeth meet again",
            keep.sampling_rate_hz
        ),
    };
    let mountings = plan.content.mountings;
    let mounted = if mountings > 1 { format!(", each mounted {mountings} times") } else { String::new() };
    writeln!(
        text,
        "{} of spur gear vibration from {} (pairs of wheels){mounted}, {channels}. \
         Made with Meshtone {} from `{}`, which makes the same bytes again; the base scenario \
         is `{}`.\n",
        counted(rows, "simulated record"),
        counted(plan.content.units, "unit"),
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

fn counts(
    text: &mut String,
    plan: &Plan,
    contents: &Contents,
    units_of_split: &BTreeMap<String, u64>,
) -> std::fmt::Result {
    writeln!(text, "## What is in it\n")?;
    let splits = plan.content.splits.names_in(units_of_split);
    writeln!(text, "| class | {} | all |", splits.join(" | "))?;
    writeln!(text, "|---|{}---:|", "---:|".repeat(splits.len()))?;
    let count = |split: &str, label: &str| {
        contents.counts.get(&(split.to_owned(), label.to_owned())).copied().unwrap_or(0)
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
fn warnings(text: &mut String, plan: &Plan, contents: &Contents) -> std::fmt::Result {
    if contents.warnings.is_empty() {
        return Ok(());
    }
    let rows = plan.records() - contents.failures.len() as u64;
    writeln!(
        text,
        "## Warnings\n\nWhat is doubtful about the simulations, by its code in the column `{WARNINGS}`, of {}.\n",
        counted(rows, "record")
    )?;
    writeln!(text, "| code | records | meaning |\n|---|---:|---|")?;
    for (code, count) in &contents.warnings {
        let meaning = WarningKind::of_code(code).map_or("", WarningKind::meaning);
        writeln!(text, "| `{code}` | {count} | {meaning} |")?;
    }
    writeln!(text)
}

fn classes(text: &mut String, plan: &Plan, contents: &Contents) -> std::fmt::Result {
    writeln!(text, "## Classes\n\n| label | fault | severity |\n|---|---|---|")?;
    for class in &plan.content.classes {
        let fault = kinds(&class.faults).unwrap_or_else(|| "none".to_owned());
        let grows = class.growth.as_ref().map(grows).unwrap_or_default();
        writeln!(text, "| {} | {fault}{grows} | {} |", class.label, severity(class))?;
    }
    writeln!(text, "\n## How it was drawn\n\nDesign: {}. \n", design(plan))?;
    writeln!(text, "| column | key | for each | least | largest |\n|---|---|---|---:|---:|")?;
    let rules = plan.content.rules.iter().chain(plan.content.classes.iter().flat_map(|class| &class.rules));
    let mut seen = Vec::new();
    for rule in rules {
        for key in &rule.keys {
            let name = crate::shard::column_name(key);
            if seen.contains(&name) {
                continue;
            }
            let [least, largest] = contents.seen.ranges.get(&name).copied().unwrap_or([f64::NAN; 2]);
            writeln!(
                text,
                "| `{name}` | `{key}` | {} | {} | {} |",
                rule.level.name(),
                short(least),
                short(largest)
            )?;
            seen.push(name);
        }
    }
    writeln!(text)
}

/// What the data set asks, and how answers are scored.
fn questions(text: &mut String, plan: &Plan) -> std::fmt::Result {
    if plan.about.questions.is_empty() {
        return Ok(());
    }
    writeln!(text, "## Questions\n\n| question | to be told | score |\n|---|---|---|")?;
    for question in &plan.about.questions {
        writeln!(text, "| {} | {} | {} |", question.name(), question.target(), question.score())?;
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

fn design(plan: &Plan) -> &'static str {
    use crate::sampling::Design;
    match plan.content.design {
        Design::Independent => "independent draws",
        Design::LatinHypercube => "Latin hypercube",
        Design::Sobol => "scrambled Sobol sequence",
    }
}

fn columns_table(
    text: &mut String,
    wheel: &str,
    columns: &[Column],
    contents: &Contents,
) -> std::fmt::Result {
    writeln!(text, "## Columns\n\nOne row a record. Units and meanings stand in the files' metadata too.\n")?;
    writeln!(text, "| column | unit | meaning |\n|---|---|---|")?;
    for column in columns.iter().filter(|column| !matches!(column.kind, ColumnKind::Indicator(_))) {
        let constant = contents.seen.ranges.get(&column.name).filter(|[least, largest]| least == largest);
        let value = constant.map_or(String::new(), |[value, _]| format!(" (always {})", short(*value)));
        let kind = if column.kind.is_signal() { "; list of 32-bit numbers" } else { "" };
        writeln!(text, "| `{}` | {} | {}{kind}{value} |", column.name, column.unit, column.description)?;
    }
    let indicators: Vec<String> = columns
        .iter()
        .filter(|column| matches!(column.kind, ColumnKind::Indicator(_)))
        .map(|column| format!("`{}`", column.name))
        .collect();
    if !indicators.is_empty() {
        writeln!(
            text,
            "\nIndicators of the analysed channel over the {wheel}'s revolutions: {}.",
            indicators.join(", ")
        )?;
    }
    writeln!(text)
}

fn files(text: &mut String, shards: Shards, contents: &Contents) -> std::fmt::Result {
    let bytes: u64 = contents.files.values().map(|file| file.digest.bytes).sum();
    writeln!(
        text,
        "## Files\n\n{} in `data/`, {} each, {:.1} MB together. Records are in random order, so that every file \
         is a mixture of all classes. `manifest.json` has counts, failures and the SHA-256 of every file.\n",
        counted(contents.files.len() as u64, "Parquet file"),
        counted(shards.records_per_shard, "record"),
        bytes as f64 / 1e6
    )
}

fn loading(text: &mut String, shards: Shards, columns: &[Column]) -> std::fmt::Result {
    let signal = columns.iter().find(|column| column.kind.is_signal()).map_or("label", |column| &column.name);
    let all = shards.pattern();
    let first = shards.name(0);
    writeln!(
        text,
        "## Loading

In this folder. With Meshtone's Python package, which reads only what is asked for:

```python
from meshtone import load_dataset

train = load_dataset(\".\").split(\"train\")
table, first = train.to_pandas(), train.signals(\"{signal}\")[0]
```

With pandas and pyarrow:

```python
import numpy as np
import pandas as pd

train = pd.read_parquet(\"data\", filters=[(\"split\", \"==\", \"train\")], columns=[\"label\", \"{signal}\"])
first = np.asarray(train[\"{signal}\"].iloc[0])
```

With polars:

```python
import polars as pl

lazy = pl.scan_parquet(\"{all}\")
train = lazy.filter(pl.col(\"split\") == \"train\").select(\"label\", \"severity\", \"{signal}\").collect()
```

With Dask:

```python
import dask.dataframe as dd

lazy = dd.read_parquet(\"{all}\", columns=[\"label\", \"split\", \"severity\", \"{signal}\"])
train = lazy[lazy[\"split\"] == \"train\"].compute()
```

MATLAB:

```matlab
records = parquetread(\"{first}\");
train = records(records.split == \"train\", :);
first = train.{signal}{{1}};
```

Rust, with the crates `parquet` and `arrow`:

```rust
use std::fs::File;
use arrow::array::AsArray;
use arrow::datatypes::Float32Type;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

let file = File::open(\"{first}\")?;
for batch in ParquetRecordBatchReaderBuilder::try_new(file)?.build()? {{
    let batch = batch?;
    let signals = batch.column_by_name(\"{signal}\").unwrap().as_list::<i32>();
    let first = signals.value(0);
    let first = first.as_primitive::<Float32Type>().values();
}}
```"
    )
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
