//! A rolling bearing in its machine: forces of its elements on the shaft, and the linear spring around which the machine is solved.

use std::f64::consts::TAU;

use super::{BearingGeometry, ElementContact, RollingElement, Spall};

/// Elements whose loads are computed side by side.
const SIDE_BY_SIDE: usize = 8;

/// What a rolling bearing is made of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RollingParts {
    /// Its geometry.
    pub geometry: BearingGeometry,
    /// Load of an element by its deflection.
    pub contact: ElementContact,
    /// (m) Half of the diametral clearance; negative of an interference.
    pub radial_clearance_m: f64,
    /// (N) Axial preload, of a contact angle.
    pub preload_n: f64,
    /// Its spalls.
    pub spalls: Vec<Spall>,
    /// (-) Standard deviation of the cage's slip at each pass of an element, as a part of the elements' spacing.
    pub slip: f64,
}

impl RollingParts {
    /// (m) How far apart the inner ring, an element and the outer ring are while the rings are centred; negative where the element is pressed.
    /// An axial preload takes up the clearance and presses every element.
    fn gap_m(&self) -> f64 {
        let (sin, cos) = self.geometry.contact_angle_deg.to_radians().sin_cos();
        if self.preload_n > 0.0 {
            -self.contact.deflection_m(self.preload_n / (f64::from(self.geometry.elements) * sin))
        } else {
            self.radial_clearance_m * cos
        }
    }
}

/// A rolling bearing with two unknowns, the displacement of its inner ring against its outer ring across the shaft.
///
/// Element j at the angle θ_j is pressed together by `δ_j = (x cos θ_j + y sin θ_j − c) cos α − Δ_j` with the clearance c and the drop into a spall
/// Δ_j; where that is positive it pushes with `K δⁿ cos α`. An axial preload takes up the clearance: its deflection stands for `−c cos α`. Elements
/// that strike a spall push by that much more.
///
/// The machine has a linear spring in the bearing's place, the bearing's mean slope under its static load, and the solver adds the
/// difference between the elements' force and that spring's. So the modes, their damping and the static solution are those of the linearised bearing, and
/// the solution is that of the elements alone.
///
/// Source: N. Sawalhi, R. B. Randall, Mech. Syst. Signal Process. 22 (2008) 1924–1951.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RollingBearing {
    /// What it is made of.
    pub parts: RollingParts,
    /// (N) Static load on the outer ring, along x and y.
    pub static_load_n: [f64; 2],
    /// (N/m) Slope of the load along the static load, averaged over the places of the cage.
    pub stiffness_n_per_m: f64,
    /// (N/m) The linear spring in its place, of x and y.
    pub spring_n_per_m: [[f64; 2]; 2],
    /// (m) By how much the inner ring is off its place while the machine is in its own.
    pub off_m: [f64; 2],
    /// (m) Displacement at which the linear spring is free.
    free_m: [f64; 2],
    /// (m) Displacement under the static load.
    static_m: [f64; 2],
    cos_contact_angle: f64,
    lots: Vec<Elements>,
}

/// Elements side by side, with the cage at its zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Elements {
    cos: [f64; SIDE_BY_SIDE],
    sin: [f64; SIDE_BY_SIDE],
    /// (m) See [`RollingParts::gap_m`]; without end where there is no element.
    gap_m: [f64; SIDE_BY_SIDE],
}

impl Elements {
    /// Cosine and sine of an element's angle at the cage's cosine and sine.
    #[inline(always)]
    fn direction(&self, lane: usize, [cage_cos, cage_sin]: [f64; 2]) -> [f64; 2] {
        let (cos, sin) = (self.cos[lane], self.sin[lane]);
        [cos * cage_cos - sin * cage_sin, sin * cage_cos + cos * cage_sin]
    }
}

/// Where the elements are at one sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ElementPlaces<'a> {
    /// Cosine and sine of the cage's angle.
    pub(crate) cage: [f64; 2],
    /// The element nearest to each spall.
    pub(crate) drops: &'a [ElementDrop],
}

/// An element in a spall.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ElementDrop {
    /// Its number.
    pub(crate) element: usize,
    /// (m) How deep the spall lets it drop.
    pub(crate) drop_m: f64,
    /// (N) Force with which it strikes the spall, between both rings.
    pub(crate) strike_n: f64,
}

