//! Cross-sections of a tooth, along its centre line.

use super::DamagedTooth;
use super::root_crack::Ledge;
use crate::wheel::ToothProfile;

/// One cross-section. y is measured across the tooth from its centre line, z along the face from its middle; what is missing
/// lies at negative z.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
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

    /// A section of a damaged tooth: rectangles one on the other, none wider than the one below.
    ///
    /// # Arguments
    /// * `tooth` - the damage
    /// * `profile` - the healthy flank, which the back one is still
    /// * `face_width_mm` - (mm) face width
    /// * `index` - profile index
    pub fn damaged(tooth: &DamagedTooth, profile: &ToothProfile, face_width_mm: f64, index: usize) -> Self {
        let (x, y) = (profile.x_mm[index], profile.y_mm[index]);
        let hollows = tooth.pits.as_ref().map_or_else(Vec::new, |pits| pits.columns(index));
        let left = |strips: &[Strip]| match &hollows[..] {
            [] => Self::of(strips),
            hollows => Self::of_blocks(&hollowed(strips, hollows, y)),
        };
        let missing = tooth.missing_width_mm[index];
        let top = tooth.flank_y_mm[index].min(tooth.crack.map_or(y, |crack| crack.left_y_mm(x, y)));
        let corner = Ledge { above_y_mm: tooth.corner_y_mm[index], missing_mm: tooth.corner_width_mm[index] };
        let ledges = tooth.crack.map_or_else(Vec::new, |crack| crack.ledges(x, y));
        if !ledges.is_empty() {
            return left(&stacked(face_width_mm, [-y, top], missing, ledges, corner));
        }
        let step = corner.above_y_mm.min(top);
        if corner.missing_mm <= missing || step >= top {
            let strip = [Strip::new(face_width_mm, missing, -y, top)];
            return if hollows.is_empty() { Self::of(&strip) } else { left(&strip) };
        }
        left(&[
            Strip::new(face_width_mm, missing, -y, step),
            Strip::new(face_width_mm, corner.missing_mm, step, top),
        ])
    }

    /// A section of blocks that lie beside and on one another.
    fn of_blocks(blocks: &[Strip]) -> Self {
        let stack = Self::of(blocks);
        // What is above a height is as wide as all blocks there are together.
        let mut heights: Vec<f64> =
            blocks.iter().flat_map(|block| [block.from_y_mm, block.to_y_mm]).collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        let layer = |heights: &[f64]| {
            let middle = (heights[0] + heights[1]) / 2.0;
            let there = blocks.iter().filter(|block| (block.from_y_mm..block.to_y_mm).contains(&middle));
            let width_mm: f64 = there.map(|block| block.width_mm).sum();
            (width_mm, [heights[0] - stack.yc_mm, heights[1] - stack.yc_mm])
        };
        let layers: Vec<_> = heights.windows(2).map(layer).collect();
        let shear_per_mm2 = shear_flexibility(layers.into_iter()) / (2.0 * stack.iz_mm4 * stack.iz_mm4);
        Self { shear_per_mm2, ..stack }
    }

    // Inlined where there is one strip, as of most points of most teeth.
    #[inline(always)]
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
            [_] => 0.6 / area,
            _ => {
                let about_centre =
                    |strip: &Strip| (strip.width_mm, [strip.from_y_mm - yc, strip.to_y_mm - yc]);
                shear_flexibility(strips.iter().map(about_centre)) / (2.0 * iz * iz)
            }
        };
        Self { area_mm2: area, shear_per_mm2, yc_mm: yc, zc_mm: zc, iy_mm4: iy, iz_mm4: iz, iyz_mm4: iyz }
    }
}

