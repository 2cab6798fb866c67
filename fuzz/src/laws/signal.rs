//! Odd signals through every function that takes one.

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use meshtone::signal::*;

use crate::guarded;

/// Longest signal.
const MOST_SAMPLES: u16 = 800;

/// A signal, its sampling rate and a count: whatever they are, a function gives numbers, none, or an error.
pub fn signal(bytes: &[u8]) {
    guarded(|| {
        let Ok((values, rate_hz, count)) = drawn(&mut Unstructured::new(bytes)) else { return };
        of_values(&values);
        of_spectra(&values, rate_hz, count);
        of_phases(&values, rate_hz, count);
    });
}

/// A pattern that repeats, at some order of magnitude, with single values that are anything.
fn drawn(input: &mut Unstructured) -> Result<(Vec<f64>, f64, usize)> {
    let magnitude = |input: &mut Unstructured| Ok(10_f64.powi(i32::from(input.arbitrary::<i16>()?) % 320));
    let rate_hz = if input.arbitrary()? { 1e4 } else { magnitude(input)? };
    let count = input.int_in_range(0..=300_usize)?;
    let amplitude = if input.arbitrary()? { 1.0 } else { magnitude(input)? };
    let samples = usize::from(input.int_in_range(0..=MOST_SAMPLES)?);
    let others = (0..input.int_in_range(0..=3)?)
        .map(|_| Ok((input.arbitrary::<u16>()?, input.arbitrary::<f64>()?)))
        .collect::<Result<Vec<_>>>()?;
    let pattern = input.bytes(input.len())?;
    let at = |sample: usize| pattern.get(sample % pattern.len().max(1)).map_or(0, |byte| *byte as i8);
    let mut values: Vec<f64> = (0..samples).map(|sample| amplitude * f64::from(at(sample))).collect();
    for (sample, value) in others {
        if let Some(here) = values.get_mut(usize::from(sample)) {
            *here = value;
        }
    }
    Ok((values, rate_hz, count))
}

/// Numbers that a function of finite numbers gives are finite.
fn finite<'v>(name: &str, values: impl IntoIterator<Item = &'v f64>) {
    assert!(values.into_iter().all(|value| value.is_finite()), "{name} gives {}", f64::NAN);
}

/// What takes any numbers.
fn of_values(values: &[f64]) {
    if values.is_empty() || !values.iter().all(|value| value.abs() <= 1e35) {
        // Numbers are promised of what no unit makes larger; nothing panics.
        (rms(values), peak(values), peak_to_peak(values), kurtosis(values), skewness(values));
        return;
    }
    let of_all = [
        ("rms", Some(rms(values))),
        ("peak", Some(peak(values))),
        ("peak_to_peak", Some(peak_to_peak(values))),
        ("standard_deviation", Some(standard_deviation(values))),
        ("crest_factor", crest_factor(values)),
        ("kurtosis", kurtosis(values)),
        ("skewness", skewness(values)),
        ("fm4", fm4(values)),
        ("m6a", m6a(values)),
        ("m8a", m8a(values)),
        ("energy_ratio", energy_ratio(values, values)),
    ];
    of_all.iter().for_each(|(name, value)| finite(name, value));
    finite("na4", na4(&[values, values]).into_iter().flatten().flatten().collect::<Vec<_>>().iter());
}

fn of_spectra(values: &[f64], rate_hz: f64, count: usize) {
    let of_all = [
        ("spectral_kurtosis", spectral_kurtosis(values, count)),
        ("kurtogram", kurtogram(values, rate_hz, 3).map(|of| of.levels.concat())),
        ("envelope", envelope(values)),
        ("envelope_spectrum", envelope_spectrum(values)),
        ("order_spectrum", order_spectrum(values)),
        ("squared_envelope", squared_envelope(values, rate_hz, None)),
        (
            "squared_envelope_spectrum",
            squared_envelope_spectrum(values, rate_hz, None).map(|of| of.amplitudes),
        ),
        ("cepstral_prewhitening", cepstral_prewhitening(values)),
        (
            "discrete_random_separation",
            discrete_random_separation(values, count, count).map(|of| [of.discrete, of.random].concat()),
        ),
        ("velocity_rms", velocity_rms(values, rate_hz).map(|of| vec![of])),
        ("resample", resample(values, count.min(9), 4, Edge::Reflect)),
        ("resample_to", resample_to(values, rate_hz.clamp(80.0, 1e6), 8e3, Edge::Reflect)),
        ("interpolate_pchip", interpolate_pchip(values, &[0.5, count as f64], Edge::Reflect)),
        ("interpolate_band_limited", interpolate_band_limited(values, &[0.5, count as f64], Edge::Reflect)),
    ];
    for (name, values) in of_all {
        finite(name, values.iter().flatten());
    }
}

fn of_phases(values: &[f64], rate_hz: f64, count: usize) {
    let _ = check_channel(values);
    let phases = [
        ShaftPhase::constant(rate_hz / 50.0, rate_hz, values.len()),
        tachometer_pulses(values, rate_hz, &Tachometer::default())
            .and_then(|times| ShaftPhase::from_pulses(&times, 1, None, rate_hz, values.len())),
        ShaftPhase::from_pulses(values, 1, None, rate_hz, 500),
        ShaftPhase::from_speed_samples(values, rate_hz),
        ShaftPhase::from_mesh_tone(values, rate_hz, &MeshTone::new(17, rate_hz / 100.0)),
    ];
    for phase in phases.into_iter().flatten() {
        if let Ok(map) = order_map(values, &phase, rate_hz, &OrderMapSettings::default()) {
            finite("order_map", map.amplitudes.iter().flatten());
        }
        let squared = squared_envelope_order_spectrum(values, rate_hz, None, &phase);
        finite("squared_envelope_order_spectrum", squared.iter().flat_map(|of| &of.amplitudes));
        let residual = synchronous_residual(values, std::slice::from_ref(&phase));
        finite("synchronous_residual", residual.iter().flat_map(|of| &of.values));
        let teeth = count as u32;
        let records = process_channel(values, &phase, teeth, &ChainSettings::default());
        for record in records.iter() {
            finite("process_channel", &record.average.values);
            let indicators = record.indicators.table("g");
            finite("indicators", indicators.iter().filter_map(|of| of.value.as_ref()));
        }
        let _ = process_segments(values, &phase, teeth, &ChainSettings::default(), 2);
    }
}
