//! Keys that the wheels of a pair have, and those of a gearbox.

use super::{EndRelief, FoundationCoefficients, Hand};
use crate::keys::{Field, KeyRow, Range, row};

/// The row of the module.
pub(crate) fn module_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row("module_mm", "mm", "the module of both wheels, of helical ones in the normal section", field)
        .required()
        .range(Range::positive().implausible_above(100.0))
}

/// The row of a tooth count.
pub(crate) fn teeth_row<S: 'static>(name: &'static str, field: Field<S, u32>) -> KeyRow<S> {
    row(name, "", "the tooth count", field)
        .required()
        .range(Range::from_to(6.0, 10_000.0).message("must be from 6 to 10000 teeth"))
        .rule("contact ratio at least 1; undercut (fewer than 17 at 20°) is not simulated, with a warning")
}

/// The row of a face width.
pub(crate) fn face_width_row<S: 'static>(meaning: &'static str, field: Field<S, f64>) -> KeyRow<S> {
    row("face_width_mm", "mm", meaning, field).required().range(Range::positive().implausible_above(10_000.0))
}

/// The row of the pressure angle.
pub(crate) fn pressure_angle_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row(
        "pressure_angle_deg",
        "°",
        "the pressure angle at the pitch circle, of helical wheels in the normal section",
        field,
    )
    .range(Range::from_to(10.0, 35.0).help("usual pressure angles are 14.5°, 20° and 25°"))
    .rule("no teeth pointed below full height")
}

/// The row of the helix angle.
pub(crate) fn helix_angle_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row("helix_angle_deg", "°", "the helix angle at the pitch circle; 0: spur wheels", field)
        .range(
            Range::from_to(0.0, 45.0)
                .help("usual helix angles are 8° to 30°; hand says to which side the teeth lean"),
        )
        .rule("0, or at least 0.01; total contact ratio at most 12")
}

/// The row of the helix's hand.
pub(crate) fn hand_row<S: 'static>(meaning: &'static str, field: Field<S, Hand>) -> KeyRow<S> {
    row("hand", "", meaning, field)
}

/// The row of the lead crowning.
pub(crate) fn lead_crowning_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    let meaning = "the lead crowning of both wheels together: how much farther apart the flanks are at the ends of the face than at its middle";
    row("lead_crowning_um", "µm", meaning, field).range(Range::not_negative().implausible_above(1000.0))
}

/// The row of the end relief.
pub(crate) fn end_relief_row<S: 'static>(field: Field<S, EndRelief>) -> KeyRow<S> {
    row("end_relief", "", "the relief of the flanks towards both ends of the face, as a gap in µm", field)
}

/// The row of the number of slices.
pub(crate) fn slices_row<S: 'static>(field: Field<S, u32>) -> KeyRow<S> {
    let meaning = "the number of slices of the face where the gap of helical teeth, or of crowned ones, varies along it";
    row("slices", "", meaning, field).range(Range::from_to(5.0, 41.0))
}

/// The row of a profile shift.
pub(crate) fn profile_shift_row<S: 'static>(name: &'static str, field: Field<S, f64>) -> KeyRow<S> {
    let range = Range::from_to(-2.0, 2.0);
    row(name, "-", "the profile shift coefficient x, in modules", field)
        .range(range.help("usual shifts are −0.5 to 1; in mm they are x times the module"))
        .rule("no undercut, no pointed tip")
}

/// The row of an addendum.
pub(crate) fn addendum_row<S: 'static>(name: &'static str, field: Field<S, f64>) -> KeyRow<S> {
    row(name, "-", "the addendum coefficient of the basic rack, in modules", field)
        .range(Range::from_to(0.3, 2.0).help("the standard basic rack has 1"))
        .rule("tips not pointed, clear of the mating gear's fillets")
}

/// The row of a dedendum.
pub(crate) fn dedendum_row<S: 'static>(name: &'static str, field: Field<S, f64>) -> KeyRow<S> {
    row(name, "-", "the dedendum coefficient of the basic rack, in modules", field)
        .range(Range::from_to(0.5, 2.5).help("the standard basic rack has 1.25"))
        .rule("roots clear of the mating gear's tips")
}

