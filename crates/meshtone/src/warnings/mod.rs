//! Warnings about a simulation: before the time loop, and by its signals.

mod mesh_resonance;
mod observer;
mod of_signals;
mod step_error;
mod uneven_face;

pub use observer::Observer;
pub use step_error::StepJudgement;

use std::f64::consts::TAU;

use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::machine::{DecayingMode, Shaft, WheelBody};
use crate::operation::{Operation, Solver, TimeGrid};
use crate::scenario::{MemoryLimit, Scenario, SensorPlace};
use crate::simulate::{Stages, stages_within};
use crate::wheel::{Gears, unused_slices};

/// (-) Part of the starting transient that may be left where the kept signal starts.
const TOLERATED_TRANSIENT: f64 = 0.01;
/// (-) Part of the module by which the nominal load may press the teeth together without a warning.
const TOLERATED_DEFLECTION: f64 = 0.1;

/// Runs every stage before the time loop, as [`stages_within`] does, and reports all that deserves attention before the time loop.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `limit` - most memory that the simulation may need
///
/// # Errors
/// Those of [`stages_within`].
///
/// ```
/// use meshtone::scenario::{GearPair, MemoryLimit, Scenario};
///
/// let scenario = Scenario::new(GearPair { pinion_teeth: 14, ..GearPair::example() });
/// let (stages, warnings) = meshtone::stages_and_warnings(&scenario, MemoryLimit::default())?;
/// assert_eq!(warnings[0].key, "gears.pinion_teeth");
/// // What the signals show comes after.
/// let of_signals = stages.simulate()?.warnings_of_signals(meshtone::StepJudgement::Repeated);
/// assert!(of_signals.iter().all(|warning| warning.key == "operation.brake_torque_nm"));
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn stages_and_warnings(
    scenario: impl Into<Scenario>,
    limit: MemoryLimit,
) -> Result<(Stages, Vec<ScenarioWarning>), ScenarioError> {
    let stages = stages_within(scenario, limit)?;
    let warnings = stages.warnings();
    Ok((stages, warnings))
}

