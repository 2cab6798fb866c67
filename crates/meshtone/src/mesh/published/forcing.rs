//! The right-hand side in blocks of samples, as fast as the solution.

use std::f64::consts::TAU;

use super::PublishedMesh;
use super::error_force::{ErrorForce, ToothForces};
use crate::mesh::forcing::{Forcing, ForcingBlock};
use crate::mesh::load_state::DirectionVector;
use crate::operation::{Motion, TimeGrid};
use crate::wheel::ProfileErrors;

/// Forcing of the published mesh.
pub(crate) struct PublishedForcing<'a> {
    mesh: &'a PublishedMesh,
    directions: Vec<usize>,
    motion: Motion<'a>,
    errors: ErrorForce<'a>,
    tables: Option<ErrorTables>,
    sample: usize,
    /// (rev) Revolutions of the motor, added up as the published code does.
    revolutions: f64,
    step_s: f64,
    nominal_speed_hz: f64,
    nominal_torque_nm: f64,
}

impl<'a> PublishedForcing<'a> {
    /// Forcing from the first sample on.
    ///
    /// # Arguments
    /// * `mesh` - the mesh
    /// * `errors` - profile errors of both wheels
    /// * `motion` - motor and brake from the start
    /// * `time` - division of time
    /// * `nominal` - (Hz, N m) nominal speed and torque
    /// * `directions` - which of the constant directions are asked for
    pub(crate) fn new(
        mesh: &'a PublishedMesh,
        errors: Option<&'a ProfileErrors>,
        motion: Motion<'a>,
        time: &TimeGrid,
        [nominal_speed_hz, nominal_torque_nm]: [f64; 2],
        directions: &[usize],
    ) -> Self {
        let errors = mesh.error_force(errors);
        // Only where a pitch is a whole number of points do samples find the same points in every pitch.
        let tabulated = motion.is_steady() && motion.has_constant_torque() && mesh.grid.pitch_is_whole();
        Self {
            tables: tabulated.then(|| ErrorTables::new(mesh, &errors, time.samples_per_pinion_revolution)),
            mesh,
            directions: directions.to_vec(),
            motion,
            errors,
            sample: 0,
            revolutions: 0.0,
            step_s: time.step_s(),
            nominal_speed_hz,
            nominal_torque_nm,
        }
    }

    fn general_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        for k in 0..samples {
            let Some(motion) = self.motion.next() else { return };
            let rotation = TAU * self.nominal_speed_hz * ((self.sample + k) as f64 * self.step_s);
            block.motor_lead_rad.push(TAU * motion.revolutions - rotation);
            block.torque_deviation_nm.push(motion.torque_nm - self.nominal_torque_nm);
            block.speed_deviation_rad_per_s.push(TAU * motion.speed_hz - TAU * self.nominal_speed_hz);
            let (position_rev, coarse_point) = self.mesh.position(motion.revolutions);
            let force = self.errors.at(motion.revolutions, position_rev, coarse_point);
            if force != 0.0 {
                self.spread(k, force, &self.mesh.load.error_direction(position_rev), block);
            }
        }
    }

    fn spread(&self, k: usize, force_n: f64, direction: &DirectionVector, block: &mut ForcingBlock) {
        for (errors, &index) in block.errors.iter_mut().zip(&self.directions) {
            errors[k] = force_n * direction[index];
        }
    }

    fn steady_block(&mut self, tables: &ErrorTables, samples: usize, block: &mut ForcingBlock) {
        let nominal = self.mesh.load.nominal.mean_direction(self.mesh.load.nominal.pressure_angle_rad);
        let Some((first, others)) = block.errors.split_first_mut() else { return };
        if let Some(teeth) = &tables.teeth {
            tables.add_pairs(teeth, self.sample, first);
        }
        for (errors, &index) in others.iter_mut().zip(&self.directions[1..]) {
            for (error, force) in errors.iter_mut().zip(first.iter()) {
                *error = force * nominal[index];
            }
        }
        if tables.half_way.is_empty() && !tables.depends_on_position {
            return;
        }
        for k in 0..samples {
            let revolutions = self.revolutions;
            self.revolutions += self.nominal_speed_hz * self.step_s;
            let mut force = block.errors[0][k];
            let half_way = tables.half_way.get((self.sample + k) % tables.samples_per_pitch) == Some(&true);
            if half_way {
                force = self.errors.pairs_after(revolutions);
            }
            if tables.depends_on_position && tables.disturbed.contains(self.sample + k) {
                let (position_rev, coarse_point) = self.mesh.position(revolutions);
                force += self.errors.mesh_terms(position_rev, coarse_point);
                self.spread(k, force, &self.mesh.load.error_direction(position_rev), block);
            } else if half_way {
                self.spread(k, force, &nominal, block);
            }
        }
    }
}

