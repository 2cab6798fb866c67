//! How a ball or a roller resists being pressed between the races, `F = K δⁿ` of its deflection δ between both races.

use std::f64::consts::PI;

use super::BearingGeometry;
use crate::keys::by_name;

/// (Pa) Young's modulus of bearing steel.
const YOUNGS_MODULUS_PA: f64 = 206e9;
/// (-) Its Poisson's ratio.
const POISSON_RATIO: f64 = 0.3;
/// (kg/m³) Its density.
const DENSITY: f64 = 7850.0;
/// (-) Radius of a groove over the diameter of its balls.
const CONFORMITY: f64 = 0.52;

/// Kind of the elements of a rolling bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RollingElement {
    /// Balls in grooves.
    Ball,
    /// Cylindrical rollers.
    Roller,
}

by_name!(RollingElement, ["ball" => RollingElement::Ball, "roller" => RollingElement::Roller]);

/// The load of an element by its deflection, `F = K δⁿ`: n = 3/2 of a ball, 10/9 of a roller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementContact {
    /// Kind of the element.
    pub element: RollingElement,
    /// (N/mⁿ) K.
    pub stiffness: f64,
    /// (kg) Mass of the element.
    pub mass_kg: f64,
}

impl ElementContact {
    /// A ball in grooves of 0.52 of its diameter: `K = (K_i^(−2/3) + K_o^(−2/3))^(−3/2)` of its contacts with both races.
    ///
    /// # Arguments
    /// * `geometry` - of the bearing
    ///
    /// Source of the contacts: T. A. Harris, "Rolling Bearing Analysis", 4th edition, Wiley 2001, chapter 6, from H. Hertz (1881).
    pub fn ball(geometry: &BearingGeometry) -> Self {
        let ratio = geometry.element_mm / geometry.pitch_mm * geometry.contact_angle_deg.to_radians().cos();
        let flexible = [1.0, -1.0].map(|of_race| {
            let along_path = of_race * 2.0 * ratio / (1.0 - of_race * ratio);
            race_stiffness(along_path, geometry.element_mm * 1e-3).powf(-2.0 / 3.0)
        });
        let mass_kg = DENSITY * PI / 6.0 * (geometry.element_mm * 1e-3).powi(3);
        Self { element: RollingElement::Ball, stiffness: flexible.iter().sum::<f64>().powf(-1.5), mass_kg }
    }

    /// A cylindrical roller of steel, `δ = 3.84·10⁻⁵ F^0.9 / l^0.8` at each race, in mm and N.
    ///
    /// # Arguments
    /// * `geometry` - of the bearing
    /// * `length_mm` - (mm) l, the length of its contact
    ///
    /// Source: G. Lundberg, A. Palmgren, as in T. A. Harris, "Rolling Bearing Analysis", 4th edition, chapter 6.
    pub fn roller(geometry: &BearingGeometry, length_mm: f64) -> Self {
        let both_races_mm = 2.0 * 3.84e-5 / length_mm.powf(0.8);
        let mass_kg = DENSITY * PI / 4.0 * geometry.element_mm.powi(2) * length_mm * 1e-9;
        Self { element: RollingElement::Roller, stiffness: (1e3 / both_races_mm).powf(10.0 / 9.0), mass_kg }
    }

    /// (N, N/m) The load of a ball and its slope.
    ///
    /// # Arguments
    /// * `deflection_m` - (m) by which it is pressed together; 0 of a ball without load
    #[inline(always)]
    pub(super) fn of_ball(&self, deflection_m: f64) -> [f64; 2] {
        let slope = self.stiffness * deflection_m.sqrt();
        [slope * deflection_m, 1.5 * slope]
    }

    /// (N, N/m) The same of a roller.
    ///
    /// # Arguments
    /// * `deflection_m` - (m) by which it is pressed together; 0 of a roller without load
    #[inline(always)]
    pub(super) fn of_roller(&self, deflection_m: f64) -> [f64; 2] {
        let slope = self.stiffness * deflection_m.cbrt().cbrt();
        [slope * deflection_m, 10.0 / 9.0 * slope]
    }

    /// (m) The deflection of an element under a load.
    ///
    /// # Arguments
    /// * `load_n` - (N) not negative
    pub(crate) fn deflection_m(&self, load_n: f64) -> f64 {
        (load_n / self.stiffness).powf(1.0 / self.power())
    }

    /// (-) n.
    fn power(&self) -> f64 {
        match self.element {
            RollingElement::Ball => 1.5,
            RollingElement::Roller => 10.0 / 9.0,
        }
    }

    /// (s) How long an element that strikes one race touches it: `3 δ/v` of the deflection δ in which it spends its energy, within 5 % for both
    /// kinds. That race alone is `2ⁿ` times as stiff as both.
    ///
    /// # Arguments
    /// * `speed_m_per_s` - (m/s) v, at which it strikes
    pub(super) fn strike_s(&self, speed_m_per_s: f64) -> f64 {
        let power = self.power();
        let energy_j = 0.5 * self.mass_kg * speed_m_per_s.powi(2);
        let stiffness = self.stiffness * f64::powf(2.0, power);
        3.0 * ((power + 1.0) * energy_j / stiffness).powf(1.0 / (power + 1.0)) / speed_m_per_s
    }
}

