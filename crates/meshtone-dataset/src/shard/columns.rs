//! The columns of a data set: names, units, meanings, and the cells of each record.

use meshtone::scenario::{DefectPlace, Scenario, WheelName, split_key};
use meshtone::signal::{IndicatorValue, Indicators};
use meshtone_io::table::{CellType, Cells, TableColumn};
use meshtone_plot::without_unit;

use crate::draw::{NOISE_KEYS, PATH_KEYS, is_of_plan};
use crate::plan::{
    AveragedWheels, Class, ClassFault, Content, Keep, OverAngle, Plan, Rule, column_part, list_and_entry,
    wheel_words,
};
use crate::record::{Record, RecordAverage, RecordSpall};

/// Name of the column of warnings' codes.
pub(crate) const WARNINGS: &str = "warnings";
/// Separator of two codes in that column.
pub(crate) const BETWEEN_CODES: &str = ";";
/// Indicators that a preview shows of a wheel.
const PREVIEWED_INDICATORS: [&str; 4] = ["average_rms", "difference_rms", "fm4", "energy_ratio"];
/// Those that it shows where several wheels are averaged.
const PREVIEWED_OF_SEVERAL: [&str; 1] = ["difference_rms"];

/// A column.
pub(crate) struct Column {
    /// Name, which ends in the unit where the column has one.
    pub name: String,
    /// Unit; `-` for plain numbers, empty for text.
    pub unit: String,
    /// Meaning.
    pub description: String,
    /// What the column states about a record.
    pub topic: Topic,
    /// The type of the column's cells.
    pub cell_type: CellType,
    /// Whether cells may be empty.
    nullable: bool,
    /// Whether a recording has values of the column, too.
    pub is_of_recording: bool,
    /// Makes the column's cells of some records.
    pub cells: CellsOf,
}

type CellsOf = Box<dyn for<'r> Fn(&'r [Record]) -> Cells<'r>>;

/// The topic of a column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Topic {
    /// A value that the record was drawn with.
    Drawn,
    /// The value of a key that a rule varies.
    Key(String),
    /// An indicator, and whether a preview shows it.
    Indicator(bool),
    /// A raw channel.
    Channel,
    /// A signal over one revolution.
    Revolution,
    /// Anything else.
    Other,
}

impl Column {
    fn new(
        name: &str,
        unit: &str,
        cell_type: CellType,
        cells: impl Fn(&[Record]) -> Cells<'_> + 'static,
    ) -> Self {
        let (name, unit, description) = (name.to_owned(), unit.to_owned(), String::new());
        let cells = Box::new(cells);
        let (topic, nullable, is_of_recording) = (Topic::Other, false, false);
        Self { name, unit, description, topic, cell_type, nullable, is_of_recording, cells }
    }

    fn int32(name: &str, value: impl Fn(&Record) -> Option<u32> + 'static) -> Self {
        let value = move |record: &Record| value(record).map(|value| value as i32);
        Self::new(name, "", CellType::Int32, move |records| {
            Cells::Int32(records.iter().map(&value).collect())
        })
    }

    fn int64(name: &str, value: impl Fn(&Record) -> u64 + 'static) -> Self {
        let value = move |record: &Record| Some(value(record) as i64);
        Self::new(name, "", CellType::Int64, move |records| {
            Cells::Int64(records.iter().map(&value).collect())
        })
    }

    fn float64(name: &str, unit: &str, value: impl Fn(&Record) -> Option<f64> + 'static) -> Self {
        let cell_type = CellType::Float64;
        Self::new(name, unit, cell_type, move |records| Cells::Float64(records.iter().map(&value).collect()))
    }

    fn text(name: &str, value: impl Fn(&Record) -> Option<String> + 'static) -> Self {
        Self::new(name, "", CellType::Text, move |records| Cells::Text(records.iter().map(&value).collect()))
    }

    fn signal(name: &str, unit: &str, value: impl Fn(&Record) -> &[f32] + 'static) -> Self {
        let column = Self::new(name, unit, CellType::Float32List, move |records| {
            Cells::Float32List(records.iter().map(&value).collect())
        });
        column.about(Topic::Revolution).of_recording()
    }

    fn meaning(self, description: impl Into<String>) -> Self {
        Self { description: description.into(), ..self }
    }

    fn about(self, topic: Topic) -> Self {
        Self { topic, ..self }
    }

