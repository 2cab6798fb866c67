//! Lists of the shards that a part has written. They stand until the manifest of the whole data set takes over what they say.
//!
//! A shard is listed before its file gets its name. Therefore every file that is there is in a list, even if the program is killed.
//! A list has a bounded number of shards, so that rewriting it with every shard takes little time.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};

use serde::{Deserialize, Serialize};
use serde_json::{Map, json};

use crate::contents::{SampledRecord, ShardContents, Summary};
use crate::error::DatasetError;
use crate::generate::Part;
use crate::manifest::FORMAT_VERSION;
use crate::sealed;
use crate::store::{Destination, Files};

/// Folder of the lists.
pub(crate) const FOLDER: &str = "parts";
/// Largest number of shards in a list.
const SHARDS: u64 = 256;

/// The contents of some shards of a part.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PartList {
    /// The shards by their numbers.
    pub shards: BTreeMap<u64, ShardContents>,
    /// Summary of all of them.
    pub summary: Summary,
}

/// A list as its file has it. Numbers are texts of exactly as many digits as are needed to read the same number back: JSON has no NaN.
#[derive(Deserialize)]
struct ListFile {
    plan_sha256: String,
    ranges: BTreeMap<String, [String; 2]>,
    first: BTreeMap<String, (u64, usize)>,
    /// Number, label, split and values of each record.
    sampled: Vec<(u64, String, String, String)>,
    shards: Vec<ListedShard>,
}

/// A shard as a list's file has it.
#[derive(Serialize, Deserialize)]
struct ListedShard<C = ShardContents> {
    shard: u64,
    #[serde(flatten)]
    contents: C,
}

impl PartList {
    /// The names of the lists among the names of files.
    pub fn names(files: &Files) -> impl Iterator<Item = &String> {
        files.keys().filter(|name| is_list(name))
    }

    /// Reads a list of a place; none where there is none, or where it is damaged or of another plan.
    ///
    /// # Arguments
    /// * `place` - where the list is
    /// * `name` - name of the list
    /// * `plan` - hash of the plan
    pub fn read(place: &Destination, name: &str, plan: &str) -> Result<Option<Self>, DatasetError> {
        Ok(place.text(name)?.and_then(|text| Self::parse(&text, plan)))
    }

    fn parse(text: &str, plan: &str) -> Option<Self> {
        let list: ListFile = sealed::is_whole(text).then(|| serde_json::from_str(text).ok()).flatten()?;
        if list.plan_sha256 != plan {
            return None;
        }
        let number = |text: &str| text.parse::<f64>().ok();
        let ends = |[least, largest]: [String; 2]| Some([number(&least)?, number(&largest)?]);
        let ranges = list.ranges.into_iter().map(|(name, range)| Some((name, ends(range)?)));
        let sampled = list.sampled.into_iter().map(|(record, label, split, values)| {
            let values = values.split_ascii_whitespace().map(number).collect::<Option<_>>()?;
            Some((record, SampledRecord { label, split, values }))
        });
        let summary = Summary {
            ranges: ranges.collect::<Option<_>>()?,
            first: list.first,
            sampled: sampled.collect::<Option<_>>()?,
        };
        let shards = list.shards.into_iter().map(|listed| (listed.shard, listed.contents));
        Some(Self { shards: shards.collect(), summary })
    }

    /// Writes the list.
    ///
    /// # Arguments
    /// * `to` - where it is written to; it needs a buffer
    /// * `plan` - hash of the plan
    pub fn write(&self, to: impl Write, plan: &str) -> io::Result<()> {
        let Summary { ranges, first, sampled } = &self.summary;
        let ranges =
            ranges.iter().map(|(name, range)| (name.clone(), json!(range.map(|end| end.to_string()))));
        let head = json!({
            "format_version": FORMAT_VERSION,
            "meshtone_version": env!("CARGO_PKG_VERSION"),
            "plan_sha256": plan,
            "ranges": ranges.collect::<Map<_, _>>(),
            "first": first,
        });
        let sampled = sampled.iter().map(|(record, SampledRecord { label, split, values })| {
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            (record, label, split, values.join(" "))
        });
        let shards = self.shards.iter().map(|(&shard, contents)| ListedShard { shard, contents });
        sealed::write(to, &head, |to| {
            write_lines(to, "sampled", sampled)?;
            write_lines(to, "shards", shards)
        })
    }
}

/// Writes an array, one element a line.
fn write_lines(
    to: &mut impl Write,
    name: &str,
    values: impl Iterator<Item = impl Serialize>,
) -> io::Result<()> {
    write!(to, ",\n  \"{name}\": [")?;
    for (number, value) in values.enumerate() {
        write!(to, "{}\n    ", if number == 0 { "" } else { "," })?;
        serde_json::to_writer(&mut *to, &value)?;
    }
    write!(to, "\n  ]")
}

/// Returns whether a file name is that of a list.
pub(crate) fn is_list(name: &str) -> bool {
    let number = || name.strip_prefix(FOLDER)?.strip_prefix('/')?.strip_suffix(".json");
    number().is_some_and(|number| number.split('-').count() == 4)
}

/// Writes the lists of a part.
pub(crate) struct Listing<'a> {
    to: &'a Destination,
    plan: String,
    part: Part,
    /// Number of the list among the part's lists.
    number: Option<u64>,
    list: PartList,
}

impl<'a> Listing<'a> {
    /// Creates a writer that has no list yet.
    ///
    /// # Arguments
    /// * `to` - where the part is written to
    /// * `plan` - hash of the plan
    /// * `part` - the part
    pub fn new(to: &'a Destination, plan: String, part: Part) -> Self {
        Self { to, plan, part, number: None, list: PartList::default() }
    }

    /// Lists a shard. It replaces what was listed of the same shard before.
    ///
    /// # Arguments
    /// * `shard` - number of the shard
    /// * `contents`, `summary` - what it holds
    pub fn add(&mut self, shard: u64, contents: ShardContents, summary: Summary) -> Result<(), DatasetError> {
        let number = self.number_of(shard);
        if self.number != Some(number) {
            let earlier = PartList::read(self.to, &self.name(number), &self.plan)?;
            self.list = earlier.unwrap_or_default();
            self.number = Some(number);
        }
        self.list.shards.insert(shard, contents);
        self.list.summary.add(summary);
        self.write(number)
    }

    /// The number of the list that has a shard.
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
    use meshtone::scenario::WarningKind;

    use crate::contents::{Counts, ShardFile, WarningCounts};
    use crate::digest::Digest;
    use crate::shard::FailedRecord;

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
        let counts = Counts::from([("train".to_owned(), [("a \"label\"".to_owned(), 7)].into())]);
        let failures = vec![FailedRecord { record: 18, reason: "why".to_owned() }];
        let warnings = WarningCounts::from([(WarningKind::StepError, 3)]);
        list.shards.insert(2, ShardContents { file, counts, warnings, failures });
        list.summary.ranges.insert("speed_hz".to_owned(), [0.1 + 0.2, 1e300]);
        list.summary.first.insert("label".to_owned(), (2, 3));
        let values = vec![1.0 / 3.0, f64::NAN, -0.0];
        list.summary.sampled.insert(17, SampledRecord { label: "l".into(), split: "s".into(), values });
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
