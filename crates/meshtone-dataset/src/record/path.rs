//! The path from the simulated sensor's place to where a rig's is.

use meshtone::scenario::{Sensor, SensorPath};
use meshtone::sensor::{Passage, PathRipple};
use meshtone_io::run_identity::fnv_1a;

use crate::draw::{DrawnRecord, PATH_KEYS};

/// Lets an acceleration channel pass the record's path, as its values say: a gain that is the same at all frequencies, and a
/// ripple over frequency that is its mounting's own. A sensor that is linear makes its signal in the same spectrum.
///
/// The ripple is normal in decibels at half octaves and goes along straight lines over the logarithm of the frequency between them.
/// It changes magnitudes alone: no vibration comes sooner or later. A wall and the modes of a housing, drawn for the mounting and the
/// channel, follow what excites them.
///
/// # Arguments
/// * `drawn` - the record
/// * `channel` - its name: what else is kept changes nothing
/// * `sensor` - what the channel still has to pass of its sensor
/// * `rate_hz` - (S/s) its sampling rate
/// * `signal` - (g, or N where the sensor's response is to the mesh force) its samples
pub(super) fn pass(
    drawn: &DrawnRecord,
    channel: &str,
    sensor: Option<&Sensor>,
    rate_hz: f64,
    signal: &mut [f32],
) {
    let [gain_db, ripple_db, ..] = PATH_KEYS.map(|key| drawn.value(key));
    let ripple = |ripple_db: f64| PathRipple::new(drawn.mounting_seed, fnv_1a(channel.as_bytes()), ripple_db);
    let passage = Passage {
        factor: gain_db.map_or(1.0, |gain_db| libm::pow(10.0, gain_db / 20.0)),
        sensor,
        ripple: ripple_db.filter(|&ripple_db| ripple_db != 0.0).map(ripple),
        structure: structure(drawn, channel),
    };
    passage.pass(rate_hz, signal);
}

/// The wall and the housing that a record's values put under a channel's sensor.
///
/// # Arguments
/// * `drawn` - the record
/// * `channel` - its name
pub(super) fn structure(drawn: &DrawnRecord, channel: &str) -> SensorPath {
    let [.., plate_hz, strength] = PATH_KEYS.map(|key| drawn.value(key));
    let mut structure = SensorPath::RIGID;
    structure.plate_hz = plate_hz.unwrap_or(0.0);
    structure.strength = strength.unwrap_or(0.0);
    structure.seed = drawn.mounting_seed ^ fnv_1a(channel.as_bytes());
    structure
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn tone(hz: f64) -> Vec<f32> {
        (0..10_000).map(|i| (TAU * hz * f64::from(i) / 1e4).cos() as f32).collect()
    }

    fn drawn(values: &[(&str, f64)], mounting_seed: u64) -> DrawnRecord {
        DrawnRecord {
            index: 0,
            class: 0,
            unit: 0,
            mounting: 0,
            age: None,
            split: 0,
            seed: 1,
            wheels_seed: 1,
            mounting_seed,
            severity: 0,
            severity_measure: None,
            values: values.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect(),
        }
    }

    fn rms(signal: &[f32]) -> f64 {
        (signal.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>() / signal.len() as f64).sqrt()
    }

    #[test]
    fn a_gain_is_the_same_everywhere() {
        let mut signal = tone(1000.0);
        pass(&drawn(&[("path.gain_db", 6.0)], 1), "vertical_g", None, 1e4, &mut signal);
        assert!((rms(&signal) / rms(&tone(1000.0)) - 1.995).abs() < 1e-3);
    }

    /// No vibration comes sooner or later, and both ends are mirrored: backwards it is the same, whatever the length is padded to.
    #[test]
    fn a_ripple_is_the_same_backwards() {
        for len in [2, 3, 10_000, 12_500, 16_000] {
            let there: Vec<f32> = tone(613.0).into_iter().chain(tone(91.0)).take(len).collect();
            let pass = |mut signal: Vec<f32>| {
                pass(&drawn(&[("path.ripple_db", 3.0)], 5), "vertical_g", None, 1e4, &mut signal);
                signal
            };
            let (forwards, mut back) = (pass(there.clone()), pass(there.iter().rev().copied().collect()));
            back.reverse();
            let off = forwards.iter().zip(&back).map(|(a, b)| f64::from((a - b).abs()));
            // What reaches from the one end to where the other one's copy ends differs.
            let most = off.fold(0.0, f64::max);
            println!("{len}: {}", most / rms(&forwards));
            assert!(most < 0.005 * rms(&forwards), "{len}: {most}");
        }
    }

    /// A wall is its closed form; the modes of a housing are the mounting's own and the channel's own.
    #[test]
    fn a_wall_and_a_housing_change_the_level_of_a_tone() {
        let gain = |values: &[(&str, f64)], mounting_seed: u64, channel: &str| {
            let mut signal = tone(4000.0);
            pass(&drawn(values, mounting_seed), channel, None, 1e4, &mut signal);
            rms(&signal) / rms(&tone(4000.0))
        };
        let wall = gain(&[("path.plate_hz", 4000.0)], 1, "vertical_g");
        assert!((wall - (2.0f64 / 1.01).sqrt()).abs() < 5e-3, "{wall}");
        let housing = [("path.strength", 0.3)];
        assert_eq!(gain(&housing, 1, "vertical_g"), gain(&housing, 1, "vertical_g"));
        assert_ne!(gain(&housing, 1, "vertical_g"), gain(&housing, 2, "vertical_g"));
        assert_ne!(gain(&housing, 1, "vertical_g"), gain(&housing, 1, "horizontal_g"));
    }

    // Of many mountings: the standard deviation that was asked for at a knot; the same for records of one mounting.
    #[test]
    fn a_ripple_is_the_mountings_own() {
        let gain_db = |mounting_seed: u64, record_seed: u64| {
            let mut signal = tone(1024.0);
            let record =
                DrawnRecord { seed: record_seed, ..drawn(&[("path.ripple_db", 3.0)], mounting_seed) };
            pass(&record, "vertical_g", None, 1e4, &mut signal);
            20.0 * (rms(&signal) / rms(&tone(1024.0))).log10()
        };
        assert_eq!(gain_db(5, 1), gain_db(5, 2));
        let gains: Vec<f64> = (0..400).map(|seed| gain_db(seed, 1)).collect();
        let mean = gains.iter().sum::<f64>() / 400.0;
        let deviation = (gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / 400.0).sqrt();
        assert!(mean.abs() < 0.5 && (deviation - 3.0).abs() < 0.4, "{mean} {deviation}");
    }
}
