//! The modes in which a housing vibrates, drawn as those of a plate with ribs are spread: so many a kHz, with shapes of no order.
//!
//! A rigid housing has no mode between those on its feet, some hundred Hz, and those of the seats. A real one has one to three a kHz that
//! stand out of its spectrum. Which they are no drawing tells; how dense they are, and how far they are damped, decides how even the spectrum is.
//! Each has the mass of the housing, and at each seat and each sensor a shape along x, y and z that is normal with mean 0 and standard
//! deviation 1, so that its mobility, averaged over frequency, is that of a plate: density over four times the mass.
//!
//! Source: L. Cremer, M. Heckl, B. A. T. Petersson, *Structure-Borne Sound*, 3rd edition (2005), section 4.3, on the mean mobility.

use std::f64::consts::TAU;

use crate::keys::{Range, keys};
use crate::random::{Draws, Purpose};

/// (Hz) Frequency above which a housing has no modes: what lies higher hardly passes to where sensors sit.
const HIGHEST_HZ: f64 = 9e3;

/// The modes of a housing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HousingModes {
    /// (1/kHz) How many there are in a kHz; 0 of a rigid housing. Default 4.
    pub per_khz: f64,
    /// (Hz) The frequency from which on there are any. Default 350.
    pub first_hz: f64,
    /// (-) Their damping ratio. Default 0.03.
    pub damping_ratio: f64,
    /// Seed of their frequencies and shapes: which housing it is. Default 1.
    pub seed: u64,
}

impl HousingModes {
    /// Those of a rigid housing: none.
    pub const RIGID: Self = Self { per_khz: 0.0, first_hz: 350.0, damping_ratio: 0.03, seed: 1 };

    /// Number of the modes.
    pub(super) fn count(&self) -> usize {
        ((HIGHEST_HZ - self.first_hz).max(0.0) * 1e-3 * self.per_khz).round() as usize
    }

    /// (rad/s) Natural frequencies: one drawn in each stretch of 1 kHz over their number in it.
    pub(super) fn angular_frequencies(&self) -> Vec<f64> {
        let drawn = |mode: usize| {
            let part = Draws::new(self.seed, Purpose::HousingFrequency, mode as u64).uniform(0.5, 0.5);
            TAU * (self.first_hz + (mode as f64 + part) * 1e3 / self.per_khz)
        };
        (0..self.count()).map(drawn).collect()
    }

    /// (-) The shape of each mode at a point of the housing.
    ///
    /// # Arguments
    /// * `point` - where
    /// * `axis` - 0 to 2 of x, y and z
    pub(super) fn shapes(&self, point: HousingPoint, axis: usize) -> Vec<f64> {
        let mut draws = match point {
            HousingPoint::Seat(bearing) => Draws::new(self.seed, Purpose::HousingShapeAtSeat, bearing as u64),
            HousingPoint::At(at_m) => {
                Draws::new(self.seed, Purpose::HousingShapeAtSensor, place_number(at_m))
            }
        };
        let mut next = || [draws.normal(), draws.normal(), draws.normal()];
        (0..self.count()).map(|_| next()[axis]).collect()
    }
}

/// A point of a housing at which its modes have shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HousingPoint {
    /// The seat of a bearing, by its number.
    Seat(usize),
    /// (m) Anywhere else.
    At([f64; 3]),
}

/// A number that stands for a place: two sensors at one place see one shape.
fn place_number(at_m: [f64; 3]) -> u64 {
    // A micrometre is the same place.
    let whole_um = at_m.map(|along_m| (along_m * 1e6).round() as i64 as u64);
    whole_um
        .into_iter()
        .fold(0, |number, along| number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(along))
}

keys! {
    HousingModes = default Self { per_khz: 4.0, ..Self::RIGID };
    per_khz "1/kHz" "how many modes it has in a kHz, up to 9 kHz; 0 for a rigid housing"
        .range(Range::from_to(0.0, 20.0));
    first_hz "Hz" "the frequency from which on it has modes" .range(Range::positive().implausible_above(9e3));
    damping_ratio "-" "the damping ratio of its modes"
        .range(Range::below_one().help("measured peaks of housings have 0.01 to 0.06"));
    seed "" "the seed of their frequencies and shapes: which housing it is";
}
