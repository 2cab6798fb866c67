//! The pairs of the mesh under `contact`, sample by sample.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use super::contact_mesh::{ContactMesh, ContactTable};
use super::contact_pairs::ContactState;
use super::forcing::{Forcing, ForcingBlock};
use super::pair_forcing::{FlankErrors, PairDeviations};
use crate::operation::{Motion, TimeGrid};
use crate::wheel::WheelName;

/// Most pairs that a step looks at: as many as reach from `ε + 0.6` back to `−0.6` base pitches.
pub(crate) const PAIRS: usize = 3;

/// The pairs at successive samples. Pair n is in place `n mod PAIRS`.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairsBlock {
    /// (N/m) Stiffness; 0 where there is no pair.
    pub(crate) stiffness: [Vec<f64>; PAIRS],
    /// (m) What the pair's deviation and separation add to the deflection, with the damping's lead: `o + τ ȯ`, `o = e − S`.
    pub(crate) offset: [Vec<f64>; PAIRS],
    /// (m) Where along the face the load acts; empty where that is the middle throughout.
    pub(crate) face_centre: Vec<f64>,
}

impl PairsBlock {
    /// Room for `samples` samples, whatever they hold: the steady forcing sets each.
    fn resize(&mut self, samples: usize, tilts: bool) {
        for values in self.stiffness.iter_mut().chain(&mut self.offset) {
            values.resize(samples, 0.0);
        }
        self.face_centre.resize(if tilts { samples } else { 0 }, 0.0);
    }

    /// `samples` samples without pairs.
    fn clear(&mut self, samples: usize, tilts: bool) {
        self.resize(0, false);
        self.resize(samples, tilts);
    }
}

/// Forcing of a mesh under `contact`.
pub(crate) struct ContactForcing<'a> {
    mesh: &'a ContactMesh,
    motion: Motion<'a>,
    pinion: FlankErrors<'a>,
    gear: FlankErrors<'a>,
    eccentricity: Option<Eccentricity>,
    directions: usize,
    /// Whether the load moves along the face.
    tilts: bool,
    sample: usize,
    step_s: f64,
    nominal_speed_hz: f64,
    nominal_torque_nm: f64,
    /// While motor and brake are steady every sample is a point of the tables.
    steady: Option<SteadyTables>,
    /// (m) Offset of each place's pair at the sample before, with the pair's number; while they are not.
    before: [(i64, [f64; 2]); PAIRS],
}

/// By class and by tooth, with the damping's lead, at every point of a pair.
struct SteadyTables {
    /// (N/m) By class.
    stiffness: Vec<Vec<f64>>,
    /// (m) By class, `−S` less that of sound pairs.
    further_apart_m: Vec<Vec<f64>>,
    /// (m) Deviation by tooth.
    pinion_m: Vec<Vec<f64>>,
    /// (m) Deviation by tooth, and `−S` of sound pairs: all that most pairs need beside the pinion's.
    gear_m: Vec<Vec<f64>>,
    /// By class; none where the load stays midway along the face.
    bearing: Vec<Bearing>,
}

/// The class of sound pairs.
const SOUND: usize = 0;

/// What a class of pairs bears of the nominal load, at every point of a pair.
struct Bearing {
    /// (N) Load.
    load: Vec<f64>,
    /// (N m) Its moment about the middle of the face.
    moment: Vec<f64>,
    /// Whether it would bear beside the middle anywhere.
    leans: bool,
}

impl Bearing {
    fn of(mesh: &ContactMesh, table: &ContactTable) -> Self {
        let load: Vec<f64> = table.states.iter().map(|state| borne_n(mesh, state)).collect();
        let moment: Vec<f64> =
            load.iter().zip(&table.states).map(|(load, state)| load * state.face_centre_m).collect();
        let leans = table.states.iter().any(|state| state.face_centre_m != 0.0);
        Self { load, moment, leans }
    }
}

