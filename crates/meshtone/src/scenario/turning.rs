//! How fast the shafts turn: relations of their rotations, solved over fractions, and which member of a planetary set drives.

use nalgebra::{DMatrix, DVector};

use super::layout::{Layout, Ratio, entry_key};
use super::{PlanetarySet, Scenario};
use crate::error::ScenarioError;
use crate::wheel::Gears;

/// How shafts turn.
pub(super) struct Turning {
    /// Rotation of each shaft over that of the input.
    pub(super) ratios: Vec<Ratio>,
    /// For each planetary set whether its sun drives its planets, seen from the carrier; otherwise they drive it.
    pub(super) sun_drives: Vec<bool>,
}

/// What ties the rotations of shafts together: `Σ weight · ratio = 0`. By the power that it passes on, its torques on the shafts are in the
/// ratio of the same weights.
struct Relation {
    weights: Vec<(usize, i64)>,
    of: Tie,
}

/// What makes a relation.
#[derive(Clone, Copy, PartialEq)]
enum Tie {
    /// A mesh, by its number.
    Mesh(usize),
    /// A planetary set, by its number.
    Set(usize),
}

/// The relations that have been taken in, as rows of a reduced echelon form; the last column is the constant.
struct Solved {
    rows: Vec<(usize, Vec<Ratio>)>,
    shafts: usize,
}

/// How a relation fits those before it.
enum Taken {
    /// It says something new, or the same as they do.
    Fits,
    /// It contradicts them.
    Locks,
    /// A fraction has too many digits.
    TooLong,
}

impl Solved {
    /// Nothing but that the motor's shaft turns once.
    fn of_motor(motor: usize, shafts: usize) -> Self {
        let row = (0..=shafts).map(|n| Ratio::whole(i64::from(n == motor || n == shafts))).collect();
        Self { rows: vec![(motor, row)], shafts }
    }

    /// The ratio of a shaft; none where it is not determined yet.
    fn ratio(&self, shaft: usize) -> Option<Ratio> {
        let (_, row) = self.rows.iter().find(|(pivot, _)| *pivot == shaft)?;
        let is_alone = (0..self.shafts).all(|n| n == shaft || row[n].is_zero());
        is_alone.then(|| row[self.shafts])
    }

    /// Takes a relation in, by Gauss and Jordan's elimination.
    fn take(&mut self, relation: &Relation) -> Taken {
        let mut new = vec![Ratio::whole(0); self.shafts + 1];
        for &(shaft, weight) in &relation.weights {
            new[shaft] = new[shaft].plus(Ratio::whole(weight));
        }
        for (pivot, row) in &self.rows {
            reduce(&mut new, row, *pivot);
        }
        if !new.iter().all(|entry| entry.is_exact()) {
            return Taken::TooLong;
        }
        let Some(pivot) = (0..self.shafts).find(|&n| !new[n].is_zero()) else {
            return if new[self.shafts].is_zero() { Taken::Fits } else { Taken::Locks };
        };
        let leading = new[pivot];
        new.iter_mut().for_each(|entry| *entry = entry.over(leading));
        for (_, row) in &mut self.rows {
            reduce(row, &new, pivot);
        }
        let is_exact = self.rows.iter().all(|(_, row)| row.iter().all(|entry| entry.is_exact()));
        self.rows.push((pivot, new));
        if is_exact { Taken::Fits } else { Taken::TooLong }
    }
}

/// Takes so much of a row that has 1 in a column off another one that it has 0 there.
fn reduce(row: &mut [Ratio], by: &[Ratio], column: usize) {
    let factor = row[column];
    if factor.is_zero() {
        return;
    }
    for (entry, of) in row.iter_mut().zip(by) {
        *entry = entry.plus(of.times(-factor.numerator, factor.denominator));
    }
}

