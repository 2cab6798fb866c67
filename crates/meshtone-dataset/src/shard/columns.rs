//! Columns of a data set.

use meshtone::damage::Damage;
use meshtone::scenario::Model;
use meshtone::sensor::Channel;
use meshtone::signal::OCTAVES;
use meshtone_io::table::{CellType, TableColumn};

use crate::draw::{NOISE_KEYS, PATH_KEYS, is_of_plan};
use crate::plan::Plan;
use crate::words::unit_of;

/// Name of the column of codes.
pub(crate) const WARNINGS: &str = "warnings";
/// What stands between two codes in it.
pub(crate) const BETWEEN_CODES: &str = ";";

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, with its unit at the end where it has one.
    pub name: String,
    /// Unit; `-` for plain numbers, empty for text.
    pub unit: String,
    /// Meaning.
    pub description: String,
    /// What it holds.
    pub kind: ColumnKind,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnKind {
    /// Number of the record.
    Record,
    /// Number of the unit.
    Unit,
    /// Number of the mounting.
    Mounting,
    /// How far its run has come.
    Age,
    /// What is left of its run.
    Remaining,
    /// Whether its run was stopped before failure.
    Censored,
    /// Simulated time.
    SimulatedTime,
    /// Values in a revolution of the raw channels.
    PointsPerRevolution,
    /// Rms of an octave of mesh orders, by its number in the list of octaves.
    OctaveRms(usize),
    /// Kurtosis of an octave, likewise.
    OctaveKurtosis(usize),
    /// Name of the split.
    Split,
    /// The label.
    Label,
    /// Grade of the fault.
    Severity,
    /// What the grade was taken from.
    SeverityMeasure,
    /// Kind of a fault, by the fault's number.
    FaultKind(usize),
    /// Wheel that a fault is on, by the fault's number.
    FaultWheel(usize),
    /// Number of the damaged tooth, by the fault's number.
    FaultTooth(usize),
    /// How severe a fault is, by the fault's number.
    FaultSeverity(usize),
    /// Part of the flank that pits take, by the fault's number.
    FaultArea(usize),
    /// Seed of the record.
    Seed,
    /// Seed of the unit's profile errors.
    WheelsSeed,
    /// Sampling rate of the raw channels.
    SamplingRate,
    /// Angle of the gear at the first sample.
    GearAngle,
    /// Teeth of the pinion.
    PinionTeeth,
    /// Teeth of the gear.
    GearTeeth,
    /// Speed of the pinion's shaft.
    PinionSpeed,
    /// Speed of the gear's shaft.
    GearSpeed,
    /// Brake torque.
    BrakeTorque,
    /// Codes of what is doubtful.
    Warnings,
    /// Part of the time in which the teeth do not push.
    SlackFraction,
    /// A varied key of the scenario file.
    Key(String),
    /// An indicator, by its name.
    Indicator(String),
    /// A raw channel, by its number.
    Channel(usize),
    /// Synchronous average.
    Average,
    /// Difference signal.
    Difference,
    /// Enhanced difference signal.
    EnhancedDifference,
}

impl ColumnKind {
    /// Whether the column holds a signal.
    pub fn is_signal(&self) -> bool {
        matches!(self, Self::Channel(_) | Self::Average | Self::Difference | Self::EnhancedDifference)
    }

    fn cells(&self) -> CellType {
        match self {
            Self::Record | Self::Unit | Self::Mounting | Self::Seed | Self::WheelsSeed => CellType::Int64,
            Self::Split | Self::Label | Self::FaultKind(_) | Self::FaultWheel(_) | Self::Warnings => {
                CellType::Text
            }
            Self::Severity
            | Self::FaultTooth(_)
            | Self::PinionTeeth
            | Self::GearTeeth
            | Self::Censored
            | Self::PointsPerRevolution => CellType::Int32,
            kind if kind.is_signal() => CellType::Float32List { nullable_items: false },
            _ => CellType::Float64,
        }
    }

    fn is_nullable(&self) -> bool {
        matches!(
            self,
            Self::SeverityMeasure
                | Self::FaultKind(_)
                | Self::FaultWheel(_)
                | Self::FaultTooth(_)
                | Self::FaultSeverity(_)
                | Self::FaultArea(_)
                | Self::Key(_)
                | Self::Indicator(_)
                | Self::OctaveRms(_)
                | Self::OctaveKurtosis(_)
                | Self::Age
                | Self::Remaining
                | Self::Censored
        )
    }
}

