//! The reader of TOML files: types, missing and unknown keys, lines.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use meshtone_toml::{ErrorKind, TomlDocument, TomlError, TomlTable, TomlValue};

fn value_error<T>(text: &str, read: impl FnOnce(TomlValue<'_>) -> Result<T, TomlError>) -> Option<TomlError> {
    let document = TomlDocument::parse(text).unwrap();
    document.root().read(|root| read(root.required("k", "a value")?)).err()
}

#[track_caller]
fn assert_error(error: Option<TomlError>, key: &str, line: usize, value: &str, words: &str) {
    let error = error.expect("must be refused");
    assert_eq!((error.key.as_str(), error.line, error.value.as_str()), (key, Some(line), value), "{error}");
    assert!(error.problem.contains(words), "{error}");
}

#[test]
fn integers_are_numbers_in_every_notation() {
    for (text, expected) in
        [("k = 3", 3.0), ("k = 0x1f", 31.0), ("k = 1_000", 1000.0), ("k = -2.5e-3", -2.5e-3)]
    {
        let document = TomlDocument::parse(text).unwrap();
        assert_eq!(document.root().read(|root| root.number("k")).unwrap(), Some(expected), "{text}");
    }
}

#[test]
fn numbers_must_be_finite_numbers() {
    assert_error(value_error("k = nan", |value| value.number()), "k", 1, "nan", "finite");
    assert_error(value_error("\nk = -inf", |value| value.number()), "k", 2, "-inf", "finite");
    assert_error(value_error("k = 1e999", |value| value.number()), "k", 1, "1e999", "");
    assert_error(
        value_error("k = \"3\"", |value| value.number()),
        "k",
        1,
        "\"3\"",
        "must be a number, not text",
    );
    assert_error(value_error("k = true", |value| value.number()), "k", 1, "true", "must be a number");
}

#[test]
fn integers_must_be_whole_and_in_range() {
    let integer = |value: TomlValue<'_>| value.integer(1..=5);
    assert_error(value_error("k = 3.0", integer), "k", 1, "3.0", "whole number");
    assert_error(value_error("k = 6", integer), "k", 1, "6", "from 1 to 5");
    assert_error(value_error("k = -1", integer), "k", 1, "-1", "from 1 to 5");
    let document = TomlDocument::parse("k = 18446744073709551615").unwrap();
    let largest = document.root().read(|root| root.required("k", "")?.integer(0..=u64::MAX)).unwrap();
    assert_eq!(largest, u64::MAX);
}

#[test]
fn choices_suggest_the_nearest() {
    let choice = |value: TomlValue<'_>| value.choice(&[("parabolic", 1), ("linear", 2)]);
    let error = value_error("k = \"linaer\"", choice).unwrap();
    assert_eq!(error.help.as_deref(), Some("did you mean \"linear\"?"));
    assert_error(Some(error), "k", 1, "\"linaer\"", "one of \"parabolic\", \"linear\"");
    assert_error(value_error("k = 1", choice), "k", 1, "1", "must be one of \"parabolic\"");
    let far = value_error("k = \"cubic spline\"", choice).unwrap();
    assert_eq!(far.help, None);
}

#[test]
fn entries_of_arrays_have_their_own_key_and_line() {
    let text = "k = [\n  1.0,\n  2.0,\n  nan,\n]";
    assert_error(value_error(text, |value| value.numbers()), "k[2]", 4, "nan", "finite");
    let short = value_error(text.replace("nan", "3").as_str(), |value| value.exactly::<13>());
    assert_error(short, "k", 1, "[ …", "has 3 numbers; must have exactly 13");
    assert_error(value_error("k = 1", |value| value.numbers()), "k", 1, "1", "an array");
}

#[test]
fn other_types_are_named() {
    assert_error(
        value_error("k = 1", |value| value.boolean()),
        "k",
        1,
        "1",
        "true or false, not a whole number",
    );
    assert_error(
        value_error("k = [1]", |value| value.string().map(str::len)),
        "k",
        1,
        "[1]",
        "double quotes",
    );
    assert_error(value_error("k = 1.5", |value| value.table()?.read(|_| Ok(()))), "k", 1, "1.5", "a table");
    let date = value_error("k = 2024-01-01", |value| value.number());
    assert_error(date, "k", 1, "2024-01-01", "not a date");
}

fn read_motor(text: &str) -> Result<f64, TomlError> {
    fn motor(table: &TomlTable<'_>) -> Result<f64, TomlError> {
        let speed = table.required("speed_hz", "(rev/s) the motor's speed")?.number()?;
        Ok(speed + table.number("torque_nm")?.unwrap_or(0.5))
    }
    TomlDocument::parse(text)?.root().read(|root| root.table_or_empty("motor")?.read(motor))
}

#[test]
fn defaults_apply_where_keys_are_absent() {
    assert_eq!(read_motor("[motor]\nspeed_hz = 2").unwrap(), 2.5);
    assert_eq!(read_motor("motor.speed_hz = 2\nmotor.torque_nm = 1").unwrap(), 3.0);
}

#[test]
fn missing_keys_are_named_with_their_meaning() {
    let words = "missing, and it has no default; it is (rev/s) the motor's speed";
    assert_error(read_motor("\n[motor]\n").err(), "motor.speed_hz", 2, "", words);
    let absent = read_motor("").unwrap_err();
    assert_eq!((absent.key.as_str(), absent.line), ("motor.speed_hz", None));
}

#[test]
fn unknown_keys_are_named_with_the_nearest() {
    let error = read_motor("[motor]\nspeed_hz = 2\ntorque = 1\n").unwrap_err();
    assert_eq!(error.help.as_deref(), Some("did you mean `torque_nm`?"));
    assert_error(Some(error), "motor.torque", 3, "1", "unknown key; allowed in `motor`: speed_hz, torque_nm");
    let far = read_motor("colour = 1\n[motor]\nspeed_hz = 2\n").unwrap_err();
    assert!(far.help.as_deref().unwrap().contains("remove it"), "{far:?}");
    assert_error(Some(far), "colour", 1, "1", "allowed at the top level: motor");
}

#[test]
fn the_first_of_several_unknown_keys_is_reported() {
    let error = read_motor("[motor]\nspeed_hz = 2\nzebra = 1\nant = 1\n").unwrap_err();
    assert_eq!(error.key, "motor.zebra");
}

#[test]
fn a_misspelt_required_name_is_the_mistake_rather_than_the_missing_key() {
    let key = read_motor("[motor]\nsped_hz = 2\n").unwrap_err();
    assert_eq!(key.help.as_deref(), Some("did you mean `speed_hz`?"));
    assert_error(Some(key), "motor.sped_hz", 2, "2", "unknown key");
    let section = read_motor("[moter]\nspeed_hz = 2\n").unwrap_err();
    assert_eq!(section.help.as_deref(), Some("did you mean `motor`?"));
    assert_error(Some(section), "moter", 1, "", "unknown key");
}

#[test]
fn text_that_is_not_toml_is_refused_with_its_line() {
    let error = TomlDocument::parse("a = 1\nb = = 2\n").unwrap_err();
    assert_eq!(error.line, Some(2));
    assert!(error.to_string().starts_with("line 2: b = = 2: not valid TOML: "), "{error}");
    let twice = TomlDocument::parse("a = 1\na = 2\n").unwrap_err();
    assert_eq!(twice.line, Some(2));
    assert!(twice.problem.contains("duplicate key"), "{twice}");
    let open = TomlDocument::parse("a = [1,\n2\n").unwrap_err();
    assert!(open.line.is_some(), "{open:?}");
}

#[test]
fn keys_are_found_inside_tables_and_arrays() {
    let text = "seed = 1\n[a]\nb = { c = 1 }\nd = [\n1,\n2,\n]\ne.f = 3\n";
    let document = TomlDocument::parse(text).unwrap();
    for (key, line) in [
        ("seed", Some(1)),
        ("a", Some(2)),
        ("a.b.c", Some(3)),
        ("a.d", Some(4)),
        ("a.d[1]", Some(6)),
        ("a.d[7]", Some(4)),
        ("a.e.f", Some(8)),
        ("a.absent", Some(2)),
        ("absent", None),
        ("absent.too", None),
    ] {
        assert_eq!(document.line_of_key(key), line, "{key}");
    }
    assert_eq!(document.value_as_written("a.d[1]").as_deref(), Some("2"));
    assert_eq!(document.value_as_written("a.b").as_deref(), Some("{ c = 1 }"));
    assert_eq!(document.value_as_written("a"), None);
    assert_eq!(document.value_as_written("a.absent"), None);
}

#[test]
fn how_a_table_becomes_a_list_is_stated() {
    let error = TomlDocument::parse("[fault]\ntooth = 1\n[[fault]]\ntooth = 2\n").map(drop).unwrap_err();
    assert_eq!(error.line, Some(3));
    assert!(error.help.unwrap().contains("double brackets"));
}

#[test]
fn usual_mistakes_are_answered_with_what_to_write() {
    let help = |text: &str| TomlDocument::parse(text).map(drop).unwrap_err().help.unwrap();
    assert!(help("[fault]\ntooth = 1\n[fault]\ntooth = 2\n").contains("[[fault]] in double brackets"));
    assert_eq!(help("module_mm = 5,0  # of both\n"), "write a decimal point: module_mm = 5.0");
    assert_eq!(help("a = 1\na = 2\n"), "write `a` once");
    assert!(help("a = 5,\n").contains("key = value"));

    let flat = read_motor("# a motor\nspeed_hz = 2\n").unwrap_err();
    assert!(flat.help.as_deref().unwrap().contains("write [motor] on a line above it"), "{flat:?}");
    assert_error(Some(flat), "speed_hz", 2, "2", "stands outside of its section, `[motor]`");
    let above = read_motor("speed_hz = 2\n[motor]\ntorque_nm = 1\n").unwrap_err();
    assert_eq!((above.key.as_str(), above.line), ("speed_hz", Some(1)));

    for key in ["speed_rpm", "rpm"] {
        let rpm = read_motor(&format!("[motor]\n{key} = 1_200\n")).unwrap_err();
        assert!(rpm.help.as_deref().unwrap().contains("Write `speed_hz = 20`"), "{rpm:?}");
    }
    let mates = read_motor("[motor]\ngear_speed_rpm = 1200\n").unwrap_err();
    assert_eq!((mates.kind, mates.key.as_str()), (ErrorKind::MissingKey, "motor.speed_hz"));
}

#[test]
fn keys_that_will_be_asked_for_are_known() {
    let document = TomlDocument::parse("law = \"a\"\nlife = 1\nlater = 2\n").unwrap();
    let root = document.root();
    assert!(root.optional("law").is_some());
    let unknown = root.refuse_unknown(&["later", "life_rev"]).unwrap_err();
    assert_eq!(unknown.help.as_deref(), Some("did you mean `life_rev`?"));
    assert_error(
        Some(unknown),
        "life",
        2,
        "1",
        "unknown key; allowed at the top level: law, later, life_rev",
    );
}

#[test]
fn errors_are_distinguished_by_their_kind() {
    let kind = |text: &str| {
        let speed = |root: &TomlTable<'_>| root.required("speed_hz", "(rev/s) speed")?.number();
        TomlDocument::parse(text).and_then(|document| document.root().read(speed)).unwrap_err().kind
    };
    assert_eq!(kind("speed_hz = "), ErrorKind::NotToml);
    assert_eq!(kind(""), ErrorKind::MissingKey);
    assert_eq!(kind("speed_hz = 1\nsped = 2"), ErrorKind::UnknownKey);
    assert_eq!(kind("spede_hz = 1"), ErrorKind::UnknownKey);
    assert_eq!(kind("speed_hz = true"), ErrorKind::WrongType);
    assert_eq!(kind("speed_hz = inf"), ErrorKind::NotAllowed);
}

#[test]
fn a_key_that_says_not_whose_it_is_means_any_of_them() {
    let document = TomlDocument::parse("[gears]\naddendum = 1.1\nmodul = 3\n").unwrap();
    let read = |gears: &TomlTable<'_>| -> Result<(), TomlError> {
        for key in ["module_mm", "pinion_addendum", "gear_addendum", "pinion_dedendum"] {
            gears.optional(key);
        }
        Ok(())
    };
    let error = document.root().read(|root| root.table_or_empty("gears")?.read(read)).unwrap_err();
    assert_eq!(error.key, "gears.addendum");
    assert_eq!(error.help.as_deref(), Some("did you mean `pinion_addendum` or `gear_addendum`?"));
}

/// What a text of two megabytes may hold: each took seconds, by the square of its length.
#[test]
fn long_texts_are_refused_at_once() {
    let many = "[[motor]]\nname = 1\n".repeat(100_000);
    let document = TomlDocument::parse(&many).unwrap();
    let error = document.root().tables("motor").unwrap_err();
    assert_eq!(error.problem, "has 100000 entries; must have 1000 at most");
    assert_eq!(meshtone_toml::nearest_name(&"module_mm".repeat(50), ["module_mm"]), None);
}
