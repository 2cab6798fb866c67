//! Observation of recordings by the angles of the shafts.

use meshtone::signal::{
    Alternative, AngleZero, AngularSettings, AngularSignal, BearingDefects, ForeignTones, GearTrain,
    LinesOffShafts, Mismatch, ShaftPhase, SignalError, SignalWarning, StatedFacts, StatedTurning,
    SynchronousAverage, TrainBearing, TrainRecording, TrainTurning, TrainWheel, angular_resample,
    find_mismatch, find_train_mismatch, foreign_tones, kurtosis, lines_off_shafts, rms, standard_deviation,
    synchronous_average, synchronous_part,
};
use meshtone_fourier::{Complex64, from_real_spectrum};
use meshtone_learn::{MESH_ORDERS, PASSED, WheelLines, separations};

use crate::answer::wheel_in_words;
use crate::observation::{Observation, SignalKind};

/// (-) Kurtosis of what belongs to neither shaft, from which on it is impulsive.
const IMPULSIVE: f64 = 4.5;
/// (-) Its part of the energy from which on it counts: teeth that strike and part make up to a seventh that repeats with neither
/// shaft, since it depends on which two teeth meet.
const COUNTS: f64 = 0.15;
/// Times that the same teeth should meet in a recording.
const SEQUENCES: usize = 3;
/// Revolutions below which noise is not distinguished from what repeats.
const FEWEST_REVOLUTIONS: usize = 6;
/// (-) Median over mean of the squared magnitude of normal noise.
const MEDIAN_OF_SQUARES: f64 = std::f64::consts::LN_2;
/// (-) Mean square of Hann's window.
const WINDOW_SQUARE: f64 = 0.375;
/// (-) The same over its middle half: 3/8 + 1/π.
const MIDDLE_SQUARE: f64 = 0.375 + std::f64::consts::FRAC_1_PI;

/// The recording over whole cycles, after which the same teeth meet again, without the mean cycle, and the part of the energy of what does not
/// repeat that is left then. Where it is shorter than two cycles it is as it was, since nothing is known to repeat.
fn without_cycle(angular: &AngularSignal, train: &GearTrain, shaft: usize) -> (AngularSignal, f64) {
    let mut angular = angular.clone();
    let cycle = train.revolutions_of_a_cycle(shaft).max(1);
    let cycles = angular.revolutions() / cycle;
    if cycles < 2 {
        return (angular, 1.0);
    }
    let points = cycle * angular.points_per_revolution;
    angular.values.truncate(cycles * points);
    for point in 0..points {
        let mean = angular.values[point..].iter().step_by(points).sum::<f64>() / cycles as f64;
        angular.values[point..].iter_mut().step_by(points).for_each(|value| *value -= mean);
    }
    (angular, 1.0 - 1.0 / cycles as f64)
}

/// (g) Standard deviation of the noise in the lines of an average, by mesh order: from the median of the lines beside the orders of
/// all shafts, which tones do not move, without what repeats with the cycle. Empty where there are too few revolutions.
fn noise(angular: &AngularSignal, train: &GearTrain, wheel: &TrainWheel) -> Vec<f64> {
    if angular.revolutions() < FEWEST_REVOLUTIONS {
        return Vec::new();
    }
    let (unrepeated, kept) = without_cycle(angular, train, wheel.shaft);
    let revolutions = unrepeated.revolutions();
    let LinesOffShafts { spectrum, is_off } = lines_off_shafts(&unrepeated, train, wheel.shaft);
    let per_mesh_order = wheel.teeth as usize * revolutions;
    let last = (PASSED * angular.nyquist_order) as usize * revolutions;
    // A line's square grows with the number of values, that of a line of the average falls with the number of all.
    let [values, all] =
        [revolutions, angular.revolutions()].map(|turns| (turns * angular.points_per_revolution) as f64);
    let scale = (MEDIAN_OF_SQUARES * WINDOW_SQUARE * kept * values * all).sqrt();
    let band = |mesh: usize| {
        let from = (mesh * per_mesh_order).saturating_sub(per_mesh_order / 2);
        let to = (mesh * per_mesh_order + per_mesh_order / 2).min(last).min(spectrum.len());
        let squares = (from..to).filter(|&line| is_off[line]).map(|line| spectrum[line].norm_sqr());
        Some(median(squares.collect())?.sqrt() / scale)
    };
    (0..=MESH_ORDERS).map_while(band).collect()
}

