//! Load along the face: at rest against a solution of the whole machine with faces of springs that only push, and in motion against dense matrices
//! with two unknowns a mesh.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::machine::{Drive, Machine};
use meshtone::scenario::*;
use meshtone::solver::Output;
use meshtone::{Stages, stages};
use nalgebra::{DMatrix, DVector};

use crate::dense::{Dense, coordinates, outputs_from};
use crate::plain::plain;

/// Springs along each face.
const SPRINGS: usize = 400;

/// The template's gearbox on shafts of one diameter, in a rigid housing as the independent program's.
fn on_shafts(diameter_mm: f64, rotation: BodyRotation) -> Scenario {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    let of = gearbox.structure.shafts_mut().unwrap();
    of.housing.as_mut().unwrap().modes.per_khz = 0.0;
    of.shafts.iter_mut().for_each(|shaft| shaft.radius_mm = Some(diameter_mm / 2.0));
    gearbox.meshes.iter_mut().for_each(|mesh| mesh.foundation.rotation = rotation);
    gearbox
}

/// (-) Largest over mean force of the springs of each mesh: those that push are sought until they stay the same.
///
/// # Arguments
/// * `machine`, `torque_nm` - without its meshes, and what its brake takes
/// * `stiffness_n_per_m`, `width_m` - of each mesh
fn solved(machine: &Machine, torque_nm: f64, stiffness_n_per_m: &[f64], width_m: f64) -> Vec<f64> {
    let mut load = DVector::zeros(machine.coordinates());
    for drive in &machine.drives {
        if let Drive::Brake { coordinate, torque_share } = drive {
            load[*coordinate] += torque_share * torque_nm;
        }
    }
    let open = machine
        .springs
        .iter()
        .fold(DMatrix::zeros(machine.coordinates(), machine.coordinates()), |sum, spring| {
            sum + &spring.stiffness
        });
    let places: Vec<f64> = (0..=SPRINGS).map(|n| width_m * (n as f64 / SPRINGS as f64 - 0.5)).collect();
    // The springs at both ends stand for half the length.
    let share = |n: usize| if n == 0 || n == SPRINGS { 0.5 } else { 1.0 } / SPRINGS as f64;
    let mut pushes = vec![vec![true; places.len()]; stiffness_n_per_m.len()];
    loop {
        let mut closed = open.clone();
        for ((line, stiffness), pushes) in machine.lines.iter().zip(stiffness_n_per_m).zip(&pushes) {
            let [mut k, mut of_z, mut of_zz] = [0.0; 3];
            for (n, z) in places.iter().enumerate().filter(|(n, _)| pushes[*n]) {
                k += stiffness * share(n);
                of_z += stiffness * share(n) * z;
                of_zz += stiffness * share(n) * z * z;
            }
            let cross = &line.at_middle * line.per_m.transpose();
            closed += &line.at_middle * line.at_middle.transpose() * k
                + (&cross + cross.transpose()) * of_z
                + &line.per_m * line.per_m.transpose() * of_zz;
        }
        let rest = closed.lu().solve(&load).unwrap();
        let pressed: Vec<Vec<f64>> = (machine.lines.iter())
            .map(|line| {
                let [middle, slope] = [&line.at_middle, &line.per_m].map(|column| column.dot(&rest));
                places.iter().map(|z| middle + z * slope).collect()
            })
            .collect();
        let next: Vec<Vec<bool>> =
            pressed.iter().map(|of| of.iter().map(|pressed| *pressed > 0.0).collect()).collect();
        if next == pushes {
            let factor = |pressed: &Vec<f64>| {
                let mean: f64 = pressed.iter().enumerate().map(|(n, of)| share(n) * of.max(0.0)).sum();
                pressed.iter().copied().fold(0.0, f64::max) / mean
            };
            return pressed.iter().map(factor).collect();
        }
        pushes = next;
    }
}

fn factors(stages: &Stages) -> Vec<f64> {
    stages.meshes.iter().map(|mesh| mesh.along_face.face_load_factor).collect()
}

fn solved_of(stages: &Stages, stiffness_n_per_m: &[f64]) -> Vec<f64> {
    let torque_nm = stages.scenario.operation.brake_torque_nm;
    solved(stages.machine_and_modes().unwrap().0, torque_nm, stiffness_n_per_m, 0.01905)
}

