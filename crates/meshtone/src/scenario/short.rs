//! The short form of the file: one pair in a rig. Its sections `[gears]`, `[quality]` and `[rig]` are rows of keys that reach into the
//! two wheels, their mesh and the rig.

use meshtone_toml::{ReadResult, TomlTable};

use super::{
    ErrorKind, Fault, Model, Operation, Quality, Rig, Scenario, ScenarioMesh, ScenarioWheel, Sensor, Solver,
    Structure, long,
};
use crate::damage::keys_of_every_fault;
use crate::error_table::ErrorTable;
use crate::keys::{
    Field, KeyDescription, KeyKind, KeyRow, KeyValue, Keys, NumberFiles, Range, describe, describe_rows,
    documented, field, flatten, load, read_rows, row, rows, rows_of,
};
use crate::wheel::quality::{DEVIATION_KEYS, file_deviations};
use crate::wheel::rows::*;
use crate::wheel::{Material, WheelName};

/// The inertia of the brake of a rig.
const BRAKE_INERTIA_KGM2: f64 = 4.5e-3;
/// The damping of the mesh in a rig.
const MESH_DAMPING_RATIO: f64 = 0.15;

impl Scenario {
    /// The keys outside of all sections.
    fn rows_of_top_of_pair() -> Vec<KeyRow<Self>> {
        rows! {
            model ""
                "the model: teeth that touch and separate, a linear mesh that is always closed, or the published code with its known errors";
            seed ""
                "the seed of every random draw: profile errors, fluctuations, roughness of a destroyed flank, sensors' noise";
        }
    }

    fn rows_of_quality() -> Vec<KeyRow<Self>> {
        type Of = ScenarioWheel;
        let errors_row = |name| {
            row(
                name,
                "mm",
                "the profile errors, instead of a draw: 100 rows of one number a tooth",
                field!(in Of: profile_errors_mm),
            )
            .otherwise("none")
            .rule("100 × teeth, each below the module")
            .alternative("[ 100 rows of one number a tooth ]")
        };
        rows! {
            = { both(
                din_grade_row(
                    "the grade of DIN 3961 of the deviations, 1 (best) to 12; 0: ideal teeth",
                    field!(in Of: din_grade),
                )
                .range(Range::from_to(0.0, 12.0).message(
                    "must be a whole number from 0 to 12: a grade of DIN 3961, from 1 (best) to 12, or 0 for ideal teeth",
                )),
            ) };
            <wheels_seed> seed "" "the seed of the wheels alone, for several scenarios of the same wheels"
                .otherwise("the scenario's `seed`").alternative("2");
            = { both(
                row(
                    "iso_class",
                    "",
                    "the class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none",
                    field!(in Of: iso_class),
                )
                .range(Range::from_to(0.0, 11.0).message(
                    "must be a whole number from 0 to 11: a class of ISO 1328-1:2013, from 1 (best) to 11, or 0 for none",
                )),
            ) };
            .. { rows_of(&["tooth_share", "pitch_share", "run_out_share", "helix_share"]).into_iter().map(both) };
            = { documented(
                "errors_file",
                "an .npz with the profile errors, instead of a draw, as `meshtone wheels` writes it; its entries are the keys below",
                KeyKind::File,
            )
            .otherwise("none")
            .alternative("\"wheels.npz\"") };
            .. { [errors_row(ERROR_KEYS[0]).of(PINION), errors_row(ERROR_KEYS[1]).of(GEAR)] };
            .. { deviation_rows(DEVIATION_KEYS[0]).into_iter().map(|row| row.of(PINION)) };
            .. { deviation_rows(DEVIATION_KEYS[1]).into_iter().map(|row| row.of(GEAR)) };
        }
    }

