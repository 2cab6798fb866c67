//! Recordings of planetary sets: where the planets stand, and how each wheel passes the sensor.

use meshtone_fourier::{from_real_spectrum, real_spectrum};

use super::record::as_series;
use super::{
    AngleZero, AngularSettings, AngularSignal, ChainSettings, GearTrain, Passages, PassingSignal, Record,
    ShaftPhase, SignalError, SignalWarning, SynchronousAverage, TrainRecording, angular_resample,
    planetary_average, process_average,
};
use crate::scenario::{Layout, Member, MemberTeeth, Ratio, Scenario, SetLayout};
use crate::sensor::{RingPlace, Sensor};

/// A planetary set whose planets pass a sensor: its carrier turns.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TrainSet {
    /// Its name.
    pub name: String,
    /// Number of its sun among the wheels; the planets follow, and then the ring.
    pub first_wheel: usize,
    /// Speed of the carrier over that of the input, with its sign.
    pub carrier: Ratio,
    /// (rev) Where each planet stands on the carrier where that has angle 0, from x towards y.
    pub planets_rev: Vec<f64>,
    /// (rev) By how much the sun is further in its mesh with each planet than in that with the first.
    pub sun_ahead_rev: Vec<f64>,
    /// (rev) Where the sensor sits, from x towards y; none where only the recording can show it.
    pub sensor_rev: Option<f64>,
}

impl TrainSet {
    /// The sets whose carriers turn.
    pub(super) fn all(scenario: &Scenario, layout: &Layout) -> Vec<Self> {
        let set = |(of, name): (&SetLayout, &str)| {
            let turn = |rad: &f64| rad / std::f64::consts::TAU;
            let phases = &layout.phases[of.first_mesh..of.first_mesh + of.planets()];
            let sun_teeth = f64::from(scenario.wheels[of.first_wheel].teeth);
            Self {
                name: name.to_owned(),
                first_wheel: of.first_wheel,
                carrier: of.ratios[1],
                planets_rev: of.angles_rad.iter().map(turn).collect(),
                sun_ahead_rev: phases.iter().map(|phase| (phase - phases[0]) / sun_teeth).collect(),
                sensor_rev: None,
            }
        };
        let turns = |set: &Self| set.carrier.numerator != 0;
        layout.sets.iter().zip(scenario.set_names()).map(set).filter(turns).collect()
    }

    /// (rev) By how much the carrier turns until a planet is in front of the sensor, from its angle 0 on.
    fn passage_rev(&self, sensor_rev: f64, planet: usize) -> f64 {
        (sensor_rev - self.planets_rev[planet]) * self.carrier.value().signum()
    }
}

impl GearTrain {
    /// The train with the place of the sensor that a channel of its simulation comes from, where that sits on the ring of a set.
    ///
    /// # Arguments
    /// * `scenario` - what was simulated
    /// * `channel` - name of the channel, with its unit or without
    #[must_use]
    pub fn at_sensor(mut self, scenario: &Scenario, channel: &str) -> Self {
        let is = |sensor: &Sensor| [sensor.channel(), sensor.name()].iter().any(|name| name == channel);
        let sensor = scenario.all_sensors().into_iter().find(is);
        let place = sensor.and_then(|sensor| RingPlace::of(sensor.at.name()));
        for set in &mut self.sets {
            let on_ring = place.as_ref().filter(|place| place.set == set.name);
            set.sensor_rev = on_ring.map(|place| place.angle_rad / std::f64::consts::TAU);
        }
        self
    }

    /// Order of the carrier against the ring at which one damaged tooth of a wheel of a set meets its mates; none of a wheel outside of sets.
    ///
    /// # Arguments
    /// * `wheel` - its number
    pub fn tooth_order_of_carrier_against_ring(&self, wheel: usize) -> Option<f64> {
        self.sets.iter().find_map(|set| {
            let (first, planets) = (set.first_wheel, set.planets_rev.len());
            let [sun, planet, ring] = [first, first + 1, first + 1 + planets].map(|n| self.wheels[n].teeth);
            let orders = MemberTeeth { sun, planet, ring }.orders(planets);
            match wheel.checked_sub(first)? {
                0 => Some(orders.sun_tooth),
                number if number <= planets => Some(orders.planet_tooth),
                number if number == planets + 1 => Some(orders.ring_tooth),
                _ => None,
            }
        })
    }

