//! Random draws that depend on nothing but what they are for.
//!
//! Every draw is keyed by (seed, purpose, index): a counter-based generator (ChaCha with 8 rounds)
//! is started at that key, so that results do not depend on threads, lanes or on which other
//! draws were made.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Purpose of a random number; draws for different purposes are independent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
#[non_exhaustive]
pub enum Purpose {
    /// Profile errors of the pinion's teeth; index: tooth.
    PinionProfileErrors = 1,
    /// Profile errors of the gear's teeth; index: tooth.
    GearProfileErrors = 2,
    /// Roughness of a destroyed flank; index: 0.
    DestructionNoise = 3,
    /// Error of the motor's speed, sample by sample; index: 0.
    SpeedFluctuation = 4,
    /// Error of the brake's torque, sample by sample; index: 0.
    TorqueFluctuation = 5,
    /// Noise of an enhanced difference signal, value by value; index: draw.
    EnhancementNoise = 6,
    /// Records of a bootstrap sample; index: sample.
    Bootstrap = 7,
    /// Values of scenario keys that are tried; index: candidate.
    Candidate = 8,
    /// Wheels of a unit of a data set; index: unit.
    DatasetWheels = 9,
    /// Seed of a record of a data set; index: record.
    DatasetSeed = 10,
    /// The order of a data set's records and units, and seeds of its designs; index: which of them.
    DatasetDesign = 11,
    /// Values that a unit of a data set is drawn with; index: unit.
    DatasetUnit = 12,
    /// Values that a record of a data set is drawn with; index: its number in its class.
    DatasetRecord = 13,
    /// Angle of a unit's mark, and revolution in which a record begins; index: 0.
    DatasetStart = 14,
    /// Noise of a recorded channel, value by value; index: channel.
    RecordNoise = 15,
    /// Deviations of the pinion under `contact`; index: common, run-out, pitches, then the teeth.
    PinionDeviations = 16,
    /// Deviations of the gear.
    GearDeviations = 17,
    /// Noise of a sensor, sample by sample; index: the sensor's place in the scenario's list.
    SensorNoise = 18,
    /// Pits of a tooth: how many, where, how large; index: the tooth, and its wheel.
    Pits = 19,
    /// Values that a mounting of a data set's unit is drawn with, and its seed; index: mounting.
    DatasetMounting = 20,
    /// Ripple of the path to a sensor over frequency; index: what stands for the channel's name.
    PathRipple = 21,
    /// Seed of a unit's run to failure; index: unit. Under it its life and its end; index: 0.
    DatasetRun = 22,
    /// Times at which the pits of a run appear; index: 0.
    DatasetPits = 23,
    /// Times at which a run is recorded; index: record of the run.
    DatasetInspection = 24,
    /// The mounting that a unit's first record of a class is of; index: unit.
    DatasetTurn = 25,
    /// Properties that a pair of a reference set shares with its records; index: unit.
    DiagnosisUnit = 26,
    /// Properties of a record of a reference set; index: record.
    DiagnosisRecord = 27,
    /// Noise that is added to the averages of a reference set; index: record.
    DiagnosisNoise = 28,
    /// Random Fourier features of a diagnosis; index: feature.
    DiagnosisFeature = 29,
    /// Modes of the housing that a sensor sits on: frequencies and shares; index: 0.
    HousingModes = 30,
    /// Seed of the deviations of a gearbox's wheel; index: wheel.
    GearboxWheel = 31,
    /// Seed of the wheels with which a recording of the healthy machine is compared; index: draw.
    PathWheels = 32,
    /// Angles of the cage and of an element of a rolling bearing at the start; index: bearing.
    BearingStart = 33,
    /// Slip of a rolling bearing's cage, pass by pass; index: bearing.
    BearingSlip = 34,
    /// Speed and load of a record of a reference set; index: record.
    DiagnosisOperation = 35,
    /// Natural frequencies of a gearbox's housing; index: mode.
    HousingFrequency = 36,
    /// Shapes of a housing's modes at a bearing's seat, mode by mode along x, y and z; index: bearing.
    HousingShapeAtSeat = 37,
    /// The same at a sensor on the housing; index: what stands for its place.
    HousingShapeAtSensor = 38,
    /// Random part of the force across a mesh, sample by sample; index: mesh.
    RandomForce = 39,
    /// Wander of the motor's speed, from the start of the kept signal on; index: 0.
    SpeedWander = 40,
    /// Phase of a wheel's helix slope that turns with it; index: 0.
    HelixWobble = 41,
    /// Splits of a decision tree; index: tree.
    Trees = 42,
}

/// A sequence of random numbers.
#[derive(Debug, Clone)]
pub struct Draws {
    generator: ChaCha8Rng,
}

impl Draws {
    /// The sequence for `purpose` and `index` under `seed`.
    ///
    /// # Arguments
    /// * `seed` - of all draws that belong together
    /// * `purpose` - what they are for
    /// * `index` - which of the sequences for that purpose
    pub fn new(seed: u64, purpose: Purpose, index: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
        key[16..24].copy_from_slice(&index.to_le_bytes());
        Self { generator: ChaCha8Rng::from_seed(key) }
    }

    /// Next 64 random bits.
    ///
    /// ```
    /// use meshtone::random::{Draws, Purpose};
    ///
    /// let bits = |index| Draws::new(1, Purpose::DatasetSeed, index).bits();
    /// assert_eq!(bits(3), bits(3));
    /// assert_ne!(bits(3), bits(4));
    /// ```
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Next number, uniform in `centre` ± `half_width`.
    ///
    /// # Arguments
    /// * `centre`, `half_width` - of the range
    pub fn uniform(&mut self, centre: f64, half_width: f64) -> f64 {
        // 53 random bits: every multiple of 2⁻⁵³ in [0, 1).
        let unit = (self.bits() >> 11) as f64 * 2f64.powi(-53);
        centre + half_width * (2.0 * unit - 1.0)
    }

    /// Next number, normal with mean 0 and standard deviation 1: the first of [`Self::normals`].
    pub fn normal(&mut self) -> f64 {
        self.normals()[0]
    }

    /// Next two numbers, independent and normal with mean 0 and standard deviation 1.
    ///
    /// Source: G. E. P. Box, M. E. Muller, "A note on the generation of random normal deviates", Ann. Math. Statist. 29
    /// (1958) 610–611.
    pub fn normals(&mut self) -> [f64; 2] {
        // In (0, 1]: its logarithm is finite.
        let unit = 1.0 - self.uniform(0.5, 0.5);
        let angle = std::f64::consts::TAU * self.uniform(0.5, 0.5);
        let radius = (-2.0 * unit.ln()).sqrt();
        [radius * angle.cos(), radius * angle.sin()]
    }
}
