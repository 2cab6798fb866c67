//! A piece of a round shaft as a beam element of two nodes, in bending after Timoshenko.
//!
//! Each node has the coordinates x, y, z and the rotations about them. The shape functions are those of S. P. Timoshenko's beam with
//! shear, the mass is consistent with them and has the rotary inertia of the cross-section.
//!
//! Sources: J. S. Przemieniecki, *Theory of Matrix Structural Analysis* (1968), chapter 11; G. R. Cowper, "The shear coefficient in
//! Timoshenko's beam theory", Journal of Applied Mechanics 33 (1966), for κ.

use std::f64::consts::PI;

use nalgebra::SMatrix;

use crate::wheel::Material;

/// Coordinates of a node: x, y, z and the rotations about them.
pub(super) const PER_NODE: usize = 6;

/// A matrix of both nodes' coordinates.
pub(super) type OfElement = SMatrix<f64, 12, 12>;

/// A round piece of a shaft.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    /// (m) Length.
    pub(super) length_m: f64,
    /// (m) Outer radius.
    pub(super) radius_m: f64,
    /// (m) Radius of the bore; 0 of a solid shaft.
    pub(super) bore_radius_m: f64,
    /// Its material.
    pub(super) material: Material,
}

impl Beam {
    fn area_m2(&self) -> f64 {
        PI * (self.radius_m.powi(2) - self.bore_radius_m.powi(2))
    }

    /// (m⁴) Second moment of area about a diameter.
    fn second_moment_m4(&self) -> f64 {
        PI / 4.0 * (self.radius_m.powi(4) - self.bore_radius_m.powi(4))
    }

    /// (kg m²) Moment of inertia about the shaft.
    pub(super) fn polar_kgm2(&self) -> f64 {
        self.material.density_kg_per_m3() * 2.0 * self.second_moment_m4() * self.length_m
    }

    /// (-) Shear coefficient κ of a round cross-section, hollow or not.
    fn shear_coefficient(&self) -> f64 {
        let (nu, hollow) = (self.material.poisson_ratio(), (self.bore_radius_m / self.radius_m).powi(2));
        let both = (1.0 + hollow).powi(2);
        6.0 * (1.0 + nu) * both / ((7.0 + 6.0 * nu) * both + (20.0 + 12.0 * nu) * hollow)
    }

    /// (-) Φ: how much softer in shear than in bending, `12 E I/(G κ A L²)`.
    fn shear_parameter(&self) -> f64 {
        let e = self.material.youngs_modulus_mpa();
        let stiffness = self.material.shear_modulus_mpa() * self.shear_coefficient() * self.area_m2();
        12.0 * e * self.second_moment_m4() / (stiffness * self.length_m.powi(2))
    }

    /// (N/m, N, N m/rad) Stiffness matrix.
    pub(super) fn stiffness(&self) -> OfElement {
        let (l, phi) = (self.length_m, self.shear_parameter());
        let e_pa = self.material.youngs_modulus_mpa() * 1e6;
        let shear_pa = self.material.shear_modulus_mpa() * 1e6;
        let c = e_pa * self.second_moment_m4() / (l.powi(3) * (1.0 + phi));
        let bending = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, (4.0 + phi) * l * l, -6.0 * l, (2.0 - phi) * l * l],
            [-12.0, -6.0 * l, 12.0, -6.0 * l],
            [6.0 * l, (2.0 - phi) * l * l, -6.0 * l, (4.0 + phi) * l * l],
        ]
        .map(|row| row.map(|entry| c * entry));
        let along = e_pa * self.area_m2() / l;
        let twist = shear_pa * 2.0 * self.second_moment_m4() / l;
        element(bending, [along, -along], [twist, -twist])
    }

    /// (kg, kg m, kg m²) Mass matrix.
    pub(super) fn mass(&self) -> OfElement {
        let (l, phi) = (self.length_m, self.shear_parameter());
        let density = self.material.density_kg_per_m3();
        let a = density * self.area_m2() * l / (1.0 + phi).powi(2);
        let b = density * self.second_moment_m4() / (l * (1.0 + phi).powi(2));
        let square = phi * phi;
        let moved = [
            13.0 / 35.0 + 7.0 * phi / 10.0 + square / 3.0,
            (11.0 / 210.0 + 11.0 * phi / 120.0 + square / 24.0) * l,
            9.0 / 70.0 + 3.0 * phi / 10.0 + square / 6.0,
            (13.0 / 420.0 + 3.0 * phi / 40.0 + square / 24.0) * l,
            (1.0 / 105.0 + phi / 60.0 + square / 120.0) * l * l,
            (1.0 / 140.0 + phi / 60.0 + square / 120.0) * l * l,
        ]
        .map(|m| a * m);
        let turned = [
            6.0 / 5.0,
            (0.1 - phi / 2.0) * l,
            (2.0 / 15.0 + phi / 6.0 + square / 3.0) * l * l,
            (1.0 / 30.0 + phi / 6.0 - square / 6.0) * l * l,
        ]
        .map(|n| b * n);
        let [m1, m2, m3, m4, m5, m6] = moved;
        let [n1, n2, n3, n4] = turned;
        let bending = [
            [m1 + n1, m2 + n2, m3 - n1, n2 - m4],
            [m2 + n2, m5 + n3, m4 - n2, -m6 - n4],
            [m3 - n1, m4 - n2, m1 + n1, -m2 - n2],
            [n2 - m4, -m6 - n4, -m2 - n2, m5 + n3],
        ];
        let along = density * self.area_m2() * l / 6.0;
        let twist = density * 2.0 * self.second_moment_m4() * l / 6.0;
        element(bending, [2.0 * along, along], [2.0 * twist, twist])
    }
}

/// The matrix of an element from those of bending in one plane, of tension and of torsion. Along the shaft x grows by the rotation about
/// y, and y falls by that about x.
///
/// # Arguments
/// * `bending` - of deflection and slope of the first node, then of the second
/// * `along`, `twist` - of a node with itself, and with the other
fn element(bending: [[f64; 4]; 4], along: [f64; 2], twist: [f64; 2]) -> OfElement {
    let mut whole = OfElement::zeros();
    for ([deflection, slope], sign) in [([0, 4], 1.0), ([1, 3], -1.0)] {
        let places =
            [(deflection, 1.0), (slope, sign), (PER_NODE + deflection, 1.0), (PER_NODE + slope, sign)];
        for (r, (row, of_row)) in places.into_iter().enumerate() {
            for (c, (column, of_column)) in places.into_iter().enumerate() {
                whole[(row, column)] += bending[r][c] * of_row * of_column;
            }
        }
    }
    for (coordinate, [own, other]) in [(2, along), (5, twist)] {
        let far = PER_NODE + coordinate;
        (whole[(coordinate, coordinate)], whole[(far, far)]) = (own, own);
        (whole[(coordinate, far)], whole[(far, coordinate)]) = (other, other);
    }
    whole
}