    /// The set that a wheel belongs to, where planets carry its meshes past the sensor: of planets and suns. A ring stands before it.
    fn passing_member(&self, wheel: usize) -> Option<(&TrainSet, Member)> {
        self.sets.iter().find_map(|set| {
            let planets = set.planets_rev.len();
            match wheel.checked_sub(set.first_wheel)? {
                0 => Some((set, Member::Sun)),
                number if number <= planets => Some((set, Member::Planet(number - 1))),
                _ => None,
            }
        })
    }
}

/// The signals of a wheel that planets carry past the sensor.
pub(super) struct Passing {
    signals: Vec<PassingSignal>,
    passages: Passages,
    warnings: Vec<SignalWarning>,
}

impl Passing {
    /// The average of all there is.
    pub(super) fn average(&self) -> Result<SynchronousAverage, SignalError> {
        Ok(planetary_average(&self.signals, &self.passages)?.average)
    }

    /// The records of the wheel: of all there is, or of segments.
    ///
    /// # Arguments
    /// * `settings` - what is regular
    /// * `revolutions` - of the wheel against the carrier in a segment
    pub(super) fn records(
        &self,
        settings: &ChainSettings,
        revolutions: Option<usize>,
    ) -> Result<Vec<Record>, SignalError> {
        let whole = self.signals.iter().map(|of| of.angular.revolutions()).min().unwrap_or(0);
        let count = revolutions.unwrap_or(whole);
        if count == 0 || whole < count {
            return Err(SignalError::TooFewRevolutions { revolutions: whole as f64, needed: count.max(1) });
        }
        let record = |segment: usize| {
            let signals: Vec<_> = self.signals.iter().map(|of| of.part(segment * count, count)).collect();
            let average = planetary_average(&signals, &self.passages)?.average;
            let mut record = process_average(average, self.passages.teeth, settings)?;
            record.warnings.extend(self.warnings.iter().cloned());
            Ok(record)
        };
        as_series((0..whole / count).map(record).collect())
    }
}

impl PassingSignal {
    /// Some revolutions of it.
    fn part(&self, from_rev: usize, count: usize) -> Self {
        let points = self.angular.points_per_revolution;
        let angular = AngularSignal {
            start_rev: self.angular.start_rev + from_rev as f64,
            values: self.angular.values[from_rev * points..(from_rev + count) * points].to_vec(),
            ..self.angular
        };
        Self { angular, ..*self }
    }
}

/// Parts of the carrier's revolution in which the sensor's place is looked for.
const PLACES: usize = 360;

