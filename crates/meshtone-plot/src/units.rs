//! The units that names of keys and columns end with.

/// Endings of names, and their units; the longer ones first.
const UNITS: [(&str, &str); 22] = [
    ("_kg_per_m3", "kg/m³"),
    ("_g_per_rthz", "g/√Hz"),
    ("_nm_per_rad", "N m/rad"),
    ("_n_per_m", "N/m"),
    ("_per_cm2", "1/cm²"),
    ("_per_khz", "1/kHz"),
    ("_kgm2", "kg m²"),
    ("_mpa", "MPa"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_rev", "rev"),
    ("_gpa", "GPa"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_nm", "N m"),
    ("_hz", "Hz"),
    ("_kg", "kg"),
    ("_db", "dB"),
    ("_s", "s"),
    ("_n", "N"),
    ("_g", "g"),
    ("_m", "m"),
];

/// Splits a name from the unit that its ending states; the unit is empty where it states none.
///
/// # Arguments
/// * `name` - of a key of the scenario file, or of a column
///
/// ```
/// assert_eq!(meshtone_plot::without_unit("rig.support.stiffness_n_per_m"), ("rig.support.stiffness", "N/m"));
/// assert_eq!(meshtone_plot::without_unit("pinion_teeth"), ("pinion_teeth", ""));
/// ```
pub fn without_unit(name: &str) -> (&str, &'static str) {
    let with_unit = UNITS.iter().find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, *unit)));
    with_unit.unwrap_or((name, ""))
}
