//! What the published convention ignores.

use super::{Convention, Scenario, ScenarioWarning};

/// A key that the published code ignores.
struct IgnoredKey {
    key: &'static str,
    /// Sets the key in the first scenario to its value in the second.
    copy: fn(&mut Scenario, &Scenario),
}

/// Convention: the published code accepts and ignores these, or fails.
const IGNORED_BY_PUBLISHED: [IgnoredKey; 5] = [
    IgnoredKey { key: "gears.tip_relief", copy: |to, from| to.gears.tip_relief = from.gears.tip_relief },
    IgnoredKey { key: "gears.foundation", copy: |to, from| to.gears.foundation = from.gears.foundation },
    IgnoredKey {
        key: "operation.speed_profile_hz",
        copy: |to, from| to.operation.speed_profile_hz.clone_from(&from.operation.speed_profile_hz),
    },
    IgnoredKey {
        key: "rig.bearing_stiffness_n_per_m",
        copy: |to, from| to.rig.bearing_stiffness_n_per_m = from.rig.bearing_stiffness_n_per_m,
    },
    IgnoredKey {
        key: "rig.eccentricity_mm",
        copy: |to, from| to.rig.eccentricity_mm = from.rig.eccentricity_mm,
    },
];

impl Scenario {
    /// The scenario with what its convention does not honour at its default.
    pub(crate) fn as_honoured(&self) -> Self {
        let mut honoured = self.clone();
        if self.convention == Convention::Published {
            let default = every_key_at_its_default();
            IGNORED_BY_PUBLISHED.iter().for_each(|ignored| (ignored.copy)(&mut honoured, &default));
        }
        honoured
    }

    /// Keys that are not at their default although the scenario's convention ignores them: some, under the
    /// published one.
    ///
    /// ```
    /// use meshtone::scenario::{Convention, Scenario};
    ///
    /// let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
    /// scenario.rig.eccentricity_mm = 0.02;
    /// assert!(scenario.ignored_by_convention().is_empty());
    ///
    /// scenario.convention = Convention::Published;
    /// assert_eq!(scenario.ignored_by_convention()[0].key, "rig.eccentricity_mm");
    /// ```
    pub fn ignored_by_convention(&self) -> Vec<ScenarioWarning> {
        if self.convention == Convention::Corrected {
            return Vec::new();
        }
        let default = every_key_at_its_default();
        let changed = |ignored: &&IgnoredKey| {
            let mut reset = self.clone();
            (ignored.copy)(&mut reset, &default);
            reset != *self
        };
        let warning = |ignored: &IgnoredKey| {
            let message = "is ignored: the published model does not honour it, and its default is simulated; \
                           remove it, or set convention = \"corrected\"";
            ScenarioWarning::new(ignored.key, message)
        };
        IGNORED_BY_PUBLISHED.iter().filter(changed).map(warning).collect()
    }
}

/// The required keys are not at a default, but none of them is ignored.
fn every_key_at_its_default() -> Scenario {
    Scenario::new(1.0, 20, 20, 10.0, 1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Profile;

    fn with_everything_ignored() -> Scenario {
        let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
        scenario.gears.tip_relief = None;
        scenario.gears.foundation.q[3] = 0.0;
        scenario.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, 2.0], value: vec![40.0, 41.0] });
        scenario.rig.bearing_stiffness_n_per_m = 1e8;
        scenario.rig.eccentricity_mm = 0.01;
        scenario
    }

    #[test]
    fn every_ignored_key_is_reset_and_warned_of() {
        let mut scenario = with_everything_ignored();
        assert_eq!(scenario.as_honoured(), scenario);
        assert_eq!(scenario.ignored_by_convention(), []);
        scenario.convention = Convention::Published;
        let mut default = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
        default.convention = Convention::Published;
        assert_eq!(scenario.as_honoured(), default);
        assert_eq!(default.ignored_by_convention(), []);
        assert_eq!(scenario.ignored_by_convention().len(), IGNORED_BY_PUBLISHED.len());
    }
}
