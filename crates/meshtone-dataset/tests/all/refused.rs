//! Plans that are wrong, and what is said about them.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::support::{FAST, plan, run};
use meshtone::random::{Draws, Purpose};
use meshtone_dataset::generate::Part;
use meshtone_dataset::plan::Plan;
use meshtone_dataset::shard::FailedRecord;
use meshtone_dataset::store::Destination;

/// Asserts that a plan is refused with all of `words`.
#[track_caller]
pub fn refused(text: &str, words: &[&str]) {
    let error = match Plan::read_text(text.to_owned(), Path::new("plan.toml")) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(meshtone_io::scenario_file::ReadScenarioError::Invalid { error, .. }) => {
            format!("{error} ({})", error.help.clone().unwrap_or_default())
        }
        Err(error) => error.to_string(),
    };
    for word in words {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
}

#[track_caller]
fn refused_with(from: &str, into: &str, words: &[&str]) {
    assert!(FAST.contains(from), "{from}");
    refused(&FAST.replacen(from, into, 1), words);
}

#[test]
fn empty_and_unfinished() {
    refused("", &["scenario", "missing"]);
    refused("records = \n", &["line 1", "not valid TOML"]);
    refused_with("units = 10\n", "", &["units", "missing", "pairs of wheels"]);
    refused_with("records = 60", "record = 60", &["line 3", "record", "did you mean `records`?"]);
    refused_with("units = 10", "units = 100", &["units = 100", "more than the 60 records"]);
    refused_with("units = 10", "units = 3", &["fewer than the 4 splits"]);
    let no_class = &FAST[..FAST.find("[[class]]").unwrap()];
    refused(no_class, &["class", "missing"]);
    refused(&format!("class = []\n{no_class}"), &["has no class"]);
}

/// What goes into the metadata of an exchange format, where others read it.
#[test]
fn versions_and_days() {
    for version in ["1.0", "1.0.0.0", "v1.0.0", "1..0"] {
        let message = format!("version = \"{version}\": must be three whole numbers");
        refused(&format!("version = \"{version}\"\n{FAST}"), &[&message]);
    }
    for day in ["2026-13-01", "2026-1-01", "26-01-01", "2026-01-32", "2026-01", "+026-01-01", "tomorrow"] {
        let message = format!("published = \"{day}\": must be a day, as \"2026-11-22\"");
        refused(&format!("published = \"{day}\"\n{FAST}"), &[&message]);
    }
    let about = plan(&format!("version = \"2.0.1\"\npublished = \"2026-02-28\"\n{FAST}")).about;
    assert_eq!((&*about.version, about.published.as_deref()), ("2.0.1", Some("2026-02-28")));
}

/// This is reported from the plan, rather than by records that are missing in the end.
#[test]
fn severities_beyond_the_worst_damage() {
    let cracked = "fault = { kind = \"root-crack\", severity = 0.5 }\nseverity = 4\n[[class.vary]]\n\
                   key = \"fault.severity\"\nuniform = [0.5, 1.5]";
    let text = FAST.replace("fault = { kind = \"missing-tooth\" }\nseverity = 4", cracked);
    let line = 1 + text.lines().position(|line| line == "uniform = [0.5, 1.5]").unwrap();
    let line = format!("line {line}: class[2].vary[0].uniform");
    refused(&text, &[&line, "gives fault.severity = 1.", "must be from 0 to 1", "narrow what it draws"]);
    let constrained = text.replace("seed = 3", "seed = 3\nconstraints = [\"fault.severity < 1\"]");
    assert!(Plan::read_text(constrained, Path::new("plan.toml")).unwrap().foreseen_failures().is_empty());
}