/// The load of a bearing and its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BearingLoad {
    /// (N) Along x and y.
    pub(crate) force_n: [f64; 2],
    /// (N/m) Slopes: xx, xy, yy.
    pub(crate) slope_n_per_m: [f64; 3],
}

/// (N) Load below which the place of the linear spring is that of this load.
const LEAST_LOAD_N: f64 = 1.0;
/// (N/m) Least stiffness of the linear spring.
const LEAST_STIFFNESS: f64 = 1e6;
/// Places of the cage within one spacing over which the static solution is averaged.
const PLACES: usize = 16;

impl RollingBearing {
    /// A bearing under its static load.
    ///
    /// # Arguments
    /// * `parts` - what it is made of
    /// * `static_load_n` - (N) load on the outer ring, along x and y
    pub fn new(parts: RollingParts, static_load_n: [f64; 2]) -> Self {
        let count = parts.geometry.elements as usize;
        let gap_m = parts.gap_m();
        let lot = |first: usize| {
            let angle = |lane: usize| TAU * (first + lane) as f64 / count as f64;
            Elements {
                cos: std::array::from_fn(|lane| angle(lane).cos()),
                sin: std::array::from_fn(|lane| angle(lane).sin()),
                gap_m: std::array::from_fn(|lane| if first + lane < count { gap_m } else { f64::INFINITY }),
            }
        };
        let mut this = Self {
            cos_contact_angle: parts.geometry.contact_angle_deg.to_radians().cos(),
            lots: (0..count).step_by(SIDE_BY_SIDE).map(lot).collect(),
            static_load_n,
            stiffness_n_per_m: 0.0,
            spring_n_per_m: [[0.0; 2]; 2],
            off_m: [0.0; 2],
            free_m: [0.0; 2],
            static_m: [0.0; 2],
            parts,
        };
        let load_n = static_load_n[0].hypot(static_load_n[1]);
        let [cos, sin] = if load_n > 0.0 { static_load_n.map(|load| load / load_n) } else { [0.0, -1.0] };
        let [displacement_m, along, across] = this.under_load(load_n.max(LEAST_LOAD_N));
        let [along, across] = [along, across].map(|stiffness| stiffness.max(LEAST_STIFFNESS));
        this.stiffness_n_per_m = along;
        let free_m = displacement_m - load_n.max(LEAST_LOAD_N) / along;
        this.free_m = [free_m * cos, free_m * sin];
        this.static_m = [displacement_m * cos, displacement_m * sin];
        let mixed = (along - across) * cos * sin;
        this.spring_n_per_m = [
            [along * cos * cos + across * sin * sin, mixed],
            [mixed, along * sin * sin + across * cos * cos],
        ];
        this
    }

    /// (rad) Direction of the static load.
    pub(super) fn load_angle_rad(&self) -> f64 {
        let [x, y] = self.static_load_n;
        if x == 0.0 && y == 0.0 { -TAU / 4.0 } else { y.atan2(x) }
    }

    /// (m) By how much the static load presses an element together; not positive of one without load.
    ///
    /// # Arguments
    /// * `angle_rad` - (rad) of the element
    pub(super) fn pressed_m(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = angle_rad.sin_cos();
        (self.static_m[0] * cos + self.static_m[1] * sin) * self.cos_contact_angle - self.parts.gap_m()
    }

    /// (m, N/m, N/m) Displacement under a load in its direction, and the slopes of the load along and across it, averaged over the places of
    /// the cage.
    ///
    /// # Arguments
    /// * `load_n` - (N) positive
    pub fn under_load(&self, load_n: f64) -> [f64; 3] {
        let spacing = TAU / f64::from(self.parts.geometry.elements);
        let mut sums = [0.0; 3];
        for place in 0..PLACES {
            let (sin, cos) = (spacing * place as f64 / PLACES as f64).sin_cos();
            let places = ElementPlaces { cage: [cos, sin], drops: &[] };
            let (displacement_m, load) = self.balanced(load_n, &places);
            let [along, _, across] = load.slope_n_per_m;
            for (sum, value) in sums.iter_mut().zip([displacement_m, along, across]) {
                *sum += value / PLACES as f64;
            }
        }
        sums
    }

