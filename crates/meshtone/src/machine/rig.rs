//! The rig around the wheels: bearings, shafts, brake.

use std::ops::Bound::Excluded;

use meshtone_toml::{ReadResult, TomlValue};

use super::{Support, Unbalance};
use crate::keys::{Check, KeyKind, KeyRow, KeyValue, Keys, NumberFiles, Range, Written, rows};
use crate::wheel::{Gears, WheelName};

/// Condensed shafts in their bearings and supports.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Rig {
    /// (N/m) Stiffness of each wheel's bearing in x, y and z. Default 1.9e8.
    pub bearing_stiffness_n_per_m: f64,
    /// (N m/rad) Stiffness of each wheel against tilting about x and y. Default 1e8.
    pub wheel_rotational_stiffness_nm_per_rad: f64,
    /// (-) Modal damping. Default 0.05 for every mode.
    pub damping_ratio: DampingRatio,
    /// The motor's shaft. Default 200 mm long, radius 10 mm.
    pub pinion_shaft: Shaft,
    /// The brake's shaft. Default 600 mm long, radius 10 mm.
    pub gear_shaft: Shaft,
    /// What each shaft's bearings sit in.
    pub support: Support,
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            bearing_stiffness_n_per_m: 1.9e8,
            wheel_rotational_stiffness_nm_per_rad: 1e8,
            damping_ratio: DampingRatio::Uniform(0.05),
            pinion_shaft: Shaft::new(200.0, 10.0),
            gear_shaft: Shaft::new(600.0, 10.0),
            support: Support::default(),
        }
    }
}

/// What the machine of a rig is made of.
#[derive(Debug, Clone, Copy)]
pub struct RigParts<'a> {
    /// The pinion and the gear.
    pub gears: &'a Gears,
    /// Their shafts, in bearings and supports.
    pub rig: &'a Rig,
    /// Mass and inertias of the pinion and of the gear, instead of those of solid discs.
    pub inertias: [&'a WheelInertia; 2],
    /// Unbalances of both with their shafts.
    pub unbalances: [&'a Unbalance; 2],
    /// (kg m²) Inertia of the brake.
    pub brake_inertia_kgm2: f64,
    /// Whether the brake drives, so that the gear pushes the pinion.
    pub overruns: bool,
}

/// Beyond these the equations are solved in rounding errors.
pub(super) const STIFFNESS: Range = Range::positive().implausible_above(1e15);
pub(super) const MASS: Range = Range::positive().implausible_above(1e9);

impl Keys for Rig {
    const SECTION: &str = "rig";

    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        rows! {
            bearing_stiffness_n_per_m "N/m" "the stiffness of each wheel's bearings in x, y and z"
                .range(STIFFNESS);
            wheel_rotational_stiffness_nm_per_rad "N m/rad" "the tilting stiffness of each wheel, about x and about y"
                .range(STIFFNESS);
            damping_ratio "-" "the modal damping ratio: one for all modes, or 13 by rising frequency"
                .range(Range::below_one().message("must be from 0 to less than 1 (1 is critical damping)").help("a usual ratio is 0.05, which is 5 %"));
            pinion_shaft "" "the shaft to motor (pinion) or brake (gear)";
            gear_shaft "" "the shaft to motor (pinion) or brake (gear)";
            support "" "the supports of the shafts' bearings";
        }
    }
}

impl Rig {
    /// The shaft of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn shaft(&self, wheel: WheelName) -> &Shaft {
        match wheel {
            WheelName::Pinion => &self.pinion_shaft,
            WheelName::Gear => &self.gear_shaft,
        }
    }
}

/// Structural damping, as a part of critical damping.
pub(super) const STRUCTURAL_DAMPING: Range = Range::below_one().help("a bolted structure has 0.01 to 0.05");

/// Ratio of each mode's damping to its critical damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DampingRatio {
    /// The same for all modes.
    Uniform(f64),
    /// One per mode, in the order of rising natural frequency.
    PerMode([f64; 13]),
}

impl DampingRatio {
    /// (-) The ratio that all modes have in common; that of the lowest one where each has its own.
    pub(crate) fn of_all_modes(&self) -> f64 {
        self.per_mode()[0]
    }

