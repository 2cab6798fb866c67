//! From a scenario to everything that the page draws.

mod bearing;
mod desk;
mod diagnosis;
mod gearbox;
mod healthy;
mod lines;
mod mesh_cycle;
mod recording;
mod severity;
mod teeth;
mod wheel_signals;

use meshtone::scenario::{Fault, Model, Scenario, ScenarioWarning};
use meshtone::sensor::{NamedSignal, SignalSource};
use meshtone::signal::{ChainSettings, SimulatedShafts};
use meshtone::wheel::WheelName;
use meshtone::{Simulation, StageTime, Stages, StepJudgement};
use meshtone_plot::DamagedTooth;
use serde_json::{Map, Value, json};

pub use desk::desk;
pub use diagnosis::{DiagnosisQuestion, diagnosis};
pub use gearbox::{gearbox_answer, gearbox_sections_json};
pub use healthy::{HealthyIndicators, healthy_indicators, healthy_json};
pub use mesh_cycle::MeshCycle;
pub use recording::{RecordingQuestion, recording};
pub use severity::severity_curve;
pub use teeth::TeethInPlane;
pub use wheel_signals::WheelSignals;

use crate::packet::Packet;
use crate::question::memory_limit;
use crate::refusal::Refusal;

/// How much of a simulation is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Detail {
    /// While a control moves: the same motion over three revolutions of the gear.
    Coarse,
    /// All that the scenario says.
    #[default]
    Full,
}

impl Detail {
    /// The scenario that is simulated for it.
    ///
    /// # Arguments
    /// * `scenario` - what is asked for
    pub fn of(self, scenario: &Scenario) -> Scenario {
        match self {
            Self::Full => scenario.clone(),
            Self::Coarse => shortened(scenario),
        }
    }
}

/// Revolutions of the gear that are kept of a shortened simulation: enough for an average.
const SHORT_REVOLUTIONS: f64 = 3.0;
/// (-) What may be left of the transient then: less than a picture shows. The settling is half as long as by default.
const SHORT_TOLERANCE: f64 = 1e-3;

/// The scenario with no more than some revolutions kept. What comes before is not simulated either, but for the settling; where the
/// speed varies, or the published model simulates all of it, nothing is gained and the scenario stays as it is.
fn shortened(scenario: &Scenario) -> Scenario {
    let mut short = scenario.clone();
    let gears = &scenario.gears();
    let revolutions = SHORT_REVOLUTIONS * f64::from(gears.gear_teeth) / f64::from(gears.pinion_teeth);
    let kept_s = revolutions / scenario.operation.pinion_speed_hz;
    let time = scenario.time_grid();
    if scenario.model.has_meshes()
        && scenario.operation.speed_profile_hz.is_none()
        && scenario.operation.torque_profile_nm.is_none()
        && kept_s < time.kept_samples() as f64 * time.step_s()
    {
        short.solver.discard_and_keep(time.kept_from_s(), kept_s);
        short.solver.settle_tolerance = scenario.solver.settle_tolerance.max(SHORT_TOLERANCE);
    }
    short
}

/// What is asked beside the scenario.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AnswerOptions {
    /// How much of it.
    pub detail: Detail,
    /// The channel that is drawn and processed, by its name; where there is none of it, the first sensor's, or the vertical
    /// acceleration.
    pub channel: Option<String>,
    /// The wheel of a gearbox that is looked at, by its name; where there is none of it, the first.
    pub wheel: Option<String>,
    /// The mesh of a gearbox that is looked at, likewise.
    pub mesh: Option<String>,
    /// The rolling bearing of a gearbox that is looked at, by the name of its seat, such as `input:0`; where there is none of it, the
    /// first with a defect, or else the first.
    pub bearing: Option<String>,
}

/// Everything that the page draws of a scenario.
#[derive(Clone, PartialEq)]
pub struct State {
    /// What was asked for, whatever was shortened of it.
    pub scenario: Scenario,
    /// How much was asked for.
    pub detail: Detail,
    /// What is doubtful.
    pub warnings: Vec<ScenarioWarning>,
    /// The simulation.
    pub simulation: Simulation,
    /// Key figures: what, value, unit.
    pub figures: Vec<(&'static str, f64, &'static str)>,
    /// The teeth in their plane.
    pub teeth: TeethInPlane,
    /// Stiffness and forces over the mesh cycle.
    pub mesh: MeshCycle,
    /// Number of the signal that is drawn.
    pub signal: usize,
    /// What its signal shows of each wheel, the pinion first.
    pub wheels: [WheelSignals; 2],
}