    fn rows_of_rig() -> Vec<KeyRow<Self>> {
        type Of = ScenarioWheel;
        let mut of_rig = Rig::rows().into_iter().map(|row| row.of(RIG));
        let inertia = |name, example| {
            row(name, "", "the wheel's mass and inertias, any of the three", field!(in Of: inertia))
                .otherwise("those of a solid disc of pitch radius")
                .alternative(example)
        };
        let unbalance = |name| {
            row(name, "", "the unbalance of the wheel and its shaft", field!(in Of: unbalance))
                .otherwise("none")
                .alternative("{ g_mm = 50.0 }")
        };
        rows! {
            .. { of_rig.by_ref().take(2) };
            (operation) brake_inertia_kgm2 "kg m²" "the inertia of the brake"
                .range(Range::positive().implausible_above(1e9));
            .. { of_rig.by_ref().take(1) };
            = { both(
                row("eccentricity_mm", "mm", "the eccentricity of both wheels", field!(in Of: eccentricity_mm))
                    .range(Range::not_negative())
                    .rule("less than the module"),
            ) };
            = { misalignment_row(field!(in ScenarioMesh: misalignment_um)).of(MESH) };
            .. { of_rig.by_ref().take(2) };
            = { inertia(
                "pinion_inertia",
                "{ mass_kg = 0.24, polar_inertia_kgm2 = 7.8e-5, transverse_inertia_kgm2 = 4.4e-5 }",
            )
            .of(PINION) };
            = { inertia(
                "gear_inertia",
                "{ mass_kg = 1.20, polar_inertia_kgm2 = 1.95e-3, transverse_inertia_kgm2 = 1.0e-3 }",
            )
            .of(GEAR) };
            .. { [unbalance("pinion_unbalance").of(PINION), unbalance("gear_unbalance").of(GEAR)] };
            .. { of_rig };
            = { mesh_damping_row(field!(in ScenarioMesh: damping_ratio)).named("mesh_damping_ratio").of(MESH) };
        }
    }

    /// A pair with every key at its default, and those without one at whatever is refused.
    pub(super) fn start_of_rig() -> Self {
        let quality = Quality::default();
        let wheel = |name: &str| ScenarioWheel {
            tooth_share: quality.tooth_share,
            pitch_share: quality.pitch_share,
            run_out_share: quality.run_out_share,
            slope_wobble: quality.slope_wobble,
            ..ScenarioWheel::new(name, name, 0.5, 0, f64::NAN)
        };
        let names = WheelName::BOTH.map(WheelName::name);
        Self {
            model: Model::default(),
            seed: 1,
            wheels_seed: None,
            material: Material::default(),
            wheels: names.map(wheel).to_vec(),
            meshes: vec![ScenarioMesh {
                damping_ratio: MESH_DAMPING_RATIO,
                friction: 0.0,
                random_force: 0.0,
                ..ScenarioMesh::new(names, f64::NAN)
            }],
            structure: Structure::Rig(Rig::start()),
            operation: Operation { brake_inertia_kgm2: BRAKE_INERTIA_KGM2, ..Operation::start() },
            faults: Vec::new(),
            sensors: Vec::new(),
            solver: Solver::start(),
        }
    }
}

/// A section of the file whose keys are values of the scenario.
pub(super) struct Section {
    /// Its name; empty for the keys above the sections.
    pub(super) name: &'static str,
    /// Its keys.
    pub(super) rows: Vec<KeyRow<Scenario>>,
}

impl Section {
    /// Reads the section over what the scenario has.
    pub(super) fn read(
        &self,
        scenario: &mut Scenario,
        root: &TomlTable<'_>,
        files: &dyn NumberFiles,
    ) -> ReadResult<()> {
        if self.name.is_empty() {
            return read_rows(&self.rows, scenario, root, files);
        }
        root.table_or_empty(self.name)?.read(|table| {
            refuse_not_modelled(self.name, table)?;
            read_rows(&self.rows, scenario, table, files)
        })
    }

    /// Its keys, with the defaults of a scenario.
    pub(super) fn described(self, start: &Scenario) -> SectionDescription {
        SectionDescription { name: self.name, keys: describe_rows(&self.rows, start, self.name) }
    }
}

