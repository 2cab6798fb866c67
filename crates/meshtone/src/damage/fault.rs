//! What is broken, and where.

use std::collections::BTreeMap;

use meshtone_toml::{ReadResult, TomlTable};

use super::severity::SoundTooth;
use super::{Damage, FaultyTeeth, MissingTooth};
use crate::error::ScenarioError;
use crate::keys::{
    Check, KeyDescription, KeyKind, Keys, NoFiles, Range, by_name, check_keys, commented_rows, describe,
    describe_from, keys, read_rows, require, rows_but, write_keys, write_rows,
};
use crate::wheel::{NamedGears, Teeth, WheelName};

/// Damage to one tooth, or to several alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Name of the damaged wheel: of a pair `pinion` or `gear`. Default the gear.
    pub wheel: String,
    /// Which of its teeth, by their numbers from 1 to the wheel's tooth count, in the order in which the teeth enter contact;
    /// the two first teeth meet at the start of the simulation. Default 1.
    pub tooth: FaultyTeeth,
    /// What is wrong with each of them.
    pub damage: Damage,
    /// (-) How severe that is, from 0, none, to 1, the largest that the tooth allows: where it is given, the sizes follow from
    /// it, and those in [`Self::damage`] do not count. None where they do.
    pub severity: Option<f64>,
    /// Of a planet, in which of its two meshes the damage is; none for both, and on any other wheel.
    pub flank: Option<FaultFlank>,
}

/// In which mesh a planet's tooth is damaged: one of its flanks meets the sun, the other one the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FaultFlank {
    /// On the flank that meets the sun.
    Sun,
    /// On the flank that meets the ring.
    Ring,
    /// On both, alike.
    #[default]
    Both,
}

by_name!(FaultFlank, ["sun" => FaultFlank::Sun, "ring" => FaultFlank::Ring, "both" => FaultFlank::Both]);

impl Fault {
    /// Damage to a tooth, or to several alike.
    ///
    /// # Arguments
    /// * `wheel` - the damaged wheel, or its name
    /// * `tooth` - number of the damaged tooth, from 1, or numbers of several, or all
    /// * `damage` - what is wrong with each of them
    ///
    /// ```
    /// use meshtone::damage::{Fault, FaultyTeeth, MissingTooth};
    /// use meshtone::wheel::WheelName;
    ///
    /// assert_eq!(Fault::new(WheelName::Gear, 5, MissingTooth).tooth, FaultyTeeth::One(5));
    /// assert_eq!(Fault::new(WheelName::Gear, vec![5, 6], MissingTooth).tooth.numbers(38), [5, 6]);
    /// ```
    pub fn new(wheel: impl Into<String>, tooth: impl Into<FaultyTeeth>, damage: impl Into<Damage>) -> Self {
        Self { wheel: wheel.into(), tooth: tooth.into(), damage: damage.into(), severity: None, flank: None }
    }

    /// The same fault with a severity in place of its sizes.
    ///
    /// # Arguments
    /// * `severity` - (-) from 0, none, to 1, the largest that the tooth allows
    ///
    /// ```
    /// use meshtone::damage::{Fault, RootCrack};
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let crack = RootCrack { depth_mm: 0.0, angle_deg: 60.0, length_mm: None };
    /// let scenario = Scenario::new(GearPair::example())
    ///     .with_faults(vec![Fault::on_first_gear_tooth(crack).with_severity(0.5)]);
    /// let sized = scenario.with_own_sizes()?;
    /// assert!((sized.number("fault.depth_mm").unwrap() - 1.738).abs() < 1e-3);
    /// assert!((sized.fault_severities()?[0] - 0.5).abs() < 1e-12);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn with_severity(self, severity: f64) -> Self {
        Self { damage: self.damage.without_sizes(), severity: Some(severity), ..self }
    }

    /// The damaged wheel of two that mesh, which are named as those of a pair.
    pub fn side(&self) -> WheelName {
        if self.wheel == WheelName::Pinion.name() { WheelName::Pinion } else { WheelName::Gear }
    }

    /// The damage that it does to a pair's teeth, with its own sizes; none of severity 0, or where it is smaller than the
    /// profile's points can show.
    ///
    /// # Arguments
    /// * `teeth` - both healthy teeth
    pub fn sized(&self, teeth: &Teeth) -> Option<Damage> {
        match self.severity {
            None => Some(self.damage.clone()),
            Some(severity) if severity > 0.0 => {
                self.damage.of_severity(severity, &SoundTooth::new(teeth, self.side()))
            }
            Some(_) => None,
        }
    }

    /// The same fault with the sizes of its severity, if it has any, beside it.
    pub(crate) fn with_sizes(&self, teeth: &Teeth) -> Self {
        Self { damage: self.sized(teeth).unwrap_or_else(|| self.damage.clone()), ..self.clone() }
    }

    /// (-) How severe it is: what is given, or what follows from its sizes.
    ///
    /// # Arguments
    /// * `teeth` - both healthy teeth
    pub fn severity_on(&self, teeth: &Teeth) -> f64 {
        self.severity.unwrap_or_else(|| self.damage.severity(&SoundTooth::new(teeth, self.side())))
    }

    /// Damage to the gear's first tooth.
    ///
    /// # Arguments
    /// * `damage` - what is wrong with it
    pub fn on_first_gear_tooth(damage: impl Into<Damage>) -> Self {
        Self::new(WheelName::Gear, 1, damage)
    }

    /// Damage where a scenario file has it that names neither wheel nor tooth: on the gear's first tooth, or on those that the
    /// kind is usually found on.
    ///
    /// # Arguments
    /// * `damage` - what is wrong
    pub fn at_usual_place(damage: impl Into<Damage>) -> Self {
        let damage = damage.into();
        Self::new(WheelName::Gear, damage.usual_teeth(), damage)
    }

    /// Index from 0 of the damaged tooth, of several of the first.
    pub fn tooth_index(&self) -> usize {
        self.tooth.first().saturating_sub(1) as usize
    }
}

