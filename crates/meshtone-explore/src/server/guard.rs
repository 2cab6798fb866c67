//! The guard that answers only the page itself, at its own address.

use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Uri, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};

use super::Embedding;

/// Refuses requests before anything is read of them.
#[derive(Debug, Clone)]
pub(super) struct Guard(Arc<Rules>);

#[derive(Debug)]
struct Rules {
    /// Names by which a request may call this machine.
    hosts: [String; 2],
    /// The first part of every path.
    token: String,
    policy: HeaderValue,
}

impl Guard {
    /// The guard of a page.
    ///
    /// # Arguments
    /// * `port` - where it is served
    /// * `token` - the first part of its path
    /// * `embedding` - who may show it in a frame
    pub(super) fn new(port: u16, token: &str, embedding: Embedding) -> Self {
        // A notebook's page comes from this machine, at whatever port, or is an editor's own.
        let ancestors = match embedding {
            Embedding::Refused => "'none'",
            Embedding::Notebook => "http://localhost:* http://127.0.0.1:* vscode-webview:",
        };
        let policy = format!(
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
             base-uri 'none'; form-action 'none'; frame-ancestors {ancestors}"
        );
        Self(Arc::new(Rules {
            hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")],
            token: token.to_owned(),
            policy: HeaderValue::from_str(&policy).unwrap_or(HeaderValue::from_static("default-src 'none'")),
        }))
    }

    /// Puts the guard before a page, which then lies below its token.
    pub(super) fn protect(self, router: Router) -> Router {
        let nested = Router::new().nest(&format!("/{}/", self.0.token), router);
        nested.layer(middleware::from_fn_with_state(self, check))
    }
}

async fn check(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let rules = &guard.0;
    let mut response = match rules.objection(request.method(), request.uri(), request.headers()) {
        Some(words) => (StatusCode::FORBIDDEN, words).into_response(),
        None => next.run(request).await,
    };
    rules.add_headers(response.headers_mut());
    response
}

impl Rules {
    fn objection(&self, method: &Method, uri: &Uri, headers: &HeaderMap) -> Option<&'static str> {
        let is_host = |text: &str| self.hosts.iter().any(|host| host == text);
        let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
        // A name that leads to this machine, but that another page has chosen, is no name of it; neither is one of two that a request
        // states at once, or of a whole address in its first line.
        let is_stated_once = headers.get_all(header::HOST).iter().count() == 1;
        let is_own_address = uri.authority().is_none_or(|authority| is_host(authority.as_str()));
        if !is_stated_once || !is_own_address || !text(header::HOST).is_some_and(is_host) {
            return Some("this page answers to 127.0.0.1 and localhost at its own port only");
        }
        // Browsers say for whom they ask. Whoever follows a link, or shows the page in a notebook, navigates.
        let is_foreign = text(HeaderName::from_static("sec-fetch-site")) == Some("cross-site");
        if is_foreign && text(HeaderName::from_static("sec-fetch-mode")) != Some("navigate") {
            return Some("only this page itself may ask");
        }
        let is_own = |origin: &str| origin.strip_prefix("http://").is_some_and(is_host);
        let origin = text(header::ORIGIN);
        let is_reading = matches!(*method, Method::GET | Method::HEAD);
        if origin.map_or(!is_reading, |origin| !is_own(origin)) {
            return Some("only this page itself may ask");
        }
        let token = uri.path().split('/').nth(1).unwrap_or_default();
        if !is_equal(token.as_bytes(), self.token.as_bytes()) {
            return Some(
                "the address lacks the token of this run: open the address that was printed when it started",
            );
        }
        None
    }

    fn add_headers(&self, headers: &mut HeaderMap) {
        headers.insert(header::CONTENT_SECURITY_POLICY, self.policy.clone());
        for (name, value) in [
            (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
            (header::REFERRER_POLICY, "no-referrer"),
            (header::CACHE_CONTROL, "no-store"),
            (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        ] {
            headers.insert(name, HeaderValue::from_static(value));
        }
    }
}

/// In a time that does not depend on how much of it is right.
fn is_equal(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && one.iter().zip(other).fold(0, |differing, (a, b)| differing | (a ^ b)) == 0
}

/// An answer of a kind.
pub(super) fn respond(status: StatusCode, media_type: &'static str, body: impl Into<Body>) -> Response {
    (status, [(header::CONTENT_TYPE, media_type)], body.into()).into_response()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_refused(method: Method, uri: &'static str, headers: &[(HeaderName, &'static str)]) -> bool {
        let guard = Guard::new(8000, "abc", Embedding::Refused);
        let mut stated = HeaderMap::new();
        for (name, value) in headers {
            stated.append(name.clone(), HeaderValue::from_static(value));
        }
        guard.0.objection(&method, &Uri::from_static(uri), &stated).is_some()
    }

    #[test]
    fn only_the_page_itself_may_ask() {
        let here = (header::HOST, "127.0.0.1:8000");
        assert!(!is_refused(Method::GET, "/abc/", std::slice::from_ref(&here)));
        assert!(!is_refused(Method::GET, "/abc/", &[(header::HOST, "localhost:8000")]));
        assert!(is_refused(Method::GET, "/abc/", &[(header::HOST, "evil.example:8000")]));
        assert!(is_refused(Method::GET, "/abc/", &[]));
        assert!(is_refused(Method::GET, "/abd/", std::slice::from_ref(&here)));
        assert!(is_refused(Method::GET, "/", std::slice::from_ref(&here)));
        assert!(is_refused(Method::GET, "/abc/", &[here.clone(), (header::HOST, "evil.example")]));
        assert!(!is_refused(Method::GET, "http://127.0.0.1:8000/abc/", std::slice::from_ref(&here)));
        assert!(is_refused(Method::GET, "http://evil.example/abc/", std::slice::from_ref(&here)));
        let fetch = |name, value| (HeaderName::from_static(name), value);
        let foreign = fetch("sec-fetch-site", "cross-site");
        assert!(is_refused(Method::GET, "/abc/main.js", &[here.clone(), foreign.clone()]));
        assert!(is_refused(
            Method::GET,
            "/abc/",
            &[here.clone(), foreign.clone(), fetch("sec-fetch-mode", "no-cors")]
        ));
        assert!(!is_refused(
            Method::GET,
            "/abc/",
            &[here.clone(), foreign, fetch("sec-fetch-mode", "navigate")]
        ));
        let own = (header::ORIGIN, "http://127.0.0.1:8000");
        assert!(!is_refused(Method::POST, "/abc/answer", &[here.clone(), own]));
        assert!(is_refused(Method::POST, "/abc/answer", std::slice::from_ref(&here)));
        for other in ["http://evil.example", "https://127.0.0.1:8000", "null", "http://127.0.0.1:8001"] {
            assert!(is_refused(Method::POST, "/abc/answer", &[here.clone(), (header::ORIGIN, other)]));
            assert!(is_refused(Method::GET, "/abc/", &[here.clone(), (header::ORIGIN, other)]));
        }
    }
}
