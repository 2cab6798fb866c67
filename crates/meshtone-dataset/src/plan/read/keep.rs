//! The table `[keep]`.

use meshtone::scenario::{Scenario, WheelName};
use meshtone::sensor::{Channel, ChannelKind};
use meshtone::signal::GearTrain;
use meshtone_io::channel_name::{accelerations, read_channel};
use meshtone_io::experiment::Tuned;
use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::super::{AveragedWheels, Keep, MOST_SHARD_RECORDS, OverAngle};
use super::{distinct, number_where, over_zero};

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
    let known = Known::of(base);
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
        distinct(value, "is named twice", |value| read_channel(value, &known.channels))
    })?;
    let duration_s = table.read_optional("duration_s", |value| over_zero(value, "must be more than 0 s"))?;
    let of_tuned = || tuned.map(|tuned| AveragedWheels::One(tuned.wheel.clone()));
    let wheel = table.read_optional("wheel", |value| wheels(value, base))?.or_else(of_tuned);
    let wheel = wheel.unwrap_or_else(|| default_wheels(base));
    // The meshes of all wheels on a shaft are taken away from the average over its revolutions.
    let train = GearTrain::of_scenario(base)?;
    let is_averaged = |name: &str| wheel.all().iter().any(|wheel| wheel == name);
    let averaged = train.wheels.iter().filter(|wheel| is_averaged(&wheel.name));
    let fewest = averaged.flat_map(|wheel| train.teeth_on(wheel.shaft)).min();
    let teeth = u64::from(fewest.unwrap_or(1));
    let analysed = table.read_optional("analysed", |value| read_channel(value, &known.accelerations))?;
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
        channels: channels.unwrap_or(known.usual),
        wheel,
        analysed: analysed.unwrap_or_else(|| tuned.map_or(known.leading, |tuned| tuned.channel.clone())),
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

/// One wheel, or a list of several.
fn wheels(value: &TomlValue<'_>, base: &Scenario) -> ReadResult<AveragedWheels> {
    let choices: Vec<(&str, String)> =
        base.wheel_names().into_iter().map(|wheel| (wheel, wheel.to_owned())).collect();
    if !value.is_array() {
        return value.choice(&choices).map(AveragedWheels::One);
    }
    let chosen = distinct(value, "is named twice", |value| value.choice(&choices))?;
    if chosen.is_empty() {
        return Err(value.error("is empty; must name a wheel or several"));
    }
    Ok(AveragedWheels::Each(chosen))
}

/// The gear of a pair; all wheels of a gearbox.
fn default_wheels(base: &Scenario) -> AveragedWheels {
    match base.rig() {
        Some(_) => AveragedWheels::One(WheelName::default().into()),
        None => AveragedWheels::Each(base.wheel_names().into_iter().map(str::to_owned).collect()),
    }
}

/// The channels of the simulations of a base scenario.
struct Known {
    /// All that can be kept.
    channels: Vec<Channel>,
    /// All that can be averaged.
    accelerations: Vec<Channel>,
    /// What is kept by default: the listed sensors, of a pair without one the horizontal and the vertical acceleration, and of a gearbox
    /// without one the vertical accelerations of the bearings' seats.
    usual: Vec<Channel>,
    /// What is averaged by default.
    leading: Channel,
}

impl Known {
    fn of(base: &Scenario) -> Self {
        let sensors = base.all_sensors();
        let of_sensors: Vec<Channel> = sensors.iter().map(|sensor| Channel::Sensor(sensor.name())).collect();
        let channels = match base.rig() {
            Some(_) => Channel::all(&sensors),
            None => of_sensors.clone(),
        };
        let usual = match base.rig() {
            Some(_) if sensors.is_empty() => {
                [ChannelKind::Horizontal, ChannelKind::Vertical].map(Channel::from).into()
            }
            _ => of_sensors,
        };
        Self { channels, accelerations: accelerations(base), usual, leading: Channel::leading(&sensors) }
    }
}

/// An enhancement is only what it is for the signals that it was tuned to.
fn agree(table: &TomlTable<'_>, keep: &Keep, tuned: Option<&Tuned>) -> ReadResult<()> {
    let Some(tuned) = tuned else { return Ok(()) };
    for (key, same) in [
        ("sampling_rate_hz", keep.sampling_rate_hz == tuned.sampling_rate_hz),
        ("analysed", keep.analysed == tuned.channel),
        ("wheel", keep.wheel == AveragedWheels::One(tuned.wheel.clone())),
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