/// The middle one of some values, of an even number the upper one; none of no values.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Evidence against a recording of which nothing repeats with any shaft.
///
/// # Arguments
/// * `angular`, `averages` - the recording over the angle of each wheel's shaft, and its average
/// * `slowest`, `teeth` - number of the wheel on the slowest shaft, and its teeth
fn nothing_synchronous(
    angular: &[AngularSignal],
    averages: &[SynchronousAverage],
    (slowest, teeth): (usize, u32),
) -> Option<String> {
    let views = angular.iter().zip(averages);
    let parts = views.map(|(view, average)| synchronous_part(&view.values, &average.values));
    let parts = parts.collect::<Option<Vec<_>>>()?;
    let is_known = parts.iter().all(|part| part.revolutions >= FEWEST_REVOLUTIONS);
    let part = *parts.get(slowest).filter(|_| is_known && parts.iter().all(|part| part.is_noise()))?;
    Some(SignalWarning::NothingSynchronous { part, teeth, other: None }.to_string())
}

/// (-) Level of the quietest revolution over that of the loudest, below which the sensor did not measure all the time.
const QUIETEST: f64 = 1.0 / 30.0;

impl Observation {
    /// Observes the wheels of a rig in a recording, with what speaks against the statements about it.
    ///
    /// # Arguments
    /// * `recording` - a channel, in g, with the rig's shafts and how they turned
    ///
    /// # Errors
    /// Fewer than two whole revolutions of a shaft; those of [`meshtone::signal::angular_resample`].
    pub fn of_recording(recording: &TrainRecording) -> Result<Self, SignalError> {
        let train = recording.train;
        let settings = AngularSettings::default();
        let angular = (0..train.wheels.len()).map(|wheel| recording.angular(wheel, &settings));
        let angular = angular.collect::<Result<Vec<_>, _>>()?;
        let phase = |shaft| recording.phase(shaft);
        let zeros = train.wheels.iter().map(|wheel| Ok(phase(wheel.shaft)?.zero));
        let zero: Vec<AngleZero> = zeros.collect::<Result<_, SignalError>>()?;
        let input_speed_hz = recording.mean_speed_hz(train.input())?;
        let against = mismatch(recording, &angular)?;
        let observed = Self::of_angles(train, &angular, input_speed_hz)?;
        let bearings: Vec<TrainBearing> = train.bearings.iter().map(|(_, bearing)| *bearing).collect();
        let bearings = recording.bearing_defects(&bearings)?;
        let observed = Self { zero, bearings, ..observed };
        Ok(against.into_iter().fold(observed, Self::with_mismatch))
    }

