//! Reference sets on disk, in batches: a set that was begun is gone on with, and one that is there is read.

use std::env::var_os;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use meshtone::PHYSICS_VERSION;
use meshtone::batch::Control;
use meshtone_fourier::Complex64;
use meshtone_io::atomic_file::{WriteFileError, write_atomically};
use meshtone_io::npz::{NpzReader, NpzWriter};
use meshtone_learn::{MESH_ORDERS, WheelLines, separations};
use rayon::prelude::*;
use serde_json::json;
use sha2::{Digest, Sha256};

use crate::draw::{DrawnFault, RECORDS_PER_UNIT};
use crate::prior::Prior;
use crate::reference::{ReferenceRecord, ReferenceSet, build_reference};

/// Raised when a record of the same number becomes another one, or its file another.
const FORMAT: u32 = 5;
/// Records of a batch, which is one file: whole pairs of wheels.
const BATCH: u64 = 512;
/// Numbers of a record beside its lines: its own, kind, wheel, tooth, whether on one, severity, speed.
const COLUMNS: usize = 7;
/// Sizes of a damage, at most.
const SIZES: usize = 6;

/// All numbers of a record: these, the number of its sizes, and the sizes.
const WIDTH: usize = COLUMNS + 1 + SIZES;

/// A reference set that could not be kept.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file or folder that could not be written.
    #[error(transparent)]
    File(#[from] WriteFileError),
    /// The caller has stopped it; what is finished stays.
    #[error(
        "cancelled; the batches of simulations that are finished are kept, and the next question goes on with them"
    )]
    Cancelled,
}

/// Store of reference sets: a folder for each prior, named after what it says and the program's version.
#[derive(Debug, Clone)]
pub struct ReferenceStore {
    folder: PathBuf,
}

impl ReferenceStore {
    /// Simulations that are kept together, in one file: whole pairs of wheels.
    pub const BATCH: u64 = BATCH;
    /// Simulations to learn from, where no other number is asked for.
    pub const USUAL_RECORDS: u64 = 6144;
    /// Most simulations to learn from: time and memory grow with their square; so many take 70 s and 0.7 GB.
    pub const MOST_RECORDS: u64 = 20_480;

    /// # Arguments
    /// * `folder` - in which the sets are; made where it is not there
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// Default folder of the sets, in the user's folder for what can be made again. None where the
    /// environment names no home directory.
    pub fn default_folder() -> Option<PathBuf> {
        let given = |name: &str| var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let caches = if cfg!(windows) {
            given("LOCALAPPDATA")
        } else if cfg!(target_os = "macos") {
            given("HOME").map(|home| home.join("Library/Caches"))
        } else {
            // A relative one is to be left out, as its specification says.
            let stated = given("XDG_CACHE_HOME").filter(|path| path.is_absolute());
            stated.or_else(|| given("HOME").map(|home| home.join(".cache")))
        };
        Some(caches?.join("meshtone").join("reference"))
    }

    /// The folder of a prior's set.
    ///
    /// # Arguments
    /// * `prior` - what the set is drawn from
    pub fn folder_of(&self, prior: &Prior) -> PathBuf {
        // All fields are named, so that none is forgotten; the train follows from the rig.
        let Prior {
            base,
            train: _,
            spreads,
            grade_steps,
            speed_spread,
            load_spread,
            load_change,
            gain_db,
            has_any_sensor,
            healthy_speed_hz,
            seed,
            focus,
        } = prior;
        let identity = json!({
            "versions": [env!("CARGO_PKG_VERSION"), PHYSICS_VERSION.to_string(), FORMAT.to_string()],
            "counts": [RECORDS_PER_UNIT, MESH_ORDERS as u64, u64::from(*grade_steps), *seed],
            "rig": base.to_toml(),
            "spreads": spreads.iter().map(|of| json!([of.key, of.deviation])).collect::<Vec<_>>(),
            "numbers": [speed_spread, load_spread, load_change, gain_db],
            "sensor": has_any_sensor,
            "healthy_speed_hz": healthy_speed_hz,
            "focus": focus.as_ref().map(|of| json!([of.kind, of.wheel, of.severity])),
            "kinds": prior.kinds().iter().map(|of| json!([of.name, of.sizes])).collect::<Vec<_>>(),
        });
        let mut hash = Sha256::new();
        hash.update(identity.to_string());
        let name: String = hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        self.folder.join(name)
    }