impl Layout {
    /// Speed ratios, from the motor's shaft on. What is reached by two ways must turn the same by both.
    ///
    /// A relation is taken in as soon as it says how fast one more shaft turns, so that the messages name what is farther from the motor; relations
    /// that determine shafts only together come last.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is
    /// * `motor`, `brake` - numbers of their shafts
    ///
    /// # Errors
    /// A train that is locked or free, a mesh that names the driven wheel first, fractions of too many digits.
    pub(super) fn turn(
        &self,
        scenario: &Scenario,
        [motor, brake]: [usize; 2],
    ) -> Result<Turning, ScenarioError> {
        let shafts = scenario.shafts().len();
        let mut relations = self.relations(scenario)?;
        let mut solved = Solved::of_motor(motor, shafts);
        let mut taken: Vec<Relation> = Vec::new();
        while !relations.is_empty() {
            let unknown = |relation: &Relation| {
                relation.weights.iter().filter(|(shaft, _)| solved.ratio(*shaft).is_none()).count()
            };
            let next = (0..relations.len()).find(|&n| unknown(&relations[n]) <= 1).unwrap_or(0);
            let relation = relations.remove(next);
            self.take(scenario, &mut solved, &relation)?;
            taken.push(relation);
        }
        let ratios: Vec<Ratio> = (0..shafts).filter_map(|shaft| solved.ratio(shaft)).collect();
        if ratios.len() < shafts {
            return Err(free(scenario, &solved, brake));
        }
        let sun_drives = sun_drives(scenario, &taken, &ratios, [motor, brake]);
        Ok(Turning { ratios, sun_drives })
    }

    /// What ties the shafts together: every mesh of wheels on two shafts, and every planetary set.
    fn relations(&self, scenario: &Scenario) -> Result<Vec<Relation>, ScenarioError> {
        let of_mesh = self.gears.iter().enumerate().map(|(mesh, gears)| {
            let [driving, driven] = self.wheels_of_mesh[mesh].map(|wheel| self.shaft_of_wheel[wheel]);
            let Gears { pinion_teeth, gear_teeth, .. } = gears;
            let weights = vec![(driving, i64::from(*pinion_teeth)), (driven, i64::from(*gear_teeth))];
            Ok(Relation { weights, of: Tie::Mesh(mesh) })
        });
        let names: Vec<&str> = scenario.shafts().iter().map(|shaft| shaft.name.as_str()).collect();
        let entries = scenario.planetary().len();
        let of_set = scenario.planetary().iter().enumerate().map(|(number, set)| {
            let [sun, ring] = [set.teeth.sun, set.teeth.ring].map(i64::from);
            let members =
                ["sun", "carrier", "ring"].into_iter().zip(set.shafts()).zip([sun, -sun - ring, ring]);
            let mut weights = Vec::new();
            for ((member, shaft), weight) in members {
                if let Some(shaft) = shaft {
                    let found = super::layout::find(&names, shaft, "shaft").map_err(|error| {
                        let key = entry_key("planetary", number, entries, member);
                        error.with_key(key).with_help(
                            "name a [[shaft]], or write \"fixed\" for the member that stands still",
                        )
                    })?;
                    weights.push((found, weight));
                }
            }
            check_members(set, &weights).map_err(|error| error.in_entry("planetary", number, entries))?;
            Ok(Relation { weights, of: Tie::Set(number) })
        });
        of_mesh.chain(of_set).collect()
    }

    /// Takes a relation in, or says what is wrong with it.
    fn take(
        &self,
        scenario: &Scenario,
        solved: &mut Solved,
        relation: &Relation,
    ) -> Result<(), ScenarioError> {
        let name = |shaft: usize| scenario.shafts()[shaft].name.as_str();
        let (key, written) = match relation.of {
            Tie::Mesh(mesh) => (
                entry_key("mesh", mesh, scenario.own_meshes(), "wheels"),
                format!("{:?}", scenario.meshes[mesh].wheels),
            ),
            Tie::Set(set) => {
                (entry_key("planetary", set, scenario.planetary().len(), "teeth"), String::new())
            }
        };
        let before: Vec<Option<Ratio>> =
            relation.weights.iter().map(|(shaft, _)| solved.ratio(*shaft)).collect();
        if let (Tie::Mesh(_), [None, Some(_)], [(driving, _), (driven, _)]) =
            (relation.of, &before[..], &relation.weights[..])
        {
            let problem = format!(
                "names the driven wheel first: shaft {:?} is nearer to the motor than shaft {:?}",
                name(*driven),
                name(*driving)
            );
            return Err(ScenarioError::new(key, written, problem).with_help("swap the two names"));
        }
        let last = relation.weights.last().map_or(0, |(shaft, _)| *shaft);
        match solved.take(relation) {
            Taken::Fits => Ok(()),
            Taken::TooLong => {
                let problem =
                    format!("makes the ratio of shaft {:?} a fraction of too many digits", name(last));
                Err(ScenarioError::new(key, written, problem)
                    .with_help("choose fewer stages, or tooth counts with common factors"))
            }
            Taken::Locks => {
                let problem = match (relation.of, &before[..], &relation.weights[..]) {
                    (Tie::Mesh(_), [Some(driving), Some(known)], [(_, z1), (_, z2)]) => format!(
                        "locks the train: through this mesh shaft {:?} would turn {} times as fast as the input, by the other path it turns \
                         {known} times",
                        name(last),
                        driving.times(-z1, *z2)
                    ),
                    _ => "locks the train: with these teeth its members cannot turn as fast as the other paths make their shafts".to_owned(),
                };
                Err(ScenarioError::new(key, written, problem).with_help(
                    "change the tooth counts so that all paths have the same ratio, or remove a mesh or what holds a member",
                ))
            }
        }
    }
}

