//! The results panel of every fault, of awkward wheels and of awkward signals.

#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use crate::support::check;
use meshtone::scenario::*;
use meshtone::sensor::Channels;
use meshtone::{Simulation, simulate};
use meshtone_plot::{Figure, PlotError, panel};

/// (bytes) Of an SVG.
const LARGEST: usize = 400_000;

fn simulated(scenario: &Scenario) -> Simulation {
    let mut scenario = scenario.clone();
    scenario.solver.sampling_rate_hz = 2e4;
    scenario.meshes[0].points_per_tooth = 2000;
    simulate(&scenario).unwrap()
}

fn drawn(scenario: &Scenario) -> Figure {
    let simulation = simulated(scenario);
    let figure = panel::draw(&simulation).unwrap();
    check(&figure, LARGEST);
    figure
}

fn assert_shows(figure: &Figure, words: &[&str]) {
    for word in words {
        let found = figure.labels().iter().any(|label| label.text.contains(word));
        assert!(found, "no {word:?} in {:?}", figure.labels().iter().map(|l| &l.text).collect::<Vec<_>>());
        assert!(figure.svg().contains(word), "{word}");
    }
}

const EVERY_PANEL: [&str; 22] = [
    "Pinion, input shaft",
    "Gear, output shaft",
    "First tooth, in its plane",
    "From the wheel’s centre, x (mm)",
    "Across the tooth, y (mm)",
    "Tooth face",
    "Face width, z (mm)",
    "Profile errors",
    "Error (µm)",
    "Vertical acceleration (g)",
    "Mesh stiffness over a gear revolution",
    "Stiffness (N/µm)",
    "working",
    "back",
    "root",
    "pitch",
    "tip",
    "start of active profile",
    "chamfer",
    "module 3 mm",
    "contact model",
    "(°)",
];

#[test]
fn panels_of_the_gallery_show_what_they_should() {
    let expected: [(&str, &[&str]); 9] = [
        (
            "healthy",
            &["Healthy gear pair", "DIN 3961 grade 7", "17 and 38 teeth", "Average of 17 gear revolutions"],
        ),
        ("missing_tooth", &["Missing tooth", "tooth missing", "turn of the missing tooth", "healthy gear"]),
        (
            "tooth_breakage",
            &["Tooth breakage: chip 5 mm high, 12 mm wide, tip loss 3 mm", "corner chipped off"],
        ),
        (
            "partial_face",
            &["Pit over part of the face: 2 mm wide", "hatched: lost over part of the face width"],
        ),
        (
            "through_face",
            &["Pit over the whole face: 15 mm wide", "damaged tooth in contact", "pit 15 mm wide,"],
        ),
        (
            "tooth_destruction",
            &["Tooth destruction: flank ground up to", "18 and 35 teeth", "flank ground down"],
        ),
        (
            "root_crack",
            &[
                "Root crack: 3 mm deep, at 45° to the centre line, over the whole face",
                "crack 3 mm deep,",
                "over the whole face",
            ],
        ),
        (
            "pits",
            &["Pits: 3 pits, ", "% of the flank (moderate)", "hatched: lost over part of the face width"],
        ),
        ("wear", &["Wear: up to 30 µm deep", "flank worn", "38 teeth damaged", "healthy gear"]),
    ];
    for ((name, scenario), (expected_name, words)) in crate::support::gallery().iter().zip(expected) {
        assert_eq!(*name, expected_name);
        let figure = drawn(scenario);
        assert_shows(&figure, &EVERY_PANEL);
        assert_shows(&figure, words);
    }
}

