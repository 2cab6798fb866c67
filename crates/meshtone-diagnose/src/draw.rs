//! Draws from a prior: rigs with their damages.

use meshtone::damage::{Fault, FaultyTeeth};
use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{DamageKind, Scenario, ScenarioError, SensorPath};

use crate::answer::SEVERAL;
use crate::prior::{Prior, unstated};

/// Records of one pair of wheels: how it was when it was healthy, how it is healthy another day, and damaged.
pub(crate) const RECORDS_PER_UNIT: u64 = 8;
/// (-) The least severity that is drawn.
const LEAST_SEVERITY: f64 = 0.02;
/// (Hz) Frequency at which a wall under the sensor bends as far as its support moves, where one is drawn, and the standard deviation of its
/// logarithm.
const PLATE_HZ: f64 = 4000.0;
const PLATE_SPREAD: f64 = 0.5;
/// (-) Standard deviation of the share of a mode of the housing: least and largest.
const HOUSING_STRENGTH: [f64; 2] = [0.1, 0.4];
/// (-) How far the sizes of a damage lie from those of its severity: the largest logarithm of the ratio.
const SIZE_SPREAD: f64 = 0.3;
/// (-) Part of the records whose speed and load are brought nearer to those of the healthy record of their pair, and the least factor by which
/// their distance is multiplied; its logarithm is uniform. Machines are measured at one operating point where that can be had.
const NEAR_PART: f64 = 1.0 / 3.0;
const LEAST_DISTANCE: f64 = 1e-3;
/// Draws of two damages before the record is given up: in every second the second one is the more severe.
const MOST_PAIRS: usize = 60;
/// Draws of a damage before the record goes without other sizes than those of its severity.
const MOST_ATTEMPTS: usize = 4;
/// Draws of a damage before a record of a [`Focus`] is given up: a range of severities is a tenth of all at least.
const MOST_FOCUSED_ATTEMPTS: usize = 100;

/// A damage that was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFault {
    /// Its kind, by its place in [`Prior::kinds`]; as many as these are two damages at once.
    pub kind: usize,
    /// The damaged wheel, by its place among the rig's; of two damages that of the more severe one.
    pub wheel: usize,
    /// Number of the damaged tooth from 1, of several of the first.
    pub tooth: u32,
    /// Whether that is the only one.
    pub is_on_one_tooth: bool,
    /// (-) How severe it is, from 0 to 1; of two damages the more severe one.
    pub severity: f64,
    /// Its sizes, in the order and units of the kind's [`DamageKind::sizes`].
    pub sizes: Vec<f64>,
}

/// A record that was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The scenario that is simulated.
    pub scenario: Scenario,
    /// The damage; none of a healthy record.
    pub fault: Option<DrawnFault>,
    /// The wall and the housing between the simulated sensor and the rig's.
    pub path: SensorPath,
    /// (dB) Gain of that path.
    pub gain_db: f64,
}

impl Drawn {
    /// (-) Gains of the path from the simulated sensor to the rig's at some frequencies.
    ///
    /// # Arguments
    /// * `frequencies_hz` - (Hz)
    pub fn path_gains(&self, frequencies_hz: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let gain = 10f64.powf(self.gain_db / 20.0);
        self.path.at(frequencies_hz).into_iter().map(|path| gain * path.norm()).collect()
    }
}

