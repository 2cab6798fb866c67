//! Rolling bearings with spalls in a gearbox, unbalance and bent shafts.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;

use crate::plain::{even, plain};
use meshtone::machine::Axis;
use meshtone::scenario::*;
use meshtone::sensor::GRAVITY_M_PER_S2;
use meshtone::signal::{FrequencyBand, ShaftPhase, squared_envelope, squared_envelope_order_spectrum};
use meshtone::{Simulation, stages};
use nalgebra::{Complex, DMatrix, DVector};

/// A rig with teeth without deviations, whose first bearing, at the input, is a ball bearing.
fn rig(rig: GearboxRig, bearing: &str) -> Scenario {
    let mut gearbox = plain(template(rig, bearing));
    gearbox.solver.sampling_rate_hz = 100_000.0;
    gearbox.solver.discard_and_keep(0.2, 1.0);
    gearbox.operation.pinion_speed_hz = 30.0;
    gearbox.sensors.clear();
    gearbox
}

fn template(rig: GearboxRig, bearing: &str) -> Scenario {
    let text = gearbox_template(Some(rig)).replace("iso_class = 5", "iso_class = 0");
    let first = format!("[[bearing]]\nkind = \"ball\"\nname = \"ER-10K\"\n{bearing}\n");
    Scenario::from_toml(&text.replacen("[[bearing]]\n", &first, 1)).unwrap()
}

fn simulate(gearbox: &Scenario) -> Simulation {
    meshtone::simulate(gearbox).unwrap()
}