#[test]
fn the_png_has_the_panels_size() {
    let (_, scenario) = crate::support::gallery().remove(2);
    let figure = drawn(&scenario);
    let png = figure.png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&png)).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), figure.size_px());
    assert!(png.len() < 300_000, "{} bytes", png.len());
    // Neither blank nor without text: the title's corner has ink in it.
    let mut indices = vec![0; reader.output_buffer_size().unwrap()];
    let palette = reader.info().palette.clone().unwrap().into_owned();
    reader.next_frame(&mut indices).unwrap();
    let rows = indices.chunks(1600).skip(18).take(24);
    let dark =
        rows.flat_map(|row| &row[15..400]).filter(|index| palette[3 * usize::from(**index)] < 60).count();
    assert!(dark > 500, "{dark}");
}

#[test]
fn the_run_stands_in_both_files() {
    let (_, scenario) = crate::support::gallery().remove(0);
    let figure = drawn(&scenario).of_run("0123<ab>cd");
    check(&figure, LARGEST);
    assert!(figure.svg().contains("<metadata>meshtone.run: 0123abcd</metadata>"));
    let png = figure.png().unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&png)).read_info().unwrap();
    let texts = &reader.info().uncompressed_latin1_text;
    assert_eq!((texts[0].keyword.as_str(), texts[0].text.as_str()), ("meshtone.run", "0123abcd"));
}

/// The example's pair with one damage of the gear's first tooth, or none.
fn of_example(damage: Option<Damage>) -> Scenario {
    let GearPair { pinion_teeth, gear_teeth, .. } = GearPair::example();
    with_teeth(pinion_teeth, gear_teeth, damage)
}

fn with_teeth(pinion: u32, gear: u32, damage: Option<Damage>) -> Scenario {
    let mut scenario =
        Scenario::new(GearPair { pinion_teeth: pinion, gear_teeth: gear, ..GearPair::example() });
    let thinnest = 1.5 * f64::from(pinion.min(gear)) - 3.75;
    scenario.rig_mut().unwrap().pinion_shaft.radius_mm = 10f64.min(0.8 * thinnest);
    scenario.rig_mut().unwrap().gear_shaft.radius_mm = 10f64.min(0.8 * thinnest);
    scenario.faults = damage.into_iter().map(Fault::on_first_gear_tooth).collect();
    scenario
}

#[test]
fn small_and_large_wheels() {
    let damages = || {
        let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.5 };
        [
            None,
            Some(MissingTooth.into()),
            Some(ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 9.0, tip_loss_mm: 0.0 }.into()),
            Some(PartialFace { width_mm: 5.0, pit }.into()),
        ]
    };
    for (pinion, gear) in [(6, 200), (6, 6), (200, 6), (200, 200), (41, 42)] {
        for damage in damages() {
            // Six teeth against six, one missing: the wheels lose contact and the motion has no bound.
            if pinion == gear && gear == 6 && damage == Some(MissingTooth.into()) {
                continue;
            }
            drawn(&with_teeth(pinion, gear, damage));
        }
    }
}

#[test]
fn small_and_large_modules() {
    for module in [0.2, 50.0] {
        let mut scenario = Scenario::new(GearPair {
            module_mm: module,
            face_width_mm: 10.0 * module,
            pinion_speed_hz: 10.0,
            ..GearPair::example()
        });
        scenario.rig_mut().unwrap().pinion_shaft.radius_mm = 5.0 * module;
        scenario.rig_mut().unwrap().gear_shaft.radius_mm = 5.0 * module;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = if module < 1.0 { 12 } else { 1 });
        scenario.faults = vec![Fault::on_first_gear_tooth(ToothBreakage {
            chip_height_mm: 1.5 * module,
            chip_width_mm: 10.0 * module,
            tip_loss_mm: module,
        })];
        drawn(&scenario);
    }
}

#[test]
fn ideal_teeth_say_so() {
    assert_shows(&drawn(&of_example(None)), &["ideal teeth"]);
}

#[test]
fn base_circles_that_are_not_seen_are_mentioned() {
    let mentioned =
        |figure: &Figure| figure.labels().iter().filter(|l| l.text == "base circle below the root").count();
    let named = |figure: &Figure| figure.labels().iter().filter(|l| l.text == "base").count();
    for (pinion, gear, seen) in [(17, 38, 2), (38, 45, 2), (45, 60, 1), (60, 200, 0)] {
        for damage in [None, Some(partial_face())] {
            let figure = drawn(&with_teeth(pinion, gear, damage));
            assert_eq!((named(&figure), mentioned(&figure)), (seen, 2 - seen), "{pinion} and {gear}");
        }
    }
}

