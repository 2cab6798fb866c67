//! The main numbers of a run, for reading.

use meshtone_io::summary::{
    ChannelSummary, HelixSummary, MachineSummary, MeshForce, MeshStiffness, MeshSummary, SetSummary, Summary,
};

/// Natural frequencies that are printed.
const FREQUENCIES: usize = 17;

/// The table of one run: a few rows for the whole, then some for each mesh, then the signals.
pub fn table(summary: &Summary) -> String {
    let row = |(name, value): (String, String)| format!("  {name:<24}{value}\n");
    let whole = of_whole(summary).into_iter().map(|(name, value)| row((name.to_owned(), value)));
    let meshes = summary.machine.meshes.iter().flat_map(|mesh| {
        let rows = of_mesh(mesh).into_iter().map(row);
        std::iter::once("\n".to_owned()).chain(rows).collect::<Vec<_>>()
    });
    let heads = format!("\n  {:<28}{:>12}{:>12}{:>12}\n", "signal", "rms", "peak", "kurtosis");
    let signals = summary.channels.iter().map(|channel| {
        let ChannelSummary { name, rms, peak, kurtosis, .. } = channel;
        let (rms, peak) = (short(*rms), short(*peak));
        let kurtosis = kurtosis.map_or_else(|| "-".to_string(), short);
        format!("  {name:<28}{rms:>12}{peak:>12}{kurtosis:>12}\n")
    });
    let sets =
        summary.machine.planetary.iter().map(|set| row((format!("orders of {}", set.name), orders(set))));
    whole.chain(sets).chain(meshes).chain([heads]).chain(signals).collect()
}

/// The rows of the whole machine.
fn of_whole(summary: &Summary) -> [(&'static str, String); 7] {
    let Summary { machine, samples, sampling_rate_hz, .. } = summary;
    let MachineSummary { model, seed, shafts, natural_frequencies_hz: frequencies, .. } = machine;
    let duration_s = *samples as f64 / sampling_rate_hz;
    let rate = short(*sampling_rate_hz);
    let shown: Vec<_> = frequencies.iter().take(FREQUENCIES).map(|f| frequency(*f)).collect();
    let more = if frequencies.len() > FREQUENCIES { " …" } else { "" };
    let shafts = shafts.iter().map(|shaft| format!("{} {}", shaft.name, short(shaft.speed_hz)));
    [
        ("model", format!("{model}, seed {seed}")),
        ("fault", faults(machine)),
        ("sampling", format!("{samples} samples, {duration_s:.3} s at {rate} S/s")),
        ("shaft speeds, rev/s", shafts.collect::<Vec<_>>().join(", ")),
        ("hunting-tooth period", format!("{} revolutions of the input", machine.cycle_input_revolutions)),
        ("natural frequencies, Hz", shown.join(" ") + more),
        ("computing time", format!("{} ms", short(summary.total_time().as_secs_f64() * 1e3))),
    ]
}

/// At which orders the events of a planetary set repeat.
fn orders(set: &SetSummary) -> String {
    let of = set.orders_of_carrier_against_ring;
    let [mesh, planets, sun, planet, ring] =
        [of.mesh, of.planet_passage, of.sun_tooth, of.planet_tooth, of.ring_tooth].map(short);
    format!(
        "mesh {mesh}, planets pass {planets}; a tooth of the sun {sun}, of a planet {planet}, of the ring {ring} (per revolution of the carrier against the ring)"
    )
}

/// The rows of a mesh.
fn of_mesh(mesh: &MeshSummary) -> Vec<(String, String)> {
    let (stiffness, force) = (&mesh.mesh_stiffness, &mesh.mesh_force);
    let uneven = mesh.face_load_factor.filter(|factor| *factor > 1.0);
    let uneven = uneven.map_or_else(String::new, |factor| format!("; face load factor {factor:.2}"));
    let ratio = contact_ratio(mesh.contact_ratio, mesh.helix) + &uneven;
    let frequency = format!("{} Hz, contact ratio {ratio}", short(mesh.mesh_frequency_hz));
    let mut rows = vec![
        (format!("mesh {}", mesh.wheels.join("-")), frequency),
        ("mesh stiffness, N/µm".to_owned(), range(per_um(stiffness))),
        ("mesh force, N".to_owned(), range([force.min_n, force.mean_n, force.max_n]) + &touching(force)),
    ];
    rows.extend(
        mesh.transmission_error_um
            .map(|error| ("transmission error, µm".to_owned(), range([error.min, error.mean, error.max]))),
    );
    let efficiency = mesh.efficiency.map(|part| format!("{:.2} %", 100.0 * part));
    rows.extend(efficiency.map(|percent| ("efficiency".to_owned(), percent)));
    rows
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

/// `root-crack (severity 0.400) on tooth 1 of gear`, one after the other, and the spalls of bearings.
fn faults(machine: &MachineSummary) -> String {
    let faults = machine.faults.iter().map(|fault| {
        let (kind, severity, wheel) = (fault.kind, fault.severity, &fault.wheel);
        format!("{kind} (severity {severity:.3}) on {} of {wheel}", fault.tooth.in_words())
    });
    let spalls = machine.bearings.iter().flat_map(|bearing| {
        bearing.defects.iter().map(|of| {
            let (width, race, severity) = (short(of.width_mm), of.place.name(), of.severity);
            format!("spall of {width} mm ({race}, severity {severity:.3}) on bearing {}", bearing.at)
        })
    });
    let all: Vec<_> = faults.chain(spalls).collect();
    if all.is_empty() { "none".to_owned() } else { all.join(", ") }
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
