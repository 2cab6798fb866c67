//! What makes a gearbox sound like one: friction, the random force, housing modes, and the drive.

use std::f64::consts::{PI, TAU};

use crate::planetary::RIG_A;
use crate::planetary_averages::STAGE;
use meshtone::machine::Axis;
use meshtone::scenario::{HousingModes, Ripple, Scenario, ScenarioError, Sensor, gearbox_template};
use meshtone::sensor::SignalSource;
use meshtone::{simulate, stages};
use nalgebra::{Complex, DMatrix, DVector};

/// The template, 0.2 s at 51.2 kS/s, without what is random, rubs or vibrates in it.
fn bare() -> Result<Scenario, ScenarioError> {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None))?;
    gearbox.solver.sampling_rate_hz = 51_200.0;
    gearbox.solver.duration_s = Some(0.2);
    gearbox.meshes.iter_mut().for_each(|mesh| (mesh.friction, mesh.random_force) = (0.0, 0.0));
    set_modes(&mut gearbox, HousingModes::RIGID);
    gearbox.operation.torque_ripple.clear();
    gearbox.operation.speed_wander_percent = 0.0;
    Ok(gearbox)
}

fn set_modes(gearbox: &mut Scenario, modes: HousingModes) {
    if let Some(housing) = gearbox.housing_mut() {
        housing.modes = modes;
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A mesh without friction beside one that has some is as with next to none: of spur and helical teeth that tilt with their wheels, of helical ones that
/// do not, and of a planetary set.
#[test]
fn a_mesh_without_friction_stands_beside_one_with_it() {
    let box_of = |helix_angle_deg: f64| {
        let mut gearbox = bare().unwrap();
        gearbox.meshes.iter_mut().for_each(|mesh| mesh.helix_angle_deg = helix_angle_deg);
        gearbox.meshes[0].friction = 0.05;
        gearbox
    };
    let set = RIG_A.replacen("[[shaft]]", &format!("{STAGE}[[shaft]]"), 1);
    let set = set.replace("couples_to = \"motor\"\ncoupling_stiffness_nm_per_rad = 1.0\n", "");
    let mut set = Scenario::from_toml(&set).unwrap();
    (set.solver.sampling_rate_hz, set.solver.duration_s) = (8e4, Some(0.1));
    assert!(set.meshes[0].friction > 0.0);
    for (gearbox, mesh) in [(box_of(0.0), 1), (box_of(15.0), 1), (set, 1)] {
        let force_n = |friction: f64| {
            let mut gearbox = gearbox.clone();
            match gearbox.structure.shafts_mut().and_then(|shafts| shafts.planetary.first_mut()) {
                Some(set) => set.friction = friction,
                None => gearbox.meshes[1].friction = friction,
            }
            simulate(gearbox).unwrap().channels.of(SignalSource::MeshForce(mesh)).to_vec()
        };
        let [without, with] = [0.0, 1e-9].map(force_n);
        let largest_n = without.iter().fold(0.0, |most: f64, force_n| most.max(force_n.abs()));
        let apart_n = without.iter().zip(&with).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        println!("{:e} of {largest_n:.1} N", apart_n);
        assert!(apart_n < 1e-5 * largest_n, "{apart_n}");
    }
}

/// The loss of ideal wheels is `π μ (1/z₁ + 1/z₂)(1 − ε + ε₁² + ε₂²)` of the power: textbooks of gears, with the load shared evenly among
/// the pairs; G. Niemann, H. Winter, *Maschinenelemente* 2, section 21.11. Power that goes in and does not come out is that loss.
#[test]
fn friction_takes_the_power_that_textbooks_say() {
    let mut gearbox = bare().unwrap();
    gearbox.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 0);
    gearbox.meshes.iter_mut().for_each(|mesh| mesh.friction = 0.06);
    let simulation = simulate(gearbox).unwrap();
    for (number, pair) in simulation.stages.pairs.iter().enumerate() {
        let [z1, z2] = [&pair.teeth.pinion, &pair.teeth.gear].map(|wheel| f64::from(wheel.teeth));
        let (path, gear) = (&pair.teeth.path, &pair.teeth.gear);
        let mesh = &simulation.stages.meshes[number];
        let whole = path.contact_ratio;
        let at_pitch_point_mm = gear.curvature_mm(gear.working_pitch_radius_mm);
        let pitch_point = (path.gear_tip_curvature_mm - at_pitch_point_mm) / path.base_pitch_mm;
        // The chamfers shorten the path at either end.
        let shorter = (whole - mesh.contact_ratio) / 2.0;
        let (before, after) = (pitch_point - shorter, whole - pitch_point - shorter);
        let textbook =
            PI * 0.06 * (1.0 / z1 + 1.0 / z2) * (1.0 - mesh.contact_ratio + before * before + after * after);
        let loss = 1.0 - simulation.efficiency(number).unwrap();
        assert!((loss / textbook - 1.0).abs() < 0.1, "mesh {number}: {loss} beside {textbook}");
    }
}

/// Without friction nothing is lost, no channel says so, and nothing else is on: the signals of the former law, bit for bit as with every
/// key at 0. The random force changes what sensors show and nothing of what is integrated.
#[test]
fn random_force_is_superposed_on_the_same_motion() {
    let without = simulate(bare().unwrap()).unwrap();
    assert_eq!(without.efficiency(0), None);
    let mut random = bare().unwrap();
    random.meshes.iter_mut().for_each(|mesh| mesh.random_force = 0.055);
    let with = simulate(random.clone()).unwrap();
    let (sensor, others): (Vec<_>, Vec<_>) = with
        .channels
        .signals
        .iter()
        .zip(&without.channels.signals)
        .partition(|(a, _)| a.name.ends_with("_g"));
    for (with, without) in others {
        let largest = without.values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let off = with.values.iter().zip(&without.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9 * largest, "{}: {off}", with.name);
    }
    let added = |n: usize| -> Vec<f64> {
        let (with, without) = sensor[n];
        with.values.iter().zip(&without.values).map(|(a, b)| a - b).collect()
    };
    assert!(added(0).iter().any(|value| value.abs() > 0.01));
    // The same seed draws the same force, whatever the wheels are, and another one another.
    assert_eq!(simulate(random.clone()).unwrap().channels, with.channels);
    random.seed += 1;
    random.wheels_seed = Some(1);
    assert_ne!(simulate(random).unwrap().channels["input_0_vertical_g"], with.channels["input_0_vertical_g"]);
}

/// The spectrum of what the random force adds is that of white noise through the machine's own matrices, with the mean meshes closed,
/// within 1 dB in third octaves at 0.8, 2 and 6.3 kHz. The matrices and the directions are put together here once more.
#[test]
fn random_force_goes_through_the_machine() {
    let mut random = bare().unwrap();
    random.solver.discard_and_keep(0.1, 1.0);
    set_modes(&mut random, HousingModes::default());
    // Small matrices.
    random.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.elements = 3);
    random.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 0);
    random.meshes.iter_mut().for_each(|mesh| mesh.random_force = 0.055);
    let mut without = random.clone();
    without.meshes.iter_mut().for_each(|mesh| mesh.random_force = 0.0);
    let [with, without] = [random, without].map(|scenario| simulate(scenario).unwrap());
    let name = "input_0_vertical_g";
    let added: Vec<f64> =
        with.channels[name].iter().zip(&without.channels[name]).map(|(a, b)| a - b).collect();
    let stages = &with.stages;
    let (machine, modes) = stages.machine_and_modes().unwrap();
    let count = machine.coordinates();
    let mass = &machine.mass;
    let shapes = &modes.shapes;
    let damped = DMatrix::from_diagonal(&DVector::from_fn(count, |n, _| {
        2.0 * modes.damping_ratio[n] * modes.angular_frequencies[n]
    }));
    let damping = mass * shapes * damped * shapes.transpose() * mass;
    let stiffness = machine.stiffness();
    let sensor = machine.weights("input_0_vertical", Axis::Y);
    let rate_hz = with.channels.sampling_rate_hz;
    let samples = added.len();
    let spectrum = meshtone_fourier::real_spectrum(&added);
    for centre_hz in [800.0, 2000.0, 6300.0] {
        let edge = 2f64.powf(1.0 / 6.0);
        let lines = [centre_hz / edge, centre_hz * edge].map(|hz| (hz * samples as f64 / rate_hz) as usize);
        let measured = spectrum[lines[0]..lines[1]].iter().map(|line| line.norm_sqr()).sum::<f64>() * 2.0
            / (samples as f64 * rate_hz * (lines[1] - lines[0]) as f64);
        let mut expected = 0.0;
        const PLACES: usize = 6;
        for place in 0..PLACES {
            let hz = centre_hz * edge.powf(2.0 * (place as f64 + 0.5) / PLACES as f64 - 1.0);
            let w = TAU * hz;
            let mut dynamic = DMatrix::from_fn(count, count, |r, c| {
                Complex::new(stiffness[(r, c)] - w * w * mass[(r, c)], w * damping[(r, c)])
            });
            for (line, mesh) in machine.lines.iter().zip(&stages.meshes) {
                let along = line.at_middle.map(Complex::from);
                let closed = Complex::new(1.0, w * mesh.damping_time_s) * mesh.mean_stiffness_n_per_m;
                dynamic += &along * along.transpose() * closed;
            }
            let factor = dynamic.lu();
            for (number, line) in machine.lines.iter().enumerate() {
                let across = line.across.as_ref().unwrap();
                let moved = factor.solve(&across.at_pitch_point.map(Complex::from)).unwrap();
                let seen_g = moved.iter().zip(sensor.iter()).map(|(u, of)| u * *of).sum::<Complex<f64>>()
                    * (w * w / 9.81);
                let pair = &stages.pairs[number];
                let pitch_point = (pair.teeth.path.gear_tip_curvature_mm
                    - pair.teeth.gear.curvature_mm(pair.teeth.gear.working_pitch_radius_mm))
                    / pair.teeth.path.base_pitch_mm;
                let (before, after) = (pitch_point, pair.teeth.path.contact_ratio - pitch_point);
                let distance_m = (before * before + after * after) / (2.0 * pair.teeth.path.contact_ratio)
                    * pair.teeth.path.base_pitch_mm
                    * 1e-3;
                let [own, mate] = [&pair.teeth.pinion, &pair.teeth.gear].map(|wheel| f64::from(wheel.teeth));
                let sliding =
                    distance_m * TAU * 30.0 * stages.layout.driving_ratio(number).abs() * (1.0 + own / mate);
                let density = 0.055 * pair.static_force_n.powf(0.4) * (sliding / 0.5).powf(1.25);
                expected += (seen_g.norm() * density).powi(2) / (1.0 + (hz / 1e4).powi(2)) / PLACES as f64;
            }
        }
        let off_db = 10.0 * (measured / expected).log10();
        assert!(off_db.abs() < 1.0, "{centre_hz} Hz: {off_db} dB");
    }
}