fn partial_face() -> Damage {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.4 };
    PartialFace { width_mm: 5.0, pit }.into()
}

/// The face shows the damage where the equations of motion take the width away.
#[test]
fn damage_is_at_the_end_from_which_the_load_moves_away() {
    let chip = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 6.0, tip_loss_mm: 0.0 };
    for damage in [partial_face(), chip.into()] {
        let mut scenario = of_example(Some(damage));
        scenario.model = Model::Linear;
        let simulation = simulated(&scenario);
        assert_shows(&panel::draw(&simulation).unwrap(), &["chamfer", "linear model"]);
        let states = &simulation.stages.meshes[0].classes[1].states;
        assert!(
            states.iter().any(|state| state.face_centre_m < 0.0)
                && states.iter().all(|state| state.face_centre_m <= 0.0)
        );
        let figure = panel::draw(&simulation).unwrap();
        let face_middle = figure.labels().into_iter().filter(|label| label.text == "Face width, z (mm)");
        let face_middle = face_middle.map(|label| (label.left + label.right) / 2.0).fold(0.0, f64::max);
        let document = roxmltree::Document::parse(figure.svg()).unwrap();
        let edges = document.descendants().filter(|node| {
            node.attribute("stroke") == Some("#d55e00") && node.attribute("stroke-width") == Some("1.8")
        });
        let mut places = edges.flat_map(|edge| {
            let path = edge.attribute("d").unwrap().replace('Z', "");
            let points =
                path.split(['M', 'L']).filter_map(|point| point.split(' ').next()?.parse::<f64>().ok());
            points.collect::<Vec<_>>()
        });
        assert!(places.next().is_some() && places.all(|x| x > face_middle));
    }
}

#[test]
fn a_rough_flank_below_the_start_of_contact() {
    let (_, mut scenario) = crate::support::gallery().remove(5);
    scenario.faults = vec![Fault::on_first_gear_tooth(ToothDestruction {
        start: -0.1,
        line: DestructionLine::SlopeDeg(20.0),
        offset_mm: 0.3,
        noise_mm: 0.05,
    })];
    drawn(&scenario);
}

#[test]
fn published_model_and_given_errors() {
    let (_, mut scenario) = crate::support::gallery().remove(4);
    let errors = meshtone::stages(&scenario).unwrap().pairs[0].profile_errors.clone();
    scenario.set_quality(Quality::of_errors(errors.unwrap()));
    scenario.model = Model::Published;
    assert_shows(&drawn(&scenario), &["model as published", "given profile errors"]);
}

#[test]
fn a_changing_speed_is_drawn_over_time() {
    let mut scenario = of_example(Some(MissingTooth.into()));
    let profile = Profile { time_s: vec![0.0, 1.0, 1.6], value: vec![20.0, 40.0, 30.0] };
    scenario.operation.speed_profile_hz = Some(profile);
    scenario.operation.torque_profile_nm = Some(Profile { time_s: vec![0.0, 1.0], value: vec![5.0, 12.0] });
    let words = [
        "at changing speed",
        "Speed of both shafts",
        "Speed (Hz)",
        "pinion speed 20 to 40 Hz",
        "5 to 12 N·m",
    ];
    assert_shows(&drawn(&scenario), &words);
}

#[test]
fn kept_signals_that_start_within_a_revolution() {
    // The impact must stay where the tooth is, wherever the kept signal starts.
    let mut scenario = of_example(Some(MissingTooth.into()));
    scenario.solver.settle_fraction = 0.33;
    let Simulation { stages, channels, .. } = simulated(&scenario);
    let per_gear = stages.time.samples_per_pinion_revolution * 38 / 17;
    assert_ne!(stages.time.first_kept_sample % per_gear, 0);
    check(&panel::draw(&stages.with_channels(channels)).unwrap(), LARGEST);
}

