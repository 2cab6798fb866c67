//! The noise of a rig, from a recording of its healthy machine.

use std::sync::Arc;

use meshtone::random::Draws;
use meshtone::sensor::add_recorded_noise;
use meshtone::signal::{AntiAliasing, Edge, SignalError, discrete_random_separation, standard_deviation};

/// Blocks in a recording by which its periodic part is found.
const BLOCKS: usize = 16;
/// (s) Longest block: it resolves tones 4 Hz apart.
const LONGEST_BLOCK_S: f64 = 1.0;

/// What a recording of a healthy machine has beside everything that is periodic: the noise of the machine, of its surroundings and of the
/// measurement, at the data set's rate, with the standard deviation 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Background {
    samples: Arc<[f32]>,
}

impl Background {
    /// The background of a recording.
    ///
    /// The periodic part is found without the phase of any shaft, by [`discrete_random_separation`]: what a block of the signal predicts of
    /// a later one. Half a block at either end, where it is found too small, is left out.
    ///
    /// # Arguments
    /// * `signal` - (any unit) the recording
    /// * `from_hz` - (S/s) its sampling rate
    /// * `to_hz` - (S/s) the data set's
    ///
    /// # Errors
    /// Those of the separation: a constant signal, or one of fewer than some 300 samples. A signal that is too short for a single sample at
    /// the data set's rate, or whose noise has no finite level above 0.
    pub fn of_recording(signal: &[f64], from_hz: f64, to_hz: f64) -> Result<Self, SignalError> {
        let block = (signal.len() / BLOCKS).min((LONGEST_BLOCK_S * from_hz) as usize);
        let random = discrete_random_separation(signal, block, block)?.random;
        let inner = &random[block / 2..random.len() - block / 2];
        let step = from_hz / to_hz;
        let filter = AntiAliasing::steep(from_hz, to_hz)?;
        let count = (inner.len() as f64 / step) as usize;
        if count == 0 {
            let what = "samples at keep.sampling_rate_hz";
            return Err(SignalError::TooFew { what, given: count, needed: 1 });
        }
        let samples = filter.read_double(inner, (0..count).map(|i| i as f64 * step), Edge::Reflect);
        let deviation = standard_deviation(&samples);
        if !(deviation > 0.0 && deviation.is_finite()) {
            return Err(SignalError::Constant { value: samples[0], samples: count });
        }
        Ok(Self { samples: samples.iter().map(|sample| (sample / deviation) as f32).collect() })
    }

    /// The text of a file that keeps it beside the data: a sample in each line.
    pub(crate) fn to_text(&self) -> String {
        self.samples.iter().map(|sample| format!("{sample:?}\n")).collect()
    }

    /// Reads that text; none where it is another, or has a number that is not finite.
    pub(crate) fn from_text(text: &str) -> Option<Self> {
        let finite = |line: &str| line.parse().ok().filter(|sample: &f32| sample.is_finite());
        let samples: Arc<[f32]> = text.lines().map(finite).collect::<Option<_>>()?;
        (!samples.is_empty()).then_some(Self { samples })
    }

    /// Refuses records that are longer: in those the noise would repeat, as lines at the rate of repetition.
    ///
    /// # Arguments
    /// * `samples` - number of samples of a record
    /// * `rate_hz` - (S/s) the data set's
    pub(crate) fn check_length(&self, samples: usize, rate_hz: f64) -> Result<(), String> {
        if samples <= self.samples.len() {
            return Ok(());
        }
        let [given_s, record_s] = [self.samples.len(), samples].map(|count| count as f64 / rate_hz);
        // A block in all is left out of the recording.
        let needed_s = record_s + (record_s / (BLOCKS - 1) as f64).min(LONGEST_BLOCK_S);
        Err(format!(
            "gives {given_s:.3} s of noise, but a record lasts {record_s:.3} s; must be a recording of at least {:.2} s",
            (needed_s * 100.0).ceil() / 100.0 + 0.01
        ))
    }

    /// Adds a random piece of it to a signal. A piece that reaches the end of the recording goes on at its beginning.
    ///
    /// # Arguments
    /// * `draws` - decide where the piece begins
    /// * `deviation` - (the signal's unit) standard deviation
    /// * `signal` - the signal
    pub(crate) fn add(&self, draws: &mut Draws, deviation: f64, signal: &mut [f32]) {
        let first = (draws.bits() % self.samples.len() as u64) as usize;
        add_recorded_noise(&self.samples, first, deviation, signal);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::Purpose;
    use std::f64::consts::TAU;

    /// Of coloured noise under mesh tones a hundred times as strong in energy the noise is left: its level by the normalisation, its colour as it was.
    #[test]
    fn tones_are_removed_and_the_colour_of_the_noise_is_kept() {
        let mut draws = Draws::new(3, Purpose::RecordNoise, 0);
        let white: Vec<f64> = (0..50_000).flat_map(|_| draws.normals()).collect();
        let coloured = |i: usize| white[i] + white[i.saturating_sub(1)];
        let tones = |i: usize| (1..4).map(|h| 12.0 * (TAU * 0.0123 * (h * i) as f64).cos()).sum::<f64>();
        let signal: Vec<f64> = (0..100_000).map(|i| coloured(i) + tones(i)).collect();
        let background = Background::of_recording(&signal, 25e3, 25e3).unwrap();
        let samples: Vec<f64> = background.samples.iter().map(|&x| f64::from(x)).collect();
        assert!((standard_deviation(&samples) - 1.0).abs() < 1e-6);
        // Neighbours of that noise correlate by one half.
        let neighbours = samples.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / samples.len() as f64;
        assert!((neighbours - 0.5).abs() < 0.1, "{neighbours}");
        assert_eq!(Background::from_text(&background.to_text()), Some(background));
        for text in ["", "1\nx\n", "1\nNaN\n", "1\ninf\n"] {
            assert_eq!(Background::from_text(text), None, "{text}");
        }
    }

    #[test]
    fn recordings_without_noise_at_the_rate_of_the_data_are_refused() {
        let mut draws = Draws::new(3, Purpose::RecordNoise, 0);
        let white: Vec<f64> = (0..200).flat_map(|_| draws.normals()).collect();
        let refused = |signal: &[f64], to_hz: f64| Background::of_recording(signal, 25e3, to_hz).unwrap_err();
        assert!(
            matches!(refused(&white, 50.0), SignalError::TooFew { given: 0, .. }),
            "{:?}",
            refused(&white, 50.0)
        );
        assert!(matches!(refused(&[white, vec![f64::NAN]].concat(), 25e3), SignalError::NotFinite { .. }));
        assert!(matches!(refused(&[1.0; 400], 25e3), SignalError::Constant { .. }));
    }

    #[test]
    fn pieces_differ_and_have_the_level() {
        let background = Background { samples: [1.0f32, -1.0].repeat(500).into() };
        let piece = |seed: u64| {
            let mut signal = [0.0f32; 4000];
            background.add(&mut Draws::new(seed, Purpose::RecordNoise, 0), 0.5, &mut signal);
            signal
        };
        assert!(piece(1).iter().all(|sample| sample.abs() == 0.5));
        assert_eq!(piece(1), piece(1));
        assert!((2..20).any(|seed| piece(seed) != piece(1)));
    }
}