    /// Observes the wheels of a rig in a recording over the angles of their shafts.
    ///
    /// # Arguments
    /// * `train` - the rig's shafts and wheels
    /// * `angular` - of each wheel the same channel over the angle of its shaft, in g
    /// * `input_speed_hz` - (Hz) mean speed of the shaft that drives
    ///
    /// # Errors
    /// Fewer than two whole revolutions of a shaft.
    fn of_angles(
        train: &GearTrain,
        angular: &[AngularSignal],
        input_speed_hz: f64,
    ) -> Result<Self, SignalError> {
        let averages = angular.iter().map(synchronous_average).collect::<Result<Vec<_>, _>>()?;
        let shaft_hz = |shaft: usize| input_speed_hz * train.shafts[shaft].speed_ratio.value();
        let by_speed = |a: &usize, b: &usize| {
            shaft_hz(train.wheels[*a].shaft).total_cmp(&shaft_hz(train.wheels[*b].shaft))
        };
        // Of two of one shaft the last one.
        let slowest = (0..angular.len()).rev().min_by(by_speed).unwrap_or(0);
        let wheel = &train.wheels[slowest];
        let shaft =
            SlowestShaft { angular: &angular[slowest], train, wheel, speed_hz: shaft_hz(wheel.shaft) };
        let (foreign, impulses) = shaft.energy_off_all_shafts();
        let tones = foreign.as_ref().filter(|tones| tones.count());
        let mismatch = nothing_synchronous(angular, &averages, (slowest, wheel.teeth))
            .or_else(|| shaft.silent_part())
            .or_else(|| tones.map(ForeignTones::to_string));
        let separations = separations(train);
        let wheels = averages.iter().zip(separations);
        let wheels = wheels.map(|(average, separation)| Some(WheelLines::of_average(average, separation)));
        let noise = angular.iter().zip(&train.wheels).map(|(view, wheel)| noise(view, train, wheel));
        Ok(Self {
            signal: SignalKind::Recording,
            input_speed_hz: Some(input_speed_hz),
            zero: vec![AngleZero::Given; angular.len()],
            wheels: wheels.collect(),
            noise: noise.collect(),
            mismatch,
            foreign,
            doubts: shaft.too_short().into_iter().chain(impulses).collect(),
            bearings: BearingDefects::default(),
        })
    }
}

/// Finds what fits a recording better than what is stated about the shaft whose phase is known.
///
/// # Arguments
/// * `recording` - the channel with its shafts
/// * `angular` - of each wheel the channel over the angle of its shaft
fn mismatch(recording: &TrainRecording, angular: &[AngularSignal]) -> Result<Option<Mismatch>, SignalError> {
    let TrainRecording { train, signal, sampling_rate_hz, turning } = *recording;
    let TrainTurning::Shaft { shaft, phase, stated } = turning else { return Ok(None) };
    let wheel = train.wheels.iter().position(|wheel| wheel.shaft == *shaft);
    let Some((wheel, facts)) = wheel.zip(StatedFacts::of_shaft(train, *shaft, *stated)) else {
        return Ok(None);
    };
    match find_train_mismatch(&angular[wheel], train, *shaft, *stated) {
        None if train.meshes.len() < 2 => other_tone(signal, sampling_rate_hz, phase, &facts),
        found => Ok(found),
    }
}

/// The recording over the angle of the slowest shaft, on which what is not of the rig is looked for.
struct SlowestShaft<'a> {
    angular: &'a AngularSignal,
    train: &'a GearTrain,
    wheel: &'a TrainWheel,
    /// (Hz) Its speed.
    speed_hz: f64,
}