    /// (-) The ratio of each mode, in the order of rising natural frequency.
    pub fn per_mode(&self) -> [f64; 13] {
        match *self {
            Self::Uniform(ratio) => [ratio; 13],
            Self::PerMode(ratios) => ratios,
        }
    }
}

impl KeyValue for DampingRatio {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = if value.is_array() {
            let ratios = value.exactly().map(Self::PerMode);
            ratios.map_err(|error| error.with_help("give one number for all modes, or 13, one per mode"))?
        } else {
            Self::Uniform(value.number()?)
        };
        Ok(())
    }

    fn write(&self) -> Written {
        match self {
            Self::Uniform(ratio) => ratio.write(),
            Self::PerMode(ratios) => ratios.write(),
        }
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        match self {
            Self::Uniform(ratio) => ratio.check(key, range, unit),
            Self::PerMode(ratios) => ratios.check(key, range, unit),
        }
    }

    fn kind() -> KeyKind {
        KeyKind::NumberOrNumbers(13)
    }
}

/// A round shaft; its radius is also the bore of the wheel on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// (mm) Length between wheel and motor or brake.
    pub length_mm: f64,
    /// (mm) Radius.
    pub radius_mm: f64,
    /// (mm) Distance between the two bearings that the shaft bends on. Default 130.
    pub bearing_span_mm: f64,
    /// (-) Where between them the wheel sits, as a part of the span from the bearing at negative z. Default 0.5.
    pub wheel_at: f64,
    /// (N/m) Stiffness of both bearings together; none for [`Rig::bearing_stiffness_n_per_m`].
    pub bearing_stiffness_n_per_m: Option<f64>,
    /// (-) Damping ratio of the shaft and its bearings. Default 0.025.
    pub damping_ratio: f64,
}

impl Shaft {
    /// A shaft with the wheel midway between its bearings, and the rest at its default.
    ///
    /// # Arguments
    /// As the fields of the same names.
    pub fn new(length_mm: f64, radius_mm: f64) -> Self {
        Self {
            length_mm,
            radius_mm,
            bearing_span_mm: 130.0,
            wheel_at: 0.5,
            bearing_stiffness_n_per_m: None,
            damping_ratio: 0.025,
        }
    }
}

impl Keys for Shaft {
    fn start() -> Self {
        Self::new(f64::NAN, f64::NAN)
    }

    fn rows() -> Vec<KeyRow<Self>> {
        rows! {
            length_mm "mm" "the length from the wheel to motor or brake"
                .range(Range::positive().implausible_above(1e6));
            radius_mm "mm" "the radius, also of the wheel's bore"
                .range(Range::positive()).rule("less than the wheel's root radius");
            bearing_span_mm "mm" "the distance between the shaft's two bearings"
                .range(Range::positive().implausible_above(1e5));
            wheel_at "-" "the position of the wheel between them"
                .range(Range::between(Excluded(0.0), Excluded(1.0)).message("must be more than 0 and less than 1 (0.5: midway between the bearings)"));
            bearing_stiffness_n_per_m "N/m" "the stiffness of both bearings together"
                .otherwise("`rig.bearing_stiffness_n_per_m`").range(STIFFNESS);
            damping_ratio "-" "the damping ratio of the shaft and its bearings" .range(STRUCTURAL_DAMPING);
        }
    }
}

/// Mass and inertias of one wheel; what is `None` is that of a solid disc of pitch radius.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelInertia {
    /// (kg) Mass.
    pub mass_kg: Option<f64>,
    /// (kg m²) Moment of inertia about the shaft.
    pub polar_inertia_kgm2: Option<f64>,
    /// (kg m²) Moment of inertia about a diameter.
    pub transverse_inertia_kgm2: Option<f64>,
}

impl Keys for WheelInertia {
    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        const DISC: &str = "the disc's";
        rows! {
            mass_kg "kg" "the mass" .otherwise(DISC).range(MASS);
            polar_inertia_kgm2 "kg m²" "the moment of inertia about the shaft" .otherwise(DISC).range(MASS);
            transverse_inertia_kgm2 "kg m²" "the moment of inertia about a diameter"
                .otherwise(DISC).range(MASS);
        }
    }
}
