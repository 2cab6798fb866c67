//! What is read off the solution: the channels, as sensors on the rig would show them.
//!
//! A channel is a row of one table; its name is the same in the file of signals, in the list of a data set's plan, in an
//! experiment and in Python.

mod contact_figures;

pub use contact_figures::ContactFigures;

use std::f64::consts::TAU;

use crate::machine::coordinates::*;
use crate::operation::TimeGrid;
use crate::solver::{Axis, Block, Output, Recorder};

/// (m/s²) One g, as the published model has it.
pub const GRAVITY_M_PER_S2: f64 = 9.81;

/// One row a channel: its kind, its name with the unit at the end, unit, meaning, and what of the solution it is.
macro_rules! channels {
    ($($kind:ident $name:ident $unit:literal $meaning:literal $output:expr;)+) => {
        /// A signal of [`Channels`].
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum ChannelKind {
            $(#[doc = concat!("(", $unit, ") ", $meaning, ".")] $kind,)+
        }

        impl ChannelKind {
            /// All of them, in the order of [`Channels`]' fields.
            pub const ALL: [Self; [$($unit),+].len()] = [$(Self::$kind),+];

            /// Name with the unit at its end, the same wherever a channel is named.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind => stringify!($name),)+ }
            }

            /// Unit.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$kind => $unit,)+ }
            }

            /// Meaning, in a few words.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$kind => $meaning,)+ }
            }

            /// What is read off the solution.
            pub fn output(self) -> Output {
                match self { $(Self::$kind => $output,)+ }
            }
        }

        /// The kept signals, all at the same rate and equally long.
        #[derive(Debug, Clone, PartialEq, Default)]
        #[non_exhaustive]
        pub struct Channels {
            /// (S/s) Sampling rate.
            pub sampling_rate_hz: f64,
            /// (s) Time of the first kept sample since the start of the simulation.
            pub start_s: f64,
            $(#[doc = concat!("(", $unit, ") ", $meaning, ".")] pub $name: Vec<f64>,)+
        }

        impl Channels {
            /// The signal of a kind.
            pub fn get(&self, kind: ChannelKind) -> &[f64] {
                match kind { $(ChannelKind::$kind => &self.$name,)+ }
            }

            /// The signal of a kind, to be filled.
            pub fn get_mut(&mut self, kind: ChannelKind) -> &mut Vec<f64> {
                match kind { $(ChannelKind::$kind => &mut self.$name,)+ }
            }
        }
    };
}

channels! {
    Horizontal horizontal_g "g" "horizontal acceleration of the supports, their mean, over 9.81 m/s²; under linear and published the sum of both wheels'"
        Output::Sensor(Axis::X, PER_G);
    Vertical vertical_g "g" "vertical acceleration of the supports, their mean, over 9.81 m/s²; under linear and published the sum of both wheels'"
        Output::Sensor(Axis::Y, PER_G);
    Axial axial_g "g" "sum of both wheels' axial accelerations, over 9.81 m/s²"
        Output::Sensor(Axis::Z, PER_G);
    PinionShaftSpeed pinion_shaft_speed_hz "Hz" "revolutions of the pinion per second"
        Output::Velocity(weighted(&[(THETA_PINION, 1.0 / TAU)]));
    GearShaftSpeed gear_shaft_speed_hz "Hz" "revolutions of the gear per second"
        Output::Velocity(weighted(&[(THETA_GEAR, -1.0 / TAU)]));
    MeshForce mesh_force_n "N"
        "force along the line of action; negative: back flanks touch, or the linear mesh pulls where real teeth would part"
        Output::MeshForce;
}

/// (s²/m) One over g.
const PER_G: f64 = 1.0 / GRAVITY_M_PER_S2;

fn weighted(terms: &[(usize, f64)]) -> Vec<f64> {
    let mut weights = vec![0.0; COORDINATES];
    for &(coordinate, weight) in terms {
        weights[coordinate] = weight;
    }
    weights
}

impl ChannelKind {
    /// Those that an accelerometer would show.
    pub const ACCELERATIONS: [Self; 3] = [Self::Horizontal, Self::Vertical, Self::Axial];
}

/// What [`Channels`] reads off the solution, in the order of [`ChannelKind::ALL`].
pub fn channel_outputs() -> [Output; ChannelKind::ALL.len()] {
    ChannelKind::ALL.map(ChannelKind::output)
}

impl Channels {
    /// Empty channels, with room for the kept samples.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn new(time: &TimeGrid) -> Self {
        let mut channels = Self {
            sampling_rate_hz: time.sampling_rate_hz,
            start_s: time.first_kept_sample as f64 * time.step_s(),
            ..Self::default()
        };
        for kind in ChannelKind::ALL {
            channels.get_mut(kind).reserve_exact(time.kept_samples());
        }
        channels
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.vertical_g.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.vertical_g.is_empty()
    }

    /// (s) Time of sample `index` since the start of the simulation.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / self.sampling_rate_hz
    }

    /// (-) Part of the kept time in which the mesh force is negative.
    pub fn tension_fraction(&self) -> f64 {
        let pulling = self.mesh_force_n.iter().filter(|&&force| force < 0.0).count();
        pulling as f64 / self.mesh_force_n.len().max(1) as f64
    }
}

impl Recorder for Channels {
    fn record(&mut self, block: &Block) {
        for (index, kind) in ChannelKind::ALL.into_iter().enumerate() {
            self.get_mut(kind).extend_from_slice(block.output(index));
        }
    }
}
