//! The signals of a simulation, as a list.

use std::borrow::Cow;
use std::ops::Index;

use super::{ChannelKind, Measurement, Sensor, SensorDirection, measure};
use crate::operation::TimeGrid;
use crate::solver::{Block, Recorder};

/// The part of a machine that a signal is of. Parts are counted from 0, in the order of the scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SignalSource {
    /// (g) What a sensor shows.
    Sensor(usize),
    /// (g) Acceleration of the support of the pinion's shaft or, along the shafts and where supports do not move, the sum of both wheels'.
    Supports(SensorDirection),
    /// (N) Force of a mesh along its line of action.
    MeshForce(usize),
    /// (µm) How far the wheels of a mesh have turned against one another, along the line of action.
    TransmissionError(usize),
    /// (W) Power that the friction of a mesh's flanks takes.
    FrictionLoss(usize),
    /// (Hz) Revolutions of a shaft per second; of a pair the pinion's is the first.
    ShaftSpeed(usize),
}

impl SignalSource {
    /// Unit of such signals.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Sensor(_) | Self::Supports(_) => "g",
            Self::MeshForce(_) => "N",
            Self::TransmissionError(_) => "µm",
            Self::FrictionLoss(_) => "W",
            Self::ShaftSpeed(_) => "Hz",
        }
    }
}

/// A signal of a simulation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NamedSignal {
    /// Its name with the unit in it: of a sensor `NAME_g`, of a pair's parts as [`ChannelKind::name`], of a gearbox's `force_n.z1-z2`,
    /// `transmission_error_um.z1-z2`, `friction_loss_w.z1-z2` and `speed_hz.input`.
    pub name: Cow<'static, str>,
    /// Unit of its values.
    pub unit: &'static str,
    /// Meaning, in a few words.
    pub meaning: &'static str,
    /// What it is of.
    pub source: SignalSource,
    /// The kept samples.
    pub values: Vec<f64>,
}

impl NamedSignal {
    pub(super) const MEANING_OF_SENSOR: &'static str = "what the sensor shows, over 9.81 m/s²";

    /// A signal without samples.
    ///
    /// # Arguments
    /// * `name` - with the unit in it
    /// * `source` - what it is of
    pub fn new(name: impl Into<Cow<'static, str>>, source: SignalSource) -> Self {
        let meaning = match source {
            SignalSource::Sensor(_) => Self::MEANING_OF_SENSOR,
            SignalSource::Supports(_) => "acceleration of the supports or the wheels, over 9.81 m/s²",
            SignalSource::MeshForce(_) => {
                "force along the line of action of the mesh; negative where coast flanks touch"
            }
            SignalSource::TransmissionError(_) => {
                "how far the wheels of the mesh have turned against one another, along the line of action"
            }
            SignalSource::FrictionLoss(_) => "power that the friction of the mesh's flanks takes",
            SignalSource::ShaftSpeed(_) => "revolutions of the shaft per second",
        };
        Self { name: name.into(), unit: source.unit(), meaning, source, values: Vec::new() }
    }
}

impl From<ChannelKind> for NamedSignal {
    fn from(kind: ChannelKind) -> Self {
        Self { meaning: kind.meaning(), ..Self::new(kind.name(), kind.source()) }
    }
}

/// The kept signals of a simulation, all at the same rate and equally long.
///
/// Those of a pair are its sensors' and then [`ChannelKind::ALL`]; those of a gearbox its sensors', then of each mesh force, transmission
/// error and, with friction, the power that it takes, then the speed of each shaft.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.solver.sampling_rate_hz = 2e4;
/// let channels = meshtone::simulate(&scenario)?.channels;
/// assert_eq!(channels.signals[1].name, "vertical_g");
/// assert_eq!(channels["vertical_g"].len(), channels.len());
/// assert_eq!(channels.signal("casing_g"), None);
/// # Ok::<(), meshtone::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Channels {
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first kept sample since the start of the simulation.
    pub start_s: f64,
    /// The signals, in the order of files; sensors first.
    pub signals: Vec<NamedSignal>,
}

impl Channels {
    /// Signals at a rate, from a time on.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) their rate
    /// * `start_s` - (s) time of the first sample
    /// * `signals` - equally long; sensors first
    pub fn new(sampling_rate_hz: f64, start_s: f64, signals: Vec<NamedSignal>) -> Self {
        Self { sampling_rate_hz, start_s, signals }
    }

    /// Signals without samples, with room for those that are kept.
    pub(crate) fn with_room(time: &TimeGrid, mut signals: Vec<NamedSignal>) -> Self {
        signals.iter_mut().for_each(|signal| signal.values.reserve_exact(time.kept_samples()));
        Self::new(time.sampling_rate_hz, 0.0, signals)
    }

    /// The samples of the signal of a name.
    ///
    /// # Arguments
    /// * `name` - with the unit in it
    pub fn signal(&self, name: &str) -> Option<&[f64]> {
        let named = self.signals.iter().find(|signal| signal.name == name);
        named.map(|signal| signal.values.as_slice())
    }

    /// The samples of the signal of a part of the machine; none where there is no such signal.
    ///
    /// # Arguments
    /// * `source` - which part
    pub fn of(&self, source: SignalSource) -> &[f64] {
        let of_source = self.signals.iter().find(|signal| signal.source == source);
        of_source.map_or(&[], |signal| &signal.values)
    }

    /// The main signal: the first sensor's, or the vertical acceleration where no sensor is listed.
    pub fn leading(&self) -> Option<&NamedSignal> {
        let is_leading = |signal: &&NamedSignal| {
            matches!(
                signal.source,
                SignalSource::Sensor(_) | SignalSource::Supports(SensorDirection::Vertical)
            )
        };
        self.signals.iter().find(is_leading)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.signals.first().map_or(0, |signal| signal.values.len())
    }

    /// Returns whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (s) Time of sample `index` since the start of the simulation.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / self.sampling_rate_hz
    }

    /// Makes of the motions of the sensors' places what the sensors show.
    ///
    /// # Arguments
    /// * `sensors` - in the order of their signals
    /// * `conditions` - those of the first sensor
    pub(crate) fn measure<'s>(
        &mut self,
        sensors: impl Iterator<Item = &'s Sensor>,
        conditions: &Measurement,
    ) {
        for (index, (sensor, signal)) in sensors.zip(&mut self.signals).enumerate() {
            let raw = std::mem::take(&mut signal.values);
            signal.values = measure(raw, sensor, &Measurement { index, ..*conditions });
        }
    }
}

impl Index<&str> for Channels {
    type Output = [f64];

    /// The samples of the signal of a name.
    ///
    /// # Panics
    /// There is no signal of that name; [`Channels::signal`] says so without a panic.
    #[expect(clippy::panic, reason = "an index that there is not, as of a map")]
    fn index(&self, name: &str) -> &[f64] {
        self.signal(name).unwrap_or_else(|| panic!("there is no signal {name:?}"))
    }
}

impl Recorder for Channels {
    fn record(&mut self, block: &Block) {
        for (index, signal) in self.signals.iter_mut().enumerate() {
            signal.values.extend_from_slice(block.output(index));
        }
    }
}
