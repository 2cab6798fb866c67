//! What lies between the rigid mass of a support and a sensor on it: the wall, and the housing.

use std::f64::consts::TAU;

use meshtone_fourier::Complex64;

use super::measure::REMEMBERED;
use crate::error::ScenarioError;
use crate::keys::{Check, Range, check_keys, keys};
use crate::random::{Draws, Purpose};

/// The path from the motion of a support's mass to that of a sensor on it.
///
/// The sensor sits on a wall that bends under the force of the bearing: by `1 + j f/f_c` more than the rigid mass moves, where the wall is
/// so large that nothing comes back from its edges. A housing of finite size has modes instead. Both have minimum phase or come close
/// to it, and neither changes the motion below a few hundred hertz.
///
/// Source of the plate's mobility: L. Cremer, M. Heckl, B. A. T. Petersson, *Structure-Borne Sound*, 3rd edition (2005), section 5.3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SensorPath {
    /// (Hz) Frequency at which the wall under the sensor bends as far as the rigid mass moves; 0: no wall. Default 4000.
    pub plate_hz: f64,
    /// (1/kHz) Housing modes in a kilohertz of the band. Default 1.43.
    pub modes_per_khz: f64,
    /// (Hz) The band in which the housing has modes. Default 3.5 to 14 kHz.
    pub band_hz: [f64; 2],
    /// (-) Damping ratio of the housing's modes. Default 0.015.
    pub damping_ratio: f64,
    /// (-) Standard deviation of the share that a mode of the housing has in the motion. Default 0: no housing modes.
    pub strength: f64,
    /// Seed of the housing's modes. Default 1.
    pub seed: u64,
}

/// (-) Frequency at which the plate's response stops growing, over [`SensorPath::plate_hz`].
const PLATE_ENDS: f64 = 10.0;
/// Most modes of a housing.
const MOST_MODES: f64 = 1e4;

const HZ: Range = Range::positive().implausible_above(1e7);

keys! {
    SensorPath = default Self { plate_hz: 4000.0, ..Self::RIGID };
    plate_hz "Hz" "the frequency at which the wall under the sensor bends as far as the support moves; 0: no wall"
        .range(Range::not_negative().implausible_above(1e7));
    strength "-" "the standard deviation of a housing mode's share; 0: no modes"
        .range(Range::not_negative().implausible_above(100.0));
    modes_per_khz "1/kHz" "the housing modes in a kilohertz" .range(Range::positive().implausible_above(1e3));
    band_hz "Hz" "the frequency band of the housing's modes"
        .range(HZ).rule("the first less than the second");
    damping_ratio "-" "the damping ratio of the housing's modes"
        .range(Range::positive().implausible_above(1.0));
    seed "" "the seed of the housing's modes";
}

/// A mode of a housing.
struct HousingMode {
    hz: f64,
    /// (-) Its share in the motion.
    share: f64,
}

impl SensorPath {
    /// Nothing: the sensor moves with the support.
    pub const RIGID: Self = Self {
        plate_hz: 0.0,
        modes_per_khz: 1.43,
        band_hz: [3500.0, 14_000.0],
        damping_ratio: 0.015,
        strength: 0.0,
        seed: 1,
    };

    /// Whether there is anything between support and sensor.
    pub fn is_rigid(&self) -> bool {
        self.plate_hz == 0.0 && self.strength == 0.0
    }

    /// The complex gain at a list of frequencies: `H = (1 + j f/f_c)/(1 + j f/10 f_c)` of the plate, times
    /// `H = 1 + Σ g f²/(f_r² − f² + 2 j ζ f_r f)` of the housing.
    ///
    /// # Arguments
    /// * `frequencies_hz` - (Hz)
    ///
    /// ```
    /// use meshtone::scenario::SensorPath;
    ///
    /// let path = SensorPath::default();
    /// let gains = path.at([0.0, 4000.0]);
    /// assert_eq!(gains[0].norm(), 1.0);
    /// assert!((gains[1].norm() / 2f64.sqrt() - 1.0).abs() < 0.01);
    /// ```
    pub fn at(&self, frequencies_hz: impl IntoIterator<Item = f64>) -> Vec<Complex64> {
        let modes = self.housing_modes();
        let gain = |hz: f64| {
            let housing = modes.iter().map(|mode| {
                let below =
                    Complex64::new(mode.hz * mode.hz - hz * hz, 2.0 * self.damping_ratio * mode.hz * hz);
                mode.share * hz * hz / below
            });
            let plate = if self.plate_hz == 0.0 {
                Complex64::ONE
            } else {
                let ratio = hz / self.plate_hz;
                Complex64::new(1.0, ratio) / Complex64::new(1.0, ratio / PLATE_ENDS)
            };
            plate * (Complex64::ONE + housing.sum::<Complex64>())
        };
        frequencies_hz.into_iter().map(gain).collect()
    }

    /// (Hz) Frequencies of the housing's modes, rising; none without.
    ///
    /// ```
    /// use meshtone::scenario::SensorPath;
    ///
    /// let mut path = SensorPath::default();
    /// assert!(path.housing_frequencies_hz().is_empty());
    /// path.strength = 0.2;
    /// assert_eq!(path.housing_frequencies_hz().len(), 15);
    /// ```
    pub fn housing_frequencies_hz(&self) -> Vec<f64> {
        let mut frequencies: Vec<f64> = self.housing_modes().iter().map(|mode| mode.hz).collect();
        frequencies.sort_by(f64::total_cmp);
        frequencies
    }

