//! What a part has made, written down shard by shard until the manifest of the whole data set takes it over.
//!
//! A shard is listed before its file gets its name: every file that is there is in a list, also where the program is killed.
//! A list has a bounded number of shards, so that writing it anew with every shard takes little time.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};

use serde_json::{Map, Value, json};

use crate::contents::{Counts, SampledRecord, Seen, ShardContents, ShardFile};
use crate::digest::{Digest, Hash};
use crate::error::DatasetError;
use crate::generate::Part;
use crate::manifest::{FORMAT_VERSION, counts_table};
use crate::sealed;
use crate::shard::FailedRecord;
use crate::store::Destination;

/// Folder of the lists.
pub(crate) const FOLDER: &str = "parts";
/// Shards in a list at most.
const SHARDS: u64 = 256;

/// What some shards of a part hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PartList {
    /// By their numbers.
    pub shards: BTreeMap<u64, ShardContents>,
    /// Of all of them.
    pub seen: Seen,
}

impl PartList {
    /// The names of lists among those of files.
    pub fn names(files: &BTreeMap<String, u64>) -> impl Iterator<Item = &String> {
        files.keys().filter(|name| is_list(name))
    }

    /// Reads a list; none where it is damaged, or of another plan.
    ///
    /// # Arguments
    /// * `text` - of the list
    /// * `plan` - hash of the plan
    pub fn parse(text: &str, plan: &str) -> Option<Self> {
        let list: Value = sealed::is_whole(text).then(|| serde_json::from_str(text).ok()).flatten()?;
        if list["plan_sha256"].as_str() != Some(plan) {
            return None;
        }
        let shards = list["shards"].as_array()?.iter().map(read_shard).collect::<Option<_>>()?;
        let ranges = list["ranges"]
            .as_object()?
            .iter()
            .map(|(name, range)| Some((name.clone(), [number(&range[0])?, number(&range[1])?])));
        let first = list["first"].as_object()?.iter().map(|(label, place)| {
            Some((label.clone(), (place[0].as_u64()?, usize::try_from(place[1].as_u64()?).ok()?)))
        });
        let sampled = list["sampled"].as_array()?.iter().map(read_sampled);
        let seen = Seen {
            ranges: ranges.collect::<Option<_>>()?,
            first: first.collect::<Option<_>>()?,
            sampled: sampled.collect::<Option<_>>()?,
        };
        Some(Self { shards, seen })
    }

    /// Writes the list.
    ///
    /// # Arguments
    /// * `to` - where it is written to; it needs a buffer
    /// * `plan` - hash of the plan
    pub fn write(&self, to: impl Write, plan: &str) -> io::Result<()> {
        let ranges = self.seen.ranges.iter().map(|(name, range)| (name.clone(), json!(range.map(exact))));
        let first = self.seen.first.iter().map(|(label, place)| (label.clone(), json!([place.0, place.1])));
        let sampled = self.seen.sampled.iter().map(|(record, sampled)| {
            let values: Vec<String> = sampled.values.iter().map(|&value| exact(value)).collect();
            json!([record, sampled.label, sampled.split, values.join(" ")])
        });
        let head = json!({
            "format_version": FORMAT_VERSION,
            "meshtone_version": env!("CARGO_PKG_VERSION"),
            "plan_sha256": plan,
            "ranges": ranges.collect::<Map<_, _>>(),
            "first": first.collect::<Map<_, _>>(),
        });
        let sampled: Vec<Value> = sampled.collect();
        let shards: Vec<Value> = self.shards.iter().map(shard_value).collect();
        sealed::write(to, head.as_object().unwrap_or(&Map::new()), |to| {
            write_lines(to, "sampled", &sampled)?;
            write_lines(to, "shards", &shards)
        })
    }
}

/// An array, an element a line.
fn write_lines(to: &mut impl Write, name: &str, values: &[Value]) -> io::Result<()> {
    write!(to, ",\n  \"{name}\": [")?;
    for (number, value) in values.iter().enumerate() {
        write!(to, "{}\n    {value}", if number == 0 { "" } else { "," })?;
    }
    write!(to, "\n  ]")
}

/// Whether a name is one of a list.
pub(crate) fn is_list(name: &str) -> bool {
    let number = || name.strip_prefix(FOLDER)?.strip_prefix('/')?.strip_suffix(".json");
    number().is_some_and(|number| number.split('-').count() == 4)
}

fn shard_value((shard, of_shard): (&u64, &ShardContents)) -> Value {
    let ShardContents { file, counts, warnings, failures } = of_shard;
    let failures = failures.iter().map(|f| json!({ "record": f.record, "reason": f.reason }));
    json!({
        "shard": shard,
        "bytes": file.digest.bytes,
        "sha256": file.digest.sha256.to_string(),
        "rows": file.rows,
        "counts": counts_table(counts),
        "warnings": warnings,
        "failures": failures.collect::<Vec<_>>(),
    })
}

