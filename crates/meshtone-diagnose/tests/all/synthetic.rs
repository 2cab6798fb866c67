//! Reference sets that need no simulation, for tests.

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{DamageKind, GearPair, Scenario};
use meshtone::signal::{AngleZero, BearingDefects};
use meshtone_fourier::Complex64;
use meshtone_learn::{WheelLines, separations};

use crate::draw::{DrawnFault, RECORDS_PER_UNIT};
use crate::observation::{Observation, SignalKind};
use crate::prior::Prior;
use crate::reference::{ReferenceRecord, ReferenceSet};

/// Mesh orders of the lines.
const LAST_MESH: u32 = 6;

/// The prior of a rig: the example's pair of grade 7 under 20 N m.
pub fn prior() -> Prior {
    let mut rig = Scenario::new(GearPair { brake_torque_nm: 20.0, ..GearPair::example() });
    rig.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
    Prior::new(&rig).unwrap()
}

/// The prior of a gearbox of two stages, coarsely sampled, whose same teeth meet again after four revolutions of the input.
pub fn gearbox_prior() -> Prior {
    let text = meshtone::scenario::gearbox_template(None);
    // At so coarse a rate teeth that part make no two cycles alike.
    let mut gearbox = crate::plain::plain(Scenario::from_toml(&text).unwrap());
    for (wheel, teeth) in gearbox.wheels.iter_mut().zip([24, 48, 24, 48]) {
        wheel.teeth = teeth;
    }
    // Shafts damped so that little of the start-up is left after half of the time.
    gearbox.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.damping_ratio = 0.2);
    gearbox.sensors.clear();
    let solver = &mut gearbox.solver;
    (solver.sampling_rate_hz, solver.duration_s, solver.settle_fraction) = (2.5e4, Some(0.8), 0.5);
    Prior::new(&gearbox).unwrap()
}

/// Records of a prior: deviations of the wheels' own, and of a damage a ringing on its tooth as large as it is severe, whose order
/// is the kind's.
pub fn records(prior: &Prior, count: u64) -> Vec<ReferenceRecord> {
    let kinds = prior.kinds();
    (0..count).map(|number| record(prior, number, &kinds)).collect()
}

fn record(prior: &Prior, number: u64, kinds: &[DamageKind]) -> ReferenceRecord {
    let (unit, rig) = (number / RECORDS_PER_UNIT, &prior.train.wheels);
    let mut own = Draws::new(prior.seed, Purpose::DiagnosisRecord, number);
    let [least, most] = prior.focus.as_ref().map_or([0.0, 1.0], |focus| focus.severity);
    let fault = prior.class(kinds, number).map(|(kind, wheel)| {
        let drawn = least + (most - least) * own.uniform(0.5, 0.5);
        let sizes = kinds.get(kind).map_or(0, |kind| kind.sizes.len());
        let severity = if kind < kinds.len() && sizes == 0 { 1.0 } else { drawn };
        DrawnFault {
            kind,
            wheel,
            tooth: 1 + (own.bits() % u64::from(rig[wheel].teeth)) as u32,
            is_on_one_tooth: kind < kinds.len(),
            severity,
            sizes: vec![severity; sizes],
        }
    });
    let wheels = separations(&prior.train).into_iter().enumerate().map(|(wheel, separation)| {
        let teeth = rig[wheel].teeth;
        let mut of_unit =
            Draws::new(prior.seed, Purpose::DiagnosisUnit, rig.len() as u64 * unit + wheel as u64);
        let mut lines: Vec<Complex64> = (0..=LAST_MESH * teeth)
            .map(|order| {
                let [re, im] = of_unit.normals();
                Complex64::new(re, im) * if order % teeth == 0 { 1.0 } else { 0.01 }
            })
            .collect();
        if let Some(fault) = fault.as_ref().filter(|fault| fault.wheel == wheel) {
            let at = f64::from(fault.tooth - 1) / f64::from(teeth);
            let middle = (1.5 + 4.0 * fault.kind as f64 / kinds.len() as f64) * f64::from(teeth);
            for (order, line) in lines.iter_mut().enumerate() {
                let from_middle = (order as f64 - middle) / f64::from(teeth);
                let size = 0.3 * fault.severity * (-2.0 * from_middle * from_middle).exp();
                *line += Complex64::from_polar(size, -std::f64::consts::TAU * order as f64 * at);
            }
        }
        WheelLines { separation, lines }
    });
    let wheels = wheels.collect();
    ReferenceRecord { number, fault, input_speed_hz: prior.base.operation.pinion_speed_hz, wheels }
}

/// A set of them.
pub fn reference(prior: &Prior, count: u64) -> ReferenceSet {
    ReferenceSet { prior: prior.clone(), records: records(prior, count) }
}

/// (g) Noise in the lines of what is observed.
const NOISE_G: f64 = 1e-3;

/// A record as a recording shows it.
pub fn observed(record: &ReferenceRecord) -> Observation {
    let mut draws = Draws::new(4711, Purpose::DiagnosisNoise, record.number);
    let mut noisy = |wheel: &WheelLines| {
        let mut wheel = wheel.clone();
        for line in &mut wheel.lines {
            let [re, im] = draws.normals();
            *line += Complex64::new(re, im) * (NOISE_G * std::f64::consts::FRAC_1_SQRT_2);
        }
        wheel
    };
    Observation {
        signal: SignalKind::Recording,
        input_speed_hz: Some(record.input_speed_hz),
        zero: vec![AngleZero::Simulated; record.wheels.len()],
        wheels: record.wheels.iter().map(|wheel| Some(noisy(wheel))).collect(),
        noise: vec![vec![NOISE_G]; record.wheels.len()],
        mismatch: None,
        foreign: None,
        doubts: Vec::new(),
        bearings: BearingDefects::default(),
    }
}
