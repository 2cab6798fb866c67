#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| meshtone_fuzz::readers::data_set(
    "data/train-000000.parquet",
    bytes
));
