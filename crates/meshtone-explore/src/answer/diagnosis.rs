//! A diagnosis of recordings that were opened on the page.

use std::sync::atomic::{AtomicBool, Ordering};

use meshtone::batch::Control;
use meshtone::scenario::Scenario;
use meshtone::signal::{GearTrain, MeshTone, ShaftPhase, StatedTurning, TrainRecording, TrainTurning};
use meshtone_diagnose::{
    Answer, AnswerInWords, DiagnosisWarning, Learned, Observation, Question, REFINED_RECORDS, ReferenceStore,
    diagnose, refine,
};
use meshtone_io::recording::Recording;
use serde_json::{Value, json};

use super::recording::{RecordingQuestion, Turned, chosen, read, turned};
use crate::refusal::Refusal;

/// A recording that is diagnosed, or the healthy one that it is compared with: its file, and what that does not say itself.
type OpenedRecording<'a> = (&'a [u8], RecordingQuestion);

/// What is asked beside the scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagnosisQuestion<'a> {
    /// The recording in question.
    pub now: OpenedRecording<'a>,
    /// A recording of the same rig when it was healthy.
    pub healthy: Option<OpenedRecording<'a>>,
    /// Number of simulations to learn from.
    pub records: u64,
}

impl<'a> DiagnosisQuestion<'a> {
    /// As the page says it.
    ///
    /// # Arguments
    /// * `fields` - the fields by their names; of each recording also how many bytes its file has
    /// * `files` - the recording's file, and behind it the healthy one's
    ///
    /// # Errors
    /// Files that are shorter than is said; a number of simulations that is not allowed.
    pub fn of(fields: &Value, files: &'a [u8]) -> Result<Self, Refusal> {
        let cut = || Refusal::unfit("the request is not understood: it ends before its recordings do");
        let length = |recording: &Value| usize::try_from(recording.get("bytes")?.as_u64()?).ok();
        let now = fields.get("recording").ok_or_else(cut)?;
        let (file, behind) = length(now).and_then(|bytes| files.split_at_checked(bytes)).ok_or_else(cut)?;
        let of_healthy = |healthy| -> Result<OpenedRecording<'a>, Refusal> {
            let file = length(healthy).and_then(|bytes| behind.get(..bytes)).ok_or_else(cut)?;
            Ok((file, RecordingQuestion::of(healthy)))
        };
        let healthy = fields.get("healthy").filter(|healthy| !healthy.is_null());
        let records = fields.get("records").map_or(Some(ReferenceStore::USUAL_RECORDS), Value::as_u64);
        let [least, most] = [ReferenceStore::BATCH, ReferenceStore::MOST_RECORDS];
        let records = records.filter(|records| (least..=most).contains(records));
        Ok(Self {
            now: (file, RecordingQuestion::of(now)),
            healthy: healthy.map(of_healthy).transpose()?,
            records: records.ok_or_else(|| {
                Refusal::unfit(format!(
                    "the number of simulations must be a whole number from {least} to {most}"
                ))
            })?,
        })
    }
}

/// Diagnoses a recording by a scenario, as `meshtone diagnose` does.
///
/// What is seen without a simulation is said first, because the simulations take minutes. Learning from them cannot be cancelled, so that
/// it is asked before and after it whether the answer is still wanted.
///
/// # Arguments
/// * `question` - the recordings
/// * `rig` - the scenario; its faults are left out
/// * `store` - where the simulations are kept
/// * `say` - given what there is to say meanwhile: `seen`, the warnings before anything is simulated, and `progress`
/// * `cancelled` - set where nobody waits for it any more
///
/// # Errors
/// A recording that cannot be read or compared; a folder that cannot be written; cancelled.
pub fn diagnosis(
    question: &DiagnosisQuestion,
    rig: &Scenario,
    store: &ReferenceStore,
    say: &(dyn Fn(Value) + Sync),
    cancelled: &AtomicBool,
) -> Result<Value, Refusal> {
    let (now, mut seen) = observe(&question.now, rig)?;
    let mut healthy = Vec::new();
    if let Some(opened) = &question.healthy {
        let (observed, warnings) = observe(opened, rig)?;
        healthy.push(observed);
        seen.extend(warnings);
    }
    let asked = Question { now: &[now], healthy: &healthy };
    let prior = asked.prior(rig)?;
    asked.check(&prior)?;
    seen.extend(asked.warnings(&prior));
    say(json!({ "seen": messages(&seen) }));
    let progress = |counted: &'static str, of: u64| {
        move |finished: usize| {
            say(json!({ "progress": { "finished": finished, "of": of, "counted": counted } }))
        }
    };
    let of_set = progress("simulations", question.records.next_multiple_of(ReferenceStore::BATCH));
    let control = Control { progress: &of_set, cancelled, ..Control::default() };
    let reference = store.get(&prior, question.records, &control)?;
    let wanted = || if cancelled.load(Ordering::Relaxed) { Err(Refusal::Superseded) } else { Ok(()) };
    say(json!({ "progress": { "counted": "comparing the recording with them" } }));
    let learned = Learned::new(&reference, &asked)?;
    wanted()?;
    let of_likeliest = progress("simulations, of the likeliest damage", REFINED_RECORDS);
    let refined = refine(&learned, &asked, &Control { progress: &of_likeliest, ..control })?;
    wanted()?;
    Ok(answer_json(&diagnose(&learned, &asked, refined.as_ref())?, &seen))
}

