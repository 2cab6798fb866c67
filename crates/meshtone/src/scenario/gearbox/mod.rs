//! What the user asks for of a gearbox: the long form of the scenario file, of any number of shafts, wheels and meshes.

mod example;
mod layout;
mod parts;
mod places;
mod room;

pub use example::{GearboxRig, gearbox_template};
pub use layout::{GearboxLayout, Ratio};
pub use parts::{GearboxMesh, GearboxWheel};

use meshtone_toml::{ReadResult, TomlDocument, TomlError, TomlTable};

use super::from_toml::{Numbers, ScenarioFiles, located};
use super::validate::{DrivenSpeed, pitch_line_mm};
use super::{MemoryLimit, ScenarioError, ScenarioWarning, SectionDescription, WarningKind};
use crate::bearing::RollingParts;
use crate::damage::{Fault, check_faults};
use crate::keys::{
    KeyRow, Keys, NoFiles, NumberFiles, check_keys, check_rows, describe, describe_rows, field, read_keys,
    read_rows, row, write_keys, write_rows,
};
use crate::machine::{Bearing, GearboxShaft, Housing};
use crate::operation::{Operation, Solver, TimeGrid};
use crate::sensor::Sensor;
use crate::wheel::Material;
use crate::wheel::quality::{check_errors, one_source};
use layout::{entry_key, find, section};
pub(super) use parts::list;

/// Everything that a simulation of a gearbox depends on.
///
/// ```
/// use meshtone::scenario::{Gearbox, gearbox_template};
///
/// let gearbox = Gearbox::from_toml(&gearbox_template(None))?;
/// assert_eq!(gearbox.meshes[0].name(), "z1-z2");
/// assert_eq!(Gearbox::from_toml(&gearbox.to_toml())?, gearbox);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gearbox {
    /// Seed of every random draw.
    pub seed: u64,
    /// Seed of the wheels' deviations; none for that of everything else.
    pub wheels_seed: Option<u64>,
    /// Material of shafts and wheels. Default steel.
    pub material: Material,
    /// The shafts.
    pub shafts: Vec<GearboxShaft>,
    /// The wheels.
    pub wheels: Vec<GearboxWheel>,
    /// Which wheels mesh.
    pub meshes: Vec<GearboxMesh>,
    /// The bearings.
    pub bearings: Vec<Bearing>,
    /// The housing; none where the bearings' seats stand on the ground.
    pub housing: Option<Housing>,
    /// Speed and load.
    pub operation: Operation,
    /// Faults.
    pub faults: Vec<Fault>,
    /// Listed sensors; without one, a vertical one sits on every bearing's seat.
    pub sensors: Vec<Sensor>,
    /// Sampling and settling.
    pub solver: Solver,
}

/// The keys above the sections.
impl Keys for Gearbox {
    fn start() -> Self {
        Self {
            seed: 1,
            wheels_seed: None,
            material: Material::default(),
            shafts: Vec::new(),
            wheels: Vec::new(),
            meshes: Vec::new(),
            bearings: Vec::new(),
            housing: None,
            operation: Operation::start(),
            faults: Vec::new(),
            sensors: Vec::new(),
            solver: Solver::start(),
        }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row(
                "seed",
                "",
                "the seed of every random draw: deviations, fluctuations, sensors' noise",
                field!(seed),
            ),
            row("wheels_seed", "", "the seed of the wheels' deviations alone, for the same wheels with other noise and fluctuations", field!(wheels_seed))
                .otherwise("seed")
                .alternative("2"),
            row("material", "", "the material of shafts and wheels", field!(material)),
        ]
    }
}

/// Names of the sections that only a gearbox has.
const OF_GEARBOX: [&str; 5] = ["shaft", "wheel", "mesh", "bearing", "housing"];
/// Names of the sections that only a pair has.
const OF_PAIR: [&str; 3] = ["gears", "rig", "quality"];

