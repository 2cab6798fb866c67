//! Where sensors among shafts of beams sit.

use super::layout::entry_key;
use super::{Layout, Scenario};
use crate::error::ScenarioError;
use crate::machine::GearboxPlace;
use crate::sensor::{RingPlace, check_own_name};

/// (-) How far from a bearing's place, as a part of the shaft's length, a sensor that names it may be.
const SAME_PLACE: f64 = 1e-6;

impl Scenario {
    /// Where each of [`Self::all_sensors`] sits; none of those on the ring of a planetary set, which turns in the coordinates of its set.
    ///
    /// # Arguments
    /// * `layout` - of this scenario
    ///
    /// # Errors
    /// A place that there is not; a name that two sensors have.
    pub fn places(&self, layout: &Layout) -> Result<Vec<Option<GearboxPlace>>, ScenarioError> {
        let sensors = self.all_sensors();
        let entries = sensors.len();
        let mut places = Vec::with_capacity(entries);
        for (index, sensor) in sensors.iter().enumerate() {
            check_own_name(&sensors, index)?;
            let place = match RingPlace::of(sensor.at.name()) {
                Some(on_ring) => self.check_ring(&on_ring).map(|()| None),
                None => self.place(sensor.at.name(), layout).map(Some),
            };
            places.push(place.map_err(|problem| {
                let at = entry_key("sensor", index, entries, "at");
                ScenarioError::new(at, format!("{:?}", sensor.at.name()), problem)
                    .with_help(self.known_places())
            })?);
        }
        Ok(places)
    }

    /// A place on a ring is on one that stands still.
    fn check_ring(&self, on: &RingPlace) -> Result<(), String> {
        let set = self.planetary().iter().find(|set| set.name == on.set);
        let set = set.ok_or_else(|| format!("names {:?}, which is no [[planetary]] set", on.set))?;
        match set.shafts()[2] {
            None => Ok(()),
            Some(shaft) => {
                Err(format!("is on a ring that turns with shaft {shaft:?}; only a fixed ring bears a sensor"))
            }
        }
    }

    fn place(&self, at: &str, layout: &Layout) -> Result<GearboxPlace, String> {
        let parts: Vec<&str> = at.splitn(2, ':').collect();
        let along = |text: &str| {
            let (shaft, place) = text.split_once(':')?;
            let number = self.shafts().iter().position(|known| known.name == shaft)?;
            let place: f64 = place.trim().parse().ok()?;
            (0.0..=1.0).contains(&place).then_some((number, place))
        };
        match parts[..] {
            ["housing", point] => {
                let inside = point.trim().strip_prefix('[').and_then(|point| point.strip_suffix(']'));
                let numbers: Option<Vec<f64>> = inside
                    .and_then(|inside| inside.split(',').map(|number| number.trim().parse().ok()).collect());
                match (numbers.as_deref(), self.housing()) {
                    (Some(&[x, y, z]), Some(_)) => Ok(GearboxPlace::Housing([x * 1e-3, y * 1e-3, z * 1e-3])),
                    (Some([_, _, _]), None) => Err("is on the housing, but there is no [housing]".to_owned()),
                    _ => Err("must be \"housing:[x, y, z]\", three numbers in mm".to_owned()),
                }
            }
            ["shaft", text] => match along(text) {
                Some((shaft, place)) => Ok(GearboxPlace::Shaft(shaft, place)),
                None => {
                    Err("must be \"shaft:SHAFT:AT\" with a shaft's name and a place from 0 to 1".to_owned())
                }
            },
            _ => {
                let (shaft, place) = along(at)
                    .ok_or("must be \"SHAFT:AT\", \"shaft:SHAFT:AT\" or \"housing:[x, y, z]\"".to_owned())?;
                let bearings = self.bearings().iter().zip(&layout.shaft_of_bearing);
                let seat = bearings
                    .filter(|(_, of)| **of < self.shafts().len())
                    .position(|(bearing, of)| *of == shaft && (bearing.at - place).abs() < SAME_PLACE);
                seat.map(GearboxPlace::Seat).ok_or_else(|| "names no bearing's place".to_owned())
            }
        }
    }

    fn known_places(&self) -> String {
        let seats: Vec<String> =
            self.bearings_of_shafts().map(|bearing| format!("{:?}", bearing.seat_name())).collect();
        let sets: Vec<String> =
            self.planetary().iter().map(|set| format!("\"ring:{}:90\"", set.name)).collect();
        let rings = if sets.is_empty() { String::new() } else { format!("; rings {}", sets.join(", ")) };
        format!("the bearings' seats are {}{rings}", seats.join(", "))
    }
}