/// Observes the rig's wheels in a recording, whose name stands before all that is said of it.
fn observe(
    (file, question): &OpenedRecording,
    rig: &Scenario,
) -> Result<(Observation, Vec<DiagnosisWarning>), Refusal> {
    let recording = read(file, question)?;
    let name = &question.name;
    let (observation, doubts) = of_recording(&recording, question, rig).map_err(|error| error.about(name))?;
    let doubts = recording.warnings.iter().map(ToString::to_string).chain(doubts);
    let about = |doubt| DiagnosisWarning { code: "reading", message: format!("{name}: {doubt}") };
    Ok((observation, doubts.map(about).collect()))
}

/// Observes the rig's wheels in a recording that was read, and says what is doubtful about the angle of its shaft.
///
/// The shafts turn as the scenario of a simulation says, or by the tachometer. Where there is none, the mesh tone makes the speed of the
/// page's scenario exact.
fn of_recording(
    recording: &Recording,
    question: &RecordingQuestion,
    rig: &Scenario,
) -> Result<(Observation, Vec<String>), Refusal> {
    let (simulated, channel) = chosen(recording, question)?;
    let mut channel = channel.into_owned();
    if !channel.convert_to_g() {
        let unit = channel.unit.filter(|unit| !unit.trim().is_empty());
        let is = unit.map_or_else(|| "has no stated unit".to_owned(), |unit| format!("is in {unit}"));
        let problem = format!("channel {} {is}; must be g or m/s²", channel.name);
        return Err(
            Refusal::unfit(problem).with_help("state it in the field Unit, where the recording is opened")
        );
    }
    let (rate_hz, samples) = (recording.sampling_rate_hz, &channel.samples);
    let by_mesh_tone = |train: &GearTrain| {
        let nominal_hz = rig.operation.pinion_speed_hz;
        let on_input = train.wheels.iter().find(|wheel| wheel.shaft == train.input());
        let tone = MeshTone::new(on_input.map_or(1, |wheel| wheel.teeth), nominal_hz);
        let phase = ShaftPhase::from_mesh_tone(samples, rate_hz, &tone)?;
        Ok(("mesh tone", StatedTurning::MeshTone { nominal_hz }, phase))
    };
    let Turned { train, turning, .. } = turned(
        recording,
        question.tachometer.as_deref().map(|name| (name, question.pulses_per_revolution)),
        simulated.as_ref(),
        rig,
        by_mesh_tone,
    )?;
    let doubts = match &turning {
        TrainTurning::Shaft { phase, .. } => phase.warnings.iter().map(ToString::to_string).collect(),
        TrainTurning::SimulatedPair(_) => Vec::new(),
    };
    let recording =
        TrainRecording { signal: samples, sampling_rate_hz: rate_hz, train: &train, turning: &turning };
    Ok((Observation::of_recording(&recording)?, doubts))
}

fn messages<'w>(warnings: impl IntoIterator<Item = &'w DiagnosisWarning>) -> Vec<&'w str> {
    warnings.into_iter().map(|warning| &warning.message[..]).collect()
}

/// The answer in words, with the warnings that were not said before.
fn answer_json(answer: &Answer, seen: &[DiagnosisWarning]) -> Value {
    let AnswerInWords { summary, damaged, likeness, kinds, others, notes } = answer.in_words();
    json!({
        "summary": summary,
        "damaged": damaged,
        "likeness": likeness,
        "columns": AnswerInWords::COLUMNS,
        "kinds": kinds,
        "others": others,
        "notes": notes,
        "warnings": messages(answer.warnings.iter().filter(|warning| !seen.contains(warning))),
    })
}
