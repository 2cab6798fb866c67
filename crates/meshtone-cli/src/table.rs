//! The main numbers of a run, for reading.

use meshtone_io::summary::{
    ChannelSummary, FaultSummary, GearboxSummary, HelixSummary, MeshForce, MeshStiffness, Summary,
    SummaryEnd, SummaryHead,
};

/// The table of one run.
pub fn table(summary: &Summary) -> String {
    let rows = rows(summary).into_iter().map(|(name, value)| format!("  {name:<24}{value}\n"));
    rows.chain(signals(&summary.channels, label)).collect()
}

/// The main numbers of each signal, below their heads.
fn signals(
    channels: &[ChannelSummary],
    label: fn(&ChannelSummary) -> String,
) -> impl Iterator<Item = String> {
    let heads = format!("\n  {:<28}{:>12}{:>12}{:>12}\n", "signal", "rms", "peak", "kurtosis");
    let channels = channels.iter().map(move |channel| {
        let kurtosis = channel.kurtosis.map_or_else(|| "-".to_string(), short);
        let (rms, peak) = (short(channel.rms), short(channel.peak));
        format!("  {:<28}{rms:>12}{peak:>12}{kurtosis:>12}\n", label(channel))
    });
    std::iter::once(heads).chain(channels)
}

/// The table of a gearbox's run: a few rows for the whole, then some for each mesh.
pub fn gearbox_table(summary: &GearboxSummary) -> String {
    let frequencies: Vec<_> = summary.natural_frequencies_hz.iter().take(12).map(|f| frequency(*f)).collect();
    let shafts = summary.shafts.iter().map(|shaft| format!("{} {}", shaft.name, short(shaft.speed_hz)));
    let faults = summary.faults.iter().map(|fault| {
        format!(
            "{} (severity {:.3}) on {} of {}",
            fault.kind,
            fault.severity,
            fault.tooth.in_words(),
            fault.wheel
        )
    });
    let spalls = summary.bearings.iter().flat_map(|bearing| {
        bearing.defects.iter().map(|of| {
            format!(
                "spall of {} mm ({}, severity {:.3}) on bearing {}",
                short(of.width_mm),
                of.race,
                of.severity,
                bearing.at
            )
        })
    });
    let faults: Vec<_> = faults.chain(spalls).collect();
    let [model, sampling, time] = common_rows(&summary.head, &summary.end);
    let whole = [
        model,
        ("fault", if faults.is_empty() { "none".to_owned() } else { faults.join(", ") }),
        sampling,
        ("shaft speeds, rev/s", shafts.collect::<Vec<_>>().join(", ")),
        ("repeats after", format!("{} revolutions of the input", summary.cycle_input_revolutions)),
        ("natural frequencies, Hz", format!("{} …", frequencies.join(" "))),
        time,
    ];
    let of_meshes = summary.meshes.iter().flat_map(|mesh| {
        let (stiffness, force, error) = (&mesh.mesh_stiffness, &mesh.mesh_force, &mesh.transmission_error_um);
        [
            (String::new(), String::new()),
            (
                format!("mesh {}", mesh.wheels.join("-")),
                format!(
                    "{} Hz, contact ratio {}",
                    short(mesh.mesh_frequency_hz),
                    contact_ratio(mesh.contact_ratio, mesh.helix)
                ),
            ),
            ("mesh stiffness, N/µm".to_owned(), range(per_um(stiffness))),
            ("mesh force, N".to_owned(), range([force.min_n, force.mean_n, force.max_n]) + &touching(force)),
            ("transmission error, µm".to_owned(), range([error.min, error.mean, error.max])),
        ]
    });
    let rows = whole.into_iter().map(|(name, value)| (name.to_owned(), value)).chain(of_meshes);
    let rows =
        rows.map(|(name, value)| format!("  {name:<24}{value}\n").replace(&format!("{:26}\n", ""), "\n"));
    let named = |channel: &ChannelSummary| channel.name.clone();
    rows.chain(signals(&summary.channels, named)).collect()
}

/// `1.5`, of helical wheels with their overlap and the force along the shafts.
fn contact_ratio(transverse: f64, helix: Option<HelixSummary>) -> String {
    helix.map_or_else(
        || format!("{transverse:.4}"),
        |helix| {
            let HelixSummary { overlap_ratio, total_contact_ratio, axial_force_n, .. } = helix;
            format!(
                "{transverse:.4}, overlap {overlap_ratio:.4}, total {total_contact_ratio:.4}, axial force {} N",
                short(axial_force_n.abs())
            )
        },
    )
}

/// (N/µm) Least, mean and largest stiffness.
fn per_um(stiffness: &MeshStiffness) -> [f64; 3] {
    [stiffness.min_n_per_mm, stiffness.mean_n_per_mm, stiffness.max_n_per_mm].map(|of_mm| 1e-3 * of_mm)
}

