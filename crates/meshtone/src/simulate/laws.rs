//! Whether a result obeys the laws that every machine does: see [`crate::checks`].

use std::f64::consts::TAU;

use super::{Simulation, Stages};
use crate::checks::{Figures, SignalFigures, TorqueBalance, crossings, overlap_modules, speed_factor};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::operation::MotionSample;
use crate::scenario::{Ratio, Shafts};
use crate::sensor::{Channels, SignalSource};
use crate::solver::Output;
use crate::wheel::Gears;

/// (-) Part of the largest torque on a shaft by which its torques may not balance in a result.
const REFUSED_IMBALANCE: f64 = 0.1;
/// Periods of the mode that decays the slowest over which torques balance.
const FEWEST_PERIODS: f64 = 4.0;

/// (-) Part of the largest torque on any shaft that counts as one on a shaft that idles.
const IDLE_PART: f64 = 0.01;
/// (N m) The same where no shaft is loaded.
const LEAST_TORQUE_NM: f64 = 1e-3;

/// A shaft whose torques do not balance.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Imbalance {
    /// (-) What is missing, as a part of the largest torque on the shaft.
    pub(crate) part: f64,
    /// (-) The same with the acceleration that the shaft has: what a motion misses that has not settled, it does not.
    pub(crate) lost: f64,
    /// The torques in words.
    pub(crate) words: String,
}

impl Stages {
    /// What the laws look at in the kept signals.
    ///
    /// # Arguments
    /// * `channels` - all kept signals
    pub(crate) fn figures(&self, channels: &Channels) -> Figures {
        let of = |source| SignalFigures::of(channels.of(source));
        Figures {
            forces: (0..self.meshes.len()).map(|mesh| of(SignalSource::MeshForce(mesh))).collect(),
            speeds: (0..self.layout.own_shafts()).map(|shaft| of(SignalSource::ShaftSpeed(shaft))).collect(),
        }
    }

    /// Refuses signals that no machine can have, or that break a law.
    ///
    /// # Arguments
    /// * `figures` - of the kept signals
    ///
    /// # Errors
    /// Flanks that overlap by more than a module, or of planetary sets fly through their backlash from sample to sample, a shaft that is off its speed by
    /// more than a factor of 3, torques that are off balance by more than a tenth.
    pub(crate) fn check_laws(&self, figures: &Figures) -> Result<(), Error> {
        if self.machine().is_none() || self.time.kept_samples() == 0 {
            return Ok(());
        }
        let rate_hz = self.time.sampling_rate_hz;
        if let Some(problem) = self.crossed(figures) {
            let help = format!(
                "raise solver.sampling_rate_hz from {rate_hz:.0} to {:.0} S/s; where that changes nothing, raise the damping ratios or \
                 operation.brake_torque_nm",
                4.0 * rate_hz
            );
            return Err(Error::Impossible { problem, help });
        }
        if let Some(problem) = self.overlap(figures).or_else(|| self.lost_speed(figures)) {
            let help = self.help_of_load().unwrap_or_else(|| {
                format!(
                    "raise solver.sampling_rate_hz from {rate_hz:.0} to {:.0} S/s; where that changes nothing, lower \
                     operation.brake_torque_nm, raise the damping ratios, or use stiffer parts",
                    4.0 * rate_hz
                )
            });
            return Err(Error::Impossible { problem, help });
        }
        let worst = self.imbalances(figures).into_iter().max_by(|a, b| a.lost.total_cmp(&b.lost));
        match worst.filter(|worst| worst.lost.is_nan() || worst.lost > REFUSED_IMBALANCE) {
            Some(worst) => Err(Error::Impossible { problem: worst.words, help: self.help_of_imbalance() }),
            None => Ok(()),
        }
    }

    /// Teeth that have passed through each other.
    fn overlap(&self, figures: &Figures) -> Option<String> {
        let meshes = self.mean_stiffness_n_per_m().into_iter().zip(&self.layout.gears).zip(&figures.forces);
        let of_mesh = |(mesh, ((stiffness_n_per_m, gears), force)): (
            usize,
            ((f64, &Gears), &SignalFigures),
        )| {
            let largest_n = force.largest();
            let modules = overlap_modules(largest_n, stiffness_n_per_m, gears.module_mm)?;
            Some(format!(
                "the force of {} reaches {largest_n:.3e} N, with which its flanks would overlap by {modules:.3} modules: no machine \
                 moves like that",
                self.mesh_in_words(mesh)
            ))
        };
        meshes.enumerate().find_map(of_mesh)
    }