impl Prior {
    /// The name of a damage that was drawn.
    ///
    /// # Arguments
    /// * `kind` - its place among the kinds
    pub(crate) fn label(kinds: &[DamageKind], kind: usize) -> &'static str {
        kinds.get(kind).map_or(SEVERAL, |kind| kind.name)
    }

    /// A record, the same whatever else is drawn.
    ///
    /// # Arguments
    /// * `number` - of the record: the first two of every eight are healthy
    ///
    /// # Errors
    /// A scenario that is not valid.
    pub fn draw(&self, number: u64) -> Result<Drawn, ScenarioError> {
        self.draw_among(&self.kinds(), number)
    }

    /// Finds the kind and the wheel that a record damages: each kind, and two damages at once, on each wheel in turn; none of a healthy
    /// record, and where there are no kinds.
    pub(crate) fn class(&self, kinds: &[DamageKind], number: u64) -> Option<(usize, usize)> {
        match (&self.focus, number % RECORDS_PER_UNIT) {
            (_, 0) | (None, 1) => None,
            (Some(focus), _) => Some((focus.kind, focus.wheel)),
            (None, place) => {
                let turn = number / RECORDS_PER_UNIT * (RECORDS_PER_UNIT - 2) + place - 2;
                let (wheels, kinds) = (self.train.wheels.len(), kinds.len());
                let turn = turn as usize % (wheels * (kinds + 1));
                (kinds > 0).then_some((turn / wheels, turn % wheels))
            }
        }
    }

    /// Does what [`Self::draw`] does, where the kinds are known already: finding them takes a check of a scenario of each.
    ///
    /// Numbers of the rig are drawn once for a unit, the damage and the noise for each record, each from draws of its own purpose, so that a record can be made
    /// again alone.
    pub(crate) fn draw_among(&self, kinds: &[DamageKind], number: u64) -> Result<Drawn, ScenarioError> {
        let mut common = Draws::new(self.seed, Purpose::DiagnosisUnit, number / RECORDS_PER_UNIT);
        let mut own = Draws::new(self.seed, Purpose::DiagnosisRecord, number);
        let mut numbers: Vec<(&str, f64)> = Vec::new();
        let known = self.base.numbers();
        for spread in &self.spreads {
            let factor = (spread.deviation * common.normal()).exp();
            if let Some(number) = known.iter().find(|number| number.key == spread.key) {
                numbers.push((&spread.key, number.value * factor));
            }
        }
        let steps = i64::from(self.grade_steps);
        let step = (common.bits() % (2 * steps as u64 + 1)) as i64 - steps;
        for number in known.iter().filter(|number| number.value > 0.0) {
            let coarsest = match number.key.rsplit('.').next() {
                Some("din_grade") => 12.0,
                Some("iso_class") => 11.0,
                _ => continue,
            };
            numbers.push((&number.key, (number.value + step as f64).clamp(1.0, coarsest)));
        }
        let (path, gain_db) = (self.draw_path(&mut common), self.gain_db * common.normal());
        let place = common.uniform(0.5, 0.5);
        let seed = common.bits() >> 1;
        // A pair runs at about its own speed and load.
        let [speed_change, load_change] = self.draw_change(number);
        let speed = 0.7 * self.speed_spread * common.uniform(0.0, 1.0) + speed_change;
        let load = self.load_spread * common.uniform(0.0, 1.0) + load_change;
        let operation = &self.base.operation;
        let is_healthy = number.is_multiple_of(RECORDS_PER_UNIT);
        let nominal_hz = self.healthy_speed_hz.filter(|_| is_healthy).unwrap_or(operation.pinion_speed_hz);
        let speed_hz = nominal_hz * speed.exp();
        let load_nm = operation.brake_torque_nm * load.exp();
        let mut scenario = self.base.with_numbers(&numbers)?;
        let operation = &mut scenario.operation;
        (operation.pinion_speed_hz, operation.brake_torque_nm) = (speed_hz, load_nm);
        // Other wheels than those of the rig's own, and the sensor anywhere where no place is stated.
        (scenario.seed, scenario.wheels_seed) = (seed, None);
        if let Some(housing) = scenario.housing_mut() {
            housing.modes.seed = seed;
        }
        if self.has_any_sensor {
            let places = scenario.sensor_places();
            let at = ((place * places.len() as f64) as usize).min(places.len().saturating_sub(1));
            scenario.sensors = places.into_iter().skip(at).take(1).map(unstated).collect();
        }
        let Some((kind, wheel)) = self.class(kinds, number) else {
            return Ok(Drawn { scenario, fault: None, path, gain_db });
        };
        let (scenario, fault) = match kind < kinds.len() {
            true => self.damaged(kinds, (kind, wheel), &scenario, &mut own)?,
            false => self.twice_damaged(kinds, wheel, &scenario, &mut own)?,
        };
        Ok(Drawn { scenario, fault: Some(fault), path, gain_db })
    }

    /// (-) Logarithms of the ratios of a record's speed and load to those of its pair.
    fn draw_change(&self, number: u64) -> [f64; 2] {
        let draw = |number: u64| {
            let mut draws = Draws::new(self.seed, Purpose::DiagnosisOperation, number);
            let uniform = draws.uniform(0.0, 1.0);
            let load = self.load_change * uniform * uniform.abs().powi(3);
            let speed = 0.3 * self.speed_spread * draws.uniform(0.0, 1.0);
            let is_near = draws.uniform(0.5, 0.5) < NEAR_PART;
            let distance = if is_near { LEAST_DISTANCE.powf(draws.uniform(0.5, 0.5)) } else { 1.0 };
            ([speed, load], distance)
        };
        let (healthy, _) = draw(number / RECORDS_PER_UNIT * RECORDS_PER_UNIT);
        let (own, distance) = draw(number);
        std::array::from_fn(|at| healthy[at] + distance * (own[at] - healthy[at]))
    }

    /// A housing, and where the rig names no sensor, in every other draw a wall.
    fn draw_path(&self, common: &mut Draws) -> SensorPath {
        let [least, largest] = HOUSING_STRENGTH;
        let mut path = SensorPath::RIGID;
        path.seed = common.bits() >> 1;
        path.strength = least * (largest / least).powf(common.uniform(0.5, 0.5));
        let (has_wall, plate_hz) =
            (common.uniform(0.5, 0.5) < 0.5, PLATE_HZ * (PLATE_SPREAD * common.normal()).exp());
        if self.has_any_sensor && has_wall {
            path.plate_hz = plate_hz;
        }
        path
    }

    /// Damages a rig twice: any two kinds, the more severe one on a wheel, the other on any.
    fn twice_damaged(
        &self,
        kinds: &[DamageKind],
        wheel: usize,
        healthy: &Scenario,
        own: &mut Draws,
    ) -> Result<(Scenario, DrawnFault), ScenarioError> {
        for _ in 0..MOST_PAIRS {
            let other = (own.bits() % self.train.wheels.len() as u64) as usize;
            let drawn = [wheel, other].map(|wheel| {
                let kind = (own.bits() % kinds.len() as u64) as usize;
                self.damaged(kinds, (kind, wheel), healthy, own)
            });
            let [Ok((one, first)), Ok((other, second))] = drawn else { continue };
            let faults = [one.faults, other.faults].concat();
            let both = healthy.clone().with_faults(faults);
            // Two damages of one tooth may not go together.
            if first.severity >= second.severity && both.validate().is_ok() {
                let (kind, sizes) = (kinds.len(), Vec::new());
                let fault = DrawnFault { kind, is_on_one_tooth: false, sizes, ..first };
                return Ok((both, fault));
            }
        }
        Err(ScenarioError::new("fault", SEVERAL, "no two damages that were drawn go together"))
    }

    /// Damages a rig.
    ///
    /// Severity and sizes are drawn until they fit the tooth: not every severity can be had with every scenario, and the sizes vary about those
    /// of the severity. The last attempt takes exactly the sizes of its severity. The severity that counts is that of the sizes in the end.
    ///
    /// # Arguments
    /// * `kinds` - those of the rig
    /// * `class` - the kind by its place among them, and the wheel
    /// * `healthy` - without the damage
    fn damaged(
        &self,
        kinds: &[DamageKind],
        (kind, wheel): (usize, usize),
        healthy: &Scenario,
        own: &mut Draws,
    ) -> Result<(Scenario, DrawnFault), ScenarioError> {
        let of_kind = &kinds[kind];
        // Other severities are drawn again.
        let within = self.focus.as_ref().map(|focus| focus.severity);
        let usual = Fault::at_usual_place(of_kind.example.clone());
        let tooth = 1 + (own.bits() % u64::from(self.train.wheels[wheel].teeth)) as u32;
        let is_on_one_tooth = usual.tooth == FaultyTeeth::One(1);
        let teeth = if is_on_one_tooth { FaultyTeeth::One(tooth) } else { usual.tooth };
        let attempts = if within.is_some() { MOST_FOCUSED_ATTEMPTS } else { MOST_ATTEMPTS };
        for attempt in 0..attempts {
            let least = LEAST_SEVERITY;
            let drawn = least + (1.0 - least) * own.uniform(0.5, 0.5);
            let severity = if of_kind.sizes.is_empty() { 1.0 } else { drawn };
            let fault = Fault::new(&self.base.wheels[wheel].name, teeth.clone(), of_kind.example.clone());
            let fault = fault.with_severity(severity);
            let sized = healthy.clone().with_faults(vec![fault]).with_own_sizes()?;
            if sized.faults.is_empty() {
                continue;
            }
            let spread = if attempt + 1 < attempts { SIZE_SPREAD } else { 0.0 };
            let keys: Vec<String> = of_kind.sizes.iter().map(|size| format!("fault.{size}")).collect();
            let other: Vec<(&str, f64)> = keys
                .iter()
                .filter_map(|key| Some((key.as_str(), sized.number(key)? * own.uniform(0.0, spread).exp())))
                .collect();
            let Ok(damaged) = sized.with_numbers(&other) else { continue };
            let Ok(severities) = damaged.fault_severities() else { continue };
            let severity = severities[0].min(1.0);
            if within.is_some_and(|[least, most]| severity < least || severity > most) {
                continue;
            }
            let sizes = keys.iter().map(|key| damaged.number(key).unwrap_or(f64::NAN)).collect();
            return Ok((damaged, DrawnFault { kind, wheel, tooth, is_on_one_tooth, severity, sizes }));
        }
        // A record that is counted as healthy because its damage cannot be would be wrong.
        let problem = "no damage of this kind that was drawn fits the tooth";
        Err(ScenarioError::new("fault.kind", format!("\"{}\"", of_kind.name), problem))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prior::Focus;
    use crate::synthetic::{gearbox_prior, prior};

    #[test]
    fn a_record_is_the_same_whatever_else_is_drawn() {
        let prior = prior();
        let again = [13, 4, 13].map(|number| prior.draw(number).unwrap());
        // A size that is a list is not a number, and not equal to itself.
        let [first, other, second] = again.each_ref().map(|drawn| format!("{drawn:?}"));
        assert!(first == second && first != other);
        assert_ne!(again[0].scenario.number("seed"), again[1].scenario.number("seed"));
    }

    // The two healthy records of a pair have its wheels; each kind comes on each wheel as often as the next.
    #[test]
    fn pairs_have_healthy_records_and_all_damages_in_turn() {
        let prior = prior();
        let kinds = prior.kinds().len() + 1;
        let mut counts = vec![0; 2 * kinds];
        for number in 0..8 * kinds as u64 {
            let drawn = prior.draw(number).unwrap();
            assert_eq!(drawn.fault.is_none(), number % 8 < 2);
            if let Some(fault) = drawn.fault {
                counts[2 * fault.kind + fault.wheel] += 1;
                assert_eq!(drawn.scenario.faults.len(), if fault.kind + 1 < kinds { 1 } else { 2 });
                assert!((0.0..=1.0).contains(&fault.severity));
            }
        }
        assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
        let [first, second] = [0, 1].map(|number| prior.draw(number).unwrap());
        let seeds = [&first, &second].map(|drawn| drawn.scenario.number("seed"));
        assert_eq!((seeds[0], first.path), (seeds[1], second.path));
    }

    // A healthy recording and the one in question are of one speed and load, of about one load, or of quite another one.
    #[test]
    fn loads_of_a_pair_are_the_same_near_each_other_or_far_apart() {
        let prior = prior();
        let operation = |number| prior.draw_among(&[], number).unwrap().scenario.operation.clone();
        let of_units = (0..1000).map(|unit| [operation(8 * unit + 1), operation(8 * unit)]);
        let (speeds, apart): (Vec<f64>, Vec<f64>) = of_units
            .map(|[now, healthy]| {
                let speed = (now.pinion_speed_hz / healthy.pinion_speed_hz).ln();
                (speed, (now.brake_torque_nm / healthy.brake_torque_nm).ln())
            })
            .unzip();
        // Of a million draws in NumPy 17.2 %, 11.0 % higher, 11.1 % lower; of a thousand a standard error is 1.2 %, 1.0 %.
        let same = speeds.iter().zip(&apart).filter(|(speed, load)| speed.abs() < 6e-4 && load.abs() < 0.05);
        let same = same.count();
        assert!((136..=208).contains(&same), "{same}");
        let part = |least: f64, most: f64| {
            apart.iter().filter(|apart| (least..most).contains(*apart)).count() as f64 / 1000.0
        };
        let [near, higher, lower] = [part(-0.25, 0.25), part(1.0, 4.6), part(-4.6, -1.0)];
        assert!(near > 0.4 && higher > 0.08 && lower > 0.08, "{near} {higher} {lower}");
    }

    // Another speed of the healthy recordings changes the first record of each pair alone, and its speed alone.
    #[test]
    fn healthy_records_are_drawn_at_their_own_speed() {
        let prior = prior();
        let other = Prior { healthy_speed_hz: Some(28.0), ..prior.clone() };
        for number in 0..8 {
            let [one, mut two] =
                [&prior, &other].map(|prior| prior.draw_among(&[], number).unwrap().scenario);
            if number == 0 {
                let ratio = two.operation.pinion_speed_hz / one.operation.pinion_speed_hz;
                assert!((ratio - 28.0 / prior.base.operation.pinion_speed_hz).abs() < 1e-12, "{ratio}");
                two.operation.pinion_speed_hz = one.operation.pinion_speed_hz;
            }
            assert_eq!(one, two);
        }
    }

    #[test]
    fn a_focus_draws_its_damage_at_the_recordings_speed() {
        let prior = prior();
        let kind = prior.kinds().iter().position(|kind| kind.name == "tooth-breakage").unwrap();
        let focus = Focus { kind, wheel: 0, severity: [0.3, 0.5] };
        let narrowed = prior.narrowed(focus, Some(43.0), Some(43.0));
        for number in 0..24 {
            let drawn = narrowed.draw(number).unwrap();
            assert!((drawn.scenario.operation.pinion_speed_hz / 43.0 - 1.0).abs() < 0.003);
            let Some(fault) = drawn.fault else { continue };
            assert_eq!((fault.kind, fault.wheel, number % 8 > 0), (kind, 0, true));
            assert!((0.3..=0.5).contains(&fault.severity), "{}", fault.severity);
        }
        let seed = |prior: &Prior| prior.draw(0).unwrap().scenario.number("seed");
        assert_ne!(seed(&narrowed), seed(&prior));
    }

    // Every kind is drawn on every wheel, the wheels' own numbers are left alone, and the sensor sits on any seat.
    #[test]
    fn a_gearbox_is_drawn_with_damage_on_every_wheel() {
        let prior = gearbox_prior();
        let classes = prior.train.wheels.len() as u64 * (prior.kinds().len() as u64 + 1);
        let mut seen = std::collections::BTreeSet::new();
        let mut seats = std::collections::BTreeSet::new();
        for number in 0..classes.div_ceil(6) * RECORDS_PER_UNIT {
            let drawn = prior.draw(number).unwrap();
            let gearbox = &drawn.scenario;
            seats.insert(gearbox.sensors[0].at.name().to_owned());
            assert_eq!((gearbox.sensors.len(), gearbox.wheels[3].teeth), (1, 48));
            let Some(fault) = drawn.fault else { continue };
            let wheels: Vec<usize> = drawn.scenario.placed_faults().iter().map(|(wheel, _)| *wheel).collect();
            assert!(wheels.contains(&fault.wheel), "{wheels:?} {fault:?}");
            seen.insert((fault.kind, fault.wheel));
        }
        assert_eq!(seen.len() as u64, classes);
        assert!(seats.len() > 3, "{seats:?}");
        let keys: Vec<&str> = prior.spreads.iter().map(|spread| spread.key.as_str()).collect();
        for key in ["bearing[input:0].stiffness_n_per_m", "housing.mass_kg", "mesh[z1-z2].damping_ratio"] {
            assert!(keys.contains(&key), "{key}: {keys:?}");
        }
    }
}
