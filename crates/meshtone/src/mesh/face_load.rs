//! Flanks that are closer together towards one end of the face: how much of the face bears the nominal load, and where.
//!
//! The teeth are springs side by side along the face, `k' = k/b` each, without coupling. Where the unloaded flanks close by θ per
//! length of face, a light load bears on a length a from the closer end only, `F = k' θ a²/2`, and a heavier one on all of it. In
//! the time loop a pair is the spring that this is about the nominal load: the stiffness of the length that bears, closed where
//! its middle is, with the load at its centroid.

use std::f64::consts::TAU;

use super::path_table::PairState;

/// Flanks that close by more towards one end of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceSlope {
    /// (-) θ, how much closer together the unloaded flanks are per length of face; positive towards positive z.
    pub(crate) slope: f64,
    /// (m) Face width, b.
    pub(crate) width_m: f64,
    /// (rad/m) How far the wheels tilt against one another under the nominal load, per distance of it from the middle of the face.
    pub(crate) tilt_rad_per_m: f64,
}

/// Such flanks under the nominal load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceLoad {
    face: FaceSlope,
    /// (m) How far the load would press the teeth together if they closed alike along the face.
    deflection_m: f64,
    /// (-) θ less what the wheels' tilt takes, which makes them yield where they are pressed most.
    loaded_slope: f64,
}

/// A helix slope of a wheel that turns with it: `s cos(2πk/Z + φ)` of tooth k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HelixWobble {
    /// (-) s, its amplitude.
    pub(crate) slope: f64,
    /// (rad) φ.
    pub(crate) phase_rad: f64,
    /// Z.
    pub(crate) teeth: u32,
}

/// What such slopes make of the pairs of a mesh under the nominal load. That it then acts beside the middle of the face is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wobble {
    wheels: [HelixWobble; 2],
    /// The face with what slope all pairs have.
    steady: FaceLoad,
}

/// How a pair differs from one without wobble.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WobblingPair {
    /// (-) Its stiffness over that of the other one, where the face is one slice.
    pub(super) stiffness: f64,
    /// (m) By how much closer its flanks are there.
    pub(super) closer_m: f64,
    /// (m) By how much closer they are at one end of the face than at the other, where it has slices.
    pub(super) leans_m: f64,
}

impl WobblingPair {
    /// Without wobble.
    pub(super) const NONE: Self = Self { stiffness: 1.0, closer_m: 0.0, leans_m: 0.0 };
}

impl Wobble {
    /// The wobble of a mesh.
    ///
    /// # Arguments
    /// * `wheels` - of both
    /// * `face` - with the slope that all pairs have
    /// * `deflection_m` - (m) how far the load would press the teeth together if they closed alike along the face
    pub(super) fn new(wheels: [HelixWobble; 2], face: FaceSlope, deflection_m: f64) -> Self {
        Self { wheels, steady: FaceLoad::new(face, deflection_m) }
    }

    /// A pair, by the teeth of both wheels.
    pub(super) fn of_pair(&self, teeth: [usize; 2]) -> WobblingPair {
        let of_wheel = |(wheel, tooth): (&HelixWobble, usize)| {
            wheel.slope * (TAU * tooth as f64 / f64::from(wheel.teeth) + wheel.phase_rad).cos()
        };
        let steady = self.steady;
        let slope = steady.face.slope + self.wheels.iter().zip(teeth).map(of_wheel).sum::<f64>();
        let own = FaceLoad::new(FaceSlope { slope, ..steady.face }, steady.deflection_m);
        let [bears, before] = [own, steady].map(|load| load.whole());
        WobblingPair {
            stiffness: (bears.until_m - bears.from_m) / (before.until_m - before.from_m),
            closer_m: slope * bears.middle_m() - steady.face.slope * before.middle_m(),
            leans_m: (own.loaded_slope - steady.loaded_slope) * steady.face.width_m,
        }
    }
}

/// A part of the face, from one z to another.
#[derive(Debug, Clone, Copy)]
struct Bearing {
    from_m: f64,
    until_m: f64,
    /// (m) Centroid of the load on it.
    load_centre_m: f64,
}

impl Bearing {
    fn middle_m(&self) -> f64 {
        (self.from_m + self.until_m) / 2.0
    }
}

