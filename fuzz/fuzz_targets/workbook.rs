#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| meshtone_fuzz::readers::recording("a.xlsx", bytes));
