//! Warnings that the signals cause.

use super::largest_torque;
use super::observer::Observer;
use super::step_error::{StepError, StepJudgement, step_error, step_error_of_part, step_error_of_signals};
use crate::checks::{Figures, SignalFigures, WindowSums};
use crate::error::{ScenarioWarning, WarningKind};
use crate::sensor::SignalSource;
use crate::simulate::{Simulation, Stages};
use crate::wheel::Gears;

/// (-) Part of the time that the mesh may pull without a warning.
const TOLERATED_TENSION: f64 = 0.01;
/// (-) Where damage makes the mesh pull, a load that so many times its own would hold the teeth together is worth a word.
const SENSIBLE_LOAD_FACTOR: f64 = 30.0;
/// (-) How many times the static force the mesh force may be without a warning.
const TOLERATED_RESONANCE: f64 = 1000.0;
/// (-) How far the mean mesh force of the published model may be from the static one without a warning.
const TOLERATED_MEAN_FORCE: f64 = 0.1;
/// (-) How far a shaft's mean speed may be from what the motor drives it at without a warning.
const TOLERATED_SPEED: f64 = 0.2;
/// (-) Part of the time that teeth may be apart without a warning.
const TOLERATED_APART: f64 = 0.5;
/// (-) Part of the largest torque on a shaft by which its torques may be off balance without a warning.
const TOLERATED_IMBALANCE: f64 = 0.01;
/// (-) Part of the largest mesh force that a mesh which idles carries at most.
const IDLE_PART: f64 = 0.01;
/// (-) How far the step may falsify the rms of a signal without a warning.
const TOLERATED_STEP: f64 = 0.02;
/// (-) The same where teeth part, or the motion does not last: a few hits more are chance.
const TOLERATED_STEP_OF_PART: f64 = 0.03;

impl Simulation {
    /// Warnings that the signals cause: a mesh that pulls (not under `contact`, whose teeth part:
    /// [`Simulation::contact_figures`] says for how long), a mesh force beyond all measure, a mean force
    /// that the published model's damping changes, a shaft that does not turn at the speed
    /// that it is driven at, a step too long for a resonance.
    ///
    /// # Arguments
    /// * `judgement` - how the step is judged where a resonance is suspected
    pub fn warnings_of_signals(&self, judgement: StepJudgement) -> Vec<ScenarioWarning> {
        let in_part = self.is_judged_in_part(judgement);
        let mut warnings = match self.stages.scenario.rig() {
            None => {
                let step = if in_part { None } else { step_error_of_signals(self, judgement) };
                self.warnings_of_train(step)
            }
            Some(_) => {
                let mut observer = Observer::new(&self.stages);
                observer.observe(Observer::CHANNELS.map(|kind| self.channels.of(kind.source())));
                // Where a part is simulated again, there is no estimate to be judged.
                let estimated = if in_part { StepJudgement::Estimated } else { judgement };
                self.stages.warnings_of_signals(&observer, estimated)
            }
        };
        let rate_hz = self.channels.sampling_rate_hz;
        let step = in_part.then(|| step_error_of_part(self)).flatten();
        warnings.extend(step.and_then(|error| long_step(error, rate_hz, TOLERATED_STEP_OF_PART)));
        warnings.extend(self.silent_sensors());
        warnings
    }

    /// Whether the step is judged by a tenth of the time that is simulated again: where the motion does not last, where teeth part, and with rolling
    /// bearings.
    fn is_judged_in_part(&self, judgement: StepJudgement) -> bool {
        let stages = &self.stages;
        let parts = |mesh: usize| self.channels.of(SignalSource::MeshForce(mesh)).contains(&0.0);
        judgement == StepJudgement::Repeated
            && stages.machine().is_some()
            && !stages.scenario.operation.is_drawn_for_every_sample()
            && (!stages.is_steady()
                || !stages.bearings.is_empty()
                || stages.teeth_part() && (0..stages.meshes.len()).any(parts))
    }

