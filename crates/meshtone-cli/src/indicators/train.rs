//! The machine that a recording is of, and how its shafts turned.

use meshtone::scenario::Scenario;
use meshtone::signal::{GearTrain, SeparationSettings, TrainTurning};
use meshtone_io::indicators::WarningEntry;
use meshtone_plot::DamagedTooth;

use super::options::{PhaseOptions, ShaftOptions};
use super::phase::{check_rate, simulated_form};
use super::process::Wheel;
use super::reading::Input;
use super::refuse::{RefusedInput, refuse};
use crate::failure::Failure;

/// A machine with how it turned in a recording.
pub struct Turned {
    /// Shafts, wheels, meshes.
    pub train: GearTrain,
    /// How its shafts turned.
    pub turning: TrainTurning,
    /// The wheels in words, in the order of the train.
    pub wheels: Vec<Wheel>,
    /// The source of the phase, in words.
    pub source: String,
    /// Doubts about the recording and the files that state its phase.
    pub warnings: Vec<WarningEntry>,
}

/// Shafts, wheels and meshes of a scenario of either form.
pub fn train_of(form: &Scenario) -> Result<GearTrain, Failure> {
    GearTrain::of_scenario(form).map_err(|error| Failure::bad_input(error.to_string()))
}

impl Turned {
    /// Finds out how the shafts of a recording turned.
    ///
    /// What `meshtone simulate` wrote knows its wheels and their angles itself. Of another recording the tooth counts are those of the scenario, or
    /// of the options, and the options say how one shaft turned; beside a scenario that is its speed, made exact by the mesh tone, where they
    /// say nothing.
    ///
    /// # Arguments
    /// * `input` - the recording
    /// * `phase`, `shafts` - the options
    /// * `scenario` - of the machine, where it is stated
    pub fn new(
        input: &Input,
        phase: &PhaseOptions,
        shafts: &ShaftOptions,
        scenario: Option<&Scenario>,
    ) -> Result<Self, Failure> {
        let is_silent = !phase.states_shaft_angle() && shafts.is_empty();
        match (&input.scenario_toml, scenario) {
            (Some(toml), Some(stated)) if is_silent => {
                let simulated = Self::simulated(input, toml)?;
                simulated.check_is_of(&train_of(stated)?, input)?;
                Ok(simulated)
            }
            (Some(toml), None) if is_silent && phase.is_empty() => Self::simulated(input, toml),
            (_, Some(form)) => Self::measured(input, phase, shafts, form),
            (Some(toml), None) if phase.teeth.is_none() => {
                Self::measured(input, phase, shafts, &simulated_form(input, toml)?)
            }
            (_, None) => {
                phase.check_teeth(input)?;
                phase.check_angle(input)?;
                if !shafts.is_empty() {
                    let problem = "--shaft and --mesh name parts of a scenario, and none is stated";
                    return Failure::refuse(problem, "state it with --scenario, or leave them out");
                }
                let wheel = ("wheel", phase.teeth.unwrap_or(0));
                let train = match phase.mate_teeth {
                    None => GearTrain::of_wheels([wheel]),
                    Some(teeth) => GearTrain::of_wheels([wheel, ("mate", teeth)]),
                };
                Self::of_phase(input, phase, train, 0, phase.source().to_owned())
            }
        }
    }

    /// Takes shafts and angles from the scenario of what was simulated.
    fn simulated(input: &Input, scenario_toml: &str) -> Result<Self, Failure> {
        let form = simulated_form(input, scenario_toml)?;
        let train = train_of(&form)?.at_sensor(&form, &input.channel.name);
        let samples = input.channel.samples.len();
        check_rate(input, form.time_grid().sampling_rate_hz)?;
        let turning = TrainTurning::of_simulated(&form, input.start_s, samples)
            .map_err(|error| refuse(&input.source, "its time", RefusedInput::Phase, &error))?;
        let damaged = (0..train.wheels.len()).map(|wheel| damaged_teeth(&form, wheel));
        let phase = PhaseOptions::default();
        let wheels = wheels(&train, damaged.collect(), |_, damaged| phase.first_tooth(false, damaged));
        let warnings = input.warnings.clone();
        Ok(Self { train, turning, wheels, source: phase.source().to_owned(), warnings })
    }