// The angle follows from the scenario, not from the channels that are kept.
#[test]
fn a_gearbox_whose_speed_changes_has_an_order_spectrum() {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    gearbox.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 0.3], value: vec![20.0, 30.0] });
    gearbox.solver.duration_s = Some(0.3);
    let mut simulation = meshtone::simulate(&gearbox).unwrap();
    let known = panel::draw(&simulation).unwrap();
    let is_of_revolutions =
        |label: &str| label.starts_with("Order spectrum") && label.contains("revolutions of the input");
    assert!(known.labels().iter().any(|label| is_of_revolutions(&label.text)));
    simulation.channels.signals.retain(|signal| !signal.name.starts_with("speed_hz"));
    assert_eq!(panel::draw(&simulation).unwrap().svg(), known.svg());
}

/// A gearbox of three stages with one tooth missing from each of the first wheels.
fn with_damaged_wheels(damaged: usize) -> Simulation {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    let name = |of: &str, n: usize| format!("{of}{n}");
    let coupled = [Coupled::Motor, Coupled::Nothing, Coupled::Nothing, Coupled::Brake];
    let shaft = |n: usize| {
        let mut shaft = GearboxShaft::new(&name("shaft", n), 150.0, 12.0);
        shaft.couples_to = coupled[n];
        shaft
    };
    let wheel = |n: usize| {
        let (on, at) = (name("shaft", n.div_ceil(2)), [0.2, 0.5, 0.8][n / 2]);
        ScenarioWheel::new(&name("z", n + 1), &on, at, [20, 40][n % 2], 15.0)
    };
    gearbox.structure.shafts_mut().unwrap().shafts = (0..4).map(shaft).collect();
    gearbox.wheels = (0..6).map(wheel).collect();
    gearbox.meshes = [["z1", "z2"], ["z3", "z4"], ["z5", "z6"]].map(|of| ScenarioMesh::new(of, 2.5)).to_vec();
    let bearings = (0..4).flat_map(|n| [0.0, 1.0].map(|at| Bearing::new(&name("shaft", n), at)));
    gearbox.structure.shafts_mut().unwrap().bearings = bearings.collect();
    gearbox.structure.shafts_mut().unwrap().housing = None;
    // It names the former shafts.
    gearbox.operation.torque_ripple.clear();
    gearbox.sensors.clear();
    let fault = |n: usize| Fault::new(name("z", n + 1), 3, MissingTooth);
    gearbox.faults = (0..damaged).map(fault).collect();
    gearbox.solver.duration_s = Some(1.0);
    meshtone::simulate(&gearbox).unwrap()
}

#[test]
fn damaged_wheels_of_a_gearbox_are_drawn_as_far_as_there_is_room() {
    for damaged in [1, 2, 3, 5] {
        let simulation = with_damaged_wheels(damaged);
        let figure = panel::draw(&simulation).unwrap();
        check(&figure, LARGEST);
        let shows = |text: &str| figure.labels().iter().any(|label| label.text.contains(text));
        let drawn = damaged.min(4);
        for wheel in 1..=6 {
            let (is_drawn, name) = (wheel <= drawn, format!("z{wheel}"));
            assert_eq!(shows(&format!("{name}, shaft shaft{}", wheel / 2)), is_drawn, "{damaged}: {name}");
            assert_eq!(shows(&format!("revolutions of {name}")), is_drawn, "{damaged}: {name}");
            // Of more than two wheels there is no room for the stiffness.
            assert_eq!(
                shows(&format!("over a turn of {name}")),
                is_drawn && damaged <= 2,
                "{damaged}: {name}"
            );
        }
        assert!(shows("Missing tooth on tooth 3 of z1") && !shows(", Missing"));
        assert_eq!(shows("1 more damaged wheel is in the summary"), damaged == 5);
        let curves = if damaged <= 2 { 2 * damaged } else { drawn };
        assert_eq!(tinted(&figure).len(), curves, "{damaged}");
    }
}

