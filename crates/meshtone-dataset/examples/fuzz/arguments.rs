//! The command line.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

pub const USAGE: &str = "Usage: cargo xtask fuzz [--minutes M] [--seed S] [--reader NAME] [--number N]";

/// What the command line asks for.
pub struct Arguments {
    pub duration: Duration,
    pub seed: u64,
    /// One reader alone.
    pub reader: Option<String>,
    /// One input alone.
    pub number: Option<u64>,
}

impl Arguments {
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let mut arguments = Self { duration: Duration::from_secs(60), seed: now, reader: None, number: None };
        while let Some(name) = words.next() {
            let value = words.next().ok_or_else(|| format!("{name} needs a value"))?;
            let wrong = || format!("{name} {value}: must be a number");
            match name.as_str() {
                "--minutes" => {
                    let minutes = value.parse::<f64>().ok().filter(|minutes| (0.0..1e6).contains(minutes));
                    arguments.duration = Duration::from_secs_f64(60.0 * minutes.ok_or_else(wrong)?);
                }
                "--seed" => arguments.seed = value.parse().map_err(|_| wrong())?,
                "--number" => arguments.number = Some(value.parse().map_err(|_| wrong())?),
                "--reader" => arguments.reader = Some(value),
                _ => return Err(format!("there is no {name}")),
            }
        }
        Ok(arguments)
    }

    /// The numbers of the inputs.
    pub fn numbers(&self) -> std::ops::RangeInclusive<u64> {
        self.number.map_or(0..=u64::MAX, |number| number..=number)
    }
}
