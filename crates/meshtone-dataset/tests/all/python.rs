//! pyarrow and polars read data sets.
//!
//! `cargo xtask test` makes a virtual environment and names its interpreter in `MESHTONE_PYTHON`. Without that variable
//! there is nothing to read with, and the test says so and ends.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;
use std::process::Command;

use crate::support::{FAST, plan, run};
use meshtone_dataset::generate::Part;
use meshtone_dataset::store::Destination;

#[test]
fn pyarrow_and_polars_read_it() {
    let Some(python) = std::env::var_os("MESHTONE_PYTHON") else {
        println!("skipped: MESHTONE_PYTHON is not set; `cargo xtask test` sets it");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    run(&plan(FAST), &Destination::directory(directory.path()), Part::WHOLE, 2).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-dataset/tests/python/read.py");
    let output = Command::new(python).arg(script).arg(directory.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}
