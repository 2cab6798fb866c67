//! Rules about profile shift, basic racks and centre distance. Each names the number that would do.

use super::{Gears, Mounting, NamedGears, Wheel, WheelName};
use crate::error::{ScenarioWarning, WarningKind};
use crate::keys::{Check, refuse, require};

/// (modules) By how much the tip of a rack-shaped tool is rounded: below it no involute is made.
///
/// Source: ISO 53:1998, profile A: clearance 0.25, fillet radius 0.38, `0.38 (1 − sin 20°) = 0.25`.
pub(super) const TOOL_ROUNDING: f64 = 0.25;

/// (modules) Tips thinner than this are warned of.
///
/// Source: G. Niemann, H. Winter, *Maschinenelemente II*, section 21.5: 0.2 modules, 0.4 of hardened teeth.
const THIN_TIP: f64 = 0.2;

/// Checks wheels that are not standard ones, alone and together; standard ones have rules of their own.
pub(super) fn check(gears: &NamedGears) -> Check {
    if gears.beyond_standard().is_empty() || is_sound(gears) {
        return Ok(());
    }
    shifts_together(gears)?;
    for wheel in WheelName::BOTH {
        undercut(gears, wheel)?;
        pointed(gears, wheel)?;
        closed_space(gears, wheel)?;
    }
    centre_distance(gears)?;
    for wheel in WheelName::BOTH {
        clearance(gears, wheel)?;
        interference(gears, wheel)?;
    }
    contact_ratio(gears)
}

/// Returns whether all of the rules hold.
fn is_sound(gears: &Gears) -> bool {
    let both =
        |holds: fn(&Gears, WheelName) -> bool| WheelName::BOTH.into_iter().all(|wheel| holds(gears, wheel));
    can_mesh(gears)
        && both(is_not_undercut)
        && both(has_tips)
        && both(has_spaces)
        && has_room(gears)
        && has_backlash(gears)
        && both(is_clear)
        && both(is_free)
        && stays_in_contact(gears)
}

/// Tips that could break off.
pub(super) fn thin_tips(gears: &NamedGears<'_>) -> impl Iterator<Item = ScenarioWarning> {
    let least_mm = THIN_TIP * gears.module_mm;
    WheelName::BOTH.into_iter().filter_map(move |name| {
        let thickness_mm = tip_thickness_mm(gears, name);
        let (teeth, shift) = (gears.teeth(name), gears.profile_shift(name));
        let key = if shift == 0.0 { "teeth" } else { "profile_shift" };
        let message = format!(
            "the tips of {teeth} teeth are {thickness_mm:.4} mm thick, less than {THIN_TIP} modules ({least_mm:.4} mm), and \
             could break off; lower the profile shift or the addendum"
        );
        let key = gears.key_of(name, key);
        (thickness_mm < least_mm).then(|| ScenarioWarning::new(WarningKind::ThinTips, key, message))
    })
}

/// (-) Least profile shift that leaves a wheel without undercut, `h − z sin²α_t/(2 cos β)`, h the height of the tool's straight flank:
/// the dedendum coefficient less the tool's rounding. To four digits, rounded up.
pub(super) fn least_shift(gears: &Gears, wheel: WheelName) -> f64 {
    rounded_up(straight_dedendum(gears, wheel) - f64::from(gears.teeth(wheel)) * undercut_height(gears))
}

/// Number of teeth below which a wheel without a shift is undercut, where it has no shift and fewer.
pub(super) fn fewer_than_limit(gears: &Gears, wheel: WheelName) -> Option<f64> {
    limit_without_shift(gears, wheel).filter(|_| gears.profile_shift(wheel) == 0.0)
}

/// Number of teeth below which a wheel without a shift is undercut, `2h/sin²α`, where it has fewer. Rounded down, as in the textbooks:
/// for 20° it is 17.1, and 17 teeth are made without undercut to speak of.
fn limit_without_shift(gears: &Gears, wheel: WheelName) -> Option<f64> {
    let limit = (straight_dedendum(gears, wheel) / undercut_height(gears)).floor();
    let is_undercut = f64::from(gears.teeth(wheel)) < limit;
    is_undercut.then_some(limit)
}

