//! Units, where they matter: whether a word in parentheses is one, time, and which ones convert into each other.

/// Symbols that measurements come in. What follows a prefix is in [`PREFIXED`].
const PLAIN: [&str; 34] = [
    "%", "°", "°C", "°F", "deg", "degC", "rad", "rev", "rpm", "RPM", "U/min", "1/min", "min", "h", "dB",
    "bar", "mbar", "psi", "in", "ips", "ft", "lb", "lbf", "kgf", "count", "counts", "EU", "G", "gn", "g_n",
    "sec", "mil", "Nm", "kNm",
];
/// Symbols that may have a prefix.
const PREFIXED: [&str; 15] = ["m", "s", "g", "V", "A", "N", "Hz", "Pa", "W", "J", "K", "C", "Ohm", "Ω", "S"];
const PREFIXES: [&str; 10] = ["", "n", "µ", "μ", "u", "m", "c", "d", "k", "M"];

/// Whether a text is a unit, such as `m/s²` or `mV`, rather than a remark.
pub(super) fn is_unit(text: &str) -> bool {
    let text = text.trim();
    let is_symbol = |symbol: &str| {
        let symbol = symbol.trim_end_matches(|c: char| c.is_ascii_digit() || "²³⁻¹^-".contains(c));
        let prefixed =
            |base: &&str| symbol.strip_suffix(base).is_some_and(|prefix| PREFIXES.contains(&prefix));
        symbol.is_empty() || PLAIN.contains(&symbol) || PREFIXED.iter().any(prefixed)
    };
    let worth_reading = !text.is_empty() && text.chars().any(|c| c.is_alphabetic() || "%°".contains(c));
    worth_reading && (PLAIN.contains(&text) || text.split(['/', '*', '·', '.', ' ', '(', ')']).all(is_symbol))
}

/// (s) One unit of time, if the unit is one of time.
pub(super) fn seconds_in(unit: &str) -> Option<f64> {
    match unit.trim() {
        "s" | "S" | "sec" | "secs" | "Sec" | "second" | "seconds" | "Sekunden" => Some(1.0),
        "ms" | "msec" | "milliseconds" => Some(1e-3),
        "us" | "µs" | "μs" | "usec" | "microseconds" => Some(1e-6),
        "ns" | "nsec" | "nanoseconds" => Some(1e-9),
        "min" | "minutes" => Some(60.0),
        "h" | "hours" => Some(3600.0),
        _ => None,
    }
}

/// (m/s²) One g.
const STANDARD_GRAVITY: f64 = 9.80665;
/// Units that convert into each other, with the size of each: of acceleration, velocity, displacement, voltage, frequency, torque.
const CONVERTED: [&[(&str, f64)]; 6] = [
    &[
        ("g", STANDARD_GRAVITY),
        ("mg", 1e-3 * STANDARD_GRAVITY),
        ("m/s2", 1.0),
        ("mm/s2", 1e-3),
        ("in/s2", 0.0254),
        ("ft/s2", 0.3048),
    ],
    &[("m/s", 1.0), ("mm/s", 1e-3), ("µm/s", 1e-6), ("in/s", 0.0254)],
    &[("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("in", 0.0254), ("mil", 2.54e-5)],
    &[("V", 1.0), ("mV", 1e-3), ("µV", 1e-6), ("kV", 1e3)],
    &[("Hz", 1.0), ("rpm", 1.0 / 60.0)],
    &[("Nm", 1.0), ("kNm", 1e3), ("mNm", 1e-3)],
];

/// Number by which samples in one unit are multiplied to be in another; none where the two do not convert into each other.
///
/// # Arguments
/// * `from`, `to` - such as `m/s²` and `g`
pub(super) fn conversion(from: &str, to: &str) -> Option<f64> {
    let [from, to] = [from, to].map(plain);
    if from == to {
        return Some(1.0);
    }
    CONVERTED.iter().find_map(|units| {
        let size = |unit: &str| units.iter().find(|(name, _)| *name == unit).map(|(_, size)| size);
        Some(size(&from)? / size(&to)?)
    })
}

/// A unit in one of its spellings.
fn plain(unit: &str) -> String {
    let unit: String = unit.trim().chars().filter(|c| !" ^*·".contains(*c)).collect();
    let unit = unit
        .replace('²', "2")
        .replace('μ', "µ")
        .replace("sec", "s")
        .replace("m/s/s", "m/s2")
        .replace("ms-2", "m/s2");
    match unit.as_str() {
        "gn" | "g_n" | "G" | "gs" | "grms" => "g".to_owned(),
        "ips" => "in/s".to_owned(),
        "um" => "µm".to_owned(),
        "um/s" => "µm/s".to_owned(),
        "uV" => "µV".to_owned(),
        "v" | "volt" | "Volt" | "volts" | "Volts" => "V".to_owned(),
        "RPM" | "1/min" | "U/min" | "r/min" => "rpm".to_owned(),
        "N.m" => "Nm".to_owned(),
        _ => unit,
    }
}

#[cfg(test)]
mod tests {
    use super::{conversion, is_unit};

    #[test]
    fn units_convert_where_they_measure_the_same() {
        for (from, to, factor) in [
            ("m/s^2", "g", 1.0 / 9.80665),
            ("m/s²", "m/s2", 1.0),
            ("m s-2", "m/s²", 1.0),
            ("g", "m/s^2", 9.80665),
            ("mV", "V", 1e-3),
            ("G", "g", 1.0),
            ("ips", "mm/s", 25.4),
            ("EU", "EU", 1.0),
        ] {
            let found = conversion(from, to).unwrap_or(f64::NAN);
            assert!((found / factor - 1.0).abs() < 1e-12, "{from} {to}: {found}");
        }
        for (from, to) in [("m/s^2", "V"), ("mV", "g"), ("EU", "g"), ("m/s", "m/s2")] {
            assert_eq!(conversion(from, to), None, "{from} {to}");
        }
    }

    #[test]
    fn units_are_distinguished_from_remarks() {
        for unit in
            ["g", "m/s²", "m/s^2", "mV", "V", "°", "rpm", "N·m", "Nm", "kHz", "%", "µm", "s", "1/s", "m s-2"]
        {
            assert!(is_unit(unit), "{unit}");
        }
        for remark in ["horizontal", "bearing 2", "", "raw", "-", "x", "A-side", "sensor", "1", "2"] {
            assert!(!is_unit(remark), "{remark}");
        }
    }
}
