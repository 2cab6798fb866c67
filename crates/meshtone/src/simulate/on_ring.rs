//! Sensors on the ring of a planetary set: they stand still while the set's frame turns past them.
//!
//! The solution knows the ring in the frame of the carrier, where a sensor at the angle φ_S of the ground is at φ = φ_S − θ_c. Its displacement is
//! `u = Σ A(φ) q`, q the ring's coordinates, and its acceleration `Σ A q̈ + 2 Ȧ q̇ + Ä q` with `Ȧ = −Ω A'` and `Ä = Ω² A''`: so the passage of the
//! planets comes from the shape of the rim itself.

use std::f64::consts::TAU;

use super::{AssembledMachine, Stages};
use crate::machine::{RimShape, SetCoordinates};
use crate::operation::{Motion, MotionSample, TimeGrid};
use crate::solver::{Block, MotionState, OnRing, Output, Recorder, StepCounts};

/// How the motion of a place depends on one coordinate.
pub(super) struct Term {
    pub(super) coordinate: usize,
    /// Number of waves, with which the weight changes around the ring.
    waves: usize,
    shape: TermShape,
}

enum TermShape {
    X,
    Y,
    Rotation { radius_m: f64 },
    Rim(RimShape),
}

impl Term {
    /// What the coordinate adds to the motion outwards and around, and how that changes with the angle.
    ///
    /// # Arguments
    /// * `wave` - cosine and sine of its number of waves times the angle in the carrier's frame
    fn of_wave(&self, [cos, sin]: [f64; 2]) -> [[f64; 2]; 2] {
        match self.shape {
            TermShape::X => [[cos, -sin], [-sin, -cos]],
            TermShape::Y => [[sin, cos], [cos, -sin]],
            TermShape::Rotation { radius_m } => [[0.0, radius_m], [0.0; 2]],
            TermShape::Rim(shape) => shape.of_wave([cos, sin]),
        }
    }
}

/// The terms of the motion of a place.
fn terms(on: &OnRing, of_set: &SetCoordinates, radius_m: f64) -> Vec<Term> {
    let ring = of_set.members[2];
    let rigid = [(0, 1, TermShape::X), (1, 1, TermShape::Y), (2, 0, TermShape::Rotation { radius_m })]
        .map(|(axis, waves, shape)| Term { coordinate: ring + axis, waves, shape });
    let rim = of_set.rim.iter().filter(|(shape, _)| !on.is_far || shape.waves == 0);
    let rim =
        rim.map(|&(shape, coordinate)| Term { coordinate, waves: shape.waves, shape: TermShape::Rim(shape) });
    rigid.into_iter().chain(rim).collect()
}

/// Cosine and sine of every multiple of an angle that terms need.
fn multiples(angle_rad: f64, terms: &[Term]) -> Vec<[f64; 2]> {
    let (sin, cos) = angle_rad.sin_cos();
    let most = terms.iter().map(|term| term.waves).max().unwrap_or(0);
    let next = |[c, s]: &[f64; 2]| Some([c * cos - s * sin, s * cos + c * sin]);
    std::iter::successors(Some([1.0, 0.0]), next).take(most + 1).collect()
}

/// Where an asked output comes from among those that the solution gives.
enum Source {
    /// As it is.
    Same(usize),
    /// Of displacement, velocity and acceleration of each term, one after the other from a number on.
    OnRing { on: OnRing, terms: Vec<Term>, first: usize, carrier_ratio: f64 },
}

/// Hands on what a place on a turning ring shows, in place of the coordinates that it depends on.
struct OfRings<'a> {
    inner: &'a mut dyn Recorder,
    sources: Vec<Source>,
    motion: Motion<'a>,
    next_sample: usize,
}