fn read_shard(value: &Value) -> Option<(u64, ShardContents)> {
    let digest = Digest { bytes: value["bytes"].as_u64()?, sha256: Hash::parse(value["sha256"].as_str()?)? };
    let mut counts = Counts::new();
    for (split, labels) in value["counts"].as_object()? {
        for (label, count) in labels.as_object()? {
            counts.insert((split.clone(), label.clone()), count.as_u64()?);
        }
    }
    let failures =
        value["failures"].as_array()?.iter().map(FailedRecord::from_json).collect::<Option<_>>()?;
    let file = ShardFile { digest, rows: value["rows"].as_u64()? };
    // Lists of manifests before format 3 have none.
    let warnings = match value.get("warnings") {
        None => BTreeMap::new(),
        Some(codes) => {
            let codes = codes.as_object()?.iter();
            codes.map(|(code, count)| Some((code.clone(), count.as_u64()?))).collect::<Option<_>>()?
        }
    };
    Some((value["shard"].as_u64()?, ShardContents { file, counts, warnings, failures }))
}

fn read_sampled(value: &Value) -> Option<(u64, SampledRecord)> {
    let text = |place: usize| value[place].as_str().map(str::to_owned);
    let values = value[3].as_str()?.split_ascii_whitespace().map(|word| word.parse().ok());
    let (label, split, values) = (text(1)?, text(2)?, values.collect::<Option<_>>()?);
    Some((value[0].as_u64()?, SampledRecord { label, split, values }))
}

/// The digits by which the very same number is read back; JSON has no NaN.
fn exact(value: f64) -> String {
    value.to_string()
}

fn number(value: &Value) -> Option<f64> {
    value.as_str()?.parse().ok()
}

/// The list that a part is writing.
pub(crate) struct Listing<'a> {
    to: &'a Destination,
    plan: String,
    part: Part,
    /// Which of the part's lists.
    number: Option<u64>,
    list: PartList,
}

impl<'a> Listing<'a> {
    /// Begins with no list.
    ///
    /// # Arguments
    /// * `to` - where the part is written to
    /// * `plan` - hash of the plan
    /// * `part` - which part
    pub fn new(to: &'a Destination, plan: String, part: Part) -> Self {
        Self { to, plan, part, number: None, list: PartList::default() }
    }

    /// Lists a shard, in the place of what was listed of it.
    ///
    /// # Arguments
    /// * `shard` - its number
    /// * `of_shard`, `seen` - what it holds
    pub fn add(&mut self, shard: u64, of_shard: ShardContents, seen: Seen) -> Result<(), DatasetError> {
        let number = self.number_of(shard);
        if self.number != Some(number) {
            let earlier =
                self.to.text(&self.name(number))?.and_then(|text| PartList::parse(&text, &self.plan));
            self.list = earlier.unwrap_or_default();
            self.number = Some(number);
        }
        self.list.shards.insert(shard, of_shard);
        self.list.seen.add(seen);
        self.write(number)
    }

    /// Which of the part's lists has a shard.
    fn number_of(&self, shard: u64) -> u64 {
        shard / self.part.of / SHARDS
    }

    fn name(&self, number: u64) -> String {
        format!("{FOLDER}/part-{}-{}-{number:06}.json", self.part.number, self.part.of)
    }

    fn write(&self, number: u64) -> Result<(), DatasetError> {
        self.to.write(&self.name(number), |file| self.list.write(BufWriter::new(file), &self.plan))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::contents::WarningCounts;

    impl Listing<'_> {
        /// Lists many shards, each list being written once.
        pub fn add_all(
            &mut self,
            shards: impl Iterator<Item = (u64, ShardContents)>,
        ) -> Result<(), DatasetError> {
            for (shard, of_shard) in shards {
                let number = self.number_of(shard);
                if let Some(before) = self.number.replace(number).filter(|before| *before != number) {
                    self.write(before)?;
                    self.list = PartList::default();
                }
                self.list.shards.insert(shard, of_shard);
            }
            self.number.map_or(Ok(()), |last| self.write(last))
        }
    }

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let mut list = PartList::default();
        let file = ShardFile { digest: Digest::of(b"abc"), rows: 7 };
        let counts = Counts::from([(("train".to_owned(), "a \"label\"".to_owned()), 7)]);
        let failures = vec![FailedRecord { record: 18, reason: "why".to_owned() }];
        let warnings = WarningCounts::from([("step-error".to_owned(), 3)]);
        list.shards.insert(2, ShardContents { file, counts, warnings, failures });
        list.seen.ranges.insert("speed_hz".to_owned(), [0.1 + 0.2, 1e300]);
        list.seen.first.insert("label".to_owned(), (2, 3));
        let values = vec![1.0 / 3.0, f64::NAN, -0.0];
        list.seen.sampled.insert(17, SampledRecord { label: "l".into(), split: "s".into(), values });
        let mut text = Vec::new();
        list.write(&mut text, "plan").unwrap();
        let text = String::from_utf8(text).unwrap();
        let read = PartList::parse(&text, "plan").unwrap();
        // Not a number is not equal to itself.
        assert_eq!(format!("{read:?}"), format!("{list:?}"));
        assert_eq!(PartList::parse(&text, "another"), None);
        assert_eq!(PartList::parse(&text.replace("why", "who"), "plan"), None);
        assert!(is_list("parts/part-2-8-000000.json") && !is_list("parts/notes.json"));
    }
}