/// Makes an offset at uniform points `o + τ ȯ`, the derivative by central differences: one to the point before would be late by half
/// a step, and the motion's error of the first order.
fn add_lead(offset_m: &mut [f64], lead: f64) {
    let mut before = offset_m.first().copied().unwrap_or(0.0);
    for n in 0..offset_m.len() {
        let now = offset_m[n];
        let after = offset_m.get(n + 1).copied().unwrap_or(now);
        offset_m[n] += lead / 2.0 * (after - before);
        before = now;
    }
}

impl<'a> ContactForcing<'a> {
    /// Forcing from sample `first_sample` on.
    ///
    /// # Arguments
    /// * `mesh` - the pairs, tabulated at every sample of a pitch while motor and brake are steady
    /// * `deviations` - how the flanks deviate
    /// * `motion` - motor and brake from the start
    /// * `time` - division of time
    /// * `nominal` - (Hz, N m) nominal speed and torque
    /// * `directions` - number of directions in which a force of the deviations is asked for: it is 0, since it depends on which
    ///   teeth touch
    /// * `first_sample` - beyond 0 only while motor and brake are steady
    pub(crate) fn new(
        mesh: &'a ContactMesh,
        deviations: &PairDeviations<'a>,
        motion: Motion<'a>,
        time: &TimeGrid,
        [nominal_speed_hz, nominal_torque_nm]: [f64; 2],
        directions: usize,
        first_sample: usize,
    ) -> Self {
        let [pinion, gear] = FlankErrors::of_both(deviations);
        let lead = mesh.damping_time_s / time.step_s();
        let eccentricity = Eccentricity::of(deviations);
        let tilts = mesh.tilts();
        let sound = &mesh.classes[SOUND].states;
        let steady = (motion.is_steady() && motion.has_constant_torque()).then(|| {
            let tabulate = |flanks: &FlankErrors, wheel: WheelName| -> Vec<Vec<f64>> {
                let mut tables = flanks.tabulate_at((0..mesh.points()).map(|point| mesh.position(point)));
                tables.resize_with(mesh.sequence.teeth_of(wheel), || vec![0.0; mesh.points()]);
                if let Some(eccentricity) = &eccentricity {
                    eccentricity.add_to(&mut tables, mesh, wheel);
                }
                if wheel == WheelName::Gear {
                    let apart =
                        |(deviation, state): (&mut f64, &ContactState)| *deviation -= state.separation_m;
                    tables.iter_mut().for_each(|table| table.iter_mut().zip(sound).for_each(apart));
                }
                tables.iter_mut().for_each(|table| add_lead(table, lead));
                tables
            };
            let further_apart = |class: &ContactTable| {
                let states = sound.iter().zip(&class.states);
                let mut further_m: Vec<f64> =
                    states.map(|(sound, state)| sound.separation_m - state.separation_m).collect();
                add_lead(&mut further_m, lead);
                further_m
            };
            SteadyTables {
                stiffness: (mesh.classes.iter())
                    .map(|class| class.states.iter().map(|state| state.stiffness_n_per_m).collect())
                    .collect(),
                further_apart_m: mesh.classes.iter().map(further_apart).collect(),
                bearing: (mesh.classes.iter().filter(|_| tilts))
                    .map(|class| Bearing::of(mesh, class))
                    .collect(),
                pinion_m: tabulate(&pinion, WheelName::Pinion),
                gear_m: tabulate(&gear, WheelName::Gear),
            }
        });
        Self {
            mesh,
            motion,
            pinion,
            gear,
            eccentricity,
            directions,
            tilts,
            sample: first_sample,
            step_s: time.step_s(),
            nominal_speed_hz,
            nominal_torque_nm,
            steady,
            before: [(i64::MIN, [0.0; 2]); PAIRS],
        }
    }