/// Simulates a scenario and prepares all that the page draws.
///
/// # Arguments
/// * `scenario` - what is asked for
/// * `options` - what of it
/// * `is_wanted` - whether the answer still is: asked between stages, and many times while the simulation runs
///
/// # Errors
/// The scenario cannot be simulated ([`meshtone::simulate`]), a simulation needs more memory than one for the page may, or nobody waits for
/// the answer any longer.
///
/// ```
/// use meshtone::scenario::Scenario;
/// use meshtone_explore::{AnswerOptions, answer, presets};
///
/// let mut scenario = Scenario::from_toml(presets()[3].toml)?;
/// scenario.solver.sampling_rate_hz = 2e4;
/// let state = answer(&scenario, &AnswerOptions::default(), &|| true).unwrap();
/// assert!(state.simulation.stages.fault_severities[0] > 0.0);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn answer(
    scenario: &Scenario,
    options: &AnswerOptions,
    is_wanted: &dyn Fn() -> bool,
) -> Result<State, Refusal> {
    let simulated = options.detail.of(scenario);
    let (stages, mut warnings) = meshtone::stages_and_warnings(&simulated, memory_limit())?;
    wanted(is_wanted)?;
    let simulation = stages.simulate_while(is_wanted)?.ok_or(Refusal::Superseded)?;
    let stages = &simulation.stages;
    let (signal, of_wheel) = wheel_signals(&simulation, options.channel.as_deref());
    let of_signals = || match options.detail {
        Detail::Full => simulation.warnings_of_signals(StepJudgement::Repeated),
        Detail::Coarse => Vec::new(),
    };
    // About as long as the wheels' signals.
    let of_rest = || (of_signals(), figures(&simulation), TeethInPlane::new(stages), MeshCycle::new(stages));
    let ((of_signals, figures, teeth, mesh), wheels) = rayon::join(of_rest, || WheelName::BOTH.map(of_wheel));
    warnings.extend(of_signals);
    wanted(is_wanted)?;
    Ok(State {
        scenario: scenario.clone(),
        detail: options.detail,
        warnings,
        figures,
        teeth,
        mesh,
        signal,
        wheels,
        simulation,
    })
}

/// Ends what nobody waits for.
fn wanted(is_wanted: &dyn Fn() -> bool) -> Result<(), Refusal> {
    if is_wanted() { Ok(()) } else { Err(Refusal::Superseded) }
}

/// The signal of a name, or the leading one where there is none of it, by its number, and what it shows of the wheel on a shaft.
fn wheel_signals(
    simulation: &Simulation,
    name: Option<&str>,
) -> (usize, impl Fn(WheelName) -> WheelSignals + Send) {
    let Simulation { stages, channels, .. } = simulation;
    let named = channels.signals.iter().position(|signal| name == Some(&signal.name));
    let leading = || {
        let source = channels.leading()?.source;
        channels.signals.iter().position(|signal| signal.source == source)
    };
    let number = named.or_else(leading).unwrap_or(0);
    let signal = &channels.signals[number].values;
    let shafts = SimulatedShafts::of_stages(stages, channels.start_s, channels.len());
    let of_wheel = move |shaft| {
        let damaged = damaged_numbers(stages, shaft);
        let record = shafts.process(signal, shaft, &ChainSettings::default());
        WheelSignals { record, teeth: shafts.teeth(shaft), damaged }
    };
    (number, of_wheel)
}

/// Numbers of a wheel's damaged teeth, from 1, rising.
fn damaged_numbers(stages: &Stages, wheel: WheelName) -> Vec<usize> {
    DamagedTooth::of_stages(stages, wheel).iter().map(|tooth| tooth.tooth as usize).collect()
}