/// So many modes a kHz, each in its stretch, with the housing's mass; none of a rigid one, whose machine has the coordinates of before.
#[test]
fn housing_has_the_modes_that_are_asked_for() {
    let frequencies = |modes: HousingModes| {
        let mut gearbox = bare().unwrap();
        set_modes(&mut gearbox, modes);
        let stages = meshtone::stages(gearbox).unwrap();
        let (machine, _) = stages.machine_and_modes().unwrap();
        let stiffness = machine.stiffness();
        (0..machine.names.len())
            .filter(|n| machine.names[*n].starts_with("housing_mode"))
            .map(|n| {
                // Beside the mode's own spring those of the seats, of which each takes a share.
                assert_eq!(machine.mass[(n, n)], 30.0);
                (stiffness[(n, n)] / 30.0).sqrt() / TAU
            })
            .collect::<Vec<f64>>()
    };
    assert!(frequencies(HousingModes::RIGID).is_empty());
    let four = frequencies(HousingModes::default());
    assert_eq!(four.len(), 35);
    let other = frequencies(HousingModes { seed: 2, ..HousingModes::default() });
    assert!(four.iter().zip(&other).all(|(one, other)| one != other));
    assert_eq!(
        frequencies(HousingModes { per_khz: 2.0, first_hz: 500.0, ..HousingModes::default() }).len(),
        17
    );
}