#[test]
fn contradictory() {
    let twice = "[[vary]]\nkey = \"operation.pinion_speed_hz\"\nfixed = 50\n[keep]";
    refused_with("[keep]", twice, &["vary[2].key", "varied by vary[0] too"]);
    refused_with(
        "uniform = [30.0, 60.0]",
        "uniform = [30.0, 60.0]\nfixed = 3",
        &["uniform", "given beside fixed"],
    );
    refused_with("uniform = [30.0, 60.0]", "per = \"record\"", &["does not state how it varies"]);
    refused_with("label = \"missing\"", "label = \"breakage\"", &["label \"breakage\" of another class"]);
    refused_with(
        "label = \"healthy\"",
        "label = \"healthy\"\ncount = 5",
        &["has a weight where another class has a count"],
    );
    refused_with("label = \"healthy\"", "label = \"healthy\"\nseverity = 3", &["given for a healthy class"]);
    let level = "[[vary]]\nkey = \"noise.level_g\"\nfixed = 1.0\n[keep]";
    refused_with("[keep]", level, &["noise is given both relative and in g"]);
    let seed = "[[vary]]\nkey = \"seed\"\nchoice = [1, 2]\n[keep]";
    refused_with("[keep]", seed, &["every record has a seed of its own"]);
    let by_record = "[[vary]]\nkey = \"gears.module_mm\"\nuniform = [2, 3]\nper = \"record\"\n[keep]";
    refused_with("[keep]", by_record, &["gears.module_mm", "share their wheels"]);
    let circle = "[[vary]]\nkey = \"rig.damping_ratio\"\nfixed = 1\ntimes = \"rig.eccentricity_mm\"\n\
                  [[vary]]\nkey = \"rig.eccentricity_mm\"\nfixed = 1\ntimes = \"rig.damping_ratio\"\n[keep]";
    refused_with("[keep]", circle, &["depends on itself"]);
    let mixed =
        "[[vary]]\nkey = \"rig.damping_ratio\"\nfixed = 1e-3\ntimes = \"operation.pinion_speed_hz\"\n[keep]";
    refused_with("[keep]", mixed, &["vary[2].times", "varies by record; what a unit has cannot"]);
    refused_with(
        "records_per_shard = 8",
        "channels = []\naverage = false\ndifference = false\nindicators = false",
        &["nothing is kept"],
    );
    refused_with("sampling_rate_hz = 8e3", "sampling_rate_hz = 2e4", &["more than solver.sampling_rate_hz"]);
}