impl TrainRecording<'_> {
    /// The signals of a wheel of a set whose planets pass the sensor; none of any other wheel.
    ///
    /// A simulation says itself where its planets and sensors are. Of another recording, or where the sensor is not on the ring, the place is taken
    /// at which the recording is loudest.
    ///
    /// # Arguments
    /// * `wheel` - its number
    /// * `settings` - how the signal is resampled
    pub(super) fn passing(
        &self,
        wheel: usize,
        settings: &AngularSettings,
    ) -> Result<Option<Passing>, SignalError> {
        let Some((set, member)) = self.train.passing_member(wheel) else { return Ok(None) };
        let of = &self.train.wheels[wheel];
        let phase = self.wheel_phase(wheel)?;
        let is_simulated = phase.zero == AngleZero::Simulated;
        let mut warnings = Vec::new();
        let sensor_rev = match set.sensor_rev.filter(|_| is_simulated) {
            Some(known) => known,
            None => {
                let (found, warning) = self.find_sensor(set)?;
                warnings.push(warning);
                found
            }
        };
        let Ratio { numerator, denominator } = set.carrier;
        let period = self.train.shafts[of.shaft].speed_ratio.times(denominator, numerator.abs());
        let passages = Passages { period, planets: set.planets_rev.len(), teeth: of.teeth };
        let mut settings = *settings;
        let of_planet = |planet: usize| {
            let ahead_rev = if member == Member::Sun { set.sun_ahead_rev[planet] } else { 0.0 };
            let mut phase = phase.clone();
            phase.revolutions.iter_mut().for_each(|angle| *angle += ahead_rev);
            let angular = angular_resample(self.signal, &phase, &settings)?;
            settings.points_per_revolution = Some(angular.points_per_revolution);
            let start_rev = if is_simulated { of.start_rev } else { 0.0 };
            let turned_rev = set.passage_rev(sensor_rev, planet) * period.value();
            Ok(PassingSignal { angular, passage_rev: turned_rev + start_rev + ahead_rev })
        };
        let planets = match member {
            Member::Planet(planet) => planet..planet + 1,
            _ => 0..set.planets_rev.len(),
        };
        let signals = planets.map(of_planet).collect::<Result<_, SignalError>>()?;
        Ok(Some(Passing { signals, passages, warnings }))
    }

    /// (rev) Where the sensor sits by the recording: where windows around the passages hold most of the band around the mesh order.
    ///
    /// Source: G. D'Elia, E. Mucchi, M. Cocconcelli, "On the identification of the angular position of gears for the diagnostics of planetary gearboxes",
    /// Mech. Syst. Signal Process. 83 (2017) 305–320.
    fn find_sensor(&self, set: &TrainSet) -> Result<(f64, SignalWarning), SignalError> {
        let (known, phase, _) = self.turning.known_phase(self.train)?;
        let Ratio { numerator, denominator } = self.train.shafts[known].speed_ratio;
        let ratio = set.carrier.times(denominator, numerator);
        let carrier: ShaftPhase = phase.geared(Ratio { numerator: ratio.numerator.abs(), ..ratio })?;
        let angular = angular_resample(self.signal, &carrier, &AngularSettings::default())?;
        let sun = &self.train.wheels[set.first_wheel];
        let meshes_per_rev = f64::from(sun.teeth) * self.train.shafts[sun.shaft].speed_ratio.value()
            / set.carrier.value().abs();
        let mesh_line = meshes_per_rev * angular.revolutions() as f64;
        let mut spectrum = real_spectrum(&angular.values);
        for (line, value) in spectrum.iter_mut().enumerate() {
            if (line as f64 - mesh_line).abs() > 0.5 * mesh_line {
                *value *= 0.0;
            }
        }
        let mut powers = [0.0; PLACES];
        for (at, value) in from_real_spectrum(spectrum, angular.values.len()).iter().enumerate() {
            let points = angular.points_per_revolution;
            powers[at % points * PLACES / points] += value * value;
        }
        let apart_rev = |planet: usize| set.passage_rev(0.0, planet) - set.passage_rev(0.0, 0);
        let centres_rev: Vec<f64> = (0..set.planets_rev.len()).map(apart_rev).collect();
        let in_windows = |place: usize| -> f64 {
            let weight = |part: usize, centre_rev: &f64| {
                let away = (part as f64 + 0.5 - place as f64) / PLACES as f64 - centre_rev;
                let away = (away - away.round()) * centres_rev.len() as f64;
                if away.abs() < 0.5 { (std::f64::consts::PI * away).cos().powi(2) } else { 0.0 }
            };
            let weights = |part: usize| centres_rev.iter().map(|centre| weight(part, centre)).sum::<f64>();
            powers.iter().enumerate().map(|(part, power)| weights(part) * power).sum()
        };
        let loudest = (0..PLACES).map(|place| (place, in_windows(place))).fold((0, -1.0), |best, of| {
            // Of places that differ by rounding only, the first.
            if of.1 > best.1 * (1.0 + 1e-9) { of } else { best }
        });
        let carrier_rev = loudest.0 as f64 / PLACES as f64;
        let warning = SignalWarning::PlanetsFound { set: set.name.clone(), carrier_deg: 360.0 * carrier_rev };
        Ok((set.planets_rev[0] + set.carrier.value().signum() * carrier_rev, warning))
    }
}