/// Torque that varies with the middle shaft's rotation modulates the mesh force at that shaft's order.
#[test]
fn torque_varies_with_any_shaft() {
    let mut gearbox = bare().unwrap();
    gearbox.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 0);
    gearbox.solver.discard_and_keep(0.2, 1.0);
    gearbox.operation.torque_ripple =
        vec![Ripple { shaft: Some("middle".into()), order: 1.0, amplitude: 0.3, phase_deg: 0.0 }];
    let simulation = simulate(gearbox.clone()).unwrap();
    let force_n = &simulation.channels["force_n.z3-z4"];
    let speed_hz = 30.0 * 32.0 / 96.0;
    let rate_hz = simulation.channels.sampling_rate_hz;
    let (mut cos, mut sin) = (0.0, 0.0);
    for (k, force_n) in force_n.iter().enumerate() {
        let angle = TAU * speed_hz * k as f64 / rate_hz;
        cos += force_n * angle.cos();
        sin += force_n * angle.sin();
    }
    let amplitude = 2.0 * cos.hypot(sin) / force_n.len() as f64 / mean(force_n);
    // The train's torsion below its first natural frequency adds a little.
    assert!((amplitude / 0.3 - 1.0).abs() < 0.15, "{amplitude}");
    let refused = |change: &dyn Fn(&mut Ripple)| {
        let mut gearbox = gearbox.clone();
        change(&mut gearbox.operation.torque_ripple[0]);
        meshtone::stages(gearbox).unwrap_err().to_string()
    };
    let unknown = refused(&|ripple| ripple.shaft = Some("second".into()));
    assert!(unknown.contains("operation.torque_ripple.shaft") && unknown.contains("\"middle\""), "{unknown}");
    let many = refused(&|ripple| ripple.amplitude = 1.3);
    assert!(many.contains("1.2"), "{many}");
    gearbox.operation.torque_ripple[0].amplitude = 1.1;
    let warnings = meshtone::stages(gearbox).unwrap().warnings();
    assert!(warnings.iter().any(|warning| warning.kind.code() == "torque-reverses"), "{warnings:?}");
}

