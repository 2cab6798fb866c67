//! The right name for a misspelt one.

/// Similarity below which two names are rather different words than one word misspelt.
const LEAST_SIMILARITY: f64 = 0.7;

/// (bytes) Length from which a text is no name misspelt: comparing takes time by the product of the lengths.
const LONGEST_NAME: usize = 100;

/// The candidate that a misspelt name most probably means, if any is near.
///
/// # Arguments
/// * `written` - the name that is not among the candidates
/// * `candidates` - the names that exist
///
/// ```
/// use meshtone_toml::nearest_name;
///
/// assert_eq!(nearest_name("modul", ["module_mm", "pinion_teeth"]), Some("module_mm"));
/// assert_eq!(nearest_name("colour", ["module_mm", "pinion_teeth"]), None);
/// ```
pub fn nearest_name<'n>(written: &str, candidates: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let candidates = candidates.into_iter().take_while(|_| written.len() < LONGEST_NAME);
    candidates
        .map(|candidate| (similarity(written, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= LEAST_SIMILARITY)
        .max_by(|(left, _), (right, _)| left.total_cmp(right))
        .map(|(_, candidate)| candidate)
}

/// Returns whether one of the two names is surely the other one misspelt: one or two letters differ, or the unit at its end does.
pub(crate) fn is_misspelling(written: &str, name: &str) -> bool {
    name.len() >= 4
        && written.len() < LONGEST_NAME
        && (differs_by_two(written, name) || has_another_unit(written, name))
}

/// Returns whether one or two letters differ. Names of other lengths need no comparison.
fn differs_by_two(written: &str, name: &str) -> bool {
    let [letters, own] = [written, name].map(|name| name.chars().count());
    letters.abs_diff(own) <= 2 && strsim::osa_distance(written, name) <= 2
}

/// Returns whether the two names are of the same quantity in two units, which stand behind the last underscore: `speed_rpm` and
/// `speed_hz`, not `gear_teeth` and `gear_width`.
pub(crate) fn has_another_unit(written: &str, name: &str) -> bool {
    const LONGEST_UNIT: usize = 3;
    let both = written.rsplit_once('_').zip(name.rsplit_once('_'));
    both.is_some_and(|((written, unit), (quantity, own))| {
        written == quantity && unit != own && unit.len().max(own.len()) <= LONGEST_UNIT
    })
}

/// Returns whether a name is of revolutions per minute and the other of the same per second: `rpm`, `speed_rpm` or `pinion_rpm` for
/// `pinion_speed_hz`, not `gear_speed_rpm`.
pub(crate) fn is_rpm_of(written: &str, name: &str) -> bool {
    let (Some(written), Some(quantity)) = (written.strip_suffix("rpm"), name.strip_suffix("_hz")) else {
        return false;
    };
    let written = written.trim_end_matches('_');
    let [quantity, words] = [quantity, written].map(|name| name.split('_').collect::<Vec<_>>());
    quantity.starts_with(&words) || quantity.ends_with(&words) || written.is_empty()
}

fn similarity(written: &str, candidate: &str) -> f64 {
    // A forgotten unit suffix or prefix is the likeliest mistake, and weighs heavily by letters.
    let contained = written.len() >= 4 && (candidate.contains(written) || written.contains(candidate));
    let by_letters = strsim::normalized_damerau_levenshtein(written, candidate);
    let by_start = strsim::jaro_winkler(written, candidate);
    let bonus = if contained { 0.5 } else { 0.0 };
    by_letters.max(by_start * 0.9) + bonus
}