/// The face load factors are those of the static solution, within 3 %. With the stiffness of an independent program, which has the rotation of the
/// wheels' bodies in the teeth, the solution is that program's, on another machine of the same parts.
#[test]
fn face_load_factors_are_those_of_the_static_solution() {
    for (diameter_mm, published) in [
        (15.875, [7.17, 6.15]),
        (20.0, [4.58, 3.92]),
        (25.0, [2.98, 2.54]),
        (30.0, [2.10, 1.78]),
        (40.0, [1.35, 1.22]),
    ] {
        let stages = stages(on_shafts(diameter_mm, BodyRotation::Machine)).unwrap();
        let found = factors(&stages);
        let own = solved_of(&stages, &stages.mean_stiffness_n_per_m());
        let of_program = solved_of(&stages, &[159.4e6, 176.4e6]);
        println!(
            "{diameter_mm} mm: {found:.3?}, solved {own:.3?}; softer teeth {of_program:.3?}, {published:?}"
        );
        for ((found, own), (of_program, published)) in
            found.iter().zip(own).zip(of_program.iter().zip(published))
        {
            assert!((found / own - 1.0).abs() < 0.03, "{diameter_mm}: {found} {own}");
            assert!((of_program / published - 1.0).abs() < 0.03, "{diameter_mm}: {of_program} {published}");
        }
    }
}

/// Slender shafts are warned of with what would help, and what is said is so; thick ones are not.
#[test]
fn slender_shafts_are_warned_of_with_what_would_help() {
    let thick = stages(on_shafts(40.0, BodyRotation::Machine)).unwrap();
    assert!(factors(&thick).iter().all(|factor| (1.0..2.0).contains(factor)));
    assert!(thick.warnings().iter().all(|warning| warning.kind != WarningKind::UnevenFace));
    let slender = on_shafts(15.875, BodyRotation::Machine);
    let of_slender = stages(&slender).unwrap();
    let found = factors(&of_slender);
    assert!((found[0] - 10.5).abs() < 0.1 && (found[1] - 8.54).abs() < 0.1, "{found:?}");
    let warnings = of_slender.warnings();
    let uneven: Vec<_> = warnings.iter().filter(|of| of.kind == WarningKind::UnevenFace).collect();
    assert_eq!(uneven.len(), 2);
    assert_eq!(uneven[0].key, "shaft[1].radius_mm");
    let said = |number: usize, after: &str| -> f64 {
        let rest = uneven[number].message.split(after).nth(1).unwrap();
        rest.split([',', ' ', ';']).next().unwrap().parse().unwrap()
    };
    let mut thicker = slender.clone();
    thicker.structure.shafts_mut().unwrap().shafts[1].radius_mm = Some(1.5 * 7.9375);
    let mut centred = slender.clone();
    centred.wheels[..2].iter_mut().for_each(|wheel| wheel.at = 0.5);
    let mut crowned = slender.clone();
    crowned.meshes[0].lead_crowning_um = said(0, "a crowning of ");
    for (changed, after) in [
        (thicker, "50 % thicker would make it "),
        (centred, "midway between their bearings would make it "),
        (crowned, "µm would make it "),
    ] {
        // The teeth are a little stiffer on a thicker shaft.
        let (said, found) = (said(0, after), factors(&stages(&changed).unwrap())[0]);
        println!("{after}{said}: {found:.3}");
        assert!((said / found - 1.0).abs() < 0.06, "{after}{said}: {found}");
    }
}

/// Two equal wheels on equal shafts whose middle planes are so far apart, each at half of that from the middle of its shaft.
fn offset_by(apart_mm: f64) -> Scenario {
    let shafts = ["input", "output"].map(|name| GearboxShaft::new(name, 240.0, 15.0)).to_vec();
    let wheel = |name: &str, shaft: &str, side: f64| {
        ScenarioWheel::new(name, shaft, 0.5 + side * apart_mm / 480.0, 40, 20.0)
    };
    let wheels = vec![wheel("z1", "input", 1.0), wheel("z2", "output", -1.0)];
    let bearings =
        ["input", "output"].into_iter().flat_map(|shaft| [0.0, 1.0].map(|at| Bearing::new(shaft, at)));
    let meshes = vec![ScenarioMesh::new(["z1", "z2"], 2.0)];
    let mut gearbox =
        Scenario::of_shafts(shafts, wheels, meshes, bearings.collect(), Operation::new(30.0, 20.0));
    let shafts = &mut gearbox.structure.shafts_mut().unwrap().shafts;
    (shafts[0].couples_to, shafts[1].couples_to) = (Coupled::Motor, Coupled::Brake);
    gearbox
}

