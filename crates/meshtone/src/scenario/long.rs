//! The long form of the file: any number of shafts, wheels and meshes.

use meshtone_toml::{ReadResult, TomlError, TomlTable};

use super::short::Section;
use super::to_toml::Style;
use super::{
    Fault, Material, Model, Operation, PlanetarySet, Scenario, ScenarioMesh, ScenarioWheel,
    SectionDescription, Sensor, SensorDirection, Shafts, Solver, Structure,
};
use crate::keys::{KeyRow, Keys, NumberFiles, describe, describe_rows, field, read_keys, read_rows, rows};
use crate::machine::{Bearing, GearboxShaft, Housing};

/// Names of the sections that only shafts of beams have.
const OF_SHAFTS: [&str; 6] = ["shaft", "wheel", "mesh", "planetary", "bearing", "housing"];
/// Names of the sections that only a rig has.
const OF_RIG: [&str; 3] = ["gears", "rig", "quality"];

/// Whether a table has the sections of the long form.
pub(super) fn is_written_in(root: &TomlTable<'_>) -> ReadResult<bool> {
    let has = |names: &[&'static str]| names.iter().find(|name| root.has(name)).copied();
    match (has(&OF_SHAFTS), has(&OF_RIG)) {
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

/// The keys above the sections.
pub(super) fn top() -> Section {
    Section { name: "", rows: Scenario::rows_of_top() }
}

/// `[operation]`: speed and load.
pub(super) fn operation() -> Section {
    let rows = Operation::rows_of_shafts().into_iter().map(|row| row.of(field!(in Scenario: operation)));
    Section { name: "operation", rows: rows.collect() }
}

/// `[solver]`: sampling, length and settling.
pub(super) fn solver() -> Section {
    let rows = Solver::rows_of_shafts().into_iter().map(|row| row.of(field!(in Scenario: solver)));
    Section { name: "solver", rows: rows.collect() }
}

/// Reads shafts of beams with their wheels.
pub(super) fn read(root: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<Scenario> {
    let mut scenario = Scenario::start_of_shafts();
    if let Some(model) = root.optional("model") {
        let name = model.string()?;
        if name != Model::Contact.name() {
            return Err(model
                .error("must be \"contact\" for a gearbox; the other models accept one pair only")
                .with_help("remove model, or write one pair with [gears] and [rig]"));
        }
    }
    top().read(&mut scenario, root, files)?;
    let shafts = list(root, "shaft", files)?;
    scenario.meshes = list(root, "mesh", files)?;
    let wheel = |table: &TomlTable<'_>| ScenarioWheel::read(table, &scenario.meshes, files);
    let wheels = root.tables("wheel")?.into_iter().map(|table| table.read(wheel));
    scenario.wheels = wheels.collect::<ReadResult<_>>()?;
    let bearings = list(root, "bearing", files)?;
    let mut housing = root.optional("housing").map(|_| Housing::default());
    if let Some(housing) = &mut housing {
        root.table_or_empty("housing")?.read(|table| read_keys(housing, table, files))?;
    }
    let planetary = list(root, "planetary", files)?;
    scenario.structure = Structure::Shafts(Shafts { shafts, bearings, housing, planetary });
    operation().read(&mut scenario, root, files)?;
    scenario.operation.complete();
    let faults = root.tables("fault")?.into_iter().map(|table| table.read(Fault::on_named_wheel));
    scenario.faults = faults.collect::<ReadResult<_>>()?;
    let sensor = |table: &TomlTable<'_>| {
        let mut sensor = Sensor::at_place("");
        // On a ring that is what most sensors measure.
        if table.optional("at").is_some_and(|at| at.string().is_ok_and(|at| at.starts_with("ring:"))) {
            sensor.direction = SensorDirection::Radial;
        }
        read_rows(&Sensor::rows_of_shafts(), &mut sensor, table, files).map(|()| sensor)
    };
    scenario.sensors =
        root.tables("sensor")?.into_iter().map(|table| table.read(sensor)).collect::<ReadResult<_>>()?;
    solver().read(&mut scenario, root, files)?;
    Ok(scenario.with_members())
}

impl Scenario {
    fn rows_of_top() -> Vec<KeyRow<Self>> {
        rows! {
            seed "" "the seed of every random draw: deviations, fluctuations, sensors' noise";
            wheels_seed ""
                "the seed of the wheels' deviations alone, for the same wheels with other noise and fluctuations"
                .otherwise("seed").alternative("2");
            material "" "the material of shafts and wheels";
        }
    }

    /// Shafts of beams without any, and every other key at its default.
    pub(super) fn start_of_shafts() -> Self {
        Self {
            model: Model::Contact,
            seed: 1,
            wheels_seed: None,
            material: Material::default(),
            wheels: Vec::new(),
            meshes: Vec::new(),
            structure: Structure::Shafts(Shafts::default()),
            operation: Operation::start(),
            faults: Vec::new(),
            sensors: Vec::new(),
            solver: Solver::start(),
        }
    }

    /// The text of a file, each section in its own style.
    pub(super) fn in_long_sections(
        &self,
        Shafts { shafts, bearings, housing, planetary }: &Shafts,
        style: &impl Style,
    ) -> String {
        fn entries<S: Keys>(entries: &[S], style: &impl Style) -> Vec<String> {
            let keys = |entry| style.keys(&S::rows(), entry, &S::start(), S::SECTION);
            entries.iter().map(|entry| format!("[[{}]]\n{}", S::SECTION, keys(entry))).collect()
        }
        let start = Self::start_of_shafts();
        let keys = |Section { name, rows }: Section| style.keys(&rows, self, &start, name);
        let section = |of: Section| {
            let name = of.name;
            format!("[{name}]\n{}", keys(of))
        };
        let (rows, start_of_sensor) = (Sensor::rows_of_shafts(), Sensor::at_place(""));
        let sensor =
            |of: &Sensor| format!("[[sensor]]\n{}", style.keys(&rows, of, &start_of_sensor, "sensor"));
        let housing = housing.iter().map(|of| {
            format!("[housing]\n{}", style.keys(&Housing::rows(), of, &Housing::start(), "housing"))
        });
        [
            vec![keys(top())],
            entries(shafts, style),
            entries(&self.wheels[..self.own_wheels()], style),
            entries(&self.meshes[..self.own_meshes()], style),
            entries(planetary, style),
            entries(bearings, style),
            housing.collect(),
            vec![section(operation())],
            self.faults.iter().map(|fault| format!("[[fault]]\n{}", fault.write())).collect(),
            self.sensors.iter().map(sensor).collect(),
            vec![section(solver())],
        ]
        .concat()
        .join("\n")
    }
}

/// The sections of a gearbox's scenario file, in order; of `fault` see [`super::sections`].
///
/// ```
/// let sections = meshtone::scenario::gearbox_sections();
/// assert!(sections.iter().any(|section| section.name == "mesh"));
/// ```
pub fn gearbox_sections() -> Vec<SectionDescription> {
    let start = Scenario::start_of_shafts();
    let of = |section: Section| section.described(&start);
    let section = |name, keys| SectionDescription { name, keys };
    let sensor: Vec<KeyRow<Sensor>> = Sensor::rows_of_shafts();
    vec![
        of(top()),
        section("shaft", describe::<GearboxShaft>()),
        section("wheel", describe::<ScenarioWheel>()),
        section("mesh", describe::<ScenarioMesh>()),
        section("planetary", describe::<PlanetarySet>()),
        section("bearing", describe::<Bearing>()),
        section("housing", describe::<Housing>()),
        of(operation()),
        section("sensor", describe_rows(&sensor, &Sensor::at_place(""), "sensor")),
        of(solver()),
    ]
}

/// Reads a list of sections of a name.
pub(super) fn list<S: Keys>(
    table: &TomlTable<'_>,
    name: &'static str,
    files: &dyn NumberFiles,
) -> ReadResult<Vec<S>> {
    let read = |table: &TomlTable<'_>| {
        let mut section = S::start();
        read_keys(&mut section, table, files).map(|()| section)
    };
    table.tables(name)?.into_iter().map(|table| table.read(read)).collect()
}
