//! How often defects of bearings are found, and named rightly, in simulated recordings of a gearbox with six ball bearings.
//!
//! ```text
//! cargo run --release -p meshtone-diagnose --example bearing_defects -- 48 races.csv
//! ```
//!
//! Simulates so many rigs, each recorded on all six seats: every other one has a spall in one race of one bearing, half of either kind have damaged teeth. Wheels,
//! structure, speed, load and path are drawn as for the reference set; a recording of the same rig without damage is the healthy one. Writes a row for each recording
//! and race, and prints a table by race and size.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fmt::Write;
use std::fs;

use meshtone::Simulation;
use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Bearing, BearingDefect, BearingKind, DefectPlace, Scenario};
use meshtone::signal::{BearingDefects, DefectKind, GearTrain, RaceTest, TrainRecording, TrainTurning};
use meshtone_diagnose::{BearingAnswer, Drawn, Prior};
use meshtone_fourier::{from_real_spectrum, real_spectrum};
use rayon::prelude::*;

/// Bearings of the input, the middle and the output shaft. Those of the input have the same orders.
const BEARINGS: [(&str, f64, &str); 6] = [
    ("input", 0.0, "ER-10K"),
    ("input", 1.0, "ER-10K"),
    ("middle", 0.0, "6203"),
    ("middle", 1.0, "6205"),
    ("output", 0.0, "ER-16K"),
    ("output", 1.0, "UER204"),
];
const RACES: [(DefectPlace, DefectKind); 3] = [
    (DefectPlace::Outer, DefectKind::OuterRace),
    (DefectPlace::Inner, DefectKind::InnerRace),
    (DefectPlace::Element, DefectKind::Element),
];
/// (-) Smallest and largest size of a spall, and limits of the rows of the table: its width over the diameter of an element.
const SIZES: [f64; 4] = [0.03, 0.08, 0.2, 0.5];
/// (s) At the slowest speed that is drawn, the cages of the output shaft turn the 12 times that are needed in 5.8 s.
const DURATION_S: f64 = 6.0;
const RATE_HZ: f64 = 25_600.0;
/// (-) Noise, as a part of the rms.
const NOISE_PART: f64 = 0.05;
const SEED: u64 = 2647;

/// What a recording is of.
#[derive(Clone)]
struct Truth {
    has_damaged_teeth: bool,
    /// The bearing, the race and the size of the spall.
    defect: Option<(usize, usize, f64)>,
    /// Whether the sensor is on the seat of the bearing.
    is_on_seat: bool,
}

/// A recording with what is said of its bearings.
type Asked = (Truth, Vec<BearingAnswer>);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, count, output] = &arguments[..] else { return Err("needs COUNT OUTPUT.csv".into()) };
    let prior = Prior { seed: SEED, ..Prior::new(&rig()?)? };
    let asked = (0..count.parse()?)
        .into_par_iter()
        .map(|number| ask(&prior, number).map_err(|error| error.to_string()));
    let asked: Vec<Asked> = asked.collect::<Result<Vec<_>, _>>()?.concat();
    let mut rows = String::from(
        "recording,teeth,bearing,race,size,on_seat,tested_bearings,tested_race,is_true,p,depth,healthy_depth\n",
    );
    for (number, (truth, found)) in asked.iter().enumerate() {
        let (bearing, race, size) = truth.defect.unwrap_or((9, 9, 0.0));
        for BearingAnswer { bearings, test, healthy_depth } in found {
            writeln!(
                rows,
                "{number},{},{bearing},{race},{size:.3},{},{},{},{},{:.2e},{:.2},{:.2}",
                truth.has_damaged_teeth,
                truth.is_on_seat,
                bearings.join(" "),
                test.race.name(),
                is_true(truth, test),
                test.false_alarm_probability,
                test.depth,
                healthy_depth.unwrap_or(f64::NAN),
            )?;
        }
    }
    fs::write(output, rows)?;
    print!("{}", table(&asked)?);
    Ok(())
}