    /// Sensors that show nothing at all.
    fn silent_sensors(&self) -> impl Iterator<Item = ScenarioWarning> {
        let sensors = self.stages.sensors.iter().enumerate();
        let is_silent = |number: usize| {
            let values = self.channels.of(SignalSource::Sensor(number));
            !values.is_empty() && values.iter().all(|value| *value == 0.0)
        };
        sensors.filter(move |(number, _)| is_silent(*number)).map(|(number, sensor)| {
            let message = format!(
                "sensor {} shows exactly 0 throughout: nothing that is simulated moves its place in its direction; give it another place or \
                 direction, or raise solver.highest_mode_hz",
                sensor.name()
            );
            ScenarioWarning::new(WarningKind::SilentSensor, format!("sensor[{number}]"), message)
        })
    }

    /// The same of shafts of beams: of the force of each mesh and the speed of each shaft.
    ///
    /// # Arguments
    /// * `step` - the error of the step by all signals, where it is judged by them
    fn warnings_of_train(&self, step: Option<StepError>) -> Vec<ScenarioWarning> {
        let (stages, channels) = (&self.stages, &self.channels);
        let (_, torque_nm) = largest_torque(&stages.scenario.operation);
        let static_n = stages.forces_of_torque_n(torque_nm);
        let figures = stages.figures(channels);
        let meshes = figures.forces.iter().zip(static_n).enumerate();
        let forces = meshes.filter_map(|(mesh, (force_n, static_n))| {
            resonance(
                &stages.mesh_in_words(mesh),
                stages.scenario.words().speed_key,
                force_n.largest(),
                static_n,
            )
        });
        let driven_hz = stages.mean_driven_hz();
        let shafts = stages.layout.shaft_names.iter().zip(&stages.layout.ratios).zip(&figures.speeds);
        let speeds = shafts.filter_map(|((shaft, ratio), speed_hz)| {
            other_speed(&format!("shaft {shaft:?}"), driven_hz * ratio.value().abs(), speed_hz.mean().abs())
        });
        let rate_hz = channels.sampling_rate_hz;
        let step = step.and_then(|error| long_step(error, rate_hz, TOLERATED_STEP));
        let slowest =
            stages.layout.ratios.iter().map(|ratio| ratio.value().abs()).fold(f64::INFINITY, f64::min);
        let samples_per_turn = (stages.time.samples_per_pinion_revolution as f64 / slowest).round() as usize;
        // A mesh that idles settles whenever it has struck for the last time.
        let loaded_n = stages.pairs.iter().map(|pair| pair.static_force_n).fold(0.0, f64::max);
        let is_shown = |source| match source {
            SignalSource::Sensor(_) => true,
            SignalSource::MeshForce(mesh) => stages.pairs[mesh].static_force_n > IDLE_PART * loaded_n,
            _ => false,
        };
        let shown = channels.signals.iter().filter(|signal| is_shown(signal.source));
        let windows: Vec<WindowSums> = shown
            .map(|signal| {
                let mut windows = WindowSums::new(channels.len(), samples_per_turn);
                windows.add(&signal.values);
                windows
            })
            .collect();
        let broken = stages.imbalance(&figures).into_iter().chain(stages.rattle(&figures));
        forces.chain(speeds).chain(step).chain(stages.unsettled(&windows)).chain(broken).collect()
    }
}

impl Stages {
    /// Does what [`Simulation::warnings_of_signals`] does of a pair, for signals that need not be kept.
    ///
    /// # Arguments
    /// * `observer` - it has seen all kept samples
    /// * `judgement` - how the step is judged where a resonance is suspected
    pub fn warnings_of_signals(&self, observer: &Observer, judgement: StepJudgement) -> Vec<ScenarioWarning> {
        let is_damaged = self.pairs.iter().any(|pair| !pair.damaged.is_empty());
        let force = &observer.figures.forces[0];
        let pulling = (!self.teeth_part()).then(|| tension(force, is_damaged)).flatten();
        let rate_hz = self.time.sampling_rate_hz;
        let step =
            step_error(self, observer, judgement).and_then(|error| long_step(error, rate_hz, TOLERATED_STEP));
        let (_, torque_nm) = largest_torque(&self.scenario.operation);
        let static_n = self.forces_of_torque_n(torque_nm)[0];
        let resonance = resonance("the mesh", self.scenario.words().speed_key, force.largest(), static_n);
        let braked = self.braked_rotation(force.mean());
        let unsettled = self.unsettled(&observer.windows);
        let (imbalance, rattle) = (self.imbalance(&observer.figures), self.rattle(&observer.figures));
        let doubtful =
            [pulling, resonance, braked, self.other_speed(observer), step, unsettled, imbalance, rattle];
        doubtful.into_iter().flatten().collect()
    }

