//! Warnings about a simulation: before the time loop, and by its signals.

mod gyroscopic;
mod mesh_resonance;
mod observer;
mod of_signals;
mod step_error;
mod uneven_face;

pub use gyroscopic::GyroscopicShift;
pub use observer::Observer;
pub use step_error::StepJudgement;

use crate::checks::{WindowSums, transient_part};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::machine::{Shaft, WheelBody};
use crate::mesh::Mesh;
use crate::operation::{Operation, TimeGrid};
use crate::scenario::{MemoryLimit, Scenario, SensorPlace, SetLayout, entry_key};
use crate::simulate::{Stages, stages_within};
use crate::wheel::unused_slices;

/// (-) Part of the starting transient that may be left where the kept signal starts.
const TOLERATED_TRANSIENT: f64 = 0.01;
/// (-) Part of the mean load of the planets that each one carries without a warning.
const LEAST_SHARE: f64 = 0.1;
/// (-) Part of the module by which a wheel may run out without a warning.
const TOLERATED_RUN_OUT: f64 = 0.1;
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
    /// are not cut into, wheels of a rig whose accelerations, or whose supports', cancel in the channels, meshes and sensors above the highest
    /// mode that is simulated, a load that would break teeth or is at one end of a face, under a linear mesh places at which none meet, chamfers that leave too little of the path, and a mesh frequency that meets a natural
    /// frequency of shafts of beams.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        let unused = self.meshes.iter().enumerate().filter_map(|(number, mesh)| {
            unused_slices(&self.scenario.named_gears(&self.layout, number), mesh.slices())
        });
        let of_scenario = self.warnings_of_scenario.iter().cloned();
        of_scenario
            .chain(unused)
            .chain(self.equal_wheels())
            .chain(self.beyond_band())
            .chain(self.large_run_outs())
            .chain(self.undamped())
            .chain(self.gyroscopic())
            .chain(self.idle_planets())
            .chain(self.overloads())
            .chain(self.uneven_faces())
            .chain(self.without_contact())
            .chain(self.short_paths())
            .chain(self.mesh_resonances())
            .collect()
    }

    /// Planets that hardly bear at rest, because of their pins.
    fn idle_planets(&self) -> Vec<ScenarioWarning> {
        let Some((assembled, _)) = self.machine().filter(|_| !self.layout.sets.is_empty()) else {
            return Vec::new();
        };
        let (stiffness, torque_nm) = (self.mean_stiffness_n_per_m(), self.scenario.operation.brake_torque_nm);
        let forces_n = assembled.machine.forces_at_rest_n(&stiffness, torque_nm);
        let of_set = |(number, set): (usize, &SetLayout)| {
            let of_planets = &forces_n[set.first_mesh..set.first_mesh + set.planets()];
            let mean_n = of_planets.iter().sum::<f64>() / of_planets.len() as f64;
            let planet = of_planets.iter().position(|force_n| *force_n < LEAST_SHARE * mean_n)?;
            let has_errors = self.scenario.planetary()[number].pin.error_um.iter().any(|um| *um != 0.0);
            let cause = if has_errors { "pin.error_um" } else { "carrier_eccentricity_um" };
            let key = entry_key("planetary", number, self.layout.sets.len(), cause);
            let message = format!(
                "planet {} carries {:.1} % of what a planet carries on average, at rest: it may lose contact when the set turns",
                planet + 1,
                100.0 * (of_planets[planet] / mean_n).max(0.0)
            );
            Some(ScenarioWarning::new(WarningKind::IdlePlanet, key, message))
        };
        self.layout.sets.iter().enumerate().filter_map(of_set).collect()
    }

    /// Teeth that the load would bend off, mesh by mesh.
    pub(crate) fn overloads(&self) -> impl Iterator<Item = ScenarioWarning> {
        let (key, torque_nm) = largest_torque(&self.scenario.operation);
        let forces_n = self.forces_of_torque_n(torque_nm).into_iter().zip(self.mean_stiffness_n_per_m());
        let meshes = self.layout.mesh_names.iter().zip(&self.layout.gears);
        forces_n.zip(meshes).filter_map(move |((force_n, stiffness_n_per_m), (name, gears))| {
            let of_mesh = name.as_ref().map_or_else(String::new, |name| format!(" of mesh {name}"));
            let deflection_mm = force_n / stiffness_n_per_m * 1e3;
            let (module_mm, width_mm) = (gears.module_mm, gears.face_width_mm);
            let most_mm = TOLERATED_DEFLECTION * module_mm;
            (deflection_mm > most_mm).then(|| {
                let most_nm = torque_nm.abs() * most_mm / deflection_mm;
                let message = format!(
                    "{torque_nm:?} N m deflects the teeth{of_mesh} by {deflection_mm:.3} mm, {:.2} modules, with {force_n:.0} N \
                     on {width_mm} mm of face: they would break; at most {most_nm:.0} N m stays below a tenth of the \
                     module",
                    deflection_mm / module_mm
                );
                ScenarioWarning::new(WarningKind::Overload, key.clone(), message)
            })
        })
    }

    /// Wheels that run out so far that their teeth hardly mesh: tolerances allow some hundredths of a module.
    fn large_run_outs(&self) -> Vec<ScenarioWarning> {
        let of_wheel = |mesh: usize, side: usize| {
            let (run_out_um, module_mm) =
                (self.pairs[mesh].run_out[side].run_out_um, self.layout.gears[mesh].module_mm);
            let wheel = self.layout.wheels_of_mesh[mesh][side];
            let key = match self.scenario.rig() {
                None => format!("wheel[{wheel}].run_out_um"),
                Some(_) => ["quality.pinion_run_out_um", "quality.gear_run_out_um"][side].to_owned(),
            };
            (run_out_um * 1e-3 > TOLERATED_RUN_OUT * module_mm).then(|| {
                let message = format!(
                    "a run-out of {run_out_um:.0} µm is {:.2} modules: the teeth go that far in and out of mesh in every turn, and tolerances allow \
                     some hundredths",
                    run_out_um * 1e-3 / module_mm
                );
                ScenarioWarning::new(WarningKind::LargeRunOut, key, message)
            })
        };
        let meshes = 0..if self.scenario.model.has_meshes() { self.pairs.len() } else { 0 };
        meshes.flat_map(|mesh| [of_wheel(mesh, 0), of_wheel(mesh, 1)]).flatten().collect()
    }

    /// Meshes and mounted resonances above the highest mode of shafts of beams: their vibration is missing in the signals.
    fn beyond_band(&self) -> Option<ScenarioWarning> {
        self.scenario.structure.shafts()?;
        let highest_hz = self.scenario.solver.highest_mode_hz(self.time.sampling_rate_hz);
        let speed_hz = self.scenario.operation.pinion_speed_hz;
        let meshes = self.meshes.iter().zip(&self.scenario.meshes).map(|(mesh, of)| {
            (
                format!("the teeth of mesh {} meet", of.name()),
                mesh.turning.pitches_per_revolution.abs() * speed_hz,
            )
        });
        let resonances = self
            .sensors
            .iter()
            .filter_map(|sensor| Some((format!("sensor {} resounds", sensor.name()), sensor.resonance_hz?)));
        let (what, hz) = meshes.chain(resonances).find(|(_, hz)| *hz > highest_hz)?;
        let message = format!(
            "{what} at {hz:.0} Hz, and the highest mode that is simulated lies below {highest_hz:.0} Hz: the signals lack what moves there; raise it"
        );
        Some(ScenarioWarning::new(WarningKind::BeyondBand, "solver.highest_mode_hz", message))
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

    /// Meshes whose tips' chamfers and shortening leave less than one pair of sound teeth on the path of contact at times.
    fn short_paths(&self) -> Vec<ScenarioWarning> {
        let there =
            if self.teeth_part() { "only corners of tips touch" } else { "a linear mesh has no stiffness" };
        let of_mesh = |(number, mesh): (usize, &Mesh)| {
            let ratio = mesh.contact_ratio + mesh.face.overlap().abs();
            let keys = self.scenario.named_gears(&self.layout, number).shorteners();
            let key = keys.first().filter(|_| ratio < 1.0)?;
            let message = format!(
                "the ends of the teeth leave a contact ratio of {ratio:.2}, so that at times {there}; lower {}",
                keys.join(" or ")
            );
            Some(ScenarioWarning::new(WarningKind::NoContact, key, message))
        };
        let mut warnings: Vec<_> = self.meshes.iter().enumerate().filter_map(of_mesh).collect();
        // The meshes of a planetary set are alike.
        warnings.dedup();
        warnings
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

    /// A mode that nothing damps: what sets it in motion at the start lasts.
    fn undamped(&self) -> Option<ScenarioWarning> {
        (self.slowest_mode.decay_per_s <= 0.0).then(|| {
            let message = "a start-up transient lasts, and it never decays: a mode has no damping";
            ScenarioWarning::new(WarningKind::Unsettled, "solver.settle_fraction", message)
        })
    }

    /// Signals in which a mode has not settled, or none where they are steady.
    ///
    /// # Arguments
    /// * `windows` - sums over each of some signals, all divided alike
    pub(super) fn unsettled(&self, windows: &[WindowSums]) -> Option<ScenarioWarning> {
        // What has decayed to 1 % of the start, which is a motion in equilibrium, is a part of no signal.
        let is_undamped = self.slowest_mode.decay_per_s <= 0.0;
        // A slow wander changes a signal by less than a transient that counts.
        let is_steady = self.scenario.operation.is_steady_but_for_wander();
        if is_undamped || !is_steady || self.transient_remainder() < TOLERATED_TRANSIENT {
            return None;
        }
        let (slowest, time) = (&self.slowest_mode, &self.time);
        let parts = windows.iter().map(|of| {
            let window_s = of.window_samples() as f64 * time.step_s();
            transient_part(&of.variances(), slowest.decay_per_s * window_s)
        });
        let part = parts.fold(0.0, f64::max);
        (part > TOLERATED_TRANSIENT).then(|| {
            let frequency_hz = slowest.frequency_hz;
            let remedy = remedy(time, slowest.decay_per_s);
            let message = format!(
                "a start-up transient changes the rms of the kept signal by {:.1} %: the mode at {frequency_hz:.0} Hz has decayed for {:.3} s \
                 only; {remedy}",
                100.0 * part,
                time.kept_from_s(),
            );
            ScenarioWarning::new(WarningKind::Unsettled, "solver.settle_fraction", message)
        })
    }
}

/// What lets a mode settle, and what that costs.
fn remedy(time: &TimeGrid, decay_per_s: f64) -> String {
    const MOST: f64 = 0.99;
    let [kept_s, whole_s] = [time.kept_samples(), time.samples].map(|samples| samples as f64 * time.step_s());
    let needed_s = -TOLERATED_TRANSIENT.ln() / decay_per_s;
    let fraction = (100.0 * needed_s / (needed_s + kept_s)).ceil() / 100.0;
    if fraction <= MOST {
        let cost = kept_s / (1.0 - fraction) / whole_s;
        format!(
            "solver.settle_fraction = {fraction:.2} beside solver.duration_s = {kept_s:.3} lets it decay, and takes {cost:.1} times as long"
        )
    } else {
        "raise the damping_ratio of shafts and supports".to_owned()
    }
}

/// The key of the largest torque, and the torque in N m.
fn largest_torque(operation: &Operation) -> (String, f64) {
    let values = operation.torque_profile_nm.iter().flat_map(|profile| &profile.value).enumerate();
    let values =
        values.map(|(index, &torque)| (format!("operation.torque_profile_nm.value[{index}]"), torque));
    let constant = ("operation.brake_torque_nm".to_owned(), operation.brake_torque_nm);
    let of_profile =
        values.reduce(|largest, other| if other.1.abs() > largest.1.abs() { other } else { largest });
    of_profile.unwrap_or(constant)
}