    /// Refuses a recording of other wheels than the scenario's.
    fn check_is_of(&self, stated: &GearTrain, input: &Input) -> Result<(), Failure> {
        let words = |train: &GearTrain| {
            let wheel = |wheel: usize| train.wheels[wheel].teeth.to_string();
            train.meshes.iter().map(|mesh| mesh.map(wheel).join("/")).collect::<Vec<_>>().join(", ")
        };
        let [here, there] = [&self.train, stated].map(words);
        if here == there {
            return Ok(());
        }
        let source = input.source.display();
        let problem = format!("{source}: is of meshes with {here} teeth, but the scenario has {there}");
        Failure::refuse(problem, "name the scenario of its own rig with --scenario")
    }

    /// Of a recording of a known machine, of which the options say how one shaft turned.
    fn measured(
        input: &Input,
        stated: &PhaseOptions,
        shafts: &ShaftOptions,
        form: &Scenario,
    ) -> Result<Self, Failure> {
        let train = train_of(form)?;
        let mut shaft = shafts.shaft(&train, [stated.teeth, stated.mate_teeth])?;
        let ratio = |shaft: usize| train.speed_ratio(shaft, train.input()).value();
        let mut phase = stated.clone();
        // The tone of a mesh that is named is followed, also where a speed is stated.
        phase.from_mesh_tone |= shafts.mesh.is_some();
        if !stated.states_shaft_angle() {
            phase.shaft_hz = Some(form.operation.pinion_speed_hz * ratio(shaft));
            phase.from_mesh_tone = true;
        }
        let mut source = phase.source().to_owned();
        let mut tone = None;
        if phase.from_mesh_tone {
            let mesh = shafts.mesh(&train, shaft)?;
            let [driving, driven] = train.meshes[mesh];
            let wheel = if train.wheels[driven].shaft == shaft { driven } else { driving };
            let of_wheel = train.wheels[wheel].shaft;
            phase.shaft_hz = phase.shaft_hz.map(|hz| hz * ratio(of_wheel) / ratio(shaft));
            (shaft, tone) = (of_wheel, Some(wheel));
            source = format!("{source} of {}", train.mesh_name(mesh));
        } else if train.shafts.len() > 2 {
            source = format!("{source} of shaft {}", train.shafts[shaft].name);
        }
        let own = tone.or_else(|| train.wheels.iter().position(|wheel| wheel.shaft == shaft));
        phase.teeth = own.map(|wheel| train.wheels[wheel].teeth);
        Self::of_phase(input, &phase, train, shaft, source)
    }

    /// Of a recording of a machine of which only the turning of one shaft is stated.
    ///
    /// # Arguments
    /// * `input` - the recording
    /// * `phase` - the options
    pub fn without_wheels(input: &Input, phase: &PhaseOptions) -> Result<Self, Failure> {
        if phase.from_mesh_tone {
            phase.check_teeth(input)?;
        }
        phase.check_angle(input)?;
        Self::of_phase(input, phase, GearTrain::of_shaft("shaft"), 0, phase.source().to_owned())
    }

    fn of_phase(
        input: &Input,
        options: &PhaseOptions,
        train: GearTrain,
        shaft: usize,
        source: String,
    ) -> Result<Self, Failure> {
        let (phase, of_phase) = options.measured(input)?;
        let damaged = vec![Vec::new(); train.wheels.len()];
        let on_shaft = |wheel: usize| train.wheels[wheel].shaft == shaft;
        let wheels = wheels(&train, damaged, |wheel, damaged| options.first_tooth(on_shaft(wheel), damaged));
        let stated = options.stated_facts(options.teeth.unwrap_or(0)).turning;
        let warnings = [input.warnings.clone(), of_phase].concat();
        Ok(Self { train, turning: TrainTurning::Shaft { shaft, phase, stated }, wheels, source, warnings })
    }
}

