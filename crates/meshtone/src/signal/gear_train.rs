//! The shafts of a machine by their tooth counts: what turns how fast, and which lines its wheels make.

use super::{SeparationSettings, ShaftPhase, SignalError, TrainBearing, TrainSet};
use crate::error::ScenarioError;
use crate::scenario::{Bearing, Layout, Ratio, Scenario};
use crate::simulate::Stages;

/// A shaft of a train.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrainShaft {
    /// Its name.
    pub name: String,
    /// Its speed over that of the first shaft of a pair, or of the input of a gearbox; positive.
    pub speed_ratio: Ratio,
}

/// A wheel of a train.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainWheel {
    /// Its name.
    pub name: String,
    /// Its teeth.
    pub teeth: u32,
    /// Number of its shaft.
    pub shaft: usize,
    /// (rev) Angle of the wheel where that of its shaft is 0, counted from where its first tooth enters contact. Only a simulation knows it.
    pub start_rev: f64,
}

/// Shafts, wheels, meshes and rolling bearings of a machine, as far as a recording shows them: a pair, or a gearbox of any number of shafts.
///
/// ```
/// use meshtone::scenario::{Scenario, gearbox_template};
/// use meshtone::signal::GearTrain;
///
/// let train = GearTrain::of_scenario(&Scenario::from_toml(&gearbox_template(None))?)?;
/// let ratios: Vec<String> = train.shafts.iter().map(|shaft| shaft.speed_ratio.to_string()).collect();
/// assert_eq!(ratios, ["1/1", "1/3", "1/5"]);
/// assert_eq!(train.mesh_order(1), 16.0);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GearTrain {
    /// The shafts.
    pub shafts: Vec<TrainShaft>,
    /// The wheels.
    pub wheels: Vec<TrainWheel>,
    /// Numbers of the two wheels of each mesh, the driving one first.
    pub meshes: Vec<[usize; 2]>,
    /// The ball and roller bearings, each with its name: shaft and place, such as `input:0`.
    pub bearings: Vec<(String, TrainBearing)>,
    /// The planetary sets whose carriers turn.
    pub sets: Vec<TrainSet>,
    /// Number of the shaft that the ratios are of: the pinion's, or the one that the motor turns.
    input: usize,
}

impl GearTrain {
    /// One wheel, or two that mesh, each on a shaft of its own.
    ///
    /// # Arguments
    /// * `wheels` - name and tooth count of the wheel on the first shaft, and of its mate where that is known; none without teeth
    pub fn of_wheels<const N: usize>(wheels: [(&str, u32); N]) -> Self {
        let first = wheels.first().map_or(1, |(_, teeth)| *teeth);
        let shaft = |&(name, teeth): &(&str, u32)| TrainShaft {
            name: name.to_owned(),
            speed_ratio: Ratio::ONE.times(i64::from(first), i64::from(teeth)),
        };
        let wheel = |(shaft, &(name, teeth)): (usize, &(&str, u32))| TrainWheel {
            name: name.to_owned(),
            teeth,
            shaft,
            start_rev: 0.0,
        };
        Self {
            shafts: wheels.iter().map(shaft).collect(),
            wheels: wheels.iter().enumerate().map(wheel).collect(),
            meshes: (1..N).map(|mate| [0, mate]).collect(),
            bearings: Vec::new(),
            sets: Vec::new(),
            input: 0,
        }
    }

    /// A shaft without wheels.
    ///
    /// # Arguments
    /// * `name` - its name
    pub fn of_shaft(name: &str) -> Self {
        let shaft = TrainShaft { name: name.to_owned(), speed_ratio: Ratio::ONE };
        Self { shafts: vec![shaft], ..Self::of_wheels([]) }
    }

    /// The shafts of a scenario, by its names and in its order.
    ///
    /// # Arguments
    /// * `scenario` - what is simulated
    ///
    /// # Errors
    /// Those of [`Scenario::layout`].
    pub fn of_scenario(scenario: &Scenario) -> Result<Self, ScenarioError> {
        Ok(Self::of_layout(scenario, &scenario.layout()?))
    }