    /// Teeth of planetary sets that strike with one flank at a sample and with the other at the next: the steps are too long for their impacts, which
    /// then grow.
    fn crossed(&self, figures: &Figures) -> Option<String> {
        let of_mesh = |(mesh, force): (usize, &SignalFigures)| {
            let Mesh { backlash_m, mean_stiffness_n_per_m, .. } = self.meshes.get(mesh)?;
            let deflection_m = force.mean().abs() / mean_stiffness_n_per_m;
            let part = crossings(force.part_of_flips(), (*backlash_m)?, deflection_m)?;
            Some(format!(
                "the flanks of {} fly through their backlash from one sample to the next at {:.0} % of the samples, with up to {:.3e} N: the \
                 step is too long for their impacts",
                self.mesh_in_words(mesh),
                100.0 * part,
                force.largest()
            ))
        };
        // Of other meshes the repeated step warns, which sets have not.
        let is_of_set = |(mesh, _): &(usize, _)| self.scenario.meshes[*mesh].is_of_set;
        figures.forces.iter().enumerate().filter(is_of_set).find_map(of_mesh)
    }

    /// A shaft that does not turn as it is driven.
    fn lost_speed(&self, figures: &Figures) -> Option<String> {
        let driven_hz = self.mean_driven_hz();
        let shafts = self.shaft_names().into_iter().zip(&self.layout.ratios).zip(&figures.speeds);
        let of_shaft = |((name, ratio), speed_hz): ((String, &Ratio), &SignalFigures)| {
            let mean_hz = speed_hz.mean();
            let driven_hz = driven_hz * ratio.value().abs();
            speed_factor(mean_hz.abs(), driven_hz).map(|_| {
                format!("{name} turns at {mean_hz:.4e} Hz on average, while the motor drives it at {driven_hz:.4} Hz: no machine moves like that")
            })
        };
        shafts.filter(|_| driven_hz > 0.0).find_map(of_shaft)
    }

    /// (Hz) Mean speed of the motor over the kept samples.
    pub(crate) fn mean_driven_hz(&self) -> f64 {
        if self.scenario.operation.keeps_speed() {
            return self.scenario.operation.pinion_speed_hz;
        }
        let speed_hz: Vec<f64> = self.kept_motion().iter().map(|motion| motion.speed_hz).collect();
        SignalFigures::of(&speed_hz).mean()
    }

    /// Motor and brake at the kept samples.
    pub(super) fn kept_motion(&self) -> Vec<MotionSample> {
        self.motion().skip(self.time.first_kept_sample).take(self.time.kept_samples()).collect()
    }

    /// What a mesh is called.
    ///
    /// # Arguments
    /// * `mesh` - its number
    pub(crate) fn mesh_in_words(&self, mesh: usize) -> String {
        self.layout.mesh_names[mesh]
            .as_ref()
            .map_or_else(|| "the mesh".to_owned(), |name| format!("mesh {name}"))
    }

    /// What each shaft is called.
    fn shaft_names(&self) -> Vec<String> {
        let name = |name: &String| match self.scenario.rig() {
            Some(_) => format!("the {name}"),
            None => format!("shaft {name:?}"),
        };
        self.layout.shaft_names.iter().map(name).collect()
    }

    /// How far the torques of every shaft that no motor holds are off balance: over the kept signals the mean force of its meshes is that which
    /// the mean torque of the brake and its own acceleration ask for.
    ///
    /// # Arguments
    /// * `figures` - of the kept signals
    pub(crate) fn imbalances(&self, figures: &Figures) -> Vec<Imbalance> {
        let Some((assembled, _)) = self.machine() else { return Vec::new() };
        // Over less than a few periods of what rings longest a mean says nothing.
        let kept_s = self.time.kept_samples() as f64 * self.time.step_s();
        if kept_s * self.slowest_mode.frequency_hz < FEWEST_PERIODS {
            return Vec::new();
        }
        let mean_n: Vec<f64> = figures.forces.iter().map(SignalFigures::mean_in_middle).collect();
        let rms_n: Vec<f64> = figures.forces.iter().map(SignalFigures::rms).collect();
        let operation = &self.scenario.operation;
        let (torque_nm, acceleration) = if operation.is_constant() {
            (operation.brake_torque_nm, 0.0)
        } else {
            let kept = self.kept_motion().into_iter().map(|motion| (motion.torque_nm, motion.speed_hz));
            let (torque_nm, speed_hz): (Vec<f64>, Vec<f64>) = kept.unzip();
            let [torque_nm, speed_hz] = [torque_nm, speed_hz].map(|values| SignalFigures::of(&values));
            (torque_nm.mean_in_middle(), TAU * self.time.sampling_rate_hz * speed_hz.rise())
        };
        let friction: Vec<f64> = self.scenario.meshes.iter().map(|mesh| mesh.friction).collect();
        let balances = TorqueBalance::of(&assembled.machine);
        // A shaft that idles is no better known than the loaded ones.
        let loaded_nm = balances
            .iter()
            .map(|balance| balance.largest_nm(&rms_n, torque_nm))
            .fold(LEAST_TORQUE_NM, f64::max);
        let of_shaft = |balance: TorqueBalance| {
            let largest_nm = balance.largest_nm(&rms_n, torque_nm).max(IDLE_PART * loaded_nm);
            // What friction may take is no imbalance.
            let rubbed_nm = balance.friction_nm(&rms_n, &friction);
            let missing = |acceleration: f64| {
                let missing_nm = balance.missing_nm(&mean_n, torque_nm, acceleration).abs();
                // What is no number stays.
                if missing_nm <= rubbed_nm { 0.0 } else { (missing_nm - rubbed_nm) / largest_nm }
            };
            let own = self.acceleration_rad_per_s2(&balance, figures).unwrap_or(acceleration);
            let (part, lost) = (missing(acceleration), missing(own).min(missing(acceleration)));
            let of_mesh = |&(mesh, _): &(usize, f64)| {
                let (name, static_n) = (self.mesh_in_words(mesh), self.pairs[mesh].static_force_n);
                format!("{:.4} N in {name}, where the load asks for {static_n:.4} N", mean_n[mesh])
            };
            let meshes: Vec<String> = balance.meshes.iter().map(of_mesh).collect();
            let why = if lost < 0.5 * part { ", as the shaft still changes its speed" } else { "" };
            let words = format!(
                "the mean torques on a shaft are off balance by {:.1} % of the largest{why}: {}",
                100.0 * part.max(lost),
                meshes.join("; ")
            );
            Imbalance { part, lost, words }
        };
        balances.into_iter().map(of_shaft).collect()
    }

