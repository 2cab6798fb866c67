//! What a signal shows of a wheel.

use meshtone::signal::{IndicatorValue, Record, SignalError};
use serde_json::{Value, json};

use crate::packet::Packet;

/// Mesh harmonics of the order spectrum that are handed over, and shaft orders of the envelope's at least.
const MESH_HARMONICS: usize = 20;
const ENVELOPE_ORDERS: usize = 256;

/// What a signal shows of one wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelSignals {
    /// Its teeth.
    pub teeth: u32,
    /// Numbers of the damaged ones, from 1.
    pub damaged: Vec<usize>,
    /// Average, parts, spectra and indicators; or why there are none.
    pub record: Result<Record, SignalError>,
}

impl WheelSignals {
    /// Its indicators; none where the signal could not be processed.
    ///
    /// # Arguments
    /// * `unit` - of the signal
    pub fn indicators(&self, unit: &str) -> Vec<IndicatorValue> {
        self.record.as_ref().map_or_else(|_| Vec::new(), |record| record.indicators.table(unit))
    }

    /// As JSON, with its arrays in a packet.
    pub fn json(&self, unit: &str, packet: &mut Packet) -> Value {
        let record = match &self.record {
            Ok(record) => record,
            Err(error) => {
                return json!({ "teeth": self.teeth, "damaged": self.damaged, "problem": error.to_string() });
            }
        };
        let orders = (MESH_HARMONICS * self.teeth as usize).min(record.order_spectrum.len());
        let envelope_orders =
            ENVELOPE_ORDERS.max(2 * self.teeth as usize).min(record.envelope_spectrum.len());
        let mut array = |values: &[f64]| packet.array(values.iter().copied());
        json!({
            "teeth": self.teeth,
            "damaged": self.damaged,
            "revolutions": record.average.revolutions,
            "average": array(&record.average.values),
            "difference": array(&record.parts.difference),
            "envelope": array(&record.envelope),
            "spectrum": array(&record.order_spectrum[..orders]),
            "envelope_spectrum": array(&record.envelope_spectrum[..envelope_orders]),
            "indicators": indicators_json(&self.indicators(unit)),
            "warnings": record.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        })
    }
}

/// Indicators as the page lists them: name, unit, value.
pub fn indicators_json(indicators: &[IndicatorValue]) -> Value {
    indicators.iter().map(|entry| json!([entry.name, entry.unit, entry.value])).collect()
}
