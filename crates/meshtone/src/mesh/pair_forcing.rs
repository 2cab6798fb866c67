//! The force of the flanks' deviations, pair by pair.

use crate::error_table::ErrorTable;
use std::f64::consts::TAU;

use super::forcing::{Forcing, ForcingBlock};
use super::load_state::{DIRECTIONS, DirectionVector};
use super::pair_mesh::{PairMesh, PairTable};
use crate::interpolation::NotAKnotSpline;
use crate::operation::{Motion, TimeGrid};
use crate::wheel::{ProfileErrors, RunOut, Teeth, WheelName};

/// Deviations of all flanks of one wheel from their ideal profile.
pub(super) struct FlankErrors<'a> {
    /// (mm) Over the rows of the profile errors; one a tooth, none for ideal teeth.
    by_row: Vec<NotAKnotSpline<'a>>,
    rows: usize,
    wheel: WheelName,
    teeth: &'a Teeth,
}

impl<'a> FlankErrors<'a> {
    /// Of both wheels.
    pub(super) fn of_both(deviations: &PairDeviations<'a>) -> [Self; 2] {
        WheelName::BOTH.map(|wheel| {
            let table = deviations.errors.map(|errors| match wheel {
                WheelName::Pinion => &errors.pinion_profile_errors_mm,
                WheelName::Gear => &errors.gear_profile_errors_mm,
            });
            let teeth = table.into_iter().flat_map(ErrorTable::each_tooth);
            Self {
                by_row: teeth.map(|tooth| NotAKnotSpline::uniform(0.0, 1.0, tooth)).collect(),
                rows: table.map_or(2, ErrorTable::points),
                wheel,
                teeth: deviations.teeth,
            }
        })
    }

    /// (-) Tooth count of the pinion.
    pub(super) fn pinion_teeth(&self) -> f64 {
        f64::from(self.teeth.pinion.teeth)
    }

    /// (m) Deviation of a tooth where it is touched at a position of the path.
    pub(super) fn at_position_m(&self, tooth: usize, position: f64) -> f64 {
        if self.by_row.is_empty() { 0.0 } else { self.at_row_m(tooth, self.row(position)) }
    }

    /// (m) Deviations of every tooth at some positions of the path.
    pub(super) fn tabulate_at(&self, positions: impl Iterator<Item = f64>) -> Vec<Vec<f64>> {
        let rows: Vec<f64> = positions.map(|position| self.row(position)).collect();
        self.by_row.iter().map(|errors| rows.iter().map(|&row| errors.at(row) * 1e-3).collect()).collect()
    }

    /// Row of the profile errors, counted through, that is touched at `position` of the path of contact: rows are uniform
    /// in radius, from where contact starts to where it ends.
    fn row(&self, position: f64) -> f64 {
        let wheel = self.teeth.wheel(self.wheel);
        let first = match self.wheel {
            WheelName::Pinion => self.teeth.contact.pinion_initial_radius_mm,
            WheelName::Gear => self.teeth.contact.gear_initial_radius_mm,
        };
        let radius = self.teeth.path.curvature_mm(self.wheel, position).hypot(wheel.base_radius_mm);
        let from_root = ((radius - first) / (wheel.tip_radius_mm - first)).clamp(0.0, 1.0);
        let passed = if self.wheel == WheelName::Pinion { from_root } else { 1.0 - from_root };
        passed * (self.rows - 1) as f64
    }

    /// (m) Deviation of a tooth at a row.
    fn at_row_m(&self, tooth: usize, row: f64) -> f64 {
        self.by_row.get(tooth).map_or(0.0, |errors| errors.at(row) * 1e-3)
    }
}

/// What the pairs of one simulation are forced by.
pub(crate) struct PairDeviations<'a> {
    /// Both wheels.
    pub(crate) teeth: &'a Teeth,
    /// Profile errors of both wheels; none for ideal teeth.
    pub(crate) errors: Option<&'a ProfileErrors>,
    /// (m) Eccentricity of both wheels.
    pub(crate) eccentricity_m: f64,
    /// Run-out of the pinion and of the gear; only under `contact`.
    pub(crate) run_out: [RunOut; 2],
}

/// Forcing of a mesh of tooth pairs: `Σ k_n e_n` along each pair's line of action, with the stiffness that the mesh itself has
/// there, so that a deviation that all teeth have is a rotation and no more.
pub(crate) struct PairForcing<'a> {
    mesh: &'a PairMesh,
    motion: Motion<'a>,
    directions: Vec<usize>,
    nominal: DirectionVector,
    pinion: FlankErrors<'a>,
    gear: FlankErrors<'a>,
    eccentricity_m: f64,
    sample: usize,
    step_s: f64,
    nominal_speed_hz: f64,
    nominal_torque_nm: f64,
    /// While motor and brake are steady every sample is a point of the mesh.
    steady: Option<SteadyTables>,
    whole_n: Vec<f64>,
}