    fn steady_block(&self, tables: &SteadyTables, samples: usize, block: &mut PairsBlock) {
        let (per_pitch, before) = (self.mesh.points_per_pitch, self.mesh.points_before);
        // Sample s is point s + before of pair 0, and each pair begins a pitch after the one before.
        let (first, last) = (self.sample + before, self.sample + samples - 1 + before);
        let oldest = (first as i64 - self.mesh.points() as i64).div_euclid(per_pitch as i64) + 1;
        // In each place pairs follow one another; between two of them there is none.
        let mut set = [0; PAIRS];
        let mut leans = false;
        for pair in oldest..=(last / per_pitch) as i64 {
            let Some(Part { from, until, point }) = self.part(pair, samples) else { continue };
            let range = point..point + until - from;
            let place = pair.rem_euclid(PAIRS as i64) as usize;
            let class = self.mesh.sequence.class(pair);
            leans |= tables.bearing.get(class).is_some_and(|bearing| bearing.leans);
            block.stiffness[place][set[place]..from].fill(0.0);
            block.offset[place][set[place]..from].fill(0.0);
            set[place] = until;
            block.stiffness[place][from..until].copy_from_slice(&tables.stiffness[class][range.clone()]);
            let offsets = &mut block.offset[place][from..until];
            let (pinion_tooth, gear_tooth) = self.mesh.sequence.teeth(pair);
            let pinion = &tables.pinion_m[pinion_tooth][range.clone()];
            let gear = &tables.gear_m[gear_tooth][range.clone()];
            for (offset, (pinion, gear)) in offsets.iter_mut().zip(pinion.iter().zip(gear)) {
                *offset = pinion + gear;
            }
            if class != SOUND {
                for (offset, further) in offsets.iter_mut().zip(&tables.further_apart_m[class][range]) {
                    *offset += further;
                }
            }
        }
        for (place, set) in set.into_iter().enumerate() {
            block.stiffness[place][set..].fill(0.0);
            block.offset[place][set..].fill(0.0);
        }
        block.face_centre.fill(0.0);
        if leans {
            self.find_face_centre(tables, oldest..=(last / per_pitch) as i64, &mut block.face_centre);
        }
    }

    /// Which of the next samples a pair takes part in.
    fn part(&self, pair: i64, samples: usize) -> Option<Part> {
        let since_first =
            pair * self.mesh.points_per_pitch as i64 - self.mesh.points_before as i64 - self.sample as i64;
        let from = since_first.max(0);
        let until = (since_first + self.mesh.points() as i64).min(samples as i64);
        let part =
            || Part { from: from as usize, until: until as usize, point: (from - since_first) as usize };
        (from < until).then(part)
    }

    /// (m) Where along the face the load of all pairs acts at the next samples.
    fn find_face_centre(&self, tables: &SteadyTables, pairs: RangeInclusive<i64>, face_centre: &mut [f64]) {
        let mut whole_load = vec![0.0; face_centre.len()];
        for pair in pairs {
            let Some(Part { from, until, point }) = self.part(pair, face_centre.len()) else { continue };
            let bearing = &tables.bearing[self.mesh.sequence.class(pair)];
            let sums = face_centre[from..until].iter_mut().zip(&mut whole_load[from..until]);
            let of_pair = bearing.moment[point..].iter().zip(&bearing.load[point..]);
            for ((moments, whole), (moment, load)) in sums.zip(of_pair) {
                *moments += moment;
                *whole += load;
            }
        }
        for (k, (moment, whole)) in face_centre.iter_mut().zip(whole_load).enumerate() {
            *moment = if whole > 0.0 { *moment / whole } else { self.face_centre_m(self.sample + k) };
        }
    }

    /// (m) Where along the face the load of all pairs acts: where all are further apart than the nominal load presses the mean mesh
    /// together, or without a load, that of the nearest pair.
    fn face_centre_m(&self, point: usize) -> f64 {
        let (mut moment, mut whole) = (0.0, 0.0);
        let (mut least_m, mut of_nearest) = (f64::INFINITY, 0.0);
        for (_, state) in self.mesh.pairs_at(point) {
            let load = borne_n(self.mesh, state);
            moment += load * state.face_centre_m;
            whole += load;
            if state.stiffness_n_per_m > 0.0 && state.separation_m < least_m {
                (least_m, of_nearest) = (state.separation_m, state.face_centre_m);
            }
        }
        if whole > 0.0 { moment / whole } else { of_nearest }
    }

