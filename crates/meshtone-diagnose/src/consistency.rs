//! A check that several recordings are of one state.

use meshtone_learn::WheelLines;

use crate::answer::{HEALTHY, wheel_in_words};
use crate::learn::Learned;
use crate::observation::{Observation, Question};

/// (dB) How much louder one recording's difference signal may be than another's of the same state: loads and mounting move it less.
const LOUDEST_DB: f64 = 6.0;
/// (-) Probabilities of damage of which one says that it is there, the other that it is not.
const DECIDED: [f64; 2] = [0.2, 0.8];

/// Doubts that recordings are of one state, by their levels alone.
pub(crate) fn levels_apart(question: &Question) -> Vec<String> {
    let both = [("recordings", question.now), ("healthy recordings", question.healthy)];
    let hardly = |(which, recordings)| {
        Some(format!("the {which} are hardly of one state: {}", much_louder_recording(recordings)?))
    };
    both.into_iter().filter_map(hardly).collect()
}

/// The loudest of several recordings, where it is much louder than the quietest.
fn much_louder_recording(recordings: &[Observation]) -> Option<String> {
    let levels: Vec<f64> = recordings.iter().map(level_db).collect();
    let by = |a: &usize, b: &usize| levels[*a].total_cmp(&levels[*b]);
    let (quietest, loudest) = ((0..levels.len()).min_by(by)?, (0..levels.len()).max_by(by)?);
    let apart_db = levels[loudest] - levels[quietest];
    (apart_db > LOUDEST_DB).then(|| {
        format!(
            "the difference signal of number {} is {:.1} times that of number {}; ask about each state alone",
            loudest + 1,
            10f64.powf(apart_db / 20.0),
            quietest + 1
        )
    })
}

/// (dB) Level of the largest difference signal of a wheel.
fn level_db(asked: &Observation) -> f64 {
    let energy = |wheel: &WheelLines| wheel.difference().iter().map(|line| line.norm_sqr()).sum::<f64>();
    let most = asked.wheels.iter().flatten().map(energy).fold(f64::MIN_POSITIVE, f64::max);
    10.0 * most.log10()
}

/// Says which recordings contradict each other, where their levels do not say so already: one is damaged and another is not, or another
/// wheel of it is.
///
/// Each recording is looked at alone. Two sure wheels are reported before a recording without damage, since they name more.
///
/// # Arguments
/// * `learned`, `question` - by what each recording is looked at alone
pub(crate) fn contradicting_states(learned: &Learned, question: &Question) -> Option<String> {
    if question.now.len() < 2 || much_louder_recording(question.now).is_some() {
        return None;
    }
    let wheels = &learned.reference.prior.train.wheels;
    let of_wheels = |one: &Observation| {
        let alone = Question { now: std::slice::from_ref(one), healthy: question.healthy };
        learned.seen(&alone).of_wheels
    };
    let of_wheels: Vec<Vec<f64>> = question.now.iter().map(of_wheels).collect();
    let damaged: Vec<f64> = of_wheels.iter().map(|of| of.iter().sum()).collect();
    let most = (0..damaged.len()).find(|&at| damaged[at] > DECIDED[1])?;
    let sure = |at: usize| (0..wheels.len()).find(|&wheel| of_wheels[at][wheel] > DECIDED[1]);
    let sure: Vec<(usize, usize)> = (0..damaged.len()).filter_map(|at| Some((at, sure(at)?))).collect();
    if let [(first, one), others @ ..] = &sure[..]
        && let Some((second, other)) = others.iter().find(|(_, other)| other != one)
    {
        return Some(format!(
            "the recordings are hardly of one state: of number {} alone the {} is damaged, of number {} the {}; ask about each state alone",
            first + 1,
            wheel_in_words(&wheels[*one].name),
            second + 1,
            wheel_in_words(&wheels[*other].name)
        ));
    }
    let least = (0..damaged.len()).find(|&at| damaged[at] < DECIDED[0])?;
    Some(format!(
        "the recordings are hardly of one state: number {} alone is damaged with a probability of {:.0} %, number {} {HEALTHY} with \
         {:.0} %; ask about each state alone",
        most + 1,
        100.0 * damaged[most],
        least + 1,
        100.0 * (1.0 - damaged[least])
    ))
}
