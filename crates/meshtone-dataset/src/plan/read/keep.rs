//! The table `[keep]`.

use meshtone::scenario::Scenario;
use meshtone::sensor::{Channel, ChannelKind};
use meshtone_io::channel_name::{accelerations, read_channel};
use meshtone_io::experiment::Tuned;
use meshtone_io::wheel_name::read_wheel;
use meshtone_toml::{ReadResult, TomlTable};

use super::super::{Keep, MOST_SHARD_RECORDS, OverAngle};

const RATE_HZ: f64 = 25e3;
const LARGEST_RATE_HZ: f64 = 1e7;
const MOST_POINTS: u64 = 1 << 20;
const MOST_REVOLUTIONS: u64 = 1 << 20;

pub(super) fn read(table: &TomlTable<'_>, base: &Scenario, tuned: Option<&Tuned>) -> ReadResult<Keep> {
    let default_rate =
        tuned.map_or(RATE_HZ.min(base.solver.sampling_rate_hz), |tuned| tuned.sampling_rate_hz);
    let rate = table.optional("sampling_rate_hz");
    let sampling_rate_hz = rate.as_ref().map(|value| value.number()).transpose()?.unwrap_or(default_rate);
    if let Some(value) = rate.filter(|_| !(sampling_rate_hz > 0.0 && sampling_rate_hz <= LARGEST_RATE_HZ)) {
        return Err(value.error(format!("must be more than 0 and at most {LARGEST_RATE_HZ:e} S/s")));
    }
    if sampling_rate_hz > base.solver.sampling_rate_hz {
        let simulated = base.solver.sampling_rate_hz;
        let problem =
            format!("is more than solver.sampling_rate_hz, {simulated:?} S/s, of the base scenario");
        return Err(table.error("sampling_rate_hz", problem).with_help("raise solver.sampling_rate_hz"));
    }
    let channels = match table.optional("channels") {
        None => default_channels(base),
        Some(value) => {
            let chosen = value
                .array()?
                .iter()
                .map(|value| read_channel(value, &Channel::all(&base.sensors)))
                .collect::<ReadResult<Vec<_>>>()?;
            if let Some(twice) = (1..chosen.len()).find(|&n| chosen[..n].contains(&chosen[n])) {
                return Err(value.array()?[twice].error("is named twice"));
            }
            chosen
        }
    };
    let duration_s = table.optional("duration_s");
    if let Some(value) =
        duration_s.as_ref().filter(|value| value.number().is_ok_and(|seconds| seconds <= 0.0))
    {
        return Err(value.error("must be more than 0 s"));
    }
    let flag =
        |key| -> ReadResult<Option<bool>> { table.optional(key).map(|value| value.boolean()).transpose() };
    let wheel = table.optional("wheel").map(|value| read_wheel(&value)).transpose()?;
    let wheel = wheel.or(tuned.map(|tuned| tuned.wheel)).unwrap_or_default();
    let teeth = u64::from(base.gears.teeth(wheel));
    let analysed = table
        .optional("analysed")
        .map(|value| read_channel(&value, &accelerations(&base.sensors)))
        .transpose()?;
    let sidebands = table
        .optional("sidebands")
        .map(|value| value.integer(0..=teeth.saturating_sub(2) / 2))
        .transpose()?;
    let orders = table.optional("shaft_orders").map(|value| value.integer(0..=teeth - 1)).transpose()?;
    let shard = table.optional("records_per_shard");
    let shard = shard.map(|value| value.integer(1..=MOST_SHARD_RECORDS)).transpose()?;
    let keep = Keep {
        sampling_rate_hz,
        duration_s: duration_s.map(|value| value.number()).transpose()?,
        over_angle: over_angle(table)?,
        channels,
        wheel,
        analysed: analysed
            .unwrap_or_else(|| tuned.map_or(Channel::leading(&base.sensors), |tuned| tuned.channel.clone())),
        sidebands: sidebands.map_or(tuned.map_or(2, |tuned| tuned.sidebands), |count| count as usize),
        shaft_orders: orders.map_or(tuned.map_or(7, |tuned| tuned.shaft_orders), |last| last as usize),
        average: flag("average")?.unwrap_or(true),
        difference: flag("difference")?.unwrap_or(true),
        indicators: flag("indicators")?.unwrap_or(true),
        aligned: flag("aligned")?.unwrap_or(false),
        records_per_shard: shard,
    };
    if keep.channels.is_empty() && !keep.is_analysed() {
        return Err(table.error(
            "channels",
            "is empty, and average, difference and indicators are false: nothing is kept",
        ));
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
            return Err(table
                .error(key, problem)
                .with_help("leave it out: it is then that of the file `tuned`"));
        }
    }
    Ok(())
}