const PINION: Field<Scenario, ScenarioWheel> = Field::new(
    |scenario: &Scenario| scenario.wheels.first(),
    |scenario: &mut Scenario| scenario.wheels.first_mut(),
);
const GEAR: Field<Scenario, ScenarioWheel> = Field::new(
    |scenario: &Scenario| scenario.wheels.get(1),
    |scenario: &mut Scenario| scenario.wheels.get_mut(1),
);
const MESH: Field<Scenario, ScenarioMesh> = Field::new(
    |scenario: &Scenario| scenario.meshes.first(),
    |scenario: &mut Scenario| scenario.meshes.first_mut(),
);
const RIG: Field<Scenario, Rig> = Field::new(Scenario::rig, Scenario::rig_mut);

/// The row of a key of both wheels.
fn both(row: KeyRow<ScenarioWheel>) -> KeyRow<Scenario> {
    row.of_all::<Scenario>(|scenario| &scenario.wheels, |scenario| &mut scenario.wheels)
}

/// The rows of a key of both wheels, and of those of the pinion and of the gear alone, which state the wheels' values where they differ.
macro_rules! each {
    ($name:ident, $row:expr, $example:literal) => {{
        fn alike(scenario: &Scenario) -> &[ScenarioWheel] {
            let wheels = &scenario.wheels;
            let is_alike = |wheel: &ScenarioWheel| wheel.$name.write() == wheels[0].$name.write();
            if wheels.iter().all(is_alike) { wheels } else { &[] }
        }
        let own = |name, wheel| {
            let row = $row
                .named(name)
                .meaning("the value of this wheel alone, where they differ")
                .otherwise("that of both wheels");
            row.alternative($example).of::<Scenario>(wheel)
        };
        let [pinion, gear]: [Field<Scenario, ScenarioWheel>; 2] = [
            Field::new(|of| of.wheels.first().filter(|_| alike(of).is_empty()), |of| of.wheels.first_mut()),
            Field::new(|of| of.wheels.get(1).filter(|_| alike(of).is_empty()), |of| of.wheels.get_mut(1)),
        ];
        [
            $row.of_all(alike, |scenario| &mut scenario.wheels),
            own(concat!("pinion_", stringify!($name)), pinion),
            own(concat!("gear_", stringify!($name)), gear),
        ]
    }};
}

/// The keys above the sections.
pub(super) fn top() -> Section {
    Section { name: "", rows: Scenario::rows_of_top_of_pair() }
}

/// `[gears]`: the teeth of both wheels.
pub(super) fn gears() -> Section {
    type Of = ScenarioWheel;
    let material = |key| {
        row(key, "", "the material of this wheel alone, its body and teeth", field!(in Of: material))
            .otherwise("gears.material")
            .alternative("\"bronze\"")
    };
    let relief = "the relief of the flanks near the tips, as a gap in µm";
    let relief = || row("flank_relief", "", relief, field!(in Of: flank_relief));
    let mut rows = vec![
        module_row(field!(in ScenarioMesh: module_mm)).of(MESH),
        teeth_row("pinion_teeth", field!(in Of: teeth)).of(PINION),
        teeth_row("gear_teeth", field!(in Of: teeth)).of(GEAR),
        both(face_width_row("the face width of both wheels", field!(in Of: face_width_mm))),
        pressure_angle_row(field!(in ScenarioMesh: pressure_angle_deg)).of(MESH),
        helix_angle_row(field!(in ScenarioMesh: helix_angle_deg)).of(MESH),
        hand_row(
            "the hand of the pinion's helix; the gear's is the other one",
            field!(in ScenarioMesh: hand),
        )
        .of(MESH),
        lead_crowning_row(field!(in ScenarioMesh: lead_crowning_um)).of(MESH),
        end_relief_row(field!(in ScenarioMesh: end_relief)).of(MESH),
        slices_row(field!(in ScenarioMesh: slices)).of(MESH),
        profile_shift_row("pinion_profile_shift", field!(in Of: profile_shift)).of(PINION),
        profile_shift_row("gear_profile_shift", field!(in Of: profile_shift)).of(GEAR),
        addendum_row("pinion_addendum", field!(in Of: addendum)).of(PINION),
        addendum_row("gear_addendum", field!(in Of: addendum)).of(GEAR),
        dedendum_row("pinion_dedendum", field!(in Of: dedendum)).of(PINION),
        dedendum_row("gear_dedendum", field!(in Of: dedendum)).of(GEAR),
        centre_distance_row(field!(in ScenarioMesh: centre_distance_mm)).of(MESH),
        row("material", "", "the material of wheels and shafts", field!(in Scenario: material)),
        material("pinion_material").of(PINION),
        material("gear_material").of(GEAR),
    ];
    rows.extend(each!(flank_relief, relief(), "{ amount_um = 20.0 }"));
    rows.extend(each!(tip_chamfer_mm, chamfer_row(field!(in Of: tip_chamfer_mm)), "0.69"));
    rows.extend([
        both(shortening_row(field!(in Of: active_profile_shortening))),
        backlash_row(field!(in ScenarioMesh: backlash_mm)).of(MESH),
        both(flank_reduction_row(field!(in Of: uniform_flank_reduction_mm))),
        points_row(field!(in ScenarioMesh: points_per_tooth)).of(MESH),
        foundation_row(field!(in ScenarioMesh: foundation)).of(MESH),
    ]);
    Section { name: "gears", rows }
}