    fn of_recording(self) -> Self {
        Self { is_of_recording: true, ..self }
    }

    fn nullable(self) -> Self {
        Self { nullable: true, ..self }
    }

    /// Returns whether the column holds a signal.
    pub fn is_signal(&self) -> bool {
        self.cell_type == CellType::Float32List
    }

    /// Returns whether the column is one of what a record is drawn with.
    pub fn is_drawn(&self) -> bool {
        matches!(self.topic, Topic::Drawn | Topic::Key(_))
    }

    /// Returns whether the column holds one of the indicators that a preview shows.
    pub fn is_previewed_indicator(&self) -> bool {
        self.topic == Topic::Indicator(true)
    }

    /// Returns whether a preview shows the column, unless all records have the same value.
    pub fn is_previewed(&self) -> bool {
        self.is_drawn() || self.is_previewed_indicator()
    }
}

impl From<&Column> for TableColumn {
    fn from(column: &Column) -> Self {
        let mut metadata = vec![("unit", column.unit.as_str()), ("description", &column.description)];
        if let Topic::Key(key) = &column.topic {
            metadata.push(("key", key));
        }
        let nullable = column.nullable;
        Self { nullable, ..Self::new(&column.name, column.cell_type).with_metadata(metadata) }
    }
}

/// The columns of a plan's data set: what a record is, its varied keys, its indicators, its signals.
///
/// They follow from the plan alone, so that all shards of all parts have the same ones in the same order. A varied key that is a column
/// already, such as the speed, gets no second one.
///
/// # Arguments
/// * `plan` - the plan
pub(crate) fn columns(plan: &Plan) -> Vec<Column> {
    let Content { classes, keep, .. } = &plan.content;
    let wheel = &wheel_words(&keep.wheel.all()[0]);
    let mut columns = of_record(&plan.content);
    if classes.iter().any(|class| class.growth.is_some()) {
        columns.extend(of_run(classes));
    }
    if let Some(points) = keep.over_angle.map(|angle| angle.points_per_revolution as u32) {
        let meaning = format!("values in a revolution of the {wheel}, of channels, average and difference");
        columns.push(
            Column::int32("points_per_revolution", move |_| Some(points)).of_recording().meaning(meaning),
        );
    }
    columns.extend(of_simulation(&plan.content.base));
    let keys = varied_keys(&plan.content).into_iter().map(|(_, key)| of_key(key));
    let keys: Vec<Column> = keys.filter(|key| columns.iter().all(|column| column.name != key.name)).collect();
    columns.extend(keys);
    if keep.indicators {
        columns.extend((0..keep.wheel.all().len()).flat_map(|number| of_indicators(keep, number)));
    }
    for (number, channel) in keep.channels.iter().enumerate() {
        let samples = match keep.over_angle {
            None => "raw channel, its samples one after the other".to_owned(),
            Some(OverAngle { revolutions, .. }) => {
                format!("raw channel over {revolutions} revolutions of the {wheel}, at equal angles")
            }
        };
        let column = Column::signal(&channel.name(), channel.unit(), move |r| &r.channels[number]);
        columns.push(column.about(Topic::Channel).meaning(format!("{samples}: {}", channel.meaning())));
    }
    columns.extend((0..keep.wheel.all().len()).flat_map(|number| of_revolution(keep, number)));
    if plan.content.tuned.is_some() {
        columns.push(Column::signal("enhanced_relative_difference", "-", |r| &r.enhanced).meaning(
            "enhanced difference signal over one revolution of the gear, the fault's response in the middle, \
             over the rms of the enhanced healthy signal",
        ));
    }
    columns
}

