//! The two forms of a scenario: of one pair, and of a gearbox.

use meshtone_toml::{ReadResult, TomlTable};

use super::from_toml::{Numbers, ScenarioFiles};
use super::{
    Gearbox, GearboxLayout, MemoryLimit, Model, Ripple, Scenario, ScenarioError, ScenarioWarning, Sensor,
};
use crate::damage::Fault;
use crate::operation::{Operation, Solver, TimeGrid};
use crate::wheel::{NamedGears, Teeth, WheelName};

/// A scenario in the form in which its file is written.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a file has only one")]
pub enum ScenarioForm {
    /// The short form: one pair of gears.
    Pair(Scenario),
    /// The long form: a gearbox.
    Gearbox(Gearbox),
}

impl From<Scenario> for ScenarioForm {
    fn from(scenario: Scenario) -> Self {
        Self::Pair(scenario)
    }
}

impl From<Gearbox> for ScenarioForm {
    fn from(gearbox: Gearbox) -> Self {
        Self::Gearbox(gearbox)
    }
}

impl From<&Scenario> for ScenarioForm {
    fn from(scenario: &Scenario) -> Self {
        scenario.clone().into()
    }
}

impl From<&Gearbox> for ScenarioForm {
    fn from(gearbox: &Gearbox) -> Self {
        gearbox.clone().into()
    }
}

impl From<&ScenarioForm> for ScenarioForm {
    fn from(scenario: &ScenarioForm) -> Self {
        scenario.clone()
    }
}