    /// (rad/s²) Mean acceleration of a shaft by its own speed, per unit of the motor's rotation; none of a shaft without a signal.
    fn acceleration_rad_per_s2(&self, balance: &TorqueBalance, figures: &Figures) -> Option<f64> {
        let (_, modal) = self.machine()?;
        self.scenario.signals_and_outputs().into_iter().find_map(|(signal, output)| {
            let (SignalSource::ShaftSpeed(shaft), Output::Velocity { place, axis, .. }) =
                (signal.source, output)
            else {
                return None;
            };
            let rotation = balance.rotation_at(&modal.weights(&place, axis))?;
            Some(TAU * self.time.sampling_rate_hz * figures.speeds.get(shaft)?.rise() / rotation)
        })
    }

    /// What can be done where the load alone breaks the teeth; nothing where it does not.
    pub(super) fn help_of_load(&self) -> Option<String> {
        let overload = self.overloads().next()?;
        Some(format!("lower {}: {}", overload.key, overload.message))
    }

    /// What can be done where torques do not balance: the stiffest spring takes the most digits.
    pub(crate) fn help_of_imbalance(&self) -> String {
        let stiffest = self.scenario.structure.shafts().map(stiffest_spring);
        match stiffest {
            Some((key, value)) => {
                format!(
                    "lower {key} = {value:e}, the stiffest spring, whose digits are missing elsewhere, or lengthen the signal"
                )
            }
            None => "lengthen the signal or the settling, or make shafts and bearings less stiff".to_owned(),
        }
    }
}

/// The key of the stiffest spring of shafts of beams, and its stiffness.
fn stiffest_spring(of: &Shafts) -> (String, f64) {
    let couplings = of.shafts.iter().enumerate().map(|(number, shaft)| {
        (format!("shaft[{number}].coupling_stiffness_nm_per_rad"), shaft.coupling_nm_per_rad())
    });
    let bearings = of.bearings.iter().enumerate().flat_map(|(number, bearing)| {
        let springs = [
            ("stiffness_n_per_m", bearing.stiffness_n_per_m),
            ("axial_stiffness_n_per_m", bearing.axial_n_per_m()),
            ("tilt_stiffness_nm_per_rad", bearing.tilt_stiffness_nm_per_rad),
            ("seat.stiffness_n_per_m", bearing.seat.stiffness_n_per_m),
            ("seat.tilt_stiffness_nm_per_rad", bearing.seat.tilt_stiffness_nm_per_rad),
        ];
        springs.map(|(key, value)| (format!("bearing[{number}].{key}"), value))
    });
    let none = (String::from("bearing.stiffness_n_per_m"), 0.0);
    couplings
        .chain(bearings)
        .fold(none, |stiffest, spring| if spring.1 > stiffest.1 { spring } else { stiffest })
}

impl Simulation {
    /// Refuses a simulation that breaks a law: see [`Stages::check_laws`].
    pub(super) fn lawful(self) -> Result<Self, Error> {
        self.stages.check_laws(&self.stages.figures(&self.channels))?;
        Ok(self)
    }
}