#[test]
fn keys_that_are_none() {
    refused_with(
        "operation.pinion_speed_hz\"\nuniform",
        "operation.pinion_speed\"\nuniform",
        &[
            "vary[0].key",
            "`operation.pinion_speed` is no number",
            "did you mean `operation.pinion_speed_hz`?",
        ],
    );
    refused_with(
        "operation.pinion_speed_hz\"\nuniform",
        "operation.pinion_speed_rpm\"\nuniform",
        &["did you mean `operation.pinion_speed_hz`?", "a sixtieth of those per minute"],
    );
    refused_with(
        "key = \"fault.chip_height_mm\"",
        "key = \"fault.width_mm\"",
        &["tooth-breakage", "chip_width_mm"],
    );
    refused_with(
        "measure = \"fault.chip_height_mm\"",
        "measure = \"fault.chip_hight_mm\"",
        &["did you mean `fault.chip_height_mm`?"],
    );
    refused_with(
        "when = \"operation.pinion_speed_hz > 50\"",
        "when = \"speed > 50\"",
        &["split.shift[0].when", "`speed` is no number"],
    );
    refused_with(
        "when = \"operation.pinion_speed_hz > 50\"",
        "when = \"operation.pinion_speed_hz\"",
        &["<="],
    );
    refused_with(
        "when = \"operation.pinion_speed_hz > 50\"",
        "when = \"gears.module_mm > 2\"",
        &["concerns nothing that varies"],
    );
    let teeth = "[[vary]]\nkey = \"gears.gear_teeth\"\nuniform = [30, 50]\n[keep]";
    refused_with("[keep]", teeth, &["is a whole number", "choice or grid"]);
    let backlash = "[[vary]]\nkey = \"gears.backlash_mm\"\nuniform = [0.1, 0.2]\n[keep]";
    refused_with("[keep]", backlash, &["it is left out (default: ⅔", "state it in the scenario"]);
    let apart = FAST.replace(
        "points_per_tooth = 1000",
        "points_per_tooth = 1000\ntip_chamfer_mm = 0.5\ngear_tip_chamfer_mm = 0.3",
    );
    let chamfer = "[[vary]]\nkey = \"gears.tip_chamfer_mm\"\nuniform = [0.1, 0.2]\n[keep]";
    refused(
        &apart.replace("[keep]", chamfer),
        &["the wheels differ in it: vary `gears.gear_tip_chamfer_mm`"],
    );
    // A name is no number that could be stated.
    let hand = "[[vary]]\nkey = \"gears.hand\"\nuniform = [0.1, 0.2]\n[keep]";
    refused_with("[keep]", hand, &["`gears.hand` is no number of the scenario", "did you mean"]);
    // A chamfer of both wheels and one of either would decide the same number.
    let both = |key: &str| format!("[[vary]]\nkey = \"gears.{key}.length_mm\"\nuniform = [0.8, 0.9]\n");
    let twice = [both("flank_relief"), both("gear_flank_relief"), "[keep]".to_owned()].concat();
    refused_with("[keep]", &twice, &["`gears.flank_relief.length_mm` is varied by", "must be varied once"]);
    refused_with(
        "uniform = [30.0, 60.0]",
        "unifrom = [30.0, 60.0]",
        &["vary[0].unifrom", "unknown key", "did you mean `uniform`?"],
    );
    refused_with("kind = \"missing-tooth\"", "kind = \"missing\"", &["did you mean \"missing-tooth\"?"]);
    refused_with("[split]", "[splits]", &["splits", "did you mean `split`?"]);
    let another = |name: &str| {
        let shift = "[[split.shift]]\npart = 0.1\nwhen = \"operation.pinion_speed_hz > 55\"";
        format!("{}\n{shift}\nname = \"{name}\"\n", FAST.replace("\"fast\"", "\"fast-1\""))
    };
    for name in ["test", "fast-1", "fast_1"] {
        refused(&another(name), &["split.shift[1].name", "is the name of another split"]);
    }
}

#[test]
fn fractions_beyond_1() {
    refused_with("train = 0.5", "train = 0.8", &["split.test", "add up to 1.3", "must be 1"]);
    refused_with("train = 0.5", "train = 1.5", &["split.train = 1.5", "from 0 to 1"]);
    refused_with("train = 0.5", "train = 0.1", &["add up to 0.6"]);
    refused_with(
        "uniform = [1.0, 5.0]",
        "uniform = [0.5, 1.5]\nfraction_of = \"tooth.height_mm\"",
        &["fraction_of", "1.5", "from 0 to 1"],
    );
}

#[test]
fn distributions_upside_down() {
    refused_with(
        "uniform = [30.0, 60.0]",
        "uniform = [60.0, 30.0]",
        &["line", "[least, largest]", "write [30.0, 60.0]"],
    );
    refused_with("uniform = [30.0, 60.0]", "uniform = [30.0, 30.0]", &["fixed = 30.0"]);
    refused_with("uniform = [30.0, 60.0]", "log_uniform = [0.0, 60.0]", &["a logarithm needs more than 0"]);
    let normal = "normal = { mean = 40, standard_deviation = -1, least = 30, largest = 60 }";
    refused_with("uniform = [30.0, 60.0]", normal, &["standard_deviation", "more than 0"]);
    let normal = "normal = { mean = 40, standard_deviation = 1, least = 60, largest = 30 }";
    refused_with("uniform = [30.0, 60.0]", normal, &["largest", "more than least"]);
    let normal = "normal = { mean = 0, standard_deviation = 1, least = 40, largest = 60 }";
    refused_with("uniform = [30.0, 60.0]", normal, &["30 standard deviations away"]);
    refused_with(
        "uniform = [30.0, 60.0]",
        "grid = { least = 60, largest = 30, values = 3 }",
        &["more than least"],
    );
    refused_with("uniform = [30.0, 60.0]", "choice = []", &["is empty"]);
    refused_with(
        "uniform = [30.0, 60.0]",
        "choice = [30, 40]\nweights = [1]",
        &["has 1 numbers; must have 2"],
    );
    refused_with("breaks = [2.0, 4.0]", "breaks = [4.0, 2.0]", &["each larger than the one before"]);
}