struct SteadyTables {
    pinion_m: Vec<Vec<f64>>,
    gear_m: Vec<Vec<f64>>,
    samples_per_revolution: f64,
}

impl<'a> PairForcing<'a> {
    /// Forcing from sample `first_sample` on.
    ///
    /// # Arguments
    /// * `mesh` - the pairs, tabulated at every sample of a pitch while motor and brake are steady
    /// * `deviations` - how the flanks deviate
    /// * `motion` - motor and brake from the start
    /// * `time` - division of time
    /// * `nominal` - (Hz, N m) nominal speed and torque
    /// * `directions` - which of the constant directions are asked for
    /// * `first_sample` - beyond 0 only while motor and brake are steady
    pub(crate) fn new(
        mesh: &'a PairMesh,
        deviations: &PairDeviations<'a>,
        motion: Motion<'a>,
        time: &TimeGrid,
        [nominal_speed_hz, nominal_torque_nm]: [f64; 2],
        directions: &[usize],
        first_sample: usize,
    ) -> Self {
        let [pinion, gear] = FlankErrors::of_both(deviations);
        let steady = (motion.is_steady() && motion.has_constant_torque()).then(|| {
            let positions =
                || (0..mesh.contact_points()).map(|point| point as f64 / mesh.points_per_pitch as f64);
            let tabulate = |flanks: &FlankErrors| flanks.tabulate_at(positions());
            SteadyTables {
                pinion_m: tabulate(&pinion),
                gear_m: tabulate(&gear),
                samples_per_revolution: time.samples_per_pinion_revolution as f64,
            }
        });
        Self {
            nominal: mesh.nominal.mean_direction(mesh.nominal.pressure_angle_rad),
            mesh,
            motion,
            directions: directions.to_vec(),
            pinion,
            gear,
            eccentricity_m: deviations.eccentricity_m,
            sample: first_sample,
            step_s: time.step_s(),
            nominal_speed_hz,
            nominal_torque_nm,
            steady,
            whole_n: Vec::new(),
        }
    }

    fn steady_block(&mut self, tables: &SteadyTables, samples: usize, block: &mut ForcingBlock) {
        let per_pitch = self.mesh.points_per_pitch;
        self.whole_n.clear();
        self.whole_n.resize(samples, 0.0);
        let mut start = 0;
        while start < samples {
            let (pitch, since) = ((self.sample + start) / per_pitch, (self.sample + start) % per_pitch);
            let length = (per_pitch - since).min(samples - start);
            let entry = self.mesh.entry(self.sample + start) as u32;
            block.entries.extend(entry..entry + length as u32);
            for (age, from) in (since..self.mesh.contact_points()).step_by(per_pitch).enumerate() {
                self.add_pair(tables, pitch as i64 - age as i64, from, start, length, block);
            }
            start += length;
        }
        for (errors, &direction) in block.errors.iter_mut().zip(&self.directions) {
            if self.nominal[direction] != 0.0 {
                for (error, whole) in errors.iter_mut().zip(&self.whole_n) {
                    *error += self.nominal[direction] * whole;
                }
            }
        }
        if self.eccentricity_m != 0.0 {
            for k in 0..samples {
                let revolutions = (self.sample + k) as f64 / tables.samples_per_revolution;
                self.add_eccentricity(revolutions, block.entries[k] as usize, k, block);
            }
        }
    }

