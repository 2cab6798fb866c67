//! Rules that concern several keys of `[gears]`.

use std::f64::consts::PI;

use super::{Gears, TipRelief};
use crate::error::{ScenarioError, ScenarioWarning};
use crate::keys::{Check, below, check_keys, refuse, require};

impl Gears {
    /// (-) Contact ratio: how many tooth pairs are in contact, on average.
    ///
    /// For teeth of standard addendum, without regard to undercut: [`crate::wheel::contact_ratio`].
    pub fn contact_ratio(&self) -> f64 {
        crate::wheel::contact_ratio(self.pinion_teeth, self.gear_teeth, self.pressure_angle_deg.to_radians())
    }

    /// Every key alone, and the two wheels together.
    pub(crate) fn check(&self) -> Check {
        check_keys(self, "gears")?;
        pressure_angle(self)?;
        contact_ratio(self)?;
        self.tip_relief.map_or(Ok(()), |relief| tip_relief(&relief, self.module_mm))?;
        below("gears.crowning_mm", self.crowning_mm, self.half_thickness_mm(), HALF_THICKNESS)?;
        let relief = &self.flank_relief;
        if relief.amount_um > 0.0 {
            below("gears.flank_relief.length_mm", relief.length_mm, 2.0 * self.module_mm, "2 modules")?;
        }
        below("gears.tip_chamfer_mm", self.chamfer_mm(), self.module_mm, "the module")?;
        // The default grows with the centre distance: it is no slip of the user's.
        if let Some(backlash_mm) = self.backlash_mm {
            below("gears.backlash_mm", backlash_mm, self.module_mm, "the module")?;
        }
        tip_thickness(self)
    }

    /// What can be simulated but deserves attention.
    pub(crate) fn warnings(&self) -> Vec<ScenarioWarning> {
        undercut(self).chain(flared_tip(self)).collect()
    }

    /// (mm) Half a tooth's thickness at the pitch circle.
    pub(crate) fn half_thickness_mm(&self) -> f64 {
        half_thickness_mm(self.module_mm)
    }

    /// (mm) Height of a tooth of standard proportions, from root to tip.
    pub(crate) fn tooth_height_mm(&self) -> f64 {
        2.25 * self.module_mm
    }
}

/// What [`Gears::half_thickness_mm`] is, in words for a message.
pub(crate) const HALF_THICKNESS: &str = "half the tooth's thickness at the pitch circle";

fn half_thickness_mm(module_mm: f64) -> f64 {
    PI * module_mm / 4.0
}

/// Undercut, by the rule `z < 2/sin²α`. Its limit is rounded down, as in the textbooks: for 20° it
/// is 17.1, and 17 teeth are made without undercut to speak of.
fn undercut(gears: &Gears) -> impl Iterator<Item = ScenarioWarning> {
    let limit = (2.0 / gears.pressure_angle_deg.to_radians().sin().powi(2)).floor();
    [
        ("gears.pinion_teeth", gears.pinion_teeth, gears.gear_teeth),
        ("gears.gear_teeth", gears.gear_teeth, gears.pinion_teeth),
    ]
    .into_iter()
    .filter(move |&(_, teeth, _)| f64::from(teeth) < limit)
    .map(move |(key, teeth, mate)| {
        let angle = gears.pressure_angle_deg;
        let reach = if interferes(teeth, mate, angle.to_radians()) {
            format!(", and the {mate} teeth of its mate reach below its involute (interference)")
        } else {
            String::new()
        };
        let message = format!(
            "{teeth} teeth are undercut at a pressure angle of {angle}° (fewer than {limit}){reach}, which \
             the tooth profile of this model does not show; use at least {limit} teeth, or a larger \
             pressure angle"
        );
        ScenarioWarning::new(key, message)
    })
}

/// The relief is measured from the tooth's thickness where it starts, so that little of it thickens the tip.
fn flared_tip(gears: &Gears) -> Option<ScenarioWarning> {
    let relief = gears.tip_relief?;
    let least = [gears.pinion_teeth, gears.gear_teeth]
        .map(|teeth| {
            let half_thickness =
                |below_tip_mm| half_thickness_below_tip_mm(gears, f64::from(teeth), below_tip_mm);
            half_thickness(relief.length_mm) - half_thickness(0.0)
        })
        .into_iter()
        .fold(0.0, f64::max);
    (relief.depth_mm < least).then(|| {
        let message = format!(
            "adds metal to the tip: the depth is that from the thickness {} mm below the tip, and the tooth itself \
             thins by up to {least:.4} mm from there on; use at least that, plus the relief itself",
            relief.length_mm
        );
        ScenarioWarning::new("gears.tip_relief.depth_mm", message)
    })
}

/// Whether the mate's tip reaches beyond the point where the line of action touches the wheel's base circle:
/// `(z_m + 2)² > (z_m cos α)² + ((z + z_m) sin α)²`, with `z_m` the mate's tooth count.
fn interferes(teeth: u32, mate: u32, pressure_angle_rad: f64) -> bool {
    let (sin, cos) = pressure_angle_rad.sin_cos();
    let (z, mate) = (f64::from(teeth), f64::from(mate));
    (mate + 2.0).powi(2) > (mate * cos).powi(2) + ((z + mate) * sin).powi(2)
}

fn pressure_angle(gears: &Gears) -> Check {
    const KEY: &str = "gears.pressure_angle_deg";
    let angle = gears.pressure_angle_deg;
    let fewest = gears.pinion_teeth.min(gears.gear_teeth);
    require(
        KEY,
        angle,
        tip_half_angle(f64::from(fewest), angle.to_radians()) > 0.0,
        format!(
            "must be smaller for a wheel of {fewest} teeth, whose tips would be pointed below full height"
        ),
    )
    .map_err(|error| error.with_help("lower gears.pressure_angle_deg, or use more teeth"))
}