#[test]
fn constraints_that_cannot_be_met() {
    let constraints = "seed = 3\nconstraints = [\"operation.pinion_speed_hz > 100\"]";
    refused_with(
        "seed = 3",
        constraints,
        &["constraints", "10000 draws", "`operation.pinion_speed_hz > 100` was not met by 10000"],
    );
    refused_with(
        "> 50\"",
        "> 70\"",
        &["split.shift[0].when", "`operation.pinion_speed_hz > 70` was not met by"],
    );
    // All records would be in the shift.
    refused_with("> 50\"", "> 20\"", &["split.shift[0].when", "not what belongs to the split fast"]);
    refused_with(
        "uniform = [1.0, 5.0]",
        "uniform = [8.0, 9.0]",
        &["no record of the class \"breakage\" can be simulated", "fault.chip_height_mm"],
    );
}

/// A whole number of hunting periods is simulated: of 20 and 40 teeth, one revolution of the gear.
#[test]
fn more_than_is_simulated() {
    let keep = |duration_s: f64| format!("[keep]\nduration_s = {duration_s}");
    let words = ["keep.duration_s = 0.05", "revolutions of the gear", "needs at least 2", "raise it"];
    refused_with("[keep]", &keep(0.05), &words);
    // The key that says how much is simulated, where that says too little, and its line.
    for (key, value) in [("pinion_revolutions", "3.0"), ("duration_s", "0.05")] {
        let line = format!("line 20: scenario.solver.{key} = {value}");
        let words = [&line, "no record of the class \"healthy\"", "needs at least 2", "raise it"];
        refused_with("sampling_rate_hz = 1e4", &format!("sampling_rate_hz = 1e4\n{key} = {value}"), &words);
    }
    // Any steady motion goes on for as long as a record asks.
    for duration_s in [0.5, 5.0] {
        assert_eq!(plan(&FAST.replacen("[keep]", &keep(duration_s), 1)).foreseen_failures(), []);
    }
    // The gear turns 30 to 60 times in two seconds.
    let some = plan(&FAST.replacen("[keep]", &keep(0.1), 1)).foreseen_failures();
    assert!(!some.is_empty() && some.len() < 60, "{}", some.len());
    assert!(some[0].reason.starts_with("keep.duration_s = 0.1"), "{}", some[0].reason);
    let profile = "[scenario.operation.speed_profile_hz]\ntime_s = [0.0, 1.0]\nvalue = [40.0, 50.0]\n[scenario.quality]";
    let run_up = FAST.replacen("[scenario.quality]", profile, 1);
    let run_up =
        run_up.replace("[[vary]]\nkey = \"operation.pinion_speed_hz\"\nuniform = [30.0, 60.0]\n", "");
    let run_up = run_up.replace("when = \"operation.pinion_speed_hz > 50\"", "when = \"noise.snr_db > 20\"");
    let words = ["keep.duration_s = 1.2", "is longer than the speed profile, 1.0000 s", "shorten it"];
    refused(&run_up.replacen("[keep]", &keep(1.2), 1), &words);
    // Chips that are higher than the tooth.
    let some = plan(&FAST.replace("uniform = [1.0, 5.0]", "uniform = [5.0, 7.5]")).foreseen_failures();
    assert!(!some.is_empty() && some.len() < 20, "{}", some.len());
    assert!(some.iter().all(|failed| failed.reason.contains("fault.chip_height_mm")), "{some:?}");
}

