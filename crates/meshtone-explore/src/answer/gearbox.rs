//! From a gearbox to everything that its page draws.

use meshtone::scenario::{Member, Scenario, ScenarioWarning};
use meshtone::sensor::{ContactFigures, SignalSource};
use meshtone::signal::{
    AngularSettings, GearTrain, IndicatorValue, SignalError, TrainRecording, TrainSettings, TrainTurning,
};
use meshtone::{Simulation, StepJudgement};
use serde_json::{Map, Value, json};

use super::bearing::LookedAtBearing;
use super::lines::{Spectrum, SpectrumLine, Tones};
use super::wheel_signals::indicators_json;
use super::{AnswerOptions, Detail, wanted};
use crate::packet::Packet;
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// (s) What is kept while a control moves.
const SHORT_S: f64 = 0.25;
/// (-) What may be left of the transient then.
const SHORT_TOLERANCE: f64 = 1e-2;

/// Everything that the page draws of a gearbox.
pub struct GearboxState {
    gearbox: Scenario,
    options: AnswerOptions,
    warnings: Vec<ScenarioWarning>,
    simulation: Simulation,
    /// Its shafts, wheels and bearings.
    train: GearTrain,
    /// Number of the signal that is drawn.
    signal: usize,
    /// Number of the wheel that is looked at.
    wheel: usize,
    /// Number of the mesh that is looked at.
    mesh: usize,
    /// The rolling bearing that is looked at, where there is one.
    bearing: Option<LookedAtBearing>,
}

/// Simulates a gearbox and prepares all that the page draws.
///
/// # Arguments
/// * `gearbox` - what is asked for
/// * `options` - what of it
/// * `is_wanted` - whether the answer still is, asked between the stages
///
/// # Errors
/// The scenario cannot be simulated ([`meshtone::simulate`]), a simulation needs more memory than one for the page may, or nobody waits for
/// the answer any longer.
pub fn gearbox_answer(
    gearbox: &Scenario,
    options: &AnswerOptions,
    is_wanted: &dyn Fn() -> bool,
) -> Result<GearboxState, Refusal> {
    let mut simulated = gearbox.clone();
    // The page's spectrum is over time, in which lines of a speed that wanders have no one place.
    simulated.operation.speed_wander_percent = 0.0;
    let kept_s = simulated.time_grid().kept_samples() as f64 * simulated.time_grid().step_s();
    if options.detail == Detail::Coarse && simulated.operation.is_steady() && kept_s > SHORT_S {
        let settings = &mut simulated.solver;
        settings.discard_and_keep(gearbox.time_grid().kept_from_s(), SHORT_S);
        settings.settle_tolerance = settings.settle_tolerance.max(SHORT_TOLERANCE);
    }
    let stages = meshtone::stages_within(&simulated, memory_limit())?;
    wanted(is_wanted)?;
    let simulation = stages.simulate_while(is_wanted)?.ok_or(Refusal::Superseded)?;
    let mut warnings = simulation.stages.warnings();
    if options.detail == Detail::Full {
        warnings.extend(simulation.warnings_of_signals(StepJudgement::Estimated));
    }
    let number = |name: Option<&str>, names: Vec<String>| {
        names.iter().position(|known| Some(known.as_str()) == name).unwrap_or(0)
    };
    // At first a damaged wheel.
    let damaged = gearbox.faults.first().map(|fault| fault.wheel.as_str());
    let wheel = options.wheel.as_deref().or(damaged);
    let wheel = number(wheel, gearbox.wheels.iter().map(|wheel| wheel.name.clone()).collect());
    let of_wheel = simulation.stages.layout.mesh_of(wheel).map(|(mesh, _)| gearbox.meshes[mesh].name());
    let mesh = options.mesh.as_deref().or(of_wheel.as_deref());
    let signals = &simulation.channels.signals;
    let signal =
        number(options.channel.as_deref(), signals.iter().map(|signal| signal.name.to_string()).collect());
    let channel = &signals[signal].name;
    let mut train = GearTrain::of_stages(&simulation.stages).at_sensor(gearbox, channel);
    // No planets pass what is no sensor's: forces and speeds.
    if !gearbox.all_sensors().iter().any(|sensor| sensor.channel() == *channel) {
        train.sets.clear();
    }
    Ok(GearboxState {
        signal,
        wheel,
        mesh: number(mesh, gearbox.meshes.iter().map(|mesh| mesh.name()).collect()),
        bearing: LookedAtBearing::of(gearbox, &train, options.bearing.as_deref()),
        train,
        gearbox: gearbox.clone(),
        options: options.clone(),
        warnings,
        simulation,
    })
}

/// The sections of a gearbox, as the page sets them.
///
/// # Arguments
/// * `gearbox` - the whole
pub fn gearbox_sections_json(gearbox: &Scenario) -> Value {
    let table: Result<toml::Table, _> = gearbox.to_toml().parse();
    table.ok().and_then(|table| serde_json::to_value(table).ok()).unwrap_or_default()
}

