//! Load that is carried by a part of the face: the time loop has two unknowns, with what of the face touches in closed form; here, in a solver of its own, every slice of the face of every pair touches or does not, with the wheels' tilt.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::dense::machine_of;
use crate::physics::*;
use meshtone::machine::{Axis, Drive, SUPPORTS};
use meshtone::mesh::Mesh;
use meshtone::scenario::*;
use meshtone::{Stages, simulate};
use nalgebra::{DVector, Matrix2, Vector2};

/// Slices of the face width: where damage takes a part of it, and where an end of it bears.
const SLICES: usize = 15;
const SLICES_OF_AN_END: usize = 60;
/// Pairs that can touch at once.
const PAIRS: i64 = 3;

/// A slice of a pair at one instant.
struct Slice {
    stiffness: f64,
    /// (m) Along the face.
    z: f64,
    separation: f64,
}

/// A face in slices.
struct Face {
    slices: usize,
    /// (-) How much closer together the flanks are per length of face.
    slope: f64,
    /// (s) Damping of a contact over its stiffness.
    damping_time_s: f64,
}

/// The slices that carry, of all pairs at a sample. The stiffness of what is left of a pair's face is spread over it.
fn slices(mesh: &Mesh, face: &Face, width_m: f64, sample: usize) -> Vec<Slice> {
    let point = sample + mesh.points_before;
    let (latest, since) = ((point / mesh.points_per_pitch) as i64, point % mesh.points_per_pitch);
    let mut all = Vec::new();
    for age in 0..PAIRS {
        let class = mesh.sequence.class(latest - age);
        let Some(state) = mesh.classes[class].states.get(since + age as usize * mesh.points_per_pitch) else {
            continue;
        };
        if state.stiffness_n_per_m == 0.0 {
            continue;
        }
        // The load's middle tells how much is missing from the end at positive z.
        let left = width_m + 2.0 * state.face_centre_m;
        for n in 0..face.slices {
            let z = -width_m / 2.0 + left * (n as f64 + 0.5) / face.slices as f64;
            all.push(Slice {
                stiffness: state.stiffness_n_per_m / face.slices as f64,
                z,
                separation: state.separation_m - face.slope * z,
            });
        }
    }
    all
}

/// (m) Deflection at which slices carry a force.
fn at_rest(all: &[Slice], force: f64) -> f64 {
    let carried = |deflection: f64| {
        all.iter().map(|slice| slice.stiffness * (deflection - slice.separation).max(0.0)).sum::<f64>()
    };
    let (mut low, mut high) = (-1e-3, 1e-3);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if carried(middle) < force { low = middle } else { high = middle }
    }
    high
}