impl Gearbox {
    /// A gearbox with every other key at its default.
    ///
    /// # Arguments
    /// * `shafts`, `wheels`, `meshes`, `bearings` - its parts
    /// * `operation` - speed and load
    pub fn new(
        shafts: Vec<GearboxShaft>,
        wheels: Vec<GearboxWheel>,
        meshes: Vec<GearboxMesh>,
        bearings: Vec<Bearing>,
        operation: Operation,
    ) -> Self {
        Self { shafts, wheels, meshes, bearings, operation, ..Self::start() }
    }

    /// Whether a text is the long form of a scenario file: it has a section that only a gearbox has, and none that only a pair has.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    ///
    /// # Errors
    /// Text that is not TOML; sections of both forms.
    pub fn is_written_in(text: &str) -> Result<bool, ScenarioError> {
        let document = TomlDocument::parse(text)?;
        Self::is_table(&document.root()).map_err(|error| document.locate(error).into())
    }

    /// Whether a table has the sections of a gearbox.
    pub(super) fn is_table(root: &TomlTable<'_>) -> ReadResult<bool> {
        let has = |names: &[&'static str]| names.iter().find(|name| root.has(name)).copied();
        match (has(&OF_GEARBOX), has(&OF_PAIR)) {
            (Some(gearbox), Some(pair)) => {
                let problem = format!(
                    "given beside {gearbox}: one pair has [gears] and [rig], a gearbox [[shaft]], [[wheel]] and [[mesh]]"
                );
                let error = TomlError::new(root.path_of(pair), "", problem);
                Err(error.with_help("remove the sections of one of the two forms"))
            }
            (gearbox, _) => Ok(gearbox.is_some()),
        }
    }

    /// The error of a gearbox where one pair of gears is expected.
    pub(crate) fn refused_as_pair() -> ScenarioError {
        let problem = "is of a gearbox, and one pair of gears, [gears], is expected here";
        ScenarioError::new("mesh", "", problem).with_help(
            "`meshtone simulate`, `indicators`, `path`, `diagnose`, `explore` and data sets accept \
             gearboxes; the models published and linear, and tuning, accept one pair only",
        )
    }

    /// Reads and validates a gearbox that names no other file.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    ///
    /// # Errors
    /// The first thing that is wrong, with its line.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        Self::read(text, &NoFiles, MemoryLimit::default())
    }

    /// Reads and validates a gearbox that may name other files.
    ///
    /// # Arguments
    /// * `text` - the scenario file's text
    /// * `files` - loads the files that the text names
    /// * `limit` - most memory that the simulation may need
    ///
    /// # Errors
    /// Those of [`Self::from_toml`], and what `files` reports.
    pub fn from_toml_within(
        text: &str,
        files: &dyn ScenarioFiles,
        limit: MemoryLimit,
    ) -> Result<Self, ScenarioError> {
        Self::read(text, &Numbers(files), limit)
    }

    fn read(text: &str, files: &dyn NumberFiles, limit: MemoryLimit) -> Result<Self, ScenarioError> {
        Self::is_written_in(text)?;
        let document = TomlDocument::parse(text)?;
        let gearbox = document.root().read(|root| Self::from_table(root, files))?;
        gearbox.validate_within(limit).map(|_| gearbox).map_err(|error| located(&document, error))
    }

