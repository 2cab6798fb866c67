//! Rules that concern several keys of `[quality]`.

use super::{ERROR_POINTS, Quality};
use crate::error::ScenarioError;
use crate::error_table::ErrorTable;
use crate::keys::{Check, check_keys, refuse};
use crate::wheel::Gears;

impl Quality {
    /// Every key alone, and the profile errors with the wheels that have them.
    pub(crate) fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "quality")?;
        let class = self.iso_class;
        if class != 0 && self.din_grade != 0 {
            let problem = "given beside quality.din_grade; deviations are drawn for one of the two";
            return Err(ScenarioError::new("quality.iso_class", class, problem)
                .with_help("remove iso_class, or remove din_grade"));
        }
        let Some(errors) = &self.profile_errors else {
            return Ok(());
        };
        let grade = self.din_grade;
        if grade != 0 {
            let problem = "given beside profile errors, which replace the errors drawn for a grade";
            return Err(ScenarioError::new("quality.din_grade", grade, problem)
                .with_help("remove din_grade or set it to 0, or remove the profile errors"));
        }
        if class != 0 {
            let problem = "given beside profile errors, which replace the deviations drawn for a class";
            return Err(ScenarioError::new("quality.iso_class", class, problem)
                .with_help("remove iso_class, or the profile errors"));
        }
        if let Some(seed) = self.seed {
            let problem = "given beside profile errors, which are not drawn";
            return Err(ScenarioError::new("quality.seed", seed, problem)
                .with_help("remove quality.seed, or the profile errors"));
        }
        let module_mm = gears.module_mm;
        matrix("pinion", &errors.pinion_profile_errors_mm, gears.pinion_teeth, module_mm)?;
        matrix("gear", &errors.gear_profile_errors_mm, gears.gear_teeth, module_mm)
    }
}

fn matrix(wheel: &str, errors: &ErrorTable, teeth: u32, module_mm: f64) -> Check {
    let key = format!("quality.{wheel}_profile_errors_mm");
    let (rows, columns) = (errors.points(), errors.teeth());
    if rows != ERROR_POINTS || columns != teeth as usize {
        let problem = format!(
            "is {rows} × {columns}; must be {ERROR_POINTS} × {teeth}: {ERROR_POINTS} points along each of the \
             {wheel}'s {teeth} teeth"
        );
        let help = match (columns, rows == teeth as usize) {
            (ERROR_POINTS, true) => "it seems to be transposed: a row is a point, a column a tooth",
            _ => "gears.pinion_teeth and gears.gear_teeth must be those of the wheels with these errors",
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