/// Lists the columns of what a record is, of its faults and of its machine.
///
/// They begin with what every data set has. Those of the machine, at the end, are other ones for a pair than for a gearbox.
fn of_record(content: &Content) -> Vec<Column> {
    let [unit, _] = content.base.words().nouns;
    let splits: Vec<String> = content.splits.names().into_iter().map(str::to_owned).collect();
    let labels: Vec<String> = content.classes.iter().map(|class| class.label.clone()).collect();
    let mut columns = vec![
        Column::int64("record", |r| r.drawn.index)
            .of_recording()
            .meaning("number of the record; with the plan it determines everything else"),
        Column::int64("unit", |r| r.drawn.unit)
            .of_recording()
            .meaning(format!("number of the unit: the {unit}, shared by several records")),
        Column::int64("mounting", |r| r.drawn.mounting)
            .meaning("number of the mounting, that is of one assembly of the unit"),
        Column::text("split", move |r| Some(splits[r.drawn.split].clone()))
            .meaning("the split that the unit, or its mounting, belongs to"),
        Column::text("label", move |r| Some(labels[r.drawn.class].clone())).meaning("the class"),
        Column::int32("severity", |r| Some(r.drawn.severity.into()))
            .about(Topic::Drawn)
            .meaning("grade of the fault, from 1; 0 for healthy"),
        Column::float64("severity_measure", "-", |r| r.drawn.severity_measure)
            .nullable()
            .meaning("the number that the grade was taken from"),
    ];
    // All data sets have the columns of one fault, even if every class is healthy.
    let most_faults = content.classes.iter().map(|class| class.faults.len()).max().unwrap_or(0);
    columns.extend((0..most_faults.max(1)).flat_map(|number| of_fault(content, number)));
    columns.extend([
        Column::int64("seed", |r| r.drawn.seed).meaning("seed of the record's noise and fluctuations"),
        Column::int64("wheels_seed", |r| r.drawn.wheels_seed).meaning("seed of the unit's profile errors"),
        Column::float64("sampling_rate_hz", "Hz", |r| Some(r.sampling_rate_hz))
            .of_recording()
            .meaning("sampling rate of the raw channels"),
    ]);
    match content.base.rig() {
        Some(_) => columns.extend(of_pair()),
        None => columns.extend(of_train(&content.base)),
    }
    columns
}

/// Lists the columns of the two wheels of a pair and of how they are driven.
fn of_pair() -> [Column; 6] {
    let speed_hz = |wheel: WheelName| move |r: &Record| Some(r.wheels[wheel as usize].speed_hz);
    [
        angle_of("gear", WheelName::Gear as usize),
        teeth_of("pinion", WheelName::Pinion as usize, "the pinion, the driving wheel"),
        teeth_of("gear", WheelName::Gear as usize, "the gear, the driven wheel"),
        Column::float64("pinion_speed_hz", "Hz", speed_hz(WheelName::Pinion))
            .about(Topic::Drawn)
            .of_recording()
            .meaning("speed of the pinion's shaft"),
        Column::float64("gear_speed_hz", "Hz", speed_hz(WheelName::Gear))
            .of_recording()
            .meaning("speed of the gear's shaft"),
        torque("the gear's shaft"),
    ]
}

/// Lists the columns of the drive and of the wheels of a train.
fn of_train(gearbox: &Scenario) -> Vec<Column> {
    let input = Column::float64("input_speed_hz", "Hz", |r| Some(r.input_speed_hz))
        .about(Topic::Drawn)
        .of_recording()
        .meaning("speed of the motor and of the shaft that is coupled to it");
    let wheels = gearbox.wheels.iter().enumerate().flat_map(|(number, wheel)| {
        let words = format!("wheel {}", wheel.name);
        let speed = Column::float64(&of_wheel(&wheel.name, "speed_hz"), "Hz", move |r| {
            Some(r.wheels[number].speed_hz)
        });
        [
            teeth_of(&wheel.name, number, &words),
            speed.of_recording().meaning(format!("speed of the shaft of {words}, {:?}", wheel.shaft)),
            angle_of(&wheel.name, number),
        ]
    });
    [input, torque("the shaft that the brake holds")].into_iter().chain(wheels).collect()
}

/// Name of a column about a wheel.
fn of_wheel(wheel: &str, last: &str) -> String {
    format!("{}_{last}", column_part(wheel))
}

fn angle_of(wheel: &str, number: usize) -> Column {
    let meaning = format!(
        "angle of the {} at the first sample, from where its tooth 1 comes into contact",
        wheel_words(wheel)
    );
    let angle = move |r: &Record| Some(r.wheels[number].angle_rev);
    Column::float64(&of_wheel(wheel, "angle_rev"), "rev", angle).meaning(meaning)
}

fn teeth_of(wheel: &str, number: usize, words: &str) -> Column {
    let teeth = Column::int32(&of_wheel(wheel, "teeth"), move |r| Some(r.wheels[number].teeth));
    teeth.about(Topic::Drawn).of_recording().meaning(format!("teeth of {words}"))
}