    pub(super) fn from_table(root: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<Self> {
        let mut gearbox = Self::start();
        if let Some(model) = root.optional("model") {
            let name = model.string()?;
            if name != "contact" {
                return Err(model
                    .error("must be \"contact\" for a gearbox; the other models accept one pair only")
                    .with_help("remove model, or write one pair with [gears] and [rig]"));
            }
        }
        read_keys(&mut gearbox, root, files)?;
        gearbox.shafts = list(root, "shaft", files)?;
        gearbox.meshes = list(root, "mesh", files)?;
        let wheel = |table: &TomlTable<'_>| GearboxWheel::read(table, &gearbox.meshes, files);
        let wheels = root.tables("wheel")?.into_iter().map(|table| table.read(wheel));
        gearbox.wheels = wheels.collect::<Result<_, _>>()?;
        gearbox.bearings = list(root, "bearing", files)?;
        if root.optional("housing").is_some() {
            let mut housing = Housing::default();
            root.table_or_empty("housing")?.read(|table| read_keys(&mut housing, table, files))?;
            gearbox.housing = Some(housing);
        }
        let operation = Operation::rows_of_shafts();
        root.table_or_empty("operation")?
            .read(|table| read_rows(&operation, &mut gearbox.operation, table, files))?;
        gearbox.faults = faults(root)?;
        let sensor = |table: &TomlTable<'_>| {
            let mut sensor = Sensor::at_place("");
            read_rows(&Sensor::rows_of_shafts(), &mut sensor, table, files).map(|()| sensor)
        };
        gearbox.sensors =
            root.tables("sensor")?.into_iter().map(|table| table.read(sensor)).collect::<ReadResult<_>>()?;
        let solver = Solver::rows_of_shafts();
        root.table_or_empty("solver")?.read(|table| read_rows(&solver, &mut gearbox.solver, table, files))?;
        Ok(gearbox)
    }

    /// The gearbox as a scenario file that needs no other file, defaults explicitly.
    pub fn to_toml(&self) -> String {
        let mut sections = vec![write_keys(self)];
        let entries = |name: &str, texts: Vec<String>| -> Vec<String> {
            texts.into_iter().map(|text| format!("[[{name}]]\n{text}")).collect()
        };
        sections.extend(entries("shaft", self.shafts.iter().map(write_keys).collect()));
        sections.extend(entries("wheel", self.wheels.iter().map(write_keys).collect()));
        sections.extend(entries("mesh", self.meshes.iter().map(write_keys).collect()));
        sections.extend(entries("bearing", self.bearings.iter().map(write_keys).collect()));
        sections.extend(self.housing.iter().map(|housing| format!("[housing]\n{}", write_keys(housing))));
        sections.push(format!("[operation]\n{}", write_rows(&Operation::rows_of_shafts(), &self.operation)));
        sections.extend(entries("fault", self.faults.iter().map(Fault::write).collect()));
        let sensor = |sensor: &Sensor| write_rows(&Sensor::rows_of_shafts(), sensor);
        sections.extend(entries("sensor", self.sensors.iter().map(sensor).collect()));
        sections.push(format!("[solver]\n{}", write_rows(&Solver::rows_of_shafts(), &self.solver)));
        sections.join("\n")
    }