/// `[operation]`: speed and load.
pub(super) fn operation() -> Section {
    Section { name: "operation", rows: flatten(field!(in Scenario: operation)).collect() }
}

/// The rows of a wheel's deviations that are given beside the profiles.
fn deviation_rows([pitch, run_out, phase, helix]: [&'static str; 4]) -> Vec<KeyRow<ScenarioWheel>> {
    let pitches = row(
        pitch,
        "µm",
        "the working flanks' cumulative pitch deviations along the pitch circle, positive where \
         metal is added; they are added to given profile errors",
        field!(in ScenarioWheel: deviations.cumulative_pitch_um),
    )
    .otherwise("drawn, or none beside given profile errors")
    .rule("one a tooth, each below the module")
    .alternative("[ one number a tooth ]");
    let names = [
        (run_out, "drawn, or none beside given profile errors or pitches, which contain it"),
        (phase, "drawn, or 0 beside given profile errors"),
        (helix, "drawn, or none beside given profile errors"),
    ];
    let of_wheel = rows_of(&["run_out_um", "run_out_phase_rad", "helix_slope_um"]).into_iter().zip(names);
    let others = of_wheel
        .map(|(row, (name, otherwise)): (KeyRow<ScenarioWheel>, _)| row.named(name).otherwise(otherwise));
    [pitches].into_iter().chain(others).collect()
}

const ERROR_KEYS: [&str; 2] = ["pinion_profile_errors_mm", "gear_profile_errors_mm"];

/// `[quality]`: how well both wheels are made.
pub(super) fn quality() -> Section {
    Section { name: "quality", rows: Scenario::rows_of_quality() }
}

/// `[rig]`: bearings, shafts, brake and wheel bodies.
pub(super) fn rig() -> Section {
    Section { name: "rig", rows: Scenario::rows_of_rig() }
}

/// `[solver]`: sampling, length, settling and initial state.
pub(super) fn solver() -> Section {
    Section { name: "solver", rows: flatten(field!(in Scenario: solver)).collect() }
}

/// Reads one pair.
pub(super) fn read(root: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<Scenario> {
    let mut scenario = Scenario::start_of_rig();
    top().read(&mut scenario, root, files)?;
    gears().read(&mut scenario, root, files)?;
    operation().read(&mut scenario, root, files)?;
    scenario.operation.complete();
    root.table_or_empty("quality")?.read(|table| {
        read_errors_file(&mut scenario.wheels, table, files)?;
        read_rows(&quality().rows, &mut scenario, table, files)
    })?;
    scenario.faults = Fault::list_from_table(root)?;
    rig().read(&mut scenario, root, files)?;
    scenario.sensors = long::list(root, "sensor", files)?;
    solver().read(&mut scenario, root, files)?;
    Ok(scenario)
}

/// Profile errors from a file; those of the two inline keys are given both or not at all.
fn read_errors_file(
    wheels: &mut [ScenarioWheel],
    table: &TomlTable<'_>,
    files: &dyn NumberFiles,
) -> ReadResult<()> {
    let file = table.optional("errors_file");
    let [pinion, gear] = ERROR_KEYS.map(|key| table.optional(key));
    match (file, pinion, gear) {
        (None, None, None) | (None, Some(_), Some(_)) => Ok(()),
        (Some(file), None, None) => {
            let errors: [ErrorTable; 2] = load(&file, |name| files.matrices(name))?;
            let deviations = file_deviations(table, &file, files, Some)?;
            for ((wheel, errors), deviations) in wheels.iter_mut().zip(errors).zip(deviations) {
                (wheel.profile_errors_mm, wheel.deviations) = (Some(errors), deviations);
            }
            Ok(())
        }
        (Some(_), _, _) => Err(table
            .error("errors_file", "given beside inline profile errors; they have only one source")
            .with_help("remove errors_file, or pinion_profile_errors_mm and gear_profile_errors_mm")),
        (None, pinion, _) => {
            let missing = if pinion.is_some() { ERROR_KEYS[1] } else { ERROR_KEYS[0] };
            let problem = "missing; profile errors are given for both wheels or for neither";
            Err(table.error(missing, problem))
        }
    }
}

/// Keys that users may expect, and what is said of them: names of former versions, and what is not modelled.
const NOT_MODELLED: [(&str, &str, &str); 7] = [
    (
        "gears",
        "crowning_mm",
        "is now called uniform_flank_reduction_mm: it is a constant reduction of the whole flank; lead crowning is lead_crowning_um",
    ),
    ("gears", "profile_crowning_um", "is not modelled: flank_relief relieves the profile's ends"),
    ("gears", "internal", "is not modelled: both wheels are external gears"),
    ("gears", "shaft_angle_deg", "is not modelled: the shafts are parallel"),
    ("gears", "rim_thickness_mm", "is not modelled: the wheels' bodies are solid"),
    ("operation", "temperature_c", "is not modelled: heat and oil are not simulated"),
    ("operation", "oil_viscosity_mm2_per_s", "is not modelled: heat and oil are not simulated"),
];

fn refuse_not_modelled(section: &str, table: &TomlTable<'_>) -> ReadResult<()> {
    let of_section = NOT_MODELLED.iter().filter(|(of, ..)| *of == section);
    match of_section.map(|(_, key, problem)| (*key, *problem)).find(|(key, _)| table.has(key)) {
        Some((key, problem)) => Err(table.error(key, problem).of_kind(ErrorKind::UnknownKey)),
        None => Ok(()),
    }
}

/// A section of the scenario file, for documentation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SectionDescription {
    /// Its name; empty for the keys above the sections.
    pub name: &'static str,
    /// Its keys; of `fault`, those of every kind of damage beside `kind`.
    pub keys: Vec<KeyDescription>,
}
/// The sections of the scenario file of one pair, in order; of a gearbox's see [`gearbox_sections`](super::gearbox_sections).
///
/// ```
/// let sections = meshtone::scenario::sections();
/// let gears = sections.iter().find(|section| section.name == "gears").unwrap();
/// let module = &gears.keys[0];
/// assert_eq!((module.key.as_str(), module.unit, module.required), ("module_mm", "mm", true));
/// assert_eq!(module.allowed, "> 0, ≤ 100");
/// ```
pub fn sections() -> Vec<SectionDescription> {
    let start = Scenario::start_of_rig();
    let of = |section: Section| section.described(&start);
    let section = |name, keys| SectionDescription { name, keys };
    vec![
        of(top()),
        of(gears()),
        of(operation()),
        of(quality()),
        section("fault", keys_of_every_fault()),
        of(rig()),
        section("sensor", describe::<Sensor>()),
        of(solver()),
    ]
}