impl GearboxState {
    /// The answer's bytes.
    ///
    /// # Arguments
    /// * `more` - what else is said beside it
    pub fn packet(&self, more: Map<String, Value>) -> Vec<u8> {
        let mut packet = Packet::default();
        let Simulation { stages, channels, .. } = &self.simulation;
        let signal = &channels.signals[self.signal];
        let tones = Tones::of(&self.train, stages.scenario.operation.pinion_speed_hz);
        let spectrum = Spectrum::of(&signal.values, channels.sampling_rate_hz);
        let lines = if stages.is_steady() { spectrum.lines(&tones) } else { Vec::new() };
        let line = |line: &SpectrumLine| json!([line.frequency_hz, line.amplitude, line.name]);
        let warning = |warning: &ScenarioWarning| json!({ "key": warning.key, "message": warning.message });
        let force = channels.of(SignalSource::MeshForce(self.mesh));
        let turning = TrainTurning::of_simulated(&stages.scenario, channels.start_s, signal.values.len());
        let recording = || {
            let turning = turning.as_ref().map_err(Clone::clone)?;
            let sampling_rate_hz = channels.sampling_rate_hz;
            Ok::<_, SignalError>(TrainRecording {
                signal: &signal.values,
                sampling_rate_hz,
                train: &self.train,
                turning,
            })
        };
        let average =
            recording().and_then(|recording| recording.average(self.wheel, &AngularSettings::default()));
        let indicators = recording().and_then(|recording| self.indicators(&recording, signal.unit));
        let problem = average.as_ref().err().or(indicators.as_ref().err()).map(ToString::to_string);
        // What is kept while a control moves is too short for averages.
        let bearing = self.bearing.as_ref().filter(|_| self.options.detail == Detail::Full);
        let bearing = bearing.map(|bearing| bearing.json(recording(), &mut packet));
        let wheel = &self.gearbox.wheels[self.wheel];
        let average = average
            .ok()
            .map(|of| json!({ "values": packet.array(of.values), "revolutions": of.revolutions }));
        let indicators = indicators.ok().flatten().map(|table| indicators_json(&table));
        let mut said = json!({
            "detail": if self.options.detail == Detail::Full { "full" } else { "coarse" },
            "toml": meshtone::written_out(&self.gearbox.to_toml()),
            "scenario": gearbox_sections_json(&self.gearbox),
            "warnings": self.warnings.iter().map(warning).collect::<Vec<_>>(),
            "figures": self.figures(force, &tones),
            "train": self.train(&tones),
            "channels": channels.signals.iter().map(|signal| &signal.name).collect::<Vec<_>>(),
            "signal": {
                "name": signal.name,
                "unit": signal.unit,
                "sampling_rate_hz": channels.sampling_rate_hz,
                "start_s": channels.start_s,
                "values": packet.array(signal.values.iter().copied()),
            },
            "spectrum": spectrum.json(&tones, &mut packet),
            "lines": lines.iter().map(line).collect::<Vec<_>>(),
            "wheel": { "name": wheel.name, "teeth": wheel.teeth, "average": average, "indicators": indicators, "problem": problem },
            "bearing": bearing,
            "mesh": { "name": self.gearbox.meshes[self.mesh].name(), "force": packet.array(force.iter().copied()) },
        });
        if let Value::Object(entries) = &mut said {
            entries.extend(more);
        }
        packet.bytes(&said)
    }

    /// Indicators of the wheel that is looked at; none while a control moves, when too little is simulated.
    fn indicators(
        &self,
        recording: &TrainRecording<'_>,
        unit: &str,
    ) -> Result<Option<Vec<IndicatorValue>>, SignalError> {
        if self.options.detail != Detail::Full {
            return Ok(None);
        }
        let records = recording.process_one(self.wheel, &TrainSettings::default())?.records;
        Ok(records.first().map(|record| record.indicators.table(unit)))
    }

    /// Key figures of the train and of the mesh that is looked at: what, value, unit.
    fn figures(&self, force_n: &[f64], tones: &Tones) -> Vec<(String, f64, &'static str)> {
        let stages = &self.simulation.stages;
        let (pair, mesh) = (&stages.pairs[self.mesh], &stages.meshes[self.mesh]);
        let name = &tones.meshes[self.mesh].name;
        let largest_n = force_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let apart = ContactFigures::of_force(force_n).apart_fraction;
        let of_mesh = |what: &str| format!("{what} of {name}");
        let train = GearTrain::of_stages(stages);
        let tooth = train.tooth_order_of_carrier_against_ring(self.wheel).map(|order| {
            (
                format!("order of a damaged tooth of {}", train.wheels[self.wheel].name),
                order,
                "of the carrier against the ring",
            )
        });
        let mut figures = vec![
            (of_mesh("mesh frequency"), tones.meshes[self.mesh].frequency_hz, "Hz"),
            (of_mesh("contact ratio"), pair.teeth.path.contact_ratio, ""),
            (of_mesh("mean stiffness"), mesh.mean_stiffness_n_per_m * 1e-6, "N/µm"),
            (of_mesh("static force"), pair.static_force_n, "N"),
            (of_mesh("largest force"), largest_n, "N"),
            (of_mesh("contact loss"), 100.0 * apart, "% of the time"),
            (
                "hunting-tooth period".to_owned(),
                stages.layout.cycle_revolutions() as f64,
                "revolutions of the input",
            ),
            ("sampling rate".to_owned(), self.simulation.channels.sampling_rate_hz, "S/s"),
        ];
        figures.extend(tooth);
        figures
    }

