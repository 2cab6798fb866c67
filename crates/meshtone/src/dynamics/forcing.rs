//! The right-hand side in blocks of samples, as fast as the solution.

use nalgebra::SVector;

use super::excitation::{ErrorForce, ToothForces};
use super::mesh_directions::DIRECTIONS;
use super::motion::Motion;
use crate::scenario::Convention;
use crate::simulate::Stages;

/// Forcing of successive samples.
#[derive(Debug, Clone, Default)]
pub(crate) struct ForcingBlock {
    /// (N) Force of the profile errors in each of the mesh's directions that the solution uses.
    pub(crate) errors: Vec<Vec<f64>>,
    /// (rad) Angle of the motor less that of the rigid rotation at the nominal speed.
    pub(crate) motor_lead_rad: Vec<f64>,
    /// (N m) Torque of the brake less its nominal value.
    pub(crate) torque_deviation_nm: Vec<f64>,
    /// (rad/s) Speed of the motor less the nominal one.
    pub(crate) speed_deviation_rad_per_s: Vec<f64>,
}

/// Produces the forcing of one simulation, block by block.
pub(crate) struct Forcing<'a> {
    stages: &'a Stages,
    directions: Vec<usize>,
    motion: Motion<'a>,
    errors: ErrorForce<'a>,
    tables: Option<ErrorTables>,
    sample: usize,
    /// (rev) Revolutions of the motor, added up as the published code does.
    revolutions: f64,
}

impl<'a> Forcing<'a> {
    /// Forcing from the first simulated sample on.
    ///
    /// # Arguments
    /// * `stages` - the simulation
    /// * `directions` - which of the five constant mesh directions the solution uses
    pub(crate) fn new(stages: &'a Stages, directions: &[usize]) -> Self {
        let motion = Motion::new(&stages.scenario, &stages.time);
        let errors = stages.error_force();
        let steady = motion.is_steady();
        Self {
            tables: steady.then(|| ErrorTables::new(stages, &errors)),
            stages,
            directions: directions.to_vec(),
            motion,
            errors,
            // Beyond 0 only where the motion is steady, and so a function of the sample.
            sample: stages.time.first_simulated_sample,
            revolutions: 0.0,
        }
    }