/// In a record that is longer than the background its noise would repeat.
#[test]
fn a_background_that_is_shorter_than_a_record() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("healthy.csv");
    let mut draws = Draws::new(3, Purpose::RecordNoise, 0);
    let numbers = (0..4000).flat_map(|_| draws.normals()).map(|number| format!("{number}\n"));
    fs::write(&file, format!("noise_g\n{}", numbers.collect::<String>())).unwrap();
    let with = |keep: &str| {
        let text = FAST.replacen("[keep]", keep, 1);
        format!("background = {{ file = '{}', sampling_rate_hz = 8e3 }}\n{text}", file.display())
    };
    // One second, of which a sixteenth is left out.
    let words =
        ["background", "gives 0.938 s of noise", "a record lasts 2.000 s", "a recording of at least 2.15 s"];
    refused(&with("[keep]\nduration_s = 2.0"), &words);
    assert_eq!(plan(&with("[keep]\nduration_s = 0.9")).foreseen_failures(), []);
    // Records of 40 revolutions of the pinion at 30 to 60 Hz: those that are foreseen to fail are those that do.
    let some = plan(&with("[keep]"));
    let foreseen = some.foreseen_failures();
    assert!(!foreseen.is_empty() && foreseen.len() < 60, "{}", foreseen.len());
    let set = Destination::directory(directory.path().join("set"));
    let failed = run(&some, &set, Part::WHOLE, 2).unwrap().failures;
    let records =
        |failures: &[FailedRecord]| failures.iter().map(|failed| failed.record).collect::<BTreeSet<_>>();
    assert_eq!(records(&failed), records(&foreseen));
    assert!(failed[0].reason.starts_with("background: gives 0.938 s of noise"), "{}", failed[0].reason);
}

/// A value of a choice that no other value can save is reported before anything is made.
#[test]
fn choices_that_are_impossible() {
    let missing = "fault = { kind = \"missing-tooth\" }\nseverity = 4";
    let tooth = |choice: &str| format!("{missing}\n[[class.vary]]\nkey = \"fault.tooth\"\n{choice}");
    let words = [
        "line 38",
        "class[2].vary[0].choice[1] = 41",
        "class \"missing\"",
        "must be at most 40, the gear's teeth",
    ];
    refused_with(missing, &tooth("choice = [3, 41]"), &words);
    refused_with(missing, &tooth("grid = [3, 0]"), &["class[2].vary[0].grid[1] = 0", "must be at least 1"]);
    refused_with(missing, &tooth("fixed = 41"), &["can be simulated", "must be at most 40"]);
    // At no time chosen.
    plan(&FAST.replacen(missing, &tooth("choice = [3, 41]\nweights = [1, 0]"), 1));
    // Beside other faults on the same tooth.
    let two = "fault = [{ kind = \"missing-tooth\", tooth = 5 }, { kind = \"missing-tooth\", tooth = 7 }]\nseverity = 4";
    let second = format!("{two}\n[[class.vary]]\nkey = \"fault[1].tooth\"\nchoice = [4, 5, 6]");
    refused_with(
        missing,
        &second,
        &["class[2].vary[0].choice[1] = 5", "tooth 5 of the gear has fault[0] already"],
    );
    // A number that is too large for some of the drawn teeth is not impossible.
    let teeth = "[[vary]]\nkey = \"gears.gear_teeth\"\nchoice = [40, 60]\n[keep]";
    plan(&FAST.replacen(missing, &tooth("choice = [3, 41]"), 1).replacen("[keep]", teeth, 1));
}

