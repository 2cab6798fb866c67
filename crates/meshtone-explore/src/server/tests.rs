//! The server, asked as a browser asks it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use meshtone::damage::damage_kinds;
use meshtone::scenario::{Fault, GearPair, Model, Scenario, gearbox_template};
use serde_json::{Value, json};

use super::*;

/// Tooth counts with a large common factor need few samples a revolution.
fn fast() -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: 20,
        gear_teeth: 40,
        brake_torque_nm: 200.0,
        ..GearPair::example()
    });
    scenario.solver.sampling_rate_hz = 1000.0;
    scenario
}

fn server() -> Server {
    server_with(None)
}

fn server_with(reference: Option<PathBuf>) -> Server {
    let settings = ServerSettings { scenario: fast(), port: 0, embedding: Embedding::Refused, reference };
    Server::start(settings).unwrap()
}

struct Answered {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answered {
    fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap()
    }

    /// What is said of a packet, and how many numbers follow.
    fn packet(&self) -> (Value, usize) {
        let length = u32::from_le_bytes(self.body[..4].try_into().unwrap()) as usize;
        (serde_json::from_slice(&self.body[4..4 + length]).unwrap(), (self.body.len() - 4 - length) / 4)
    }
}

impl Server {
    fn request(&self, method: &str, path: &str, body: &[u8]) -> TcpStream {
        let mut stream = TcpStream::connect(self.address).unwrap();
        let (host, token, length) = (self.address, &self.token, body.len());
        let head = format!(
            "{method} /{token}/{path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n"
        );
        // A server that refuses may not read all of it.
        let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body));
        stream
    }

    fn ask(&self, method: &str, path: &str, body: &[u8]) -> Answered {
        answered(self.request(method, path, body))
    }

    fn post(&self, path: &str, question: &Value) -> Answered {
        self.ask("POST", path, question.to_string().as_bytes())
    }
}

fn answered(mut stream: TcpStream) -> Answered {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
    let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    Answered { status, head, body: bytes[end + 4..].to_vec() }
}

/// What is said about recordings, and their files behind it.
fn framed(said: Vec<u8>, files: &[u8]) -> Vec<u8> {
    [&(said.len() as u32).to_le_bytes()[..], &said, files].concat()
}

fn question(scenario: &Scenario, number: u64) -> Value {
    json!({ "page": "one", "number": number, "detail": "full", "scenario": scenario })
}

#[test]
fn the_page_comes_with_a_strict_policy_and_all_that_it_names() {
    let server = server();
    let page = server.ask("GET", "", b"");
    assert_eq!(page.status, 200);
    assert!(page.head.contains("default-src 'none'; script-src 'self'; style-src 'self'"), "{}", page.head);
    assert!(page.head.contains("frame-ancestors 'none'"));
    let html = String::from_utf8(page.body).unwrap();
    for part in html.split(['"', '\'']).filter(|part| part.ends_with(".js") || part.ends_with(".css")) {
        assert_eq!(server.ask("GET", part, b"").status, 200, "{part}");
    }
    assert_eq!(server.ask("GET", "nothing.js", b"").status, 404);
    let mut without_token = TcpStream::connect(server.address).unwrap();
    let head = format!("GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", server.address);
    without_token.write_all(head.as_bytes()).unwrap();
    assert_eq!(answered(without_token).status, 403);
    assert_eq!(server.ask("GET", "start", b"").json()["scenario"]["gears"]["pinion_teeth"], 20);
}

/// A connection that asks for nothing, or not to the end, is closed; one that waits for an answer is not.
#[test]
fn idle_connections_are_closed() {
    let server = server();
    for said in [&b""[..], b"GET / HTTP/1.1\r\nHost: "] {
        let mut idle = TcpStream::connect(server.address).unwrap();
        idle.write_all(said).unwrap();
        idle.set_read_timeout(Some(std::time::Duration::from_secs(20))).unwrap();
        let mut answer = Vec::new();
        idle.read_to_end(&mut answer).unwrap();
        assert!(answer.is_empty() || answer.starts_with(b"HTTP/1.1 4"), "{answer:?}");
    }
    assert_eq!(server.ask("GET", "", b"").status, 200);
}

