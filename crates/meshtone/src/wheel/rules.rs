//! Rules that concern several keys of two wheels in mesh.

use std::f64::consts::PI;

use super::contact::contact_ratio_of;
use super::internal_rules;
use super::mounting_rules::{self, fewer_than_limit, least_shift, thin_tips, touched_curvature_mm};
use super::{Gears, Hand, NamedGears, Wheel, WheelName};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::keys::{Check, below, refuse, require};

impl Gears {
    /// (-) Contact ratio: how many tooth pairs are in contact, on average.
    ///
    /// From tip to tip, without regard to undercut and chamfers.
    pub fn contact_ratio(&self) -> f64 {
        let [pinion, gear] = self.wheels();
        contact_ratio_of(&pinion, &gear)
    }

    /// Both wheels, the pinion first.
    pub(super) fn wheels(&self) -> [Wheel; 2] {
        WheelName::BOTH.map(|wheel| self.wheel(wheel))
    }

    /// One of the two wheels, as its teeth are: without a bore.
    pub(super) fn wheel(&self, wheel: WheelName) -> Wheel {
        Wheel::new(self, wheel, 0.0)
    }

    /// (mm) Half a tooth's thickness at the pitch circle, of the wheel whose teeth are thicker there.
    pub(crate) fn half_thickness_mm(&self) -> f64 {
        self.half_thicknesses_mm().into_iter().fold(0.0, f64::max)
    }

    /// (mm) Half a tooth's thickness at the pitch circle, of the pinion and of the gear: `m (π/4 + x tan α)`, of a ring
    /// `m (π/4 − x tan α)`.
    fn half_thicknesses_mm(&self) -> [f64; 2] {
        let tan = self.pressure_angle_deg.to_radians().tan();
        WheelName::BOTH.map(|wheel| {
            let outwards = self.sign(wheel) * self.profile_shift(wheel);
            PI * self.module_mm / 4.0 + self.module_mm * outwards * tan
        })
    }

    /// (mm) Half the thickness of a tooth of pinion and gear at a distance from its tip, before the constant reduction of its flank.
    pub(crate) fn half_thicknesses_below_tip_mm(&self, below_tip_mm: f64) -> [f64; 2] {
        self.wheels().map(|wheel| half_thickness_below_tip_mm(&wheel, below_tip_mm))
    }

    /// (mm) How far the chamfers of a wheel's tips and their relief reach inwards from the tip; 0 where there is none.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn tip_lengths_mm(&self, wheel: WheelName) -> [f64; 2] {
        let relief = &self.flank_relief[wheel as usize];
        [self.chamfer_mm(wheel), if relief.amount_um > 0.0 { relief.length_mm } else { 0.0 }]
    }

    /// (mm) Height of a tooth from root to tip, of the wheel whose teeth are higher.
    pub(crate) fn tooth_height_mm(&self) -> f64 {
        let heights =
            WheelName::BOTH.map(|wheel| self.dedendum(wheel) + self.addendum(wheel) + self.tip_alteration());
        heights.into_iter().fold(0.0, f64::max) * self.module_mm
    }
}

impl NamedGears<'_> {
    /// The two wheels together, whose keys are each in their range.
    pub(crate) fn check(&self) -> Check {
        if self.internal {
            internal_rules::check(self)?;
        } else {
            mounting_rules::check(self)?;
        }
        pressure_angle(self)?;
        contact_ratio(self)?;
        helix(self)?;
        let (key, reduction_mm, thickness_mm) = self.thinner(self.half_thicknesses_mm());
        below(&key, reduction_mm, thickness_mm, HALF_THICKNESS)?;
        for (wheel, relief) in WheelName::BOTH.into_iter().zip(&self.flank_relief) {
            if relief.amount_um > 0.0 {
                let key = self.key_of_each(wheel, "flank_relief.length_mm", &self.flank_relief);
                below(&key, relief.length_mm, 2.0 * self.module_mm, "2 modules")?;
            }
        }
        if self.end_relief.amount_um > 0.0 {
            let (length_mm, half_mm) = (self.end_relief.length_mm, self.face_width_mm / 2.0);
            let problem = format!("must be at most {half_mm} mm, half the face width");
            require(&self.key("end_relief.length_mm"), length_mm, length_mm <= half_mm, problem)?;
        }
        for wheel in WheelName::BOTH {
            let key = self.key_of_each(wheel, "tip_chamfer_mm", &self.tip_chamfer_mm);
            below(&key, self.chamfer_mm(wheel), self.module_mm, "the module")?;
        }
        // The default grows with the centre distance: it is no typing error of the user.
        if let Some(backlash_mm) = self.backlash_mm {
            below(&self.key("backlash_mm"), backlash_mm, self.module_mm, "the module")?;
        }
        tip_thickness(self)
    }

    /// The constant reduction of a flank, in mm, of the wheel of whose thickness it leaves less: its key, its value and that thickness.
    fn thinner(&self, thickness_mm: [f64; 2]) -> (String, f64, f64) {
        let removed_mm = self.uniform_flank_reduction_mm;
        let left_mm = |wheel: usize| thickness_mm[wheel] - removed_mm[wheel];
        let wheel = if left_mm(0) <= left_mm(1) { WheelName::Pinion } else { WheelName::Gear };
        let key = self.key_of_each(wheel, "uniform_flank_reduction_mm", &removed_mm);
        (key, removed_mm[wheel as usize], thickness_mm[wheel as usize])
    }

    /// Warnings about wheels that can be simulated.
    pub(crate) fn warnings(&self) -> Vec<ScenarioWarning> {
        undercut(self).chain(thin_tips(self)).chain(hand_of_spur(self)).chain(reliefs_cut_off(self)).collect()
    }
}