fn torque(shaft: &str) -> Column {
    let torque = Column::float64("brake_torque_nm", "N m", |r| Some(r.brake_torque_nm));
    torque.about(Topic::Drawn).of_recording().meaning(format!("brake torque on {shaft}"))
}

/// Lists the columns of what the simulation of a record says about itself.
fn of_simulation(base: &Scenario) -> Vec<Column> {
    const APART: &str = "fraction of the simulated time with contact loss";
    let slack = |name: &str, mesh: usize, meaning: &str| {
        Column::float64(name, "-", move |r| r.slack_fractions.get(mesh).copied()).meaning(meaning)
    };
    let slack = match base.rig() {
        None => {
            let of_mesh = |(number, mesh): (usize, &meshtone::scenario::ScenarioMesh)| {
                let name = of_wheel(&mesh.name(), "apart_fraction");
                slack(&name, number, &format!("{APART} in mesh {}", mesh.name()))
            };
            base.meshes.iter().enumerate().map(of_mesh).collect()
        }
        Some(_) if !base.model.teeth_part() => vec![slack(
            "tension_fraction",
            0,
            "part of the simulated time in which the linear mesh pulls where real teeth would separate",
        )],
        _ => vec![slack("apart_fraction", 0, APART)],
    };
    let codes =
        |r: &Record| r.warnings.iter().map(|kind| kind.code()).collect::<Vec<_>>().join(BETWEEN_CODES);
    let warnings = Column::text(WARNINGS, move |r| Some(codes(r)))
        .meaning("codes of the simulation's warnings, with `;` between; empty without any");
    let simulated = Column::float64("simulated_s", "s", |r| Some(r.simulated_s))
        .of_recording()
        .meaning("simulated time from which average and indicators are computed");
    [warnings].into_iter().chain(slack).chain([simulated]).collect()
}

/// Lists the columns of where a record is in its unit's run to failure.
///
/// # Arguments
/// * `classes` - of the plan
fn of_run(classes: &[Class]) -> [Column; 3] {
    let mut growing = classes.iter().filter(|class| class.growth.is_some()).flat_map(|class| &class.faults);
    let part = if growing.any(is_of_bearing) { "wheel or bearing" } else { "wheel" };
    let left = format!(
        "turns of the damaged {part} to failure; where `censored` is 1 to the end of the run, at least so many were left"
    );
    [
        Column::float64("age_rev", "rev", |r| Some(r.drawn.age?.age_rev))
            .about(Topic::Drawn)
            .meaning(format!("turns of the damaged {part} since its run began")),
        Column::float64("remaining_rev", "rev", |r| Some(r.drawn.age?.remaining_rev)).meaning(left),
        Column::int32("censored", |r| Some(r.drawn.age?.is_censored.into()))
            .meaning("1 where the run was stopped before failure, else 0"),
    ]
    .map(Column::nullable)
}

/// The indicators of the analysed channel over the revolutions of one of the averaged wheels.
fn of_indicators(keep: &Keep, number: usize) -> Vec<Column> {
    let wheel = &keep.wheel.all()[number];
    let (prefix, words) = (keep.wheel.prefix(wheel), wheel_words(wheel));
    let previewed = match keep.wheel {
        AveragedWheels::One(_) => &PREVIEWED_INDICATORS[..],
        AveragedWheels::Each(_) => &PREVIEWED_OF_SEVERAL,
    };
    let of_indicator = |IndicatorValue { name, unit, .. }: IndicatorValue| {
        let column = if unit == "g" { format!("{prefix}{name}_g") } else { format!("{prefix}{name}") };
        let topic = Topic::Indicator(previewed.contains(&name.as_str()));
        let meaning = format!("indicator {name} of the analysed channel over the {words}'s revolutions");
        let value = move |r: &Record| {
            r.averages.get(number)?.indicators.iter().find(|value| value.name == name)?.value
        };
        Column::float64(&column, &unit, value).about(topic).of_recording().nullable().meaning(meaning)
    };
    Indicators::default().table("g").into_iter().map(of_indicator).collect()
}