impl ScenarioForm {
    /// Reads and validates either form of a scenario that names no other file.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    ///
    /// # Errors
    /// The first thing that is wrong, with its line; sections of both forms.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        if Gearbox::is_written_in(text)? {
            return Gearbox::from_toml(text).map(Self::Gearbox);
        }
        let scenario = Scenario::from_toml(text)?;
        scenario.validate().map(|_| Self::Pair(scenario))
    }

    /// Reads either form that is a table of another file, without validating it.
    ///
    /// # Arguments
    /// * `table` - with the sections of a scenario file
    /// * `files` - loads the files that it names
    ///
    /// # Errors
    /// An unknown or missing key, a value of the wrong type, what `files` reports; sections of both forms.
    pub fn from_table(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Self> {
        if Gearbox::is_table(table)? {
            Gearbox::from_table(table, &Numbers(files)).map(Self::Gearbox)
        } else {
            Scenario::from_table(table, files).map(Self::Pair)
        }
    }

    /// The scenario file, defaults explicitly.
    pub fn to_toml(&self) -> String {
        match self {
            Self::Pair(scenario) => scenario.to_toml(),
            Self::Gearbox(gearbox) => gearbox.to_toml(),
        }
    }

    /// Checks every value, alone and against the others.
    ///
    /// # Errors
    /// Those of [`Scenario::validate`] and [`Gearbox::validate`].
    pub fn validate(&self) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        self.validate_within(MemoryLimit::default())
    }

    /// Does what [`Self::validate`] does, with another limit of memory.
    ///
    /// # Arguments
    /// * `limit` - most memory that the simulation may need
    ///
    /// # Errors
    /// Those of [`Self::validate`].
    pub fn validate_within(&self, limit: MemoryLimit) -> Result<Vec<ScenarioWarning>, ScenarioError> {
        match self {
            Self::Pair(scenario) => scenario.validate_within(limit),
            Self::Gearbox(gearbox) => gearbox.validate_within(limit),
        }
    }

    /// The pair, where it is one.
    pub fn pair(&self) -> Option<&Scenario> {
        match self {
            Self::Pair(scenario) => Some(scenario),
            Self::Gearbox(_) => None,
        }
    }

    /// The gearbox, where it is one.
    pub fn gearbox(&self) -> Option<&Gearbox> {
        match self {
            Self::Pair(_) => None,
            Self::Gearbox(gearbox) => Some(gearbox),
        }
    }

    /// Model of the meshes.
    pub fn model(&self) -> Model {
        self.pair().map_or(Model::Contact, |scenario| scenario.model)
    }

    /// Seed of every random draw.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Pair(scenario) => scenario.seed,
            Self::Gearbox(gearbox) => gearbox.seed,
        }
    }

    /// How the shafts, wheels and meshes stand and turn.
    ///
    /// # Errors
    /// Those of [`GearboxLayout::new`].
    pub fn layout(&self) -> Result<GearboxLayout, ScenarioError> {
        match self {
            Self::Pair(scenario) => Ok(GearboxLayout::of_pair(scenario)),
            Self::Gearbox(gearbox) => GearboxLayout::new(gearbox),
        }
    }

    /// The wheels of a mesh with what messages call them.
    ///
    /// # Arguments
    /// * `layout` - of this scenario
    /// * `mesh` - number of the mesh
    pub(crate) fn named_gears<'a>(&'a self, layout: &'a GearboxLayout, mesh: usize) -> NamedGears<'a> {
        match self {
            Self::Pair(_) => NamedGears::of_pair(&layout.gears[mesh]),
            Self::Gearbox(gearbox) => layout.named_gears(gearbox, mesh),
        }
    }

    /// The scenario with what its model does not honour at its default.
    pub(crate) fn without_ignored_keys(&self) -> Self {
        self.pair().map_or_else(|| self.clone(), |scenario| Self::Pair(scenario.without_ignored_keys()))
    }

    /// Keys that are not at their default although the model ignores them.
    pub fn ignored_by_model(&self) -> Vec<ScenarioWarning> {
        self.pair().map_or_else(Vec::new, Scenario::ignored_by_model)
    }

    /// Harmonics of the brake's torque.
    pub(crate) fn torque_ripple(&self) -> &[Ripple] {
        self.gearbox().map_or(&[], |gearbox| &gearbox.operation.torque_ripple)
    }

    /// Key of the nominal speed.
    pub fn speed_key(&self) -> &'static str {
        if self.gearbox().is_some() { "operation.input_speed_hz" } else { "operation.pinion_speed_hz" }
    }

    /// Speed and load.
    pub fn operation(&self) -> &Operation {
        match self {
            Self::Pair(scenario) => &scenario.operation,
            Self::Gearbox(gearbox) => &gearbox.operation,
        }
    }

    /// Speed and load, to be changed.
    pub fn operation_mut(&mut self) -> &mut Operation {
        match self {
            Self::Pair(scenario) => &mut scenario.operation,
            Self::Gearbox(gearbox) => &mut gearbox.operation,
        }
    }

    /// (m/s, rad/s) Velocities at the start, of a pair in the order of its coordinates; none where it starts in equilibrium, as a gearbox does.
    pub(crate) fn initial_velocity(&self) -> Option<&[f64]> {
        self.pair()?.solver.initial_velocity.as_ref().map(|given| given.as_slice())
    }

    /// Sampling and settling.
    pub fn solver(&self) -> &Solver {
        match self {
            Self::Pair(scenario) => &scenario.solver,
            Self::Gearbox(gearbox) => &gearbox.solver,
        }
    }

    /// Sampling and settling, to be changed.
    pub fn solver_mut(&mut self) -> &mut Solver {
        match self {
            Self::Pair(scenario) => &mut scenario.solver,
            Self::Gearbox(gearbox) => &mut gearbox.solver,
        }
    }

    /// Whether motor and brake are steady.
    pub fn is_steady(&self) -> bool {
        self.operation().is_steady() && self.torque_ripple().is_empty()
    }

    /// Division of time.
    pub fn time_grid(&self) -> TimeGrid {
        match self {
            Self::Pair(scenario) => scenario.time_grid(),
            Self::Gearbox(gearbox) => gearbox.time_grid(),
        }
    }

    /// The listed sensors, each with its name.
    pub fn sensors(&self) -> Vec<(String, &Sensor)> {
        match self {
            Self::Pair(scenario) => scenario.sensors.iter().map(|sensor| (sensor.name(), sensor)).collect(),
            Self::Gearbox(gearbox) => gearbox.sensors.iter().map(|sensor| (sensor.name(), sensor)).collect(),
        }
    }

    /// The listed sensors, to be changed.
    pub fn sensors_mut(&mut self) -> Vec<&mut Sensor> {
        match self {
            Self::Pair(scenario) => scenario.sensors.iter_mut().collect(),
            Self::Gearbox(gearbox) => gearbox.sensors.iter_mut().collect(),
        }
    }

    /// All sensors, each with its name: the listed ones, or of a gearbox without any a vertical one on every bearing's seat.
    pub(crate) fn all_sensors(&self) -> Vec<Sensor> {
        match self {
            Self::Pair(scenario) => scenario.sensors.clone(),
            Self::Gearbox(gearbox) => {
                let named = |of: Sensor| Sensor { name: Some(of.name()), ..of };
                gearbox.all_sensors().into_iter().map(named).collect()
            }
        }
    }

    /// States the natural frequency up to which a gearbox's modes are stepped, which otherwise follows the rate.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) the rate at which it stays
    pub(crate) fn keep_highest_mode(&mut self, sampling_rate_hz: f64) {
        if let Self::Gearbox(Gearbox { solver, .. }) = self {
            solver.highest_mode_hz = Some(solver.highest_mode_hz(sampling_rate_hz));
        }
    }

    /// A pair with the sizes of the faults that were given by their severity; a gearbox as it is.
    ///
    /// # Arguments
    /// * `teeth` - the healthy teeth of the first mesh
    pub(crate) fn with_sizes(mut self, teeth: &Teeth) -> Self {
        if let Self::Pair(scenario) = &mut self {
            scenario.faults.iter_mut().for_each(|fault| *fault = fault.with_sizes(teeth));
        }
        self
    }

    /// Puts the sensor of a channel before the others, since a recording is compared with the first one.
    ///
    /// # Arguments
    /// * `channel` - name of the channel, with its unit or without
    ///
    /// Returns whether another sensor is the first one now. A channel that no listed sensor has changes nothing.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario, ScenarioForm, Sensor};
    ///
    /// let named = ["foot", "cover", "flange"].map(|name| {
    ///     let mut sensor = Sensor::default();
    ///     sensor.name = Some(name.to_owned());
    ///     sensor
    /// });
    /// let mut form = ScenarioForm::Pair(Scenario::new(GearPair::example()).with_sensors(named.to_vec()));
    /// assert!(form.lead_with_sensor("cover_g") && !form.lead_with_sensor("cover") && !form.lead_with_sensor("wall"));
    /// let names: Vec<String> = form.sensors_mut().iter().map(|sensor| sensor.name()).collect();
    /// assert_eq!(names, ["cover", "foot", "flange"]);
    /// ```
    pub fn lead_with_sensor(&mut self, channel: &str) -> bool {
        let is = |name: String| channel == name || channel.strip_suffix("_g") == Some(&name);
        let Some(at) = self.sensors().into_iter().position(|(name, _)| is(name)) else { return false };
        match self {
            Self::Pair(scenario) => scenario.sensors[..=at].rotate_right(1),
            Self::Gearbox(gearbox) => gearbox.sensors[..=at].rotate_right(1),
        }
        at > 0
    }

    /// Returns the scenario with other faults.
    ///
    /// # Arguments
    /// * `faults` - each with the number of its wheel, of a pair 0 the pinion and 1 the gear; the wheel that it names itself does not count
    #[must_use]
    pub fn with_faults(mut self, faults: Vec<(usize, Fault)>) -> Self {
        match &mut self {
            Self::Pair(scenario) => {
                let on_wheel = |(wheel, fault): (usize, Fault)| Fault {
                    wheel: WheelName::BOTH[wheel.min(1)].into(),
                    ..fault
                };
                scenario.faults = faults.into_iter().map(on_wheel).collect();
            }
            Self::Gearbox(gearbox) => {
                let name =
                    |wheel: usize| gearbox.wheels.get(wheel).map_or_else(String::new, |of| of.name.clone());
                let on_wheel = |(wheel, fault): (usize, Fault)| Fault { wheel: name(wheel), ..fault };
                gearbox.faults = faults.into_iter().map(on_wheel).collect();
            }
        }
        self
    }

    /// The faults, each with the number of its wheel.
    pub fn faults(&self) -> Vec<(usize, &Fault)> {
        match self {
            Self::Pair(scenario) => {
                scenario.faults.iter().map(|fault| (fault.side() as usize, fault)).collect()
            }
            Self::Gearbox(gearbox) => gearbox.placed_faults(),
        }
    }

    /// Names of the wheels, in their order: of a pair `pinion` and `gear`.
    pub fn wheel_names(&self) -> Vec<&str> {
        match self.gearbox() {
            Some(gearbox) => gearbox.wheels.iter().map(|wheel| wheel.name.as_str()).collect(),
            None => WheelName::BOTH.map(WheelName::name).to_vec(),
        }
    }

    /// Number of the faults.
    pub fn fault_count(&self) -> usize {
        match self {
            Self::Pair(scenario) => scenario.faults.len(),
            Self::Gearbox(gearbox) => gearbox.faults.len(),
        }
    }

    /// Reads and validates either form.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    /// * `limit` - most memory that the simulation may need
    ///
    /// # Errors
    /// Those of [`Scenario::from_toml_within`] and [`Gearbox::from_toml_within`]; sections of both forms.
    pub fn from_toml_within(
        text: &str,
        files: &dyn ScenarioFiles,
        limit: MemoryLimit,
    ) -> Result<Self, ScenarioError> {
        if Gearbox::is_written_in(text)? {
            Gearbox::from_toml_within(text, files, limit).map(Self::Gearbox)
        } else {
            Scenario::from_toml_within(text, files, limit).map(Self::Pair)
        }
    }
}