#[test]
fn base_scenarios() {
    refused_with(
        "module_mm = 3.0",
        "module_mm = -3.0",
        &["line", "scenario.gears.module_mm = -3.0", "more than 0"],
    );
    refused_with("module_mm = 3.0", "modul_mm = 3.0", &["did you mean `module_mm`?"]);
    refused_with(
        "[scenario.solver]",
        "[scenario.fault]\nkind = \"missing-tooth\"\n[scenario.solver]",
        &["must be healthy", "[[class]]"],
    );
    refused_with("din_grade = 7", "din_grade = 7\nseed = 3", &["scenario.quality.seed", "wheels of its own"]);
    refused("scenario = \"absent.toml\"\nunits = 1", &["line 1", "absent.toml"]);
}

/// What can be made, and is hardly what was meant.
#[test]
fn doubtful_plans_are_warned_of() {
    assert_eq!(plan(FAST).warnings(), [""; 0]);
    let life = "growth = { law = \"archard\", life_rev = 1e6 }";
    let runs = FAST.replace(
        "fault = { kind = \"missing-tooth\" }\nseverity = 4",
        &format!("fault = {{ kind = \"wear\", severity = 0.5 }}\n{life}"),
    );
    let short = plan(&runs.replacen("units = 10", "units = 12", 1)).warnings();
    assert!(short.len() == 1 && short[0].contains("1 or 2 records each"), "{short:?}");
    let teeth = |values: &str| {
        let choice = format!("[[vary]]\nkey = \"gears.gear_teeth\"\nchoice = [{values}]\n[keep]");
        plan(&FAST.replacen("[keep]", &choice, 1)).warnings()
    };
    let unlearned = teeth("30, 31, 32, 33, 34, 35, 36, 37");
    assert!(
        unlearned.len() == 1 && unlearned[0].contains("nothing is learned of it in train"),
        "{unlearned:?}"
    );
    assert_eq!(teeth("38"), [""; 0]);
    // A batch steps a face that is cut into slices alone.
    let crowned =
        plan(&FAST.replacen("face_width_mm = 15.0", "face_width_mm = 15.0\nlead_crowning_um = 5.0", 1))
            .warnings();
    assert!(
        crowned.len() == 1 && crowned[0].contains("side by side") && crowned[0].contains("slices"),
        "{crowned:?}"
    );
}

#[test]
fn channels_that_there_are_not() {
    let keep = "[keep]\nchannels = [\"casing_g\"]";
    refused_with(
        "[keep]",
        keep,
        &["keep.channels[0]", "must be one of \"horizontal_g\"", "\"mesh_force_n\""],
    );
    let sensor = "[[scenario.sensor]]\nname = \"casting\"\n[keep]\nchannels = [\"casing_g\"]";
    refused_with(
        "[keep]",
        sensor,
        &["must be one of \"casting_g\", \"horizontal_g\"", "did you mean \"casting_g\"?"],
    );
}