/// What the desk shows of a recording, and what it guesses; where a field of the page helps, it says which.
#[test]
fn a_recording_is_looked_at_before_it_is_processed() {
    let server = server();
    let rows = |time: &str| {
        let row = |i: u32| {
            let wave = (0.7 * f64::from(i)).sin() + 0.1 * f64::from(i * i % 7);
            // The pinion turns 40 times a second, with two pulses each time.
            format!("{:.6},{},{wave:.4},,\n", f64::from(i) / 8000.0, if i % 100 < 9 { 5 } else { 0 })
        };
        format!("{time},marks [V],bearing [g]\n")
            + &(0..12_000).map(row).map(|row| row.replace(",,", "")).collect::<String>()
    };
    let asked = |settings: Value| {
        let mut scenario = fast();
        scenario.operation.pinion_speed_hz = 40.0;
        let mut asked = question(&scenario, 1);
        asked["name"] = json!("run.csv");
        settings.as_object().unwrap().iter().for_each(|(name, value)| asked[name] = value.clone());
        asked.to_string().into_bytes()
    };
    let desk =
        |settings: Value, file: &str| server.ask("POST", "desk", &framed(asked(settings), file.as_bytes()));
    let (said, numbers) = desk(json!({}), &rows("time_s")).packet();
    assert_eq!(
        said["guess"],
        json!({ "channel": "bearing", "tachometer": "marks", "pulses_per_revolution": 2 })
    );
    assert_eq!((&said["sampling_rate_hz"], &said["duration_s"]), (&json!(8000.0), &json!(1.5)));
    assert_eq!((&said["rate_by"], &said["speed_hz"]), (&json!("time column time_s"), &json!(40.0)));
    assert!((said["pulses_hz"].as_f64().unwrap() - 80.0).abs() < 1e-6);
    assert_eq!((said["signal"]["values"]["length"].as_u64(), numbers > 8000), (Some(8000), true));
    assert_eq!(said["teeth"][0]["teeth"], 20);
    let problem = |settings: Value, file: &str| {
        desk(settings, file).packet().0["problem"].as_str().unwrap_or_default().to_owned()
    };
    let no_rate = problem(json!({}), &rows("first"));
    assert!(
        no_rate.contains("in the field Sampling rate") && no_rate.contains("in the field Time column"),
        "{no_rate}"
    );
    assert_eq!(problem(json!({ "time": "first" }), &rows("first")), "");
    let head = format!("Recorder: X3\n{}", rows("time_s"));
    assert!(
        problem(json!({}), &head).contains("in the field Lines to skip"),
        "{}",
        problem(json!({}), &head)
    );
    let (skipped, _) = desk(json!({ "skip_lines": 1, "unit": "m/s²" }), &head).packet();
    assert_eq!(skipped["guess"]["channel"], "bearing");
    // No message names an option, which the page has not.
    for file in
        ["1,5\n2,5\n", "a;b\n1;x\n2;3\n", "t,a\n0,1\n1,\n2,3\n", "t,a\n0,1\n0.5,2\n7,3\n", "a\n1\n2\n"]
    {
        let answered = desk(json!({}), file);
        let text = String::from_utf8_lossy(&answered.body).into_owned();
        assert!(!text.contains("option") && !text.contains("--"), "{text}");
    }
}

#[test]
fn an_answer_has_all_that_is_drawn() {
    let server = server();
    let mut scenario = fast();
    scenario.operation.pinion_speed_hz = 41.0;
    let (said, numbers) = server.post("answer", &question(&scenario, 1)).packet();
    assert_eq!((&said["number"], &said["detail"]), (&json!(1), &json!("full")));
    assert_eq!(serde_json::from_value::<Scenario>(said["brief"].clone()).unwrap(), scenario);
    assert_eq!(said["wheels"][1]["average"]["length"], said["wheels"][1]["difference"]["length"]);
    assert!(numbers > 1000);
    // It is its own healthy gear.
    assert_eq!(said["healthy"][1], said["wheels"][1]["indicators"]);
    assert_eq!(server.scenario(), scenario.clone());
    let coarse = json!({ "page": "one", "number": 2, "detail": "coarse", "scenario": fast() });
    let (said, _) = server.post("answer", &coarse).packet();
    assert!(said["wheels"][1]["revolutions"].as_u64() <= Some(3));
    assert_eq!(server.scenario(), scenario.clone());
}

