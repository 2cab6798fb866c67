//! Requests of the page.

use std::sync::{Arc, PoisonError};

use axum::Router;
use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Path, State as Shares};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use meshtone::scenario::Scenario;
use meshtone_diagnose::ReferenceStore;
use serde_json::{Map, Value, json};

use super::Shared;
use super::diagnosis::of_diagnosis;
use super::guard::respond;
use super::latest::RequestTurn;
use crate::answer::{
    AnswerOptions, Detail, HealthyIndicators, RecordingQuestion, State, answer, desk, gearbox_answer,
    gearbox_sections_json, healthy_indicators, healthy_json, recording, severity_curve,
};
use crate::controls::{controls, gearbox_controls};
use crate::export::{export, without_defaults};
use crate::question;
use crate::refusal::Refusal;

/// (bytes) Largest request about a scenario: one with given deviations of two large wheels.
const MOST_OF_SCENARIO: usize = 8 << 20;
/// (bytes) Largest recording.
const MOST_OF_RECORDING: usize = 64 << 20;
/// Media types of answers: JSON alone, and [`crate::Packet`]'s bytes.
const JSON: &str = "application/json";
const PACKET: &str = "application/octet-stream";
/// Bytes of the length, little endian, that stands before what is said about a recording.
const LENGTH_BYTES: usize = 4;

/// Addresses of the requests of the page.
pub(super) fn router(shared: Arc<Shared>) -> Router {
    let about_recordings = Router::new()
        .route("/recording", post(of_recording))
        .route("/desk", post(of_desk))
        .layer(DefaultBodyLimit::max(MOST_OF_RECORDING));
    let diagnoses = Router::new()
        .route("/diagnosis", post(of_diagnosis))
        .layer(DefaultBodyLimit::max(MOST_OF_SCENARIO + 2 * MOST_OF_RECORDING));
    Router::new()
        .route("/start", get(start))
        .route("/answer", post(of_answer))
        .route("/gearbox", post(of_gearbox))
        .route("/healthy", post(of_healthy))
        .route("/severity", post(of_severity))
        .route("/export/{form}", post(of_export))
        .layer(DefaultBodyLimit::max(MOST_OF_SCENARIO))
        .merge(about_recordings)
        .merge(diagnoses)
        .with_state(shared)
}

/// A request about a scenario, taken apart.
#[derive(Debug)]
pub(super) struct AskedRequest {
    /// Identity of the page.
    pub(super) page: String,
    /// Number of the request: later ones are higher.
    pub(super) number: u64,
    /// Level of detail, and channel.
    options: AnswerOptions,
    /// Number of the fault whose severity is meant.
    fault: usize,
    /// The request as it came.
    pub(super) fields: Value,
}

impl AskedRequest {
    pub(super) fn of(body: &[u8]) -> Result<Self, Refusal> {
        let fields: Value = serde_json::from_slice(body)
            .map_err(|error| Refusal::unfit(format!("the request is not understood: {error}")))?;
        let text = |name: &str| fields.get(name).and_then(Value::as_str);
        let number = |name: &str| fields.get(name).and_then(Value::as_u64).unwrap_or(0);
        let named = |name: &str| text(name).map(str::to_owned);
        let detail = if text("detail") == Some("coarse") { Detail::Coarse } else { Detail::Full };
        Ok(Self {
            page: text("page").unwrap_or_default().to_owned(),
            number: number("number"),
            options: AnswerOptions {
                detail,
                channel: named("channel"),
                wheel: named("wheel"),
                mesh: named("mesh"),
                bearing: named("bearing"),
            },
            fault: usize::try_from(number("fault")).unwrap_or(usize::MAX),
            fields,
        })
    }
}

/// Computes an answer about a pair beside the server's own thread, while somebody waits for it.
///
/// # Arguments
/// * `purpose` - what is asked for: a later request of the same page for it takes the place of this one
/// * `body` - the request
/// * `work` - what is computed of the request, its scenario and its turn
async fn compute<T: Send + 'static>(
    shared: &Arc<Shared>,
    purpose: &str,
    body: &[u8],
    work: impl FnOnce(&AskedRequest, &Scenario, &RequestTurn) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    compute_of(shared, purpose, body, question::pair, work).await
}