    /// The next `samples` samples.
    pub(crate) fn next_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        block.errors.resize_with(self.directions.len(), Vec::new);
        for errors in &mut block.errors {
            errors.clear();
            errors.resize(samples, 0.0);
        }
        block.motor_lead_rad.clear();
        block.torque_deviation_nm.clear();
        block.speed_deviation_rad_per_s.clear();
        match self.tables.take() {
            Some(tables) if self.motion.has_constant_torque() => {
                self.steady_block(&tables, samples, block);
                self.tables = Some(tables);
            }
            tables => {
                self.tables = tables;
                self.general_block(samples, block);
            }
        }
        self.sample += samples;
    }

    fn general_block(&mut self, samples: usize, block: &mut ForcingBlock) {
        let stages = self.stages;
        let operation = &stages.scenario.operation;
        let nominal_speed = std::f64::consts::TAU * operation.pinion_speed_hz;
        for k in 0..samples {
            let Some(motion) = self.motion.next() else { return };
            let excitation = stages.excite(&motion, &self.errors);
            let rotation = nominal_speed * ((self.sample + k) as f64 * stages.time.step_s());
            block.motor_lead_rad.push(excitation.motor_angle_rad - rotation);
            block.torque_deviation_nm.push(excitation.brake_torque_nm - operation.brake_torque_nm);
            block.speed_deviation_rad_per_s.push(excitation.motor_speed_rad_per_s - nominal_speed);
            if excitation.error_force_n != 0.0 {
                let direction = stages.system.mesh.error_direction(
                    excitation.position_rev,
                    excitation.coarse_point,
                    stages.scenario.convention,
                );
                self.spread(k, excitation.error_force_n, direction.as_slice(), block);
            }
        }
    }

    fn spread(&self, k: usize, force_n: f64, direction: &[f64], block: &mut ForcingBlock) {
        for (errors, &index) in block.errors.iter_mut().zip(&self.directions) {
            errors[k] = force_n * direction[index];
        }
    }

    fn steady_block(&mut self, tables: &ErrorTables, samples: usize, block: &mut ForcingBlock) {
        let Some((first, others)) = block.errors.split_first_mut() else { return };
        if let Some(teeth) = &tables.teeth {
            tables.add_pairs(teeth, self.sample, first);
        }
        let stages = self.stages;
        let nominal =
            stages.system.mesh.nominal.mean_direction(stages.system.mesh.nominal.pressure_angle_rad);
        for (errors, &index) in others.iter_mut().zip(&self.directions[1..]) {
            for (error, force) in errors.iter_mut().zip(first.iter()) {
                *error = force * nominal[index];
            }
        }
        if !tables.needs_position {
            return;
        }
        if tables.published || tables.eccentric {
            self.correct_each(tables, samples, block, &nominal);
        } else {
            self.correct_disturbed(tables, samples, block);
        }
    }

    /// Replaces the force of the samples at which the fault is in contact, by the table.
    fn correct_disturbed(&self, tables: &ErrorTables, samples: usize, block: &mut ForcingBlock) {
        let cycle = tables.disturbed.cycle;
        let mut k = 0;
        while k < samples {
            let since = (self.sample + k) % cycle;
            match tables.disturbed.at(since) {
                Some(disturbed) => {
                    let force = block.errors[0][k] + disturbed.force_n;
                    self.spread(k, force, disturbed.direction.as_slice(), block);
                    k += 1;
                }
                None => k += tables.disturbed.next_after(since) - since,
            }
        }
    }

    /// Looks at each sample's own position.
    fn correct_each(
        &mut self,
        tables: &ErrorTables,
        samples: usize,
        block: &mut ForcingBlock,
        nominal: &SVector<f64, DIRECTIONS>,
    ) {
        let stages = self.stages;
        for k in 0..samples {
            let revolutions = self.steady_revolutions(self.sample + k, tables);
            let mut force = block.errors[0][k];
            let half_way = tables.half_way.get((self.sample + k) % tables.samples_per_pitch) == Some(&true);
            if half_way {
                force = self.errors.pairs_after(revolutions);
            }
            let may_disturb = tables.disturbed.contains((self.sample + k) % tables.disturbed.cycle);
            if tables.eccentric || (may_disturb && tables.depends_on_position) {
                let (position_rev, coarse_point) = stages.position(revolutions);
                force += self.errors.mesh_terms(revolutions, position_rev, coarse_point);
                let direction = stages.system.mesh.error_direction(
                    position_rev,
                    coarse_point,
                    stages.scenario.convention,
                );
                self.spread(k, force, direction.as_slice(), block);
            } else if half_way {
                self.spread(k, force, nominal.as_slice(), block);
            }
        }
    }

    fn steady_revolutions(&mut self, sample: usize, tables: &ErrorTables) -> f64 {
        if !tables.published {
            return sample as f64 / tables.samples_per_revolution;
        }
        let here = self.revolutions;
        self.revolutions += self.stages.scenario.operation.pinion_speed_hz * self.stages.time.step_s();
        here
    }
}

/// The teeth's forces at the samples, while motor speed and brake torque are constant.
struct ErrorTables {
    teeth: Option<ToothForces>,
    samples_per_pitch: usize,
    needs_position: bool,
    depends_on_position: bool,
    disturbed: Disturbed,
    /// Samples of a pitch whose place on the fine grid rounding decides; empty for none.
    half_way: Vec<bool>,
    eccentric: bool,
    published: bool,
    samples_per_revolution: f64,
}