/// The hand of a helix that the wheels do not have.
fn hand_of_spur(gears: &NamedGears) -> Option<ScenarioWarning> {
    let is_ignored = gears.hand != Hand::Right && !gears.is_helical();
    is_ignored.then(|| {
        let message = "has no effect: the wheels are spur; give helix_angle_deg, or remove hand";
        ScenarioWarning::new(WarningKind::IgnoredKey, gears.key("hand"), message)
    })
}

/// Reliefs that end where the chamfer of the tips begins, so that none of them is left.
fn reliefs_cut_off(gears: &NamedGears) -> Vec<ScenarioWarning> {
    let of_wheel = |wheel: WheelName| {
        let [chamfer_mm, relief_mm] = gears.tip_lengths_mm(wheel);
        (relief_mm > 0.0 && relief_mm <= chamfer_mm).then(|| {
            let message = format!(
                "has no effect: {relief_mm:.2} mm are relieved from the tip inwards, and the tip chamfer takes {chamfer_mm:.2} mm; lengthen \
                 the relief"
            );
            let key = gears.key_of_each(wheel, "flank_relief.length_mm", &gears.flank_relief);
            ScenarioWarning::new(WarningKind::IgnoredKey, key, message)
        })
    };
    let mut warnings: Vec<_> = WheelName::BOTH.into_iter().filter_map(of_wheel).collect();
    warnings.dedup();
    warnings
}

/// The number of slices of a face that is not cut into slices.
///
/// # Arguments
/// * `gears` - the wheels
/// * `slices` - of the mesh's face: 1 where its gap does not vary along it
pub(crate) fn unused_slices(gears: &NamedGears, slices: usize) -> Option<ScenarioWarning> {
    (slices == 1 && gears.slices != Gears::SLICES).then(|| {
        let message = "has no effect: the face is taken as a whole; give lead_crowning_um or end_relief, or remove slices";
        ScenarioWarning::new(WarningKind::IgnoredKey, gears.key("slices"), message)
    })
}

/// Name of [`Gears::half_thickness_mm`] in messages.
pub(crate) const HALF_THICKNESS: &str = "half the tooth's thickness at the pitch circle";

/// Undercut of wheels without a shift.
fn undercut(gears: &NamedGears<'_>) -> impl Iterator<Item = ScenarioWarning> {
    WheelName::BOTH.into_iter().filter_map(move |name| {
        let limit = fewer_than_limit(gears, name)?;
        let (teeth, mate, angle) = (gears.teeth(name), gears.teeth(name.mate()), gears.pressure_angle_deg);
        let reach = if interferes(&gears.wheel(name), &gears.wheel(name.mate())) {
            format!(", and the {mate} teeth of its mate reach below its involute (interference)")
        } else {
            String::new()
        };
        let message = format!(
            "{teeth} teeth are undercut at a pressure angle of {angle}° (fewer than {limit}){reach}, which \
             the tooth profile of this model does not show; use at least {limit} teeth, a larger \
             pressure angle, or {} = {:.4} or more",
            gears.key_of(name, "profile_shift"),
            least_shift(gears, name)
        );
        Some(ScenarioWarning::new(WarningKind::Undercut, gears.key_of(name, "teeth"), message))
    })
}

/// Returns whether the mate's tip reaches beyond the point where the line of action touches the wheel's base circle.
fn interferes(wheel: &Wheel, mate: &Wheel) -> bool {
    touched_curvature_mm(wheel, mate) < 0.0
}

fn pressure_angle(gears: &NamedGears) -> Check {
    let key = gears.key("pressure_angle_deg");
    let is_pointed = |wheel: &Wheel| wheel.half_thickness_angle_at_rad(wheel.tip_radius_mm) <= 0.0;
    let Some(fewest) = gears.wheels().iter().filter(|wheel| is_pointed(wheel)).map(|wheel| wheel.teeth).min()
    else {
        return Ok(());
    };
    let problem = format!(
        "must be smaller for a wheel of {fewest} teeth, whose tips would be pointed below full height"
    );
    Err(refuse(&key, gears.pressure_angle_deg, problem).with_help(format!("lower {key}, or use more teeth")))
}

