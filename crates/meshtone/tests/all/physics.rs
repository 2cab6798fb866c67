//! What the tests of the physics share.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use meshtone::Stages;
use meshtone::mesh::{Mesh, PairKind, PairTable, Pairs};
use meshtone::scenario::{
    BodyRotation, FoundationCoefficients, GearPair, Gears, Scenario, Sensor, SensorPath, SensorPlace,
    Support, SupportSprings,
};
use meshtone::wheel::{Teeth, teeth};

/// The wheels of [`GearPair::example`]: 17 and 38 teeth of module 3 mm, 15 mm wide.
pub fn example_gears() -> Gears {
    Scenario::new(GearPair::example()).gears()
}

/// Deviation of `value` from `exact`, relative to `exact`.
pub fn deviation(value: f64, exact: f64) -> f64 {
    value / exact - 1.0
}

/// Asserts that the largest relative deviation of (value, exact) pairs is within `tolerance`, and prints it.
#[track_caller]
pub fn assert_close(what: &str, tolerance: f64, pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let mut largest = 0.0_f64;
    let mut count = 0;
    for (value, exact) in pairs {
        let deviation = deviation(value, exact).abs();
        assert!(deviation <= tolerance, "{what}: {value:e} instead of {exact:e}, off by {deviation:.2e}");
        largest = largest.max(deviation);
        count += 1;
    }
    assert!(count > 0, "{what}: nothing was compared");
    println!("{what}: largest relative deviation {largest:.2e} of {count}");
    largest
}

/// Mean.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Gives a scenario supports, tips and deviations of its own, for tests whose numbers or tolerances were measured with them: supports
/// with modes at 1.6 and 4.3 kHz, a path as long as chamfers of 0.2 modules leave it, and wheels whose teeth are more alike and whose bodies
/// turn with each pair of teeth.
pub fn with_own_structure(scenario: &mut Scenario) {
    scenario.rig_mut().unwrap().support = Support {
        mass_kg: 1.6,
        springs: SupportSprings::Stiffnesses { stiffness_n_per_m: 1.6e8, coupling_n_per_m: 5e8 },
        damping_ratio: 0.025,
    };
    scenario
        .wheels
        .iter_mut()
        .for_each(|wheel| wheel.tip_chamfer_mm = Some(0.2 * scenario.meshes[0].module_mm));
    scenario.wheels.iter_mut().for_each(|wheel| wheel.active_profile_shortening = 0.0);
    scenario.meshes[0].foundation = with_rotation_in_teeth();
    for wheel in &mut scenario.wheels {
        (wheel.tooth_share, wheel.pitch_share) = (0.4, 0.15);
    }
}

/// What both supports do on average.
pub fn mean_of_supports() -> Sensor {
    let mut sensor = Sensor::default();
    (sensor.at, sensor.path) = (SensorPlace::Support, SensorPath::RIGID);
    sensor
}

/// Root of the mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Standard deviation.
pub fn deviation_about_mean(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Largest absolute value.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

/// Healthy teeth of wheels on shafts of the given diameter, whose flanks are conjugate.
pub fn linear_teeth(gears: &Gears, bore_diameter_mm: f64) -> Teeth {
    teeth(gears, [bore_diameter_mm / 2.0; 2])
}

/// The same as the published code has them, but without its tip relief: the pinion's profile resampled, pairs that are not conjugate.
pub fn published_teeth(gears: &Gears, bore_diameter_mm: f64) -> Teeth {
    meshtone::published::relieved_teeth(gears, [bore_diameter_mm / 2.0; 2], None)
}

/// The class of two sound teeth.
pub const SOUND_PAIR: PairKind = PairKind { pinion: None, gear: None, pairs_per_cycle: 1 };

/// Sound pairs of the wheels.
pub fn sound_pairs<'a>(gears: &Gears, teeth: &'a Teeth) -> Pairs<'a> {
    Pairs::new(teeth, &[], gears)
}

/// The mesh of a simulation that has one.
pub fn mesh(stages: &Stages) -> &Mesh {
    &stages.meshes[0]
}

/// Pairs of two sound teeth, and those of the first damaged tooth with sound mates.
pub fn sound_and_damaged(mesh: &Mesh) -> [&PairTable; 2] {
    let [sound, damaged, ..] = &mesh.classes[..] else { panic!("no damaged tooth") };
    [sound, damaged]
}

/// (N/m) Stiffness of a class of pairs, point by point.
pub fn stiffness_n_per_m(pairs: &PairTable) -> Vec<f64> {
    pairs.states.iter().map(|state| state.stiffness_n_per_m).collect()
}

/// A wheel's body that turns with each pair of teeth, as it does in programs and tables that the library is compared with.
pub fn with_rotation_in_teeth() -> FoundationCoefficients {
    FoundationCoefficients { rotation: BodyRotation::Tooth, ..Default::default() }
}

/// A wheel's body that does not give way.
pub fn rigid_foundation() -> FoundationCoefficients {
    FoundationCoefficients {
        l: [0.0; 6],
        m: [0.0; 6],
        p: [0.0; 6],
        q: [0.0; 6],
        rotation: BodyRotation::Tooth,
    }
}

/// Abscissae and weights of Gauss and Legendre's rule with 5 points on \[−1, 1\]: exact up to degree 9.
pub const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// `∫ f` from `from` to `to`, in `pieces` pieces of five points.
pub fn integral(from: f64, to: f64, pieces: usize, f: impl Fn(f64) -> f64) -> f64 {
    let half = (to - from) / (2 * pieces) as f64;
    (0..pieces)
        .map(|k| {
            let middle = from + half * (2 * k + 1) as f64;
            GAUSS.iter().map(|(t, w)| w * half * f(middle + half * t)).sum::<f64>()
        })
        .sum()
}