/// (Hz, dB) Third-octave levels of a recorded two-stage gearbox of the same teeth over the energy of the channel: mean over two channels and two loads
/// of the healthy recordings of OEDI submission 623 (NREL, CC BY 4.0), measured once for this comparison.
const RECORDED_DB: [[f64; 2]; 10] = [
    [629.96, -21.49],
    [793.70, -17.10],
    [1000.0, -14.67],
    [1259.92, -12.99],
    [1587.40, -12.98],
    [2000.0, -9.98],
    [2519.84, -9.89],
    [3174.80, -9.70],
    [4000.0, -5.18],
    [5039.68, -11.25],
];

/// What is heard of a gearbox, as medians over its sensors.
#[derive(Debug)]
struct Heard {
    /// Part of the energy in lines, at multiples of a tenth of the input's order, without what the remainder has of it there.
    line_share: f64,
    /// Third octaves from 198 Hz to 6.3 kHz within 10 dB of the loudest.
    loud_octaves: f64,
    /// (dB) Median difference of third octaves from those recorded.
    shape_db: f64,
    /// Logarithm of the rms of the first mesh harmonic over that of the signal.
    first_harmonic: f64,
    /// Modulation of the remainder's power, and of the signal's, at orders of the input.
    remainder_at_3: f64,
    remainder_at_middle: f64,
    signal_at_middle: f64,
    kurtosis: f64,
    /// (g) Of what is no line.
    remainder_rms: f64,
}