/// Average and difference signal over a revolution of one of the averaged wheels.
fn of_revolution(keep: &Keep, number: usize) -> Vec<Column> {
    let wheel = &keep.wheel.all()[number];
    let prefix = keep.wheel.prefix(wheel);
    let turn = format!(
        "over one revolution of the {}, at equal angles from where its tooth 1 comes into contact",
        wheel_words(wheel)
    );
    let signal = |name: &str, words: &str, value: fn(&RecordAverage) -> &[f32]| {
        let name = format!("{prefix}{name}_g");
        let column = Column::signal(&name, "g", move |r| r.averages.get(number).map_or(&[], value));
        column.meaning(format!("{words} {turn}"))
    };
    let average = keep.average.then(|| signal("average", "synchronous average", |of| &of.average));
    let difference = keep.difference.then(|| signal("difference", "difference signal", |of| &of.difference));
    average.into_iter().chain(difference).collect()
}

/// Bearing and sizes of a spall.
fn of_spall(number: usize, named: impl Fn(&str) -> String) -> [Column; 5] {
    let spall = move |r: &Record| r.faults.get(number)?.spall.clone();
    let size = |last: &str, unit: &str, value: fn(&RecordSpall) -> Option<f64>| {
        Column::float64(&named(last), unit, move |r| value(&spall(r)?))
    };
    [
        Column::text(&named("bearing"), move |r| Some(spall(r)?.bearing))
            .meaning("the damaged bearing: its shaft, and its place on it as a part of the length"),
        size("spall_width_mm", "mm", |of| Some(of.sizes.width_mm))
            .meaning("width of the spall along the path of the rolling elements, or around an element"),
        size("spall_drop_um", "µm", |of| Some(of.sizes.drop_um))
            .meaning("how deep an element drops into the spall: to its depth, or until it touches both edges"),
        size("spall_angle_deg", "°", |of| (of.sizes.place != DefectPlace::Element).then_some(of.sizes.angle_deg)).meaning(
            "angle from the static load of the bearing to the middle of the spall, of a race that turns at time 0 before settling; null of a \
             rolling element, which starts at a random angle",
        ),
        size("spall_order", "-", |of| Some(of.order)).meaning(
            "order of the spall's first line over the revolutions of the bearing's shaft, without slip: BPFO, BPFI or twice BSF",
        ),
    ]
}

fn is_of_bearing(fault: &ClassFault) -> bool {
    fault.teeth().is_none()
}

/// Kind, place, severity and sizes of a fault, as far as some class has them.
///
/// A class may have several faults, and a record of a class with fewer has no values in the columns of the others. The pits' area has a
/// column only where some class has pits in that place.
///
/// # Arguments
/// * `content` - of the plan
/// * `number` - of the fault in its class, from 0
fn of_fault(content: &Content, number: usize) -> Vec<Column> {
    let faults = || content.classes.iter().filter_map(|class| class.faults.get(number));
    let with_bearings = faults().any(is_of_bearing);
    let (of_kind, of_severity) = match with_bearings {
        true => (
            ", of a bearing outer-race, inner-race or rolling-element",
            "; of a bearing the width of the spall over the diameter of an element",
        ),
        false => ("", ""),
    };
    let named = |last: &str| format!("{}_{last}", name_in_list("fault", number));
    let kind = Column::text(&named("kind"), move |r| Some(r.faults.get(number)?.kind.to_owned()));
    let mut columns = vec![kind.meaning(format!("kind of damage{of_kind}"))];
    if !with_bearings || !faults().all(is_of_bearing) {
        let wheels = content.base.wheel_names().join(" or ");
        columns.extend([
            Column::text(&named("wheel"), move |r| r.faults.get(number)?.wheel.clone())
                .meaning(format!("the damaged wheel: {wheels}")),
            Column::int32(&named("tooth"), move |r| r.faults.get(number)?.tooth).meaning(
                "number of the damaged tooth, from 1, in the order in which its wheel's teeth come into contact from the \
                 start of the record on, null where it is several; in the plan and the scenario teeth are counted from where \
                 the first two meet",
            ),
        ]);
    }
    let severity = Column::float64(&named("severity"), "-", move |r| Some(r.faults.get(number)?.severity));
    columns.push(severity.meaning(format!(
        "severity of the damage, from 0, none, to 1, the largest that the tooth allows; each kind's \
         scale is in the guide{of_severity}"
    )));
    if with_bearings {
        columns.extend(of_spall(number, named));
    }
    if faults().filter_map(ClassFault::teeth).any(|of| of.damage.has_area()) {
        let area = Column::float64(&named("area_percent"), "%", move |r| r.faults.get(number)?.area_percent);
        columns.push(area.meaning("part of the flank's contact part that the pits take, of the worst tooth"));
    }
    columns.into_iter().map(Column::nullable).collect()
}