/// The gearbox of the examples, on ball bearings.
fn rig() -> Result<Scenario, Box<dyn Error>> {
    let mut gearbox = Scenario::from_toml(include_str!("../../../examples/gearbox.toml"))?;
    let bearing = |(shaft, at, name): (&str, f64, &str)| {
        let mut bearing = Bearing::new(shaft, at);
        bearing.kind = BearingKind::Ball;
        bearing.name = Some(name.to_owned());
        bearing
    };
    let shafts = gearbox.structure.shafts_mut().ok_or("the example is a gearbox")?;
    shafts.bearings = BEARINGS.map(bearing).into();
    gearbox.sensors.clear();
    Ok(gearbox)
}

/// Simulates a rig and the same rig without damage, and looks for defects in what the sensor on each of its seats records.
fn ask(prior: &Prior, number: u64) -> Result<Vec<Asked>, Box<dyn Error>> {
    let mut draws = Draws::new(SEED, Purpose::DiagnosisNoise, number);
    // Every race on every bearing, with sound and with damaged teeth.
    let (is_damaged, turn) = (number % 2 == 1, number / 2);
    let has_damaged_teeth = (turn + turn / 6) % 2 == 1;
    let size = SIZES[0] * (SIZES[3] / SIZES[0]).powf(draws.uniform(0.5, 0.5));
    let defect = is_damaged.then_some(((turn % 6) as usize, ((turn + turn / 6) % 3) as usize, size));
    let record = if has_damaged_teeth { 2 + number / 4 % 6 } else { 1 };
    // With some draws of damping and damage the motion grows without bound.
    let Some(now) = Simulated::new(prior, 8 * number + record, defect)? else {
        return Ok(Vec::new());
    };
    let Some(healthy) = Simulated::new(prior, 8 * number, None)? else {
        return Ok(Vec::new());
    };
    let on_seat = |seat: usize| {
        let now = now.defects(seat, &mut draws)?;
        let healthy = healthy.defects(seat, &mut draws)?;
        let answer = |test: &RaceTest| BearingAnswer {
            bearings: test.bearings.iter().map(usize::to_string).collect(),
            test: test.clone(),
            healthy_depth: {
                let is_same = |of: &&RaceTest| (of.race, &of.bearings) == (test.race, &test.bearings);
                healthy.races.iter().find(is_same).map(|of| of.depth)
            },
        };
        let is_on_seat = defect.is_some_and(|(bearing, ..)| bearing == seat);
        Ok((Truth { has_damaged_teeth, defect, is_on_seat }, now.races.iter().map(answer).collect()))
    };
    (0..BEARINGS.len()).map(on_seat).collect()
}

/// A simulated rig.
struct Simulated {
    drawn: Drawn,
    gearbox: Scenario,
    form: Scenario,
    simulation: Simulation,
}

impl Simulated {
    /// The rig of a record, with a spall: the bearing, the race and the size; none where its motion grows without bound.
    fn new(
        prior: &Prior,
        record: u64,
        defect: Option<(usize, usize, f64)>,
    ) -> Result<Option<Self>, Box<dyn Error>> {
        let drawn = prior.draw(record)?;
        let mut gearbox = drawn.scenario.clone();
        gearbox.sensors.clear();
        gearbox.solver.sampling_rate_hz = RATE_HZ;
        gearbox.solver.duration_s = Some(DURATION_S);
        gearbox.solver.pinion_revolutions = None;
        if let Some((bearing, race, size)) = defect {
            gearbox.bearings_mut()[bearing].defect = vec![BearingDefect::new(RACES[race].0, size)];
        }
        let Ok(simulation) = meshtone::simulate(&gearbox) else { return Ok(None) };
        let form = gearbox.clone();
        Ok(Some(Self { drawn, gearbox, form, simulation }))
    }