    /// The first records of a prior's set: those that are there are read, the others simulated and kept.
    ///
    /// Where the healthy records are at another speed, all others are those of the set at one speed.
    ///
    /// # Arguments
    /// * `prior` - what may be
    /// * `count` - records, rounded up to whole batches
    /// * `control` - progress, in records that are there, and cancellation
    ///
    /// # Errors
    /// A folder that cannot be written; cancelled.
    pub fn get(&self, prior: &Prior, count: u64, control: &Control) -> Result<ReferenceSet, StoreError> {
        let folder = self.folder_of(prior);
        fs::create_dir_all(&folder).map_err(|source| WriteFileError { path: folder.clone(), source })?;
        let is_own =
            |number: &u64| prior.healthy_speed_hz.is_none() || number.is_multiple_of(RECORDS_PER_UNIT);
        let mut records = Vec::new();
        if prior.healthy_speed_hz.is_some() {
            let at_one_speed = Prior { healthy_speed_hz: None, ..prior.clone() };
            records = self.get(&at_one_speed, count, control)?.records;
            records.retain(|record| !is_own(&record.number));
        }
        for batch in 0..count.div_ceil(BATCH) {
            let path = folder.join(format!("batch-{batch:04}.npz"));
            let before = (batch * BATCH) as usize;
            // A file that cannot be read is made again: it holds nothing that a simulation does not give.
            let of_batch = match read(&path, prior) {
                Ok(of_batch) => of_batch,
                Err(_) => {
                    let progress = |finished: usize| (control.progress)(before + finished);
                    let own = Control { progress: &progress, ..*control };
                    let numbers = (batch * BATCH..(batch + 1) * BATCH).into_par_iter().filter(is_own);
                    let of_batch = build_reference(prior, numbers, &own);
                    if control.cancelled.load(Ordering::Relaxed) {
                        return Err(StoreError::Cancelled);
                    }
                    write_atomically(&path, |file| write(file, &of_batch))?;
                    of_batch
                }
            };
            (control.progress)(before + BATCH as usize);
            records.extend(of_batch);
        }
        records.sort_by_key(|record| record.number);
        Ok(ReferenceSet { prior: prior.clone(), records })
    }
}

fn write(file: &mut File, records: &[ReferenceRecord]) -> io::Result<()> {
    let mut archive = NpzWriter::stored(file);
    let mut numbers = Vec::with_capacity(records.len() * WIDTH);
    for record in records {
        let of_fault = record.fault.as_ref().map_or([f64::NAN; 5], |fault| {
            let is_on_one_tooth = f64::from(u8::from(fault.is_on_one_tooth));
            [fault.kind as f64, fault.wheel as f64, f64::from(fault.tooth), is_on_one_tooth, fault.severity]
        });
        let sizes = record.fault.as_ref().map_or(&[][..], |fault| &fault.sizes);
        numbers.push(record.number as f64);
        numbers.extend(of_fault);
        // The number of sizes too, so that NaN among them is not the end.
        numbers.extend([record.input_speed_hz, sizes.len() as f64]);
        numbers.extend((0..SIZES).map(|size| sizes.get(size).copied().unwrap_or(f64::NAN)));
    }
    let mut hash = Sha256::new();
    let mut add = |name: &str, shape: &[usize], values: &[f64]| {
        hash_values(&mut hash, values);
        archive.add(name, shape, values)
    };
    add("records", &[records.len(), WIDTH], &numbers)?;
    for wheel in 0..records.first().map_or(0, |record| record.wheels.len()) {
        let lines = || records.iter().map(|record| &record.wheels[wheel].lines);
        let lengths: Vec<f64> = lines().map(|lines| lines.len() as f64).collect();
        add(&format!("lengths_{wheel}"), &[records.len()], &lengths)?;
        let parts: Vec<f64> = lines().flatten().flat_map(|line| [line.re, line.im]).collect();
        add(&format!("lines_{wheel}"), &[parts.len() / 2, 2], &parts)?;
    }
    archive.add(DIGEST, &[32], &digest(hash))?;
    archive.finish()?;
    Ok(())
}

