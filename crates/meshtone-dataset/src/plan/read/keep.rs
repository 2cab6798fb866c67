//! The table `[keep]`.

use meshtone::scenario::Scenario;
use meshtone::sensor::{Channel, ChannelKind};
use meshtone_io::channel_name::{accelerations, read_channel};
use meshtone_io::experiment::Tuned;
use meshtone_io::wheel_name::read_wheel;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{Keep, MOST_SHARD_RECORDS, OverAngle};
use super::{number_where, over_zero};

const RATE_HZ: f64 = 25e3;
const LARGEST_RATE_HZ: f64 = 1e7;
const MOST_POINTS: u64 = 1 << 20;
const MOST_REVOLUTIONS: u64 = 1 << 20;

/// Reads what is kept of each record.
///
/// Absent keys take their values from a tuning, where the plan names one, so that the records are processed as the recordings were, and
/// else from the base scenario. The checks of several keys against each other come after all of them have been read, because any of them
/// may be missing.
pub(super) fn read(table: &TomlTable<'_>, base: &Scenario, tuned: Option<&Tuned>) -> ReadResult<Keep> {
    let simulated_hz = base.solver.sampling_rate_hz;
    let default_hz = tuned.map_or(RATE_HZ.min(simulated_hz), |tuned| tuned.sampling_rate_hz);
    let given_hz = table.read_optional("sampling_rate_hz", |value| {
        let otherwise = format!("must be more than 0 and at most {LARGEST_RATE_HZ:e} S/s");
        number_where(value, |rate_hz| rate_hz > 0.0 && rate_hz <= LARGEST_RATE_HZ, &otherwise)
    })?;
    let sampling_rate_hz = given_hz.unwrap_or(default_hz);
    if sampling_rate_hz > simulated_hz {
        let problem =
            format!("is more than solver.sampling_rate_hz, {simulated_hz:?} S/s, of the base scenario");
        return Err(table.error("sampling_rate_hz", problem).with_help("raise solver.sampling_rate_hz"));
    }
    let channels = table.read_optional("channels", |value| {
        let mut chosen = Vec::new();
        for value in value.array()? {
            let channel = read_channel(&value, &Channel::all(&base.sensors))?;
            if chosen.contains(&channel) {
                return Err(value.error("is named twice"));
            }
            chosen.push(channel);
        }
        Ok(chosen)
    })?;
    let duration_s = table.read_optional("duration_s", |value| over_zero(value, "must be more than 0 s"))?;
    let wheel =
        table.read_optional("wheel", read_wheel)?.or(tuned.map(|tuned| tuned.wheel)).unwrap_or_default();
    let teeth = u64::from(base.gears.teeth(wheel));
    let analysed =
        table.read_optional("analysed", |value| read_channel(value, &accelerations(&base.sensors)))?;
    let integer = |key, allowed| table.read_optional(key, |value| value.integer(allowed));
    let sidebands = integer("sidebands", 0..=teeth.saturating_sub(2) / 2)?;
    let orders = integer("shaft_orders", 0..=teeth - 1)?;
    let flag = |key, default| -> ReadResult<bool> {
        Ok(table.read_optional(key, TomlValue::boolean)?.unwrap_or(default))
    };
    let keep = Keep {
        sampling_rate_hz,
        duration_s,
        over_angle: over_angle(table)?,
        channels: channels.unwrap_or_else(|| default_channels(base)),
        wheel,
        analysed: analysed
            .unwrap_or_else(|| tuned.map_or(Channel::leading(&base.sensors), |tuned| tuned.channel.clone())),
        sidebands: sidebands.map_or(tuned.map_or(2, |tuned| tuned.sidebands), |count| count as usize),
        shaft_orders: orders.map_or(tuned.map_or(7, |tuned| tuned.shaft_orders), |last| last as usize),
        average: flag("average", true)?,
        difference: flag("difference", true)?,
        indicators: flag("indicators", true)?,
        aligned: flag("aligned", false)?,
        records_per_shard: integer("records_per_shard", 1..=MOST_SHARD_RECORDS)?,
    };
    if keep.channels.is_empty() && !keep.is_analysed() {
        let problem = "is empty, and average, difference and indicators are false: nothing is kept";
        return Err(table.error("channels", problem));
    }
    agree(table, &keep, tuned)?;
    Ok(keep)
}

/// Channels over the angle: both numbers, or none.
fn over_angle(table: &TomlTable<'_>) -> ReadResult<Option<OverAngle>> {
    let points = table.optional("points_per_revolution");
    let revolutions = table.optional("revolutions");
    let (points, revolutions) = match (points, revolutions) {
        (None, None) => return Ok(None),
        (Some(points), Some(revolutions)) => (points, revolutions),
        (Some(points), None) => {
            let problem =
                "given without revolutions; must be both: how many values, over how many revolutions";
            return Err(points.error(problem));
        }
        (None, Some(revolutions)) => {
            return Err(revolutions.error("given without points_per_revolution; must be both"));
        }
    };
    if table.optional("duration_s").is_some() {
        return Err(table.error("duration_s", "given beside revolutions; give one of the two lengths"));
    }
    Ok(Some(OverAngle {
        points_per_revolution: points.integer(4..=MOST_POINTS)? as usize,
        revolutions: revolutions.integer(1..=MOST_REVOLUTIONS)? as usize,
    }))
}

/// The listed sensors, or the horizontal and the vertical acceleration.
fn default_channels(base: &Scenario) -> Vec<Channel> {
    if base.sensors.is_empty() {
        return [ChannelKind::Horizontal, ChannelKind::Vertical].map(Channel::from).into();
    }
    base.sensors.iter().map(|sensor| Channel::Sensor(sensor.name())).collect()
}

/// An enhancement is only what it is for the signals that it was tuned to.
fn agree(table: &TomlTable<'_>, keep: &Keep, tuned: Option<&Tuned>) -> ReadResult<()> {
    let Some(tuned) = tuned else { return Ok(()) };
    for (key, same) in [
        ("sampling_rate_hz", keep.sampling_rate_hz == tuned.sampling_rate_hz),
        ("analysed", keep.analysed == tuned.channel),
        ("wheel", keep.wheel == tuned.wheel),
        ("sidebands", keep.sidebands == tuned.sidebands),
        ("shaft_orders", keep.shaft_orders == tuned.shaft_orders),
        ("duration_s", keep.duration_s.is_none()),
        ("points_per_revolution", keep.over_angle.is_none()),
    ] {
        if !same {
            let problem = "is not what the enhancement was tuned to";
            let help = "leave it out: it is then that of the file `tuned`";
            return Err(table.error(key, problem).with_help(help));
        }
    }
    Ok(())
}
