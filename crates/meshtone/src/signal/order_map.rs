//! The order spectrum as it changes over a recording.

use meshtone_fourier::{hann_window, real_spectrum};

use super::spectrum::windowed;
use super::{AngularSettings, AngularSignal, ShaftPhase, SignalError, angular_resample};

/// Revolutions of a part, where they are not stated: a part of the recording, between these.
const PARTS: usize = 12;
const REVOLUTIONS: [usize; 2] = [2, 16];
/// Parts that begin within the length of one.
const OVERLAPPING: usize = 4;
/// Most parts.
const MOST_PARTS: usize = 200;
/// Most amplitudes of a map: a gigabyte.
const MOST_AMPLITUDES: usize = 1 << 27;

/// Amplitudes over the order of a shaft and over time.
#[derive(Debug, Clone, PartialEq)]
pub struct OrderMap {
    /// (rev) Length of the parts that the recording is cut into. Amplitude k of a part is that of order k/revolutions.
    pub revolutions: usize,
    /// (s) Time of the middle of each part, since the first sample.
    pub times_s: Vec<f64>,
    /// (Hz) Mean speed of the shaft in each part.
    pub speeds_hz: Vec<f64>,
    /// (unit of the signal) A spectrum for each part.
    pub amplitudes: Vec<Vec<f64>>,
}

/// Settings of an order map.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrderMapSettings {
    /// (rev) Length of the parts: lines are that much finer, and changes that much coarser. By default a twelfth of the recording, from 2 to
    /// 16 revolutions.
    pub revolutions: Option<usize>,
    /// Highest order; by default, and at most, the Nyquist order of the quickest revolution.
    pub highest_order: Option<f64>,
}

impl OrderMapSettings {
    /// Mesh orders up to which a map is of use: the line of the sixth with its sidebands.
    pub const MESH_ORDERS: f64 = 6.5;
}

/// Cuts a recording into overlapping parts of whole revolutions and computes the order spectrum of each.
///
/// Orders of the shaft are upright lines whatever its speed does, and resonances are bands that move. Each part is multiplied by Hann's window,
/// and amplitudes are single-sided: a cosine of amplitude A shows as A at its order, and at least as 0.85 A between two.
///
/// # Arguments
/// * `signal` - the recording
/// * `phase` - the phase of the shaft at its samples
/// * `sampling_rate_hz` - (S/s) of the recording
/// * `settings` - length of the parts, highest order
///
/// # Errors
/// Those of [`angular_resample`]; parts of no revolution, or of more than the recording has; a highest order that is not positive; more than
/// 2²⁷ amplitudes.
///
/// Source: K. R. Fyfe, E. D. S. Munck, "Analysis of computed order tracking", Mech. Syst. Signal Process. 11 (1997)
/// 187–205.
///
/// ```
/// use meshtone::signal::{OrderMapSettings, ShaftPhase, order_map};
///
/// // Five periods a revolution, while the shaft speeds up from 5 to 15 Hz.
/// let phase = ShaftPhase::from_speed_profile(&[0.0, 4.0], &[5.0, 15.0], 4000.0, 16_001)?;
/// let signal: Vec<f64> = phase.revolutions.iter().map(|r| 3.0 * (std::f64::consts::TAU * 5.0 * r).cos()).collect();
/// let map = order_map(&signal, &phase, 4000.0, &OrderMapSettings::default())?;
/// assert_eq!(map.revolutions, 3);
/// assert!(map.amplitudes.iter().all(|part| (part[15] - 3.0).abs() < 1e-3));
/// assert!(map.speeds_hz[0] < 6.5 && *map.speeds_hz.last().unwrap() > 14.0);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn order_map(
    signal: &[f64],
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
    settings: &OrderMapSettings,
) -> Result<OrderMap, SignalError> {
    let angular = angular_resample(signal, phase, &AngularSettings::default())?;
    map_of_angular(&angular, phase, sampling_rate_hz, settings)
}