impl FaceLoad {
    /// A face under a load.
    ///
    /// # Arguments
    /// * `face` - how the flanks close
    /// * `deflection_m` - (m) how far the load would press the teeth together if they closed alike along the face
    pub(crate) fn new(face: FaceSlope, deflection_m: f64) -> Self {
        let unyielding = Self { face, deflection_m, loaded_slope: face.slope };
        let (mut low, mut high) = (0.0, face.slope.abs());
        // The larger the slope that is left, the farther from the middle the load acts.
        for _ in 0..HALVINGS {
            let left = (low + high) / 2.0;
            let centre_m = Self { loaded_slope: left, ..unyielding }.whole().load_centre_m;
            if left + face.tilt_rad_per_m * centre_m > face.slope.abs() {
                high = left;
            } else {
                low = left;
            }
        }
        Self { loaded_slope: high.copysign(face.slope), ..unyielding }
    }

    /// (-) How much closer together the flanks are per length of face, less what the wheels' tilt under the load takes.
    pub(crate) fn loaded_slope(&self) -> f64 {
        self.loaded_slope
    }

    /// What bears of sound teeth.
    fn whole(&self) -> Bearing {
        self.bearing(-self.face.width_m / 2.0, self.face.width_m / 2.0)
    }

    /// What bears of a part of the face.
    ///
    /// # Arguments
    /// * `from_m`, `until_m` - (m) the part that is left
    fn bearing(&self, from_m: f64, until_m: f64) -> Bearing {
        let (slope, width_m) = (self.loaded_slope, until_m - from_m);
        // A pair carries as much of the load as it has of the stiffness, so that its own does not matter.
        let bears_m = (2.0 * self.deflection_m * width_m / slope.abs()).sqrt();
        if bears_m >= width_m {
            let eccentric_m = slope * width_m * width_m / (12.0 * self.deflection_m);
            let load_centre_m = (from_m + until_m) / 2.0 + eccentric_m;
            Bearing { from_m, until_m, load_centre_m }
        } else if slope > 0.0 {
            Bearing { from_m: until_m - bears_m, until_m, load_centre_m: until_m - bears_m / 3.0 }
        } else {
            Bearing { from_m, until_m: from_m + bears_m, load_centre_m: from_m + bears_m / 3.0 }
        }
    }

    /// (m) Middle of what bears of sound teeth.
    pub(crate) fn middle_m(&self) -> f64 {
        self.whole().middle_m()
    }

    /// Makes a pair whose flanks close alike along the face one whose flanks close as these.
    ///
    /// # Arguments
    /// * `state` - of a pair that bears from the end of the face at negative z to one that is as far from the other end as twice
    ///   its face centre
    /// * `middle_m` - (m) where along the face the separation stays as it is
    pub(crate) fn lean(&self, state: &mut PairState, middle_m: f64) {
        let half_m = self.face.width_m / 2.0;
        let (from_m, until_m) = (-half_m, half_m + 2.0 * state.face_centre_m);
        let bearing = self.bearing(from_m, until_m);
        state.stiffness_n_per_m *= (bearing.until_m - bearing.from_m) / (until_m - from_m);
        state.separation_m -= self.face.slope * (bearing.middle_m() - middle_m);
        state.face_centre_m = bearing.load_centre_m;
    }
}