/// (modules) Height of the tool's straight flank per tooth below which a wheel without a shift is undercut, `sin²α_t/(2 cos β)`.
fn undercut_height(gears: &Gears) -> f64 {
    let sin = gears.transverse_pressure_angle_rad().sin();
    sin * sin / 2.0 * (gears.transverse_module_mm() / gears.module_mm)
}

/// (-) Dedendum coefficient of the part of a wheel's flank that the tool's straight flank makes.
fn straight_dedendum(gears: &Gears, wheel: WheelName) -> f64 {
    gears.dedendum(wheel) - TOOL_ROUNDING
}

/// Without a shift a wheel is simulated as if it was not undercut, with a warning.
fn is_not_undercut(gears: &Gears, wheel: WheelName) -> bool {
    let shift = gears.profile_shift(wheel);
    shift == 0.0 || shift >= least_shift(gears, wheel)
}

fn undercut(gears: &NamedGears, wheel: WheelName) -> Check {
    let problem = format!(
        "{} teeth are undercut at a pressure angle of {}°; must be at least {:.4}",
        gears.teeth(wheel),
        gears.pressure_angle_deg,
        least_shift(gears, wheel)
    );
    let key = Coefficient::Shift(wheel).key(gears);
    require(&key, gears.profile_shift(wheel), is_not_undercut(gears, wheel), problem)
        .map_err(|error| error.with_help(undercut_help(gears, wheel)))
}

fn undercut_help(gears: &Gears, wheel: WheelName) -> &'static str {
    match limit_without_shift(gears, wheel) {
        Some(_) => {
            "without a shift (0) such teeth are simulated as if they were not undercut, with a warning"
        }
        None => "raise it; without a shift (0) so many teeth are not undercut",
    }
}

/// Returns whether there is a distance at which the teeth fit into one another: not with shifts too far inwards.
fn can_mesh(gears: &Gears) -> bool {
    Mounting::without_backlash(gears).working_pressure_angle_rad > 0.0
}

fn shifts_together(gears: &NamedGears) -> Check {
    let [smaller, other] = if gears.pinion_profile_shift < gears.gear_profile_shift {
        WheelName::BOTH
    } else {
        [WheelName::Gear, WheelName::Pinion]
    };
    let causes = [Coefficient::Shift(smaller), Coefficient::Shift(other)];
    refuse_first(gears, &causes, "the teeth would fit into one another at no distance", &can_mesh)
}

/// Returns whether tips end at their height.
fn has_tips(gears: &Gears, wheel: WheelName) -> bool {
    tip_thickness_mm(gears, wheel) > 0.0
}

fn pointed(gears: &NamedGears, wheel: WheelName) -> Check {
    let what = format!("the tips of {} teeth would be pointed", gears.teeth(wheel));
    let causes = [Coefficient::Shift(wheel), Coefficient::Addendum(wheel)];
    refuse_first(gears, &causes, &what, &|gears| has_tips(gears, wheel))
}

/// Returns whether the spaces between teeth are open down to their roots.
fn has_spaces(gears: &Gears, wheel: WheelName) -> bool {
    let wheel = gears.wheel(wheel);
    let foot_mm = wheel.root_radius_mm.max(wheel.base_radius_mm);
    wheel.half_thickness_angle_at_rad(foot_mm) < wheel.half_pitch_angle_rad()
}

fn closed_space(gears: &NamedGears, wheel: WheelName) -> Check {
    let what = format!("the spaces between {} teeth would close above their roots", gears.teeth(wheel));
    let causes = [Coefficient::Dedendum(wheel), Coefficient::Shift(wheel)];
    refuse_first(gears, &causes, &what, &|gears| has_spaces(gears, wheel))
}

/// Returns whether the axes are as far apart as teeth of nominal thickness need.
fn has_room(gears: &Gears) -> bool {
    gears
        .centre_distance_mm
        .is_none_or(|distance_mm| distance_mm >= Mounting::least_centre_distance_mm(gears))
}

/// Returns whether a given backlash is at least what a given distance opens.
fn has_backlash(gears: &Gears) -> bool {
    gears.backlash_mm.is_none_or(|backlash_mm| backlash_mm >= Mounting::new(gears).opened_backlash_mm)
}