/// Returns what the names of the columns of an entry of a list begin with: `fault`, and of further ones `fault_2` and so on.
fn name_in_list(list: &str, number: usize) -> String {
    if number == 0 { list.to_owned() } else { format!("{list}_{}", number + 1) }
}

/// The varied keys in the plan's order. Of several keys that share a column, only the first is given.
pub(crate) fn varied_keys(content: &Content) -> Vec<(&Rule, &str)> {
    let mut keys: Vec<(&Rule, &str)> = Vec::new();
    for rule in content.all_rules() {
        for key in &rule.keys {
            if !keys.iter().any(|(_, other)| column_name(other) == column_name(key)) {
                keys.push((rule, key));
            }
        }
    }
    keys
}

/// The value of a varied key.
fn of_key(key: &str) -> Column {
    let name = column_name(key);
    let meanings = [
        "signal-to-noise ratio of the added noise",
        "standard deviation of the added noise",
        "gain of the path to the sensor",
        "standard deviation over frequency of the gain of the path to the sensor, its mounting's own",
        "frequency at which the wall under the sensor bends as far as the place moves",
        "standard deviation of the share of a mode of the housing, its mounting's own",
    ];
    let mut of_plan = NOISE_KEYS.iter().chain(&PATH_KEYS).zip(meanings);
    let description = match of_plan.find(|(other, _)| **other == key) {
        Some((_, meaning)) => meaning.to_owned(),
        None if is_of_plan(key) => format!("{key} of the plan, which other keys depend on"),
        None if is_tooth(key) => format!(
            "{key} of the scenario, from 1: the same tooth counted from where the scenario's first teeth meet, as the plan \
             and `meshtone dataset scenario` have it"
        ),
        None => format!("{key} of the scenario"),
    };
    let own_name = name.clone();
    let value = move |record: &Record| {
        let of_column = record.drawn.values.iter().find(|(other, _)| column_name(other) == own_name);
        of_column.map(|(_, value)| *value)
    };
    let unit = Some(without_unit(&name).1).filter(|unit| !unit.is_empty()).unwrap_or("-");
    let column = Column::float64(&name, unit, value).meaning(description);
    column.about(Topic::Key(key.to_owned())).of_recording().nullable()
}

/// Name of a varied key's column: without its section, unless that is a fault, a sensor, a part of a gearbox or one of the plan's own. Of a
/// wheel its name stands before the key, and of another named part of a gearbox the section too.
pub(crate) fn column_name(key: &str) -> String {
    let (section, Some(rest)) = split_key(key) else { return key.to_owned() };
    let name = match list_and_entry(section) {
        ("wheel", Some(name)) => [name, rest].join("_"),
        ("shaft" | "mesh" | "bearing", Some(name)) => {
            let (list, _) = list_and_entry(section);
            [list, name, rest].join("_")
        }
        ("fault" | "noise" | "path" | "latent" | "sensor" | "housing", None) => key.to_owned(),
        (list @ ("fault" | "sensor"), Some(number)) => {
            [&name_in_list(list, number.parse().unwrap_or(0)), rest].join("_")
        }
        _ => rest.to_owned(),
    };
    let name = column_part(&name);
    // `fault_tooth` counts from the record's start.
    if is_tooth(key) { format!("{name}_of_scenario") } else { name }
}

/// Returns whether a key is the number of a damaged tooth.
fn is_tooth(key: &str) -> bool {
    let (section, rest) = split_key(key);
    rest == Some("tooth") && list_and_entry(section).0 == "fault"
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
            ("wheel[z1].face_width_mm", "z1_face_width_mm", "mm"),
            ("mesh[z1-z2].backlash_mm", "mesh_z1_z2_backlash_mm", "mm"),
            ("bearing[input:0.5].damping_ratio", "bearing_input_0_5_damping_ratio", "-"),
            ("shaft[input].inertia.mass_kg", "shaft_input_inertia_mass_kg", "kg"),
            ("housing.mass_kg", "housing_mass_kg", "kg"),
        ] {
            assert_eq!(column_name(key), name);
            assert_eq!(of_key(key).unit, unit);
        }
    }
}