/// Faces bear where both are: 10.4 of 20 mm of wheels that are 9.6 mm apart. Their load is not midway along either face and tilts both wheels alike, so
/// that it stays even.
#[test]
fn offset_faces_bear_where_they_overlap() {
    let aligned = stages(offset_by(0.0)).unwrap();
    let offset = stages(offset_by(9.6)).unwrap();
    let ratio = offset.meshes[0].mean_stiffness_n_per_m / aligned.meshes[0].mean_stiffness_n_per_m;
    println!("stiffness x {ratio:.6}, {:?}", offset.meshes[0].along_face);
    assert!((ratio - 0.52).abs() < 1e-9);
    assert!((factors(&offset)[0] - 1.0).abs() < 1e-3);
    // A narrower wheel in the middle of a wide one has its own face and tilts neither.
    let mut narrow = offset_by(0.0);
    narrow.wheels[1].face_width_mm = 10.4;
    let narrow = stages(&narrow).unwrap();
    assert!(
        (narrow.meshes[0].mean_stiffness_n_per_m / offset.meshes[0].mean_stiffness_n_per_m - 1.0).abs()
            < 1e-9
    );
    for (stages, is_tilted) in [(&aligned, false), (&offset, true), (&narrow, false)] {
        let machine = stages.machine_and_modes().unwrap().0;
        let line = &machine.lines[0];
        // The force's moments about the axis across it that tilts each wheel.
        let moments: Vec<f64> = line
            .per_m
            .iter()
            .zip(line.at_middle.iter())
            .map(|(of_tilt, of_force)| of_tilt * of_force)
            .collect();
        let [one, other] = [0, 1].map(|wheel| {
            let half = moments.len() / 2;
            moments[wheel * half..(wheel + 1) * half].iter().sum::<f64>()
        });
        println!("{one:.3e} {other:.3e}");
        assert!((one + other).abs() < 1e-12 && (one.abs() > 4e-3) == is_tilted, "{one} {other}");
    }
}

/// A gearbox of few elements, whose samples are points of the tables, over a few milliseconds.
fn slender() -> Scenario {
    let mut gearbox = plain(Scenario::from_toml(&gearbox_template(None)).unwrap());
    gearbox.sensors.clear();
    let of = gearbox.structure.shafts_mut().unwrap();
    of.shafts.iter_mut().for_each(|shaft| shaft.elements = 4);
    of.housing = None;
    // 105 samples for a pitch of the first mesh, 210 for one of the second.
    gearbox.solver.sampling_rate_hz = 105.0 * 32.0 * 30.0;
    gearbox.solver.highest_mode_hz = Some(1e9);
    gearbox.solver.settle_fraction = 0.0;
    gearbox.solver.duration_s = Some(0.003);
    gearbox
}

/// Gearboxes on slender shafts, whose meshes have two unknowns: with crowning and with damage of a part of the face, move as a dense
/// solution has it that integrates what of each face touches.
#[test]
fn leaning_faces_move_as_with_dense_matrices() {
    let chip = ToothBreakage { chip_height_mm: 2.5, chip_width_mm: 8.0, tip_loss_mm: 0.0 };
    let chipped = || vec![Fault::new("z2", 1, chip), Fault::new("z4", 1, chip)];
    let missing = || vec![Fault::new("z2", 1, MissingTooth)];
    for (name, helix_angle_deg, crowning_um, faults) in [
        ("spur", 0.0, 0.0, Vec::new()),
        ("spur, missing tooth", 0.0, 0.0, missing()),
        ("spur, chipped", 0.0, 0.0, chipped()),
        ("spur, crowned", 0.0, 8.0, Vec::new()),
        ("helical", 12.0, 0.0, Vec::new()),
        ("helical, missing tooth", 12.0, 0.0, missing()),
        ("helical, chipped", 12.0, 0.0, chipped()),
        ("helical, crowned", 12.0, 8.0, Vec::new()),
    ] {
        let mut gearbox = slender();
        for mesh in &mut gearbox.meshes {
            (mesh.lead_crowning_um, mesh.slices, mesh.phase) = (crowning_um, 7, Some(0.0));
            mesh.helix_angle_deg = helix_angle_deg;
        }
        gearbox.faults = faults;
        if helix_angle_deg > 0.0 {
            // The dense solution reads the deviations of an undivided face midway; and on thinner shafts gyroscopic moments, which it lacks, are stepped.
            gearbox.wheels.iter_mut().for_each(|wheel| (wheel.din_grade, wheel.iso_class) = (0, 0));
            let of = gearbox.structure.shafts_mut().unwrap();
            of.shafts.iter_mut().for_each(|shaft| shaft.radius_mm = Some(10.0));
        }
        let stages = stages(&gearbox).unwrap();
        assert!(stages.meshes.iter().all(|mesh| mesh.two_unknowns().is_some()), "{name}");
        let (machine, _) = stages.machine_and_modes().unwrap();
        assert!(machine.spinning.is_empty(), "{name}");
        let dense = Dense::of(&stages, stages.time.samples);
        let theirs = dense.accelerations();
        let outputs: Vec<Output> = coordinates(machine, 2).collect();
        let ours = outputs_from(0, &stages, &outputs);
        let rms = |of: &mut dyn Iterator<Item = f64>| of.map(|x| x * x).sum::<f64>().sqrt();
        let scales: Vec<f64> =
            (0..ours.len()).map(|n| rms(&mut theirs.iter().map(|sample| sample[n]))).collect();
        let largest = scales.iter().copied().fold(0.0, f64::max);
        let (worst, coordinate) = (ours.iter().enumerate())
            .map(|(n, ours)| {
                let difference = rms(&mut ours.iter().zip(&theirs).map(|(ours, theirs)| ours - theirs[n]));
                (difference / if scales[n] > 1e-6 * largest { scales[n] } else { largest }, n)
            })
            .fold((0.0, 0), |worst, of| if of.0 > worst.0 { of } else { worst });
        let (named, size) = (&machine.names[coordinate], scales[coordinate] / largest);
        println!("{name}: {worst:.1e} in {named}, {size:.1e} of the largest");
        assert!(worst < 1e-8, "{name}: {worst:e}");
    }
}

