//! Cross-sections of a tooth, along its centre line.

use super::DamagedTooth;
use crate::wheel::ToothProfile;

/// One cross-section. y is measured across the tooth from its centre line, z along the face from its middle; what is missing
/// lies at negative z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// (mm²) Area.
    pub area_mm2: f64,
    /// (1/mm²) Shear flexibility `s` in the shear energy `F_s² ∫ s/G dx`: 0.6/A for a rectangle.
    pub shear_per_mm2: f64,
    /// (mm) y of the centre.
    pub yc_mm: f64,
    /// (mm) z of the centre.
    pub zc_mm: f64,
    /// (mm⁴) Second moment of area about y, about the section's own centre.
    pub iy_mm4: f64,
    /// (mm⁴) Second moment of area about z, likewise.
    pub iz_mm4: f64,
    /// (mm⁴) Product of inertia, likewise.
    pub iyz_mm4: f64,
}

/// A rectangle of a section, from one y to another.
#[derive(Clone, Copy)]
struct Strip {
    width_mm: f64,
    from_y_mm: f64,
    to_y_mm: f64,
    centre_z_mm: f64,
}

impl Strip {
    /// What is left of the face's width when `missing_mm` are gone from its end at negative z.
    fn new(face_width_mm: f64, missing_mm: f64, from_y_mm: f64, to_y_mm: f64) -> Self {
        Self { width_mm: face_width_mm - missing_mm, from_y_mm, to_y_mm, centre_z_mm: missing_mm / 2.0 }
    }

    fn height_mm(&self) -> f64 {
        self.to_y_mm - self.from_y_mm
    }

    fn area_mm2(&self) -> f64 {
        self.width_mm * self.height_mm()
    }
}

impl Section {
    /// The whole rectangle of a sound tooth.
    ///
    /// # Arguments
    /// * `face_width_mm` - (mm) its width
    /// * `half_thickness_mm` - (mm) half its height
    pub fn sound(face_width_mm: f64, half_thickness_mm: f64) -> Self {
        Self::of(&[Strip::new(face_width_mm, 0.0, -half_thickness_mm, half_thickness_mm)])
    }

    /// A section of a damaged tooth: one rectangle, or a lower one and a narrower upper one.
    ///
    /// # Arguments
    /// * `tooth` - the damage
    /// * `profile` - the healthy flank, which the back one is still
    /// * `face_width_mm` - (mm) face width
    /// * `index` - profile index
    pub fn damaged(tooth: &DamagedTooth, profile: &ToothProfile, face_width_mm: f64, index: usize) -> Self {
        let (back, top) = (-profile.y_mm[index], tooth.flank_y_mm[index]);
        let missing = tooth.missing_width_mm[index];
        let corner_width = tooth.corner_width_mm[index];
        let step = tooth.corner_y_mm[index].min(top);
        if corner_width <= missing || step >= top {
            return Self::of(&[Strip::new(face_width_mm, missing, back, top)]);
        }
        Self::of(&[
            Strip::new(face_width_mm, missing, back, step),
            Strip::new(face_width_mm, corner_width, step, top),
        ])
    }

    fn of(strips: &[Strip]) -> Self {
        let area: f64 = strips.iter().map(Strip::area_mm2).sum();
        let mean = |of: fn(&Strip) -> f64| {
            strips.iter().map(|strip| strip.area_mm2() * of(strip)).sum::<f64>() / area
        };
        let yc = mean(|strip| (strip.from_y_mm + strip.to_y_mm) / 2.0);
        let zc = mean(|strip| strip.centre_z_mm);
        let (mut iy, mut iz, mut iyz) = (0.0, 0.0, 0.0);
        for strip in strips {
            let (width, height, area) = (strip.width_mm, strip.height_mm(), strip.area_mm2());
            let dy = (strip.from_y_mm + strip.to_y_mm) / 2.0 - yc;
            let dz = strip.centre_z_mm - zc;
            iz += width * height.powi(3) / 12.0 + area * dy * dy;
            iy += height * width.powi(3) / 12.0 + area * dz * dz;
            iyz += area * dy * dz;
        }
        let shear_per_mm2 = match strips {
            [lower, upper] => {
                let heights = [lower.from_y_mm - yc, lower.to_y_mm - yc, upper.to_y_mm - yc];
                shear_flexibility(lower.width_mm, upper.width_mm, heights) / (2.0 * iz * iz)
            }
            _ => 0.6 / area,
        };
        Self { area_mm2: area, shear_per_mm2, yc_mm: yc, zc_mm: zc, iy_mm4: iy, iz_mm4: iz, iyz_mm4: iyz }
    }
}

/// (mm⁵) `∫ Q²/b dy` over a section that is `lower_width` wide between the first two of the heights
/// `[bottom, step, top]`, measured from its centre, and `upper_width` between the last two.
///
/// On each piece `Q(y) = Q_end + b (y_end² − y²)/2`, with `Q_end` the first moment beyond the piece.
pub(super) fn shear_flexibility(lower_width: f64, upper_width: f64, [bottom, step, top]: [f64; 3]) -> f64 {
    let piece = |width: f64, from: f64, to: f64, beyond: f64| {
        // Q²/b with Q = a − b y²/2.
        let a = beyond + width * to * to / 2.0;
        let integral = |y: f64| a * a * y / width - a * y.powi(3) / 3.0 + width * y.powi(5) / 20.0;
        integral(to) - integral(from)
    };
    let upper_moment = upper_width * (top * top - step * step) / 2.0;
    piece(upper_width, step, top, 0.0) + piece(lower_width, bottom, step, upper_moment)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_flexibility_of_a_rectangle_is_known() {
        // ∫ Q²/b dy = 4 b h⁵/15 for a rectangle of width b and height 2h, however it is split.
        let (b, h) = (3.0, 2.0f64);
        for step in [-1.0, 0.0, 1.5] {
            let value = shear_flexibility(b, b, [-h, step, h]);
            assert!((value / (4.0 * b * h.powi(5) / 15.0) - 1.0).abs() < 1e-14, "{step}");
        }
    }

    #[test]
    fn shear_flexibility_agrees_with_a_sum() {
        let (w, u, heights) = (15.0, 9.0, [-2.3, 0.4, 1.9]);
        let steps = 200_000;
        let (mut moment, mut sum) = (0.0, 0.0);
        let h = (heights[2] - heights[0]) / f64::from(steps);
        for k in 0..steps {
            let y = heights[2] - h * (f64::from(k) + 0.5);
            let b = if y > heights[1] { u } else { w };
            sum += (moment + b * h * y / 2.0f64).powi(2) / b * h;
            moment += b * h * y;
        }
        assert!((shear_flexibility(w, u, heights) / sum - 1.0).abs() < 1e-4);
    }
}
