//! The scenarios of the gallery, and what holds for every figure.

// The example that draws the gallery uses a part.
#![allow(dead_code, clippy::unwrap_used)]

use meshtone::scenario::*;
use meshtone_plot::{Figure, Label};

fn small_pair(damage: Option<Damage>) -> Scenario {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
    scenario.faults = damage.into_iter().map(Fault::at_usual_place).collect();
    scenario
}

/// Names of files and what they show.
pub fn gallery() -> Vec<(&'static str, Scenario)> {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.5 };
    let breakage = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 3.0 };
    let pits = Pits::Listed {
        at: vec![0.35, 0.42, 0.5],
        z_mm: vec![-3.0, 1.0, 5.0],
        radius_mm: vec![0.6, 0.9, 0.5],
        face_radius_mm: None,
        depth_mm: vec![0.1, 0.15, 0.1],
    };
    let crack = RootCrack { depth_mm: 3.0, angle_deg: 45.0, length_mm: None };
    let mut destruction = Scenario::new(GearPair {
        pinion_teeth: 18,
        gear_teeth: 35,
        face_width_mm: 30.0,
        pinion_speed_hz: 45.0,
        brake_torque_nm: 15.0,
        ..GearPair::example()
    });
    destruction.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 8);
    destruction.faults = vec![Fault::on_first_gear_tooth(ToothDestruction {
        start: 3.0 / 14.0,
        line: DestructionLine::End(13.0 / 14.0),
        offset_mm: 0.0,
        noise_mm: 0.0,
    })];
    vec![
        ("healthy", small_pair(None)),
        ("missing_tooth", small_pair(Some(MissingTooth.into()))),
        ("tooth_breakage", small_pair(Some(breakage.into()))),
        ("partial_face", small_pair(Some(PartialFace { width_mm: 2.0, pit }.into()))),
        ("through_face", small_pair(Some(ThroughFace { pit }.into()))),
        ("tooth_destruction", destruction),
        ("root_crack", small_pair(Some(crack.into()))),
        ("pits", small_pair(Some(pits.into()))),
        ("wear", small_pair(Some(Wear { depth_um: 30.0 }.into()))),
    ]
}

/// Whether the boxes of two texts share more than an edge.
fn overlap(one: &Label, other: &Label) -> bool {
    one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom
}

/// What holds for every figure: it can be drawn in at most `largest` bytes, no text leaves it, and none is over another.
pub fn check(figure: &Figure, largest: usize) {
    roxmltree::Document::parse(figure.svg()).unwrap();
    assert!(figure.svg().len() < largest, "{} bytes", figure.svg().len());
    for number in ["NaN", "inf"] {
        assert!(!figure.svg().contains(&format!("{number} ")), "{number}");
    }
    let (width, height) = figure.size_px();
    let labels = figure.labels();
    for (index, label) in labels.iter().enumerate() {
        let inside = label.left >= 0.0
            && label.top >= 0.0
            && label.right <= f64::from(width)
            && label.bottom <= f64::from(height);
        assert!(inside, "{label:?} leaves the figure");
        for other in &labels[index + 1..] {
            assert!(!overlap(label, other), "{label:?} overlaps {other:?}");
        }
    }
    assert!(figure.png().unwrap().starts_with(b"\x89PNG"));
}