    /// Checks every value, alone and against the others.
    ///
    /// # Returns
    /// Warnings about a gearbox that can be simulated.
    ///
    /// # Errors
    /// The first value that is impossible, or certainly a mistake.
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
        check_keys(self, "")?;
        check_list("shaft", &self.shafts)?;
        check_list("wheel", &self.wheels)?;
        check_list("mesh", &self.meshes)?;
        check_list("bearing", &self.bearings)?;
        for (index, sensor) in self.sensors.iter().enumerate() {
            check_rows(&Sensor::rows_of_shafts(), sensor, "sensor")
                .map_err(|error| error.in_entry("sensor", index, self.sensors.len()))?;
        }
        if let Some(housing) = &self.housing {
            check_keys(housing, "housing")?;
        }
        check_rows(&Operation::rows_of_shafts(), &self.operation, "operation")?;
        check_rows(&Solver::rows_of_shafts(), &self.solver, "solver")?;
        self.check_counts()?;
        self.check_shafts()?;
        self.rolling_bearings()?;
        self.operation.check()?;
        self.check_length(limit)?;
        let layout = GearboxLayout::new(self)?;
        self.driven_speed(&layout).check()?;
        self.check_faults(&layout)?;
        self.check_quality(&layout)?;
        self.places(&layout)?;
        Ok(self.warnings(&layout))
    }

    fn check_counts(&self) -> Result<(), ScenarioError> {
        let counts = [
            ("shaft", self.shafts.len(), 2),
            ("wheel", self.wheels.len(), 2),
            ("mesh", self.meshes.len(), 1),
        ];
        if let Some((name, count, least)) = counts.into_iter().find(|(_, count, least)| count < least) {
            let problem = format!("there are {count} [[{name}]]; a gearbox has at least {least}");
            return Err(ScenarioError::new(name, "", problem).with_help("see `meshtone init gearbox`"));
        }
        let most = crate::solver::MOST_MESHES;
        if self.meshes.len() > most {
            let problem = format!("there are {} meshes; must be at most {most}", self.meshes.len());
            let error = ScenarioError::new("mesh", "", problem);
            return Err(error.with_help("leave out meshes that carry no load"));
        }
        Ok(())
    }

    /// What the rolling bearings are made of: each with its number.
    ///
    /// # Errors
    /// Those of [`Bearing::rolling`]; too many of them.
    pub(crate) fn rolling_bearings(&self) -> Result<Vec<(usize, RollingParts)>, ScenarioError> {
        let entries = self.bearings.len();
        let rolling = |(number, bearing): (usize, &Bearing)| match bearing.rolling() {
            Ok(parts) => parts.map(|parts| Ok((number, parts))),
            Err(error) => {
                let key = entry_key("bearing", number, entries, &error.key);
                Some(Err(ScenarioError { key, ..error }))
            }
        };
        let rolling: Vec<_> =
            self.bearings.iter().enumerate().filter_map(rolling).collect::<Result<_, _>>()?;
        let most = crate::solver::MOST_ROLLING_BEARINGS;
        if rolling.len() > most {
            let problem = format!("there are {} rolling bearings; must be at most {most}", rolling.len());
            return Err(ScenarioError::new("bearing", "", problem).with_help("let the others be linear"));
        }
        Ok(rolling)
    }

    fn check_shafts(&self) -> Result<(), ScenarioError> {
        let entries = self.shafts.len();
        for (index, shaft) in self.shafts.iter().enumerate() {
            let key = |name: &str| entry_key("shaft", index, entries, name);
            match (shaft.radius_mm, shaft.segments.is_empty()) {
                (None, true) => {
                    let problem = "missing, and it has no default; it is (mm) the shaft's radius, unless segments is given";
                    return Err(ScenarioError::new(key("radius_mm"), "", problem));
                }
                (Some(radius_mm), false) => {
                    let problem = "given beside segments, which have radii of their own";
                    return Err(ScenarioError::new(key("radius_mm"), radius_mm, problem)
                        .with_help("remove one of the two"));
                }
                _ => {}
            }
            let whole_mm: f64 = shaft.pieces_mm().iter().map(|[length_mm, _]| length_mm).sum();
            if (whole_mm / shaft.length_mm - 1.0).abs() > 1e-6 {
                let problem =
                    format!("add up to {whole_mm:?} mm; must be length_mm, {:?} mm", shaft.length_mm);
                return Err(ScenarioError::new(key("segments"), "", problem));
            }
            let thinnest_mm =
                shaft.pieces_mm().iter().map(|[_, radius_mm]| *radius_mm).fold(f64::INFINITY, f64::min);
            if shaft.bore_radius_mm >= thinnest_mm {
                let problem = format!("must be less than {thinnest_mm:?} mm, the shaft's least radius");
                return Err(ScenarioError::new(key("bore_radius_mm"), shaft.bore_radius_mm, problem));
            }
        }
        Ok(())
    }

    /// The kept signal has one length and at least two samples, and there is memory for it.
    fn check_length(&self, limit: MemoryLimit) -> Result<(), ScenarioError> {
        let settings = &self.solver;
        if let (Some(duration_s), Some(_)) = (settings.duration_s, settings.pinion_revolutions) {
            let problem = "given beside solver.input_revolutions; the length has only one source";
            return Err(ScenarioError::new("solver.duration_s", duration_s, problem)
                .with_help("remove one of the two"));
        }
        if let (Some(revolutions), Some(_)) = (settings.pinion_revolutions, &self.operation.speed_profile_hz)
        {
            let problem = "given with operation.speed_profile_hz, whose speeds vary";
            return Err(ScenarioError::new("solver.input_revolutions", revolutions, problem)
                .with_help("give solver.duration_s instead"));
        }
        let time = self.time_grid();
        // Time, force of each mesh, speed of each shaft and a sensor's signal, with what is made of them.
        let signals =
            4 * self.meshes.len() + 2 * self.shafts.len() + 2 * self.sensors.len().max(self.bearings.len());
        let bytes = (time.samples as u64).saturating_mul(8 * signals as u64);
        if let Some(objection) = limit.objection(bytes) {
            let key =
                if settings.duration_s.is_some() { "solver.duration_s" } else { "solver.sampling_rate_hz" };
            return Err(ScenarioError::new(key, "", objection)
                .with_help("simulate a shorter time, or at a lower rate; or raise the memory limit"));
        }
        if time.kept_samples() < 2 {
            let problem = "keeps less than two samples";
            let error = ScenarioError::new("solver.duration_s", "", problem);
            return Err(error.with_help("keep a longer signal"));
        }
        Ok(())
    }

    /// The faults, each with the number of its wheel.
    pub(crate) fn placed_faults(&self) -> Vec<(usize, &Fault)> {
        let number = |fault: &Fault| self.wheels.iter().position(|of| of.name == fault.wheel);
        self.faults.iter().filter_map(|fault| Some((number(fault)?, fault))).collect()
    }

    fn check_faults(&self, layout: &GearboxLayout) -> Result<(), ScenarioError> {
        let names: Vec<&str> = self.wheels.iter().map(|wheel| wheel.name.as_str()).collect();
        for (index, Fault { wheel, .. }) in self.faults.iter().enumerate() {
            let key = entry_key("fault", index, self.faults.len(), "wheel");
            find(&names, wheel, "wheel").map_err(|error| error.with_key(key))?;
        }
        for mesh in 0..self.meshes.len() {
            let (numbers, faults): (Vec<usize>, Vec<Fault>) =
                layout.faults_of_mesh(&self.placed_faults(), mesh).into_iter().unzip();
            check_faults(&faults, &numbers, self.faults.len(), &layout.named_gears(self, mesh))?;
        }
        Ok(())
    }

    fn check_quality(&self, layout: &GearboxLayout) -> Result<(), ScenarioError> {
        for (index, wheel) in self.wheels.iter().enumerate() {
            let section = section("wheel", index, self.wheels.len());
            // Every wheel is in a mesh, as the layout has checked.
            let module_mm = layout.mesh_of(index).map_or(f64::NAN, |(mesh, _)| layout.gears[mesh].module_mm);
            one_source(&section, wheel.din_grade, wheel.iso_class, wheel.profile_errors_mm.is_some())?;
            let pitches = format!("{section}.cumulative_pitch_um");
            wheel.deviations.check_pitches(&pitches, wheel.teeth, module_mm)?;
            if let Some(errors) = &wheel.profile_errors_mm {
                check_errors(&format!("{section}.profile_errors_mm"), errors, wheel.teeth, module_mm)?;
            }
        }
        Ok(())
    }

    /// What is doubtful about a gearbox that can be simulated.
    fn warnings(&self, layout: &GearboxLayout) -> Vec<ScenarioWarning> {
        const FAST_HZ: f64 = 100.0;
        const LONG_CYCLE: i64 = 1000;
        let (key, speed_hz) = self.driven_speed(layout).fastest();
        let ratios = layout.ratios.iter().map(|ratio| ratio.value().abs());
        let shafts = self.shafts.iter().zip(ratios.map(|ratio| ratio * speed_hz));
        let fastest = shafts.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, hz)| *hz > FAST_HZ);
        let fast = fastest.map(|(shaft, hz)| {
            let message = format!(
                "shaft {:?} turns at {hz:.1} rev/s: gyroscopic moments, which are neglected, shift natural \
                 frequencies by up to 2 % at 100 rev/s and by more above",
                shaft.name
            );
            ScenarioWarning::new(WarningKind::Gyroscopic, key, message)
        });
        let cycle = layout.cycle_revolutions();
        let time = self.time_grid();
        let long = (cycle > LONG_CYCLE).then(|| {
            let kept = time.kept_samples() as f64 / time.samples_per_pinion_revolution as f64;
            let message = format!(
                "the machine repeats after {cycle} revolutions of the input only; the kept signal covers {:.1} % of them",
                100.0 * kept / cycle as f64
            );
            ScenarioWarning::new(WarningKind::LongCycle, "solver.duration_s", message)
        });
        let of_teeth = layout.warnings_of_teeth(self);
        let wheels = self.wheels.len();
        let of_wheel = |number: usize| self.wheels[number].ignored_shares(&section("wheel", number, wheels));
        let of_shares = (0..wheels).flat_map(of_wheel);
        let ended = self.operation.ended_profiles(time.kept_from_s());
        let of_speed = self.driven_speed(layout).warnings();
        let of_teeth = of_teeth.into_iter().chain(layout.added_thrusts(self));
        of_teeth.chain(of_shares).chain(of_speed).chain(fast).chain(long).chain(ended).collect()
    }

    fn driven_speed(&self, layout: &GearboxLayout) -> DrivenSpeed<'_> {
        let pitch_lines_mm = layout.gears.iter().enumerate().map(|(mesh, gears)| {
            pitch_line_mm(gears.transverse_module_mm(), gears.pinion_teeth) * layout.driving_ratio(mesh).abs()
        });
        DrivenSpeed {
            operation: &self.operation,
            key: "operation.input_speed_hz",
            pitch_line_mm: pitch_lines_mm.fold(0.0, f64::max),
        }
    }

    /// Division of time: a whole number of samples per revolution of the input.
    pub fn time_grid(&self) -> TimeGrid {
        TimeGrid::of_input(&self.operation, &self.solver)
    }
}