impl Stages {
    /// Warnings about stages that can be simulated: those of [`Scenario::validate`], keys that the model ignores, slices that the faces
    /// are not cut into, wheels of a rig whose accelerations, or whose supports', cancel in the channels, a settling too short for the
    /// slowest mode, a load that would break teeth or is at one end of a face, under a linear mesh places at which none meet, and a mesh frequency that meets a natural
    /// frequency of shafts of beams.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        let unused = self.meshes.iter().enumerate().filter_map(|(number, mesh)| {
            unused_slices(&self.scenario.named_gears(&self.layout, number), mesh.slices())
        });
        let of_scenario = self.warnings_of_scenario.iter().cloned();
        of_scenario
            .chain(unused)
            .chain(self.equal_wheels())
            .chain(self.unsettled())
            .chain(self.overloads())
            .chain(self.uneven_faces())
            .chain(self.without_contact())
            .chain(self.mesh_resonances())
            .collect()
    }

    /// Teeth that the load would bend off, mesh by mesh.
    fn overloads(&self) -> impl Iterator<Item = ScenarioWarning> {
        let (key, torque_nm) = largest_torque(&self.scenario.operation);
        let forces_n = self.forces_of_torque_n(torque_nm).into_iter().zip(self.mean_stiffness_n_per_m());
        let meshes = self.layout.mesh_names.iter().zip(&self.layout.gears);
        forces_n.zip(meshes).filter_map(move |((force_n, stiffness_n_per_m), (name, gears))| {
            let of_mesh = name.as_ref().map_or_else(String::new, |name| format!(" of mesh {name}"));
            let teeth = format!("the teeth{of_mesh}");
            overload(&teeth, key.clone(), torque_nm, force_n, stiffness_n_per_m, gears)
        })
    }

    /// Places at which no pair of teeth meets: nothing holds the wheels there, where real teeth would touch with their tips'
    /// corners. Under `contact` they do.
    fn without_contact(&self) -> Option<ScenarioWarning> {
        if self.teeth_part() || self.pairs.iter().all(|pair| pair.damaged.is_empty()) {
            return None;
        }
        let stiffness = self.stiffness_over_a_turn_n_per_mm();
        let bare = stiffness.iter().filter(|&&stiffness| stiffness <= 0.0).count();
        (bare > 0).then(|| {
            let message = format!(
                "no pair of teeth meets for {:.2} % of a revolution: a linear mesh has no stiffness there, \
                 and the teeth strike where the next pair begins; with model = \"contact\" tip corners touch \
                 there, and with less damage a pair remains",
                100.0 * bare as f64 / stiffness.len() as f64
            );
            ScenarioWarning::new(WarningKind::NoContact, "fault", message)
        })
    }

    /// (-) Part of the starting transient that is left where the kept signal starts, by the slowest active mode's decay.
    pub fn transient_remainder(&self) -> f64 {
        let settling_s = self.time.kept_from_s();
        (-self.slowest_mode.decay_per_s * settling_s).exp()
    }

    fn equal_wheels(&self) -> Option<ScenarioWarning> {
        let (rig, sensors) = (self.scenario.rig()?, &self.scenario.sensors);
        if !self.scenario.model.has_meshes() {
            return None;
        }
        let side = |body: &WheelBody, shaft: &Shaft| {
            let bearing = shaft.bearing_stiffness_n_per_m.unwrap_or(rig.bearing_stiffness_n_per_m);
            let bends =
                [shaft.radius_mm, shaft.bearing_span_mm, shaft.wheel_at, shaft.damping_ratio, bearing];
            (body.mass_kg, body.transverse_kgm2, bends)
        };
        let [pinion, gear] = self.wheel_bodies()[..] else { return None };
        if side(&pinion, &rig.pinion_shaft) != side(&gear, &rig.gear_shaft) {
            return None;
        }
        let (moving, channels) = if self.teeth_part() {
            if !sensors.iter().any(|sensor| sensor.at == SensorPlace::Support) {
                return None;
            }
            ("they and their supports", "sensors at the mean of both supports")
        } else {
            ("they", "the horizontal and vertical channels, which are the sum of both wheels' accelerations,")
        };
        let message = format!(
            "both wheels have the same mass, shafts and bearings: {moving} move in opposition, and {channels} show nothing; give \
             one wheel its own mass (rig.gear_inertia.mass_kg) or shaft \
             (rig.gear_shaft.bearing_span_mm)"
        );
        Some(ScenarioWarning::new(WarningKind::EqualWheels, "gears.gear_teeth", message))
    }

    fn unsettled(&self) -> Option<ScenarioWarning> {
        let named = if self.teeth_part() { words_of } else { |_: &DecayingMode| String::new() };
        unsettled(&self.slowest_mode, &self.time, &self.scenario.operation, &self.scenario.solver, named)
    }
}

/// A start-up transient that the discarded time does not outlast.
///
/// # Arguments
/// * `slowest` - the mode that is the slowest to decay
/// * `time`, `operation`, `solver` - the time that is discarded, profiles that it may pass, and the settings that say so
/// * `named` - what is said of the mode
fn unsettled(
    slowest: &DecayingMode,
    time: &TimeGrid,
    operation: &Operation,
    solver: &Solver,
    named: fn(&DecayingMode) -> String,
) -> Option<ScenarioWarning> {
    let decay = slowest.decay_per_s;
    let settling_s = time.kept_from_s();
    let remainder = (-decay * settling_s).exp();
    (remainder > TOLERATED_TRANSIENT).then(|| {
        let advice = if decay > 0.0 {
            let needed_s = -TOLERATED_TRANSIENT.ln() / decay;
            let raise = raised_fraction(time, operation, solver, needed_s);
            format!("it takes {needed_s:.3} s to fall to 1 %{raise}{}", named(slowest))
        } else {
            "it never decays: a mode has no damping".to_string()
        };
        let percent = 100.0 * remainder;
        let message = format!(
            "up to {percent:.0} % of the start-up transient is left when the kept signal starts, after {settling_s:.3} s; \
             {advice}"
        );
        ScenarioWarning::new(WarningKind::Unsettled, "solver.settle_fraction", message)
    })
}