/// What pits leave of the rectangles of a section.
///
/// # Arguments
/// * `strips` - the rectangles
/// * `hollows` - columns of the face from its middle, and the height that each loses below the sound flank
/// * `flank_y_mm` - (mm) the sound flank
fn hollowed(strips: &[Strip], hollows: &[([f64; 2], f64)], flank_y_mm: f64) -> Vec<Strip> {
    let mut blocks = Vec::new();
    for strip in strips {
        let [mut from, end] = [-0.5, 0.5].map(|side| strip.centre_z_mm + side * strip.width_mm);
        let mut add = |z: [f64; 2], to_y_mm: f64| {
            if z[1] > z[0] && to_y_mm > strip.from_y_mm {
                let (width_mm, centre_z_mm) = (z[1] - z[0], (z[0] + z[1]) / 2.0);
                blocks.push(Strip { width_mm, to_y_mm, centre_z_mm, ..*strip });
            }
        };
        // A section's z runs from where the face's begins.
        for (column, lost_mm) in hollows.iter().rev() {
            let column = [-column[1], -column[0]].map(|z| z.clamp(from, end));
            add([from, column[0]], strip.to_y_mm);
            add(column, strip.to_y_mm.min(flank_y_mm - lost_mm));
            from = column[1];
        }
        add([from, end], strip.to_y_mm);
    }
    blocks
}

/// The rectangles of a section from which two damages have taken the upper part of one end.
///
/// # Arguments
/// * `face_width_mm` - (mm) its width
/// * `heights_mm` - (mm) its lower and upper end
/// * `missing_mm` - (mm) width that is missing over the whole height
/// * `ledges` - of the one damage, from below, each wider than the one before
/// * `corner` - of the other damage
fn stacked(
    face_width_mm: f64,
    [bottom, top]: [f64; 2],
    missing_mm: f64,
    mut ledges: Vec<Ledge>,
    corner: Ledge,
) -> Vec<Strip> {
    let above_corner = ledges.partition_point(|ledge| ledge.above_y_mm < corner.above_y_mm);
    ledges.insert(above_corner, corner);
    let (mut from, mut missing) = (bottom, missing_mm);
    let mut strips = Vec::with_capacity(ledges.len() + 1);
    for ledge in ledges.into_iter().filter(|ledge| ledge.above_y_mm < top) {
        if ledge.missing_mm > missing {
            strips.push(Strip::new(face_width_mm, missing, from, ledge.above_y_mm));
            (from, missing) = (ledge.above_y_mm, ledge.missing_mm);
        }
    }
    // At its start a crack through the whole face is as wide as the face.
    if missing < face_width_mm || strips.is_empty() {
        strips.push(Strip::new(face_width_mm, missing, from, top));
    }
    strips
}

/// (mm⁵) `∫ Q²/b dy` over a section made of rectangles, each with its width and the heights of its ends from the section's
/// centre, from below.
///
/// On each `Q(y) = Q_end + b (y_end² − y²)/2`, with `Q_end` the first moment beyond it.
pub(crate) fn shear_flexibility(rectangles: impl DoubleEndedIterator<Item = (f64, [f64; 2])>) -> f64 {
    let (mut beyond, mut sum) = (0.0, 0.0);
    for (width, [from, to]) in rectangles.rev() {
        // Q²/b with Q = a − b y²/2.
        let a = beyond + width * to * to / 2.0;
        let integral = |y: f64| a * a * y / width - a * y.powi(3) / 3.0 + width * y.powi(5) / 20.0;
        sum += integral(to) - integral(from);
        beyond += width * (to * to - from * from) / 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_flexibility_of_a_rectangle_is_known() {
        // ∫ Q²/b dy = 4 b h⁵/15 for a rectangle of width b and height 2h, however it is split.
        let (b, h) = (3.0, 2.0f64);
        for step in [-1.0, 0.0, 1.5] {
            let value = shear_flexibility([(b, [-h, step]), (b, [step, h])].into_iter());
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
        let [bottom, step, top] = heights;
        let value = shear_flexibility([(w, [bottom, step]), (u, [step, top])].into_iter());
        assert!((value / sum - 1.0).abs() < 1e-4);
    }
}
