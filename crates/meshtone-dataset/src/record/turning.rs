//! How the wheels of a scenario turn, of a pair and of a gearbox alike.

use meshtone::operation::greatest_common_divisor;
use meshtone::scenario::{Layout, Scenario, ScenarioError, WheelName};

/// How the wheels of a scenario turn.
///
/// The *input* is the pinion of a pair and the motor's shaft of a gearbox. Angles are counted in its revolutions from the start of the
/// simulation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Turning {
    /// The wheels: pinion and gear, or those of the gearbox in its order.
    pub wheels: Vec<TurningWheel>,
    /// Number of the wheel that has the mark at which records begin: the gear of a pair, a wheel of the input of a gearbox.
    pub marked: usize,
    /// Turns of the marked wheel after which the same teeth meet again, as far as records begin in any of them.
    pub turns: u32,
    /// Whether a tooth of every wheel enters contact where a record begins, and not of the marked wheel alone.
    pub enter_together: bool,
}

/// A wheel that turns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TurningWheel {
    /// Name.
    pub name: String,
    /// Number of its teeth.
    pub teeth: u32,
    /// (Hz) Nominal speed of its shaft.
    pub speed_hz: f64,
    /// (pitches) What passes in a revolution of the input.
    pub pitches_per_revolution: f64,
    /// (pitches) What has passed at the start of the simulation.
    pub first_pitch: f64,
}

/// Most turns of the marked wheel in which a record of a gearbox begins: some gearboxes repeat after millions only.
const MOST_TURNS: i64 = 100;

impl Turning {
    /// How the wheels of a scenario turn.
    ///
    /// # Arguments
    /// * `scenario` - a valid one
    ///
    /// # Errors
    /// Those of [`Scenario::layout`].
    pub fn of(scenario: &Scenario) -> Result<Self, ScenarioError> {
        // Only the wheels of a rig enter contact together, and are counted from the gear's first tooth.
        if scenario.rig().is_some() {
            Ok(Self::of_pair(scenario))
        } else {
            Ok(Self::of_train(scenario, &scenario.layout()?))
        }
    }

    /// How the two wheels of a pair turn.
    pub fn of_pair(scenario: &Scenario) -> Self {
        let (gears, pinion_hz) = (&scenario.gears(), scenario.operation.pinion_speed_hz);
        let [pinion, gear] = [gears.pinion_teeth, gears.gear_teeth];
        let wheel = |side: WheelName| TurningWheel {
            name: side.name().to_owned(),
            teeth: gears.teeth(side),
            speed_hz: match side {
                WheelName::Pinion => pinion_hz,
                WheelName::Gear => pinion_hz * f64::from(pinion) / f64::from(gear),
            },
            pitches_per_revolution: f64::from(pinion),
            first_pitch: 0.0,
        };
        let common = greatest_common_divisor(pinion, gear);
        Self {
            wheels: WheelName::BOTH.map(wheel).to_vec(),
            marked: WheelName::Gear as usize,
            turns: pinion / common,
            enter_together: true,
        }
    }

    /// How the wheels of a train turn.
    pub fn of_train(gearbox: &Scenario, layout: &Layout) -> Self {
        let input_hz = gearbox.operation.pinion_speed_hz;
        let wheel = |number: usize| {
            let (of, shaft) = (&gearbox.wheels[number], layout.shaft_of_wheel[number]);
            let ratio = layout.ratios[shaft].value().abs();
            TurningWheel {
                name: of.name.clone(),
                teeth: of.teeth,
                speed_hz: input_hz * ratio,
                pitches_per_revolution: f64::from(of.teeth) * ratio,
                first_pitch: layout.mesh_of(number).map_or(0.0, |(mesh, _)| layout.phases[mesh]),
            }
        };
        let is_on_input = |shaft: &usize| layout.ratios[*shaft].value().abs() == 1.0;
        Self {
            wheels: (0..gearbox.wheels.len()).map(wheel).collect(),
            marked: layout.shaft_of_wheel.iter().position(is_on_input).unwrap_or(0),
            turns: layout.cycle_revolutions().clamp(1, MOST_TURNS) as u32,
            enter_together: false,
        }
    }

    /// (rev) Revolutions of the input after which records begin with the same teeth again.
    pub fn cycle_rev(&self) -> f64 {
        let marked = &self.wheels[self.marked];
        f64::from(self.turns) * f64::from(marked.teeth) / marked.pitches_per_revolution
    }

    /// Number of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - name of a wheel of the scenario
    pub fn number(&self, wheel: &str) -> usize {
        self.wheels.iter().position(|known| known.name == wheel).unwrap_or(0)
    }
}

impl TurningWheel {
    /// (rev) Angle of the input at which so many pitches have passed.
    pub fn input_rev(&self, pitches: f64) -> f64 {
        (pitches - self.first_pitch) / self.pitches_per_revolution
    }

    /// (pitches) What has passed at an angle of the input.
    pub fn pitches(&self, input_rev: f64) -> f64 {
        self.first_pitch + input_rev * self.pitches_per_revolution
    }
}