/// Teeth that a load would bend off.
///
/// # Arguments
/// * `teeth` - what they are called
/// * `key`, `torque_nm` - the torque of the brake, and where it stands
/// * `force_n`, `stiffness_n_per_m` - what it makes the mesh carry, and the mesh's mean stiffness
/// * `gears` - its wheels
fn overload(
    teeth: &str,
    key: String,
    torque_nm: f64,
    force_n: f64,
    stiffness_n_per_m: f64,
    gears: &Gears,
) -> Option<ScenarioWarning> {
    let deflection_mm = force_n / stiffness_n_per_m * 1e3;
    let (module_mm, width_mm) = (gears.module_mm, gears.face_width_mm);
    let most_mm = TOLERATED_DEFLECTION * module_mm;
    (deflection_mm > most_mm).then(|| {
        let most_nm = torque_nm * most_mm / deflection_mm;
        let message = format!(
            "{torque_nm:?} N m deflects {teeth} by {deflection_mm:.3} mm, {:.2} modules, with {force_n:.0} N \
             on {width_mm} mm of face: they would break; at most {most_nm:.0} N m stays below a tenth of the \
             module",
            deflection_mm / module_mm
        );
        ScenarioWarning::new(WarningKind::Overload, key, message)
    })
}

/// The advice to raise the settling fraction, in hundredths, as the end of a sentence; empty where no fraction is enough.
///
/// A profile that would then end before the kept signal is moved along with it: lowering the fraction again would not settle.
fn raised_fraction(time: &TimeGrid, operation: &Operation, solver: &Solver, needed_s: f64) -> String {
    const MOST: f64 = 0.99;
    let [kept_s, whole_s] = [time.kept_samples(), time.samples].map(|samples| samples as f64 * time.step_s());
    let part_of = |whole_s: f64| (100.0 * needed_s / whole_s).ceil() / 100.0;
    let is_length_given = solver.duration_s.or(solver.pinion_revolutions).is_some();
    // Settling takes its part of the whole, if that is long enough, or comes before a stated length.
    let (length, fraction, from_s) = if is_length_given || part_of(whole_s) > MOST {
        let length =
            if is_length_given { String::new() } else { format!("; give solver.duration_s = {kept_s:.3}") };
        let fraction = part_of(needed_s + kept_s);
        (length, fraction, kept_s * fraction / (1.0 - fraction))
    } else {
        (String::new(), part_of(whole_s), part_of(whole_s) * whole_s)
    };
    if fraction > MOST {
        return String::new();
    }
    let later = |(key, _): (&str, f64)| {
        format!(", and add {from_s:.3} s to the times of {key}, which would end before")
    };
    let later: String = operation.profiles_ended_at(from_s).map(later).collect();
    format!("{length}; raise solver.settle_fraction to {fraction:.2}{later}")
}

/// The key of the largest torque, and the torque in N m.
fn largest_torque(operation: &Operation) -> (String, f64) {
    let values = operation.torque_profile_nm.iter().flat_map(|profile| &profile.value).enumerate();
    let values =
        values.map(|(index, &torque)| (format!("operation.torque_profile_nm.value[{index}]"), torque));
    let constant = ("operation.brake_torque_nm".to_owned(), operation.brake_torque_nm);
    let of_profile = values.reduce(|largest, other| if other.1 > largest.1 { other } else { largest });
    of_profile.unwrap_or(constant)
}

/// Which mode is slow, and what damps it.
fn words_of(mode: &DecayingMode) -> String {
    let ratio = mode.decay_per_s / (TAU * mode.frequency_hz);
    format!(
        "; slowest is the mode at {:.0} Hz, at {:.2} % of critical damping, which the damping_ratio of shafts and supports raises",
        mode.frequency_hz,
        100.0 * ratio
    )
}
