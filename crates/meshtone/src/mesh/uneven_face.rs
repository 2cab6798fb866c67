//! How unevenly a mesh at rest loads its face: by the lean of the shafts under the nominal load, by slopes of the flanks and by crowning.
//!
//! The face is a row of strips of the mean stiffness. At a place z along it the flanks penetrate by `D₀ + z D₁ − gap(z)`, and only push. The
//! deflection D₀ is that at which they carry the load; D₁ is the slope that the wheels take: that of the machine under a load midway, plus
//! that of the flanks, less what the moment of the load about the middle of the face tilts the wheels.

use crate::machine::Leans;

/// Strips of a face. The last one that bears is the narrower part of a strip.
const STRIPS: usize = 100;

/// How a mesh at rest under the nominal load bears along its face.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LoadAlongFace {
    /// (m) By how much more the shafts' lean under the load closes the flanks at the end of the face at positive z than at the other one,
    /// before the load moves there.
    pub lean_m: f64,
    /// (m) The same with what the moment of the load takes back.
    pub tilt_m: f64,
    /// (-) χ = c k̄ b²/12, c the tilt of the wheels against one another per moment about the middle of the face: of so much a part of the
    /// flanks' unevenness the wheels yield while the whole face bears, χ/(1 + χ).
    pub tilt_product: f64,
    /// (-) Largest load per length of face over its mean, of sound teeth: the face load factor K_Hβ of ISO 6336-1.
    pub face_load_factor: f64,
}

/// (-) Middle of a strip, from −½ to ½.
fn place(strip: usize) -> f64 {
    (strip as f64 + 0.5) / STRIPS as f64 - 0.5
}

impl LoadAlongFace {
    /// An even load.
    pub(super) const EVEN: Self = Self { lean_m: 0.0, tilt_m: 0.0, tilt_product: 0.0, face_load_factor: 1.0 };
}

/// A face of a mean mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UnevenFace {
    /// (m) Face width.
    pub(crate) width_m: f64,
    /// (N/m) Mean stiffness of the mesh.
    pub(crate) stiffness_n_per_m: f64,
    /// (N) Load.
    pub(crate) force_n: f64,
    /// (-) By how much closer together the unloaded flanks are per length of face, towards positive z.
    pub(crate) slope: f64,
    /// (m) Of each strip, how much farther apart the flanks are than those in the middle.
    gaps_m: Vec<f64>,
}

impl UnevenFace {
    /// A face.
    ///
    /// # Arguments
    /// * `width_m`, `stiffness_n_per_m`, `force_n`, `slope` - as the fields
    /// * `mean_gap_m` - (m) of a part of the face, from −½ to ½, how much farther apart its flanks are on average than those in the middle
    pub(crate) fn new(
        [width_m, stiffness_n_per_m, force_n, slope]: [f64; 4],
        mean_gap_m: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let edge = |n: usize| n as f64 / STRIPS as f64 - 0.5;
        let gaps_m = (0..STRIPS).map(|n| mean_gap_m([edge(n), edge(n + 1)])).collect();
        Self { width_m, stiffness_n_per_m, force_n, slope, gaps_m }
    }

    /// (m) Penetration of each strip where the face carries the load at a slope of the wheels.
    ///
    /// # Arguments
    /// * `tilt` - (-) D₁
    fn pressed_m(&self, tilt: f64) -> Vec<f64> {
        let place_m = |n: usize| place(n) * self.width_m;
        let offsets: Vec<f64> =
            self.gaps_m.iter().enumerate().map(|(n, gap)| place_m(n) * (tilt + self.slope) - gap).collect();
        // The load less the first strips' shares falls convexly: Newton's method comes down to the solution from where all of them touch.
        let needed_m = self.needed_m();
        let most_m = offsets.iter().copied().fold(f64::INFINITY, f64::min);
        let mut deflection_m = needed_m - most_m;
        for _ in 0..STRIPS {
            let touching = offsets.iter().filter(|offset| deflection_m + **offset > 0.0);
            let (count, sum) = touching.fold((0.0, 0.0), |(count, sum), offset| (count + 1.0, sum + offset));
            let next_m = (needed_m - sum) / count;
            if next_m >= deflection_m {
                break;
            }
            deflection_m = next_m;
        }
        offsets.iter().map(|offset| (deflection_m + offset).max(0.0)).collect()
    }

    /// (m) Penetrations of all strips together.
    fn needed_m(&self) -> f64 {
        self.force_n / self.stiffness_n_per_m * STRIPS as f64
    }

    /// (N m) Moment of the load about the middle of the face.
    fn moment_nm(&self, tilt: f64) -> f64 {
        let strip_n_per_m = self.stiffness_n_per_m / STRIPS as f64;
        let place_m = |n: usize| place(n) * self.width_m;
        self.pressed_m(tilt).iter().enumerate().map(|(n, pressed)| place_m(n) * pressed).sum::<f64>()
            * strip_n_per_m
    }

    /// (-) D₁ where the moment of the load holds the wheels.
    ///
    /// # Arguments
    /// * `free` - (-) D₁ without the moment
    /// * `rad_per_nm` - (rad/(N m)) how much less per moment
    fn held_tilt(&self, free: f64, rad_per_nm: f64) -> f64 {
        if free + self.slope == 0.0 {
            // Crowning and end relief alone load both halves of the face alike.
            return free;
        }
        // The more the wheels lean, the larger is the moment that holds them: they lie between what none and the largest one leaves.
        let most = rad_per_nm * self.force_n * self.width_m / 2.0;
        let (mut low, mut high) = (free - most, free + most);
        for _ in 0..HALVINGS {
            let tilt = (low + high) / 2.0;
            if tilt + rad_per_nm * self.moment_nm(tilt) > free { high = tilt } else { low = tilt }
        }
        (low + high) / 2.0
    }