/// Does what [`compute`] does, of a scenario of any form.
///
/// # Arguments
/// * `read` - reads the scenario of a request
async fn compute_of<T: Send + 'static>(
    shared: &Arc<Shared>,
    purpose: &str,
    body: &[u8],
    read: impl FnOnce(&Value) -> Result<Scenario, Refusal> + Send + 'static,
    work: impl FnOnce(&AskedRequest, &Scenario, &RequestTurn) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let asked = AskedRequest::of(body)?;
    let turn = shared.latest.note(&format!("{purpose} {}", asked.page), asked.number);
    let _abandoned = turn.abandoned_on_drop();
    let failed = |what: &str| {
        Refusal::unfit(format!("the computation {what}")).with_help("reload the page and report the settings")
    };
    let permit = Arc::clone(&shared.room).acquire_owned().await.map_err(|_| failed("was ended"))?;
    if !turn.is_wanted() {
        return Err(Refusal::Superseded);
    }
    let worked = tokio::task::spawn_blocking(move || {
        let _permit = permit;
        let worked = read(&asked.fields).and_then(|scenario| work(&asked, &scenario, &turn));
        worked.map_err(|refusal| if turn.is_late() { too_long() } else { refusal })
    });
    worked.await.map_err(|_| failed("broke off"))?
}

fn too_long() -> Refusal {
    Refusal::unfit("the simulation takes longer than a minute").with_help(
        "lower solver.sampling_rate_hz or the numbers of teeth; `meshtone simulate` has no such limit",
    )
}

/// Answers with what the page is made from, and the scenario with which it opens.
async fn start(Shares(shared): Shares<Arc<Shared>>) -> Response {
    let scenario = &shared.start;
    let mut said;
    if scenario.rig().is_some() {
        said = controls();
        said["scenario"] = Value::Object(without_defaults(scenario));
    } else {
        said = gearbox_controls();
        said["scenario"] = gearbox_sections_json(scenario);
    }
    said["records"] =
        json!([ReferenceStore::BATCH, ReferenceStore::USUAL_RECORDS, ReferenceStore::MOST_RECORDS]);
    respond(StatusCode::OK, JSON, said.to_string())
}

/// Everything that is drawn.
async fn of_answer(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let sharing = Arc::clone(&shared);
    let bytes = compute(&shared, "answer", &body, move |asked, scenario, turn| {
        let state = answer(scenario, &asked.options, &|| turn.is_wanted())?;
        if asked.options.detail == Detail::Full {
            *sharing.current.lock().unwrap_or_else(PoisonError::into_inner) = scenario.clone();
        }
        let mut more = Map::from_iter([
            ("number".to_owned(), asked.number.into()),
            ("brief".to_owned(), Value::Object(without_defaults(scenario))),
        ]);
        if let Some(healthy) = known_healthy(&sharing, &state, &asked.options) {
            more.insert("healthy".to_owned(), healthy_json(&healthy));
        }
        Ok(state.packet(more))
    });
    Ok(respond(StatusCode::OK, PACKET, bytes.await?))
}

/// Everything that is drawn of a gearbox.
async fn of_gearbox(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let sharing = Arc::clone(&shared);
    let bytes = compute_of(&shared, "answer", &body, question::scenario, move |asked, gearbox, turn| {
        let state = gearbox_answer(gearbox, &asked.options, &|| turn.is_wanted())?;
        if asked.options.detail == Detail::Full {
            *sharing.current.lock().unwrap_or_else(PoisonError::into_inner) = gearbox.clone();
        }
        Ok(state.packet(Map::from_iter([("number".to_owned(), asked.number.into())])))
    });
    Ok(respond(StatusCode::OK, PACKET, bytes.await?))
}

/// Indicators of the gears without damage, where they are known already: where they have none, or the damage alone has changed.
fn known_healthy(shared: &Shared, state: &State, options: &AnswerOptions) -> Option<HealthyIndicators> {
    if state.scenario.faults.is_empty() {
        let unit = state.simulation.channels.signals[state.signal].unit;
        return Some(state.wheels.each_ref().map(|wheel| wheel.indicators(unit)));
    }
    let known = shared.healthy.lock().unwrap_or_else(PoisonError::into_inner);
    let of_same = known.as_ref().filter(|(key, _)| *key == key_of_healthy(&state.scenario, options));
    of_same.map(|(_, healthy)| healthy.clone())
}

fn key_of_healthy(scenario: &Scenario, options: &AnswerOptions) -> String {
    format!("{:?}\n{}", options, scenario.clone().with_faults(Vec::new()).to_toml())
}