/// The template's machine with 32/80 and 48/64 teeth of class 4 at 29.75 Hz and some torque, with torque that varies with the input and the
/// middle shaft, heard below 6.4 kHz on four seats of some housings.
fn heard(
    torque_nm: f64,
    ripples: [f64; 2],
    housings: std::ops::Range<u64>,
) -> Result<Heard, Box<dyn std::error::Error>> {
    const INPUT_HZ: f64 = 29.75;
    const REVOLUTIONS: usize = 80;
    let mut all: Vec<[f64; 9]> = Vec::new();
    for seed in housings {
        let mut gearbox = Scenario::from_toml(&gearbox_template(None))?;
        // As if the angle of the input were known.
        gearbox.operation.speed_wander_percent = 0.0;
        gearbox.seed = seed;
        for (wheel, teeth) in gearbox.wheels.iter_mut().zip([32, 80, 48, 64]) {
            (wheel.teeth, wheel.iso_class) = (teeth, 4);
        }
        if let Some(shafts) = gearbox.structure.shafts_mut() {
            shafts.shafts.iter_mut().for_each(|shaft| shaft.radius_mm = Some(15.0));
        }
        set_modes(&mut gearbox, HousingModes { seed, ..HousingModes::default() });
        (gearbox.operation.pinion_speed_hz, gearbox.operation.brake_torque_nm) = (INPUT_HZ, torque_nm);
        let ripple = |(shaft, order, amplitude): (&str, f64, f64)| Ripple {
            shaft: Some(shaft.to_owned()),
            order,
            amplitude,
            phase_deg: 0.0,
        };
        let of_shafts = [("input", 3.0, ripples[0]), ("middle", 1.0, ripples[1])];
        gearbox.operation.torque_ripple = of_shafts.into_iter().filter(|of| of.2 > 0.0).map(ripple).collect();
        gearbox.sensors = ["input:0", "middle:0", "middle:1", "output:1"].map(Sensor::at_place).to_vec();
        gearbox.solver.sampling_rate_hz = 51_200.0;
        gearbox.solver.pinion_revolutions = Some(REVOLUTIONS as f64);
        gearbox.solver.duration_s = None;
        let channels = simulate(gearbox)?.channels;
        let step_hz = INPUT_HZ / REVOLUTIONS as f64;
        for signal in channels.signals.iter().filter(|signal| signal.unit == "g") {
            all.push(features(&signal.values, step_hz));
        }
    }
    let median = |number: usize| {
        let mut values: Vec<f64> = all.iter().map(|features| features[number]).collect();
        values.sort_by(f64::total_cmp);
        (values[(values.len() - 1) / 2] + values[values.len() / 2]) / 2.0
    };
    Ok(Heard {
        line_share: median(0),
        loud_octaves: median(1),
        shape_db: median(2),
        first_harmonic: median(3),
        remainder_at_3: median(4),
        remainder_at_middle: median(5),
        signal_at_middle: median(6),
        kurtosis: median(7),
        remainder_rms: median(8),
    })
}

/// The features of one signal over whole revolutions of the input, as a recorder at 12.8 kS/s hears it.
fn features(signal: &[f64], step_hz: f64) -> [f64; 9] {
    const HIGHEST_HZ: f64 = 6.4e3;
    const INPUT_HZ: f64 = 29.75;
    let mut spectrum = meshtone_fourier::real_spectrum(signal);
    let length = signal.len();
    for (line, value) in spectrum.iter_mut().enumerate() {
        if line == 0 || line as f64 * step_hz > HIGHEST_HZ {
            *value *= 0.0;
        }
    }
    let power =
        |lines: &mut dyn Iterator<Item = usize>| lines.map(|line| spectrum[line].norm_sqr()).sum::<f64>();
    let whole = power(&mut (0..spectrum.len()));
    let per_tenth = (INPUT_HZ / 10.0 / step_hz).round() as usize;
    let lines = power(&mut (0..spectrum.len()).step_by(per_tenth));
    let octave_db = |centre_hz: f64| {
        let edge = 2f64.powf(1.0 / 6.0);
        let [from, to] = [centre_hz / edge, centre_hz * edge].map(|hz| (hz / step_hz).round() as usize);
        10.0 * (power(&mut (from..to)) / whole).log10()
    };
    let octaves: Vec<f64> =
        (0..16).map(|n| octave_db(1000.0 * 2f64.powf((f64::from(n) - 7.0) / 3.0))).collect();
    let loudest = octaves.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut off: Vec<f64> = RECORDED_DB.iter().map(|[hz, db]| (octave_db(*hz) - db).abs()).collect();
    off.sort_by(f64::total_cmp);
    let first = spectrum[(32.0 * INPUT_HZ / step_hz).round() as usize].norm_sqr();
    let in_time = |is_kept: &dyn Fn(usize) -> bool| {
        let kept = spectrum
            .iter()
            .enumerate()
            .map(|(line, value)| if is_kept(line) { *value } else { *value * 0.0 });
        meshtone_fourier::from_real_spectrum(kept.collect(), length)
    };
    let [signal, remainder] = [in_time(&|_| true), in_time(&|line| line % per_tenth != 0)];
    let modulation = |signal: &[f64], order: f64| {
        let powers: Vec<f64> = signal.iter().map(|value| value * value).collect();
        let spectrum = meshtone_fourier::real_spectrum(&powers);
        2.0 * spectrum[(order * INPUT_HZ / step_hz).round() as usize].norm() / spectrum[0].norm()
    };
    let moment = |power: i32| signal.iter().map(|value| value.powi(power)).sum::<f64>() / length as f64;
    // One line in so many is at a multiple, and has its share of the remainder.
    let by_chance = 1.0 / per_tenth as f64;
    [
        (lines / whole - by_chance) / (1.0 - by_chance),
        octaves.iter().filter(|db| **db > loudest - 10.0).count() as f64,
        (off[4] + off[5]) / 2.0,
        (first / whole).sqrt().ln(),
        modulation(&remainder, 3.0),
        modulation(&remainder, 0.4),
        modulation(&signal, 0.4),
        moment(4) / moment(2).powi(2),
        (remainder.iter().map(|value| value * value).sum::<f64>() / length as f64).sqrt(),
    ]
}