/// `min 1, mean 2, max 3`.
fn range(values: [f64; 3]) -> String {
    let [min, mean, max] = values.map(short);
    format!("min {min}, mean {mean}, max {max}")
}

fn rows(summary: &Summary) -> [(&'static str, String); 8] {
    let (stiffness, force) = (&summary.mesh_stiffness, &summary.mesh_force);
    let frequencies: Vec<_> = summary.natural_frequencies_hz.iter().map(|f| frequency(*f)).collect();
    let [model, sampling, time] = common_rows(&summary.head, &summary.end);
    let stiffness = range(per_um(stiffness));
    let forces = range([force.min_n, force.mean_n, force.max_n]);
    [
        model,
        ("fault", faults(&summary.faults)),
        sampling,
        ("contact ratio", contact_ratio(summary.contact_ratio, summary.helix) + &along_the_face(summary)),
        ("mesh stiffness, N/µm", stiffness),
        ("mesh force, N", forces + &touching(force)),
        ("natural frequencies, Hz", frequencies.join(" ")),
        time,
    ]
}

/// Model, sampling and computing time, which every run has.
fn common_rows(head: &SummaryHead, end: &SummaryEnd) -> [(&'static str, String); 3] {
    let SummaryHead { model, seed, samples, sampling_rate_hz, .. } = head;
    let duration_s = *samples as f64 / sampling_rate_hz;
    let rate = short(*sampling_rate_hz);
    [
        ("model", format!("{model}, seed {seed}")),
        ("sampling", format!("{samples} samples, {duration_s:.3} s at {rate} S/s")),
        ("computing time", format!("{} ms", short(end.total_time().as_secs_f64() * 1e3))),
    ]
}

/// By how much the load is uneven along the face, where it is.
fn along_the_face(summary: &Summary) -> String {
    let uneven = summary.face_load_factor.filter(|factor| *factor > 1.0);
    uneven.map_or_else(String::new, |factor| format!("; face load factor {factor:.2}"))
}

/// For how long the mesh pulls, or its teeth do not touch or touch with their backs.
fn touching(force: &MeshForce) -> String {
    let percent = |fraction: f64| format!("{:.1} %", 100.0 * fraction);
    let Some(contact) = &force.contact else {
        let tension =
            force.tension_fraction.map(|part| format!("; in tension {} of the time", percent(part)));
        return tension.unwrap_or_default();
    };
    let hits = match contact.back_flank_hits {
        0 => "no coast flank hits".to_string(),
        1 => format!("1 hit of coast flanks, {} of the time", percent(contact.back_flank_fraction)),
        hits => format!("{hits} hits of coast flanks, {} of the time", percent(contact.back_flank_fraction)),
    };
    format!("; contact loss {} of the time, {hits}", percent(contact.apart_fraction))
}

/// `root-crack (severity 0.400) on tooth 1 of the gear`, one after the other.
fn faults(faults: &[FaultSummary]) -> String {
    let place = |fault: &FaultSummary| {
        let FaultSummary { kind, wheel, tooth, severity, .. } = fault;
        format!("{kind} (severity {severity:.3}) on {} of the {wheel}", tooth.in_words())
    };
    match faults {
        [] => "none".to_string(),
        faults => faults.iter().map(place).collect::<Vec<_>>().join(", "),
    }
}

/// `pinion shaft speed, Hz` for `pinion_shaft_speed_hz`.
fn label(channel: &ChannelSummary) -> String {
    let quantity = channel.name.rsplit_once('_').map_or(channel.name.as_str(), |(quantity, _)| quantity);
    format!("{}, {}", quantity.replace('_', " "), channel.unit)
}

/// To the hertz, where that is not too long to read.
fn frequency(value_hz: f64) -> String {
    if value_hz.abs() < 1e6 { format!("{value_hz:.0}") } else { short(value_hz) }
}

/// Four significant digits.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    format!("{value:.*}", usize::try_from(3 - magnitude).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::{frequency, short};

    #[test]
    fn four_digits() {
        let shown = [0.0, 187.0042, -1.60909, 258_400.0, 0.001_234_56, 1e-9, 2.5e12, f64::NAN].map(short);
        assert_eq!(shown, ["0", "187.0", "-1.609", "258400", "0.001235", "1.000e-9", "2.500e12", "NaN"]);
    }

    #[test]
    fn large_frequencies_are_short() {
        let shown = [0.4, 187.4, 999_999.4, 1e6, 123_456_789.0].map(frequency);
        assert_eq!(shown, ["0", "187", "999999", "1.000e6", "1.235e8"]);
    }
}