/// The columns of a plan's data set: what a record is, its varied keys, its indicators, its signals.
///
/// # Arguments
/// * `plan` - the plan
pub fn columns(plan: &Plan) -> Vec<Column> {
    let classes = &plan.content.classes;
    let keep = &plan.content.keep;
    let wheel = keep.wheel.name();
    let most_faults = classes.iter().map(|class| class.faults.len()).max().unwrap_or(0);
    let is_pits = |number: usize| {
        classes.iter().any(|class| {
            class.faults.get(number).is_some_and(|fault| matches!(fault.damage, Damage::Pits(_)))
        })
    };
    let mut columns = of_record(most_faults, is_pits);
    if classes.iter().any(|class| class.growth.is_some()) {
        columns.extend(of_run());
    }
    if keep.over_angle.is_some() {
        let meaning = format!("values in a revolution of the {wheel}, of channels, average and difference");
        columns.push(column("points_per_revolution", "", &meaning, ColumnKind::PointsPerRevolution));
    }
    columns.extend(of_simulation(plan.content.base.model));
    let taken: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
    columns
        .extend(varied_keys(plan).into_iter().map(key_column).filter(|column| !taken.contains(&column.name)));
    if keep.indicators {
        columns.extend(indicator_names().into_iter().map(|(name, unit)| Column {
            name: if unit == "g" { format!("{name}_g") } else { name.clone() },
            description: format!("indicator {name} of the analysed channel over the {wheel}'s revolutions"),
            unit,
            kind: ColumnKind::Indicator(name),
        }));
        columns.extend(OCTAVES.iter().enumerate().flat_map(|(number, (name, _))| of_octave(number, name)));
    }
    let channel = |(number, kind): (usize, &Channel)| Column {
        name: kind.name().into_owned(),
        unit: kind.unit().to_owned(),
        description: match keep.over_angle {
            None => format!("raw channel, its samples one after the other: {}", kind.meaning()),
            Some(angle) => format!(
                "raw channel over {} revolutions of the {wheel}, at equal angles: {}",
                angle.revolutions,
                kind.meaning()
            ),
        },
        kind: ColumnKind::Channel(number),
    };
    columns.extend(keep.channels.iter().enumerate().map(channel));
    let mut signal = |wanted: bool, name: &str, unit: &str, description: &str, kind: ColumnKind| {
        if wanted {
            columns.push(column(name, unit, description, kind));
        }
    };
    let turn = format!(
        "over one revolution of the {wheel}, at equal angles from where its tooth 1 comes into contact"
    );
    signal(keep.average, "average_g", "g", &format!("synchronous average {turn}"), ColumnKind::Average);
    signal(
        keep.difference,
        "difference_g",
        "g",
        &format!("difference signal {turn}"),
        ColumnKind::Difference,
    );
    let enhanced = "enhanced difference signal over one revolution of the gear, the fault's response in the middle, \
                    over the rms of the enhanced healthy signal";
    let wanted = plan.content.tuned.is_some();
    signal(wanted, "enhanced_relative_difference", "-", enhanced, ColumnKind::EnhancedDifference);
    columns
}

impl From<&Column> for TableColumn {
    fn from(column: &Column) -> Self {
        let mut metadata = vec![("unit", &column.unit), ("description", &column.description)];
        if let ColumnKind::Key(key) = &column.kind {
            metadata.push(("key", key));
        }
        Self {
            name: column.name.clone(),
            cells: column.kind.cells(),
            nullable: column.kind.is_nullable(),
            metadata: metadata.into_iter().map(|(key, value)| (key.to_owned(), value.clone())).collect(),
        }
    }
}

fn column(name: &str, unit: &str, description: &str, kind: ColumnKind) -> Column {
    Column { name: name.to_owned(), unit: unit.to_owned(), description: description.to_owned(), kind }
}

fn of_record(most_faults: usize, is_pits: impl Fn(usize) -> bool) -> Vec<Column> {
    use ColumnKind::*;
    let mut columns = vec![
        column("record", "", "number of the record; with the plan it determines everything else", Record),
        column("unit", "", "number of the unit: the pair of wheels, shared by several records", Unit),
        column("mounting", "", "number of the mounting: a unit as it was put together once", Mounting),
        column("split", "", "the split that the unit, or its mounting, belongs to", Split),
        column("label", "", "the class", Label),
        column("severity", "", "grade of the fault, from 1; 0 for healthy", Severity),
        column("severity_measure", "-", "the number that the grade was taken from", SeverityMeasure),
    ];
    // Also where every class is healthy: all data sets have the columns of one fault.
    for number in 0..most_faults.max(1) {
        columns.extend(of_fault(number));
        if is_pits(number) {
            let name = format!("{}_area_percent", name_in_list("fault", number));
            let meaning = "part of the flank's contact part that the pits take, of the worst tooth";
            columns.push(column(&name, "%", meaning, FaultArea(number)));
        }
    }
    columns.extend([
        column("seed", "", "seed of the record's noise and fluctuations", Seed),
        column("wheels_seed", "", "seed of the unit's profile errors", WheelsSeed),
        column("sampling_rate_hz", "Hz", "sampling rate of the raw channels", SamplingRate),
        column(
            "gear_angle_rev",
            "rev",
            "angle of the gear at the first sample, from where its tooth 1 comes into contact",
            GearAngle,
        ),
        column("pinion_teeth", "", "teeth of the pinion, the driving wheel", PinionTeeth),
        column("gear_teeth", "", "teeth of the gear, the driven wheel", GearTeeth),
        column("pinion_speed_hz", "Hz", "speed of the pinion's shaft", PinionSpeed),
        column("gear_speed_hz", "Hz", "speed of the gear's shaft", GearSpeed),
        column("brake_torque_nm", "N m", "brake torque on the gear's shaft", BrakeTorque),
    ]);
    columns
}

