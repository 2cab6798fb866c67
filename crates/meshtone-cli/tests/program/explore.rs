//! `meshtone explore`, as far as it comes without a browser; the page itself is tried by the tests of `meshtone-explore` and of Python.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Stdio;

use crate::support::{Workplace, program};

#[test]
fn a_scenario_is_served_at_the_address_that_is_printed() {
    let workplace = Workplace::new();
    let mut command = program();
    command.current_dir(workplace.directory.path()).args(["explore", "fast.toml", "--no-open"]);
    let mut served = command.stdout(Stdio::piped()).spawn().unwrap();
    let mut address = String::new();
    BufReader::new(served.stdout.take().unwrap()).read_line(&mut address).unwrap();
    let (host, path) = address.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
    let mut stream = TcpStream::connect(host).unwrap();
    write!(stream, "GET /{path}start HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answered = String::new();
    stream.read_to_string(&mut answered).unwrap();
    served.kill().unwrap();
    served.wait().unwrap();
    assert!(answered.starts_with("HTTP/1.1 200") && answered.contains("\"pinion_teeth\":20"), "{answered}");
}

#[test]
fn what_cannot_be_served_is_reported() {
    let workplace = Workplace::new();
    workplace.fails(2, &["explore", "absent.toml"], &["absent.toml"]);
    workplace.write("wrong.toml", "[gears]\nmodul_mm = 3.0\n");
    workplace.fails(2, &["explore", "wrong.toml"], &["wrong.toml", "line 2"]);
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    workplace.fails(2, &["explore", "--port", &port, "--no-open"], &["--port", "name another port"]);
}
