//! The chain's steps against SciPy, wherever both define the same thing.
//!
//! `cargo xtask test` makes a virtual environment, lets tests/scipy/reference.py write its inputs and results to a file, and
//! names that file in `MESHTONE_SCIPY_REFERENCE`. Without that variable there is nothing to compare with, and each test
//! says so and ends.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs::File;

use crate::signal::largest_difference;
use meshtone::signal::*;
use ndarray::Array1;
use ndarray_npy::NpzReader;

const TOLERANCE: f64 = 1e-10;

/// Reads one array of the reference; none where there is no reference.
struct Reference(NpzReader<File>);

impl Reference {
    fn open() -> Option<Self> {
        let Some(path) = std::env::var_os("MESHTONE_SCIPY_REFERENCE") else {
            println!("skipped: MESHTONE_SCIPY_REFERENCE is not set; `cargo xtask test` sets it");
            return None;
        };
        let file = File::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Some(Self(NpzReader::new(file).unwrap()))
    }

    fn get(&mut self, name: &str) -> Vec<f64> {
        let array: Array1<f64> = self.0.by_name(name).unwrap_or_else(|error| panic!("{name}: {error}"));
        array.to_vec()
    }

    /// Compares with one array, relative to its largest value.
    #[track_caller]
    fn compare(&mut self, name: &str, ours: &[f64]) {
        let theirs = self.get(name);
        let off = largest_difference(ours, &theirs) / peak(&theirs);
        println!("{name}: {off:.1e}");
        assert!(off < TOLERANCE, "{name}: {off}");
    }
}

#[test]
fn polyphase_resampling() {
    let Some(mut scipy) = Reference::open() else { return };
    for (up, down) in [(3, 2), (2, 5), (1, 7), (64, 15), (125, 1292)] {
        let case = format!("resample_{up}_{down}");
        let signal = scipy.get(&format!("{case}.signal"));
        scipy.compare(&format!("{case}.taps"), &resampling_taps(up, down).unwrap());
        for (edge, name) in [(Edge::Zero, "zero"), (Edge::Reflect, "reflect"), (Edge::Periodic, "periodic")] {
            let ours = resample(&signal, up, down, edge).unwrap();
            scipy.compare(&format!("{case}.{name}"), &ours);
        }
    }
}

#[test]
fn pchip() {
    let Some(mut scipy) = Reference::open() else { return };
    let (signal, places) = (scipy.get("pchip.signal"), scipy.get("pchip.places"));
    // With nothing beyond the ends PCHIP has its own slopes there, as SciPy's.
    scipy.compare("pchip.values", &interpolate_pchip(&signal, &places, Edge::Zero).unwrap());

    let times = scipy.get("pulses.times");
    let phase = ShaftPhase::from_pulses(&times, 2, None, 1000.0, 2500).unwrap();
    assert!(phase.warnings.is_empty());
    // One sample beyond each end is ours, by a straight line.
    let between = |i: usize| {
        let time_s = (phase.first_sample + i) as f64 / 1000.0;
        (times[0]..=times[times.len() - 1]).contains(&time_s)
    };
    let revolutions: Vec<f64> =
        (0..phase.revolutions.len()).filter(|&i| between(i)).map(|i| phase.revolutions[i]).collect();
    scipy.compare("pulses.revolutions", &revolutions);
}

#[test]
fn integrated_speed() {
    let Some(mut scipy) = Reference::open() else { return };
    let phase = ShaftPhase::from_speed_samples(&scipy.get("speed.hz"), 1000.0).unwrap();
    scipy.compare("speed.revolutions", &phase.revolutions);
}

#[test]
fn analytic_signal_and_spectra() {
    let Some(mut scipy) = Reference::open() else { return };
    for case in ["spectra_1024", "spectra_999"] {
        let signal = scipy.get(&format!("{case}.signal"));
        let hilbert: Vec<f64> = analytic_signal(&signal).unwrap().iter().map(|z| z.im).collect();
        scipy.compare(&format!("{case}.hilbert"), &hilbert);
        scipy.compare(&format!("{case}.envelope"), &envelope(&signal).unwrap());
        scipy.compare(&format!("{case}.spectrum"), &order_spectrum(&signal).unwrap());
        scipy.compare(&format!("{case}.envelope_spectrum"), &envelope_spectrum(&signal).unwrap());
    }
}

#[test]
fn separation() {
    let Some(mut scipy) = Reference::open() else { return };
    let parts = separate(&scipy.get("separation.average"), &SeparationSettings::new(19)).unwrap();
    scipy.compare("separation.regular", &parts.regular);
    scipy.compare("separation.residual", &parts.residual);
    scipy.compare("separation.difference", &parts.difference);
}

#[test]
fn moments() {
    let Some(mut scipy) = Reference::open() else { return };
    let signal = scipy.get("moments.signal");
    let own = ShapeIndicators::new(&signal);
    let ours = [
        own.rms,
        own.peak_to_peak,
        own.crest_factor.unwrap(),
        own.skewness.unwrap(),
        own.kurtosis.unwrap(),
        m6a(&signal).unwrap(),
        m8a(&signal).unwrap(),
        standard_deviation(&signal),
    ];
    // Each on its own: they differ in size by orders of magnitude.
    let theirs = scipy.get("moments.values");
    for (ours, theirs) in ours.iter().zip(&theirs) {
        assert!((ours / theirs - 1.0).abs() < TOLERANCE, "{ours} {theirs}");
    }
    scipy.compare("moments.values", &ours);
    let records = scipy.get("na4.records");
    let residuals: Vec<&[f64]> = records.chunks(400).collect();
    let ours: Vec<f64> = na4(&residuals).unwrap().into_iter().flatten().collect();
    scipy.compare("na4.values", &ours);
}

#[test]
fn squared_envelope_and_kurtosis() {
    let Some(mut scipy) = Reference::open() else { return };
    for case in ["bearing_1000", "bearing_999"] {
        let signal = scipy.get(&format!("{case}.signal"));
        let band = FrequencyBand { from_hz: 100.0, to_hz: 300.0 };
        let squares = squared_envelope(&signal, 1000.0, Some(band)).unwrap();
        scipy.compare(&format!("{case}.squares"), &squares);
        let spectrum = squared_envelope_spectrum(&signal, 1000.0, Some(band)).unwrap();
        scipy.compare(&format!("{case}.spectrum"), &spectrum.amplitudes);
        scipy.compare(&format!("{case}.kurtosis"), &spectral_kurtosis(&signal, 64).unwrap());
        scipy.compare(&format!("{case}.white"), &cepstral_prewhitening(&signal).unwrap());
    }
    let bands = kurtogram(&scipy.get("kurtogram.signal"), 2.0, 3).unwrap().levels;
    let bands: Vec<f64> = bands.concat();
    scipy.compare("kurtogram.kurtosis", &bands);
}

#[test]
fn random_part_and_velocity() {
    let Some(mut scipy) = Reference::open() else { return };
    let parts = discrete_random_separation(&scipy.get("random.signal"), 256, 300).unwrap();
    scipy.compare("random.discrete", &parts.discrete);
    scipy.compare("random.random", &parts.random);
    let velocity = velocity_rms(&scipy.get("velocity.signal"), 4000.0).unwrap();
    scipy.compare("velocity.rms", &[velocity]);
}