    /// The train, as it stands: axes, circles, faces.
    fn train(&self, tones: &Tones) -> Value {
        let (gearbox, layout) = (&self.gearbox, &self.simulation.stages.layout);
        let shaft = |(number, shaft): (usize, &meshtone::scenario::GearboxShaft)| {
            json!({
                "name": shaft.name,
                "x_mm": layout.positions_m[number][0] * 1e3,
                "y_mm": layout.positions_m[number][1] * 1e3,
                "start_mm": shaft.start_mm,
                "length_mm": shaft.length_mm,
                "radius_mm": shaft.radius_at_mm(0.5),
                "speed_hz": tones.shafts[number].1,
                "sense": layout.ratios[number].value().signum(),
            })
        };
        let damaged_teeth = |wheel: &meshtone::scenario::ScenarioWheel| -> Vec<u32> {
            let faults = gearbox.faults.iter().filter(|fault| fault.wheel == wheel.name);
            faults.flat_map(|fault| fault.tooth.numbers(wheel.teeth)).collect()
        };
        let wheel = |(number, wheel): (usize, &meshtone::scenario::ScenarioWheel)| {
            let of = layout.shaft_of_wheel[number];
            let module_mm = layout
                .mesh_of(number)
                .map_or(f64::NAN, |(mesh, _)| layout.gears[mesh].transverse_module_mm());
            // Its axis is where its carrier takes it; the speeds of a set's wheels are against that.
            let of_set = wheel.of_set.map(|of| (&layout.sets[of.set], of.member));
            let carrier_ratio = of_set.map_or(0.0, |(set, _)| set.ratios[1].value());
            let carrier = of_set.filter(|(_, member)| matches!(member, Member::Planet(_))).map(|(set, _)| {
                let [x_m, y_m] = layout.positions_m[layout.shaft_of_wheel[set.first_wheel]];
                json!({ "x_mm": x_m * 1e3, "y_mm": y_m * 1e3, "ratio": carrier_ratio })
            });
            json!({
                "name": wheel.name,
                "shaft": of,
                "ratio": layout.ratios[of].value() + carrier_ratio,
                "in_set": of_set.is_some(),
                "carrier": carrier,
                "x_mm": layout.positions_m[of][0] * 1e3,
                "y_mm": layout.positions_m[of][1] * 1e3,
                "z_mm": layout.z_mm(gearbox, number),
                "internal": layout.is_ring(number),
                "pitch_radius_mm": module_mm * f64::from(wheel.teeth) / 2.0,
                "face_width_mm": wheel.face_width_mm,
                "teeth": wheel.teeth,
                "sense": layout.ratios[of].value().signum(),
                "damaged": damaged_teeth(wheel),
            })
        };
        let mesh = |(number, mesh): (usize, &super::lines::MeshTone)| json!({ "name": mesh.name, "wheels": layout.wheels_of_mesh[number], "frequency_hz": mesh.frequency_hz });
        let bearing = |(bearing, &shaft): (&meshtone::scenario::Bearing, &usize)| {
            // A planet's is midway along it.
            let planet = (0..gearbox.wheels.len()).find(|wheel| layout.shaft_of_wheel[*wheel] == shaft);
            let z_mm = match (gearbox.shafts().get(shaft), planet) {
                (None, Some(wheel)) => layout.z_mm(gearbox, wheel),
                (of_shaft, _) => of_shaft.map_or(0.0, |of| of.z_mm(bearing.at)),
            };
            json!({
                "name": bearing.seat_name(),
                "shaft": shaft,
                "z_mm": z_mm,
                "x_mm": layout.positions_m[shaft][0] * 1e3,
                "rolling": bearing.element().is_some(),
                "damaged": !bearing.defect.is_empty(),
            })
        };
        json!({
            "shafts": gearbox.shafts().iter().enumerate().map(shaft).collect::<Vec<_>>(),
            "wheels": gearbox.wheels.iter().enumerate().map(wheel).collect::<Vec<_>>(),
            "meshes": tones.meshes.iter().enumerate().map(mesh).collect::<Vec<_>>(),
            "bearings": gearbox.bearings().iter().zip(&layout.shaft_of_bearing).map(bearing).collect::<Vec<_>>(),
        })
    }
}