    /// The shafts of a simulation.
    ///
    /// # Arguments
    /// * `stages` - of the simulation
    pub fn of_stages(stages: &Stages) -> Self {
        Self::of_layout(&stages.scenario, &stages.layout)
    }

    /// The shafts of a scenario whose layout is known, as after its simulation.
    ///
    /// # Arguments
    /// * `scenario` - what is simulated
    /// * `layout` - its layout
    pub fn of_layout(scenario: &Scenario, layout: &Layout) -> Self {
        let shafts = layout.shaft_names.iter().zip(&layout.ratios).map(|(name, ratio)| TrainShaft {
            name: name.clone(),
            speed_ratio: Ratio { numerator: ratio.numerator.abs(), ..*ratio },
        });
        let wheels = scenario.wheels.iter().enumerate().map(|(number, wheel)| TrainWheel {
            name: wheel.name.clone(),
            teeth: wheel.teeth,
            shaft: layout.shaft_of_wheel[number],
            start_rev: layout
                .mesh_of(number)
                .map_or(0.0, |(mesh, _)| layout.phases[mesh] / f64::from(wheel.teeth)),
        });
        // Those of a valid scenario are complete.
        let bearing = |(bearing, &shaft): (&Bearing, &usize)| {
            let geometry = bearing.rolling().ok()??.geometry;
            Some((bearing.seat_name(), TrainBearing { geometry, shaft }))
        };
        Self {
            input: layout.input,
            shafts: shafts.collect(),
            wheels: wheels.collect(),
            meshes: layout.wheels_of_mesh.clone(),
            sets: TrainSet::all(scenario, layout),
            bearings: scenario.bearings().iter().zip(&layout.shaft_of_bearing).filter_map(bearing).collect(),
        }
    }

    /// Number of the shaft that the ratios are of: the input, which the motor turns.
    pub fn input(&self) -> usize {
        self.input
    }

    /// Name of a mesh: `z1-z2`.
    ///
    /// # Arguments
    /// * `mesh` - its number
    pub fn mesh_name(&self, mesh: usize) -> String {
        self.meshes[mesh].map(|wheel| self.wheels[wheel].name.as_str()).join("-")
    }

    /// (orders of the input) Frequency of a mesh.
    ///
    /// # Arguments
    /// * `mesh` - its number
    pub fn mesh_order(&self, mesh: usize) -> f64 {
        let wheel = &self.wheels[self.meshes[mesh][0]];
        f64::from(wheel.teeth) * self.shafts[wheel.shaft].speed_ratio.value()
    }

    /// Speed of a shaft over that of another.
    ///
    /// # Arguments
    /// * `shaft`, `other` - their numbers
    pub fn speed_ratio(&self, shaft: usize, other: usize) -> Ratio {
        let Ratio { numerator, denominator } = self.shafts[other].speed_ratio;
        self.shafts[shaft].speed_ratio.times(denominator, numerator)
    }

    /// Tooth counts of all wheels on a shaft: its mesh orders.
    ///
    /// # Arguments
    /// * `shaft` - its number
    pub fn teeth_on(&self, shaft: usize) -> impl Iterator<Item = u32> {
        self.wheels.iter().filter(move |wheel| wheel.shaft == shaft).map(|wheel| wheel.teeth)
    }

    /// The phase of a shaft, carried through the tooth counts from that of another.
    ///
    /// # Arguments
    /// * `known` - phase of the other shaft
    /// * `of` - number of the other shaft
    /// * `shaft` - number of the shaft that is asked for
    ///
    /// # Errors
    /// Angles that do not rise.
    pub fn carried(&self, known: &ShaftPhase, of: usize, shaft: usize) -> Result<ShaftPhase, SignalError> {
        if of == shaft { Ok(known.clone()) } else { known.geared(self.speed_ratio(shaft, of)) }
    }