/// (m/s²) Mean vertical acceleration of both supports.
fn by_slices(stages: &Stages, face: &Face, samples: usize) -> Vec<f64> {
    let (machine, modes) = machine_of(stages);
    let mesh = mesh(stages);
    let width_m = stages.pairs[0].teeth.gear.face_width_mm * 1e-3;
    let (n, h) = (machine.coordinates(), stages.time.step_s() / 2.0);
    let omega2 = DVector::from_fn(n, |m, _| modes.angular_frequencies[m].powi(2));
    let damping = DVector::from_fn(n, |m, _| modes.damping_per_s(m));
    let line = &machine.lines[0];
    let lines = [&line.at_middle, &line.per_m].map(|line| modes.shapes.transpose() * line);
    let e = DVector::from_fn(n, |m, _| 1.0 / (1.0 + h * damping[m] + h * h * omega2[m]));
    let tau = face.damping_time_s;
    let lead = 1.0 + tau / h;
    let gamma =
        Matrix2::from_fn(|r, c| lead * h * h * (0..n).map(|m| lines[r][m] * e[m] * lines[c][m]).sum::<f64>());
    let force = stages.static_force_n();
    let torque = stages.scenario.operation.brake_torque_nm;
    let Drive::Brake { coordinate, .. } = machine.drives[1] else { panic!("no brake") };
    let brake = modes.shapes.row(coordinate).transpose() * torque;
    let steady = DVector::from_fn(n, |m, _| {
        if omega2[m] == 0.0 { 0.0 } else { (brake[m] - lines[0][m] * force) / omega2[m] }
    });
    let of_static = Vector2::new(lines[0].dot(&steady), lines[1].dot(&steady));
    let row = modes.shapes.transpose() * machine.turn.transpose() * machine.weights(SUPPORTS, Axis::Y);
    let solve = |all: &[Slice], rates: &[f64], free: Vector2<f64>| -> Vector2<f64> {
        let offset = |i: usize| -all[i].separation + tau * rates[i];
        let load = free + gamma * Vector2::new(force, 0.0);
        let mut touching = vec![true; all.len()];
        let mut forces = Vector2::<f64>::zeros();
        for _ in 0..60 {
            let (mut stiffness, mut constant) = (Matrix2::<f64>::zeros(), Vector2::<f64>::zeros());
            for (i, slice) in all.iter().enumerate().filter(|(i, _)| touching[*i]) {
                let arm = Vector2::new(1.0, slice.z);
                stiffness += arm * arm.transpose() * slice.stiffness;
                constant += arm * slice.stiffness * offset(i);
            }
            let deflection =
                (Matrix2::identity() + gamma * stiffness).try_inverse().unwrap() * (load - gamma * constant);
            forces = stiffness * deflection + constant;
            let now: Vec<bool> =
                (0..all.len()).map(|i| deflection[0] + all[i].z * deflection[1] + offset(i) > 0.0).collect();
            if now == touching {
                break;
            }
            touching = now;
        }
        Vector2::new(force - forces[0], -forces[1])
    };
    let (mut q, mut s) = (DVector::<f64>::zeros(n), DVector::<f64>::zeros(n));
    q[0] = (at_rest(&slices(mesh, face, width_m, 0), force) - of_static[0]) / lines[0][0];
    let mut w = Vector2::<f64>::zeros();
    let mut before: Vec<f64> = Vec::new();
    let mut output = Vec::with_capacity(samples);
    for sample in 0..samples {
        let modal = &lines[0] * w[0] + &lines[1] * w[1];
        let acceleration = DVector::from_fn(n, |m, _| modal[m] - omega2[m] * q[m] - damping[m] * s[m] / h);
        output.push(row.dot(&acceleration));
        let all = slices(mesh, face, width_m, sample + 1);
        let separations =
            |slices: &[Slice]| -> Vec<f64> { slices.iter().map(|slice| slice.separation).collect() };
        let (now, after) = (separations(&all), separations(&slices(mesh, face, width_m, sample + 2)));
        let same = now.len() == before.len() && now.len() == after.len();
        // Central differences, over two steps of 2 h.
        let rates: Vec<f64> =
            (0..now.len()).map(|i| if same { (before[i] - after[i]) / (4.0 * h) } else { 0.0 }).collect();
        before = now;
        let change = DVector::from_fn(n, |m, _| {
            e[m] * (2.0 * s[m] - 2.0 * h * h * omega2[m] * q[m] + h * h * modal[m])
        });
        let free = Vector2::from_fn(|r, _| {
            let ahead = &q + &change + (&change - &s) * (tau / h);
            of_static[r] + lines[r].dot(&ahead)
        });
        let next = solve(&all, &rates, free);
        let pushed = &lines[0] * next[0] + &lines[1] * next[1];
        let change = DVector::from_fn(n, |m, _| change[m] + h * h * e[m] * pushed[m]);
        q += &change;
        s = change - s;
        w = next;
    }
    output
}

/// log10 of rms and kurtosis about the mean.
fn indicators(signal: &[f64]) -> [f64; 2] {
    let centre = mean(signal);
    let moment = |order: i32| mean(&signal.iter().map(|v| (v - centre).powi(order)).collect::<Vec<_>>());
    [moment(2).sqrt().log10(), (moment(4) / moment(2).powi(2)).log10()]
}