    /// (m) The displacement along x that a load along x brings about, with the load's slopes: Newton's method on a convex energy, with shorter
    /// steps while the residual grows.
    fn balanced(&self, load_n: f64, places: &ElementPlaces) -> (f64, BearingLoad) {
        let residual = |load: &BearingLoad| [load.force_n[0] - load_n, load.force_n[1]];
        let size = |load: &BearingLoad| {
            let [x, y] = residual(load);
            x.hypot(y)
        };
        // There the nearest elements bear more than the load.
        let start =
            self.parts.gap_m() / self.cos_contact_angle + 2.0 * self.parts.contact.deflection_m(load_n);
        let mut at_m = [start, 0.0];
        let mut load = self.load(at_m, places);
        for _ in 0..100 {
            if size(&load) < 1e-10 * load_n {
                break;
            }
            let [xx, xy, yy] = load.slope_n_per_m;
            let firm = 1e-9 * (xx + yy) + 1e-3 * LEAST_STIFFNESS;
            let [x, y] = residual(&load);
            let determinant = (xx + firm) * (yy + firm) - xy * xy;
            let way = [((yy + firm) * x - xy * y) / determinant, ((xx + firm) * y - xy * x) / determinant];
            let mut part = 1.0;
            let mut next = load;
            let mut next_m = at_m;
            for _ in 0..40 {
                next_m = [at_m[0] - part * way[0], at_m[1] - part * way[1]];
                next = self.load(next_m, places);
                if size(&next) < size(&load) {
                    break;
                }
                part /= 2.0;
            }
            (at_m, load) = (next_m, next);
        }
        (at_m[0], load)
    }

    /// The load of the elements on the outer ring, and its slopes.
    ///
    /// # Arguments
    /// * `at_m` - (m) displacement of the inner ring against the outer one
    /// * `places` - where the elements are
    #[inline(always)]
    pub(crate) fn load(&self, [x_m, y_m]: [f64; 2], places: &ElementPlaces) -> BearingLoad {
        // The kind of the elements is asked for once, so that the loop over them can be compiled for several side by side.
        let contact = &self.parts.contact;
        match contact.element {
            RollingElement::Ball => self.load_by([x_m, y_m], places, |pressed_m| contact.of_ball(pressed_m)),
            RollingElement::Roller => {
                self.load_by([x_m, y_m], places, |pressed_m| contact.of_roller(pressed_m))
            }
        }
    }

    /// [`Self::load`] with the load and slope of an element by its deflection.
    #[inline(always)]
    fn load_by(
        &self,
        [x_m, y_m]: [f64; 2],
        places: &ElementPlaces,
        of_element: impl Fn(f64) -> [f64; 2],
    ) -> BearingLoad {
        let [x_m, y_m] = [x_m * self.cos_contact_angle, y_m * self.cos_contact_angle];
        let mut sums = [[0.0; SIDE_BY_SIDE]; 5];
        for lot in &self.lots {
            for lane in 0..SIDE_BY_SIDE {
                let [cos, sin] = lot.direction(lane, places.cage);
                let pressed_m = x_m * cos + y_m * sin - lot.gap_m[lane];
                let [force, slope] = of_element(if pressed_m > 0.0 { pressed_m } else { 0.0 });
                let terms =
                    [force * cos, force * sin, slope * cos * cos, slope * cos * sin, slope * sin * sin];
                for (sum, term) in sums.iter_mut().zip(terms) {
                    sum[lane] += term;
                }
            }
        }
        let mut sums = sums.map(|[a, b, c, d, e, f, g, h]| ((a + b) + (c + d)) + ((e + f) + (g + h)));
        for (spall, &ElementDrop { element, drop_m, strike_n }) in places.drops.iter().enumerate() {
            if drop_m > 0.0 || strike_n > 0.0 {
                // In several spalls at once an element drops by their sum.
                let earlier = places.drops[..spall].iter().filter(|of| of.element == element);
                let earlier_m: f64 = earlier.map(|of| of.drop_m).sum();
                let (lot, lane) = (&self.lots[element / SIDE_BY_SIDE], element % SIDE_BY_SIDE);
                let [cos, sin] = lot.direction(lane, places.cage);
                let pressed_m = x_m * cos + y_m * sin - lot.gap_m[lane] - earlier_m;
                let sound = of_element(pressed_m.max(0.0));
                let dropped = of_element((pressed_m - drop_m).max(0.0));
                let [force, slope] = [dropped[0] - sound[0] + strike_n, dropped[1] - sound[1]];
                let added =
                    [force * cos, force * sin, slope * cos * cos, slope * cos * sin, slope * sin * sin];
                sums.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
            }
        }
        let (once, twice) = (self.cos_contact_angle, self.cos_contact_angle.powi(2));
        BearingLoad {
            force_n: [sums[0] * once, sums[1] * once],
            slope_n_per_m: [sums[2] * twice, sums[3] * twice, sums[4] * twice],
        }
    }