    fn unsteady_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        let per_pitch = self.mesh.points_per_pitch as f64;
        let teeth = self.pinion.pinion_teeth();
        let lead = self.mesh.damping_time_s / self.step_s;
        for k in 0..samples {
            let Some(motion) = self.motion.next() else { return };
            let pitches = motion.revolutions * teeth;
            let rotation = self.nominal_speed_hz * ((self.sample + k) as f64 * self.step_s);
            block.motor_lead_rad.push(TAU * (motion.revolutions - rotation));
            block.torque_deviation_nm.push(motion.torque_nm - self.nominal_torque_nm);
            block.speed_deviation_rad_per_s.push(TAU * (motion.speed_hz - self.nominal_speed_hz));
            let eccentric = self.eccentricity.as_ref().map_or(0.0, |eccentricity| {
                WheelName::BOTH
                    .map(|wheel| {
                        let turns = pitches / self.mesh.sequence.teeth_of(wheel) as f64;
                        eccentricity.of_wheel_m(wheel, turns)
                    })
                    .iter()
                    .sum()
            });
            let latest = (pitches + self.mesh.points_before as f64 / per_pitch).floor() as i64;
            for pair in latest + 1 - PAIRS as i64..=latest {
                let place = pair.rem_euclid(PAIRS as i64) as usize;
                let position = pitches - pair as f64;
                let point = position * per_pitch + self.mesh.points_before as f64;
                let states = &self.mesh.classes[self.mesh.sequence.class(pair)].states;
                let (index, part) = (point.floor().max(0.0) as usize, point - point.floor());
                let Some([here, next]) = states.get(index..index + 2) else {
                    self.before[place] = (i64::MIN, [0.0; 2]);
                    continue;
                };
                let between = |a: f64, b: f64| a + part * (b - a);
                let (pinion_tooth, gear_tooth) = self.mesh.sequence.teeth(pair);
                let offset = self.pinion.at_position_m(pinion_tooth, position)
                    + self.gear.at_position_m(gear_tooth, position)
                    + eccentric
                    - between(here.separation_m, next.separation_m);
                let [last, last_but_one] =
                    if self.before[place].0 == pair { self.before[place].1 } else { [offset, f64::NAN] };
                self.before[place] = (pair, [offset, last]);
                block.pairs.stiffness[place][k] = between(here.stiffness_n_per_m, next.stiffness_n_per_m);
                // The next one is not known: the slope here of the parabola through the last three, or of the line through two.
                let change = if last_but_one.is_nan() {
                    offset - last
                } else {
                    1.5 * offset - 2.0 * last + 0.5 * last_but_one
                };
                block.pairs.offset[place][k] = offset + lead * change;
            }
            if self.tilts {
                block.pairs.face_centre[k] =
                    self.face_centre_m((pitches * per_pitch).round().max(0.0) as usize);
            }
        }
    }
}

/// Samples of a block that a pair takes part in, and its point at the first of them.
struct Part {
    from: usize,
    until: usize,
    point: usize,
}

/// Wheels whose teeth do not turn about their axes.
struct Eccentricity {
    /// (m) Of each wheel, what goes with the sine of its angle and what with the cosine.
    sine_and_cosine_m: [[f64; 2]; 2],
}

