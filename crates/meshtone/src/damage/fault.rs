//! What is broken, and where.

use meshtone_toml::{ReadResult, TomlTable};

use super::Damage;
use crate::error::ScenarioError;
use crate::keys::{
    Check, KeyDescription, Keys, NoFiles, Range, Row, check_keys, commented, describe, field, read_keys,
    require, row, write_keys,
};
use crate::wheel::{Gears, WheelName};

/// Damage to one tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The damaged wheel. Default the gear.
    pub wheel: WheelName,
    /// Number of the damaged tooth, 1 to the wheel's tooth count, in the order in which the teeth enter contact; the two
    /// first teeth meet at the start of the simulation. Default 1.
    pub tooth: u32,
    /// What is wrong with it.
    pub damage: Damage,
}

impl Fault {
    /// Damage to a tooth.
    ///
    /// # Arguments
    /// * `wheel` - the damaged wheel
    /// * `tooth` - number of the damaged tooth, from 1
    /// * `damage` - what is wrong with it
    pub fn new(wheel: WheelName, tooth: u32, damage: impl Into<Damage>) -> Self {
        Self { wheel, tooth, damage: damage.into() }
    }

    /// Damage to the gear's first tooth.
    ///
    /// # Arguments
    /// * `damage` - what is wrong with it
    pub fn on_first_gear_tooth(damage: impl Into<Damage>) -> Self {
        Self::new(WheelName::Gear, 1, damage)
    }

    /// Index of the damaged tooth, from 0.
    pub fn tooth_index(&self) -> usize {
        self.tooth.saturating_sub(1) as usize
    }
}

/// Where a damage is: the keys that every fault has beside `kind`.
#[derive(Debug, Clone, PartialEq)]
struct Place {
    wheel: WheelName,
    tooth: u32,
}

impl Keys for Place {
    fn start() -> Self {
        Self { wheel: WheelName::default(), tooth: 1 }
    }

    fn rows() -> Vec<Row<Self>> {
        vec![
            row("wheel", "", "the damaged wheel", field!(wheel)),
            row(
                "tooth",
                "",
                "the number of the damaged tooth, in the order in which the teeth enter contact",
                field!(tooth),
            )
            .range(Range::positive().message("must be at least 1, the first tooth"))
            .rule("at most the wheel's teeth"),
        ]
    }
}

impl Fault {
    /// Reads the faults of a file, as the scenario file has them: `[fault]`, or any number of `[[fault]]`.
    ///
    /// # Arguments
    /// * `table` - what the sections are in
    ///
    /// # Errors
    /// An unknown kind, a missing or unknown key, a value of the wrong type; ranges are checked with the whole scenario.
    pub fn list_from_table(table: &TomlTable<'_>) -> ReadResult<Vec<Self>> {
        table.tables("fault")?.into_iter().map(|table| table.read(Self::from_table)).collect()
    }

    fn from_table(table: &TomlTable<'_>) -> ReadResult<Self> {
        let mut damage = Damage::start_of(table)?;
        let mut place = Place::start();
        read_keys(&mut place, table, &NoFiles)?;
        damage.read(table)?;
        Ok(Self { wheel: place.wheel, tooth: place.tooth, damage })
    }

    fn place(&self) -> Place {
        Place { wheel: self.wheel, tooth: self.tooth }
    }

    /// The lines of its section, without the header.
    pub(crate) fn write(&self) -> String {
        format!("{}kind = \"{}\"\n{}", write_keys(&self.place()), self.damage.kind(), self.damage.write())
    }

    /// The lines of its section with a comment for every key, without the header.
    pub(crate) fn commented(&self) -> String {
        let kind = format!("# {}\nkind = \"{}\"\n", self.damage.summary(), self.damage.kind());
        [kind, self.damage.commented(), commented(&self.place())].concat()
    }

    /// Whether it can be, as far as no profile is needed; its keys are named `fault.…`.
    fn check(&self, gears: &Gears) -> Check {
        check_keys(&self.place(), "fault")?;
        let teeth = gears.teeth(self.wheel);
        if self.tooth > teeth {
            let problem = format!("must be at most {teeth}, the {}'s teeth", self.wheel.name());
            return Err(ScenarioError::new("fault.tooth", self.tooth, problem));
        }
        self.damage.check(gears)
    }
}

/// The keys that every fault has beside `kind`.
pub(super) fn keys_of_every_fault() -> Vec<KeyDescription> {
    describe::<Place>()
}

/// Whether every fault can be, alone and beside those on the same tooth.
///
/// # Arguments
/// * `faults` - all of a pair
/// * `gears` - the wheels
pub(crate) fn check_faults(faults: &[Fault], gears: &Gears) -> Check {
    for (index, fault) in faults.iter().enumerate() {
        let beside = faults[..index].iter().enumerate().find(|(_, other)| {
            (other.wheel, other.tooth) == (fault.wheel, fault.tooth) && excludes(&other.damage, &fault.damage)
        });
        let checked = match beside {
            Some((number, other)) => Err(second_damage(fault, number, other)),
            None => fault.check(gears),
        };
        checked.map_err(|error| error.in_entry("fault", index, faults.len()))?;
    }
    Ok(())
}

/// Whether a tooth with one damage has no room for the other, whatever their sizes: nothing is left of a missing tooth, a tip
/// breaks off once, and a second crack beside the first is not known to any formula.
fn excludes(damage: &Damage, other: &Damage) -> bool {
    let missing = |damage: &Damage| matches!(damage, Damage::MissingTooth(_));
    let broken = |damage: &Damage| matches!(damage, Damage::ToothBreakage(_));
    let cracked = |damage: &Damage| matches!(damage, Damage::RootCrack(_));
    missing(damage)
        || missing(other)
        || (broken(damage) && broken(other))
        || (cracked(damage) && cracked(other))
}

fn second_damage(fault: &Fault, number: usize, other: &Fault) -> ScenarioError {
    let (wheel, tooth, kind) = (fault.wheel.name(), fault.tooth, fault.damage.kind());
    let problem = format!(
        "tooth {tooth} of the {wheel} has fault[{number}] already ({}); a missing tooth has no other damage, and a tooth breaks and cracks once",
        other.damage.kind()
    );
    ScenarioError::new("fault.kind", format!("\"{kind}\""), problem)
        .with_help("remove one of the two, or give it another tooth")
}

/// The second edge lies behind the first.
pub(super) fn end_after(start: f64, end: f64) -> Check {
    let problem = format!("must be more than fault.start, {start:?}, and at most 1");
    require("fault.end", end, end > start && end <= 1.0, problem)
}