#[test]
fn a_wheel_without_a_profile_is_named() {
    let mut simulation = with_damaged_wheels(1);
    Arc::make_mut(&mut simulation.stages.pairs[0].teeth.pinion_profile).x_mm.truncate(1);
    let error = panel::draw(&simulation).map(drop).unwrap_err();
    assert_eq!(error.to_string(), "z1's tooth profile has 1 points; at least 2 are needed to draw it");
    let Simulation { mut stages, channels, .. } = simulated(&of_example(None));
    Arc::make_mut(&mut stages.pairs[0].teeth.gear_profile).x_mm.truncate(1);
    let error = panel::draw(&stages.with_channels(channels)).map(drop).unwrap_err();
    assert_eq!(error.to_string(), "the gear's tooth profile has 1 points; at least 2 are needed to draw it");
}

#[test]
fn awkward_signals() {
    let Simulation { stages, channels, .. } = simulated(&of_example(None));
    let length = channels.len();
    let like = |values: Vec<f64>| {
        let mut like = channels.clone();
        like.signals.iter_mut().for_each(|signal| signal.values.clone_from(&values));
        like
    };
    let panel = |channels: &Channels| {
        let figure = panel::draw(&stages.clone().with_channels(channels.clone())).unwrap();
        check(&figure, LARGEST);
        figure.png().unwrap();
        figure
    };
    assert_shows(&panel(&Channels::default()), &["no samples were kept"]);
    assert_shows(&panel(&like(vec![1.0; 10])), &["the kept signal is shorter than a revolution"]);
    for value in [0.0, 1.0, -1e-9, 3e8, f64::NAN, f64::INFINITY, 1e300] {
        panel(&like(vec![value; length]));
    }
    let mut spiked = channels["vertical_g"].to_vec();
    spiked[length / 2] = f64::NAN;
    panel(&like(spiked));
}

#[test]
fn signals_of_another_rate_are_refused() {
    let Simulation { stages, mut channels, .. } = simulated(&of_example(None));
    channels.sampling_rate_hz /= 2.0;
    let error = panel::draw(&stages.with_channels(channels)).unwrap_err();
    assert!(matches!(error, PlotError::SamplingRate { .. }), "{error}");
}

#[test]
fn no_samples_at_changing_speed() {
    let mut scenario = of_example(None);
    scenario.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 1.5], value: vec![20.0, 40.0] });
    let simulation = simulated(&scenario);
    let figure = panel::draw(&simulation.stages.with_channels(Channels::default())).unwrap();
    check(&figure, LARGEST);
    assert_shows(&figure, &["no samples were kept"]);
}

/// The parts of the horizontal axes that are tinted as a damaged tooth's turn, from left to right, in the figure's order.
fn tinted(figure: &Figure) -> Vec<[f64; 2]> {
    let document = roxmltree::Document::parse(figure.svg()).unwrap();
    let tints = document.descendants().filter(|node| {
        node.attribute("fill") == Some("#d55e00") && node.attribute("fill-opacity") == Some("0.22")
    });
    tints.map(extent_px).collect()
}

