//! Sums over a simulation's signals that show whether they can be right, gathered while they come.

use crate::checks::{Figures, SignalFigures, WindowSums};
use crate::sensor::ChannelKind;
use crate::simulate::Stages;

/// Sees the signals of one simulation, block by block, and keeps what [`Stages::warnings_of_signals`] needs of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Observer {
    /// Of the mesh force, and of the speeds of pinion and gear.
    pub(crate) figures: Figures,
    /// The same two over windows of the kept time.
    pub(super) windows: [WindowSums; 2],
    /// The vertical acceleration and the mesh force over turns of the wheels, where a motion lasts that repeats with them.
    pub(super) turns: Option<[WheelTurnSums; 2]>,
}

impl Observer {
    /// The signals that it sees, in their order.
    pub const CHANNELS: [ChannelKind; 4] = [
        ChannelKind::Vertical,
        ChannelKind::MeshForce,
        ChannelKind::PinionShaftSpeed,
        ChannelKind::GearShaftSpeed,
    ];

    /// Has seen nothing yet.
    ///
    /// # Arguments
    /// * `stages` - of the simulation
    pub fn new(stages: &Stages) -> Self {
        let turns = lasts(stages).then(|| [WheelTurnSums::new(stages), WheelTurnSums::new(stages)]);
        let gears = &stages.layout.gears[0];
        let of_gear = stages.time.samples_per_pitch(gears) * gears.gear_teeth as usize;
        let windows = [(); 2].map(|()| WindowSums::new(stages.time.kept_samples(), of_gear));
        let of_signals = |count: usize| vec![SignalFigures::new(stages.time.kept_samples()); count];
        let figures = Figures { forces: of_signals(1), speeds: of_signals(2) };
        Self { figures, windows, turns }
    }

    /// Sees some samples, the next ones of the kept time.
    ///
    /// # Arguments
    /// * `signals` - those of [`Self::CHANNELS`], equally long
    pub fn observe(&mut self, signals: [&[f64]; 4]) {
        let [vertical_g, force_n, pinion_hz, gear_hz] = signals;
        let figures = self.figures.forces.iter_mut().chain(&mut self.figures.speeds);
        for (figures, signal) in figures.zip([force_n, pinion_hz, gear_hz]) {
            figures.add(signal);
        }
        for (windows, signal) in self.windows.iter_mut().zip([vertical_g, force_n]) {
            windows.add(signal);
        }
        for (turns, signal) in self.turns.iter_mut().flatten().zip([vertical_g, force_n]) {
            turns.add(signal);
        }
    }

    /// (-) Part of the time in which the mesh force is 0: under `contact`, in which no teeth touch.
    pub fn apart_fraction(&self) -> f64 {
        self.figures.forces[0].part_of_zeros()
    }

    /// (-) Part of the time in which the mesh force is negative.
    pub fn tension_fraction(&self) -> f64 {
        self.figures.forces[0].part_of_negatives()
    }
}

/// Returns whether a steady vibration is reached whose lines can be looked at.
fn lasts(stages: &Stages) -> bool {
    let operation = &stages.scenario.operation;
    stages.scenario.model.has_meshes() && operation.keeps_speed() && !operation.is_drawn_for_every_sample()
}

/// A signal summed over the turns of either wheel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WheelTurnSums {
    samples: usize,
    squares: f64,
    pub of_gear: TurnSum,
    pub of_pinion: TurnSum,
}

impl WheelTurnSums {
    fn new(stages: &Stages) -> Self {
        let (time, gears) = (&stages.time, &stages.layout.gears[0]);
        let of_pinion = time.samples_per_pinion_revolution;
        let of_gear = time.samples_per_pitch(gears) * gears.gear_teeth as usize;
        let turns = |samples_per_turn| TurnSum::new(samples_per_turn, time.kept_samples());
        Self { samples: 0, squares: 0.0, of_gear: turns(of_gear), of_pinion: turns(of_pinion) }
    }

    fn add(&mut self, signal: &[f64]) {
        self.samples += signal.len();
        self.squares = signal.iter().fold(self.squares, |sum, value| sum + value * value);
        self.of_gear.add(signal);
        self.of_pinion.add(signal);
    }

    /// Of all samples.
    pub fn rms(&self) -> f64 {
        (self.squares / self.samples.max(1) as f64).sqrt()
    }
}

/// A signal summed over all whole turns of a wheel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TurnSum {
    /// Number of whole turns.
    pub count: usize,
    /// The sum, a value for each sample of a turn; none of a signal shorter than a turn.
    pub sum: Vec<f64>,
    /// Samples added.
    samples: usize,
}

impl TurnSum {
    /// No samples of any turn yet.
    ///
    /// # Arguments
    /// * `samples_per_turn` - of the wheel
    /// * `samples` - that there will be
    pub fn new(samples_per_turn: usize, samples: usize) -> Self {
        let count = samples.checked_div(samples_per_turn).unwrap_or(0);
        Self { count, sum: vec![0.0; if count == 0 { 0 } else { samples_per_turn }], samples: 0 }
    }

    /// Adds the next samples.
    pub fn add(&mut self, signal: &[f64]) {
        let wanted = (self.count * self.sum.len()).saturating_sub(self.samples);
        let mut rest = &signal[..signal.len().min(wanted)];
        while !rest.is_empty() {
            let place = self.samples % self.sum.len();
            let (of_turn, next) = rest.split_at(rest.len().min(self.sum.len() - place));
            self.sum[place..].iter_mut().zip(of_turn).for_each(|(sum, value)| *sum += value);
            self.samples += of_turn.len();
            rest = next;
        }
    }
}
