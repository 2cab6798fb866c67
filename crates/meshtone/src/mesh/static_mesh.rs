//! The mesh at rest under a force: how the pairs share it, and how far it lets the driven wheel lag behind.

use std::ops::Range;

use super::gear_mesh::Mesh;
use super::law::{CornerAt, Springs, deflection_at_rest};
use super::path_table::PairState;

/// A mesh at rest, point by point.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StaticMesh {
    /// (m) Deflection along the line of action at each point: the static transmission error. NaN where no pair can touch.
    pub deflection_m: Vec<f64>,
    /// Number of the first pair of [`Self::pair_force_n`]; pair n enters contact n pitches after the start of the simulation.
    pub first_pair: i64,
    /// (N) Force of each pair at each point: a row a pair.
    pub pair_force_n: Vec<Vec<f64>>,
}

impl StaticMesh {
    /// (m) Largest less smallest deflection.
    pub fn peak_to_peak_m(&self) -> f64 {
        let of = |pick: fn(f64, f64) -> f64, start: f64| self.deflection_m.iter().copied().fold(start, pick);
        of(f64::max, f64::NEG_INFINITY) - of(f64::min, f64::INFINITY)
    }
}

impl Mesh {
    /// The mesh at rest under a force over some pitches, `Σ k_n max(0, δ − S_n) = F`: of teeth without deviations, with their
    /// relief, chamfer and damage.
    ///
    /// # Arguments
    /// * `force_n` - (N) F, along the line of action, 0 or more
    /// * `pitches` - counted from the start of the simulation
    ///
    /// ```
    /// use std::num::NonZeroUsize;
    ///
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// let stages = meshtone::stages(&scenario)?;
    /// let mesh = &stages.meshes_at(NonZeroUsize::new(100).unwrap())?[0];
    /// let at_rest = mesh.at_rest(stages.static_force_n(), 0..2);
    /// assert!(at_rest.deflection_m.iter().all(|deflection| (0.4e-6..1e-6).contains(deflection)));
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    ///
    /// Source: S. L. Harris, Proceedings of the Institution of Mechanical Engineers 172 (1958).
    pub fn at_rest(&self, force_n: f64, pitches: Range<usize>) -> StaticMesh {
        let per_pitch = self.points_per_pitch;
        let points = pitches.start * per_pitch..pitches.end * per_pitch;
        let first_pair = self.pairs_at(points.start).map(|(pair, ..)| pair).min().unwrap_or(0);
        let last_pair =
            points.clone().last().and_then(|point| self.pairs_at(point).map(|(pair, ..)| pair).max());
        let rows = last_pair.map_or(0, |last| (last + 1 - first_pair).max(0) as usize);
        let mut pair_force_n = vec![vec![0.0; points.len()]; rows];
        let mut deflection_m = Vec::with_capacity(points.len());
        let (law, laws) = (self.law(), self.corner_laws());
        let (closer_m, tilt_m) = (self.closer_at_end_m, self.tilt_at_rest_m());
        for (column, point) in points.enumerate() {
            let touching: Vec<_> =
                self.pairs_at(point).filter(|(.., state)| state.stiffness_n_per_m > 0.0).collect();
            let numbers = touching.iter().map(|(.., state)| (state.stiffness_n_per_m, -state.separation_m));
            let (stiffness, offset): (Vec<f64>, Vec<f64>) = numbers.unzip();
            let (of_corner, corners): (Vec<i64>, Vec<CornerAt>) = self.corners_at(point).into_iter().unzip();
            if touching.is_empty() && corners.is_empty() {
                deflection_m.push(f64::NAN);
                continue;
            }
            let strip = |(pair, number, _): &(i64, usize, _)| self.strip(self.sequence.class(*pair), *number);
            let strips: Vec<[f64; 2]> = touching.iter().map(strip).collect();
            let springs = Springs {
                strips: &strips,
                closer_m: closer_m.unwrap_or(0.0),
                ..Springs::frictionless(&stiffness, &offset, &corners, &laws)
            };
            let deflection = match closer_m {
                Some(_) => law.tilted_at_rest(springs, tilt_m, force_n),
                None => deflection_at_rest(self.contact, springs, force_n),
            };
            deflection_m.push(deflection);
            for (n, (pair, _, state)) in touching.into_iter().enumerate() {
                let penetration = deflection - state.separation_m;
                let carried = match closer_m {
                    Some(_) => law.tilted(springs.only(n), [deflection, tilt_m]).forces[0],
                    None if self.contact.touches(penetration) => state.stiffness_n_per_m * penetration,
                    None => continue,
                };
                pair_force_n[(pair - first_pair) as usize][column] += carried;
            }
            for (pair, corner) in of_corner.iter().zip(&corners) {
                let lean_m = closer_m.map_or(0.0, |closer_m| tilt_m + closer_m);
                pair_force_n[(pair - first_pair) as usize][column] +=
                    corner.force_and_slope(&laws, deflection + corner.place * lean_m)[0];
            }
        }
        StaticMesh { deflection_m, first_pair, pair_force_n }
    }