#[test]
fn wrong_values_are_refused_in_the_programs_words() {
    let server = server();
    let mut wrong = question(&fast(), 1);
    wrong["scenario"]["gears"]["module_mm"] = json!(-3);
    let refused = server.post("answer", &wrong);
    assert_eq!(refused.status, 422);
    let error = &refused.json()["error"];
    assert_eq!(
        (&error["key"], &error["problem"]),
        (&json!("gears.module_mm"), &json!("must be more than 0 mm"))
    );
    let file =
        server.post("answer", &json!({ "page": "one", "number": 2, "toml": "[gears]\nmodul_mm = 3\n" }));
    assert_eq!(file.json()["error"]["line"], 2);
    for nonsense in [&b"{"[..], b"[]", b"{}"] {
        assert_eq!(server.ask("POST", "answer", nonsense).status, 422);
    }
    // As of the program, what would fill the memory is refused before it is begun.
    let mut large = question(&fast(), 3);
    large["scenario"]["solver"]["sampling_rate_hz"] = json!(1e12);
    let refused = server.post("answer", &large).json();
    assert!(refused["error"]["text"].as_str().unwrap().contains("memory"), "{refused}");
}

#[test]
fn requests_are_bounded() {
    let server = server();
    assert_eq!(server.ask("POST", "answer", &vec![b' '; (8 << 20) + 1]).status, 413);
}

#[test]
fn an_older_request_gives_way() {
    let server = server();
    let mut slow = fast();
    slow.solver.sampling_rate_hz = 3e6;
    let start = Instant::now();
    let waiting = server.request("POST", "answer", question(&slow, 1).to_string().as_bytes());
    std::thread::sleep(Duration::from_millis(30));
    assert_eq!(server.post("answer", &question(&fast(), 2)).status, 200);
    let old = answered(waiting);
    assert_eq!((old.status, old.json()["error"]["kind"].as_str()), (409, Some("superseded")));
    assert!(start.elapsed() < Duration::from_secs(20));
    assert_eq!(server.post("answer", &question(&fast(), 1)).status, 409);
}

#[test]
fn severity_healthy_and_files_are_answered() {
    let server = server();
    let broken = json!({ "kind": "tooth-breakage", "chip_height_mm": 5.0, "chip_width_mm": 12.0 });
    let mut asked = question(&fast(), 1);
    asked["scenario"]["fault"] = broken;
    let (curve, _) = server.post("severity", &asked).packet();
    assert_eq!((&curve["wheel"], &curve["severities"]["length"]), (&json!("gear"), &json!(9)));
    let healthy = server.post("healthy", &asked).json();
    assert_eq!(healthy["healthy"][0].as_array().unwrap().len(), 86);
    // It is remembered.
    let (said, _) = server.post("answer", &asked).packet();
    assert_eq!(said["healthy"], healthy["healthy"]);
    for (form, start) in [
        ("toml", &b"# Made by Meshtone"[..]),
        ("python", b"import meshtone"),
        ("svg", b"<"),
        ("parquet", b"PAR1"),
    ] {
        let file = server.post(&format!("export/{form}"), &asked);
        assert!(file.body.starts_with(start), "{form}: {}", file.status);
        assert!(file.head.contains("attachment; filename="), "{form}");
    }
    assert_eq!(server.post("export/exe", &asked).status, 422);
}

#[test]
fn a_recording_goes_through_the_same_chain() {
    let server = server();
    let wave =
        |i: u32| (std::f64::consts::TAU * 800.0 * f64::from(i) / 8000.0).sin() + 0.1 * f64::from(i * i % 7);
    let csv: String = std::iter::once("acceleration [g]".to_owned())
        .chain((0..4000).map(|i| format!("{:.4}", wave(i))))
        .collect::<Vec<_>>()
        .join("\n");
    let of_file = |name: &str| {
        let mut asked = question(&fast(), 1);
        asked["name"] = json!(name);
        asked["sampling_rate_hz"] = json!(8000.0);
        asked.to_string().into_bytes()
    };
    let answered = server.ask("POST", "recording", &framed(of_file("run.csv"), csv.as_bytes()));
    let (said, _) = answered.packet();
    assert_eq!(
        (&said["signal"]["channel"]["name"], &said["turning"]),
        (&json!("acceleration"), &json!("constant speed"))
    );
    assert_eq!(said["wheels"][0]["revolutions"], 19);
    let refused = server.ask("POST", "recording", &framed(of_file("run.wav"), b"no sound")).json();
    let text = refused["error"]["text"].as_str().unwrap().to_owned();
    assert!(text.starts_with("run.wav"), "{text}");
    assert_eq!(server.ask("POST", "recording", &[9, 0]).status, 422);
}