/// Key figures of a simulation.
fn figures(simulation: &Simulation) -> Vec<(&'static str, f64, &'static str)> {
    let Simulation { stages, channels, .. } = simulation;
    let (scenario, gears) = (&stages.scenario, &stages.layout.gears[0]);
    let mesh_hz = scenario.operation.pinion_speed_hz * f64::from(gears.pinion_teeth);
    let frequencies = stages.natural_frequencies_hz();
    // Rigid rotation has none.
    let lowest = frequencies.into_iter().find(|&frequency| frequency > 1.0);
    let largest = channels.of(SignalSource::MeshForce(0)).iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut figures = vec![
        ("contact ratio", stages.pairs[0].teeth.path.contact_ratio, ""),
        ("mesh frequency", mesh_hz, "Hz"),
    ];
    if gears.is_helical() {
        figures.extend([
            ("overlap ratio", gears.overlap_ratio(), ""),
            ("axial force", (stages.static_force_n() * gears.thrust()).abs(), "N"),
        ]);
    }
    let curves = stages.mesh_curves().into_iter();
    figures.extend(curves.map(|curve| ("mean mesh stiffness", 1e-3 * curve.mean_stiffness_n_per_mm, "N/µm")));
    figures
        .extend([("static mesh force", stages.static_force_n(), "N"), ("largest mesh force", largest, "N")]);
    figures.extend(
        simulation
            .contact_figures()
            .map(|contact| ("contact loss", 100.0 * contact.apart_fraction, "% of the time")),
    );
    figures.extend(lowest.map(|frequency| ("lowest natural frequency", frequency, "Hz")));
    if let Some(rig) = scenario.rig().filter(|_| scenario.model == Model::Contact) {
        let [in_phase, out_of_phase] = rig.support.frequencies_hz();
        figures.extend([("support modes: in phase", in_phase, "Hz"), ("out of phase", out_of_phase, "Hz")]);
    }
    figures.push(("sampling rate", channels.sampling_rate_hz, "S/s"));
    figures
}

impl State {
    /// The answer's bytes.
    ///
    /// # Arguments
    /// * `more` - what else is said beside it
    pub fn packet(&self, more: Map<String, Value>) -> Vec<u8> {
        let mut packet = Packet::default();
        let Simulation { stages, channels, timings, .. } = &self.simulation;
        let signal = &channels.signals[self.signal];
        let timing = |stage: &StageTime| json!([stage.stage, stage.elapsed.as_secs_f64() * 1e3]);
        let warning = |warning: &ScenarioWarning| json!({ "key": warning.key, "message": warning.message });
        let mut said = json!({
            "detail": if self.detail == Detail::Full { "full" } else { "coarse" },
            "toml": self.scenario.to_toml(),
            "scenario": serde_json::to_value(&self.scenario).unwrap_or_default(),
            "warnings": self.warnings.iter().map(warning).collect::<Vec<_>>(),
            "severities": stages.fault_severities,
            "sized_faults": sized_faults(&stages.scenario),
            "figures": self.figures,
            "teeth": self.teeth.json(&mut packet),
            "mesh": self.mesh.json(&mut packet),
            "channels": channels.signals.iter().map(channel_json).collect::<Vec<_>>(),
            "signal": {
                "channel": channel_json(signal),
                "sampling_rate_hz": channels.sampling_rate_hz,
                "start_s": channels.start_s,
                "values": packet.array(signal.values.iter().copied()),
            },
            "modes": modes_json(stages, signal.source),
            "wheels": self.wheels.each_ref().map(|wheel| wheel.json(signal.unit, &mut packet)),
            "timings_ms": timings.iter().map(timing).collect::<Vec<_>>(),
        });
        if let Value::Object(entries) = &mut said {
            entries.extend(more);
        }
        packet.bytes(&said)
    }
}

/// (Hz) Where the machine rings before the channel: what rings, and its natural frequencies.
fn modes_json(stages: &Stages, source: SignalSource) -> Value {
    let modes = stages.support_modes();
    let of_supports = |is_alike: bool| {
        let of_kind = modes.iter().filter(move |mode| mode.is_alike == is_alike);
        of_kind.map(|mode| mode.frequency_hz).collect::<Vec<f64>>()
    };
    let sensor = match source {
        SignalSource::Sensor(number) => stages.sensors.get(number),
        _ => None,
    };
    let housing = sensor.map_or_else(Vec::new, |sensor| sensor.path.housing_frequencies_hz());
    let mount: Vec<f64> = sensor.and_then(|sensor| sensor.resonance_hz).into_iter().collect();
    json!([
        ["supports in phase", of_supports(true)],
        ["supports out of phase", of_supports(false)],
        ["housing", housing],
        ["sensor on its mount", mount],
    ])
}

/// The sections of faults by their sizes, those too that were given by their severity; always a list.
fn sized_faults(scenario: &Scenario) -> Value {
    let sized = scenario.faults.iter().map(|fault| Fault { severity: None, ..fault.clone() }).collect();
    let sections = serde_json::to_value(scenario.clone().with_faults(sized)).unwrap_or_default();
    match sections.get("fault") {
        Some(Value::Array(several)) => Value::Array(several.clone()),
        Some(single) => Value::Array(vec![single.clone()]),
        None => Value::Array(Vec::new()),
    }
}

fn channel_json(signal: &NamedSignal) -> Value {
    json!({ "name": signal.name, "unit": signal.unit, "meaning": signal.meaning })
}
