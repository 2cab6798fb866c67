//! Diagnoses: what is said of them comes line by line, until the page closes the connection.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use axum::body::{Body, Bytes};
use axum::extract::State as Shares;
use axum::http::StatusCode;
use axum::response::Response;
use futures::stream;
use serde_json::{Value, json};
use tokio::sync::mpsc::{self, UnboundedSender};
use tokio::task::spawn_blocking;

use super::Shared;
use super::guard::respond;
use super::latest::RequestTurn;
use super::requests::{AskedRequest, framed};
use crate::answer::{DiagnosisQuestion, diagnosis};
use crate::question;
use crate::refusal::Refusal;

/// Media type of JSON in lines.
const LINES: &str = "application/x-ndjson";

/// A diagnosis: `seen` before anything is simulated, `progress`, and at the end an `answer` or an `error`.
///
/// It ends with the connection, which the page closes to stop it, and the browser where the page is closed.
pub(super) async fn of_diagnosis(
    Shares(shared): Shares<Arc<Shared>>,
    body: Bytes,
) -> Result<Response, Refusal> {
    let (said, files) = framed(&body)?;
    let asked = AskedRequest::of(&said)?;
    let turn = shared.latest.note(&format!("diagnosis {}", asked.page), asked.number);
    let abandoned = turn.abandoned_on_drop();
    let (to_page, lines) = mpsc::unbounded_channel();
    tokio::spawn(work(shared, asked, files, turn, to_page));
    let lines = stream::unfold((lines, abandoned), async |(mut lines, abandoned)| {
        let line: Value = lines.recv().await?;
        Some((Ok::<_, Infallible>(format!("{line}\n")), (lines, abandoned)))
    });
    Ok(respond(StatusCode::OK, LINES, Body::from_stream(lines)))
}

/// Waits until no other diagnosis is under way, makes this one, and sends to the page all that is said of it.
///
/// It has threads of its own: in those of all other computations, these would wait until a batch of simulations is finished.
async fn work(
    shared: Arc<Shared>,
    asked: AskedRequest,
    files: Bytes,
    turn: RequestTurn,
    to_page: UnboundedSender<Value>,
) {
    let room = Arc::clone(&shared.room_of_diagnosis);
    let permit = match Arc::clone(&room).try_acquire_owned() {
        Ok(permit) => Ok(permit),
        Err(_) => {
            // Nobody hears it whose connection is closed.
            let _ =
                to_page.send(json!({ "progress": { "counted": "waiting for another diagnosis to end" } }));
            room.acquire_owned().await
        }
    };
    let diagnosing = spawn_blocking({
        let to_page = to_page.clone();
        move || {
            let _permit = permit.map_err(|_| Refusal::Superseded)?;
            if turn.abandoned().load(Ordering::Relaxed) {
                return Err(Refusal::Superseded);
            }
            let store = shared.reference.as_ref().ok_or_else(no_folder)?;
            let rig = question::scenario(&asked.fields)?;
            let question = DiagnosisQuestion::of(&asked.fields, &files)?;
            let say = |said| drop(to_page.send(said));
            let pool = rayon::ThreadPoolBuilder::new().build();
            let pool =
                pool.map_err(|error| Refusal::unfit(format!("no threads for a diagnosis: {error}")))?;
            pool.install(|| diagnosis(&question, &rig, store, &say, turn.abandoned()))
        }
    });
    let said = match diagnosing.await {
        Ok(Ok(answer)) => json!({ "answer": answer }),
        Ok(Err(refusal)) => json!({ "error": refusal.json() }),
        Err(_) => json!({ "error": Refusal::unfit("the diagnosis was interrupted").json() }),
    };
    let _ = to_page.send(said);
}

fn no_folder() -> Refusal {
    Refusal::unfit("there is no folder for the simulations: the environment names no home directory")
        .with_help("set HOME, and start the page again")
}