    /// A shaft whose torques do not balance.
    fn imbalance(&self, figures: &Figures) -> Option<ScenarioWarning> {
        let worst = self
            .imbalances(figures)
            .into_iter()
            .max_by(|a, b| a.part.max(a.lost).total_cmp(&b.part.max(b.lost)))?;
        (worst.part.max(worst.lost) > TOLERATED_IMBALANCE).then(|| {
            let message = format!("{}; {}", worst.words, self.help_of_imbalance());
            ScenarioWarning::new(WarningKind::TorqueImbalance, "operation.brake_torque_nm", message)
        })
    }

    /// A mesh whose teeth bounce: their motion is chaotic, and another step, seed or settling gives another.
    fn rattle(&self, figures: &Figures) -> Option<ScenarioWarning> {
        let meshes = figures.forces.iter().map(SignalFigures::part_of_zeros).enumerate();
        let (mesh, part) = meshes.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (self.teeth_part() && part > TOLERATED_APART).then(|| {
            let message = format!(
                "the teeth of {} lose contact for {:.0} % of the time: they bounce, and when each strikes depends on the smallest change \
                 of rate, seed or settling; compare statistics of long signals, or load the teeth",
                self.mesh_in_words(mesh),
                100.0 * part
            );
            ScenarioWarning::new(WarningKind::Rattle, "operation.brake_torque_nm", message)
        })
    }

    /// A mean mesh force under the published model that is not the load's, because its damping acts on the rotation of the whole machine too.
    fn braked_rotation(&self, mean_n: f64) -> Option<ScenarioWarning> {
        let static_n = self.static_force_n();
        let is_off = (mean_n - static_n).abs() > TOLERATED_MEAN_FORCE * static_n.abs();
        (!self.scenario.model.has_meshes() && is_off).then(|| {
            let message = format!(
                "the mean mesh force is {mean_n:.0} N, but the load's is {static_n:.0} N: the published \
                 model's damping brakes the rotation of the whole machine as well as its vibration, and the \
                 mesh drives against that; in \"linear\" and \"contact\" it acts on vibration alone"
            );
            ScenarioWarning::new(WarningKind::BrakedRotation, "model", message)
        })
    }

    /// A shaft whose mean speed is not what it is driven at.
    fn other_speed(&self, observer: &Observer) -> Option<ScenarioWarning> {
        let [pinion_hz, gear_hz] = [0, 1].map(|shaft| observer.figures.speeds[shaft].mean());
        let driven_hz = self.mean_driven_hz();
        let Gears { pinion_teeth, gear_teeth, .. } = self.layout.gears[0];
        let ratio = f64::from(pinion_teeth) / f64::from(gear_teeth);
        let turning = [("pinion", driven_hz, pinion_hz), ("gear", driven_hz * ratio, gear_hz)];
        let mean =
            |(wheel, driven_hz, hz): (&str, f64, f64)| other_speed(&format!("the {wheel}"), driven_hz, hz);
        turning.into_iter().find_map(mean)
    }
}

/// A shaft whose mean speed is not what it is driven at.
///
/// # Arguments
/// * `what` - turns
/// * `driven_hz`, `hz` - (rev/s) the speed that it is driven at, and its own on average
fn other_speed(what: &str, driven_hz: f64, hz: f64) -> Option<ScenarioWarning> {
    ((hz / driven_hz - 1.0).abs() > TOLERATED_SPEED).then(|| {
        let message = format!(
            "{what} turns at {hz:.4} Hz on average, while the motor drives it at {driven_hz:.4} Hz: the motion has not \
             settled, or too many teeth are gone; lengthen solver.settle_fraction, raise the damping, leave out \
             solver.initial_velocity, or lessen the damage"
        );
        ScenarioWarning::new(WarningKind::OtherSpeed, "solver.settle_fraction", message)
    })
}