#[test]
fn mountings_and_growth() {
    let wheels = "[[vary]]\nkey = \"quality.din_grade\"\nchoice = [5, 6]\nper = \"mounting\"\n[keep]";
    refused_with("[keep]", wheels, &["vary[2].key", "between mountings of one unit", "share their wheels"]);
    let latent = "[[vary]]\nkey = \"rig.support.mass_kg\"\nuniform = [1, 2]\ntimes = \"latent.size\"\n[keep]";
    refused_with("[keep]", latent, &["vary[2].times", "`latent.size` is no number"]);
    let deep = "[[vary]]\nkey = \"latent.size\"\nuniform = [1, 2]\n[[vary]]\nkey = \"rig.support.mass_kg\"\nuniform = [1, 2]\n\
                times = \"latent.size\"\n[keep]";
    refused_with("[keep]", deep, &["vary[3].times", "varies by record; what a unit has cannot"]);
    let by_mounting = "[split]\nby = \"mounting\"";
    let shift = "when = \"rig.support.mass_kg > 1.5\"";
    let text = FAST
        .replace(
            "[split]",
            &format!("[[vary]]\nkey = \"rig.support.mass_kg\"\nuniform = [1, 2]\n{by_mounting}"),
        )
        .replace("when = \"operation.pinion_speed_hz > 50\"", shift);
    refused(&text, &["split.shift[0].when", "in several splits where split.by is"]);
    let grown = |growth: &str, words: &[&str]| {
        let into = format!("fault = {{ kind = \"wear\", severity = 0.5 }}\ngrowth = {growth}");
        refused_with("fault = { kind = \"missing-tooth\" }\nseverity = 4", &into, words);
    };
    let life = "life_rev = { uniform = [1e5, 1e6] }";
    grown("{ law = \"archard\" }", &["growth.life_rev", "missing"]);
    grown("{ law = \"archard\", life = 1e6 }", &["growth.life", "unknown key", "did you mean `life_rev`?"]);
    grown(&format!("{{ law = \"rust\", {life} }}"), &["law", "\"paris\", \"archard\", \"pits\""]);
    grown(&format!("{{ law = \"paris\", start = 0, {life} }}"), &["start", "from more than that"]);
    grown(
        &format!("{{ law = \"archard\", start = 0.5, failure = 0.2, {life} }}"),
        &["failure", "more than start"],
    );
    grown("{ law = \"archard\", life_rev = { uniform = [-1e5, 1e6] } }", &["life_rev", "more than 0"]);
    let by_sizes =
        "fault = { kind = \"wear\", depth_um = 20 }\ngrowth = { law = \"archard\", life_rev = 1e6 }";
    refused_with(
        "fault = { kind = \"missing-tooth\" }\nseverity = 4",
        by_sizes,
        &["class[2].growth", "must be given by its severity"],
    );
    grown("{ law = \"archard\", life_rev = { choice = [1e6, -1e6, 1e7] } }", &["life_rev", "more than 0"]);
    grown("{ law = \"archard\", life_rev = { grid = [1e6, 1e7] } }", &["life_rev", "write choice"]);
    let cracked = format!(
        "fault = {{ kind = \"root-crack\", severity = 0.5 }}\ngrowth = {{ law = \"paris\", {life} }}\n\
         [[class.vary]]\nkey = \"fault.tooth\"\nchoice = [1, 7]"
    );
    refused_with(
        "fault = { kind = \"missing-tooth\" }\nseverity = 4",
        &cracked,
        &["class[2].vary[0]", "would jump from record to record", "in the class's fault"],
    );
    let severe =
        FAST.replace("when = \"operation.pinion_speed_hz > 50\"", "when = \"fault.severity > 0.5\"").replace(
            "fault = { kind = \"missing-tooth\" }\nseverity = 4",
            &format!(
                "fault = {{ kind = \"wear\", severity = 0.5 }}\ngrowth = {{ law = \"archard\", {life} }}"
            ),
        );
    refused(&severe, &["class[2].growth", "passes through all of them"]);
    refused_with("units = 10", "units = 10\nmountings = 7", &["mountings = 7", "70 mountings"]);
    let turns = "[keep]\npoints_per_revolution = 64\nrevolutions = 1";
    refused_with("[keep]", turns, &["keep.revolutions = 1", "1.000 revolutions of the gear", "at least 2"]);
    plan(&FAST.replacen("[keep]", "[keep]\npoints_per_revolution = 64\nrevolutions = 21", 1));
    let angular = FAST.replace("[keep]", "[keep]\npoints_per_revolution = 64\nrevolutions = 2");
    let restless =
        angular.replace("brake_torque_nm = 200.0", "brake_torque_nm = 200.0\ntorque_fluctuation_nm = 1.0");
    refused(&restless, &["keep.points_per_revolution", "constant within a record"]);
    refused_with(
        "seed = 3",
        "seed = 3\nquestions = [\"severity\", \"severity\"]",
        &["questions[1]", "asked twice"],
    );
    refused_with("seed = 3", "seed = 3\nquestions = [\"remaining-life\"]", &["needs a class with growth"]);
    refused_with("[keep]", "[keep]\nrevolutions = 4", &["keep.revolutions", "points_per_revolution"]);
}