    /// The corners that can touch at a point, each with the number of its pair.
    fn corners_at(&self, point: usize) -> Vec<(i64, CornerAt)> {
        let mut corners = Vec::new();
        for (pair, at, _) in self.pairs_at(point) {
            let (slice, at) = (at / self.points(), at % self.points());
            let class = self.sequence.class(pair);
            for (end, table) in self.classes[class].corners.get(slice).into_iter().flatten().enumerate() {
                let corner = CornerAt {
                    law: ((class * self.slices() + slice) * 2 + end) as u32,
                    offset_m: -table.separation_m,
                    near: table.reach.signed_root_at(table.near[at]),
                    far: table.reach.signed_root_at(table.far[at]),
                    place: self.corner_strip(slice, end, table.place, at as f64),
                };
                corners.extend(corner.can_touch().then_some((pair, corner)));
            }
        }
        corners
    }

    /// The pairs whose tables reach a point, counted from the start of the simulation, each with the number of its state: the newest first,
    /// slice by slice.
    pub(super) fn pairs_at(&self, point: usize) -> impl Iterator<Item = (i64, usize, &PairState)> {
        let (newest, since) = (
            (point + self.points_before) / self.points_per_pitch,
            (point + self.points_before) % self.points_per_pitch,
        );
        let points = (since..self.points()).step_by(self.points_per_pitch).enumerate();
        points.flat_map(move |(age, at)| {
            let pair = newest as i64 - age as i64;
            let states = self.classes[self.sequence.class(pair)].states.iter().enumerate();
            states.skip(at).step_by(self.points()).map(move |(number, state)| (pair, number, state))
        })
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroUsize;

    use super::*;
    use crate::scenario::{Fault, GearPair, MissingTooth, Scenario};
    use crate::simulate::stages;
    use crate::wheel::{FlankRelief, ReliefShape};

    fn mesh(change: impl FnOnce(&mut Scenario)) -> Mesh {
        let mut scenario = Scenario::new(GearPair::example());
        scenario.wheels.iter_mut().for_each(|wheel| wheel.tip_chamfer_mm = Some(0.0));
        change(&mut scenario);
        let points = NonZeroUsize::new(200).unwrap();
        stages(&scenario).unwrap().meshes_at(points).unwrap().swap_remove(0)
    }

    /// The force of the pairs at a point, the newest first.
    fn forces(at_rest: &StaticMesh, point: usize) -> Vec<f64> {
        at_rest.pair_force_n.iter().map(|pair| pair[point]).filter(|force| *force > 0.0).collect()
    }

    #[test]
    fn pairs_on_their_path_share_by_stiffness() {
        let mesh = mesh(|_| {});
        let force = 200.0;
        let at_rest = mesh.at_rest(force, 0..3);
        for (point, deflection) in at_rest.deflection_m.iter().enumerate() {
            let shared = forces(&at_rest, point);
            assert!((shared.iter().sum::<f64>() / force - 1.0).abs() < 1e-12);
            // Away from tip corners δ = F/Σ k.
            let on_path: Vec<f64> = (mesh.pairs_at(point))
                .filter(|(.., state)| state.separation_m == 0.0)
                .map(|(.., state)| state.stiffness_n_per_m)
                .collect();
            let alone = force / on_path.iter().sum::<f64>();
            if shared.len() == on_path.len() {
                assert!((deflection / alone - 1.0).abs() < 1e-12);
            } else {
                // A corner takes some of it.
                assert!(*deflection < alone);
            }
        }
        assert!(at_rest.peak_to_peak_m() > 0.0);
    }

    // The tip of the driven wheel touches first, that of the driving wheel last.
    #[test]
    fn relief_of_one_wheel_acts_at_one_end_of_the_path() {
        let relief = FlankRelief { shape: ReliefShape::Parabolic, length_mm: 1.5, amount_um: 20.0 };
        let relieved = |wheels: &[usize]| {
            mesh(|scenario| {
                scenario.wheels.iter_mut().for_each(|wheel| wheel.active_profile_shortening = 0.0);
                wheels.iter().for_each(|&wheel| scenario.wheels[wheel].flank_relief = relief);
            })
        };
        let [neither, driving, driven, both] = [&[][..], &[0], &[1], &[0, 1]].map(relieved);
        let separation_um = |mesh: &Mesh, n: usize| {
            let of = |mesh: &Mesh| mesh.classes[0].states[n].separation_m * 1e6;
            of(mesh) - of(&neither)
        };
        let pitch = neither.points_per_pitch as f64;
        let middle = neither.points_before + (neither.contact_ratio / 2.0 * pitch) as usize;
        let last = neither.points_before + (neither.contact_ratio * pitch) as usize;
        assert!((separation_um(&driven, neither.points_before) - 20.0).abs() < 1e-9);
        assert!((separation_um(&driving, last) - 20.0).abs() < 1.0);
        for n in 0..neither.classes[0].states.len() {
            let [at_end, at_start] = [&driving, &driven].map(|mesh| separation_um(mesh, n));
            let other = if n < middle { at_end } else { at_start };
            assert_eq!(other, 0.0, "{n}");
            assert!((at_end + at_start - separation_um(&both, n)).abs() < 1e-9);
        }

        // In the second half of its path a pair carries as one without relief until the next one would have entered; relief keeps that away.
        let force = 200.0;
        let carried = |mesh: &Mesh| -> Vec<f64> {
            let at_rest = mesh.at_rest(force, 0..4);
            let row = (1 - at_rest.first_pair) as usize;
            let of_pair = at_rest.pair_force_n[row].iter();
            of_pair.copied().collect()
        };
        let begins = |mesh: &Mesh| carried(mesh).iter().position(|force| *force > 1.0).unwrap();
        let ends = |mesh: &Mesh| carried(mesh).iter().rposition(|force| *force > 1.0).unwrap();
        println!("{:?}", [&neither, &driving, &driven, &both].map(|mesh| [begins(mesh), ends(mesh)]));
        assert!(begins(&driven) > begins(&neither) + 5 && begins(&driven).abs_diff(begins(&both)) <= 1);
        assert!(ends(&driving) + 5 < ends(&neither) && ends(&driving).abs_diff(ends(&both)) <= 1);
        assert!(begins(&driving) == begins(&neither) && ends(&driven) == ends(&neither));
    }

    #[test]
    fn relief_delays_a_pair_until_the_other_gives_way() {
        let relief = FlankRelief { shape: ReliefShape::Linear, length_mm: 2.0, amount_um: 20.0 };
        let mesh = mesh(|scenario| scenario.wheels.iter_mut().for_each(|wheel| wheel.flank_relief = relief));
        let point = 20;
        let two: Vec<[f64; 2]> = (mesh.pairs_at(point))
            .filter(|(.., state)| state.separation_m < 25e-6)
            .map(|(.., state)| [state.stiffness_n_per_m, state.separation_m])
            .collect();
        let [first, second] = two.try_into().unwrap();
        // Both carry beyond the force at which the stiffer placed one sinks in as far as the other is away.
        let (near, far) = if first[1] < second[1] { (first, second) } else { (second, first) };
        let until = near[0] * (far[1] - near[1]);
        let at = |force: f64| mesh.at_rest(force, 0..1).deflection_m[point];
        assert!((at(0.5 * until) - (0.5 * until / near[0] + near[1])).abs() < 1e-15);
        let sum = near[0] + far[0];
        let expected = (2.0 * until + near[0] * near[1] + far[0] * far[1]) / sum;
        assert!((at(2.0 * until) - expected).abs() < 1e-15);
    }

    #[test]
    fn a_missing_tooth_carries_nothing() {
        let mesh = mesh(|scenario| scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)]);
        let at_rest = mesh.at_rest(500.0, 36..40);
        let missing = (38 - at_rest.first_pair) as usize;
        assert!(at_rest.pair_force_n[missing].iter().all(|force| *force == 0.0));
        assert!(at_rest.pair_force_n[missing - 1].iter().any(|force| (force / 500.0 - 1.0).abs() < 1e-9));
        assert!(at_rest.deflection_m.iter().all(|deflection| deflection.is_finite()));
    }
}