impl ErrorTables {
    fn new(stages: &Stages, errors: &ErrorForce) -> Self {
        let samples_per_revolution = stages.time.samples_per_pinion_revolution;
        let published = stages.scenario.convention == Convention::Published;
        let eccentric = stages.scenario.rig.eccentricity_mm != 0.0;
        let depends_on_position = errors.depends_on_position();
        let mut half_way = Vec::new();
        if published && errors.has_pairs() {
            half_way = errors.half_way(samples_per_revolution);
            if !half_way.contains(&true) {
                half_way.clear();
            }
        }
        Self {
            teeth: errors
                .has_pairs()
                .then(|| errors.tooth_tables(&errors.fine_points(samples_per_revolution))),
            samples_per_pitch: samples_per_revolution / stages.scenario.gears.pinion_teeth as usize,
            needs_position: !half_way.is_empty() || eccentric || depends_on_position,
            depends_on_position,
            disturbed: Disturbed::new(stages, errors, depends_on_position && !published && !eccentric),
            half_way,
            eccentric,
            published,
            samples_per_revolution: samples_per_revolution as f64,
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
                let pinion = match teeth.pinion_at_fault.get(pinion_tooth) {
                    Some(at_fault) if gear_tooth == 0 => at_fault,
                    _ => &teeth.pinion[pinion_tooth],
                };
                let (pinion, gear) = (&pinion[from..], &teeth.gear[gear_tooth][from..]);
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
    /// What the fault does there, in that order; empty where it is not tabulated.
    table: Vec<DisturbedSample>,
}

/// What the fault does to the force at one sample.
struct DisturbedSample {
    /// (N) Force of the mesh as a whole.
    force_n: f64,
    /// Line of action.
    direction: SVector<f64, DIRECTIONS>,
}

impl Disturbed {
    fn new(stages: &Stages, errors: &ErrorForce, tabulated: bool) -> Self {
        let (time, grid, gears) = (&stages.time, &stages.cycle, &stages.scenario.gears);
        let per_revolution = time.samples_per_pinion_revolution;
        let cycle = per_revolution / gears.pinion_teeth as usize * gears.gear_teeth as usize;
        let samples_per_point = grid.coarse_step_rev * per_revolution as f64;
        // One point more on either side, for what rounding may do.
        let points = stages.system.mesh.disturbed_points + 2;
        let last_of_first = ((points as f64 * samples_per_point).ceil() as usize).min(cycle - 1);
        let first_of_last =
            cycle.saturating_sub((2.0 * samples_per_point).ceil() as usize).max(last_of_first + 1);
        let mut disturbed = Self { cycle, last_of_first, first_of_last, table: Vec::new() };
        if tabulated {
            let convention = stages.scenario.convention;
            disturbed.table = (0..=last_of_first)
                .chain(first_of_last..cycle)
                .map(|sample| {
                    let revolutions = sample as f64 / per_revolution as f64;
                    let (position_rev, coarse_point) = stages.position(revolutions);
                    DisturbedSample {
                        force_n: errors.mesh_terms(revolutions, position_rev, coarse_point),
                        direction: stages.system.mesh.error_direction(position_rev, coarse_point, convention),
                    }
                })
                .collect();
        }
        disturbed
    }

    /// Whether `since` samples after the start of a gear revolution the fault may be in contact.
    fn contains(&self, since: usize) -> bool {
        since <= self.last_of_first || since >= self.first_of_last
    }

    fn at(&self, since: usize) -> Option<&DisturbedSample> {
        if since <= self.last_of_first {
            self.table.get(since)
        } else {
            let row = since.checked_sub(self.first_of_last)?;
            self.table.get(self.last_of_first + 1 + row)
        }
    }

    /// The first sample after an undisturbed one that is not, or the end of the revolution.
    fn next_after(&self, since: usize) -> usize {
        self.first_of_last.min(self.cycle).max(since + 1)
    }
}