/// The row of the centre distance.
pub(crate) fn centre_distance_row<S: 'static>(field: Field<S, Option<f64>>) -> KeyRow<S> {
    row("centre_distance_mm", "mm", "the distance between the axes", field)
        .otherwise("that without backlash")
        .range(Range::positive())
        .rule("at least the default; contact ratio at least 1")
        .alternative("83.0")
}

/// The row of the tips' chamfer.
pub(crate) fn chamfer_row<S: 'static>(field: Field<S, Option<f64>>) -> KeyRow<S> {
    row("tip_chamfer_mm", "mm", "the height of the chamfer or rounding of all tips", field)
        .otherwise("0.23 modules")
        .alternative("0.69")
        .range(Range::not_negative())
        .rule("less than 1 module")
}

/// The row of the active profile's shortening.
pub(crate) fn shortening_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    let meaning = "the shortening of the path of contact against that between the chamfers, in base pitches, half of it at the tips of either wheel";
    row("active_profile_shortening", "-", meaning, field).range(Range::from_to(0.0, 0.5))
}

/// The row of the backlash.
pub(crate) fn backlash_row<S: 'static>(field: Field<S, Option<f64>>) -> KeyRow<S> {
    row("backlash_mm", "mm", "the backlash along the line of action", field)
        .otherwise("⅔ (0.06 + 0.0005 a + 0.03 m), a the centre distance, plus the backlash of a given one")
        .range(Range::not_negative())
        .rule("less than 1 module; at least that of a given centre distance")
        .alternative("0.1275")
}

/// The row of the flanks' constant reduction.
pub(crate) fn flank_reduction_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row("uniform_flank_reduction_mm", "mm", "a constant reduction of the working flank", field)
        .range(Range::not_negative())
        .rule("less than π/4 modules, half the tooth's thickness")
}

/// The row of the number of points along a profile.
pub(crate) fn points_row<S: 'static>(field: Field<S, usize>) -> KeyRow<S> {
    row("points_per_tooth", "", "the number of points along a tooth's profile", field)
        .range(Range::from_to(500.0, 1e6).message("must be from 500 to 1000000; the default is 10000"))
}

/// The row of the foundation's coefficients.
pub(crate) fn foundation_row<S: 'static>(field: Field<S, FoundationCoefficients>) -> KeyRow<S> {
    row(
        "foundation",
        "",
        "the coefficients A to F of the four polynomials of the fillet foundation's compliance, by Sainsot, \
         Velex and Duverger (2004)",
        field,
    )
}

/// The row of the misalignment.
pub(crate) fn misalignment_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row(
        "misalignment_um",
        "µm",
        "the misalignment of the shafts in the plane of action over the face width, including their \
         slope under the nominal load; positive where flanks come closer towards positive z. The \
         tilt by an uneven load is computed",
        field,
    )
    .range(Range::from_to(-1e3, 1e3))
}

/// The row of the damping of a mesh.
pub(crate) fn mesh_damping_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    let meaning = "the damping of teeth in contact, relative to the critical damping of the wheels' rotation on the mean mesh stiffness";
    row("damping_ratio", "-", meaning, field)
        .range(Range::below_one().help("measured ratios are 0.03 to 0.17"))
}

/// The row of the coefficient of friction.
pub(crate) fn friction_row<S: 'static>(field: Field<S, f64>) -> KeyRow<S> {
    row("friction", "-", "the coefficient of friction of the flanks; 0 for frictionless ones", field)
        .range(Range::from_to(0.0, 0.5).help("lubricated flanks have 0.02 to 0.1"))
}

/// The row of the random force.
pub(crate) fn random_force_row<S: 'static>(meaning: &'static str, field: Field<S, f64>) -> KeyRow<S> {
    row("random_force", "-", meaning, field)
        .range(Range::from_to(0.0, 10.0).help("0.02 to 0.2 sounds like recorded gearboxes"))
}

/// The row of the grade of DIN 3961.
pub(crate) fn din_grade_row<S: 'static>(meaning: &'static str, field: Field<S, u8>) -> KeyRow<S> {
    row("din_grade", "", meaning, field).range(Range::from_to(0.0, 12.0))
}

/// The row of the class of ISO 1328-1.
pub(crate) fn iso_class_row<S: 'static>(field: Field<S, u8>) -> KeyRow<S> {
    let meaning =
        "the class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none";
    row("iso_class", "", meaning, field).range(Range::from_to(0.0, 11.0)).rule("not beside din_grade")
}
