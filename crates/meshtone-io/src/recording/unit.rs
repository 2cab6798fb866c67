//! Units, where they matter: whether a word in parentheses is one, time and voltage.

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

/// (V) One unit of voltage, if the unit is one of voltage.
pub(super) fn volts_in(unit: &str) -> Option<f64> {
    match unit.trim() {
        "V" | "v" | "volt" | "Volt" | "volts" | "Volts" => Some(1.0),
        "mV" => Some(1e-3),
        "uV" | "µV" | "μV" => Some(1e-6),
        "kV" => Some(1e3),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::is_unit;

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
