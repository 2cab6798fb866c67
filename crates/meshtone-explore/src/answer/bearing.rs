//! What a signal of a gearbox shows of one of its rolling bearings.

use meshtone::scenario::Scenario;
use meshtone::signal::{
    BearingSettings, DefectLine, EnvelopeBand, FrequencyBand, GearTrain, SignalError, TrainBearing,
    TrainRecording,
};
use serde_json::{Value, json};

use crate::packet::Packet;

/// (orders of the inner race) As far the spectrum is sent: a little beyond the last line that is looked for, the third harmonic.
const SENT_ORDERS: f64 = 3.3;

/// The rolling bearing that is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct LookedAtBearing {
    /// Name of its seat, such as `input:0`.
    pub name: String,
    /// Name of its shaft.
    pub shaft: String,
    /// Its geometry, and the number of its shaft.
    pub placed: TrainBearing,
}

impl LookedAtBearing {
    /// The rolling bearing of a name; where there is none of it the first with a defect, or else the first.
    ///
    /// # Arguments
    /// * `scenario` - of the machine
    /// * `train` - its shafts and bearings
    /// * `name` - of the bearing's seat
    pub fn of(scenario: &Scenario, train: &GearTrain, name: Option<&str>) -> Option<Self> {
        let named = train.bearings.iter().find(|(seat, _)| Some(seat.as_str()) == name);
        let is_damaged = |seat: &str| {
            let of_seat = scenario.bearings().iter().find(|bearing| bearing.seat_name() == seat);
            of_seat.is_some_and(|bearing| !bearing.defect.is_empty())
        };
        let damaged = || train.bearings.iter().find(|(seat, _)| is_damaged(seat));
        let (seat, placed) = named.or_else(damaged).or(train.bearings.first())?;
        Some(Self { name: seat.clone(), shaft: train.shafts[placed.shaft].name.clone(), placed: *placed })
    }

    /// The spectrum of the squared envelope over the orders of its shaft with the lines of its defects, or why there is none, as JSON
    /// with its arrays in a packet.
    ///
    /// # Arguments
    /// * `recording` - the channel that is looked at, and how the shafts turned; or why it cannot be processed
    /// * `packet` - takes the arrays up
    pub fn json(&self, recording: Result<TrainRecording<'_>, SignalError>, packet: &mut Packet) -> Value {
        let found = recording.and_then(|recording| {
            // A simulation has no noise: the most impulsive band is one in which there is next to nothing. A recording is drawn over the same.
            let band = FrequencyBand { from_hz: 0.0, to_hz: 0.5 * recording.sampling_rate_hz };
            let settings = BearingSettings { band: EnvelopeBand::Stated(band), ..BearingSettings::default() };
            recording.bearings(&[self.placed], &settings)
        });
        let mut said = json!({ "name": self.name, "shaft": self.shaft });
        let records = match found {
            Ok(records) => records,
            Err(error) => {
                said["problem"] = error.to_string().into();
                return said;
            }
        };
        said["verdict"] = records.defects.in_words(0).into();
        said["warnings"] = records.warnings.iter().map(ToString::to_string).collect();
        for (spectrum, lines) in &records.bearings {
            let sent = SENT_ORDERS * self.placed.geometry.defect_orders().inner_race / spectrum.step;
            said["step"] = spectrum.step.into();
            said["spectrum"] = packet.array(spectrum.amplitudes.iter().copied().take(sent as usize));
            let line = |line: &DefectLine| {
                json!([line.name(), line.order, line.found_order, line.amplitude, line.over_median])
            };
            said["lines"] = lines.iter().map(line).collect();
        }
        said
    }
}