impl SlowestShaft<'_> {
    /// Warning about averages over so few revolutions that each wheel's is not free of the others', or that noise is not separated from
    /// what repeats.
    fn too_short(&self) -> Option<String> {
        let (revolutions, name) = (self.angular.revolutions(), wheel_in_words(&self.wheel.name));
        let lasts = |revolutions: usize| {
            format!("{revolutions} turns of the {name}, {:.2} s", revolutions as f64 / self.speed_hz)
        };
        if revolutions < FEWEST_REVOLUTIONS {
            return Some(format!(
                "the recording is short ({}): to distinguish noise from what the wheels repeat, at least {} are needed",
                lasts(revolutions),
                lasts(FEWEST_REVOLUTIONS)
            ));
        }
        let sequence = self.train.revolutions_of_a_cycle(self.wheel.shaft).max(1);
        let needed = SEQUENCES * sequence;
        // Over whole sequences each wheel's orders are lines of their own.
        (revolutions < needed && !revolutions.is_multiple_of(sequence)).then(|| {
            format!(
                "the recording is short ({}): what is seen of one wheel is partly of the others until the same teeth have met \
                 {SEQUENCES} times ({}); record that long",
                lasts(revolutions),
                lasts(needed)
            )
        })
    }

    /// Evidence against a recording that is silent for a part of the time.
    fn silent_part(&self) -> Option<String> {
        let AngularSignal { values, points_per_revolution, .. } = self.angular;
        let levels: Vec<f64> = values.chunks_exact(*points_per_revolution).map(standard_deviation).collect();
        let loudest = levels.iter().copied().fold(0.0, f64::max);
        let silent = levels.iter().filter(|level| **level < QUIETEST * loudest).count();
        (silent > 0).then(|| {
            format!(
                "{silent} of {} revolutions of the {} have less than 1/{:.0} of the level of the loudest: a sensor that failed, or knocks; \
                 cut the recording to where the machine runs evenly",
                levels.len(),
                wheel_in_words(&self.wheel.name),
                1.0 / QUIETEST
            )
        })
    }

    /// Looks for what the orders of the shafts do not explain: tones of none, and a doubt about impulses that repeat with none.
    ///
    /// What repeats whenever the same teeth meet again is taken away, and the lines of all shafts are left out of the spectrum of the rest. Of the
    /// others, those that stand out of their surroundings are tones, which speak against the recording; and what they make over time is impulsive where something
    /// strikes. That is a doubt alone: the random part of a real gearbox is impulsive when it is healthy, too, and averages reduce it like noise.
    fn energy_off_all_shafts(&self) -> (Option<ForeignTones>, Option<String>) {
        let Self { angular, train, wheel, speed_hz } = self;
        if angular.revolutions() < FEWEST_REVOLUTIONS {
            return (None, None);
        }
        let (unrepeated, kept) = without_cycle(angular, train, wheel.shaft);
        let whole = unrepeated.values.len();
        let mut lines = lines_off_shafts(&unrepeated, train, wheel.shaft);
        let level = standard_deviation(&angular.values).max(f64::MIN_POSITIVE);
        let unrepeated_part = (standard_deviation(&unrepeated.values) / level).powi(2) / kept;
        let found = foreign_tones(&unrepeated, train, wheel.shaft, *speed_hz, None);
        let mut tones = found.map_or_else(Vec::new, |found| found.tones);
        tones.iter_mut().for_each(|tone| tone.part *= unrepeated_part);
        let passed = (PASSED * angular.nyquist_order) as usize * unrepeated.revolutions();
        for (line, value) in lines.spectrum.iter_mut().enumerate() {
            if !lines.is_off[line] || line >= passed {
                *value = Complex64::default();
            }
        }
        // The middle half, where the window is level enough to leave the shape.
        let rest = from_real_spectrum(lines.spectrum, whole);
        let rest = &rest[whole / 4..3 * whole / 4];
        let part = (rms(rest) / level).powi(2) / MIDDLE_SQUARE / kept;
        let impulses = kurtosis(rest).filter(|impulses| *impulses > IMPULSIVE && part > COUNTS);
        let impulses = impulses.map(|kurtosis| {
            format!(
                "impulses that repeat with no shaft make {:.0} % of the recording's energy (kurtosis {kurtosis:.1}): a bearing, or this machine's random part; \
                 they are noise to what is said of the teeth",
                100.0 * part
            )
        });
        (ForeignTones::of(&tones), impulses)
    }
}

