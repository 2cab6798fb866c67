//! Keys that both wheels have: `pinion_x` and `gear_x`.

use meshtone::scenario::KeyDescription;

/// Every key, that of the pinion with that of the gear where nothing but name and default distinguishes them; the gear's then has
/// no place of its own.
pub fn of_both_wheels(keys: &[KeyDescription]) -> Vec<(&KeyDescription, Option<&KeyDescription>)> {
    let mate = |key: &KeyDescription, of: &str, mates: &str| {
        let name = format!("{mates}{}", key.key.strip_prefix(of)?);
        keys.iter().find(|other| other.key == name && are_alike(key, other))
    };
    let alone = |key: &&KeyDescription| mate(key, "gear_", "pinion_").is_none();
    keys.iter().filter(alone).map(|key| (key, mate(key, "pinion_", "gear_"))).collect()
}

fn are_alike(one: &KeyDescription, other: &KeyDescription) -> bool {
    let all_but_default = |key: &KeyDescription| {
        (key.unit, key.meaning, key.required, key.allowed.clone(), key.kind.clone(), key.ignored_by.clone())
    };
    all_but_default(one) == all_but_default(other)
}
