//! Rules of a wheel in a ring with internal teeth.

use super::mounting_rules::touched_curvature_mm;
use super::radii::involute;
use super::{Gears, Mounting, NamedGears, WheelName};
use crate::error::ScenarioError;
use crate::keys::{Check, require};

/// Checks that the wheel turns inside the ring, that the ring's tips meet its involutes, and that the tips of both stay clear of one
/// another beside the path and of the roots.
///
/// Source: ISO 21771:2007, sections 4.5 and 5; G. Niemann, H. Winter, *Maschinenelemente II*, section 22.2.
pub(super) fn check(gears: &NamedGears) -> Check {
    let [planet, ring] = WheelName::BOTH.map(|wheel| gears.name(wheel));
    let [key, shift] = ["teeth", "profile_shift"].map(|key| gears.key_of(WheelName::Gear, key));
    let teeth = |holds, problem: String, help: String| match holds {
        true => Ok(()),
        false => Err(ScenarioError::new(&key, gears.gear_teeth, problem).with_help(help)),
    };
    let shifts = |holds, problem: String| {
        let help = format!("make the profile shifts of {planet} and {ring} more alike");
        require(&shift, gears.gear_profile_shift, holds, problem).map_err(|error| error.with_help(help))
    };
    let helix = gears.key("helix_angle_deg");
    let problem = format!("must be 0: {ring} has internal teeth, which are simulated as spur ones only");
    require(&helix, gears.helix_angle_deg, gears.helix_angle_deg == 0.0, problem)?;
    let inside = gears.pinion_teeth;
    let problem = format!("must be more than {inside}, the teeth of {planet}, which turns inside");
    teeth(gears.gear_teeth > inside, problem, format!("use more teeth on {ring}"))?;

    let fits = Mounting::without_backlash(gears).working_pressure_angle_rad > 0.0;
    shifts(fits, "the teeth would fit into one another at no distance".to_owned())?;

    let [wheel, mate] = gears.wheels();
    let start_mm = touched_curvature_mm(&wheel, &mate);
    let problem = format!(
        "the tips of {ring} reach {:.4} modules along the line of action beyond the point where it touches the base circle of \
         {planet}, inside of which there is no involute",
        -start_mm / gears.module_mm
    );
    let help = format!("use more teeth on {planet}, or raise {shift} or {}", gears.key("pressure_angle_deg"));
    teeth(start_mm >= 0.0, problem, help)?;

    let apart_rad = tips_apart_rad(gears);
    let problem = format!(
        "the tips of {planet} and {ring} foul where they pass one another beside the path of contact"
    );
    teeth(apart_rad >= 0.0, problem, format!("use more teeth on {ring} or fewer on {planet}"))?;

    let distance_mm = Mounting::new(gears).centre_distance_mm;
    let is_clear = mate.root_radius_mm > distance_mm + wheel.tip_radius_mm
        && mate.tip_radius_mm > distance_mm + wheel.root_radius_mm;
    shifts(is_clear, format!("the tips of {planet} would touch the roots of {ring}, or the other way round"))
}

/// (rad) By how much the ring's tip is still ahead, as an angle of the ring times its teeth, where the tip circles cut one another; less than 0
/// where a tip of the wheel would be there already.
///
/// `z₁ (inv α_a1 + δ₁) − z₂ (inv α_a2 + δ₂) + (z₂ − z₁) inv α_w` with the angles δ of the cut from the line of centres.
fn tips_apart_rad(gears: &Gears) -> f64 {
    let Mounting { centre_distance_mm: a, working_pressure_angle_rad, .. } = Mounting::new(gears);
    let [wheel, ring] = gears.wheels();
    let (own, of_ring) = (wheel.tip_radius_mm, ring.tip_radius_mm);
    let angle = |cos: f64| cos.clamp(-1.0, 1.0).acos();
    let cut = [
        angle((of_ring * of_ring - own * own - a * a) / (2.0 * own * a)),
        angle((a * a + of_ring * of_ring - own * own) / (2.0 * of_ring * a)),
    ];
    let [of_wheel, of_ring] = [(wheel, cut[0]), (ring, cut[1])].map(|(wheel, cut)| {
        let tip_rad = (wheel.base_radius_mm / wheel.tip_radius_mm).min(1.0).acos();
        f64::from(wheel.teeth) * (involute(tip_rad) + cut - involute(working_pressure_angle_rad))
    });
    of_wheel - of_ring
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(planet: u32, ring: u32, shifts: [f64; 2]) -> Result<(), (String, String)> {
        let mut gears = Gears::new(2.0, planet, ring, 20.0);
        (gears.internal, [gears.pinion_profile_shift, gears.gear_profile_shift]) = (true, shifts);
        NamedGears::of_pair(&gears).check().map_err(|error| {
            let help = error.help.as_deref().unwrap_or_default();
            (error.key.clone(), format!("{error} {help}"))
        })
    }

    #[test]
    fn sets_that_can_be_pass_and_others_are_refused_for_what_is_wrong() {
        for (planet, ring, shifts) in [
            (31, 81, [0.0; 2]),
            (36, 93, [0.2, 0.2]),
            (27, 78, [0.3, 0.1]),
            (40, 50, [0.0; 2]),
            (60, 69, [0.0; 2]),
        ] {
            assert_eq!(checked(planet, ring, shifts), Ok(()), "{planet}/{ring}");
        }
        let mut helical = Gears::new(2.0, 31, 81, 20.0);
        (helical.internal, helical.helix_angle_deg) = (true, 10.0);
        assert_eq!(NamedGears::of_pair(&helical).check().unwrap_err().key, "gears.helix_angle_deg");
        for (planet, ring, shifts, key, words) in [
            (81, 81, [0.0; 2], "gears.gear_teeth", "must be more than 81"),
            // The independent simulator's example of tips that reach below the planet's base circle.
            (17, 56, [0.0; 2], "gears.gear_teeth", "0.6105 modules"),
            (40, 48, [0.0; 2], "gears.gear_teeth", "foul"),
            (60, 68, [0.0; 2], "gears.gear_teeth", "foul"),
            (31, 81, [0.9, -0.2], "gears.gear_profile_shift", "more alike"),
        ] {
            let (found, message) = checked(planet, ring, shifts).unwrap_err();
            assert_eq!(found, key, "{planet}/{ring}: {message}");
            assert!(message.contains(words), "{message}");
        }
    }
}