/// Looks for tooth counts that fit a recording better than those that are stated, where its phase is from a doubtful mesh tone: another
/// tone than the mesh's may have been followed.
///
/// # Arguments
/// * `signal`, `sampling_rate_hz` - the recording
/// * `shaft` - its phase
/// * `stated` - teeth of the wheel on that shaft and of its mate, and how it turns
///
/// # Errors
/// Those of [`meshtone::signal::angular_resample`].
pub fn other_tone(
    signal: &[f64],
    sampling_rate_hz: f64,
    shaft: &ShaftPhase,
    stated: &StatedFacts,
) -> Result<Option<Mismatch>, SignalError> {
    let (StatedTurning::MeshTone { nominal_hz }, Some(_), false) =
        (stated.turning, stated.mate_teeth, shaft.warnings.is_empty())
    else {
        return Ok(None);
    };
    let phase = ShaftPhase::constant(nominal_hz, sampling_rate_hz, signal.len())?;
    let angular = angular_resample(signal, &phase, &AngularSettings::default())?;
    let turning = StatedTurning::ConstantSpeed { speed_hz: nominal_hz };
    let is_of_teeth = |found: &Mismatch| {
        matches!(found.alternative, Alternative::Teeth { .. } | Alternative::MateTeeth { .. })
    };
    Ok(find_mismatch(&angular, &StatedFacts { turning, ..*stated }).filter(is_of_teeth))
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};
    use std::f64::consts::TAU;

    const TEETH: [u32; 2] = [17, 38];

    /// Both shafts' views of a signal over the gear's angle, in revolutions of the gear.
    fn views(signal: &mut dyn FnMut(f64) -> f64, revolutions: usize) -> [AngularSignal; 2] {
        [(1024, 38.0 / 17.0), (2048, 1.0)].map(|(points, turns)| {
            let count = (revolutions as f64 * turns) as usize * points;
            AngularSignal {
                points_per_revolution: points,
                start_rev: 0.0,
                nyquist_order: points as f64 / 2.0,
                values: (0..count).map(|at| signal(at as f64 / points as f64 / turns)).collect(),
            }
        })
    }

    fn observed(views: &[AngularSignal]) -> Result<Observation, SignalError> {
        let train = GearTrain::of_wheels([("pinion", TEETH[0]), ("gear", TEETH[1])]);
        Observation::of_angles(&train, views, 40.0)
    }

    fn tones(gear_rev: f64) -> f64 {
        let of_pinion = 38.0 / 17.0 * gear_rev;
        (TAU * 38.0 * gear_rev).cos()
            + 0.1 * (TAU * 43.0 * gear_rev).cos()
            + 0.2 * (TAU * 5.0 * of_pinion).sin()
    }

    // Noise has nothing of either shaft, a sensor that failed nothing of a part of the time; tones in noise have both.
    #[test]
    fn noise_and_silence_are_no_recording_of_the_pair() {
        let mut draws = Draws::new(5, Purpose::DiagnosisNoise, 0);
        let mut said = |signal: &mut dyn FnMut(f64, f64) -> f64| {
            let views = views(&mut |rev| signal(rev, draws.normal()), 34);
            observed(&views).unwrap().mismatch
        };
        assert_eq!(said(&mut |rev, noise| tones(rev) + 0.5 * noise), None);
        let of_noise = said(&mut |_, noise| noise).unwrap();
        assert!(of_noise.contains("no signal is synchronous"), "{of_noise}");
        let failed = said(&mut |rev, noise| if rev < 20.0 { tones(rev) + 0.1 * noise } else { 0.0 }).unwrap();
        assert!(failed.starts_with("14 of 34 revolutions"), "{failed}");
    }

    // The variance of a mean over revolutions, and of a line of it: the sample's over their number and that of the points.
    #[test]
    fn noise_is_distinguished_from_both_shafts_tones() {
        let mut draws = Draws::new(1, Purpose::DiagnosisNoise, 0);
        let views = views(&mut |rev| tones(rev) + 0.5 * draws.normal(), 34);
        let observed = observed(&views).unwrap();
        for (wheel, view) in views.iter().enumerate() {
            let expected = 0.5 / ((view.revolutions() * view.points_per_revolution) as f64).sqrt();
            for (mesh, said) in observed.noise[wheel].iter().enumerate().skip(1) {
                assert!((said / expected - 1.0).abs() < 0.2, "{wheel} {mesh}: {said} of {expected}");
            }
        }
        assert_eq!(observed.mismatch, None);
    }

    #[test]
    fn impulses_of_neither_shaft_are_reported() {
        // Every 0.2713 revolutions: no order of either shaft.
        let mut struck = |rev: f64| {
            let since = rev % 0.2713;
            tones(rev) + 10.0 * (-since * 400.0).exp() * (TAU * 300.0 * since).sin()
        };
        let views = views(&mut struck, 34);
        let observed = observed(&views).unwrap();
        assert!(observed.doubts.iter().any(|said| said.contains("no shaft")), "{:?}", observed.doubts);
    }
}
