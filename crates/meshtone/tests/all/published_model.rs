//! The published model's scenarios and outputs (see `tests/published/README.md`).
#![allow(clippy::unwrap_used)]

use std::collections::HashMap;
use std::fs::File;
use std::path::PathBuf;

use meshtone::scenario::*;
use meshtone::wheel::ErrorTable;
use ndarray::{ArrayD, IxDyn};
use ndarray_npy::NpzReader;

/// A test of each of the nine scenarios, of its name.
macro_rules! for_each_scenario {
    ($check:ident) => {
        for_each_scenario!(
            $check: healthy_din0, healthy_din7, missing_din0, breakage_din7, partial_din0, through_din0, through_circ_din7,
            destruction_din0, destruction_slope_din0
        );
    };
    ($check:ident: $($name:ident),*) => {$(
        #[test]
        fn $name() {
            $check(stringify!($name));
        }
    )*};
}
pub(crate) use for_each_scenario;

/// Fields by name.
pub type Reference = HashMap<String, ArrayD<f64>>;

/// The published outputs of a scenario.
pub fn reference(name: &str) -> Reference {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../meshtone/tests/published")
        .join(format!("{name}.npz"));
    let mut npz = NpzReader::new(File::open(path).unwrap()).unwrap();
    let names = npz.names().unwrap();
    names
        .into_iter()
        .map(|entry| {
            let values = npz
                .by_name::<ndarray::OwnedRepr<f64>, IxDyn>(&entry)
                .or_else(|_| npz.by_name::<ndarray::OwnedRepr<f32>, IxDyn>(&entry).map(|a| a.mapv(f64::from)))
                .or_else(|_| {
                    npz.by_name::<ndarray::OwnedRepr<i64>, IxDyn>(&entry).map(|a| a.mapv(|v| v as f64))
                })
                .unwrap();
            (entry.trim_end_matches(".npy").to_owned(), values)
        })
        .collect()
}

/// The scenario itself.
pub fn scenario(name: &str, reference: &Reference) -> Scenario {
    let mut scenario = if name.starts_with("destruction") {
        Scenario::new(GearPair {
            pinion_teeth: 18,
            gear_teeth: 35,
            face_width_mm: 30.0,
            pinion_speed_hz: 45.0,
            brake_torque_nm: 15.0,
            ..GearPair::example()
        })
    } else {
        Scenario::new(GearPair::example())
    };
    scenario.model = Model::Published;
    if name.ends_with("din7") {
        let matrix = |key: &str| {
            let values = &reference[key];
            ErrorTable::from_fn(values.shape()[0], values.shape()[1], |r, c| values[[r, c]])
        };
        scenario.wheels[0].profile_errors_mm = Some(matrix("pinion_profile_errors_mm"));
        scenario.wheels[1].profile_errors_mm = Some(matrix("gear_profile_errors_mm"));
    }
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.5 };
    let destruction = |start, line| ToothDestruction { start, line, offset_mm: 0.0, noise_mm: 0.0 };
    let damage = match name {
        "missing_din0" => Some(MissingTooth.into()),
        "breakage_din7" => Some(Damage::ToothBreakage(ToothBreakage {
            chip_height_mm: 5.0,
            chip_width_mm: 12.0,
            tip_loss_mm: 3.0,
        })),
        "partial_din0" => Some(Damage::PartialFace(PartialFace { width_mm: 2.0, pit })),
        "through_din0" => Some(Damage::ThroughFace(ThroughFace { pit })),
        "through_circ_din7" => Some(Damage::ThroughFace(ThroughFace {
            pit: PitCircle::Circle { x_mm: 57.5, y_mm: 3.66, radius_mm: 2.5 },
        })),
        "destruction_din0" => {
            Some(Damage::ToothDestruction(destruction(3.0 / 14.0, DestructionLine::End(13.0 / 14.0))))
        }
        "destruction_slope_din0" => {
            Some(Damage::ToothDestruction(destruction(0.2, DestructionLine::SlopeDeg(22.0))))
        }
        _ => None,
    };
    scenario.faults = damage.into_iter().map(|damage: Damage| Fault::on_first_gear_tooth(damage)).collect();
    scenario
}
