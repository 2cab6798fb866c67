//! Draws the panels of the documentation's gallery.
//!
//! ```sh
//! cargo run --release -p meshtone-plot --example gallery -- docs/src/gallery
//! ```
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[path = "../tests/all/support.rs"]
mod support;

fn main() -> Result<(), Box<dyn Error>> {
    let folder: PathBuf = std::env::args_os().nth(1).ok_or("name the folder to write to")?.into();
    std::fs::create_dir_all(&folder)?;
    let with_svg = std::env::args().any(|argument| argument == "--svg");
    for (name, scenario) in support::gallery() {
        let simulation = meshtone::simulate(&scenario)?;
        let (panel, drawn) = quickest(|| meshtone_plot::panel::draw(&simulation))?;
        let (png, rasterised) = quickest(|| panel.png())?;
        println!(
            "{name}: SVG in {:.1} ms, PNG from it in {:.1} ms; SVG {} kB, PNG {} kB",
            1e3 * drawn.as_secs_f64(),
            1e3 * rasterised.as_secs_f64(),
            panel.svg().len() / 1000,
            png.len() / 1000
        );
        std::fs::write(folder.join(format!("{name}.png")), png)?;
        if with_svg {
            std::fs::write(folder.join(format!("{name}.svg")), panel.svg())?;
        }
    }
    Ok(())
}

/// The result of `work`, and the least time that it took in ten runs.
fn quickest<T, E>(work: impl Fn() -> Result<T, E>) -> Result<(T, Duration), E> {
    let timed = || -> Result<(T, Duration), E> {
        let start = Instant::now();
        let result = work()?;
        Ok((result, start.elapsed()))
    };
    let mut best = timed()?;
    for _ in 1..10 {
        let next = timed()?;
        if next.1 < best.1 {
            best = next;
        }
    }
    Ok(best)
}