impl Eccentricity {
    /// `±E sin(α + θ)` of a wheel that sits off its axis, and `F_r/2 sin(θ + φ)` of its run-out. None where all turn true.
    fn of(deviations: &PairDeviations) -> Option<Self> {
        let PairDeviations { eccentricity_m, run_out, teeth, .. } = *deviations;
        let runs_out = run_out.iter().any(|run_out| run_out.run_out_um != 0.0);
        let (axis_sine, axis_cosine) = teeth.gear.working_pressure_angle_rad.sin_cos();
        let sine_and_cosine_m = WheelName::BOTH.map(|wheel| {
            let axis_m = if wheel == WheelName::Gear { eccentricity_m } else { -eccentricity_m };
            let amplitude_mm = run_out[wheel as usize].amplitude_mm();
            let (sine, cosine) = run_out[wheel as usize].phase_rad.sin_cos();
            [
                axis_m * axis_cosine + amplitude_mm * 1e-3 * cosine,
                axis_m * axis_sine + amplitude_mm * 1e-3 * sine,
            ]
        });
        (eccentricity_m != 0.0 || runs_out).then_some(Self { sine_and_cosine_m })
    }

    /// (m) A deviation of all teeth of a wheel alike.
    ///
    /// # Arguments
    /// * `wheel` - which
    /// * `turns` - (rev) how far it has turned
    fn of_wheel_m(&self, wheel: WheelName, turns: f64) -> f64 {
        let [with_sine, with_cosine] = self.sine_and_cosine_m[wheel as usize];
        let (sine, cosine) = (TAU * turns).sin_cos();
        with_sine * sine + with_cosine * cosine
    }

    /// Adds it to a wheel's teeth at every point of their contact, where a tooth is always at the same angle: that of the tooth
    /// and that of the point are added by the sines' theorem.
    fn add_to(&self, tables_m: &mut [Vec<f64>], mesh: &ContactMesh, wheel: WheelName) {
        let [with_sine, with_cosine] = self.sine_and_cosine_m[wheel as usize];
        let pitch_rad = TAU / tables_m.len() as f64;
        let points: Vec<(f64, f64)> =
            (0..mesh.points()).map(|point| (pitch_rad * mesh.position(point)).sin_cos()).collect();
        for (tooth, table) in tables_m.iter_mut().enumerate() {
            let (sine, cosine) = (pitch_rad * tooth as f64).sin_cos();
            let with_point_cosine = with_sine * sine + with_cosine * cosine;
            let with_point_sine = with_sine * cosine - with_cosine * sine;
            for (deviation, (sine, cosine)) in table.iter_mut().zip(&points) {
                *deviation += with_point_cosine * cosine + with_point_sine * sine;
            }
        }
    }
}

/// (N) What a pair bears of the nominal load, which presses the mean mesh together: its weight where the place of the load along
/// the face is found.
fn borne_n(mesh: &ContactMesh, state: &ContactState) -> f64 {
    state.stiffness_n_per_m * (mesh.nominal_deflection_m - state.separation_m).max(0.0)
}

impl Forcing for ContactForcing<'_> {
    fn next_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        block.clear(self.directions, samples);
        match &self.steady {
            Some(tables) => {
                block.pairs.resize(samples, self.tilts);
                self.steady_block(tables, samples, &mut block.pairs);
            }
            None => {
                block.pairs.clear(samples, self.tilts);
                self.unsteady_block(samples, block);
            }
        }
        self.sample += samples;
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::forcing::{ForcingBlock, ForcingSource};
    use crate::scenario::{Fault, GearPair, Scenario, ToothBreakage};
    use crate::simulate::stages;

    // Also where all pairs are further apart than the load presses the mesh together, as without a load.
    #[test]
    fn damage_on_a_side_moves_the_load_at_any_torque() {
        for brake_torque_nm in [0.0, 10.0] {
            let mut scenario = Scenario::new(GearPair { brake_torque_nm, ..GearPair::example() });
            let chip = ToothBreakage { chip_height_mm: 6.0, chip_width_mm: 14.0, tip_loss_mm: 0.0 };
            scenario.faults = vec![Fault::on_first_gear_tooth(chip)];
            let stages = stages(&scenario).unwrap();
            let mut block = ForcingBlock::default();
            let revolution = 3 * stages.time.samples_per_pinion_revolution;
            stages.forcing(&stages.reduced_model().directions).next_block(revolution, &mut block);
            assert!(block.pairs.face_centre.iter().any(|z_m| *z_m < -1e-3), "{brake_torque_nm} N m");
        }
    }
}