/// (m/s²) Acceleration of the seat of the first bearing.
fn seat(simulation: &Simulation) -> Vec<f64> {
    let signal = simulation.channels.signals.iter().find(|signal| signal.unit == "g").unwrap();
    signal.values.iter().map(|value| value * GRAVITY_M_PER_S2).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

fn seat_rms(gearbox: &Scenario) -> f64 {
    rms(&seat(&simulate(gearbox)))
}

const OUTER: &str = "defect = [{ race = \"outer\", width_mm = 1.0 }]";
const INNER: &str = "defect = [{ race = \"inner\", width_mm = 1.0 }]";
const ELEMENT: &str = "defect = [{ race = \"element\", width_mm = 1.0 }]";

/// Figures of an independent solution with the bearing's two unknowns, of other draws of the deviations: 24.55, 12.31, 11.62 m/s² with helical
/// teeth and 24.2 with spur teeth. A linearised bearing would have 11.03, 4.75, 4.47 and 15.6.
#[test]
fn spalls_shake_the_seat_as_in_an_independent_solution() {
    for (of_rig, defect, expected) in [
        (GearboxRig::Phm2009Helical, OUTER, 24.55),
        (GearboxRig::Phm2009Helical, INNER, 12.31),
        (GearboxRig::Phm2009Helical, ELEMENT, 11.62),
        (GearboxRig::Phm2009Spur, OUTER, 24.2),
    ] {
        let mut gearbox = even(rig(of_rig, defect));
        gearbox.solver.discard_and_keep(0.2, 0.5);
        let found = seat_rms(&gearbox);
        println!("{} {defect}: {found:.2} m/s², {expected}", of_rig.name());
        assert!((found / expected - 1.0).abs() < 0.15);
    }
    let load_n = stages(rig(GearboxRig::Phm2009Helical, "")).unwrap().bearings[0].1.static_load_n;
    assert!((load_n[0].hypot(load_n[1]) - 124.7).abs() < 0.1, "{load_n:?}");
    // A shaft that may slide along itself has the same loads across it.
    let mut sliding = rig(GearboxRig::Phm2009Spur, "");
    let held_n = stages(&sliding).unwrap().bearings[0].1.static_load_n;
    sliding.bearings_mut().iter_mut().for_each(|bearing| bearing.axial_stiffness_n_per_m = Some(0.0));
    let sliding_n = stages(&sliding).unwrap().bearings[0].1.static_load_n;
    assert!(held_n.iter().zip(sliding_n).all(|(held, sliding)| (held - sliding).abs() < 1e-4 * held.abs()));
}

/// Largest line of the squared envelope spectrum within 0.04 orders of a place, over the median of the lines below 8 orders.
fn line(spectrum: &[f64], step: f64, order: f64) -> f64 {
    let mut low: Vec<f64> = spectrum[..(8.0 / step) as usize].to_vec();
    low.sort_by(f64::total_cmp);
    let near = ((order - 0.04) / step).round() as usize..=((order + 0.04) / step).round() as usize;
    spectrum[near].iter().copied().fold(0.0, f64::max) / low[low.len() / 2]
}

fn envelope_orders(gearbox: &Scenario) -> impl Fn(f64) -> f64 + use<> {
    let simulation = simulate(gearbox);
    let rate_hz = simulation.channels.sampling_rate_hz;
    let signal = seat(&simulation);
    let phase = ShaftPhase::constant(gearbox.operation.pinion_speed_hz, rate_hz, signal.len()).unwrap();
    let band = FrequencyBand { from_hz: 2000.0, to_hz: 9000.0 };
    let spectrum = squared_envelope_order_spectrum(&signal, rate_hz, Some(band), &phase).unwrap();
    move |order| line(&spectrum.amplitudes, spectrum.step, order)
}

/// BPFO has no sidebands of the shaft, BPFI has them, and 2 BSF has sidebands of the cage: 3.05231, 4.94769, 3.98388 and 0.38154 orders.
#[test]
fn envelopes_have_the_lines_of_the_defect() {
    let without_slip = |defect: &str| {
        let mut gearbox = rig(GearboxRig::Phm2009Helical, &format!("slip_percent = 0.0\n{defect}"));
        gearbox.solver.discard_and_keep(0.2, 2.0);
        envelope_orders(&gearbox)
    };
    let outer = without_slip(OUTER);
    println!("outer {:.0} {:.0} {:.0} {:.0}", outer(3.05231), outer(6.10462), outer(2.05231), outer(4.05231));
    assert!(outer(3.05231) > 30.0 && outer(6.10462) > 20.0);
    assert!(outer(2.05231).max(outer(4.05231)) < 0.1 * outer(3.05231));
    let inner = without_slip(INNER);
    println!("inner {:.0} {:.0} {:.0} {:.0}", inner(1.0), inner(3.94769), inner(4.94769), inner(5.94769));
    assert!(inner(4.94769) > 30.0 && inner(3.94769).min(inner(5.94769)) > 0.3 * inner(4.94769));
    let element = without_slip(ELEMENT);
    let [below, middle, above, twice_cage] =
        [3.98388 - 0.38154, 3.98388, 3.98388 + 0.38154, 2.0 * 0.38154].map(element);
    println!("element {below:.0} {middle:.0} {above:.0} {twice_cage:.0}");
    assert!(below.min(above) > 10.0 && twice_cage > 10.0);
}

#[test]
fn halving_the_step_changes_the_rms_by_less_than_two_percent() {
    let at = |rate_hz: f64| {
        let mut gearbox = rig(GearboxRig::Phm2009Helical, OUTER);
        gearbox.solver.sampling_rate_hz = rate_hz;
        gearbox.solver.discard_and_keep(0.2, 0.5);
        seat_rms(&gearbox)
    };
    let [once, twice, four_times] = [100_000.0, 200_000.0, 400_000.0].map(at);
    println!("{once:.3} {twice:.3} {four_times:.3}");
    assert!((once / four_times - 1.0).abs() < 0.02 && (twice / four_times - 1.0).abs() < 0.01);
}

/// Sum of the squared envelope in a band over the passes of the elements.
fn mean_pass(signal: &[f64], rate_hz: f64, band: FrequencyBand) -> Vec<f64> {
    let squares = squared_envelope(signal, rate_hz, Some(band)).unwrap();
    let pass = rate_hz / (30.0 * 3.05231);
    let bins = pass as usize;
    let mut mean = vec![0.0; bins];
    for (k, square) in squares.iter().enumerate() {
        mean[((k as f64 / pass).fract() * bins as f64) as usize % bins] += square;
    }
    mean
}

fn largest(of: &[f64]) -> usize {
    (0..of.len()).max_by(|&a, &b| of[a].total_cmp(&of[b])).unwrap()
}

/// A spall of 6 mm and 20 µm on the outer race: the bursts of entry and exit are as far apart as an element takes from edge to edge.
#[test]
fn wide_spalls_make_double_pulses() {
    let defect = "slip_percent = 0.0\ndefect = [{ race = \"outer\", width_mm = 6.0, depth_um = 20.0 }]";
    let gearbox = rig(GearboxRig::Phm2009Helical, defect);
    let simulation = simulate(&gearbox);
    let rate_hz = simulation.channels.sampling_rate_hz;
    let band = FrequencyBand { from_hz: 1000.0, to_hz: 9000.0 };
    let mean = mean_pass(&seat(&simulation), rate_hz, band);
    let bins = mean.len();
    let first = largest(&mean);
    let apart = |bin: usize| (bin + bins - first) % bins;
    // The second burst: the largest bin farther from the first than an eighth of a pass.
    let far: Vec<f64> = (0..bins)
        .map(|bin| if (bins / 8..bins - bins / 8).contains(&apart(bin)) { mean[bin] } else { 0.0 })
        .collect();
    let second = apart(largest(&far)).min(bins - apart(largest(&far)));
    // The edges are 6 mm apart on the outer race, of radius (33.5026 + 7.9375)/2 mm; half-way over each edge, 0.2 mm nearer.
    let speed_mm_per_s = 0.38154 * TAU * 30.0 * (33.5026 + 7.9375) / 2.0;
    let expected_s = 6.0 / speed_mm_per_s;
    println!("{:.3} ms, {:.3} ms", second as f64 / rate_hz * 1e3, expected_s * 1e3);
    assert!((second as f64 / rate_hz / expected_s - 1.0).abs() < 0.15);
}

/// A ball that has lost the ring flies over a deep spall, and what it strikes where detectors look is the far edge, half of the width after it
/// was unloaded: not the ring that presses it again at the end.
#[test]
fn the_strong_pulse_of_a_deep_spall_comes_half_of_its_width_after_entry() {
    for width_mm in [2.0, 3.0] {
        let defect = format!(
            "slip_percent = 0.0\ndefect = [{{ race = \"outer\", width_mm = {width_mm:?}, depth_um = 1000.0 }}]"
        );
        // On shafts that a machine has, without what would cover the pulses.
        let steady = rig(GearboxRig::Phm2009Helical, &defect);
        let mut gearbox = template(GearboxRig::Phm2009Helical, &defect);
        gearbox.meshes.iter_mut().for_each(|mesh| (mesh.friction, mesh.random_force) = (0.0, 0.0));
        (gearbox.solver, gearbox.operation, gearbox.sensors) =
            (steady.solver, steady.operation, steady.sensors);
        if let Some(housing) = &mut gearbox.structure.shafts_mut().unwrap().housing {
            housing.modes = HousingModes::RIGID;
        }
        gearbox.operation.brake_torque_nm = 80.0;
        let simulation = simulate(&gearbox);
        let rate_hz = simulation.channels.sampling_rate_hz;
        let mean = mean_pass(&seat(&simulation), rate_hz, FrequencyBand { from_hz: 8000.0, to_hz: 16_000.0 });
        let strong = largest(&mean);
        // The entry: the largest before it, within a width, that is no part of its own rise.
        let speed_mm_per_s = 0.38154 * TAU * 30.0 * (33.5026 + 7.9375) / 2.0;
        let width = width_mm / speed_mm_per_s * rate_hz;
        let before = |part: f64| mean[(strong + mean.len() - (part * width) as usize) % mean.len()];
        let parts: Vec<f64> = (30..100).map(|percent| f64::from(percent) / 100.0).collect();
        let entry = parts.iter().copied().max_by(|a, b| before(*a).total_cmp(&before(*b))).unwrap();
        println!("{width_mm} mm: {entry:.2} of the width, {:.3} of the power", before(entry) / mean[strong]);
        assert!((entry - 0.5).abs() <= 0.05);
    }
}

/// A bearing with neither clearance nor a defect has the natural frequencies of a linear one of its stiffness.
#[test]
fn a_sound_bearing_has_the_frequencies_of_a_linear_one() {
    let stages = stages(rig(GearboxRig::Phm2009Helical, "clearance_um = 0.0")).unwrap();
    let [[xx, _], [_, yy]] = stages.bearings[0].1.spring_n_per_m;
    let linear = |stiffness: f64| {
        let mut gearbox = rig(GearboxRig::Phm2009Helical, "");
        gearbox.bearings_mut()[0] = Bearing::new("input", 0.0);
        gearbox.bearings_mut()[0].stiffness_n_per_m = stiffness;
        meshtone::stages(&gearbox).unwrap().natural_frequencies_hz()
    };
    let [softer, stiffer] = [linear(xx.min(yy) * 0.5), linear(xx.max(yy) * 2.0)];
    let found = stages.natural_frequencies_hz();
    for mode in 1..20 {
        assert!(
            (softer[mode]..=stiffer[mode] * (1.0 + 1e-9)).contains(&found[mode]),
            "{mode}: {}",
            found[mode]
        );
    }
    assert!((found[10] / linear((xx + yy) / 2.0)[10] - 1.0).abs() < 0.02);
}

#[test]
fn rollers_bear_the_load_too() {
    let text = "kind = \"roller\"\nelements = 13\nelement_mm = 7.5\npitch_mm = 38.5\nroller_length_mm = 9.0\n\
                defect = [{ race = \"outer\", severity = 0.1 }]";
    let mut gearbox = rig(GearboxRig::Phm2009Helical, "");
    let toml = gearbox.to_toml().replacen("kind = \"ball\"\nname = \"ER-10K\"", text, 1);
    gearbox = Scenario::from_toml(&toml).unwrap();
    let simulation = simulate(&gearbox);
    let found = rms(&seat(&simulation));
    let sound = seat_rms(&rig(GearboxRig::Phm2009Helical, ""));
    assert!(found > 1.25 * sound, "{found} {sound}");
    assert_eq!(Scenario::from_toml(&gearbox.to_toml()).unwrap(), gearbox);
}

#[test]
fn the_same_seed_slips_alike_and_another_one_does_not() {
    let of_seed = |seed: u64| {
        let mut gearbox = rig(GearboxRig::Phm2009Spur, OUTER);
        (gearbox.seed, gearbox.solver.duration_s) = (seed, Some(0.1));
        seat(&simulate(&gearbox))
    };
    assert_eq!(of_seed(1), of_seed(1));
    assert_ne!(of_seed(1), of_seed(2));
}

#[test]
fn impossible_bearings_say_what_is_allowed() {
    let refused = |bearing: &str| {
        let text = gearbox_template(None).replacen("[[bearing]]\n", &format!("[[bearing]]\n{bearing}\n"), 1);
        Scenario::from_toml(&text).unwrap_err()
    };
    for (bearing, key, words) in [
        ("kind = \"ball\"", "bearing[0].elements", "missing"),
        ("kind = \"ball\"\nname = \"6999\"", "bearing[0].name", "must be one of 6203, 6205"),
        ("kind = \"roller\"\nname = \"6205\"", "bearing[0].name", "is a ball bearing"),
        ("kind = \"roller\"\nname = \"6999\"", "bearing[0].name", "no roller bearing is known by a name"),
        ("kind = \"roller\"\nname = \"ZA-2115\"", "bearing[0].name", "only cylindrical rollers"),
        ("kind = \"ball\"\nname = \"6205\"\nelements = 9", "bearing[0].elements", "beside name"),
        ("name = \"6205\"", "bearing[0].name", "linear"),
        ("kind = \"ball\"\nname = \"6205\"\npreload_n = 50.0", "bearing[0].preload_n", "contact angle"),
        (
            "kind = \"ball\"\nelements = 9\nelement_mm = 39.04\npitch_mm = 7.94",
            "bearing[0].element_mm",
            "room",
        ),
        (
            "kind = \"ball\"\nname = \"6205\"\ndefect = [{ race = \"outer\" }]",
            "bearing[0].defect[0].width_mm",
            "missing",
        ),
        (
            "kind = \"ball\"\nname = \"6205\"\ndefect = [{ race = \"outer\", width_mm = 9.0 }]",
            "bearing[0].defect[0].width_mm",
            "at most 7.94 mm",
        ),
        ("kind = \"ball\"\nname = \"6205\"\nslip_percent = 5.0", "bearing[0].slip_percent", "2"),
    ] {
        let error = refused(bearing);
        assert!(error.key == key && error.problem.contains(words), "{bearing}: {error}");
        assert!(error.line.is_some(), "{bearing}: {error}");
    }
}

/// (m/s²) Amplitude of the first order of a shaft in the seat's signal, over whole revolutions.
fn first_order(simulation: &Simulation, speed_hz: f64) -> f64 {
    let signal = seat(simulation);
    let rate_hz = simulation.channels.sampling_rate_hz;
    let turn = |k: usize| TAU * speed_hz * k as f64 / rate_hz;
    let part = |of: fn(f64) -> f64| {
        signal.iter().enumerate().map(|(k, value)| value * of(turn(k))).sum::<f64>() * 2.0
            / signal.len() as f64
    };
    part(f64::cos).hypot(part(f64::sin))
}

/// What turns with a shaft shakes its middle as the machine with meshes of constant stiffness does at that frequency.
#[test]
fn unbalance_and_bent_shafts_shake_as_the_frequency_response_says() {
    let gearbox = |change: fn(&mut Scenario)| {
        let text =
            gearbox_template(Some(GearboxRig::Phm2009Helical)).replace("iso_class = 5", "iso_class = 0");
        let mut gearbox = plain(Scenario::from_toml(&text).unwrap());
        gearbox.sensors = vec![Sensor::at_place("shaft:input:0.5")];
        // Whole revolutions.
        gearbox.solver.discard_and_keep(0.3, 0.4);
        change(&mut gearbox);
        gearbox
    };
    let unbalanced: fn(&mut Scenario) = |gearbox| {
        gearbox.wheels[0].unbalance = Unbalance { g_mm: 300.0, angle_deg: 40.0 };
    };
    let of_shaft: fn(&mut Scenario) = |gearbox| {
        gearbox.structure.shafts_mut().unwrap().shafts[0].unbalance =
            Unbalance { g_mm: 300.0, angle_deg: -70.0 };
    };
    let bent: fn(&mut Scenario) = |gearbox| {
        gearbox.structure.shafts_mut().unwrap().shafts[0].bow = Bow { middle_um: 20.0, angle_deg: 10.0 }
    };
    for (name, change) in [("wheel", unbalanced), ("shaft", of_shaft), ("bent", bent)] {
        let gearbox = gearbox(change);
        let stages = stages(&gearbox).unwrap();
        let (machine, modes) = stages.machine_and_modes().unwrap();
        let omega = TAU * gearbox.operation.pinion_speed_hz;
        let complex = |matrix: DMatrix<f64>| matrix.map(|value| Complex::new(value, 0.0));
        let free = machine.closed_stiffness(&stages.mean_stiffness_n_per_m());
        let tilts = machine.lines.iter().zip(&stages.meshes).map(|(line, mesh)| {
            let [width_m, _] = mesh.two_unknowns().unwrap_or_default();
            &line.per_m * line.per_m.transpose() * (mesh.mean_stiffness_n_per_m * width_m * width_m / 12.0)
        });
        let held = tilts.fold(free.clone(), |sum, tilt| sum + tilt);
        let [force] = &machine.turning_forces[..] else { panic!("one force") };
        let factor = if force.of_square_speed { omega * omega } else { 1.0 };
        let force = DVector::from_fn(force.at[0].len(), |n, _| {
            Complex::new(force.at[0][n], -force.at[1][n]) * factor
        });
        let place = stages.sensors[0].name();
        let weights = machine.weights(&place, Axis::Y).map(|weight| Complex::new(weight, 0.0));
        let response = |closed: &DMatrix<f64>| {
            let dynamic = complex(closed.clone())
                - complex(machine.mass.clone()) * Complex::new(omega * omega, 0.0)
                + complex(modes.damping_matrix(machine)) * Complex::new(0.0, omega);
            let displacement = dynamic.lu().solve(&force).unwrap();
            weights.dot(&displacement).norm() * omega * omega
        };
        // A face of which a part bears holds the wheels' tilt more than none does, and less than the whole.
        let expected = [response(&held), response(&free)];
        let found = first_order(&simulate(&gearbox), gearbox.operation.pinion_speed_hz);
        println!("{name}: {found:.5} m/s², {expected:.5?}");
        assert!(0.95 * expected[0] < found && found < 1.05 * expected[1]);
    }
}

/// In the short form likewise: the supports of a pair move with the unbalance of the pinion, in proportion to it.
#[test]
fn unbalance_of_a_pair_shakes_its_supports() {
    let first_order_g = |g_mm: f64| {
        let mut scenario = Scenario::new(GearPair::example());
        scenario.wheels[0].unbalance = Unbalance { g_mm, angle_deg: 0.0 };
        let channels = meshtone::simulate(&scenario).unwrap().channels;
        let turn = |k: usize| TAU * scenario.operation.pinion_speed_hz * k as f64 / channels.sampling_rate_hz;
        let part = |of: fn(f64) -> f64| {
            channels["vertical_g"].iter().enumerate().map(|(k, value)| value * of(turn(k))).sum::<f64>() * 2.0
                / channels["vertical_g"].len() as f64
        };
        part(f64::cos).hypot(part(f64::sin))
    };
    let [none, once, twice] = [0.0, 500.0, 1000.0].map(first_order_g);
    println!("{none} {once} {twice}");
    assert!(once > 100.0 * none && (twice / once - 2.0).abs() < 0.02);
}