fn centre_distance(gears: &NamedGears) -> Check {
    let key = gears.key("centre_distance_mm");
    let Some(distance_mm) = gears.centre_distance_mm else { return Ok(()) };
    let tight_mm = rounded_up(Mounting::without_backlash(gears).centre_distance_mm);
    let problem =
        format!("must be at least {tight_mm:.4} mm, where teeth with these profile shifts have no backlash");
    require(&key, distance_mm, has_room(gears), problem)
        .map_err(|error| error.with_help("leave it out for that distance, or lower a profile shift"))?;
    let opened_mm = rounded_up(Mounting::new(gears).opened_backlash_mm);
    let problem = format!(
        "must be at least {opened_mm:.4} mm, which {key} = {distance_mm:?} opens between teeth of nominal thickness"
    );
    require(&gears.key("backlash_mm"), gears.backlash_mm.unwrap_or(0.0), has_backlash(gears), problem)
        .map_err(|error| error.with_help("leave it out for the standard's least backlash on top of that"))
}

/// Returns whether the mate's tips stay off the ground of a wheel's tooth spaces.
fn is_clear(gears: &Gears, wheel: WheelName) -> bool {
    let (own, mate) = (gears.wheel(wheel), gears.wheel(wheel.mate()));
    own.working_pitch_radius_mm + mate.working_pitch_radius_mm > own.root_radius_mm + mate.tip_radius_mm
}

fn clearance(gears: &NamedGears, wheel: WheelName) -> Check {
    let mate = wheel.mate();
    let what = format!("{}'s tips would touch {}'s roots", gears.name(mate), gears.name(wheel));
    let causes = [Coefficient::Dedendum(wheel), Coefficient::Addendum(mate), Coefficient::Shift(wheel)];
    refuse_first(gears, &causes, &what, &|gears| is_clear(gears, wheel))
}

/// Returns whether the mate's tips stay off a wheel's fillets, in which its involute has ended. A wheel that is undercut without a shift
/// is warned of instead.
fn is_free(gears: &Gears, wheel: WheelName) -> bool {
    let (own, mate) = (gears.wheel(wheel), gears.wheel(wheel.mate()));
    let sin = own.pressure_angle_rad.sin();
    let below_mm = gears.module_mm * (straight_dedendum(gears, wheel) - gears.profile_shift(wheel));
    let end_mm = (own.pitch_radius_mm * sin - below_mm / sin).max(0.0);
    fewer_than_limit(gears, wheel).is_some()
        || touched_curvature_mm(&own, &mate) >= end_mm - ROUNDING * own.module_mm
}

fn interference(gears: &NamedGears, wheel: WheelName) -> Check {
    let mate = wheel.mate();
    let what =
        format!("{}'s tips would reach into the fillets of {}'s teeth", gears.name(mate), gears.name(wheel));
    let causes = [
        Coefficient::Addendum(mate),
        Coefficient::Dedendum(wheel),
        Coefficient::Shift(mate),
        Coefficient::Shift(wheel),
    ];
    refuse_first(gears, &causes, &what, &|gears| is_free(gears, wheel))
}

/// (mm) Radius of curvature of a wheel's flank where the mate's tip touches it first; less than 0 where the tip reaches beyond
/// its base circle, and of a ring.
pub(super) fn touched_curvature_mm(wheel: &Wheel, mate: &Wheel) -> f64 {
    let distance_mm =
        wheel.sign() * wheel.working_pitch_radius_mm + mate.sign() * mate.working_pitch_radius_mm;
    distance_mm * wheel.working_pressure_angle_rad.sin() - mate.curvature_mm(mate.tip_radius_mm)
}

/// Part of a module that is left to rounding.
const ROUNDING: f64 = 1e-9;

/// Returns whether a pair of teeth is still in contact when the next one comes.
fn stays_in_contact(gears: &Gears) -> bool {
    gears.total_contact_ratio() >= 1.0
}