/// A mesh force so far beyond the static one that the machine could not be.
///
/// # Arguments
/// * `mesh` - what it is called
/// * `key` - of the speed
/// * `largest_n`, `static_n` - (N) the largest force, and that which holds the largest torque
fn resonance(mesh: &str, key: &str, largest_n: f64, static_n: f64) -> Option<ScenarioWarning> {
    (static_n > 0.0 && largest_n > TOLERATED_RESONANCE * static_n).then(|| {
        let message = format!(
            "the force of {mesh} reaches {largest_n:.3e} N, {:.0} times the static {static_n:.4} N: a resonance that no machine \
             survives, or a load too light to be meant; raise the damping, change the speed, or load the teeth",
            largest_n / static_n
        );
        ScenarioWarning::new(WarningKind::Resonance, key, message)
    })
}

/// A step that falsifies a resonance.
///
/// # Arguments
/// * `error` - its estimate
/// * `rate_hz` - (S/s) the simulation's sampling rate
/// * `tolerated` - (-) error that is not worth a word
fn long_step(error: StepError, rate_hz: f64, tolerated: f64) -> Option<ScenarioWarning> {
    let (error, shown) = match error {
        StepError::Suspected(error) => (error, format!("and the rms may be wrong by {:.1} %", 100.0 * error)),
        StepError::Shown { gain, finer_rate_hz } => {
            let (percent, larger) = (100.0 * gain.abs(), if gain > 0.0 { "larger" } else { "smaller" });
            let shown = format!("and at {finer_rate_hz:.0} S/s the rms is {percent:.1} % {larger}");
            // Of second order.
            (gain.abs() / (1.0 - (rate_hz / finer_rate_hz).powi(2)), shown)
        }
    };
    (error > tolerated).then(|| {
        let finer_hz = rate_hz * (error / tolerated).sqrt().clamp(1.2, 10.0);
        let message = format!(
            "at {rate_hz:.0} S/s the step shifts a resonance that the teeth excite, {shown}; set sampling_rate_hz = {finer_hz:.2e}, \
             and more until this goes"
        );
        ScenarioWarning::new(WarningKind::StepError, "solver.sampling_rate_hz", message)
    })
}

/// A mesh that pulls, and what brings that down.
fn tension(force: &SignalFigures, is_damaged: bool) -> Option<ScenarioWarning> {
    let fraction = force.part_of_negatives();
    (fraction > TOLERATED_TENSION).then(|| {
        let (least_n, mean_n) = (force.least(), force.mean());
        // The force that deviations and lost material add hardly depends on the load.
        let advice = if is_damaged && mean_n - least_n > SENSIBLE_LOAD_FACTOR * mean_n {
            "no sensible load would keep these teeth in contact; less damage reduces it"
        } else {
            "a heavier load or better teeth reduce it"
        };
        let message = format!(
            "the mesh force is negative for {:.1} % of the time, down to {least_n:.0} N at a mean of \
             {mean_n:.0} N: this linear mesh pulls where real teeth would separate; {advice}",
            100.0 * fraction
        );
        ScenarioWarning::new(WarningKind::MeshPulls, "operation.brake_torque_nm", message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_that_pulls_is_reported_with_what_mends_it() {
        let of = |least_n: f64, pulling: usize, is_damaged: bool| {
            let mut mesh_force_n = vec![200.0; 100];
            mesh_force_n[..pulling].fill(least_n);
            let mut force = SignalFigures::new(mesh_force_n.len());
            // In blocks, as from the time loop.
            mesh_force_n.chunks(7).for_each(|block| force.add(block));
            tension(&force, is_damaged).map(|warning| warning.message).unwrap_or_default()
        };
        assert_eq!(of(-50.0, 1, true), "");
        let message = of(-50.0, 2, true);
        assert!(message.starts_with(
            "the mesh force is negative for 2.0 % of the time, down to -50 N at a mean of 195 N"
        ));
        assert!(message.ends_with("a heavier load or better teeth reduce it"), "{message}");
        assert_eq!(of(-4000.0, 2, false).rsplit("; ").next(), message.rsplit("; ").next());
        let damage = of(-4000.0, 2, true);
        assert!(damage.ends_with("keep these teeth in contact; less damage reduces it"), "{damage}");
    }
}
