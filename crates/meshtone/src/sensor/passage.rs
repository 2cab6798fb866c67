//! The way of a signal from where it was simulated to where it is recorded.

use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum, shared_length};

use super::{PathRipple, Sensor, SensorPath};

/// What a signal passes on its way to a recording.
#[derive(Debug, Clone)]
pub struct Passage<'a> {
    /// (-) The gain that is the same at all frequencies.
    pub factor: f64,
    /// The sensor, as far as the signal still has to pass it; none where it is passed or rigid.
    pub sensor: Option<&'a Sensor>,
    /// The ripple of the path over frequency; none where it is even.
    pub ripple: Option<PathRipple>,
    /// The wall and the housing under the sensor.
    pub structure: SensorPath,
}

impl Passage<'_> {
    /// Lets a signal pass: multiplies its spectrum by all gains at once.
    ///
    /// # Arguments
    /// * `rate_hz` - (S/s) sampling rate of the signal
    /// * `signal` - (g, or N where the sensor's response is to the mesh force) its samples
    pub fn pass(&self, rate_hz: f64, signal: &mut [f32]) {
        let Self { factor, sensor, ripple, structure } = self;
        if (ripple.is_none() && sensor.is_none() && structure.is_rigid()) || signal.len() < 2 {
            signal.iter_mut().for_each(|sample| *sample = (f64::from(*sample) * factor) as f32);
            return;
        }
        filter(signal, |length, count| {
            let step_hz = rate_hz / length as f64;
            let mut gains = match sensor {
                Some(sensor) => sensor.gains(step_hz, count),
                None => vec![Complex64::ONE; count],
            };
            gains.iter_mut().for_each(|gain| *gain *= factor);
            if let Some(ripple) = ripple {
                gains.iter_mut().zip(ripple.gains(step_hz, count)).for_each(|(gain, ripple)| *gain *= ripple);
            }
            if !structure.is_rigid() {
                let structure = structure.at((0..count).map(|line| line as f64 * step_hz));
                gains.iter_mut().zip(structure).for_each(|(gain, structure)| *gain *= structure);
            }
            gains
        });
    }
}

/// Multiplies the spectrum of a signal, mirrored at its ends: what the transform takes for periodic has no jump anywhere.
///
/// # Arguments
/// * `signal` - its samples
/// * `gains` - of the length of the transform and the number of its lines
fn filter(signal: &mut [f32], gains: impl FnOnce(usize, usize) -> Vec<Complex64>) {
    // Behind the mirrored signal so much of its beginning, there and back, as is left of the length: at least an eighth, so that the
    // filter does not reach beyond. The length is even.
    let length = shared_length(2 * signal.len() + signal.len() / 4);
    let (beginning, _) = signal.split_at((length - 2 * signal.len()) / 2);
    let there_and_back =
        |part: &[f32]| part.iter().chain(part.iter().rev()).map(|&x| f64::from(x)).collect::<Vec<_>>();
    let mut mirrored = there_and_back(signal);
    mirrored.extend(there_and_back(beginning));
    let mut spectrum = real_spectrum(&mirrored);
    let gains = gains(length, spectrum.len());
    spectrum.iter_mut().zip(gains).for_each(|(value, gain)| *value *= gain);
    let filtered = from_real_spectrum(spectrum, length);
    signal.iter_mut().zip(filtered).for_each(|(sample, value)| *sample = value as f32);
}