/// One housing: the quick test beside the medians over several.
#[test]
fn one_gearbox_sounds_like_a_recorded_one() {
    let heard = heard(60.0, [0.8, 0.0], 1..2).unwrap();
    println!("{heard:?}");
    assert!(
        (0.3..0.8).contains(&heard.line_share) && heard.loud_octaves >= 5.0 && heard.shape_db < 5.0,
        "{heard:?}"
    );
    assert!((-3.0..-1.0).contains(&heard.first_harmonic) && heard.kurtosis > 3.0, "{heard:?}");
    assert!((0.3..0.9).contains(&heard.remainder_at_3), "{heard:?}");
}

#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn gearboxes_sound_like_a_recorded_one() {
    let sets = [1..5, 11..15, 21..25].map(|housings| {
        let one = heard(60.0, [0.8, 0.0], housings.clone()).unwrap();
        let two = heard(60.0, [0.8, 0.4], housings.clone()).unwrap();
        let more = heard(90.0, [0.8, 0.0], housings.clone()).unwrap();
        println!("housings {housings:?}\none ripple {one:?}\ntwo {two:?}\ntorque x 1.5 {more:?}");
        let power = |of: &Heard| of.remainder_rms.powi(2) * of.line_share / (1.0 - of.line_share);
        println!("lines: torque to the power {:.2}", (power(&more) / power(&one)).ln() / 1.5f64.ln());
        assert!((1.4..1.7).contains(&(power(&more) / power(&one))));
        (one, two, more)
    });
    for (one, two, more) in sets {
        // Aimed at by the recordings: below 3 dB, from −2.5 to −1.5, and with both ripples at least 4 and 0.2 to 0.4. The Validation page says how
        // far that is met, and why.
        assert!((0.35..0.67).contains(&one.line_share) && (6.0..=9.0).contains(&one.loud_octaves));
        assert!(one.shape_db < 3.5 && (-2.5..-1.3).contains(&one.first_harmonic));
        assert!((0.4..0.8).contains(&one.remainder_at_3) && one.kurtosis > 3.2 && two.kurtosis > 3.5);
        assert!(two.signal_at_middle > 0.2 && (0.2..0.6).contains(&two.remainder_at_middle));
        assert!((1.0..1.3).contains(&(more.remainder_rms / one.remainder_rms)));
    }
}

/// The speed wanders by what is stated, slowly, as a longer simulation with the same seed does from its start on; before the kept signal it does not.
#[test]
fn speed_wanders_slowly_by_what_is_stated() {
    let relative = |duration_s: f64, seed: u64| -> Vec<f64> {
        let mut gearbox = bare().unwrap();
        gearbox.solver.sampling_rate_hz = 12_800.0;
        gearbox.solver.duration_s = Some(duration_s);
        gearbox.seed = seed;
        gearbox.operation.speed_wander_percent = 0.03;
        let stages = meshtone::stages(gearbox).unwrap();
        let first = stages.time.first_kept_sample;
        let all: Vec<f64> =
            stages.motion().map(|sample| sample.speed_hz / 30.0 - 1.0).take(stages.time.samples).collect();
        assert!(all[..=first].iter().all(|value| *value == all[0]));
        all[first..].to_vec()
    };
    let long = relative(120.0, 7);
    let deviation = (long.iter().map(|value| value * value).sum::<f64>() / long.len() as f64).sqrt();
    println!("standard deviation {:.4} %", 100.0 * deviation);
    // 120 s are some 380 times the correlation's 0.32 s.
    assert!((deviation / 3e-4 - 1.0).abs() < 0.12, "{deviation}");
    // Differences over a sixteenth of a second, with a = exp(−2π/16): √(2 (1 − a)) = 0.81 of the deviation between points, and √(1 − a) = 0.57
    // between the middles of the straight lines.
    let step = (12_800.0f64 / 16.0) as usize;
    let changes: Vec<f64> =
        long.iter().step_by(step).zip(long.iter().step_by(step).skip(1)).map(|(a, b)| b - a).collect();
    let change = (changes.iter().map(|value| value * value).sum::<f64>() / changes.len() as f64).sqrt();
    assert!((0.57..0.81).contains(&(change / deviation)), "{}", change / deviation);
    let short = relative(2.0, 7);
    assert_eq!(short[..], long[..short.len()]);
    assert_ne!(relative(2.0, 8)[..], short[..]);
}