/// By the distance, else by one of the coefficients; what is left is refused as of standard wheels.
fn contact_ratio(gears: &NamedGears) -> Check {
    let what = format!("the contact ratio is {:.3}, less than 1", gears.total_contact_ratio());
    if let Some(distance_mm) = gears.centre_distance_mm {
        let tight_mm = Mounting::without_backlash(gears).centre_distance_mm;
        let at = |distance_mm| Gears { centre_distance_mm: Some(distance_mm), ..Gears::clone(gears) };
        let does = |distance_mm| stays_in_contact(&at(distance_mm));
        if let Some(most) = nearest_valid(distance_mm, tight_mm, does).filter(|_| !does(distance_mm)) {
            let problem = format!("{what}; must be at most {most:.4} mm");
            return Err(refuse(&gears.key("centre_distance_mm"), distance_mm, problem));
        }
    }
    let of_wheel = |wheel| [Coefficient::Shift(wheel), Coefficient::Addendum(wheel)];
    let causes = [of_wheel(WheelName::Pinion), of_wheel(WheelName::Gear)].concat();
    refuse_first(gears, &causes, &what, &stays_in_contact)
}

/// (mm) Thickness of a wheel's teeth at the tip, along its circle.
fn tip_thickness_mm(gears: &Gears, wheel: WheelName) -> f64 {
    let wheel = gears.wheel(wheel);
    2.0 * wheel.tip_radius_mm * wheel.half_thickness_angle_at_rad(wheel.tip_radius_mm)
}

/// A number that shapes a wheel's teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Coefficient {
    Shift(WheelName),
    Addendum(WheelName),
    Dedendum(WheelName),
}

impl Coefficient {
    fn key(self, gears: &NamedGears) -> String {
        let (wheel, name) = match self {
            Self::Shift(wheel) => (wheel, "profile_shift"),
            Self::Addendum(wheel) => (wheel, "addendum"),
            Self::Dedendum(wheel) => (wheel, "dedendum"),
        };
        gears.key_of(wheel, name)
    }

    fn of(self, gears: &mut Gears) -> &mut f64 {
        match self {
            Self::Shift(wheel) => {
                wheel.choose(&mut gears.pinion_profile_shift, &mut gears.gear_profile_shift)
            }
            Self::Addendum(wheel) => wheel.choose(&mut gears.pinion_addendum, &mut gears.gear_addendum),
            Self::Dedendum(wheel) => wheel.choose(&mut gears.pinion_dedendum, &mut gears.gear_dedendum),
        }
    }

    /// Of the standard wheels that the pair would be without its further keys.
    fn default(self) -> f64 {
        match self {
            Self::Shift(_) => 0.0,
            Self::Addendum(_) => super::gears::STANDARD_ADDENDUM,
            Self::Dedendum(_) => super::gears::STANDARD_DEDENDUM,
        }
    }
}

/// Refuses the first of several numbers with which a rule, and if possible all, would hold if it was nearer to its default, and
/// says how near; passes where the rule holds, and where none is the cause alone.
fn refuse_first(
    gears: &NamedGears,
    causes: &[Coefficient],
    what: &str,
    holds: &dyn Fn(&Gears) -> bool,
) -> Check {
    if holds(gears) {
        return Ok(());
    }
    for does in [&is_sound, holds] {
        for cause in causes {
            let mut changed = Gears::clone(gears);
            let given = *cause.of(&mut changed);
            let nearest = nearest_valid(given, cause.default(), |value| {
                let mut changed = Gears::clone(gears);
                *cause.of(&mut changed) = value;
                does(&changed)
            });
            if let Some(nearest) = nearest {
                let side = if given > nearest { "most" } else { "least" };
                return Err(refuse(
                    &cause.key(gears),
                    given,
                    format!("{what}; must be at {side} {nearest:.4}"),
                ));
            }
        }
    }
    Ok(())
}

/// The last value on the way from one that does to one that is given and does not, to four digits; none where the former does
/// not either.
fn nearest_valid(given: f64, good: f64, does: impl Fn(f64) -> bool) -> Option<f64> {
    if !does(good) {
        return None;
    }
    let (mut inside, mut outside) = (good, given);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        if does(middle) { inside = middle } else { outside = middle }
    }
    Some(if given > good { -rounded_up(-inside) } else { rounded_up(inside) })
}

/// Enough for a double's precision.
const BISECTIONS: usize = 60;

/// The next larger number of four digits.
fn rounded_up(value: f64) -> f64 {
    (value * 1e4).ceil() / 1e4
}