    /// (-) Largest load per length of face over its mean: the face load factor K_Hβ of ISO 6336-1.
    fn factor(&self, tilt: f64) -> f64 {
        let pressed_m = self.pressed_m(tilt);
        let largest_m = pressed_m.iter().copied().fold(0.0, f64::max);
        // The load is largest at an end of the face, half a strip from the last strip's middle.
        let towards_end = (tilt + self.slope).abs() * self.width_m / STRIPS as f64 / 2.0;
        (largest_m + towards_end) / (self.needed_m() / STRIPS as f64)
    }
}

/// The faces of meshes that tilt their wheels together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FacesAtRest {
    /// Of each mesh.
    pub(crate) faces: Vec<UnevenFace>,
    /// Of the machine around them.
    pub(crate) leans: Leans,
}

impl FacesAtRest {
    /// The faces with more crowning in one mesh.
    ///
    /// # Arguments
    /// * `mesh` - its number
    /// * `crowning_m` - (m) how much farther apart the flanks are at both ends of the face
    pub(crate) fn crowned(&self, mesh: usize, crowning_m: f64) -> Self {
        let mut this = self.clone();
        let gaps = this.faces[mesh].gaps_m.iter_mut().enumerate();
        gaps.for_each(|(n, gap_m)| *gap_m += 4.0 * crowning_m * place(n).powi(2));
        this
    }

    /// How the meshes bear.
    pub(crate) fn loads(&self) -> Vec<LoadAlongFace> {
        let Self { faces, leans: Leans { slopes, rad_per_nm } } = self;
        let mut tilts = slopes.clone();
        // Meshes on one shaft tilt one another little, so that few rounds suffice.
        let rounds = if faces.len() > 1 { ROUNDS } else { 1 };
        for _ in 0..rounds {
            for (mesh, face) in faces.iter().enumerate() {
                let row = &rad_per_nm[mesh];
                let others = (0..faces.len()).filter(|other| *other != mesh);
                let of_others: f64 =
                    others.map(|other| row[other] * faces[other].moment_nm(tilts[other])).sum();
                tilts[mesh] = face.held_tilt(slopes[mesh] - of_others, row[mesh]);
            }
        }
        let load = |(mesh, face): (usize, &UnevenFace)| LoadAlongFace {
            lean_m: slopes[mesh] * face.width_m,
            tilt_m: tilts[mesh] * face.width_m,
            tilt_product: rad_per_nm[mesh][mesh] * face.stiffness_n_per_m * face.width_m.powi(2) / 12.0,
            face_load_factor: face.factor(tilts[mesh]),
        };
        faces.iter().enumerate().map(load).collect()
    }
}

const ROUNDS: usize = 6;
/// Halvings of an interval until a millionth of it is left.
const HALVINGS: usize = 24;

#[cfg(test)]
mod tests {
    use super::*;

    fn face(closer_um: f64, crowning_um: f64, force_n: f64) -> UnevenFace {
        UnevenFace::new([0.015, 2e8, force_n, closer_um * 1e-6 / 0.015], |[from, until]| {
            4e-6 * crowning_um * (until.powi(3) - from.powi(3)) / (3.0 * (until - from))
        })
    }

    fn factor(face: UnevenFace, slope: f64, rad_per_nm: f64) -> f64 {
        let leans = Leans { slopes: vec![slope], rad_per_nm: vec![vec![rad_per_nm]] };
        FacesAtRest { faces: vec![face], leans }.loads()[0].face_load_factor
    }

    /// ISO 6336-1, method C: `1 + F_β k̄/(2F)` up to 2 and `√(2 F_β k̄/F)` above.
    #[test]
    fn stiff_wheels_are_as_in_the_standard() {
        for (closer_um, force_n) in [(1.0, 200.0), (5.0, 200.0), (-5.0, 200.0), (5.0, 2000.0), (30.0, 200.0)]
        {
            let closes = f64::abs(closer_um) * 1e-6 * 2e8 / force_n;
            let expected = if closes < 2.0 { 1.0 + closes / 2.0 } else { (2.0 * closes).sqrt() };
            let found = factor(face(closer_um, 0.0, force_n), 0.0, 0.0);
            assert!((found / expected - 1.0).abs() < 5e-3, "{closer_um} {force_n}: {found} {expected}");
        }
        assert!((factor(face(0.0, 0.0, 200.0), 0.0, 0.0) - 1.0).abs() < 1e-12);
    }

    /// While the whole face bears, `K = 1 + k̄ L/(2F(1 + χ))` with `χ = c k̄ b²/12`.
    #[test]
    fn wheels_that_tilt_yield_to_the_load() {
        let compliance = 3e-5;
        let yields = compliance * 2e8 * 0.015f64.powi(2) / 12.0;
        let expected = 1.0 + 2e8 * 1e-6 / (2.0 * 200.0 * (1.0 + yields));
        let found = factor(face(0.0, 0.0, 200.0), 1e-6 / 0.015, compliance);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }

    #[test]
    fn crowning_helps_a_face_that_leans() {
        let of = |crowning_um: f64| factor(face(20.0, crowning_um, 200.0), 0.0, 0.0);
        assert!(of(8.0) < of(0.0) && of(0.0) > 6.0);
    }
}