/// The sections of a gearbox's scenario file, in order; of `fault` see [`super::sections`].
///
/// ```
/// let sections = meshtone::scenario::gearbox_sections();
/// assert!(sections.iter().any(|section| section.name == "mesh"));
/// ```
pub fn gearbox_sections() -> Vec<SectionDescription> {
    let section = |name, keys| SectionDescription { name, keys };
    vec![
        section("", describe::<Gearbox>()),
        section("shaft", describe::<GearboxShaft>()),
        section("wheel", describe::<GearboxWheel>()),
        section("mesh", describe::<GearboxMesh>()),
        section("bearing", describe::<Bearing>()),
        section("housing", describe::<Housing>()),
        section("operation", describe_rows(&Operation::rows_of_shafts(), &Operation::start(), "operation")),
        section("sensor", describe_rows(&Sensor::rows_of_shafts(), &Sensor::at_place(""), "sensor")),
        section("solver", describe_rows(&Solver::rows_of_shafts(), &Solver::start(), "solver")),
    ]
}

/// The faults of a table, on wheels of any names.
fn faults(table: &TomlTable<'_>) -> ReadResult<Vec<Fault>> {
    table.tables("fault")?.into_iter().map(|table| table.read(Fault::on_named_wheel)).collect()
}

/// Each key alone, of every entry of a list.
fn check_list<S: Keys>(name: &str, entries: &[S]) -> Result<(), ScenarioError> {
    let check = |(index, entry): (usize, &S)| {
        check_keys(entry, name).map_err(|error| error.in_entry(name, index, entries.len()))
    };
    entries.iter().enumerate().try_for_each(check)
}