/// What its simulation says of itself.
fn of_simulation(model: Model) -> [Column; 3] {
    let codes = "codes of what is doubtful about the simulation, with `;` between; empty where nothing is";
    let (name, slack) = if model == Model::Contact {
        ("apart_fraction", "part of the simulated time in which no teeth touch")
    } else {
        (
            "tension_fraction",
            "part of the simulated time in which the linear mesh pulls where real teeth would part",
        )
    };
    [
        column(WARNINGS, "", codes, ColumnKind::Warnings),
        column(name, "-", slack, ColumnKind::SlackFraction),
        column(
            "simulated_s",
            "s",
            "simulated time that average and indicators are of",
            ColumnKind::SimulatedTime,
        ),
    ]
}

/// Where a record is in its unit's run to failure.
fn of_run() -> [Column; 3] {
    let left = "turns of the damaged wheel to failure; where `censored` is 1 to the end of the run, at least so many were left";
    [
        column("age_rev", "rev", "turns of the damaged wheel since its run began", ColumnKind::Age),
        column("remaining_rev", "rev", left, ColumnKind::Remaining),
        column("censored", "", "1 where the run was stopped before failure, else 0", ColumnKind::Censored),
    ]
}

/// What the difference signal has in an octave.
fn of_octave(number: usize, name: &str) -> [Column; 2] {
    let octave = format!(
        "of the difference signal in the octave around {name} mesh order{}",
        if number > 1 { "s" } else { "" }
    );
    [
        column(
            &format!("difference_octave_{name}_rms_g"),
            "g",
            &format!("rms {octave}; null beyond 0.8 of half the sampling rate"),
            ColumnKind::OctaveRms(number),
        ),
        column(
            &format!("difference_octave_{name}_kurtosis"),
            "-",
            &format!("kurtosis {octave}; likewise"),
            ColumnKind::OctaveKurtosis(number),
        ),
    ]
}

/// Kind, place and severity of a fault.
fn of_fault(number: usize) -> [Column; 4] {
    let fault = name_in_list("fault", number);
    let named = |last: &str, description: &str, kind: ColumnKind| {
        let unit = if last == "severity" { "-" } else { "" };
        column(&format!("{fault}_{last}"), unit, description, kind)
    };
    let tooth = "number of the damaged tooth, from 1, in the order in which its wheel's teeth come into contact from the \
                 start of the record on, null where it is several; in the plan and the scenario teeth are counted from where the \
                 first two meet";
    [
        named("kind", "kind of damage", ColumnKind::FaultKind(number)),
        named("wheel", "the damaged wheel: pinion or gear", ColumnKind::FaultWheel(number)),
        named("tooth", tooth, ColumnKind::FaultTooth(number)),
        named(
            "severity",
            "how severe the damage is, from 0, none, to 1, the largest that the tooth allows; each kind's scale is in the guide",
            ColumnKind::FaultSeverity(number),
        ),
    ]
}

/// What the columns of an entry of a list begin with: `fault`, and of further ones `fault_2` and so on.
fn name_in_list(list: &str, number: usize) -> String {
    if number == 0 { list.to_owned() } else { format!("{list}_{}", number + 1) }
}

/// The varied keys, in the plan's order; one of those that are in the same column.
fn varied_keys(plan: &Plan) -> Vec<&str> {
    let rules = plan.content.rules.iter().chain(plan.content.classes.iter().flat_map(|class| &class.rules));
    let mut keys: Vec<&str> = Vec::new();
    for key in rules.flat_map(|rule| &rule.keys) {
        if !keys.iter().any(|other| column_name(other) == column_name(key)) {
            keys.push(key);
        }
    }
    keys
}

