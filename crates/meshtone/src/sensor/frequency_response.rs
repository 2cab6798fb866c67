//! A measured frequency response.

use std::f64::consts::PI;

use meshtone_fourier::Complex64;
use meshtone_toml::{ReadResult, TomlValue};

use super::parameters::finite_and_not_negative;
use crate::error::ScenarioError;
use crate::keys::{Check, Columns, KeyKind, KeyValue, NumberFiles, Range, Written, require};

/// A frequency response: magnitude and phase over frequency.
///
/// Between the frequencies both go along straight lines, the phase after unwrapping: from one frequency to the next it changes
/// by 180° at most. Outside them nothing passes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrequencyResponse {
    /// (Hz) Increasing frequencies, from 0 on.
    pub frequency_hz: Vec<f64>,
    /// (-, or (m/s²)/N of a force) What comes out over what goes in.
    pub magnitude: Vec<f64>,
    /// (°) By how much what comes out leads.
    pub phase_deg: Vec<f64>,
}

/// Its columns, in a table and in a file.
const COLUMNS: Columns<3> = Columns {
    noun: "a frequency response",
    names: ["frequency_hz", "magnitude", "phase_deg"],
    inline: ["numbers of its own", "numbers"],
};

impl FrequencyResponse {
    fn columns(&self) -> [&[f64]; 3] {
        [&self.frequency_hz, &self.magnitude, &self.phase_deg]
    }

    fn check_points(&self, key: &str) -> Check {
        let length = self.frequency_hz.len();
        if length < 2 {
            let problem = format!("has {length} rows; must have at least 2");
            return Err(ScenarioError::new(key, "", problem));
        }
        for (name, column) in COLUMNS.names.into_iter().zip(self.columns()) {
            if column.len() != length {
                let problem =
                    format!("has {} numbers; must have as many as frequency_hz, {length}", column.len());
                return Err(ScenarioError::new(format!("{key}.{name}"), "", problem));
            }
        }
        for (index, &frequency) in self.frequency_hz.iter().enumerate() {
            let entry = format!("{key}.frequency_hz[{index}]");
            finite_and_not_negative(&entry, frequency)?;
            let before = index.checked_sub(1).map(|before| self.frequency_hz[before]);
            if let Some(before) = before {
                let problem = format!("must be more than the frequency before it, {before:?} Hz");
                require(&entry, frequency, frequency > before, problem)?;
            }
        }
        for (index, &magnitude) in self.magnitude.iter().enumerate() {
            finite_and_not_negative(&format!("{key}.magnitude[{index}]"), magnitude)?;
        }
        self.phase_deg.iter().enumerate().try_for_each(|(index, &phase)| {
            let entry = format!("{key}.phase_deg[{index}]");
            require(&entry, phase, phase.is_finite(), "must be a finite number")
        })
    }

    /// Its complex gain for a sine.
    ///
    /// # Arguments
    /// * `frequencies_hz` - the sines' frequencies, rising
    ///
    /// ```
    /// use meshtone::scenario::FrequencyResponse;
    ///
    /// let path = FrequencyResponse { frequency_hz: vec![10.0, 20.0], magnitude: vec![1.0, 3.0], phase_deg: vec![0.0, 180.0] };
    /// let at = path.at([5.0, 15.0, 20.0]);
    /// assert_eq!(at[0].norm(), 0.0);
    /// assert!((at[1].im - 2.0).abs() < 1e-15 && at[1].re.abs() < 1e-15);
    /// assert!((at[2].re + 3.0).abs() < 1e-15);
    /// ```
    pub fn at(&self, frequencies_hz: impl IntoIterator<Item = f64>) -> Vec<Complex64> {
        let phase_rad = unwrapped_rad(&self.phase_deg);
        let mut above = 0;
        let response = |frequency_hz: f64| {
            while self.frequency_hz.get(above).is_some_and(|&point_hz| point_hz < frequency_hz) {
                above += 1;
            }
            let Some(&next_hz) = self.frequency_hz.get(above) else { return Complex64::ZERO };
            if next_hz == frequency_hz {
                return Complex64::from_polar(self.magnitude[above], phase_rad[above]);
            }
            let Some(below) = above.checked_sub(1) else { return Complex64::ZERO };
            let part = (frequency_hz - self.frequency_hz[below]) / (next_hz - self.frequency_hz[below]);
            let between = |values: &[f64]| values[below] + part * (values[above] - values[below]);
            Complex64::from_polar(between(&self.magnitude), between(&phase_rad))
        };
        frequencies_hz.into_iter().map(response).collect()
    }
}

/// (rad) Phases without jumps of more than half a turn.
fn unwrapped_rad(phase_deg: &[f64]) -> Vec<f64> {
    let mut last_deg: Option<f64> = None;
    let unwrap = |&phase_deg: &f64| {
        let unwrapped_deg = last_deg.map_or(phase_deg, |last_deg| {
            let turns = ((last_deg - phase_deg) / 360.0).round_ties_even();
            phase_deg + 360.0 * turns
        });
        last_deg = Some(unwrapped_deg);
        unwrapped_deg * (PI / 180.0)
    };
    phase_deg.iter().map(unwrap).collect()
}

impl KeyValue for FrequencyResponse {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let [frequency_hz, magnitude, phase_deg] =
            COLUMNS.read(value, |name| files.frequencies_magnitudes_phases(name))?;
        *self = Self { frequency_hz, magnitude, phase_deg };
        Ok(())
    }

    fn write(&self) -> Written {
        COLUMNS.write(self.columns())
    }

    fn check(&self, key: &str, _range: &Range, _unit: &str) -> Check {
        self.check_points(key)
    }

    fn kind() -> KeyKind {
        KeyKind::FrequencyResponse
    }
}