/// A helix slope that turns with an ideal wheel shortens what bears of its teeth at both ends alike, so that the mesh's harmonics get sidebands at twice the
/// wheel's order; beside a slope that stays, at its order too. A slope that takes back the lean of the shafts makes the rest of the face even.
#[test]
fn helix_that_wobbles_makes_sidebands_of_its_wheel() {
    let sidebands = |wobble_um: f64, slope_um: f64| {
        let mut gearbox = bare().unwrap();
        gearbox.solver.discard_and_keep(0.2, 1.0);
        gearbox.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 0);
        gearbox.wheels[0].helix_wobble_um = wobble_um;
        let lean_um = stages(&gearbox).unwrap().meshes[0].along_face.lean_m * 1e6;
        gearbox.wheels[0].deviations.helix_slope_um = Some(slope_um - lean_um);
        let channels = simulate(gearbox).unwrap().channels;
        let spectrum = meshtone_fourier::real_spectrum(&channels["force_n.z1-z2"]);
        // 1 Hz a line: 32 teeth at 30 rev/s.
        [0, 30, 60].map(|apart| spectrum[960 + apart].norm() / spectrum[960].norm())
    };
    let [_, first, second] = sidebands(20.0, 0.0);
    assert!(second > 0.1 && first < 0.1 * second, "{first} {second}");
    let [_, first, second] = sidebands(20.0, 10.0);
    assert!(first > 0.1 && second > 0.01, "{first} {second}");
    let [_, first, second] = sidebands(0.0, 0.0);
    assert!(first < 1e-3 && second < 1e-3, "{first} {second}");
}

/// In a spectrum over time lines of high orders lose their energy to the wander of the speed; over angle they keep it.
#[test]
fn high_orders_smear_over_time_and_not_over_angle() {
    let mut gearbox = bare().unwrap();
    gearbox.solver.discard_and_keep(0.3, 4.0);
    gearbox.sensors = vec![Sensor::at_place("input:0")];
    let mut kept = |wander_percent: f64| {
        gearbox.operation.speed_wander_percent = wander_percent;
        let simulation = simulate(&gearbox).unwrap();
        let stages = &simulation.stages;
        let motion: Vec<f64> = stages
            .motion()
            .skip(stages.time.first_kept_sample)
            .map(|of| of.revolutions)
            .take(simulation.channels.len())
            .collect();
        let signal = &simulation.channels.signals[0].values;
        let rate_hz = simulation.channels.sampling_rate_hz;
        // The fifth harmonic of the first mesh, with the phase of a constant speed and with that of the motor.
        let line = |revolutions: &dyn Fn(usize) -> f64| {
            let sum: Complex<f64> = signal
                .iter()
                .enumerate()
                .map(|(n, value)| Complex::from_polar(*value, -TAU * 160.0 * revolutions(n)))
                .sum();
            2.0 * sum.norm() / signal.len() as f64
        };
        [line(&|n| n as f64 * 30.0 / rate_hz), line(&|n| motion[n])]
    };
    let [[steady, same], [over_time, over_angle]] = [kept(0.0), kept(0.06)];
    println!("{steady:.4} {same:.4} g; wandering {over_time:.4}, {over_angle:.4} g");
    assert!((same / steady - 1.0).abs() < 1e-6);
    assert!(over_time < 0.7 * steady && (over_angle / steady - 1.0).abs() < 0.1);
}