/// A set has three members on two shafts or three.
fn check_members(set: &PlanetarySet, weights: &[(usize, i64)]) -> Result<(), ScenarioError> {
    if weights.len() < 2 {
        let problem = "is the second member that is fixed; one at most stands still";
        let key = if set.shafts()[2].is_none() { "ring" } else { "carrier" };
        return Err(ScenarioError::new(format!("planetary.{key}"), "\"fixed\"", problem)
            .with_help("name the [[shaft]] of two members"));
    }
    let is_twice = |n: usize| weights[..n].iter().any(|(shaft, _)| *shaft == weights[n].0);
    if (1..weights.len()).any(is_twice) {
        let problem = "two members are on one shaft, so that the set turns as a whole";
        return Err(ScenarioError::new("planetary.carrier", format!("{:?}", set.carrier), problem)
            .with_help("name another shaft for one of them"));
    }
    Ok(())
}

/// The error of a shaft whose speed nothing determines.
fn free(scenario: &Scenario, solved: &Solved, brake: usize) -> ScenarioError {
    let entries = scenario.shafts().len();
    let shaft = (0..entries).find(|shaft| solved.ratio(*shaft).is_none()).unwrap_or(0);
    let name = format!("{:?}", scenario.shafts()[shaft].name);
    let key = entry_key("shaft", shaft, entries, "name");
    let is_member =
        scenario.planetary().iter().any(|set| set.shafts().contains(&Some(&scenario.shafts()[shaft].name)));
    if is_member {
        let problem = "is free to turn at any speed: a planetary set determines a member only by both others";
        return ScenarioError::new(key, name, problem)
            .with_help("write \"fixed\" for a member of the set, or tie its shaft to the motor's by meshes or another set");
    }
    let to = if shaft == brake { "the motor" } else { "motor or brake" };
    ScenarioError::new(key, name, format!("has no path of meshes to {to}"))
        .with_help("add a [[mesh]] of a wheel on it, or remove the shaft")
}

/// For each planetary set whether power passes from its sun to its planets, seen from the carrier: by the torques that hold the brake's. Where
/// shafts share them, they are the smallest that do.
fn sun_drives(
    scenario: &Scenario,
    relations: &[Relation],
    ratios: &[Ratio],
    [motor, brake]: [usize; 2],
) -> Vec<bool> {
    if scenario.planetary().is_empty() {
        return Vec::new();
    }
    let mut balance = DMatrix::zeros(ratios.len(), relations.len());
    for (column, relation) in relations.iter().enumerate() {
        relation.weights.iter().for_each(|&(shaft, weight)| balance[(shaft, column)] += weight as f64);
    }
    // The motor gives what is needed.
    balance.fill_row(motor, 0.0);
    let mut load = DVector::zeros(ratios.len());
    load[brake] = ratios[brake].value().signum();
    let torques =
        balance.svd(true, true).solve(&load, 1e-9).unwrap_or_else(|_| DVector::zeros(relations.len()));
    let of_set = |(number, set): (usize, &PlanetarySet)| {
        let column = relations.iter().position(|relation| relation.of == Tie::Set(number));
        let [sun, carrier, _] = member_ratios(scenario, set, ratios);
        let against_carrier = sun.plus(carrier.times(-1, 1)).value();
        column.is_none_or(|column| torques[column] * against_carrier <= 0.0)
    };
    scenario.planetary().iter().enumerate().map(of_set).collect()
}

/// Rotation of sun, carrier and ring over that of the input; 0 of a fixed one.
pub(super) fn member_ratios(scenario: &Scenario, set: &PlanetarySet, ratios: &[Ratio]) -> [Ratio; 3] {
    set.shafts().map(|name| {
        name.and_then(|name| scenario.shaft_number(name)).map_or(Ratio::whole(0), |shaft| ratios[shaft])
    })
}
