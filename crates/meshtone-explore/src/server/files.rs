//! The page itself.

use axum::Router;
use axum::http::StatusCode;
use axum::routing::get;

use super::guard::respond;
use meshtone::scenario::Scenario;

/// The page of a pair or of a gearbox: what differs stands between what all pages begin and end with.
macro_rules! page {
    ($own:literal) => {
        concat!(
            include_str!("../page/head.html"),
            include_str!(concat!("../page/", $own)),
            include_str!("../page/foot.html")
        )
    };
}

/// One row a file: its path, its kind, where it lies.
macro_rules! files {
    ($($path:literal $media_type:literal $file:literal;)+) => {
        /// The page of a scenario and its parts.
        pub(super) fn router(start: &Scenario) -> Router {
            let page: &'static str = match start.rig() {
                Some(_) => page!("pair.html"),
                None => page!("gearbox.html"),
            };
            let page = move || async move { respond(StatusCode::OK, "text/html; charset=utf-8", page) };
            Router::new().route("/", get(page))$(.route($path, get(|| async {
                respond(StatusCode::OK, $media_type, &include_bytes!(concat!("../page/", $file))[..])
            })))+
        }
    };
}

files! {
    "/style.css" "text/css; charset=utf-8" "style.css";
    "/page.js" "text/javascript; charset=utf-8" "page.js";
    "/recording.js" "text/javascript; charset=utf-8" "recording.js";
    "/desk.js" "text/javascript; charset=utf-8" "desk.js";
    "/gearbox_controls.js" "text/javascript; charset=utf-8" "gearbox_controls.js";
    "/indicators.js" "text/javascript; charset=utf-8" "indicators.js";
    "/gearbox.js" "text/javascript; charset=utf-8" "gearbox.js";
    "/train.js" "text/javascript; charset=utf-8" "train.js";
    "/icon.svg" "image/svg+xml" "icon.svg";
    "/main.js" "text/javascript; charset=utf-8" "main.js";
    "/taking.js" "text/javascript; charset=utf-8" "taking.js";
    "/ask.js" "text/javascript; charset=utf-8" "ask.js";
    "/diagnosis.js" "text/javascript; charset=utf-8" "diagnosis.js";
    "/controls.js" "text/javascript; charset=utf-8" "controls.js";
    "/plots.js" "text/javascript; charset=utf-8" "plots.js";
    "/teeth.js" "text/javascript; charset=utf-8" "teeth.js";
    "/views.js" "text/javascript; charset=utf-8" "views.js";
    "/uplot.js" "text/javascript; charset=utf-8" "uplot/uPlot.iife.min.js";
    "/uplot.css" "text/css; charset=utf-8" "uplot/uPlot.min.css";
    "/uplot-licence.txt" "text/plain; charset=utf-8" "uplot/LICENSE";
}
