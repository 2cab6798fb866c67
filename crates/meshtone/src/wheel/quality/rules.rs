//! Rules that concern several keys of `[quality]`.

use super::{ERROR_POINTS, Quality, WheelDeviations};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::error_table::ErrorTable;
use crate::keys::{Check, refuse, require};
use crate::wheel::{Gears, WheelName};

impl Quality {
    /// The deviations with the wheels that have them; every key alone is in its range.
    pub(crate) fn check(&self, gears: &Gears) -> Check {
        one_source("quality", self.din_grade, self.iso_class, self.profile_errors.is_some())?;
        for wheel in WheelName::BOTH {
            let key = format!("quality.{}_cumulative_pitch_um", wheel.name());
            self.given(wheel).check_pitches(&key, gears.teeth(wheel), gears.module_mm)?;
        }
        let Some(errors) = &self.profile_errors else {
            return Ok(());
        };
        if let Some(seed) = self.seed {
            let problem = "given beside profile errors, which are not drawn";
            return Err(ScenarioError::new("quality.seed", seed, problem)
                .with_help("remove quality.seed, or the profile errors"));
        }
        let module_mm = gears.module_mm;
        let check = |wheel: WheelName, errors: &ErrorTable| {
            let key = format!("quality.{}_profile_errors_mm", wheel.name());
            check_errors(&key, errors, gears.teeth(wheel), module_mm)
        };
        check(WheelName::Pinion, &errors.pinion_profile_errors_mm)?;
        check(WheelName::Gear, &errors.gear_profile_errors_mm)
    }

    /// Shares of what is given and so not drawn, which have no effect.
    pub(crate) fn warnings(&self) -> Vec<ScenarioWarning> {
        let default = Self::default();
        let both = |is_given: fn(&WheelDeviations) -> bool| {
            WheelName::BOTH.into_iter().all(|wheel| is_given(self.given(wheel)))
        };
        let pitches = both(|given| given.cumulative_pitch_um.is_some());
        let run_out = both(|given| given.run_out_um.is_some());
        let helix = both(|given| given.helix_slope_um.is_some());
        let shares = [
            ("tooth_share", self.tooth_share != default.tooth_share, false),
            ("pitch_share", self.pitch_share != default.pitch_share, pitches),
            ("run_out_share", self.run_out_share != default.run_out_share, run_out),
            ("helix_share", self.helix_share != default.helix_share, helix),
        ];
        ignored_shares("quality", self.profile_errors.is_some(), &shares)
    }
}

/// Warnings of shares of what is given and so not drawn, which have no effect.
///
/// # Arguments
/// * `section` - the keys' section
/// * `has_errors` - whether profile errors are given, beside which nothing is drawn
/// * `shares` - the keys, whether each is set, and whether that of which it is a share is given
pub(crate) fn ignored_shares(
    section: &str,
    has_errors: bool,
    shares: &[(&str, bool, bool)],
) -> Vec<ScenarioWarning> {
    let ignored = shares.iter().filter(|(_, is_set, is_given)| *is_set && (has_errors || *is_given));
    let warning = |&(key, ..): &(&str, bool, bool)| {
        let given = match key {
            _ if has_errors => "profile errors",
            "pitch_share" => "cumulative pitch deviations",
            "run_out_share" => "run-outs",
            _ => "helix slope deviations",
        };
        let message = format!(
            "is ignored: beside given {given} nothing is drawn that it is a share of; remove {key}, or the {given}"
        );
        ScenarioWarning::new(WarningKind::IgnoredKey, format!("{section}.{key}"), message)
    };
    ignored.map(warning).collect()
}

impl WheelDeviations {
    /// One pitch deviation a tooth, each so small that it can be one.
    ///
    /// # Arguments
    /// * `key` - of the pitch deviations
    /// * `teeth`, `module_mm` - of the wheel
    pub(crate) fn check_pitches(&self, key: &str, teeth: u32, module_mm: f64) -> Check {
        let Some(pitches_um) = &self.cumulative_pitch_um else {
            return Ok(());
        };
        let count = pitches_um.len();
        if count != teeth as usize {
            let problem =
                format!("has {count} numbers; must have {teeth}, one for each of the wheel's teeth");
            return Err(ScenarioError::new(key, format!("{count} numbers"), problem));
        }
        let mut entries = pitches_um.iter().enumerate();
        entries.try_for_each(|(index, &pitch_um)| {
            let is_less = pitch_um.abs() < module_mm * 1e3;
            let problem = format!("must be smaller than the module, {module_mm} mm");
            require(&format!("{key}[{index}]"), pitch_um, is_less, problem)
        })
    }
}

/// Deviations are drawn for a grade or for a class, or their profiles are given.
///
/// # Arguments
/// * `section` - the keys' section
/// * `grade`, `class` - of DIN 3961 and of ISO 1328; 0 for none
/// * `has_errors` - whether profile errors are given
pub(crate) fn one_source(section: &str, grade: u8, class: u8, has_errors: bool) -> Check {
    let (key, value, problem, help) = match (grade, class) {
        (1.., 1..) => (
            "iso_class",
            class,
            "given beside din_grade; deviations are drawn for one of the two",
            "remove iso_class, or remove din_grade",
        ),
        (1.., 0) if has_errors => (
            "din_grade",
            grade,
            "given beside profile errors, which replace the errors drawn for a grade",
            "remove din_grade or set it to 0, or remove the profile errors",
        ),
        (0, 1..) if has_errors => (
            "iso_class",
            class,
            "given beside profile errors, which replace the deviations drawn for a class",
            "remove iso_class, or the profile errors",
        ),
        _ => return Ok(()),
    };
    Err(ScenarioError::new(format!("{section}.{key}"), value, problem).with_help(help))
}

/// Profile errors of as many points and teeth as there are, each so small that it can be one.
///
/// # Arguments
/// * `key` - of the errors
/// * `errors` - the errors
/// * `teeth`, `module_mm` - of the wheel
pub(crate) fn check_errors(key: &str, errors: &ErrorTable, teeth: u32, module_mm: f64) -> Check {
    let (rows, columns) = (errors.points(), errors.teeth());
    if rows != ERROR_POINTS || columns != teeth as usize {
        let problem = format!(
            "is {rows} × {columns}; must be {ERROR_POINTS} × {teeth}: {ERROR_POINTS} points along each of the \
             wheel's {teeth} teeth"
        );
        let help = match (columns, rows == teeth as usize) {
            (ERROR_POINTS, true) => "it seems to be transposed: a row is a point, a column a tooth",
            _ => "the tooth counts must be those of the wheels with these errors",
        };
        return Err(ScenarioError::new(key, format!("{rows} × {columns}"), problem).with_help(help));
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let error = errors[(row, column)];
        let entry = format_args!("{key}[{row}][{column}]");
        let place = format!("point {} of tooth {}", row + 1, column + 1);
        if !error.is_finite() {
            let problem = format!("{place} is {error}; must be a finite number");
            return Err(refuse(&entry.to_string(), error, problem));
        }
        if error.abs() >= module_mm {
            let problem = format!("{place} is {error} mm; must be smaller than the module, {module_mm} mm");
            return Err(refuse(&entry.to_string(), error, problem)
                .with_help("check the unit: profile errors are in mm, so 5 µm is 0.005"));
        }
    }
    Ok(())
}