    /// The modes that the seed draws: uniform over the band, with normal shares.
    fn housing_modes(&self) -> Vec<HousingMode> {
        if self.strength == 0.0 {
            return Vec::new();
        }
        let mut draws = Draws::new(self.seed, Purpose::HousingModes, 0);
        let [low, high] = self.band_hz;
        let mode = |_| {
            let hz = draws.uniform((low + high) / 2.0, (high - low) / 2.0);
            HousingMode { hz, share: self.strength * draws.normal() }
        };
        (0..self.mode_count() as usize).map(mode).collect()
    }

    fn mode_count(&self) -> f64 {
        ((self.band_hz[1] - self.band_hz[0]) * 1e-3 * self.modes_per_khz).round()
    }

    /// (s) How long what passes depends on what was before: until 1e-6 of it is left.
    pub fn memory_s(&self) -> f64 {
        let decay_s = |rad_per_s: f64| -REMEMBERED.ln() / rad_per_s;
        let plate_s = if self.plate_hz == 0.0 { 0.0 } else { decay_s(TAU * PLATE_ENDS * self.plate_hz) };
        let housing_s =
            if self.strength == 0.0 { 0.0 } else { decay_s(TAU * self.band_hz[0] * self.damping_ratio) };
        plate_s.max(housing_s)
    }

    /// Refuses housing modes without effect: keys of modes where there are none, and a band that holds none.
    fn check_effect(&self, band: String) -> Check {
        let without_modes = Self { plate_hz: self.plate_hz, ..Self::RIGID };
        if self.strength == 0.0 && *self != without_modes {
            let problem =
                "leaves modes_per_khz, band_hz, damping_ratio and seed without effect: there are no modes";
            return Err(ScenarioError::new("sensor.path.strength", "0.0", problem)
                .with_help("write strength too (0.1 to 0.4), or remove the others"));
        }
        if self.strength != 0.0 && self.mode_count() == 0.0 {
            let problem = "holds no mode, so that sensor.path.strength is without effect";
            return Err(ScenarioError::new("sensor.path.band_hz", band, problem)
                .with_help("take a wider band, or more modes_per_khz"));
        }
        Ok(())
    }

    pub(super) fn check(&self) -> Check {
        check_keys(self, "sensor.path")?;
        let [low, high] = self.band_hz;
        let value = || format!("[{low:?}, {high:?}]");
        if low >= high {
            return Err(ScenarioError::new("sensor.path.band_hz", value(), "must rise"));
        }
        self.check_effect(value())?;
        if self.mode_count() > MOST_MODES {
            let problem = format!("holds {} modes; must hold at most {MOST_MODES}", self.mode_count());
            return Err(ScenarioError::new("sensor.path.band_hz", value(), problem)
                .with_help("take a narrower band, or fewer modes_per_khz"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `|H|² = (1 + (f/f_c)²)/(1 + (f/10 f_c)²)`, of minimum phase: the phase of the pole and the zero.
    #[test]
    fn a_plate_is_the_closed_form() {
        let path = SensorPath::default();
        let frequencies = [0.0, 100.0, 4000.0, 10_000.0, 40_000.0];
        for (hz, gain) in frequencies.into_iter().zip(path.at(frequencies)) {
            let ratio = hz / 4000.0;
            let magnitude = ((1.0 + ratio * ratio) / (1.0 + ratio * ratio / 100.0)).sqrt();
            assert!((gain.norm() / magnitude - 1.0).abs() < 1e-12);
            assert!((gain.arg() - (ratio.atan() - (ratio / 10.0).atan())).abs() < 1e-12);
        }
    }

    /// At one of its modes alone a housing moves `1 + g/(2 j ζ)` times as far; far below it moves with the support.
    #[test]
    fn a_housing_mode_resonates() {
        let path =
            SensorPath { modes_per_khz: 1.0, band_hz: [5000.0, 6000.0], strength: 0.2, ..SensorPath::RIGID };
        let [mode] = &path.housing_modes()[..] else { panic!("not one mode") };
        let [far, at] = path.at([1.0, mode.hz])[..] else { panic!("not two gains") };
        assert!((far.norm() - 1.0).abs() < 1e-6);
        let expected = Complex64::ONE + mode.share / Complex64::new(0.0, 2.0 * path.damping_ratio);
        assert!((at - expected).norm() < 1e-9 * expected.norm());
    }

    /// The draws have the number, the band and the deviation that are asked for, and belong to the seed.
    #[test]
    fn housings_are_drawn_by_their_seed() {
        let path = |seed| SensorPath { modes_per_khz: 100.0, strength: 0.3, seed, ..SensorPath::RIGID };
        let modes = path(7).housing_modes();
        assert_eq!(modes.len(), 1050);
        assert!(modes.iter().all(|mode| (3500.0..=14_000.0).contains(&mode.hz)));
        let deviation = (modes.iter().map(|mode| mode.share * mode.share).sum::<f64>() / 1050.0).sqrt();
        // Of 1050 draws it scatters by 2 %.
        assert!((deviation / 0.3 - 1.0).abs() < 0.1, "{deviation}");
        assert_eq!(path(7).at([8e3]), path(7).at([8e3]));
        assert_ne!(path(7).at([8e3]), path(8).at([8e3]));
    }
}
