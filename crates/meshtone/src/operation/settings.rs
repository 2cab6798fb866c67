//! Sampling, length, settling and initial state.

use std::ops::Bound::{Excluded, Included};

use crate::keys::{KeyRow, Range, keys, rows, rows_but};

/// Settings of the solver of the equations of motion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Solver {
    /// (S/s) Nominal sampling rate; the actual one is the next with a whole number of samples from one pair of teeth to the next.
    /// Default 1e5: the acceleration below 10 kHz of the healthy pair and of damaged ones whose teeth do not bounce is then within 1 % of
    /// that at 2 MS/s.
    pub sampling_rate_hz: f64,
    /// (s) How long the kept signal is. Default as long as [`Self::pinion_revolutions`] says.
    pub duration_s: Option<f64>,
    /// (-) Revolutions of the pinion, at its nominal speed, that are kept. Without this and [`Self::duration_s`], `2 z_g` revolutions
    /// are simulated, and what settling leaves of them is kept; of a profile all is kept.
    pub pinion_revolutions: Option<f64>,
    /// (-) Part of the simulated time that is discarded: the vibration settles before the kept signal starts. Default 0.5.
    pub settle_fraction: f64,
    /// (-) How far the transient of the slowest mode must have decayed where the kept signal starts: `linear` starts
    /// in the static equilibrium of the loaded mesh, and leaves out what is not needed for that. 0 for
    /// the whole settling. Default 1e-6.
    pub settle_tolerance: f64,
    /// (Hz) Natural frequency up to which the modes of shafts of beams are stepped; those above deform at rest with their forces. None for
    /// 20 kHz, or 0.4 of the sampling rate where that is less.
    pub highest_mode_hz: Option<f64>,
    /// (m, rad) Initial displacement of the 13 coordinates. Default 0 under `published`, else the static
    /// equilibrium of the loaded mesh.
    pub initial_displacement: Option<[f64; 13]>,
    /// (m/s, rad/s) Initial velocity of the 13 coordinates. Default the rigid rotation.
    pub initial_velocity: Option<[f64; 13]>,
}

impl Solver {
    /// (Hz) Natural frequency up to which modes of shafts of beams are stepped, given or by default.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) the actual rate
    pub fn highest_mode_hz(&self, sampling_rate_hz: f64) -> f64 {
        self.highest_mode_hz.unwrap_or(20e3f64.min(0.4 * sampling_rate_hz))
    }

    /// Sets what is discarded, and what is kept after it.
    ///
    /// # Arguments
    /// * `discarded_s` - (s) not negative
    /// * `kept_s` - (s) more than 0
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair::example());
    /// scenario.solver.discard_and_keep(3.0, 1.0);
    /// assert_eq!((scenario.solver.settle_fraction, scenario.solver.duration_s), (0.75, Some(1.0)));
    /// ```
    pub fn discard_and_keep(&mut self, discarded_s: f64, kept_s: f64) {
        self.duration_s = Some(kept_s);
        self.pinion_revolutions = None;
        self.settle_fraction = discarded_s / (discarded_s + kept_s);
    }

    /// The key that decides how long the kept signal is: the length that is given, or how much of the whole is discarded.
    pub fn length_key(&self) -> LengthKey {
        let given = [("duration_s", self.duration_s), ("pinion_revolutions", self.pinion_revolutions)];
        let given = given.into_iter().find_map(|(name, value)| Some((name, value?, "raise")));
        let (name, value, change) = given.unwrap_or(("settle_fraction", self.settle_fraction, "lower"));
        LengthKey { name, value, change }
    }
}

/// The key that decides how long the kept signal is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthKey {
    /// The key in the section `[solver]`.
    pub name: &'static str,
    /// The key's value.
    pub value: f64,
    /// What is done to the value for a longer signal: `raise` or `lower`.
    pub change: &'static str,
}

keys! {
    "solver": Solver = default Self {
        sampling_rate_hz: 1e5,
        duration_s: None,
        pinion_revolutions: None,
        settle_fraction: 0.5,
        settle_tolerance: 1e-6,
        highest_mode_hz: None,
        initial_displacement: None,
        initial_velocity: None,
    };
    sampling_rate_hz "S/s"
        "the nominal sampling rate; the actual one is the next at which a whole number of samples passes from one pair of teeth to the next"
        .range(Range::positive());
    duration_s "s" "the length of the kept signal; settling comes before it"
        .otherwise("see pinion_revolutions").range(Range::positive())
        .rule("not beside pinion_revolutions").example("1.0");
    pinion_revolutions "-" "the same as a number of revolutions of the pinion; settling comes before them"
        .otherwise("2 z_g revolutions less settling, or as long as a profile").range(Range::positive())
        .rule("not beside duration_s, not with a speed profile").alternative("20.0");
    settle_fraction "-" "the part of the simulated time that is discarded from the start, while the vibration settles"
        .range(Range::below_one().message("must be from 0 to less than 1, the part of the simulation that is discarded"));
    settle_tolerance "-"
        "the fraction of the slowest mode's transient that may remain where the kept signal starts: a steady simulation starts in equilibrium and simulates only as much of the discarded part as this needs; 0: all of it, as always under published"
        .range(Range::below_one().message("must be from 0 (the whole settling is simulated) to less than 1"));
    initial_displacement "m, rad"
        "the displacement at the start: x, y of the gear, x, y of the pinion, rotation of gear, pinion and brake, z of gear and pinion, tilt φ of both, tilt ψ of both"
        .otherwise("the loaded mesh's equilibrium; zeros under published")
        .example("[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]");
    initial_velocity "m/s, rad/s" "the velocity of the same at the start"
        .otherwise("rigid rotation at the nominal speed").alternative("[ 13 numbers ]");
}

impl Solver {
    /// The rows where revolutions are those of the shaft that is coupled to the motor.
    pub(crate) fn rows_of_shafts() -> Vec<KeyRow<Self>> {
        const OWN: [&str; 5] = [
            "sampling_rate_hz",
            "duration_s",
            "pinion_revolutions",
            "initial_displacement",
            "initial_velocity",
        ];
        rows! {
            sampling_rate_hz "S/s"
                "the nominal sampling rate; the actual one is the next with a whole number of samples per revolution of the input"
                .range(Range::positive());
            duration_s "s" "the length of the kept signal; settling comes before it"
                .otherwise("that of input_revolutions").range(Range::positive())
                .rule("not beside input_revolutions").example("1.0");
            <pinion_revolutions> input_revolutions "rev"
                "the number of kept revolutions of the input; settling comes before them"
                .otherwise("those of 1 s, or as long as a profile").range(Range::positive())
                .rule("not beside duration_s, not with a speed profile").example("30.0");
            .. { rows_but(&OWN) };
            highest_mode_hz "Hz" "the natural frequency up to which modes are integrated; those above deform statically"
                .otherwise("20 kHz, or 0.4 of the sampling rate where that is less")
                .range(Range::between(Excluded(0.0), Included(1e9))).alternative("20000.0");
        }
    }
}