/// Halvings of an interval until only rounding is left.
const HALVINGS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH_M: f64 = 0.015;
    const STIFFNESS: f64 = 2e8;

    fn face(closer_um: f64, force_n: f64, tilt_rad_per_nm: f64) -> FaceLoad {
        let face = FaceSlope {
            slope: closer_um * 1e-6 / WIDTH_M,
            width_m: WIDTH_M,
            tilt_rad_per_m: tilt_rad_per_nm * force_n,
        };
        FaceLoad::new(face, force_n / STIFFNESS)
    }

    fn leaned(face: &FaceLoad) -> PairState {
        let mut state = PairState { stiffness_n_per_m: STIFFNESS, separation_m: 0.0, face_centre_m: 0.0 };
        face.lean(&mut state, face.middle_m());
        state
    }

    /// Springs side by side over a linear gap, pressed together by a force: the deflection at the closer end, the stiffness and
    /// the centroid of the load.
    fn springs(face: &FaceLoad, force_n: f64) -> [f64; 3] {
        let count = 200_000;
        let part = STIFFNESS / f64::from(count);
        let places = || (0..count).map(|n| WIDTH_M * ((f64::from(n) + 0.5) / f64::from(count) - 0.5));
        let gap = |z: f64| face.face.slope * (WIDTH_M / 2.0 - z);
        let force = |deflection: f64| places().map(|z| part * (deflection - gap(z)).max(0.0)).sum::<f64>();
        let (mut low, mut high) = (0.0, 1e-3);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if force(middle) < force_n { low = middle } else { high = middle }
        }
        let bears = places().filter(|z| gap(*z) < high).count();
        let moment = places().map(|z| z * part * (high - gap(z)).max(0.0)).sum::<f64>();
        [high, part * bears as f64, moment / force_n]
    }

    #[test]
    fn bears_as_springs_side_by_side() {
        for (closer_um, force_n) in [(1.0, 200.0), (5.0, 200.0), (5.0, 2000.0), (20.0, 100.0)] {
            let face = face(closer_um, force_n, 0.0);
            let state = leaned(&face);
            let [deflection, stiffness, centre] = springs(&face, force_n);
            assert!((state.stiffness_n_per_m / stiffness - 1.0).abs() < 1e-4, "{closer_um} {force_n}");
            assert!((state.face_centre_m - centre).abs() < 1e-5 * WIDTH_M, "{closer_um} {force_n}");
            // In closed form: F = k' x²/(2θ) while a part of the face bears, F = k (x − θb/2) beyond.
            let (part, closes) = (STIFFNESS / WIDTH_M, face.face.slope * WIDTH_M);
            let closed = if deflection < closes {
                part * deflection * deflection / (2.0 * face.face.slope)
            } else {
                STIFFNESS * (deflection - closes / 2.0)
            };
            assert!((closed / force_n - 1.0).abs() < 1e-4, "{closed} {force_n}");
        }
    }

    #[test]
    fn wheels_that_tilt_yield_to_the_load() {
        let [stiff, soft] = [0.0, 1.6e-5].map(|tilt| face(5.0, 200.0, tilt));
        let centre = leaned(&soft).face_centre_m;
        assert!((soft.loaded_slope + soft.face.tilt_rad_per_m * centre - soft.face.slope).abs() < 1e-12);
        assert!(leaned(&soft).stiffness_n_per_m > leaned(&stiff).stiffness_n_per_m);
    }

    #[test]
    fn the_other_end_is_the_mirror_image() {
        let [one, other] = [5.0, -5.0].map(|closer_um| leaned(&face(closer_um, 200.0, 1.6e-5)));
        assert_eq!(one.stiffness_n_per_m, other.stiffness_n_per_m);
        assert!((one.face_centre_m + other.face_centre_m).abs() < 1e-15 && one.face_centre_m > 0.0);
    }

    /// A pair bears on `√(2δ/s)` of its face where its flanks close by s over it, as was solved statically of a pair of 19 mm with 15 slices and
    /// 20 N/(mm µm) under 754 and 251 N; with no slope at all it stays as it is, and so do both ends alike.
    #[test]
    fn wobbling_pairs_bear_on_as_much_as_was_solved_in_slices() {
        let width_m = 0.019_05;
        let wheel =
            |closer_um: f64| HelixWobble { slope: closer_um * 1e-6 / width_m, phase_rad: 0.0, teeth: 32 };
        let face = FaceSlope { slope: 0.0, width_m, tilt_rad_per_m: 0.0 };
        for (closer_um, force_n, bears) in [
            (0.0, 754.0, 1.0),
            (6.0, 754.0, 0.81),
            (10.0, 754.0, 0.62),
            (20.0, 754.0, 0.44),
            (6.0, 251.0, 0.47),
            (20.0, 251.0, 0.25),
        ] {
            let deflection_m = force_n / (20e9 * width_m);
            let wobble = Wobble::new([wheel(closer_um), wheel(0.0)], face, deflection_m);
            let pair = wobble.of_pair([0, 5]);
            assert!((pair.stiffness / bears - 1.0).abs() < 0.03, "{closer_um} {force_n}: {pair:?}");
            let half_turned = wobble.of_pair([16, 5]);
            assert!(
                (half_turned.stiffness - pair.stiffness).abs() < 1e-12
                    && (half_turned.leans_m + pair.leans_m).abs() < 1e-15
            );
            assert!((pair.closer_m - closer_um * 1e-6 * (1.0 - pair.stiffness) / 2.0).abs() < 1e-12);
            // A quarter of a turn later it has no slope.
            assert!((wobble.of_pair([8, 5]).stiffness - 1.0).abs() < 1e-12);
        }
    }

    /// A chip at the end that would bear: the load begins where the chip ends, and the teeth sink in until there.
    #[test]
    fn a_part_that_is_missing_is_missed() {
        let face = face(5.0, 200.0, 0.0);
        let mut chipped =
            PairState { stiffness_n_per_m: STIFFNESS, separation_m: 0.0, face_centre_m: -0.0025 };
        face.lean(&mut chipped, face.middle_m());
        assert!(chipped.separation_m > 1e-6 && chipped.face_centre_m < leaned(&face).face_centre_m);
    }
}