impl Stages {
    /// Solves with coordinates in place of what is asked for on rings, and hands on what is asked for.
    ///
    /// # Arguments
    /// * `machine`, `time` - what is solved, and its division of time
    /// * `outputs`, `first_sample` - what is asked for, and from where on
    /// * `recorder` - takes it
    /// * `solve` - solves for some outputs
    pub(super) fn with_rings<T>(
        &self,
        (machine, time): (&AssembledMachine, &TimeGrid),
        (outputs, first_sample): (&[Output], usize),
        recorder: &mut dyn Recorder,
        solve: impl FnOnce(&[Output], &mut dyn Recorder) -> T,
    ) -> T {
        if !outputs.iter().any(|output| matches!(output, Output::OnRing(_))) {
            return solve(outputs, recorder);
        }
        let (mut asked, mut sources) = (Vec::new(), Vec::new());
        for output in outputs {
            let Output::OnRing(on) = output else {
                sources.push(Source::Same(asked.len()));
                asked.push(output.clone());
                continue;
            };
            let terms = terms(on, &machine.sets[on.set], machine.rim_radii_m[on.set]);
            let first = asked.len();
            asked.extend(terms.iter().flat_map(|term| {
                [0, 1, 2].map(|derivative| Output::Coordinate { number: term.coordinate, derivative })
            }));
            let carrier_ratio = self.layout.sets[on.set].ratios[1].value();
            sources.push(Source::OnRing { on: *on, terms, first, carrier_ratio });
        }
        // A motion that changes is gone through from its start.
        let next_sample = match self.scenario.operation.turns_evenly() {
            true => first_sample,
            false => time.first_simulated_sample,
        };
        let motion = self.motion_from(time.first_simulated_sample, time).starting_at(next_sample);
        solve(&asked, &mut OfRings { inner: recorder, sources, motion, next_sample })
    }
}

impl Stages {
    /// The terms of the motion of a place on a ring; none of a machine without rings.
    pub(super) fn terms_of(&self, on: &OnRing) -> Vec<Term> {
        let of_set = self
            .machine()
            .and_then(|(machine, _)| Some((machine.sets.get(on.set)?, machine.rim_radii_m.get(on.set)?)));
        of_set.map_or_else(Vec::new, |(of_set, radius_m)| terms(on, of_set, *radius_m))
    }

    /// (rad) The angle of a place on a ring in the carrier's frame, at each kept sample.
    pub(super) fn kept_angles_rad(&self, on: &OnRing) -> Vec<f64> {
        let carrier_ratio = self.layout.sets[on.set].ratios[1].value();
        let at = |motion: &MotionSample| on.angle_rad - TAU * carrier_ratio * motion.revolutions;
        self.kept_motion().iter().map(at).collect()
    }
}

impl Term {
    /// The weight of the coordinate's acceleration in what is measured at a place.
    ///
    /// # Arguments
    /// * `on` - the place
    /// * `angle_rad` - (rad) where it is in the carrier's frame
    pub(super) fn weight(&self, on: &OnRing, angle_rad: f64) -> f64 {
        let (sin, cos) = (on.direction_rad - on.angle_rad).sin_cos();
        let (wave_sin, wave_cos) = (self.waves as f64 * angle_rad).sin_cos();
        let [[radial, tangential], _] = self.of_wave([wave_cos, wave_sin]);
        on.factor * (cos * radial + sin * tangential)
    }
}

impl Recorder for OfRings<'_> {
    fn record(&mut self, block: &Block) {
        while self.next_sample < block.first_sample {
            self.motion.next();
            self.next_sample += 1;
        }
        let samples = block.len();
        let motion: Vec<_> = self.motion.by_ref().take(samples).collect();
        self.next_sample += samples;
        let shown = |source: &Source| match source {
            Source::Same(number) => block.output(*number).to_vec(),
            Source::OnRing { on, terms, first, carrier_ratio } => {
                let (sin, cos) = (on.direction_rad - on.angle_rad).sin_cos();
                let along = |[radial, tangential]: [f64; 2]| cos * radial + sin * tangential;
                let of_sample = |(sample, motion): (usize, &MotionSample)| {
                    let waves = multiples(on.angle_rad - TAU * carrier_ratio * motion.revolutions, terms);
                    let rad_per_s = TAU * motion.speed_hz * carrier_ratio;
                    let of_term = |(number, term): (usize, &Term)| {
                        let [displacement, velocity, acceleration] =
                            [0, 1, 2].map(|derivative| block.output(first + 3 * number + derivative)[sample]);
                        let [here, slope] = term.of_wave(waves[term.waves]).map(along);
                        let curved = here * (term.waves as f64 * rad_per_s).powi(2);
                        here * acceleration - 2.0 * rad_per_s * slope * velocity - curved * displacement
                    };
                    on.factor * terms.iter().enumerate().map(of_term).sum::<f64>()
                };
                motion.iter().enumerate().map(of_sample).collect()
            }
        };
        let outputs: Vec<Vec<f64>> = self.sources.iter().map(shown).collect();
        self.inner.record(&Block::new(block.first_sample, &outputs));
    }

    fn wants_state(&self, sample: usize) -> bool {
        self.inner.wants_state(sample)
    }

    fn keep_state(&mut self, state: MotionState) {
        self.inner.keep_state(state);
    }

    fn count(&mut self, counts: StepCounts) {
        self.inner.count(counts);
    }

    fn goes_on(&self) -> bool {
        self.inner.goes_on()
    }
}