    /// What the sensor on a seat shows.
    fn defects(&self, seat: usize, draws: &mut Draws) -> Result<BearingDefects, Box<dyn Error>> {
        let channels = &self.simulation.channels;
        let train = GearTrain::of_scenario(&self.form)?;
        let turning = TrainTurning::of_simulated(&self.form, channels.start_s, channels.len())?;
        let bearings: Vec<_> = train.bearings.iter().map(|(_, bearing)| *bearing).collect();
        let mut of_seat = self.gearbox.clone();
        of_seat.sensors = self.gearbox.all_sensors()[seat..=seat].to_vec();
        let simulated = channels.signal(&of_seat.leading_channel()).ok_or("no such channel")?;
        let signal = recorded(simulated, channels.sampling_rate_hz, &self.drawn, draws);
        let recording = TrainRecording {
            signal: &signal,
            sampling_rate_hz: channels.sampling_rate_hz,
            train: &train,
            turning: &turning,
        };
        Ok(recording.bearing_defects(&bearings)?)
    }
}

/// A simulated signal behind the path to the sensor, with noise.
fn recorded(simulated: &[f64], sampling_rate_hz: f64, drawn: &Drawn, draws: &mut Draws) -> Vec<f64> {
    let mut spectrum = real_spectrum(simulated);
    let per_line = sampling_rate_hz / simulated.len() as f64;
    let gains = drawn.path_gains((0..spectrum.len()).map(|line| line as f64 * per_line));
    spectrum.iter_mut().zip(gains).for_each(|(value, gain)| *value *= gain);
    let mut signal = from_real_spectrum(spectrum, simulated.len());
    let rms = meshtone::signal::rms(&signal);
    signal.iter_mut().for_each(|value| *value += NOISE_PART * rms * draws.normal());
    signal
}

fn is_true(truth: &Truth, test: &RaceTest) -> bool {
    truth
        .defect
        .is_some_and(|(bearing, race, _)| test.race == RACES[race].1 && test.bearings.contains(&bearing))
}

/// Counts by race and size.
fn table(asked: &[Asked]) -> Result<String, Box<dyn Error>> {
    let mut table = String::from(
        "| | recordings | the race: lines | a defect | another outer race: lines | a defect | another inner race or element |\n|---|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut row = |name: &str, is_of: &dyn Fn(&Truth) -> bool| {
        let of: Vec<_> = asked.iter().filter(|(truth, _)| is_of(truth)).collect();
        let count = |is_counted: &dyn Fn(&Truth, &BearingAnswer) -> bool| {
            let counts = |(truth, found): &&&Asked| found.iter().any(|of| is_counted(truth, of));
            of.iter().filter(counts).count()
        };
        let is_outer = |of: &BearingAnswer| of.test.race == DefectKind::OuterRace;
        let counts = [
            count(&|truth, of| is_true(truth, &of.test) && of.test.is_detected()),
            count(&|truth, of| is_true(truth, &of.test) && of.is_defect()),
            count(&|truth, of| !is_true(truth, &of.test) && is_outer(of) && of.test.is_detected()),
            count(&|truth, of| !is_true(truth, &of.test) && is_outer(of) && of.is_defect()),
            count(&|truth, of| !is_true(truth, &of.test) && !is_outer(of) && of.is_defect()),
        ];
        writeln!(table, "| {name} | {} | {} |", of.len(), counts.map(|count| count.to_string()).join(" | "))
    };
    row("no defect, sound teeth", &|of| of.defect.is_none() && !of.has_damaged_teeth)?;
    row("no defect, damaged teeth", &|of| of.defect.is_none() && of.has_damaged_teeth)?;
    for (race, (_, kind)) in RACES.iter().enumerate() {
        for size in SIZES.windows(2) {
            let is_of = |of: &Truth| {
                of.defect.is_some_and(|(_, at, of)| at == race && (size[0]..size[1]).contains(&of))
            };
            row(&format!("{}, {} to {}", kind.name(), size[0], size[1]), &is_of)?;
        }
    }
    row("defect, sensor on its seat", &|of| of.is_on_seat)?;
    row("defect, sensor on another seat", &|of| of.defect.is_some() && !of.is_on_seat)?;
    row("defect, damaged teeth", &|of| of.defect.is_some() && of.has_damaged_teeth)?;
    row("defect, sound teeth", &|of| of.defect.is_some() && !of.has_damaged_teeth)?;
    Ok(table)
}