// The keys that every fault has beside `kind`, which say where a damage is; those of the damage itself are its kind's.
keys! {
    Fault = Self::on_first_gear_tooth(MissingTooth);
    wheel "" "the damaged wheel" .kind(KeyKind::Name(WheelName::BOTH.map(WheelName::name).to_vec()));
    tooth "" "the damaged tooth's number, in the order of entering contact; an array of several, or \"all\""
        .range(Range::positive().message("must be at least 1, the first tooth"))
        .rule("at most the wheel's teeth, each once");
    severity "-" "the severity of the damage, instead of its sizes: 0 is none, 1 the largest that the tooth allows"
        .otherwise("that of the sizes").range(Range::from_to(0.0, 1.0)).rule("1 for a missing tooth")
        .alternative("0.4");
    flank "" "the flank of a planet's tooth that is damaged, that which meets the sun or that which meets the ring"
        .otherwise("both").rule("for planets alone").alternative("\"sun\"");
}

/// The key that a pair's fault does not have: the one for planets.
const OF_PLANETS: &[&str] = &["flank"];

impl Fault {
    /// Reads the faults of a file, as the scenario file of a pair has them: `[fault]`, or any number of `[[fault]]`.
    ///
    /// # Arguments
    /// * `table` - what the sections are in
    ///
    /// # Errors
    /// An unknown kind, a missing or unknown key, a value of the wrong type; ranges are checked with the whole scenario.
    pub fn list_from_table(table: &TomlTable<'_>) -> ReadResult<Vec<Self>> {
        table.tables("fault")?.into_iter().map(|table| table.read(Self::from_table)).collect()
    }

    /// Reads a fault of a wheel that has any name.
    ///
    /// # Arguments
    /// * `table` - its section
    ///
    /// # Errors
    /// As [`Self::list_from_table`]; a fault that names no wheel.
    pub fn on_named_wheel(table: &TomlTable<'_>) -> ReadResult<Self> {
        let wheel = table
            .required(
                "wheel",
                "the name of the damaged wheel; a spall is a [[bearing.defect]] of its bearing",
            )?
            .string()?;
        let mut fault = Self { wheel: wheel.to_owned(), ..Self::at_usual_place(Damage::start_of(table)?) };
        read_rows(&rows_but(&["wheel"]), &mut fault, table, &NoFiles)?;
        fault.read_damage(table)
    }

    /// Reads a fault of a pair.
    ///
    /// # Arguments
    /// * `table` - its section
    ///
    /// # Errors
    /// As [`Self::list_from_table`].
    pub fn from_table(table: &TomlTable<'_>) -> ReadResult<Self> {
        let mut fault = Self::at_usual_place(Damage::start_of(table)?);
        read_rows(&rows_but(OF_PLANETS), &mut fault, table, &NoFiles)?;
        fault.read_damage(table)
    }

    /// Reads the sizes, or what may stand beside a severity.
    fn read_damage(mut self, table: &TomlTable<'_>) -> ReadResult<Self> {
        let fault = &mut self;
        let Some(severity) = fault.severity else {
            fault.damage.read(table)?;
            return Ok(self);
        };
        let sizes = fault.damage.sizes();
        if let Some(size) = sizes.iter().find(|size| table.optional(size).is_some()) {
            let problem = "given beside severity, which determines the sizes";
            let keys = sizes.join(", ");
            return Err(table.error(size, problem).with_help(format!("remove severity, or all of {keys}")));
        }
        fault.damage.read_but_sizes(table)?;
        Ok(self.with_severity(severity))
    }

