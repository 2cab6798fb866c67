//! Keys that a model ignores.

use super::short::{self, Section};
use super::{Model, Scenario, ScenarioWarning, Sensor, SensorPath, WarningKind};
use crate::keys::{KeyRow, Keys};

impl Scenario {
    /// The scenario with what its model does not honour at its default.
    pub(crate) fn without_ignored_keys(&self) -> Self {
        let mut honoured = self.clone();
        reset_ignored(&mut honoured);
        honoured
    }

    /// Keys that are not at their default although the scenario's model ignores them.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Model, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair::example());
    /// scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.02);
    /// assert!(scenario.ignored_by_model().is_empty());
    ///
    /// scenario.model = Model::Published;
    /// assert_eq!(scenario.ignored_by_model()[0].key, "rig.eccentricity_mm");
    /// ```
    pub fn ignored_by_model(&self) -> Vec<ScenarioWarning> {
        let warning = |key: String| {
            let message = format!(
                "is ignored: the {} model does not use it; remove it, or set another model",
                self.model.name()
            );
            ScenarioWarning::new(WarningKind::IgnoredKey, key, message)
        };
        reset_ignored(&mut self.clone()).into_iter().map(warning).collect()
    }
}

/// Gives every key that the scenario's model ignores its default.
///
/// # Returns
/// The keys that were not at it.
fn reset_ignored(scenario: &mut Scenario) -> Vec<String> {
    let model = scenario.model;
    let start = Scenario::start_of_rig();
    let mut changed = Vec::new();
    // Shafts of beams know one model.
    if scenario.rig().is_some() {
        for Section { name, rows } in
            [short::gears(), short::operation(), short::quality(), short::rig(), short::solver()]
        {
            changed.extend(reset(&rows, scenario, &start, name, model));
        }
    }
    let sensors = scenario.sensors.len();
    let of_sensor = |(index, sensor): (usize, &mut Sensor)| {
        let name = if sensors > 1 { format!("sensor[{index}]") } else { "sensor".to_owned() };
        reset_sensor(sensor, &name, model)
    };
    let sensors = scenario.sensors.iter_mut().enumerate().flat_map(of_sensor);
    changed.extend(sensors.collect::<Vec<_>>());
    changed
}

/// Resets ignored keys of a sensor, which keeps its name though that may come of its place.
fn reset_sensor(sensor: &mut Sensor, key: &str, model: Model) -> Vec<String> {
    let name = sensor.name();
    if model.ignores("sensor.path") && sensor.path.is_rigid() {
        // It says what the model does.
        sensor.path = SensorPath::default();
    }
    let changed = reset(&Sensor::rows(), sensor, &Sensor::start(), "sensor", model);
    let changed = changed.into_iter().map(|of| of.replacen("sensor", key, 1)).collect();
    if sensor.name() != name {
        sensor.name = Some(name);
    }
    if model.ignores("sensor.path") {
        // The wheels have no wall.
        sensor.path = SensorPath::RIGID;
    }
    changed
}

/// Resets ignored keys of a section.
///
/// # Arguments
/// * `rows` - its keys
/// * `section`, `start` - the section, and the one with its defaults
/// * `name` - its name
/// * `model` - that ignores keys
///
/// # Returns
/// The keys that were not at their default.
fn reset<S: Clone + PartialEq>(
    rows: &[KeyRow<S>],
    section: &mut S,
    start: &S,
    name: &str,
    model: Model,
) -> Vec<String> {
    let key = |row: &KeyRow<S>| format!("{name}.{}", row.head.name);
    let changed = rows.iter().filter(|row| model.ignores(&key(row))).filter(|row| {
        let before = section.clone();
        row.copy(start, section);
        *section != before
    });
    changed.map(key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{GearPair, Profile};

    fn with_everything_ignored() -> Scenario {
        let mut scenario = Scenario::new(GearPair::example());
        scenario.meshes[0].backlash_mm = Some(0.2);
        scenario.meshes[0].foundation.q[3] = 0.0;
        scenario.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, 2.0], value: vec![40.0, 41.0] });
        scenario.rig_mut().unwrap().bearing_stiffness_n_per_m = 1e8;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.01);
        scenario
    }

    #[test]
    fn every_ignored_key_is_reset_and_warned_of() {
        let mut scenario = with_everything_ignored();
        scenario.model = Model::Linear;
        let ignored = scenario.ignored_by_model();
        assert_eq!(
            ignored.iter().map(|warning| warning.key.as_str()).collect::<Vec<_>>(),
            ["gears.backlash_mm"]
        );
        scenario.meshes[0].backlash_mm = None;
        assert_eq!(scenario.without_ignored_keys(), scenario);
        scenario = with_everything_ignored();
        scenario.model = Model::Published;
        let mut default = Scenario::new(GearPair::example());
        default.model = Model::Published;
        assert_eq!(scenario.without_ignored_keys(), default);
        assert_eq!(default.ignored_by_model(), []);
        assert_eq!(scenario.ignored_by_model().len(), 5);
    }
}