fn map_of_angular(
    angular: &AngularSignal,
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
    settings: &OrderMapSettings,
) -> Result<OrderMap, SignalError> {
    let (points, all) = (angular.points_per_revolution, angular.revolutions());
    let usual = || (all / PARTS).clamp(REVOLUTIONS[0], REVOLUTIONS[1]);
    let revolutions = settings.revolutions.unwrap_or_else(usual);
    if revolutions == 0 {
        return Err(SignalError::parameter("revolutions", 0.0, "at least 1"));
    }
    if all < revolutions {
        return Err(SignalError::TooFewRevolutions { revolutions: all as f64, needed: revolutions });
    }
    let highest = settings.highest_order.unwrap_or(f64::INFINITY);
    if highest.is_nan() || highest <= 0.0 {
        return Err(SignalError::parameter("highest_order", highest, "more than 0"));
    }
    let highest = highest.min(angular.nyquist_order).min(points as f64 / 2.0);
    let lines = (highest * revolutions as f64) as usize + 1;
    let parts = (OVERLAPPING * (all - revolutions) / revolutions + 1).min(MOST_PARTS);
    if lines * parts > MOST_AMPLITUDES {
        return Err(SignalError::parameter(
            "revolutions",
            revolutions as f64,
            "so few that the map has at most 2²⁷ amplitudes",
        ));
    }
    let length = revolutions * points;
    let beyond = (all - revolutions) * points;
    let window = hann_window(length);
    let mut map =
        OrderMap { revolutions, times_s: Vec::new(), speeds_hz: Vec::new(), amplitudes: Vec::new() };
    for part in 0..parts {
        let start = beyond * part / (parts - 1).max(1);
        let values = windowed(&angular.values[start..start + length], &window);
        let from_rev = angular.start_rev + start as f64 / points as f64;
        let second = |angle_rev: f64| phase.sample_at(angle_rev) / sampling_rate_hz;
        let turned = revolutions as f64;
        map.times_s.push(second(from_rev + 0.5 * turned));
        map.speeds_hz.push(turned / (second(from_rev + turned) - second(from_rev)));
        // Hann's window halves the amplitude, and each line has a mirror image.
        let amplitude = |line: &meshtone_fourier::Complex64| 4.0 * line.norm() / length as f64;
        map.amplitudes.push(real_spectrum(&values).iter().take(lines).map(amplitude).collect());
    }
    Ok(map)
}

impl OrderMap {
    /// Order of an amplitude.
    ///
    /// # Arguments
    /// * `line` - its index in a part
    pub fn order(&self, line: usize) -> f64 {
        line as f64 / self.revolutions as f64
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn angular(revolutions: usize) -> (AngularSignal, ShaftPhase) {
        let points = 64;
        let values =
            (0..revolutions * points).map(|at| (TAU * 7.0 * at as f64 / points as f64).cos()).collect();
        let signal =
            AngularSignal { points_per_revolution: points, start_rev: 0.0, nyquist_order: 32.0, values };
        let phase = ShaftPhase::new(0, (0..=revolutions * 10).map(|at| at as f64 / 10.0).collect());
        (signal, phase.unwrap_or_else(|error| panic!("{error}")))
    }

    #[test]
    fn a_line_has_its_amplitude_in_every_part() -> Result<(), SignalError> {
        let (signal, phase) = angular(24);
        let settings = OrderMapSettings { revolutions: Some(4), highest_order: Some(10.0) };
        let map = map_of_angular(&signal, &phase, 100.0, &settings)?;
        assert_eq!((map.amplitudes.len(), map.amplitudes[0].len()), (21, 41));
        for part in &map.amplitudes {
            assert!((part[28] - 1.0).abs() < 1e-12 && part[26] < 1e-12, "{part:?}");
        }
        assert!(map.speeds_hz.iter().all(|speed| (speed - 10.0).abs() < 1e-9));
        assert!((map.times_s[0] - 0.2).abs() < 1e-12 && (map.times_s[20] - 2.2).abs() < 1e-12);
        assert_eq!(map.order(28), 7.0);
        Ok(())
    }

    #[test]
    fn what_cannot_be_cut_is_refused() {
        let (signal, phase) = angular(3);
        let with = |revolutions, highest_order| {
            let settings = OrderMapSettings { revolutions, highest_order };
            map_of_angular(&signal, &phase, 100.0, &settings)
                .map(|map| map.amplitudes.len())
                .map_err(|error| error.to_string())
        };
        assert_eq!(with(Some(3), None), Ok(1));
        assert_eq!(with(None, None), Ok(3));
        assert!(with(Some(4), None).is_err_and(|error| error.contains("4")));
        assert!(with(Some(0), None).is_err());
        assert!(with(None, Some(f64::NAN)).is_err());
    }

    /// Memory that is only reserved: a map that is too large is refused before a sample is read.
    #[test]
    fn a_map_of_too_many_amplitudes_is_refused() {
        let (_, phase) = angular(3);
        let (points, turns) = (64, 1_100_000);
        let signal = AngularSignal {
            points_per_revolution: points,
            start_rev: 0.0,
            nyquist_order: 32.0,
            values: vec![0.0; points * turns],
        };
        let settings = OrderMapSettings { revolutions: Some(turns / 49), highest_order: None };
        let error = map_of_angular(&signal, &phase, 100.0, &settings).map(drop).map_err(|e| e.to_string());
        assert!(error.is_err_and(|error| error.contains("revolutions") && error.contains("2²⁷")));
    }
}