/// An undivided helical face bears as one of many slices does, which crowning of nothing makes it: while all of it bears, and less exactly where a
/// fifth does, which an even strip stands for.
#[test]
fn helical_strips_bear_as_slices_do() {
    for (diameter_mm, most) in [(40.0, 1e-2), (24.0, 6e-2)] {
        let of = |crowning_um: f64| {
            let mut gearbox = on_shafts(diameter_mm, BodyRotation::Machine);
            for mesh in &mut gearbox.meshes {
                (mesh.helix_angle_deg, mesh.lead_crowning_um, mesh.slices) = (12.0, crowning_um, 41);
            }
            let stages = stages(&gearbox).unwrap();
            assert!(stages.meshes.iter().all(|mesh| mesh.two_unknowns().is_some()));
            let at_rest = |number: usize| {
                let force_n = stages.pairs[number].static_force_n;
                stages.meshes[number].at_rest(force_n, 0..1).deflection_m
            };
            let tilt_m = stages.meshes.iter().map(|mesh| mesh.along_face.tilt_m.abs() / 2.0);
            ([0, 1].map(at_rest).concat(), tilt_m.fold(0.0, f64::max))
        };
        let [(strips, _), (slices, tilt_m)] = [0.0, 1e-9].map(of);
        // At the end of the face that is pressed more.
        let largest_m = slices.iter().fold(0.0, |most: f64, slices| most.max(slices.abs())) + tilt_m;
        let apart = strips.iter().zip(&slices).map(|(strips, slices)| (strips - slices).abs() / largest_m);
        let worst = apart.fold(0.0, f64::max);
        println!("{diameter_mm} mm: {worst:.1e}");
        assert!(worst < most, "{diameter_mm} mm: {worst:e}");
    }
}

/// Where the helix vanishes, a face that leans bears as that of spur teeth does.
#[test]
fn leaning_helical_faces_meet_spur_ones() {
    let of = |helix_angle_deg: f64| {
        let mut gearbox = on_shafts(28.0, BodyRotation::Machine);
        for mesh in &mut gearbox.meshes {
            (mesh.helix_angle_deg, mesh.damping_ratio) = (helix_angle_deg, 0.1);
        }
        gearbox.solver.duration_s = Some(0.1);
        let simulation = meshtone::simulate(plain(gearbox)).unwrap();
        assert!(simulation.stages.meshes.iter().all(|mesh| mesh.two_unknowns().is_some()));
        let static_um = simulation.stages.meshes[0]
            .at_rest(simulation.stages.pairs[0].static_force_n, 0..1)
            .peak_to_peak_m()
            * 1e6;
        let seats = simulation.channels.signals.iter().filter(|signal| signal.unit == "g");
        let rms = |values: &[f64]| (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt();
        [vec![static_um], seats.map(|signal| rms(&signal.values)).collect()].concat()
    };
    let spur = of(0.0);
    for (helix_angle_deg, most) in [(0.01, 0.01), (0.1, 0.03), (0.5, 0.2)] {
        let found = of(helix_angle_deg);
        let worst =
            spur.iter().zip(&found).map(|(spur, found)| (found / spur - 1.0).abs()).fold(0.0, f64::max);
        println!("{helix_angle_deg}: {worst:.1e}, {spur:?} {found:?}");
        assert!(worst < most, "{helix_angle_deg}: {worst:e}");
    }
}
