//! What the bearings of a shaft sit in.

use std::f64::consts::TAU;

use meshtone_toml::{ReadResult, TomlTable};

use super::rig::{MASS, STIFFNESS, STRUCTURAL_DAMPING};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::keys::{Check, Keys, Range, field, flatten, keys};

/// What the bearings of each of the two shafts sit in: a bracket or the wall of a housing, that moves across the shafts.
///
/// ```
/// use meshtone::scenario::{Support, SupportSprings};
///
/// let support = Support::default();
/// let [base_n_per_m, between_n_per_m] = support.stiffnesses_n_per_m();
/// let given = SupportSprings::Stiffnesses { stiffness_n_per_m: base_n_per_m, coupling_n_per_m: between_n_per_m };
/// let [base_hz, differential_hz] = Support { springs: given, ..support }.frequencies_hz();
/// assert!((base_hz - 450.0).abs() < 1e-9 && (differential_hz - 2900.0).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// (kg) Mass of each support. Default 2.3; 1.6 where the stiffnesses are given.
    pub mass_kg: f64,
    /// What holds it.
    pub springs: SupportSprings,
    /// (-) Damping ratio of what lies between supports and base. Default 0.025.
    pub damping_ratio: f64,
}

/// What holds two equal supports, in x and in y: the frequencies of their two motions, or the stiffnesses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SupportSprings {
    /// Natural frequencies of the two supports without shafts and wheels.
    Frequencies {
        /// (Hz) Both move alike: only what lies between them and the base deforms. Default 450.
        base_hz: f64,
        /// (Hz) They move out of phase. Default 2900.
        differential_hz: f64,
    },
    /// Stiffnesses.
    Stiffnesses {
        /// (N/m) Between each support and the base. Default 1.6e8.
        stiffness_n_per_m: f64,
        /// (N/m) Between the two supports. Default 5e8.
        coupling_n_per_m: f64,
    },
}

impl Support {
    /// What a support whose stiffnesses are given starts from: the defaults of the first files that gave them.
    const BY_STIFFNESSES: Self = Self {
        mass_kg: 1.6,
        springs: SupportSprings::Stiffnesses { stiffness_n_per_m: 1.6e8, coupling_n_per_m: 5e8 },
        damping_ratio: 0.025,
    };

    /// (N/m) Stiffness of each support to the base, and between the two.
    ///
    /// With `m ẍ_i + k_b x_i + k_c (x_i − x_j) = 0` the supports' frequencies are `ω_b² = k_b/m` and `ω_d² = (k_b + 2 k_c)/m`.
    pub fn stiffnesses_n_per_m(&self) -> [f64; 2] {
        match self.springs {
            SupportSprings::Stiffnesses { stiffness_n_per_m, coupling_n_per_m } => {
                [stiffness_n_per_m, coupling_n_per_m]
            }
            SupportSprings::Frequencies { base_hz, differential_hz } => {
                let [base, differential] =
                    [base_hz, differential_hz].map(|hz| self.mass_kg * (TAU * hz).powi(2));
                [base, (differential - base) / 2.0]
            }
        }
    }

    /// (Hz) Natural frequencies of the two supports without shafts and wheels: in phase, and out of phase.
    pub fn frequencies_hz(&self) -> [f64; 2] {
        let [base, between] = self.stiffnesses_n_per_m();
        [base, base + 2.0 * between].map(|stiffness| (stiffness / self.mass_kg).sqrt() / TAU)
    }

    /// A note about what a support by stiffnesses has of the values that it starts from; none of a support by frequencies.
    pub(crate) fn former_defaults(&self) -> Option<ScenarioWarning> {
        let SupportSprings::Stiffnesses { stiffness_n_per_m, coupling_n_per_m } = self.springs else {
            return None;
        };
        let kept = [
            ("mass_kg = 1.6", self.mass_kg == Self::BY_STIFFNESSES.mass_kg),
            ("stiffness_n_per_m = 1.6e8", stiffness_n_per_m == 1.6e8),
            ("coupling_n_per_m = 5e8", coupling_n_per_m == 5e8),
        ];
        let kept: Vec<&str> =
            kept.into_iter().filter_map(|(text, is_kept)| is_kept.then_some(text)).collect();
        let message = format!(
            "is given by stiffnesses and has {}, the former default of what is left out; if this is not \
             intended, give other values, or base_hz and differential_hz",
            kept.join(", ")
        );
        (!kept.is_empty()).then(|| ScenarioWarning::new(WarningKind::FormerDefaults, "rig.support", message))
    }

    /// What the keys alone do not say.
    pub(crate) fn check(&self) -> Check {
        match self.springs {
            SupportSprings::Frequencies { base_hz, differential_hz } if differential_hz <= base_hz => {
                let problem = format!(
                    "must be more than base_hz, {base_hz:?} Hz: the coupling of the supports stiffens them"
                );
                Err(ScenarioError::new(
                    "rig.support.differential_hz",
                    format!("{differential_hz:?}"),
                    problem,
                ))
            }
            _ => Ok(()),
        }
    }
}

/// The keys of either form.
const FREQUENCIES: [&str; 2] = ["base_hz", "differential_hz"];
const STIFFNESSES: [&str; 2] = ["stiffness_n_per_m", "coupling_n_per_m"];

keys! {
    Support = default Self { mass_kg: 2.3, springs: SupportSprings::start(), damping_ratio: 0.025 }, chosen with given_form;
    mass_kg "kg" "the mass of each support; 1.6 by default where a stiffness is given" .range(MASS);
    .. { flatten(field!(springs)) };
    damping_ratio "-" "the damping ratio of the supports on their stiffnesses" .range(STRUCTURAL_DAMPING);
}

impl Support {
    /// Takes the form that is given.
    fn given_form(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
        let given = |keys: [&'static str; 2]| keys.into_iter().find(|key| table.optional(key).is_some());
        match (given(FREQUENCIES), given(STIFFNESSES)) {
            (Some(frequency), Some(stiffness)) => Err(table
                .error(
                    stiffness,
                    format!("given beside {frequency}; the stiffness of the supports has only one source"),
                )
                .with_help(format!("remove {frequency}, or remove {stiffness}"))),
            (Some(_), None) => {
                if let SupportSprings::Stiffnesses { .. } = self.springs {
                    *self = Self::default();
                }
                Ok(())
            }
            (None, Some(_)) => {
                if let SupportSprings::Frequencies { .. } = self.springs {
                    *self = Self::BY_STIFFNESSES;
                }
                Ok(())
            }
            (None, None) => Ok(()),
        }
    }
}

const HZ: Range = Range::positive().implausible_above(1e6);

keys! {
    SupportSprings = Self::Frequencies { base_hz: 450.0, differential_hz: 2900.0 };
    [Self::Frequencies] base_hz "Hz" "the natural frequency of the bare supports, moving in phase"
        .range(HZ).alternative("450.0");
    [Self::Frequencies] differential_hz "Hz" "the natural frequency of the bare supports, moving out of phase"
        .range(HZ).rule("more than base_hz").alternative("2900.0");
    [Self::Stiffnesses] stiffness_n_per_m "N/m"
        "instead of the frequencies, the stiffness between each support and the base"
        .range(STIFFNESS).otherwise("1.6e8 where coupling_n_per_m is given").alternative("1.6e8");
    [Self::Stiffnesses] coupling_n_per_m "N/m" "instead of the frequencies, the stiffness between the two supports"
        .range(Range::not_negative().implausible_above(1e15))
        .otherwise("5e8 where stiffness_n_per_m is given").alternative("5e8");
}