/// A rig whose simulations take milliseconds, and show enough mesh orders.
fn rig() -> Scenario {
    let mut rig = fast();
    rig.model = Model::Linear;
    rig.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 6);
    rig.solver.sampling_rate_hz = 8000.0;
    rig
}

/// A file that `meshtone simulate` would write.
fn simulated(server: &Server, scenario: &Scenario) -> Vec<u8> {
    server.post("export/parquet", &question(scenario, 1)).body
}

/// The request of a diagnosis.
fn asked(rig: &Scenario, name: &str, now: &[u8], healthy: Option<&[u8]>, records: u64) -> Vec<u8> {
    let mut said = question(rig, 1);
    let tachometer = name.ends_with("csv").then_some("tacho");
    said["recording"] = json!({ "name": name, "bytes": now.len(), "tachometer": tachometer });
    said["healthy"] = json!(healthy.map(|file| json!({ "name": "sound.parquet", "bytes": file.len() })));
    said["records"] = json!(records);
    framed(said.to_string().into_bytes(), &[now, healthy.unwrap_or_default()].concat())
}

/// The lines of what is said, as they come: between them are the lengths of the parts in which they were sent.
fn said(stream: TcpStream) -> impl Iterator<Item = Value> {
    let lines = BufReader::new(stream).lines().map_while(Result::ok);
    lines.filter(|line| line.starts_with('{')).map(|line| serde_json::from_str(&line).unwrap())
}

