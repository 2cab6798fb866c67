//! Measured deviations of a wheel besides the profiles of its teeth.

use crate::wheel::WheelName;

/// Deviations of one wheel as a measuring protocol has them; each that is given stands in place of what would be drawn.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct WheelDeviations {
    /// (µm) Cumulative pitch deviation of each tooth's working flank, along the pitch circle; as with the profile, positive is
    /// metal added.
    pub cumulative_pitch_um: Option<Vec<f64>>,
    /// (µm) Run-out F_r: the teeth's deviation along the line of action is `F_r/2 sin(θ + φ)`.
    pub run_out_um: Option<f64>,
    /// (rad) Its phase φ, with θ counted from where the wheel's first tooth enters contact.
    pub run_out_phase_rad: Option<f64>,
    /// (µm) Helix slope deviation over the face width; positive where metal is added towards positive z.
    pub helix_slope_um: Option<f64>,
}

/// The keys of both wheels' deviations, which are the names of a file's entries too: the pinion's, then the gear's.
pub(crate) const DEVIATION_KEYS: [[&str; 4]; 2] = [
    ["pinion_cumulative_pitch_um", "pinion_run_out_um", "pinion_run_out_phase_rad", "pinion_helix_slope_um"],
    ["gear_cumulative_pitch_um", "gear_run_out_um", "gear_run_out_phase_rad", "gear_helix_slope_um"],
];

impl WheelDeviations {
    /// The deviations of both wheels by the keys of the scenario file; what is not given is left out.
    ///
    /// # Arguments
    /// * `both` - the pinion's and the gear's
    ///
    /// ```
    /// use meshtone::wheel::WheelDeviations;
    ///
    /// let mut both = [WheelDeviations::default(), WheelDeviations::default()];
    /// both[1].run_out_um = Some(12.0);
    /// assert_eq!(WheelDeviations::entries(&both), [("gear_run_out_um", vec![12.0])]);
    /// ```
    pub fn entries(both: &[Self; 2]) -> Vec<(&'static str, Vec<f64>)> {
        let of_wheel = |wheel: WheelName| {
            let [pitch, run_out, phase, helix] = DEVIATION_KEYS[wheel as usize];
            let given = &both[wheel as usize];
            let number = |key: &'static str, value: Option<f64>| value.map(|value| (key, vec![value]));
            let pitches = given.cumulative_pitch_um.clone().map(|pitches| (pitch, pitches));
            [
                pitches,
                number(run_out, given.run_out_um),
                number(phase, given.run_out_phase_rad),
                number(helix, given.helix_slope_um),
            ]
        };
        WheelName::BOTH.into_iter().flat_map(of_wheel).flatten().collect()
    }

    /// Sets one of the deviations of both wheels, if the key is one of theirs.
    ///
    /// # Arguments
    /// * `both` - the pinion's and the gear's
    /// * `key` - as in the scenario file
    /// * `numbers` - one a tooth for the pitches, else a single one
    ///
    /// # Returns
    /// None where there are several numbers and one is needed.
    pub fn set(both: &mut [Self; 2], key: &str, numbers: &[f64]) -> Option<()> {
        let single = || <[f64; 1]>::try_from(numbers).ok().map(|[number]| Some(number));
        for (given, [pitch, run_out, phase, helix]) in both.iter_mut().zip(DEVIATION_KEYS) {
            if key == pitch {
                given.cumulative_pitch_um = Some(numbers.to_vec());
            } else if key == run_out {
                given.run_out_um = single()?;
            } else if key == phase {
                given.run_out_phase_rad = single()?;
            } else if key == helix {
                given.helix_slope_um = single()?;
            }
        }
        Some(())
    }

    /// The keys of both wheels' deviations, in the order of [`Self::entries`].
    pub fn keys() -> impl Iterator<Item = &'static str> {
        DEVIATION_KEYS.into_iter().flatten()
    }
}