/// (°) Least helix angle but 0: below, a contact line's place on the face is lost to rounding.
const LEAST_HELIX_DEG: f64 = 0.01;
/// (-) Largest total contact ratio: wider faces carry their load by so many pairs that nothing is left to be heard of a single one.
const MOST_TOTAL_CONTACT_RATIO: f64 = 12.0;

/// The helix of helical wheels.
fn helix(gears: &NamedGears) -> Check {
    if !gears.is_helical() {
        return Ok(());
    }
    let (key, angle_deg) = (gears.key("helix_angle_deg"), gears.helix_angle_deg);
    require(
        &key,
        angle_deg,
        angle_deg >= LEAST_HELIX_DEG,
        format!("must be 0 or at least {LEAST_HELIX_DEG}°"),
    )?;
    let total = gears.total_contact_ratio();
    let problem = format!(
        "the face is so wide that the total contact ratio is {total:.1}; it must be at most {MOST_TOTAL_CONTACT_RATIO}"
    );
    require(&key, angle_deg, total <= MOST_TOTAL_CONTACT_RATIO, problem).map_err(|error| {
        error.with_help("lower the helix angle or the face width, or use a larger module")
    })?;
    let transverse = gears.contact_ratio();
    let problem = format!("the transverse contact ratio is {transverse:.3}; it must be more than 0");
    let [pinion, gear] = WheelName::BOTH.map(|wheel| gears.key_of(wheel, "teeth"));
    require(&gears.whole(), transverse, transverse > 0.0, problem).map_err(|error| {
        error.with_help(format!("raise {pinion} or {gear}, or lower {}", gears.key("centre_distance_mm")))
    })
}

fn contact_ratio(gears: &NamedGears) -> Check {
    let ratio = gears.total_contact_ratio();
    if ratio >= 1.0 {
        return Ok(());
    }
    let problem =
        format!("the contact ratio is {ratio:.3}; it must be at least 1, or the teeth lose contact");
    let [pinion, gear] = WheelName::BOTH.map(|wheel| gears.key_of(wheel, "teeth"));
    let help = format!("raise {pinion} or {gear}, or lower {}", gears.key("pressure_angle_deg"));
    Err(ScenarioError::new(gears.whole(), format!("contact ratio {ratio:.3}"), problem).with_help(help))
}

/// Crowning must leave some of the tip: the compliances take what is beyond the tooth's centre line for a negative thickness.
fn tip_thickness(gears: &NamedGears) -> Check {
    let (key, removed, left) = gears.thinner(gears.half_thicknesses_below_tip_mm(0.0));
    let problem = format!(
        "{removed:?} mm is removed where the tooth is only {left:.4} mm thick from its centre line, at the tip; must leave some of the tip"
    );
    require(&key, removed, removed < left, problem)
}

/// (mm) Half thickness of an unrelieved tooth, `below_tip_mm` from the tip along its centre line; of its foot on the
/// base circle, or of a ring's tooth on the root circle, where that is nearer.
fn half_thickness_below_tip_mm(wheel: &Wheel, below_tip_mm: f64) -> f64 {
    let (base, foot) = (wheel.sign() * wheel.base_radius_mm, wheel.foot_angle_rad());
    let roll_at = |radius_mm: f64| (wheel.base_radius_mm / radius_mm).acos().tan();
    let flank = |roll: f64| {
        let (sin, cos) = (foot - roll).sin_cos();
        (base * (cos - roll * sin), base * (sin + roll * cos))
    };
    let tip_roll = roll_at(wheel.tip_radius_mm);
    let x = flank(tip_roll).0 - below_tip_mm;
    let foot_roll = if wheel.is_internal { roll_at(wheel.root_radius_mm) } else { 0.0 };
    let (mut low, mut high) = (foot_roll, tip_roll);
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
        let reaches = |pinion, gear| {
            let [pinion, gear] = Gears::new(3.0, pinion, gear, 15.0).wheels();
            interferes(&pinion, &gear)
        };
        assert!(!reaches(13, 16) && reaches(13, 17));
        assert!(!reaches(15, 45) && reaches(15, 46));
    }

    // No pair that passes the other rules gets there: it takes a wheel of a single tooth.
    #[test]
    fn contact_ratio_below_one_names_what_to_change() {
        let mut gears = Gears::new(3.0, 1, 1, 15.0);
        gears.pressure_angle_deg = 40.0;
        let error = contact_ratio(&NamedGears::of_pair(&gears)).unwrap_err();
        assert_eq!(error.key, "gears");
        assert!(error.problem.contains("contact ratio is 0.938"), "{}", error.problem);
        let help = error.help.unwrap();
        for key in ["gears.pinion_teeth", "gears.gear_teeth", "gears.pressure_angle_deg"] {
            assert!(help.contains(key), "{help}");
        }
    }
}