#[test]
fn a_recording_is_diagnosed_with_progress() {
    let folder = tempfile::tempdir().unwrap();
    let server = server_with(Some(folder.path().to_owned()));
    let ask = |name: &str, now: &[u8], healthy: Option<&[u8]>| {
        let body = asked(&rig(), name, now, healthy, 1024);
        said(server.request("POST", "diagnosis", &body)).collect::<Vec<Value>>()
    };
    let sound = simulated(&server, &rig());
    let mut broken = rig();
    broken.faults.push(Fault::at_usual_place(damage_kinds()[0].example.clone()));
    let broken = simulated(&server, &broken);

    let all = ask("broken.parquet", &broken, Some(&sound));
    assert_eq!(all[0], json!({ "seen": [] }));
    let finished: Vec<u64> = all
        .iter()
        .filter(|said| said["progress"]["counted"] == "simulations")
        .filter_map(|said| said["progress"]["finished"].as_u64())
        .collect();
    assert!(finished.len() > 2 && finished.is_sorted() && finished.last() == Some(&1024), "{finished:?}");
    let answer = &all.last().unwrap()["answer"];
    let damaged = answer["damaged"].as_str().unwrap_or_else(|| panic!("{:?}", all.last()));
    assert!(damaged.starts_with("damaged with a probability of"), "{damaged}");
    let likeliest = &answer["kinds"][0];
    assert!(
        likeliest[3].as_str().unwrap().contains("gear") && likeliest[3].as_str().unwrap().contains("tooth 1")
    );

    // What no simulation is like has no probabilities, and is known before they are made.
    let noise = |i: u64| {
        let mixed = (i + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (mixed >> 40) as f64 / (1_u64 << 24) as f64 - 0.5
    };
    let rows = (0..16_000).map(|i| {
        let pulse = u8::from(i % 200 < 20);
        format!("{:.6},{:.5},{pulse}\n", i as f64 / 8000.0, noise(i))
    });
    let file: String = std::iter::once("time_s,bearing [g],tacho\n".to_owned()).chain(rows).collect();
    let all = ask("noise.csv", file.as_bytes(), None);
    assert!(all[0]["seen"][0].as_str().unwrap().contains("no signal is synchronous"), "{}", all[0]);
    let answer = &all.last().unwrap()["answer"];
    assert!(answer["summary"].as_str().unwrap().starts_with("Nothing can be said"), "{answer}");
    assert_eq!((&answer["kinds"], &answer["damaged"]), (&json!([]), &Value::Null));

    // What cannot be compared is refused before anything is simulated.
    let mut other = rig();
    other.wheels[1].teeth = 60;
    let refused = ask("other.parquet", &simulated(&server, &other), None);
    assert_eq!(refused.len(), 1, "{refused:?}");
    assert!(refused[0]["error"]["text"].as_str().unwrap().contains("teeth"), "{refused:?}");
    let volts = file.replace("[g]", "[V]");
    let refused = ask("volts.csv", volts.as_bytes(), None);
    assert_eq!(
        refused[0]["error"]["text"], "volts.csv: channel bearing is in V; must be g or m/s²",
        "{refused:?}"
    );
    let body = asked(&rig(), "broken.parquet", &broken, None, 100);
    let refused = said(server.request("POST", "diagnosis", &body)).next().unwrap();
    assert!(refused["error"]["text"].as_str().unwrap().contains("from 512 to 20480"), "{refused}");
}

#[test]
fn a_diagnosis_ends_with_its_connection_and_others_are_answered_meanwhile() {
    let folder = tempfile::tempdir().unwrap();
    let server = server_with(Some(folder.path().to_owned()));
    let file = simulated(&server, &rig());
    let body = asked(&rig(), "sound.parquet", &file, None, ReferenceStore::MOST_RECORDS);
    let stream = server.request("POST", "diagnosis", &body);
    let is_beyond_a_batch =
        |said: &Value| said["progress"]["finished"].as_u64() > Some(ReferenceStore::BATCH);
    assert!(said(stream.try_clone().unwrap()).any(|said| is_beyond_a_batch(&said)));
    let room = &server.shared.room_of_diagnosis;
    assert_eq!(room.available_permits(), 0);
    let start = Instant::now();
    assert_eq!(server.post("answer", &question(&fast(), 1)).status, 200);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    // Another one waits for it.
    let waiting = server.request("POST", "diagnosis", &asked(&rig(), "sound.parquet", &file, None, 1024));
    let mut waiting = said(waiting);
    assert_eq!(waiting.next().unwrap()["progress"]["counted"], "waiting for another diagnosis to end");
    stream.shutdown(std::net::Shutdown::Both).unwrap();
    let kept = waiting.find(|said| said["progress"]["finished"].is_u64()).unwrap();
    assert_eq!(kept["progress"]["finished"], 512);
    let last = waiting.last().unwrap();
    assert!(last["answer"]["summary"].is_string(), "{last}");
    assert_eq!(room.available_permits(), 1);
}

/// The two-stage gearbox with a ball bearing at the input.
fn geared(defect: &str) -> String {
    let bearing =
        format!("[[bearing]]\nshaft = \"input\"\nat = 0.0\nkind = \"ball\"\nname = \"ER-10K\"\n{defect}");
    let template = gearbox_template(None).replace("[[bearing]]\nshaft = \"input\"\nat = 0.0\n", &bearing);
    let mut gearbox = Scenario::from_toml(&template).unwrap();
    gearbox.faults.clear();
    gearbox.solver.sampling_rate_hz = 2e4;
    gearbox.solver.duration_s = Some(2.0);
    gearbox.to_toml()
}

#[test]
fn the_envelope_of_a_rolling_bearing_shows_its_defect() {
    let server = server();
    let asked = |toml: &str, detail: &str| {
        let question =
            json!({ "page": "a", "detail": detail, "toml": toml, "channel": "input_0_vertical_g" });
        server.post("gearbox", &question).packet().0
    };
    let amplitude = |said: &Value, name: &str| {
        let lines = said["bearing"]["lines"].as_array().unwrap();
        lines.iter().find(|line| line[0] == name).unwrap()[3].as_f64().unwrap()
    };
    let healthy = asked(&geared(""), "full");
    let spalled = asked(&geared("defect = [{ race = \"outer\", width_mm = 2.0 }]\n"), "full");
    assert!(
        amplitude(&spalled, "BPFO") > 5.0 * amplitude(&healthy, "BPFO"),
        "{} {}",
        spalled["bearing"],
        healthy["bearing"]
    );
    for other in ["FTF", "BPFI", "2 BSF"] {
        assert!(
            amplitude(&spalled, "BPFO") > 2.0 * amplitude(&spalled, other),
            "{other}: {}",
            spalled["bearing"]
        );
    }
    assert_eq!(
        (&spalled["bearing"]["name"], &spalled["bearing"]["shaft"]),
        (&json!("input:0"), &json!("input"))
    );
    assert_eq!(spalled["train"]["bearings"][0]["damaged"], true);
    // As far as a little beyond the third harmonic of the inner race: 4.948 of an ER-10K.
    let bearing = &spalled["bearing"];
    let most = bearing["spectrum"]["length"].as_f64().unwrap() * bearing["step"].as_f64().unwrap();
    assert!((16.0..17.0).contains(&most), "{most}");
    // Too little is simulated while a control moves, and linear bearings have no such lines.
    assert_eq!(asked(&geared(""), "coarse")["bearing"], Value::Null);
    assert_eq!(asked(&gearbox_template(None), "coarse")["bearing"], Value::Null);
}

#[test]
fn a_recording_of_a_gearbox_shows_its_wheels_and_a_bearing() {
    let server = server();
    let gearbox = Scenario::from_toml(&geared("defect = [{ race = \"outer\", width_mm = 2.0 }]\n")).unwrap();
    let export = |scenario: &Scenario| {
        server.post("export/parquet", &json!({ "page": "a", "toml": scenario.to_toml() })).body
    };
    let ask = |name: &str, scenario: &Scenario, file: &[u8]| {
        let asked = json!({ "page": "a", "name": name, "toml": scenario.to_toml(), "bearing": "input:0" });
        server.ask("POST", "recording", &framed(asked.to_string().into_bytes(), file))
    };
    // The page shows another gearbox: a sound bearing.
    let file = export(&gearbox);
    let (said, _) = ask("own.parquet", &Scenario::from_toml(&geared("")).unwrap(), &file).packet();
    assert_eq!(said["turning"], "scenario");
    let names: Vec<&Value> = said["wheels"].as_array().unwrap().iter().map(|wheel| &wheel["name"]).collect();
    assert_eq!(names, ["z1", "z2", "z3", "z4"]);
    // 2 s at 30, 10, 10 and 6 rev/s, from the angles at which first teeth enter contact on.
    let turns = |of: &Value| {
        of["wheels"].as_array().unwrap().iter().map(|wheel| wheel["revolutions"].as_u64()).collect::<Vec<_>>()
    };
    assert_eq!(turns(&said), [59, 19, 19, 11].map(Some));
    assert_eq!(said["bearing"]["name"], "input:0");
    let lines = said["bearing"]["lines"].as_array().unwrap();
    let over_median = |name: &str| lines.iter().find(|line| line[0] == name).unwrap()[4].as_f64().unwrap();
    assert!(over_median("BPFO") > 3.0 * over_median("BPFI"), "{lines:?}");
    assert!(said["spectrum"]["values"]["length"].as_u64().unwrap() > 1000);
    // A measured one turns with the page's speed.
    let rows =
        (0..40_000_u32).map(|i| format!("{:.4}", (f64::from(i) * 0.3).sin() + 0.1 * f64::from(i * i % 7)));
    let csv = std::iter::once("bearing [g]".to_owned()).chain(rows).collect::<Vec<_>>().join("\n");
    let asked = json!({ "page": "a", "name": "a.csv", "sampling_rate_hz": 2e4, "toml": geared("") });
    let body = framed(asked.to_string().into_bytes(), csv.as_bytes());
    let (measured, _) = server.ask("POST", "recording", &body).packet();
    assert_eq!((&measured["turning"], turns(&measured)[0]), (&json!("constant speed"), Some(59)));
    // What was simulated of other wheels is not looked at with these.
    let text =
        ask("pair.parquet", &gearbox, &export(&fast())).json()["error"]["text"].as_str().unwrap().to_owned();
    assert!(text.contains("pinion, gear") && text.contains("z1 of 32 teeth, z2 of 96 teeth"), "{text}");
}

#[test]
fn a_defect_that_does_not_fit_is_refused_at_its_key() {
    let server = server();
    for (defect, key, problem) in [
        (
            "{ race = \"outer\", width_mm = 9.0 }",
            "bearing[0].defect[0].width_mm",
            "at most 7.9375 mm, the diameter of an element",
        ),
        ("{ race = \"outer\", width_mm = -1.0 }", "bearing[0].defect[0].width_mm", "must be more than 0"),
        ("{ race = \"outer\", severity = 1.5 }", "bearing[0].defect[0].severity", "at most 1"),
    ] {
        let wrong = geared("").replacen(
            "name = \"ER-10K\"\n",
            &format!("name = \"ER-10K\"\ndefect = [{defect}]\n"),
            1,
        );
        let scenario: Value = serde_json::to_value(wrong.parse::<toml::Table>().unwrap()).unwrap();
        let refused = server.post("gearbox", &json!({ "page": "a", "scenario": scenario }));
        let error = &refused.json()["error"];
        assert_eq!((refused.status, &error["key"]), (422, &json!(key)), "{error}");
        assert!(error["problem"].as_str().unwrap().contains(problem), "{error}");
    }
}