/// Name of the array that holds the SHA-256 digest of all others.
const DIGEST: &str = "sha256";

fn hash_values(hash: &mut Sha256, values: &[f64]) {
    values.iter().for_each(|value| hash.update(value.to_le_bytes()));
}

/// The bytes of a digest, as an archive of numbers holds them.
fn digest(hash: Sha256) -> Vec<f64> {
    hash.finalize().iter().map(|&byte| f64::from(byte)).collect()
}

/// Reads a batch of the reference set that was kept.
///
/// The file is in the user's cache, where anything may have happened to it. Sizes are limited before they are read, its digest is that of
/// what was written, and every number that is an index later is checked, so that a changed batch is an error, upon which it is simulated
/// again, and never a wrong answer.
fn read(path: &Path, prior: &Prior) -> io::Result<Vec<ReferenceRecord>> {
    let wrong = || io::Error::other("it is no batch of a reference set");
    let mut archive = NpzReader::new(File::open(path)?)?;
    let rig = &prior.train.wheels;
    let mut hash = Sha256::new();
    let mut read = |name: &str, most: u64| -> io::Result<Vec<f64>> {
        let numbers = archive.floats(name, most)?.numbers;
        hash_values(&mut hash, &numbers);
        Ok(numbers)
    };
    let numbers = read("records", BATCH * WIDTH as u64)?;
    if !numbers.len().is_multiple_of(WIDTH) {
        return Err(wrong());
    }
    let mut wheels: Vec<Vec<WheelLines>> = vec![Vec::new(); numbers.len() / WIDTH];
    for (place, separation) in separations(&prior.train).into_iter().enumerate() {
        let lengths = read(&format!("lengths_{place}"), BATCH)?;
        let parts =
            read(&format!("lines_{place}"), BATCH * 2 * (WheelLines::most(separation.teeth) as u64 + 1))?;
        let mut rest = &parts[..];
        for (of_record, length) in wheels.iter_mut().zip(&lengths) {
            let count = (*length as usize).saturating_mul(2);
            let own = rest.split_off(..count).ok_or_else(wrong)?;
            let lines = own.chunks_exact(2).map(|part| Complex64::new(part[0], part[1])).collect();
            of_record.push(WheelLines { separation: separation.clone(), lines });
        }
        if !rest.is_empty() || lengths.len() != wheels.len() {
            return Err(wrong());
        }
    }
    // Fuzz targets look behind the digest, which no changed input passes.
    if !cfg!(fuzzing) && archive.floats(DIGEST, 32)?.numbers != digest(hash) {
        return Err(wrong());
    }
    let record = |(row, wheels): (&[f64], Vec<WheelLines>)| {
        let fault = row[1].is_finite().then(|| DrawnFault {
            kind: row[1] as usize,
            wheel: row[2] as usize,
            tooth: row[3] as u32,
            is_on_one_tooth: row[4] != 0.0,
            severity: row[5],
            sizes: row[COLUMNS + 1..].iter().take(row[COLUMNS] as usize).copied().collect(),
        });
        ReferenceRecord { number: row[0] as u64, fault, input_speed_hz: row[6], wheels }
    };
    let records: Vec<ReferenceRecord> = numbers.chunks_exact(WIDTH).zip(wheels).map(record).collect();
    let kinds = prior.kinds();
    let is_known = |fault: &DrawnFault| {
        let sizes = kinds.get(fault.kind).map_or(0, |kind| kind.sizes.len());
        fault.kind <= kinds.len()
            && fault.sizes.len() == sizes
            && rig.get(fault.wheel).is_some_and(|wheel| (1..=wheel.teeth).contains(&fault.tooth))
    };
    let is_good = |record: &ReferenceRecord| {
        record.fault.as_ref().is_none_or(is_known)
            && record.wheels.iter().all(|wheel| !wheel.lines.is_empty())
    };
    let is_rising = records.windows(2).all(|pair| pair[0].number < pair[1].number);
    if is_rising && records.iter().all(is_good) { Ok(records) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{prior, records};
    use std::sync::atomic::AtomicBool;

    // A set whose batches are there is what was written, and nothing is simulated: cancelled, it would say so.
    #[test]
    fn a_batch_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let (store, prior) = (ReferenceStore::new(folder.path()), prior());
        let of_batch = records(&prior, BATCH);
        let path = store.folder_of(&prior).join("batch-0000.npz");
        fs::create_dir_all(store.folder_of(&prior)).unwrap();
        write_atomically(&path, |file| write(file, &of_batch)).unwrap();
        let control = Control { cancelled: &AtomicBool::new(true), ..Control::default() };
        assert_eq!(store.get(&prior, 1, &control).unwrap().records, of_batch);

        // One that was cut off is made again.
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        assert!(matches!(store.get(&prior, 1, &control), Err(StoreError::Cancelled)));
        // So is one whose numbers were changed: a severity that is no number, a line, a record that is left out.
        let mut changed = [of_batch.clone(), of_batch.clone(), of_batch.clone()];
        let damaged = changed[0].iter_mut().find_map(|record| record.fault.as_mut()).unwrap();
        damaged.severity = f64::NAN;
        changed[1][3].wheels[1].lines[5].re *= 2.0;
        changed[2].remove(7);
        let rewritten = [&of_batch].into_iter().chain(&changed).map(|changed| {
            write_atomically(&path, |file| write(file, changed)).unwrap();
            let mut other = NpzReader::new(File::open(&path).unwrap()).unwrap();
            let arrays = ["records", "lengths_0", "lines_0", "lengths_1", "lines_1"];
            let arrays = arrays.map(|name| (name, other.floats(name, u64::MAX).unwrap().numbers));
            fs::write(&path, &bytes).unwrap();
            let mut original = NpzReader::new(File::open(&path).unwrap()).unwrap();
            let kept = original.floats(DIGEST, 32).unwrap().numbers;
            write_atomically(&path, |file| {
                let mut archive = NpzWriter::stored(file);
                for (name, values) in &arrays {
                    let width = match *name {
                        "records" => WIDTH,
                        name if name.starts_with("lines") => 2,
                        _ => 1,
                    };
                    archive.add(name, &[values.len() / width, width], values)?;
                }
                archive.add(DIGEST, &[32], &kept)?;
                archive.finish()?;
                Ok(())
            })
            .unwrap();
            store.get(&prior, 1, &control).is_ok()
        });
        assert_eq!(rewritten.collect::<Vec<_>>(), [true, false, false, false]);
        // Where the healthy records are at another speed, all others are those of the set at one speed.
        let other = Prior { healthy_speed_hz: Some(28.0), ..prior.clone() };
        let of_others = store.folder_of(&other).join("batch-0000.npz");
        let mut healthy: Vec<ReferenceRecord> = of_batch.iter().step_by(8).cloned().collect();
        healthy.iter_mut().for_each(|record| record.input_speed_hz = 28.0);
        fs::create_dir_all(store.folder_of(&other)).unwrap();
        write_atomically(&of_others, |file| write(file, &healthy)).unwrap();
        write_atomically(&path, |file| write(file, &of_batch)).unwrap();
        let found = store.get(&other, 1, &control).unwrap();
        let slow = found.records.iter().filter(|record| record.input_speed_hz == 28.0);
        assert_eq!((found.records.len(), slow.count()), (of_batch.len(), healthy.len()));
        for (record, one_speed) in found.records.iter().zip(&of_batch) {
            assert_eq!(found.healthy_of(record).unwrap().input_speed_hz, 28.0);
            assert!(record == one_speed || record.number % 8 == 0);
        }
        // Of another prior there is none.
        let other = Prior { load_spread: 0.3, ..prior.clone() };
        assert_ne!(store.folder_of(&other), store.folder_of(&prior));
    }
}