/// (N/m^1.5) Stiffness of the contact of a ball with the groove of a race.
///
/// # Arguments
/// * `along_path` - (-) curvature of the race along the balls' path times their diameter, positive of the inner one
/// * `ball_m` - (m) diameter of the ball
fn race_stiffness(along_path: f64, ball_m: f64) -> f64 {
    let sum = (4.0 + along_path - 1.0 / CONFORMITY) / ball_m;
    let difference = (1.0 / CONFORMITY + along_path) / ball_m / sum;
    let ellipticity = ellipticity(difference);
    let [first, second] = elliptic_integrals(ellipticity);
    let approach = 2.0 * first / PI * (PI / (2.0 * ellipticity * ellipticity * second)).cbrt();
    let modulus_pa = YOUNGS_MODULUS_PA / (1.0 - POISSON_RATIO * POISSON_RATIO);
    (2.0 / (approach * sum)).powf(1.5) * sum * modulus_pa / 3.0
}

/// (-) Longer over shorter axis of the ellipse of contact, by bisection.
///
/// # Arguments
/// * `difference` - (-) difference of the curvatures of the two directions over their sum
fn ellipticity(difference: f64) -> f64 {
    let of_ratio = |ratio: f64| {
        let [first, second] = elliptic_integrals(ratio);
        ((ratio * ratio + 1.0) * second - 2.0 * first) / ((ratio * ratio - 1.0) * second)
    };
    let (mut low, mut high) = (1.0 + 1e-6, 1e3);
    for _ in 0..60 {
        let middle = f64::sqrt(low * high);
        if of_ratio(middle) < difference { low = middle } else { high = middle }
    }
    f64::sqrt(low * high)
}

/// Complete elliptic integrals of the first and the second kind of the parameter `1 − 1/κ²`, by the arithmetic-geometric mean.
///
/// Source: M. Abramowitz, I. A. Stegun, "Handbook of Mathematical Functions", 17.6.
fn elliptic_integrals(ratio: f64) -> [f64; 2] {
    let (mut mean, mut geometric) = (1.0, 1.0 / ratio);
    let mut difference = (1.0 - geometric * geometric).sqrt();
    let (mut weight, mut lost) = (0.5, 0.0);
    for _ in 0..12 {
        lost += weight * difference * difference;
        difference = (mean - geometric) / 2.0;
        (mean, geometric) = ((mean + geometric) / 2.0, (mean * geometric).sqrt());
        weight *= 2.0;
    }
    let first = PI / (2.0 * mean);
    [first, first * (1.0 - lost)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::NamedBearing;

    fn geometry(name: &str) -> BearingGeometry {
        NamedBearing::find(name).unwrap().geometry
    }

    /// Values of K(m) and E(m) at m = 0.5 and 0.9: Abramowitz and Stegun, tables 17.1 and 17.2.
    #[test]
    fn elliptic_integrals_are_those_of_the_tables() {
        for (parameter, first, second) in [
            (0.5, 1.854_074_677_301_372, 1.350_643_881_047_675),
            (0.9, 2.578_092_113_348_173, 1.104_774_732_704_073),
        ] {
            let found = elliptic_integrals(1.0 / f64::sqrt(1.0 - parameter));
            assert!((found[0] - first).abs() < 1e-13 && (found[1] - second).abs() < 1e-13, "{found:?}");
        }
    }

    /// An independent prototype's figures, to their four digits.
    #[test]
    fn stiffness_of_balls_is_that_of_the_prototype() {
        for (name, stiffness) in [("6205", 9.215e9), ("ER-10K", 9.204e9)] {
            let found = ElementContact::ball(&geometry(name)).stiffness;
            assert!((found / stiffness - 1.0).abs() < 1e-4, "{name}: {found}");
        }
    }

    #[test]
    fn slope_is_the_derivative_and_deflection_the_inverse() {
        for contact in
            [ElementContact::ball(&geometry("6205")), ElementContact::roller(&geometry("6205"), 9.0)]
        {
            let at = |deflection_m: f64| match contact.element {
                RollingElement::Ball => contact.of_ball(deflection_m),
                RollingElement::Roller => contact.of_roller(deflection_m),
            };
            let (here_m, step_m) = (5e-6, 1e-10);
            let slope = (at(here_m + step_m)[0] - at(here_m - step_m)[0]) / (2.0 * step_m);
            assert!((at(here_m)[1] / slope - 1.0).abs() < 1e-7);
            assert!((contact.deflection_m(at(here_m)[0]) / here_m - 1.0).abs() < 1e-12);
        }
    }

    /// A roller of 10 mm under 1000 N between two races, `2 · 3.84·10⁻⁵ · 1000^0.9 / 10^0.8` mm.
    #[test]
    fn roller_yields_as_the_formula_says() {
        let deflection_m = ElementContact::roller(&geometry("6205"), 10.0).deflection_m(1000.0);
        assert!((deflection_m - 6.100e-6).abs() < 1e-9, "{deflection_m}");
    }
}