#[test]
fn damaged_teeth_are_marked_and_named_wherever_they_are() {
    let mut scenario = of_example(None);
    scenario.faults = vec![Fault::new(WheelName::Gear, 6, partial_face())];
    let gear = drawn(&scenario);
    assert_shows(
        &gear,
        &[
            "Pit over part of the face, gear tooth 6: 5 mm wide",
            "Gear tooth 6, in its plane",
            "38 teeth, tooth 6 damaged",
            "damaged gear tooth 6 in contact",
            "Gear angle since its first tooth enters contact",
            "Around gear tooth 6, enlarged",
        ],
    );
    let chip = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 6.0, tip_loss_mm: 1.0 };
    scenario.faults = vec![
        Fault::new(WheelName::Pinion, 3, chip),
        Fault::new(WheelName::Gear, 38, partial_face()),
        Fault::new(WheelName::Pinion, 3, partial_face()),
    ];
    let both = drawn(&scenario);
    assert_shows(
        &both,
        &[
            "Tooth breakage, pinion tooth 3",
            "; pit over part of the face, gear tooth 38",
            "Pinion tooth 3, in its plane",
            "Gear tooth 38, in its plane",
            "damaged pinion tooth 3 in contact",
            "damaged gear tooth 38 in contact",
            "healthy pair",
            "corner chipped off",
            "Around pinion tooth 3, enlarged",
        ],
    );
    let missing = drawn(&{
        scenario.faults = vec![Fault::new(WheelName::Pinion, 1, MissingTooth)];
        scenario
    });
    assert_shows(
        &missing,
        &[
            "Missing tooth, pinion tooth 1",
            "17 teeth, the first one missing",
            "missing tooth would enter contact",
        ],
    );
}

#[test]
fn of_several_damaged_teeth_the_one_that_is_drawn_is_named_and_so_are_the_others() {
    let mut scenario = of_example(None);
    let pits = |teeth: &[u32]| {
        teeth.iter().map(|&tooth| Fault::new(WheelName::Gear, tooth, partial_face())).collect()
    };
    scenario.faults = pits(&[20, 6]);
    assert_shows(&drawn(&scenario), &["Gear tooth 6, in its plane (also damaged: tooth 20)"]);
    scenario.faults = pits(&[1, 6, 11, 16, 21]);
    assert_shows(&drawn(&scenario), &["First tooth, in its plane (also damaged: 4 teeth)"]);
}

#[test]
fn the_edge_of_a_pit_does_not_cross_the_name_of_the_contact_start() {
    let mut scenario = of_example(None);
    let names = |figure: &Figure| {
        let names = figure.labels().into_iter().filter(|label| label.text == "start of active profile");
        names.map(|label| label.top).collect::<Vec<_>>()
    };
    let healthy = names(&drawn(&scenario));
    for (start, count) in [(0.03, 1), (0.5, 0)] {
        let pit = PitCircle::Fractions { start, end: 0.7, depth: 0.3 };
        scenario.faults = vec![Fault::on_first_gear_tooth(ThroughFace { pit })];
        let pitted = names(&drawn(&scenario));
        let lowered = healthy.iter().zip(&pitted).filter(|(before, after)| after > before).count();
        assert_eq!((pitted.len(), lowered), (healthy.len(), count), "{healthy:?} {pitted:?}");
    }
}

#[test]
fn a_damaged_tooth_turns_at_its_own_angle() {
    let contact = |tooth: u32| {
        let mut scenario = of_example(None);
        scenario.faults = vec![Fault::new(WheelName::Gear, tooth, partial_face())];
        let figure = drawn(&scenario);
        let tints = tinted(&figure);
        // The legend's sample of the average, and the turn.
        (tints[0], tints[1])
    };
    let (_, first) = contact(1);
    let pitch = 710.0 / 38.0;
    let (_, sixth) = contact(6);
    assert!((sixth[0] - first[0] - 5.0 * pitch).abs() < 0.1, "{first:?} {sixth:?}");
    assert!((sixth[1] - first[1] - 5.0 * pitch).abs() < 0.1);
    assert!(((first[1] - first[0]) / pitch - 1.612).abs() < 0.01);
}

#[test]
fn a_pinion_tooth_that_the_gears_first_revolution_does_not_meet() {
    let mut scenario = with_teeth(40, 20, None);
    scenario.faults = vec![Fault::new(WheelName::Pinion, 27, partial_face())];
    assert_shows(
        &drawn(&scenario),
        &["Around pinion tooth 27, enlarged", "20 teeth", "40 teeth, tooth 27 damaged"],
    );
}

