//! Bounds that a machine can reach.

/// (-) Modules by which the flanks of a mesh may overlap: teeth that overlap by one have passed through each other.
const MOST_OVERLAP_MODULES: f64 = 1.0;
/// (-) Factor by which a shaft's mean speed may be off: a shaft that is so far off has lost its mesh.
const MOST_SPEED_FACTOR: f64 = 3.0;
/// (-) Part of the samples at which flanks may have flown through the backlash since the sample before.
const MOST_CROSSINGS: f64 = 0.05;

/// (modules) By how much flanks overlap where that is more than any teeth can; none where teeth can.
///
/// # Arguments
/// * `largest_n` - (N) largest force of the mesh, of either sign
/// * `stiffness_n_per_m` - (N/m) its mean stiffness
/// * `module_mm` - (mm) module
pub(crate) fn overlap_modules(largest_n: f64, stiffness_n_per_m: f64, module_mm: f64) -> Option<f64> {
    let modules = largest_n / stiffness_n_per_m * 1e3 / module_mm;
    // What is no number is no machine's either.
    (modules.is_nan() || modules > MOST_OVERLAP_MODULES).then_some(modules)
}

/// (-) The part of the samples at which a force has the other sign than at the sample before, where that is more than a step that resolves the motion
/// shows of flanks that fly through their backlash; none where it is not.
///
/// # Arguments
/// * `part_of_flips` - (-) the part
/// * `backlash_m` - (m) backlash of the mesh
/// * `deflection_m` - (m) deflection under the mean force: through less backlash a resonance passes at any sample
pub(crate) fn crossings(part_of_flips: f64, backlash_m: f64, deflection_m: f64) -> Option<f64> {
    (part_of_flips > MOST_CROSSINGS && backlash_m > deflection_m).then_some(part_of_flips)
}

/// (-) A shaft's mean speed over that at which it is driven, where that is further from 1 than any machine's; none where it is not.
///
/// # Arguments
/// * `mean_hz`, `driven_hz` - (rev/s) its mean speed, and that of the motor by the ratio
pub(crate) fn speed_factor(mean_hz: f64, driven_hz: f64) -> Option<f64> {
    let factor = mean_hz / driven_hz;
    (!(1.0 / MOST_SPEED_FACTOR..=MOST_SPEED_FACTOR).contains(&factor)).then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_machine_reaches_is_found() {
        assert_eq!(overlap_modules(1e5, 2e8, 2.0), None);
        assert!(overlap_modules(1e6, 2e8, 2.0).is_some_and(|modules| (modules - 2.5).abs() < 1e-12));
        assert!(overlap_modules(f64::NAN, 2e8, 2.0).is_some());
        assert_eq!(crossings(0.04, 1e-4, 1e-6), None);
        assert_eq!(crossings(0.5, 1e-6, 1e-4), None);
        assert_eq!(crossings(0.5, 1e-4, 1e-6), Some(0.5));
        assert_eq!(speed_factor(29.0, 30.0), None);
        for mean_hz in [-30.0, 9.0, 91.0, 1.4e11, f64::NAN] {
            assert!(speed_factor(mean_hz, 30.0).is_some(), "{mean_hz}");
        }
    }
}
