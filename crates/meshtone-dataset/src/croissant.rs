//! Croissant 1.0 metadata, <https://docs.mlcommons.org/croissant/docs/croissant-spec.html>: croissant.json.

use meshtone_io::table::CellType;
use serde_json::{Value, json};

use crate::finish::Finished;
use crate::manifest::{Document, MANIFEST};
use crate::plan::About;
use crate::shard::{Column, Shards};

const CONFORMS_TO: &str = "http://mlcommons.org/croissant/1.0";
/// Identifiers of the files of records, of their rows, and of the list of splits.
const SHARDS: &str = "shards";
const RECORDS: &str = "records";
const SPLITS: &str = "splits";

const SIMULATED: &str = concat!("simulated with Meshtone ", env!("CARGO_PKG_VERSION"));

/// How a data set is to be cited.
pub(crate) fn citation(about: &About) -> String {
    let by_title = || {
        let creator = about.creator.as_ref().map(|name| format!("{name}: ")).unwrap_or_default();
        let doi = about.doi.as_ref().map(|doi| format!(", https://doi.org/{doi}")).unwrap_or_default();
        format!("{creator}{}, version {}, {SIMULATED}{doi}", about.title, about.version)
    };
    about.citation.clone().unwrap_or_else(by_title)
}

/// The metadata's text.
///
/// # Arguments
/// * `documents` - all files but the shards, the manifest and the metadata themselves; the manifest has their digest
pub(crate) fn metadata(set: &Finished, documents: &[Document]) -> String {
    let Finished { plan, shards, columns, .. } = *set;
    let about = &plan.about;
    let description = match about.description.trim() {
        "" => format!("{}, {SIMULATED}", about.title),
        description => description.to_owned(),
    };
    let mut metadata = json!({
        "@context": serde_json::from_str::<Value>(CONTEXT).unwrap_or_default(),
        "@type": "sc:Dataset",
        "conformsTo": CONFORMS_TO,
        "name": about.title,
        "description": description,
        "license": about.licence,
        "version": about.version,
        "citeAs": citation(about),
        "distribution": distribution(shards, documents),
        "recordSet": [of_splits(&plan.content.units_of_split()), of_records(columns)],
    });
    let creator = about.creator.as_ref().map(|name| json!({ "@type": "sc:Organization", "name": name }));
    let doi = about.doi.as_ref().map(|doi| json!(format!("https://doi.org/{doi}")));
    let [day, url] = [&about.published, &about.url].map(|text| text.as_ref().map(|text| json!(text)));
    for (key, value) in [("datePublished", day), ("creator", creator), ("url", url), ("sameAs", doi)] {
        if let Some(value) = value {
            metadata[key] = value;
        }
    }
    format!("{metadata:#}\n")
}

/// The meanings of the words in the metadata: the context that the specification prescribes, and those words of the vocabularies on
/// responsible use and on sampling rates without which the standard's own library gives warnings.
const CONTEXT: &str = include_str!("croissant_context.json");

/// The files. That of all hashes cannot stand here with its own, as it has this file's; nor do a million shards.
fn distribution(shards: &Shards, documents: &[Document]) -> Value {
    let manifest = "counts, failures, and the SHA-256 of every file";
    let file_sets = [
        (SHARDS, &*shards.pattern("*"), "application/x-parquet", "the records, of one split in each file"),
        ("manifest", MANIFEST, "application/json", manifest),
    ];
    let file_sets = file_sets.map(|(id, includes, format, description)| {
        json!({
            "@type": "cr:FileSet",
            "@id": id,
            "name": id,
            "description": description,
            "encodingFormat": format,
            "includes": includes,
        })
    });
    let files = documents.iter().map(|Document { name, digest }| {
        json!({
            "@type": "cr:FileObject",
            "@id": name,
            "name": name,
            "contentUrl": name,
            "contentSize": format!("{} B", digest.bytes),
            "encodingFormat": media_type(name),
            "sha256": digest.sha256,
        })
    });
    file_sets.into_iter().chain(files).collect()
}

fn media_type(name: &str) -> &'static str {
    match name.rsplit_once('.') {
        Some((_, "md")) => "text/markdown",
        Some((_, "svg")) => "image/svg+xml",
        Some((_, "png")) => "image/png",
        Some((_, "toml")) => "application/toml",
        _ => "text/plain",
    }
}

/// The list of splits, which a record's split refers to.
fn of_splits(splits: &[(&str, u64)]) -> Value {
    let (name, url) = (format!("{SPLITS}/name"), format!("{SPLITS}/url"));
    let data = splits.iter().map(|(split, _)| {
        let kind = match *split {
            "train" => "cr:TrainingSplit",
            "validation" => "cr:ValidationSplit",
            // Shifts are held out as the test is.
            _ => "cr:TestSplit",
        };
        json!({ &name: split, &url: kind })
    });
    json!({
        "@type": "cr:RecordSet",
        "@id": SPLITS,
        "name": SPLITS,
        "dataType": "cr:Split",
        "key": { "@id": name },
        "field": [
            { "@type": "cr:Field", "@id": name, "name": "name", "dataType": "sc:Text" },
            { "@type": "cr:Field", "@id": url, "name": "url", "dataType": ["sc:URL", "cr:Split"] },
        ],
        "data": data.collect::<Vec<Value>>(),
    })
}

fn of_records(columns: &[Column]) -> Value {
    json!({
        "@type": "cr:RecordSet",
        "@id": RECORDS,
        "name": RECORDS,
        "description": "One row a record.",
        "key": { "@id": format!("{RECORDS}/record") },
        "field": columns.iter().map(field).collect::<Vec<Value>>(),
    })
}

fn field(column: &Column) -> Value {
    let description = match column.unit.as_str() {
        "" | "-" => column.description.clone(),
        unit => format!("{}; unit: {unit}", column.description),
    };
    let mut field = json!({
        "@type": "cr:Field",
        "@id": format!("{RECORDS}/{}", column.name),
        "name": column.name,
        "description": description,
        "dataType": data_type(column),
        "source": { "fileSet": { "@id": SHARDS }, "extract": { "column": column.name } },
    });
    if column.is_signal() {
        field["repeated"] = json!(true);
    }
    if column.name == "split" {
        field["references"] = json!({ "field": { "@id": format!("{SPLITS}/name") } });
    }
    field
}

fn data_type(column: &Column) -> Value {
    let cells = match column.cell_type {
        CellType::Int32 | CellType::Int64 => "sc:Integer",
        CellType::Float64 | CellType::Float32List => "sc:Float",
        CellType::Text => "sc:Text",
    };
    if column.name == "label" { json!([cells, "cr:Label"]) } else { json!(cells) }
}
