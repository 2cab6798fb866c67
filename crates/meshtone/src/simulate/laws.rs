//! Whether a result obeys the laws that every machine does: see [`crate::checks`].

use std::f64::consts::TAU;

use super::{Simulation, Stages};
use crate::checks::{TorqueBalance, mean_in_middle, overlap_modules, speed_factor};
use crate::error::Error;
use crate::scenario::Shafts;
use crate::sensor::{Channels, SignalSource};
use crate::solver::Output;

/// (-) Part of the largest torque on a shaft by which its torques may not balance in a result.
const REFUSED_IMBALANCE: f64 = 0.1;

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
    /// Refuses signals that no machine can have, or that break a law.
    ///
    /// # Arguments
    /// * `channels` - the kept signals
    ///
    /// # Errors
    /// Flanks that overlap by more than a module, a shaft that is off its speed by more than a factor of 3, torques that are off balance by
    /// more than a tenth.
    pub(super) fn check_laws(&self, channels: &Channels) -> Result<(), Error> {
        if self.machine().is_none() || channels.is_empty() {
            return Ok(());
        }
        if let Some(problem) = self.overlap(channels).or_else(|| self.lost_speed(channels)) {
            let rate_hz = self.time.sampling_rate_hz;
            let help = format!(
                "raise solver.sampling_rate_hz from {rate_hz:.0} to {:.0} S/s; where that changes nothing, lower operation.brake_torque_nm, \
                 raise the damping ratios, or use stiffer parts",
                4.0 * rate_hz
            );
            return Err(Error::Impossible { problem, help });
        }
        let worst = self.imbalances(channels).into_iter().max_by(|a, b| a.lost.total_cmp(&b.lost));
        match worst.filter(|worst| worst.lost.is_nan() || worst.lost > REFUSED_IMBALANCE) {
            Some(worst) => Err(Error::Impossible { problem: worst.words, help: self.help_of_imbalance() }),
            None => Ok(()),
        }
    }

    /// Teeth that have passed through each other.
    fn overlap(&self, channels: &Channels) -> Option<String> {
        let meshes =
            self.mean_stiffness_n_per_m().into_iter().zip(&self.layout.gears).zip(&self.layout.mesh_names);
        let of_mesh = |(mesh, ((stiffness_n_per_m, gears), name)): (
            usize,
            ((f64, &crate::wheel::Gears), &Option<String>),
        )| {
            let force_n = channels.of(SignalSource::MeshForce(mesh));
            // A sum, which keeps what is no number.
            let largest_n = force_n
                .iter()
                .fold(0.0, |most: f64, force| if force.abs() <= most { most } else { force.abs() });
            let modules = overlap_modules(largest_n, stiffness_n_per_m, gears.module_mm)?;
            let of = name.as_ref().map_or_else(String::new, |name| format!(" {name}"));
            Some(format!(
                "the force of the mesh{of} reaches {largest_n:.3e} N, with which its flanks would overlap by {modules:.3} modules: no machine \
                 moves like that"
            ))
        };
        meshes.enumerate().find_map(of_mesh)
    }

    /// A shaft that does not turn as it is driven.
    fn lost_speed(&self, channels: &Channels) -> Option<String> {
        let driven_hz = self.mean_driven_hz(channels.len());
        let shafts = self.shaft_names().into_iter().zip(&self.layout.ratios).enumerate();
        let of_shaft = |(shaft, (name, ratio)): (usize, (String, &crate::scenario::Ratio))| {
            let speed_hz = channels.of(SignalSource::ShaftSpeed(shaft));
            let mean_hz = speed_hz.iter().sum::<f64>() / speed_hz.len() as f64;
            let driven_hz = driven_hz * ratio.value().abs();
            speed_factor(mean_hz.abs(), driven_hz).map(|_| {
                format!("{name} turns at {mean_hz:.4e} Hz on average, while the motor drives it at {driven_hz:.4} Hz: no machine moves like that")
            })
        };
        shafts.filter(|_| driven_hz > 0.0).find_map(of_shaft)
    }

    /// (Hz) Mean speed of the motor over the kept samples.
    pub(crate) fn mean_driven_hz(&self, samples: usize) -> f64 {
        if self.scenario.operation.speed_profile_hz.is_none() {
            return self.scenario.operation.pinion_speed_hz;
        }
        let kept = self.motion().skip(self.time.first_kept_sample).take(samples);
        kept.map(|motion| motion.speed_hz).sum::<f64>() / samples as f64
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
    /// * `channels` - the kept signals
    pub(crate) fn imbalances(&self, channels: &Channels) -> Vec<Imbalance> {
        let Some((assembled, _)) = self.machine() else { return Vec::new() };
        let forces = || (0..self.meshes.len()).map(|mesh| channels.of(SignalSource::MeshForce(mesh)));
        let mean_n: Vec<f64> = forces().map(|force_n| mean_in_middle(force_n.iter().copied())).collect();
        let rms_n: Vec<f64> = forces()
            .map(|force_n| {
                (force_n.iter().map(|force| force * force).sum::<f64>() / force_n.len() as f64).sqrt()
            })
            .collect();
        let operation = &self.scenario.operation;
        let (torque_nm, acceleration) = if self.is_steady() {
            (operation.brake_torque_nm, 0.0)
        } else {
            let kept: Vec<_> =
                self.motion().skip(self.time.first_kept_sample).take(channels.len() + 1).collect();
            let faster = kept
                .windows(2)
                .map(|pair| TAU * (pair[1].speed_hz - pair[0].speed_hz) * self.time.sampling_rate_hz);
            (
                mean_in_middle(kept[..channels.len()].iter().map(|motion| motion.torque_nm)),
                mean_in_middle(faster.collect::<Vec<_>>().into_iter()),
            )
        };
        let balances = TorqueBalance::of(&assembled.machine);
        // A shaft that idles is no better known than the loaded ones.
        let loaded_nm = balances
            .iter()
            .map(|balance| balance.largest_nm(&rms_n, torque_nm))
            .fold(LEAST_TORQUE_NM, f64::max);
        let of_shaft = |balance: TorqueBalance| {
            let largest_nm = balance.largest_nm(&rms_n, torque_nm).max(IDLE_PART * loaded_nm);
            let missing =
                |acceleration: f64| balance.missing_nm(&mean_n, torque_nm, acceleration).abs() / largest_nm;
            let own = self.acceleration_rad_per_s2(&balance, channels).unwrap_or(acceleration);
            let (part, lost) = (missing(acceleration), missing(own).min(missing(acceleration)));
            let meshes: Vec<String> = (balance.meshes.iter())
                .map(|&(mesh, _)| {
                    let name = self.layout.mesh_names[mesh]
                        .as_ref()
                        .map_or_else(String::new, |name| format!(" {name}"));
                    format!(
                        "{:.4} N in the mesh{name}, where the load asks for {:.4} N",
                        mean_n[mesh], self.pairs[mesh].static_force_n
                    )
                })
                .collect();
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
    fn acceleration_rad_per_s2(&self, balance: &TorqueBalance, channels: &Channels) -> Option<f64> {
        let (_, modal) = self.machine()?;
        let signals = channels.signals.iter().zip(self.scenario.outputs());
        let (speed_hz, rotation) = signals.into_iter().find_map(|(signal, output)| {
            let Output::Velocity { place, axis, .. } = output else { return None };
            let rotation = balance.rotation_at(&modal.weights(&place, axis))?;
            matches!(signal.source, SignalSource::ShaftSpeed(_)).then_some((&signal.values, rotation))
        })?;
        let faster =
            (1..speed_hz.len()).map(|n| TAU * (speed_hz[n] - speed_hz[n - 1]) * channels.sampling_rate_hz);
        (speed_hz.len() > 1).then(|| mean_in_middle(faster) / rotation)
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
        self.stages.check_laws(&self.channels)?;
        Ok(self)
    }
}