/// Indicators of the same gears without damage.
async fn of_healthy(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let sharing = Arc::clone(&shared);
    let said = compute(&shared, "healthy", &body, move |asked, scenario, turn| {
        let healthy = healthy_indicators(scenario, &asked.options, &|| turn.is_wanted())?;
        let said = json!({ "number": asked.number, "healthy": healthy_json(&healthy) });
        let key = key_of_healthy(scenario, &asked.options);
        *sharing.healthy.lock().unwrap_or_else(PoisonError::into_inner) = Some((key, healthy));
        Ok(said.to_string())
    });
    Ok(respond(StatusCode::OK, JSON, said.await?))
}

/// Indicators against severity.
async fn of_severity(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let bytes = compute(&shared, "severity", &body, |asked, scenario, turn| {
        let channel = asked.options.channel.as_deref();
        let curve = severity_curve(scenario, asked.fault, channel, turn.abandoned())?;
        if turn.is_wanted() { Ok(curve) } else { Err(Refusal::Superseded) }
    });
    Ok(respond(StatusCode::OK, PACKET, bytes.await?))
}

/// What is said about recordings, and their files, which stand behind it, as an answer's numbers do.
pub(super) fn framed(body: &Bytes) -> Result<(Bytes, Bytes), Refusal> {
    let cut = || Refusal::unfit("the request is not understood: it ends before the recording begins");
    let (length, rest) = body.split_at_checked(LENGTH_BYTES).ok_or_else(cut)?;
    let length = length.iter().rev().fold(0, |length, &byte| length << 8 | usize::from(byte));
    if length > rest.len() {
        return Err(cut());
    }
    Ok((body.slice(LENGTH_BYTES..LENGTH_BYTES + length), body.slice(LENGTH_BYTES + length..)))
}

/// Reads a request of any kind, as the fuzz targets do, and its recording.
#[cfg(fuzzing)]
pub fn read_request(body: &[u8]) -> Result<(), String> {
    let body = Bytes::copy_from_slice(body);
    let (said, files) = framed(&body).unwrap_or((body, Bytes::new()));
    let read = || {
        let asked = AskedRequest::of(&said)?;
        let scenario = question::scenario(&asked.fields)?;
        if !files.is_empty() {
            desk(&files, &RecordingQuestion::of(&asked.fields), &scenario)?;
            recording(&files, &RecordingQuestion::of(&asked.fields), &scenario, &|| true)?;
        }
        Ok::<_, Refusal>(())
    };
    read().map_err(|refusal| refusal.json().to_string())
}

/// A recording that was dropped on the page.
async fn of_recording(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let (said, file) = framed(&body)?;
    let bytes = compute_of(&shared, "recording", &said, question::scenario, move |asked, scenario, turn| {
        recording(&file, &RecordingQuestion::of(&asked.fields), scenario, &|| turn.is_wanted())
    });
    Ok(respond(StatusCode::OK, PACKET, bytes.await?))
}

/// A recording that was opened on the page, before it is processed.
async fn of_desk(Shares(shared): Shares<Arc<Shared>>, body: Bytes) -> Result<Response, Refusal> {
    let (said, file) = framed(&body)?;
    let bytes = compute_of(&shared, "recording", &said, question::scenario, move |asked, scenario, _| {
        desk(&file, &RecordingQuestion::of(&asked.fields), scenario)
    });
    Ok(respond(StatusCode::OK, PACKET, bytes.await?))
}

/// A file for the user.
async fn of_export(
    Shares(shared): Shares<Arc<Shared>>,
    Path(form): Path<String>,
    body: Bytes,
) -> Result<Response, Refusal> {
    let file = compute_of(&shared, "export", &body, question::scenario, move |_, scenario, turn| {
        export(&form, scenario, &|| turn.is_wanted())
    });
    let file = file.await?;
    let disposition = format!("attachment; filename=\"scenario.{}\"", file.ending);
    let mut response = respond(StatusCode::OK, file.media_type, file.bytes);
    if let Ok(value) = disposition.parse() {
        response.headers_mut().insert(header::CONTENT_DISPOSITION, value);
    }
    Ok(response)
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let status = match self {
            Self::Superseded => StatusCode::CONFLICT,
            Self::Wrong(_) | Self::Unfit { .. } => StatusCode::UNPROCESSABLE_ENTITY,
        };
        respond(status, JSON, json!({ "error": self.json() }).to_string())
    }
}