// A pit over a part of the face, and a broken corner.
#[test]
fn a_part_of_the_face_acts_as_its_slices_do() {
    let pit = PitCircle::Fractions { start: 0.3, end: 0.7, depth: 0.5 };
    let damages: [(&str, f64, Damage); 5] = [
        ("pit over 5 of 15 mm", 10.0, PartialFace { width_mm: 5.0, pit }.into()),
        ("pit over 10 of 15 mm", 10.0, PartialFace { width_mm: 10.0, pit }.into()),
        ("pit over 10 of 15 mm, light", 1.0, PartialFace { width_mm: 10.0, pit }.into()),
        ("pit over 10 of 15 mm, heavy", 100.0, PartialFace { width_mm: 10.0, pit }.into()),
        (
            "corner of 5 x 12 mm",
            10.0,
            ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 2.0 }.into(),
        ),
    ];
    for (name, brake_torque_nm, damage) in damages {
        let mut scenario = Scenario::new(GearPair { brake_torque_nm, ..GearPair::example() });
        with_own_structure(&mut scenario);
        scenario.sensors = vec![mean_of_supports()];
        scenario.model = Model::Contact;
        scenario.solver.settle_fraction = 0.0;
        // The slices are stepped by the average acceleration, which needs short steps.
        scenario.solver.sampling_rate_hz = 2.6e5;
        scenario.faults = vec![Fault::on_first_gear_tooth(damage)];
        let simulation = simulate(&scenario).unwrap();
        let samples = 3 * simulation.stages.time.samples_per_pinion_revolution;
        let mean: Vec<f64> =
            simulation.channels.signals[0].values[..samples].iter().map(|g| g * 9.81).collect();
        let damping_time_s = mesh(&simulation.stages).damping_time_s;
        let face = Face { slices: SLICES, slope: 0.0, damping_time_s };
        let sliced = by_slices(&simulation.stages, &face, samples);
        let difference: Vec<f64> = mean.iter().zip(&sliced).map(|(a, b)| a - b).collect();
        let off = rms(&difference) / rms(&sliced);
        println!(
            "{name}: {:.3} g, by slices {:.3} g, difference {:.2} %",
            rms(&mean) / 9.81,
            rms(&sliced) / 9.81,
            100.0 * off
        );
        let of_rms = rms(&mean) / rms(&sliced) - 1.0;
        println!("{name}: {of_rms:.4} of the rms");
        assert!(of_rms.abs() < 0.005 && off < 0.02, "{name}: {of_rms} {off}");
    }
}

// Flanks that lie closer together towards one end of the face: two unknowns beside slices, which are stepped by the average acceleration.
#[test]
fn an_end_of_the_face_acts_as_its_slices_do() {
    let broken = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 5.0, tip_loss_mm: 3.0 };
    for (misalignment_um, brake_torque_nm, damage) in [
        (1.0, 10.0, None),
        (3.0, 10.0, None),
        (10.0, 10.0, None),
        (10.0, 50.0, None),
        (10.0, 200.0, None),
        (3.0, 10.0, Some(broken)),
        (10.0, 10.0, Some(broken)),
        (-10.0, 10.0, Some(broken)),
        (10.0, 100.0, Some(broken)),
    ] {
        let mut scenario = Scenario::new(GearPair { brake_torque_nm, ..GearPair::example() });
        with_own_structure(&mut scenario);
        scenario.sensors = vec![mean_of_supports()];
        scenario.model = Model::Contact;
        scenario.solver.settle_fraction = 0.0;
        scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
        let aligned = simulate(&scenario).unwrap();
        scenario.meshes[0].misalignment_um = misalignment_um;
        let leaning = simulate(&scenario).unwrap();
        let mesh = mesh(&leaning.stages);
        let revolution = leaning.stages.time.samples_per_pinion_revolution;
        // Until the start is forgotten.
        let kept = 6 * revolution..20 * revolution;
        let slope = misalignment_um * 1e-6 / 0.015;
        let face = Face { slices: SLICES_OF_AN_END, slope, damping_time_s: mesh.damping_time_s };
        let sliced: Vec<f64> =
            by_slices(&aligned.stages, &face, kept.end)[kept.clone()].iter().map(|a| a / 9.81).collect();
        let [before, found, sliced] = [
            &aligned.channels.signals[0].values[kept.clone()],
            &leaning.channels.signals[0].values[kept],
            &sliced,
        ]
        .map(indicators);
        println!(
            "{misalignment_um} um, {brake_torque_nm} N m, {}: K_Hb {:.2}; log10 of rms and kurtosis {:.3} {:.3}, aligned \
             {:.3} {:.3}, by slices {:.3} {:.3}",
            damage.map_or("sound", |_| "broken"),
            mesh.along_face.face_load_factor,
            found[0],
            found[1],
            before[0],
            before[1],
            sliced[0],
            sliced[1],
        );
        for (found, sliced) in found.into_iter().zip(sliced) {
            assert!((found - sliced).abs() < 0.01, "{misalignment_um} {brake_torque_nm}: {found} {sliced}");
        }
    }
}
