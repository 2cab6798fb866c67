//! The rig around the wheels: bearings, shafts, brake.

/// Bearings, shafts, brake and wheel bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// (N/m) Stiffness of each wheel's bearing in x, y and z. Default 1.9e8.
    pub bearing_stiffness_n_per_m: f64,
    /// (N m/rad) Stiffness of each wheel against tilting about x and y. Default 1e8.
    pub wheel_rotational_stiffness_nm_per_rad: f64,
    /// (kg m²) Inertia of the brake. Default 4.5e-3.
    pub brake_inertia_kgm2: f64,
    /// (-) Modal damping. Default 0.05 for every mode.
    pub damping_ratio: DampingRatio,
    /// (mm) Eccentricity of both wheels. Default 0.
    pub eccentricity_mm: f64,
    /// The motor's shaft. Default 200 mm long, radius 10 mm.
    pub pinion_shaft: Shaft,
    /// The brake's shaft. Default 600 mm long, radius 10 mm.
    pub gear_shaft: Shaft,
    /// Mass and inertias of the pinion, instead of those of a solid disc.
    pub pinion_inertia: WheelInertia,
    /// Mass and inertias of the gear, instead of those of a solid disc.
    pub gear_inertia: WheelInertia,
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            bearing_stiffness_n_per_m: 1.9e8,
            wheel_rotational_stiffness_nm_per_rad: 1e8,
            brake_inertia_kgm2: 4.5e-3,
            damping_ratio: DampingRatio::Uniform(0.05),
            eccentricity_mm: 0.0,
            pinion_shaft: Shaft { length_mm: 200.0, radius_mm: 10.0 },
            gear_shaft: Shaft { length_mm: 600.0, radius_mm: 10.0 },
            pinion_inertia: WheelInertia::default(),
            gear_inertia: WheelInertia::default(),
        }
    }
}

/// Ratio of each mode's damping to its critical damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DampingRatio {
    /// The same for all modes.
    Uniform(f64),
    /// One per mode, in the order of rising natural frequency.
    PerMode([f64; 13]),
}

impl DampingRatio {
    /// (-) The ratio of each mode, in the order of rising natural frequency.
    pub fn per_mode(&self) -> [f64; 13] {
        match *self {
            Self::Uniform(ratio) => [ratio; 13],
            Self::PerMode(ratios) => ratios,
        }
    }
}

/// A round shaft; its radius is also the bore of the wheel on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// (mm) Length between wheel and motor or brake.
    pub length_mm: f64,
    /// (mm) Radius.
    pub radius_mm: f64,
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