/// (rad) Half the angle that a tooth's tip subtends at the wheel's centre.
fn tip_half_angle(teeth: f64, pressure_angle: f64) -> f64 {
    let involute = |angle: f64| angle.tan() - angle;
    let at_tip = (teeth * pressure_angle.cos() / (teeth + 2.0)).acos();
    PI / (2.0 * teeth) + involute(pressure_angle) - involute(at_tip)
}

fn contact_ratio(gears: &Gears) -> Check {
    let ratio = gears.contact_ratio();
    if ratio >= 1.0 {
        return Ok(());
    }
    let problem =
        format!("the contact ratio is {ratio:.3}; it must be at least 1, or the teeth lose contact");
    Err(ScenarioError::new("gears", format!("contact ratio {ratio:.3}"), problem)
        .with_help("raise gears.pinion_teeth or gears.gear_teeth, or lower gears.pressure_angle_deg"))
}

fn tip_relief(relief: &TipRelief, module_mm: f64) -> Check {
    let longest = 2.0 * module_mm;
    require(
        "gears.tip_relief.length_mm",
        relief.length_mm,
        relief.length_mm > 0.0 && relief.length_mm < longest,
        format!("must be more than 0 and less than {longest:.4} mm, the height of the working flank"),
    )
    .and_then(|()| {
        let deepest = half_thickness_mm(module_mm);
        below("gears.tip_relief.depth_mm", relief.depth_mm, deepest, HALF_THICKNESS)
    })
    .map_err(|error| error.with_help(NO_RELIEF))
}

/// What may be wanted where a relief is refused.
pub(super) const NO_RELIEF: &str = "for no relief, write tip_relief = false; its default is 1 mm × 1 mm";

/// Relief and crowning must leave some of the tip: the compliances take what is beyond the tooth's centre line for a
/// negative thickness.
fn tip_thickness(gears: &Gears) -> Check {
    let (length, depth) = gears.tip_relief.map_or((0.0, 0.0), |relief| (relief.length_mm, relief.depth_mm));
    let left = [gears.pinion_teeth, gears.gear_teeth]
        .map(|teeth| half_thickness_below_tip_mm(gears, f64::from(teeth), length))
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let removed = depth + gears.crowning_mm;
    if removed < left {
        return Ok(());
    }
    let with_crowning = if gears.crowning_mm > 0.0 { "with gears.crowning_mm, " } else { "" };
    let problem = format!(
        "{with_crowning}{removed:?} mm is removed where the tooth is only {left:.4} mm thick from its \
         centre line, {length:?} mm below the tip; must leave some of the tip"
    );
    let (key, value) = match gears.tip_relief {
        Some(relief) => ("gears.tip_relief.depth_mm", relief.depth_mm),
        None => ("gears.crowning_mm", gears.crowning_mm),
    };
    Err(refuse(key, value, problem).with_help(
        "lower gears.tip_relief.depth_mm (the default relief, 1 mm × 1 mm, is for modules above 1.5 mm), or write \
         tip_relief = false for none",
    ))
}

/// (mm) Half thickness of an unrelieved tooth, `below_tip_mm` from the tip along its centre line; of its foot on the
/// base circle where that is nearer.
fn half_thickness_below_tip_mm(gears: &Gears, teeth: f64, below_tip_mm: f64) -> f64 {
    let angle = gears.pressure_angle_deg.to_radians();
    let base = gears.module_mm * teeth / 2.0 * angle.cos();
    let foot = PI / (2.0 * teeth) + angle.tan() - angle;
    let flank = |roll: f64| {
        let (sin, cos) = (foot - roll).sin_cos();
        (base * (cos - roll * sin), base * (sin + roll * cos))
    };
    let tip_roll = (teeth * angle.cos() / (teeth + 2.0)).acos().tan();
    let x = flank(tip_roll).0 - below_tip_mm;
    let (mut low, mut high) = (0.0, tip_roll);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if flank(middle).0 < x { low = middle } else { high = middle }
    }
    flank(high).1
}

/// Enough for a double's precision.
const BISECTIONS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    // The published model's numbers.
    #[test]
    fn contact_ratios_of_the_reference_pairs() {
        for (pinion, gear, expected) in [(17, 38, 1.6090998696667), (18, 35, 1.608198199494087)] {
            let ratio = Gears::new(3.0, pinion, gear, 15.0).contact_ratio();
            assert!((ratio - expected).abs() < 1e-12, "{ratio}");
        }
    }

    // The smallest pinions at 20° that run with a given gear without interference: 13 with 16, 15 with 45 (Shigley,
    // Mechanical Engineering Design, section 13-7).
    #[test]
    fn interference_of_small_pinions() {
        let angle = 20f64.to_radians();
        assert!(!interferes(13, 16, angle) && interferes(13, 17, angle));
        assert!(!interferes(15, 45, angle) && interferes(15, 46, angle));
    }

    // No pair that passes the other rules gets there: it takes a wheel of a single tooth.
    #[test]
    fn contact_ratio_below_one_names_what_to_change() {
        let mut gears = Gears::new(3.0, 1, 1, 15.0);
        gears.pressure_angle_deg = 40.0;
        let error = contact_ratio(&gears).unwrap_err();
        assert_eq!(error.key, "gears");
        assert!(error.problem.contains("contact ratio is 0.938"), "{}", error.problem);
        let help = error.help.unwrap();
        for key in ["gears.pinion_teeth", "gears.gear_teeth", "gears.pressure_angle_deg"] {
            assert!(help.contains(key), "{help}");
        }
    }
}