/// The wheels of a train in words.
fn wheels(
    train: &GearTrain,
    damaged: Vec<Vec<DamagedTooth>>,
    first_tooth: impl Fn(usize, &[DamagedTooth]) -> String,
) -> Vec<Wheel> {
    let is_pair = train.shafts.len() <= 2 && train.wheels.len() <= 2;
    let wheel = |(number, damaged_teeth): (usize, Vec<DamagedTooth>)| {
        let of = &train.wheels[number];
        Wheel {
            name: of.name.clone(),
            teeth: of.teeth,
            shaft: (!is_pair).then(|| train.shafts[of.shaft].name.clone()),
            tooth_order_of_carrier_against_ring: train.tooth_order_of_carrier_against_ring(number),
            separation: train.separation(number, &SeparationSettings::new(1)),
            first_tooth: first_tooth(number, &damaged_teeth),
            damaged_teeth,
        }
    };
    damaged.into_iter().enumerate().map(wheel).collect()
}

/// The teeth of a wheel that a scenario damages.
fn damaged_teeth(scenario: &Scenario, wheel: usize) -> Vec<DamagedTooth> {
    let of_wheel = || {
        let layout = scenario.layout().ok()?;
        let (mesh, side) = layout.mesh_of(wheel)?;
        let faults = layout.faults_of_mesh(&scenario.placed_faults(), mesh);
        let faults: Vec<_> = faults.into_iter().map(|(_, fault)| fault).collect();
        Some(DamagedTooth::of_wheel(&faults, side, &layout.gears[mesh]))
    };
    of_wheel().unwrap_or_default()
}

impl ShaftOptions {
    /// Whether none is given.
    pub fn is_empty(&self) -> bool {
        self.shaft.is_none() && self.mesh.is_none()
    }

    /// Number of the shaft that speed or pulses are of: the named one, that of the wheel with the stated teeth, or the input.
    fn shaft(&self, train: &GearTrain, [teeth, mate_teeth]: [Option<u32>; 2]) -> Result<usize, Failure> {
        let all = || {
            let counts: Vec<String> = train.wheels.iter().map(|wheel| wheel.teeth.to_string()).collect();
            counts.join(", ")
        };
        let count = |teeth: u32| train.wheels.iter().filter(|wheel| wheel.teeth == teeth).count();
        if let Some(mate) = mate_teeth.filter(|mate| count(*mate) == 0) {
            let problem = format!("--mate-teeth {mate}: is no wheel of the scenario; there are {}", all());
            return Failure::refuse(problem, "leave it out: the scenario has the tooth counts");
        }
        if let Some(name) = &self.shaft {
            return find(
                &format!("--shaft {name}"),
                "shaft",
                name,
                train.shafts.iter().map(|shaft| shaft.name.clone()).collect(),
            );
        }
        let Some(teeth) = teeth else { return Ok(train.input()) };
        match train.wheels.iter().find(|wheel| wheel.teeth == teeth) {
            Some(wheel) if count(teeth) == 1 || train.wheels.len() == 2 => Ok(wheel.shaft),
            found => {
                let what =
                    if found.is_none() { "is no wheel of the scenario" } else { "is more than one wheel" };
                let problem = format!("--teeth {teeth}: {what}; there are {}", all());
                Failure::refuse(problem, "--shaft NAME names the shaft to which speed or pulses belong")
            }
        }
    }

    /// Number of the mesh whose tone is followed.
    fn mesh(&self, train: &GearTrain, shaft: usize) -> Result<usize, Failure> {
        match &self.mesh {
            Some(name) => find(
                &format!("--mesh {name}"),
                "mesh",
                name,
                (0..train.meshes.len()).map(|mesh| train.mesh_name(mesh)).collect(),
            ),
            None => {
                let on_shaft =
                    |mesh: &[usize; 2]| mesh.iter().any(|wheel| train.wheels[*wheel].shaft == shaft);
                Ok(train.meshes.iter().position(on_shaft).unwrap_or(0))
            }
        }
    }
}

/// Number of what an option names.
///
/// # Arguments
/// * `given` - the option as it was written
/// * `kind` - what it names: a shaft, a mesh
/// * `name`, `names` - the one that is meant, and all that there are
pub(super) fn find(given: &str, kind: &str, name: &str, names: Vec<String>) -> Result<usize, Failure> {
    names.iter().position(|known| known == name).map_or_else(
        || {
            let problem = format!("{given}: the machine has no {kind} {name}");
            Failure::refuse(problem, format!("name one of {}", names.join(", ")))
        },
        Ok,
    )
}