    /// The difference between the load of the elements and that of the linear spring.
    ///
    /// # Arguments
    /// * `x_m`, `y_m` - (m) stretch of the linear spring by the machine's motion
    /// * `places` - where the elements are
    #[inline(always)]
    pub(crate) fn beside_spring(&self, [x_m, y_m]: [f64; 2], places: &ElementPlaces) -> BearingLoad {
        let stretch_m = [x_m + self.off_m[0], y_m + self.off_m[1]];
        let [free_x_m, free_y_m] = self.free_m;
        let mut load = self.load([free_x_m + stretch_m[0], free_y_m + stretch_m[1]], places);
        let [[xx, xy], [_, yy]] = self.spring_n_per_m;
        load.force_n[0] -= xx * stretch_m[0] + xy * stretch_m[1];
        load.force_n[1] -= xy * stretch_m[0] + yy * stretch_m[1];
        load.slope_n_per_m.iter_mut().zip([xx, xy, yy]).for_each(|(slope, spring)| *slope -= spring);
        load
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::NamedBearing;

    fn bearing(
        name: &str,
        clearance_m: f64,
        preload_n: f64,
        contact_angle_deg: f64,
        load_n: [f64; 2],
    ) -> RollingBearing {
        let geometry = BearingGeometry { contact_angle_deg, ..NamedBearing::find(name).unwrap().geometry };
        let parts = RollingParts {
            contact: ElementContact::ball(&geometry),
            geometry,
            radial_clearance_m: clearance_m,
            preload_n,
            spalls: Vec::new(),
            slip: 0.0,
        };
        RollingBearing::new(parts, load_n)
    }

    /// An independent prototype's stiffness without clearance, to its three digits.
    #[test]
    fn stiffness_under_load_is_that_of_the_prototype() {
        for (name, table) in [("6205", [4.95e7, 7.14e7, 1.07e8]), ("ER-10K", [4.58e7, 6.60e7, 9.86e7])] {
            let bearing = bearing(name, 0.0, 0.0, 0.0, [100.0, 0.0]);
            // Half of the last digit of each.
            let half_digits = table.map(|stiffness| if stiffness < 1e8 { 5e4 } else { 5e5 });
            for ((load_n, stiffness), half_digit) in
                [100.0, 300.0, 1000.0].into_iter().zip(table).zip(half_digits)
            {
                let found = bearing.under_load(load_n)[1];
                assert!((found - stiffness).abs() <= half_digit, "{name} {load_n}: {found}");
            }
        }
    }

    #[test]
    fn clearance_softens_and_preload_stiffens() {
        let along = |clearance_m, preload_n, angle_deg| {
            bearing("ER-10K", clearance_m, preload_n, angle_deg, [100.0, 0.0]).under_load(100.0)[1]
        };
        let softened = along(5e-6, 0.0, 0.0) / along(0.0, 0.0, 0.0);
        assert!((0.92..0.96).contains(&softened), "{softened}");
        assert!(along(-5e-6, 0.0, 0.0) > 1.5 * along(0.0, 0.0, 0.0));
        // A preload takes up the clearance.
        assert!(along(0.0, 300.0, 15.0) > 1.5 * along(0.0, 0.0, 15.0));
        assert_eq!(along(0.0, 300.0, 15.0), along(5e-6, 300.0, 15.0));
    }

    /// A single element in the load's direction: force and slope are those of its contact.
    #[test]
    fn linear_limit_is_the_tangent_of_one_element() {
        let bearing = bearing("6205", 0.0, 0.0, 0.0, [0.0, -100.0]);
        let places = ElementPlaces { cage: [1.0, 0.0], drops: &[] };
        let small_m = 1e-9;
        // With a clearance that only the first element closes.
        let loose = RollingBearing {
            lots: bearing
                .lots
                .iter()
                .map(|lot| Elements { gap_m: lot.gap_m.map(|gap_m| gap_m.max(10e-6)), ..*lot })
                .collect(),
            ..bearing
        };
        let [before, after] = [12e-6, 12e-6 + small_m].map(|x_m| loose.load([x_m, 0.0], &places));
        let [force, slope] = loose.parts.contact.of_ball(2e-6);
        assert!((before.force_n[0] / force - 1.0).abs() < 1e-9 && before.force_n[1].abs() < 1e-9 * force);
        assert!(((after.force_n[0] - before.force_n[0]) / small_m / slope - 1.0).abs() < 1e-3);
    }

    /// The linear spring pushes with the static load at its place, with the mean slope, from any direction.
    #[test]
    fn spring_is_the_mean_slope_at_the_static_load() {
        for angle in [0.3, 2.0, 4.4] {
            let load_n = [200.0 * f64::cos(angle), 200.0 * f64::sin(angle)];
            let bearing = bearing("ER-10K", 5e-6, 0.0, 0.0, load_n);
            let [[xx, xy], [_, yy]] = bearing.spring_n_per_m;
            let determinant = xx * yy - xy * xy;
            let stretch_m = [
                (yy * load_n[0] - xy * load_n[1]) / determinant,
                (xx * load_n[1] - xy * load_n[0]) / determinant,
            ];
            let mut mean = [0.0; 2];
            for place in 0..64 {
                let (sin, cos) = (TAU * f64::from(place) / 64.0 / 8.0).sin_cos();
                let beside =
                    bearing.beside_spring(stretch_m, &ElementPlaces { cage: [cos, sin], drops: &[] });
                mean.iter_mut().zip(beside.force_n).for_each(|(mean, force)| *mean += force / 64.0);
            }
            assert!(mean[0].hypot(mean[1]) < 0.01 * 200.0, "{mean:?}");
        }
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_force_also_in_a_spall() {
        let bearing = bearing("6205", 2e-6, 0.0, 10.0, [50.0, 80.0]);
        let drop = |element, drop_m| ElementDrop { element, drop_m, strike_n: 0.0 };
        let drops = [drop(0, 3e-6), drop(1, 0.0), drop(0, 1e-6)];
        let places = ElementPlaces { cage: [f64::cos(0.7), f64::sin(0.7)], drops: &drops };
        let (at_m, step_m) = ([6e-6, 9e-6], 1e-11);
        let load = bearing.load(at_m, &places);
        let moved =
            |x: f64, y: f64| bearing.load([at_m[0] + x * step_m, at_m[1] + y * step_m], &places).force_n;
        let slope = |x, y, of: usize| (moved(x, y)[of] - moved(-x, -y)[of]) / (2.0 * step_m);
        // Two spalls under one element are one of both depths: it never pulls.
        let both = bearing.load(at_m, &ElementPlaces { drops: &[drop(0, 4e-6)], ..places });
        assert!((both.force_n[0] / load.force_n[0] - 1.0).abs() < 1e-12);
        let deep = |drops: &[ElementDrop]| bearing.load(at_m, &ElementPlaces { drops, ..places }).force_n;
        let (one, two) = (deep(&[drop(0, 1e-3)]), deep(&[drop(0, 1e-3); 2]));
        assert!(one.iter().zip(two).all(|(one, two)| (one / two - 1.0).abs() < 1e-12), "{one:?} {two:?}");
        for (found, expected) in
            load.slope_n_per_m.into_iter().zip([slope(1.0, 0.0, 0), slope(1.0, 0.0, 1), slope(0.0, 1.0, 1)])
        {
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }
}