    /// What belongs to the regular part of a wheel's average: the mesh orders of all wheels on its shaft with their sidebands; in a gearbox of
    /// three shafts or more also the whole orders that faster shafts and other meshes have.
    ///
    /// An average over the revolutions of a shaft that turns a third as fast as another holds all that repeats with the other one: its
    /// damage would look like three damaged teeth. With a speed ratio of p to q in lowest terms those are multiples of the order p.
    ///
    /// # Arguments
    /// * `wheel` - number of the wheel
    /// * `settings` - sidebands, shaft orders and mean
    ///
    /// ```
    /// use meshtone::scenario::{Scenario, gearbox_template};
    /// use meshtone::signal::{GearTrain, SeparationSettings};
    ///
    /// let train = GearTrain::of_scenario(&Scenario::from_toml(&gearbox_template(None))?)?;
    /// let of_middle = train.separation(1, &SeparationSettings::new(96));
    /// assert_eq!((of_middle.other_teeth, of_middle.other_orders), (vec![48], vec![3]));
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn separation(&self, wheel: usize, settings: &SeparationSettings) -> SeparationSettings {
        let TrainWheel { teeth, shaft, .. } = self.wheels[wheel];
        let others =
            self.wheels.iter().enumerate().filter(|(other, of)| *other != wheel && of.shaft == shaft);
        SeparationSettings {
            teeth: teeth as usize,
            other_teeth: others.map(|(_, other)| other.teeth as usize).collect(),
            other_orders: self.other_orders(shaft),
            ..settings.clone()
        }
    }

    /// The orders of a shaft whose multiples are orders of a faster shaft or of a mesh of others.
    fn other_orders(&self, shaft: usize) -> Vec<usize> {
        if self.shafts.len() < 3 {
            return Vec::new();
        }
        let faster = (0..self.shafts.len())
            .map(|other| self.speed_ratio(other, shaft))
            .filter(|ratio| ratio.numerator > ratio.denominator);
        let meshes = self.meshes.iter().map(|[driving, _]| &self.wheels[*driving]);
        let meshes =
            meshes.map(|wheel| self.speed_ratio(wheel.shaft, shaft).times(i64::from(wheel.teeth), 1));
        let orders = faster.chain(meshes).filter_map(|ratio| usize::try_from(ratio.numerator).ok());
        let own: Vec<usize> = self.teeth_on(shaft).map(|teeth| teeth as usize).collect();
        let mut orders: Vec<usize> =
            orders.filter(|order| *order > 1 && !own.iter().any(|teeth| order % teeth == 0)).collect();
        orders.sort_unstable();
        orders.dedup();
        let all = orders.clone();
        orders.retain(|order| !all.iter().any(|other| other < order && order % other == 0));
        orders
    }

    /// (rev) Revolutions of a shaft after which the same teeth of all wheels meet again.
    ///
    /// # Arguments
    /// * `shaft` - its number
    pub fn revolutions_of_a_cycle(&self, shaft: usize) -> usize {
        (1.0 / self.spacings(shaft).1).round() as usize
    }

    /// (orders of a shaft) Distances of the orders of each shaft, and of those at which the same teeth meet again: all that is periodic in
    /// the train is a multiple of the last one.
    ///
    /// # Arguments
    /// * `of` - number of the shaft whose orders they are
    pub(super) fn spacings(&self, of: usize) -> (Vec<f64>, f64) {
        let ratios: Vec<Ratio> = (0..self.shafts.len()).map(|shaft| self.speed_ratio(shaft, of)).collect();
        let hunting = ratios.iter().copied().fold(ratios[of], Ratio::common_measure);
        (ratios.iter().map(|ratio| ratio.value()).collect(), hunting.value())
    }

    /// The rolling bearings, of those with one geometry on one shaft, whose defects show at the same orders, the first.
    pub fn distinct_bearings(&self) -> Vec<TrainBearing> {
        let mut distinct = Vec::new();
        for (_, bearing) in &self.bearings {
            if !distinct.contains(bearing) {
                distinct.push(*bearing);
            }
        }
        distinct
    }
}