    /// Adds the force of one pair to `length` samples of the block from `start` on, the pair being at point `from`.
    fn add_pair(
        &mut self,
        tables: &SteadyTables,
        pair: i64,
        from: usize,
        start: usize,
        length: usize,
        block: &mut ForcingBlock,
    ) {
        let table = &self.mesh.classes[self.mesh.sequence.class(pair)];
        let (pinion_tooth, gear_tooth) = self.mesh.sequence.teeth(pair);
        let length = length.min(table.stiffness_n_per_m.len() - from);
        let range = from..from + length;
        let stiffness = &table.stiffness_n_per_m[range.clone()];
        let flanks = tables.pinion_m.get(pinion_tooth).zip(tables.gear_m.get(gear_tooth));
        let plain = table.deviation_m.is_empty() && table.load.is_empty();
        let whole = &mut self.whole_n[start..start + length];
        match flanks {
            Some((pinion, gear)) if plain => {
                let deviations = pinion[range.clone()].iter().zip(&gear[range]);
                for ((force, k), (p, g)) in whole.iter_mut().zip(stiffness).zip(deviations) {
                    *force += k * (p + g);
                }
            }
            None if plain => {}
            _ => {
                for (place, point) in range.enumerate() {
                    let flanks = flanks.map_or(0.0, |(pinion, gear)| pinion[point] + gear[point]);
                    let force = stiffness[place] * (flanks + damage_m(table, point));
                    match table.load.get(point) {
                        None => whole[place] += force,
                        Some(load) => {
                            let line = load.mean_direction(self.mesh.nominal.pressure_angle_rad);
                            for (errors, &direction) in block.errors.iter_mut().zip(&self.directions) {
                                errors[start + place] += force * line[direction];
                            }
                        }
                    }
                }
            }
        }
    }

    fn unsteady_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        let per_pitch = self.mesh.points_per_pitch;
        let pinion_teeth = self.pinion.teeth.pinion.teeth as f64;
        for k in 0..samples {
            let Some(motion) = self.motion.next() else { return };
            let pitches = motion.revolutions * pinion_teeth;
            let point = (pitches * per_pitch as f64).round().max(0.0) as usize;
            let entry = self.mesh.entry(point);
            block.entries.push(entry as u32);
            let rotation = self.nominal_speed_hz * ((self.sample + k) as f64 * self.step_s);
            block.motor_lead_rad.push(TAU * (motion.revolutions - rotation));
            block.torque_deviation_nm.push(motion.torque_nm - self.nominal_torque_nm);
            block.speed_deviation_rad_per_s.push(TAU * (motion.speed_hz - self.nominal_speed_hz));
            let (latest, since) = ((point / per_pitch) as i64, point % per_pitch);
            for (age, at) in (since..self.mesh.contact_points()).step_by(per_pitch).enumerate() {
                let pair = latest - age as i64;
                let table = &self.mesh.classes[self.mesh.sequence.class(pair)];
                let (pinion_tooth, gear_tooth) = self.mesh.sequence.teeth(pair);
                // The stiffness is that of the nearest point, as the mesh has it; the deviations are the position's own.
                let position = pitches - pair as f64;
                let flanks = self.pinion.at_row_m(pinion_tooth, self.pinion.row(position))
                    + self.gear.at_row_m(gear_tooth, self.gear.row(position));
                let force = table.stiffness_n_per_m[at] * (flanks + damage_m(table, at));
                if force != 0.0 {
                    let load = table.load.get(at).unwrap_or(&self.mesh.nominal);
                    let line = load.mean_direction(self.mesh.nominal.pressure_angle_rad);
                    for (errors, &direction) in block.errors.iter_mut().zip(&self.directions) {
                        errors[k] += force * line[direction];
                    }
                }
            }
            if self.eccentricity_m != 0.0 {
                self.add_eccentricity(motion.revolutions, entry, k, block);
            }
        }
    }

    /// `E (sin(α + θ_m/i) − sin(α + θ_m))`, a deviation of all pairs alike.
    fn add_eccentricity(&self, revolutions: f64, entry: usize, k: usize, block: &mut ForcingBlock) {
        let ratio = f64::from(self.gear.teeth.gear.teeth) / f64::from(self.gear.teeth.pinion.teeth);
        let (nominal, angle) = (self.mesh.nominal.pressure_angle_rad, TAU * revolutions);
        let deviation = self.eccentricity_m * ((nominal + angle / ratio).sin() - (nominal + angle).sin());
        let stiffness = self.mesh.direction_stiffness_at(entry);
        for (errors, &direction) in block.errors.iter_mut().zip(&self.directions) {
            errors[k] += deviation * stiffness[direction];
        }
    }
}

/// (m) How far damage sets the flanks of a class back at a point.
fn damage_m(table: &PairTable, point: usize) -> f64 {
    table.deviation_m.get(point).copied().unwrap_or(0.0)
}

impl Forcing for PairForcing<'_> {
    fn next_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        block.clear(self.directions.len(), samples);
        match self.steady.take() {
            Some(tables) => {
                self.steady_block(&tables, samples, block);
                self.steady = Some(tables);
            }
            None => self.unsteady_block(samples, block),
        }
        self.sample += samples;
    }
}

/// All of the mesh's constant directions.
pub(crate) const ALL_DIRECTIONS: [usize; DIRECTIONS] = [0, 1, 2, 3, 4];