fn key_column(key: &str) -> Column {
    let name = column_name(key);
    let unit = unit_of(&name).to_owned();
    let of_plan = NOISE_KEYS.iter().chain(&PATH_KEYS).position(|other| *other == key);
    let description = match of_plan {
        Some(0) => "signal-to-noise ratio of the added noise".to_owned(),
        Some(1) => "standard deviation of the added noise".to_owned(),
        Some(2) => "gain of the path to the sensor".to_owned(),
        Some(_) => {
            "standard deviation over frequency of the gain of the path to the sensor, its mounting's own"
                .to_owned()
        }
        None if is_of_plan(key) => format!("{key} of the plan, which other keys depend on"),
        None if is_tooth(key) => format!(
            "{key} of the scenario, from 1: the same tooth counted from where the scenario's first teeth meet, as the plan \
             and `meshtone dataset scenario` have it"
        ),
        None => format!("{key} of the scenario"),
    };
    Column { name, unit, description, kind: ColumnKind::Key(key.to_owned()) }
}

/// Name of a varied key's column: without its section, unless that is a fault, a sensor or one of the plan's own.
pub(crate) fn column_name(key: &str) -> String {
    let name = match key.split_once('.') {
        Some(("fault" | "noise" | "path" | "latent" | "sensor", _)) | None => key.to_owned(),
        Some((section, rest)) => {
            let numbered = |list| Some(name_in_list(list, number_in(section, list)?));
            let entry = ["fault", "sensor"].into_iter().find_map(numbered);
            entry.map_or_else(|| rest.to_owned(), |entry| [&entry, rest].join("_"))
        }
    };
    let name = name.replace('.', "_");
    // `fault_tooth` counts from the record's start.
    if is_tooth(key) { format!("{name}_of_scenario") } else { name }
}

/// Whether a key is the number of a damaged tooth.
fn is_tooth(key: &str) -> bool {
    key.split_once('.').is_some_and(|(section, last)| {
        last == "tooth" && (section == "fault" || number_in(section, "fault").is_some())
    })
}

/// The number of an entry of a list such as `fault[1]`, from 0.
fn number_in(section: &str, list: &str) -> Option<usize> {
    section.strip_prefix(list)?.strip_prefix('[')?.strip_suffix(']')?.parse().ok()
}

/// Names and units of all indicators, in their order.
fn indicator_names() -> Vec<(String, String)> {
    use meshtone::signal::{Indicators, SeparationSettings, separate};

    // Any average has them all.
    let average: Vec<f64> = (0..64).map(|i| f64::from(i % 7)).collect();
    let parts = separate(&average, &SeparationSettings::new(20));
    let table = parts.and_then(|parts| Indicators::new(&average, &parts, 20)).map(|all| all.table("g"));
    table.unwrap_or_default().into_iter().map(|value| (value.name, value.unit)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_keys() {
        for (key, name, unit) in [
            ("operation.pinion_speed_hz", "pinion_speed_hz", "Hz"),
            ("rig.pinion_shaft.length_mm", "pinion_shaft_length_mm", "mm"),
            ("fault.start", "fault_start", "-"),
            ("fault.circle.x_mm", "fault_circle_x_mm", "mm"),
            ("fault[0].start", "fault_start", "-"),
            ("fault[1].circle.x_mm", "fault_2_circle_x_mm", "mm"),
            ("fault[1].severity", "fault_2_severity", "-"),
            ("fault.tooth", "fault_tooth_of_scenario", "-"),
            ("fault[1].tooth", "fault_2_tooth_of_scenario", "-"),
            ("sensor.resonance_hz", "sensor_resonance_hz", "Hz"),
            ("sensor[1].noise_density_g_per_rthz", "sensor_2_noise_density_g_per_rthz", "g/√Hz"),
            ("rig.misalignment_um", "misalignment_um", "µm"),
            ("fault.random.density_per_cm2", "fault_random_density_per_cm2", "1/cm²"),
            ("noise.snr_db", "noise_snr_db", "dB"),
            ("path.gain_db", "path_gain_db", "dB"),
            ("latent.load", "latent_load", "-"),
            ("rig.bearing_stiffness_n_per_m", "bearing_stiffness_n_per_m", "N/m"),
            ("rig.wheel_rotational_stiffness_nm_per_rad", "wheel_rotational_stiffness_nm_per_rad", "N m/rad"),
            ("operation.brake_torque_nm", "brake_torque_nm", "N m"),
        ] {
            assert_eq!(column_name(key), name);
            assert_eq!(unit_of(name), unit);
        }
    }

    #[test]
    fn there_are_32_indicators() {
        assert_eq!(indicator_names().len(), 32);
    }
}