    /// Names of the damage's keys that are not written: those that a severity stands in place of.
    fn left_out(&self) -> &'static [&'static str] {
        if self.severity.is_some() { self.damage.sizes() } else { &[] }
    }

    /// The lines of its section, without the header.
    pub(crate) fn write(&self) -> String {
        let keys = self.damage.write(self.left_out());
        format!("{}kind = \"{}\"\n{keys}", write_keys(self), self.damage.kind())
    }

    /// The lines of its section with a comment for every key, without the header.
    pub(crate) fn commented(&self) -> String {
        let rows = rows_but(if self.flank.is_none() { OF_PLANETS } else { &[] });
        let kind = format!("# {}\nkind = \"{}\"\n", self.damage.summary(), self.damage.kind());
        let keys = self.damage.commented(self.left_out());
        [kind, keys, commented_rows(&rows, self, &Self::at_usual_place(self.damage.clone()), Self::SECTION)]
            .concat()
    }

    /// The lines of its section that matter, without the header.
    pub(crate) fn essential(&self) -> String {
        let place = write_rows(&rows_but(&["severity"]), self);
        format!("{place}kind = \"{}\"\n{}", self.damage.kind(), self.damage.essential())
    }

    /// Whether it can be, as far as no profile is needed; its keys are named `fault.…`.
    fn check(&self, gears: &NamedGears) -> Check {
        check_keys(self, "fault")?;
        self.tooth.check(gears.teeth(self.side()), &gears.name(self.side()))?;
        match self.severity {
            None => self.damage.check(gears),
            Some(severity) => {
                let graded = !self.damage.sizes().is_empty() || severity == 1.0;
                let problem = "must be 1: a missing tooth is lost as a whole";
                require("fault.severity", severity, graded, problem).map_err(|error| {
                    error.with_help("for a part of a tooth, use kind = \"tooth-breakage\"")
                })?;
                self.damage.check_but_sizes()
            }
        }
    }
}

/// The keys that every fault has beside `kind`.
pub fn keys_of_every_fault() -> Vec<KeyDescription> {
    describe::<Fault>()
}

/// The same with the defaults of a damage.
pub(super) fn keys_of_place(damage: Damage) -> Vec<KeyDescription> {
    describe_from(&Fault::at_usual_place(damage))
}

/// Whether every fault can be, alone and beside those on the same tooth.
///
/// # Arguments
/// * `faults` - all of a pair
/// * `numbers` - of each in the file
/// * `entries` - how many faults the file has
/// * `gears` - the wheels
pub(crate) fn check_faults(faults: &[Fault], numbers: &[usize], entries: usize, gears: &NamedGears) -> Check {
    let on_teeth = faults_on_teeth(faults, |wheel| gears.teeth(wheel));
    for (index, fault) in faults.iter().enumerate() {
        let excluded_by = |number: usize| faults[number].damage.part().excludes(fault.damage.part());
        let beside = fault.tooth.numbers(gears.teeth(fault.side())).into_iter().filter_map(|tooth| {
            let earlier = on_teeth.get(&(fault.side() as usize, tooth))?.iter().copied();
            let mut earlier = earlier.take_while(|number| *number < index);
            earlier.find_map(|number| Some((number, tooth, excluded_by(number)?)))
        });
        let checked = match beside.min_by_key(|(number, ..)| *number) {
            Some((earlier, tooth, why)) => {
                let place = format!("tooth {tooth} of {}", gears.name(fault.side()));
                Err(second_damage(fault, &place, numbers[earlier], &faults[earlier], why))
            }
            None => fault.check(gears),
        };
        checked.map_err(|error| error.in_entry("fault", numbers[index], entries))?;
    }
    Ok(())
}

/// The numbers of the faults on each tooth, rising, by the wheel and the tooth's number.
///
/// # Arguments
/// * `faults` - all of a pair
/// * `teeth` - number of teeth of a wheel
pub(super) fn faults_on_teeth(
    faults: &[Fault],
    teeth: impl Fn(WheelName) -> u32,
) -> BTreeMap<(usize, u32), Vec<usize>> {
    let mut on_teeth: BTreeMap<(usize, u32), Vec<usize>> = BTreeMap::new();
    for (number, fault) in faults.iter().enumerate() {
        for tooth in fault.tooth.numbers(teeth(fault.side())) {
            on_teeth.entry((fault.side() as usize, tooth)).or_default().push(number);
        }
    }
    on_teeth
}

/// A tooth that has lost already what the fault would take.
fn second_damage(fault: &Fault, place: &str, number: usize, other: &Fault, why: &str) -> ScenarioError {
    let problem = format!("{place} has fault[{number}] already ({}); {why}", other.damage.kind());
    ScenarioError::new("fault.kind", format!("\"{}\"", fault.damage.kind()), problem)
        .with_help("remove one of the two, or give it another tooth")
}

/// The second edge lies behind the first.
pub(super) fn end_after(start: f64, end: f64) -> Check {
    let problem = format!("must be more than fault.start, {start:?}, and at most 1");
    require("fault.end", end, end > start && end <= 1.0, problem)
}