impl Forcing for PublishedForcing<'_> {
    fn next_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        block.clear(self.directions.len(), samples);
        match self.tables.take() {
            Some(tables) => {
                self.steady_block(&tables, samples, block);
                self.tables = Some(tables);
            }
            None => self.general_block(samples, block),
        }
        self.sample += samples;
    }
}

/// The teeth's forces at the samples, while motor speed and brake torque are constant.
struct ErrorTables {
    teeth: Option<ToothForces>,
    samples_per_pitch: usize,
    depends_on_position: bool,
    disturbed: Disturbed,
    /// Samples of a pitch whose place on the fine grid rounding decides; empty for none.
    half_way: Vec<bool>,
}

impl ErrorTables {
    fn new(mesh: &PublishedMesh, errors: &ErrorForce, samples_per_revolution: usize) -> Self {
        let mut half_way = Vec::new();
        if errors.has_pairs() {
            half_way = errors.half_way(samples_per_revolution);
            if !half_way.contains(&true) {
                half_way.clear();
            }
        }
        Self {
            teeth: errors
                .has_pairs()
                .then(|| errors.tooth_tables(&errors.fine_points(samples_per_revolution))),
            samples_per_pitch: samples_per_revolution / mesh.teeth[0] as usize,
            depends_on_position: errors.depends_on_position(),
            disturbed: Disturbed::new(mesh, samples_per_revolution),
            half_way,
        }
    }

    /// Adds the force of all pairs in contact to the samples from `first` on.
    fn add_pairs(&self, teeth: &ToothForces, first: usize, force_n: &mut [f64]) {
        let (pinion_teeth, gear_teeth) = (teeth.pinion.len(), teeth.gear.len());
        let turns = pinion_teeth * gear_teeth;
        let contact = teeth.gear.first().map_or(0, Vec::len);
        let mut start = 0;
        while start < force_n.len() {
            let (pitch, since) =
                ((first + start) / self.samples_per_pitch, (first + start) % self.samples_per_pitch);
            let length = (self.samples_per_pitch - since).min(force_n.len() - start);
            let stretch = &mut force_n[start..start + length];
            for (age, from) in (since..contact).step_by(self.samples_per_pitch).enumerate() {
                let pair = pitch + turns - age % turns;
                let (pinion_tooth, gear_tooth) = (pair % pinion_teeth, pair % gear_teeth);
                let (pinion, gear) = (&teeth.pinion[pinion_tooth][from..], &teeth.gear[gear_tooth][from..]);
                for ((force, p), g) in stretch.iter_mut().zip(pinion).zip(gear) {
                    *force += p + g;
                }
            }
            start += length;
        }
    }
}

/// The samples of a gear revolution at which the fault is in contact, the first and the last of the revolution.
struct Disturbed {
    /// Samples of a gear revolution.
    cycle: usize,
    /// Samples up to this one are disturbed.
    last_of_first: usize,
    /// Samples from this one on are disturbed: the point of the cycle nearest to them is the next revolution's first.
    first_of_last: usize,
}

impl Disturbed {
    fn new(mesh: &PublishedMesh, samples_per_revolution: usize) -> Self {
        let [pinion_teeth, gear_teeth] = mesh.teeth.map(|teeth| teeth as usize);
        let cycle = samples_per_revolution / pinion_teeth * gear_teeth;
        let samples_per_point = mesh.grid.coarse_step_rev * samples_per_revolution as f64;
        // One point more on either side, for what rounding may do.
        let points = mesh.load.disturbed_points + 2;
        let last_of_first = ((points as f64 * samples_per_point).ceil() as usize).min(cycle - 1);
        let first_of_last =
            cycle.saturating_sub((2.0 * samples_per_point).ceil() as usize).max(last_of_first + 1);
        Self { cycle, last_of_first, first_of_last }
    }

    /// Whether the fault may be in contact at a sample.
    fn contains(&self, sample: usize) -> bool {
        let since = sample % self.cycle;
        since <= self.last_of_first || since >= self.first_of_last
    }
}