#[test]
fn cracks_of_either_wheel_and_beside_other_damage() {
    let (_, mut scenario) = crate::support::gallery().remove(6);
    let crack = RootCrack { depth_mm: 2.5, angle_deg: 30.0, length_mm: Some(6.5) };
    scenario.faults =
        vec![Fault::new(WheelName::Pinion, 3, crack), Fault::on_first_gear_tooth(partial_face())];
    let words = ["crack up to 2.5 mm deep,", "6.5 mm along the face", "dashed: nothing beyond carries load"];
    assert_shows(&drawn(&scenario), &words);
    scenario.faults = vec![
        Fault::on_first_gear_tooth(partial_face()),
        Fault::on_first_gear_tooth(RootCrack { depth_mm: 4.0, angle_deg: 45.0, length_mm: None }),
    ];
    assert_shows(&drawn(&scenario), &["crack 4 mm deep,", "hatched: lost over part of the face width"]);
}

#[test]
fn the_order_spectrum_has_its_mesh_orders_and_the_sensor_as_the_user_wrote_it() {
    let mut scenario = of_example(None);
    let words = [
        "Order spectrum of vertical acceleration, 38 revolutions of the pinion",
        "Order of the pinion",
        "Amplitude (g)",
        "mesh and its harmonics",
        "shafts",
    ];
    let figure = drawn(&scenario);
    assert_shows(&figure, &words);
    // The lines stand at one, two, three and four times the mesh order, whose name is beside the first.
    let mut lines = dashed(&figure, "4 3");
    lines.retain(|[left, right]| left == right);
    let lines: Vec<f64> = lines.into_iter().map(|[left, _]| left).collect();
    let [first, second, third, fourth] = lines[..] else { panic!("{lines:?}") };
    assert!([third - second, fourth - third].iter().all(|step| (step - (second - first)).abs() < 0.1));
    let mut names = figure.labels().into_iter().filter(|label| label.text == "17");
    assert!(names.any(|label| (label.left - first - 4.0).abs() < 1.0), "{first}");
    let mut sensor = Sensor::default();
    sensor.name = Some("Case_DE".to_owned());
    scenario.sensors = vec![sensor];
    assert_shows(&drawn(&scenario), &["Order spectrum of Case DE, ", "Case DE (g)"]);
}

/// (px) From where to where the lines with some dashes reach across, in the figure's order.
fn dashed(figure: &Figure, dashes: &str) -> Vec<[f64; 2]> {
    let document = roxmltree::Document::parse(figure.svg()).unwrap();
    let lines = document.descendants().filter(|node| node.attribute("stroke-dasharray") == Some(dashes));
    lines.map(extent_px).collect()
}

/// (px) From where to where a path reaches across.
fn extent_px(node: roxmltree::Node) -> [f64; 2] {
    let path = node.attribute("d").unwrap().replace('Z', "");
    let x = path.split(['M', 'L']).filter_map(|point| point.split(' ').next()?.parse::<f64>().ok());
    x.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// (px) Sum of the widths of the healthy pair's curves.
fn healthy_width(figure: &Figure) -> f64 {
    dashed(figure, "5 3").iter().map(|[left, right]| right - left).sum()
}

#[test]
fn the_healthy_stiffness_is_drawn_wherever_this_one_differs() {
    let with = |faults: &[Fault]| {
        let mut scenario = of_example(None);
        scenario.faults = faults.to_vec();
        drawn(&scenario)
    };
    let pit = Fault::new(WheelName::Gear, 6, partial_face());
    let of_pit = with(std::slice::from_ref(&pit));
    let of_both = with(&[Fault::at_usual_place(Wear { depth_um: 30.0 }), pit]);
    // The worn teeth are the gear's ordinary ones: only the pitted tooth is tinted, and yet every pitch differs from the healthy pair's.
    assert_eq!(tinted(&of_both), tinted(&of_pit));
    assert!(healthy_width(&of_both) > 5.0 * healthy_width(&of_pit), "{}", healthy_width(&of_both));
}
