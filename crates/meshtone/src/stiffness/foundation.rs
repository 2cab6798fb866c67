//! Deflection of the wheel's body under the tooth (fillet foundation).
//!
//! `(cos²α/(E W)) (L u² + M u + P (1 + Q tan²α))`, `u = (x − Rd − y tan α)/S_f`, `S_f = 2 θ_f Rd`.
//! Source: P. Sainsot, P. Velex, O. Duverger, Journal of Mechanical Design 126 (2004).
//!
//! A part of P is not the tooth's. A ring that is clamped at its bore and pushed along its root circle turns as a whole, by
//! `u = F (1 + ν)/(2π E W) (h² − 1)`, with h the root radius over that of the bore. That is the h² of P. The body turns once, for
//! all pairs of teeth together, and between them and the shaft: so it is a spring of the machine, and what is left of P is local. It is as
//! in the exact ring without its mean rotation within 3 % up to h = 7, where the fit ends and beyond which the local part hardly grows.
//! `P Q` is of the load's part along the radius, which turns nothing, and stays whole.
//!
//! A ring is no such body: its tooth stands on a half plane, and the rim's bending is the machine's. With `c = 1 − ν²` that is the same
//! sum with `L = 5.306 c`, `M = 2 (1 − ν)`, `P = 1.534 c`, `Q = 0.4167/(1 + ν)` and the tooth's width at the root circle as `S_f`.
//! Source: R. W. Cornell, "Compliance and stress sensitivity of spur gear teeth", Journal of Mechanical Design 103 (1981) 447-459.

use std::f64::consts::PI;

use crate::wheel::{BodyRotation, FoundationCoefficients, ToothProfile, Wheel};

/// Pressure angle of a load.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadDirection {
    pub(crate) sin: f64,
    pub(crate) cos: f64,
    pub(crate) tan: f64,
}

impl LoadDirection {
    pub(crate) fn new(pressure_angle_rad: f64) -> Self {
        let (sin, cos) = pressure_angle_rad.sin_cos();
        Self { sin, cos, tan: pressure_angle_rad.tan() }
    }
}

/// The polynomials of one wheel.
pub(crate) struct Foundation {
    l: f64,
    m: f64,
    p: f64,
    /// `P Q`.
    p_q: f64,
    /// Where the root is along the tooth's centre line.
    root_x_mm: f64,
    root_thickness_mm: f64,
}

/// (-) Root radius over that of the bore up to which the polynomials hold.
const MOST_RADII: f64 = 7.0;

impl Foundation {
    /// With the rotation of the whole body, as published.
    pub(crate) fn new(wheel: &Wheel, profile: &ToothProfile, coefficients: &FoundationCoefficients) -> Self {
        Self::on_ring(wheel, profile, coefficients, wheel.root_radius_mm / wheel.bore_radius_mm)
    }

    /// Without the rotation of the whole body, where that is the machine's; of a ring without its body.
    ///
    /// # Arguments
    /// * `wheel`, `profile` - the tooth on its body
    /// * `coefficients` - of the polynomials
    /// * `poisson_ratio` - (-) ν of the body
    pub(crate) fn local(
        wheel: &Wheel,
        profile: &ToothProfile,
        coefficients: &FoundationCoefficients,
        poisson_ratio: f64,
    ) -> Self {
        if wheel.is_internal {
            return Self::on_half_plane(profile, poisson_ratio);
        }
        if coefficients.rotation == BodyRotation::Tooth {
            return Self::new(wheel, profile, coefficients);
        }
        let h = (wheel.root_radius_mm / wheel.bore_radius_mm).min(MOST_RADII);
        let whole = Self::on_ring(wheel, profile, coefficients, h);
        Self { p: whole.p - (1.0 + poisson_ratio) * (h * h - 1.0) / (2.0 * PI), ..whole }
    }

    /// On a half plane.
    fn on_half_plane(profile: &ToothProfile, poisson_ratio: f64) -> Self {
        let plane = 1.0 - poisson_ratio * poisson_ratio;
        let p = 1.534 * plane;
        Self {
            l: 5.306 * plane,
            m: 2.0 * (1.0 - poisson_ratio),
            p,
            p_q: p * 0.4167 / (1.0 + poisson_ratio),
            root_x_mm: profile.x_mm[0],
            root_thickness_mm: 2.0 * profile.y_mm[0],
        }
    }

    /// On a ring whose root radius is h times that of the bore.
    fn on_ring(wheel: &Wheel, profile: &ToothProfile, coefficients: &FoundationCoefficients, h: f64) -> Self {
        let theta = (profile.y_mm[0] / profile.x_mm[0]).atan();
        let polynomial = |[a, b, c, d, e, f]: [f64; 6]| {
            a / (theta * theta) + b * h * h + c * h / theta + d / theta + e * h + f
        };
        let p = polynomial(coefficients.p);
        Self {
            l: polynomial(coefficients.l),
            m: polynomial(coefficients.m),
            p,
            p_q: p * polynomial(coefficients.q),
            root_x_mm: wheel.root_radius_mm,
            root_thickness_mm: 2.0 * theta * wheel.root_radius_mm,
        }
    }

    /// (mm/N) Compliance of a load at (x, y) over `width_mm`.
    pub(crate) fn compliance(
        &self,
        (x, y): (f64, f64),
        direction: LoadDirection,
        width_mm: f64,
        youngs_mpa: f64,
    ) -> f64 {
        let LoadDirection { cos, tan, .. } = direction;
        let u = (x - self.root_x_mm - y * tan) / self.root_thickness_mm;
        cos * cos / (youngs_mpa * width_mm) * (self.l * u * u + self.m * u + self.p + self.p_q * tan * tan)
    }
}
