//! Where the elements of a rolling bearing are, sample by sample.

use std::f64::consts::{PI, TAU};

use super::defect::{Crossing, Strike};
use super::{DefectPlace, ElementContact, ElementDrop, ElementPlaces, RollingBearing};
use crate::random::{Draws, Purpose};

/// Where the elements of one bearing are at successive samples.
#[derive(Debug, Clone, Default)]
pub(crate) struct BearingBlock {
    /// Cosine and sine of the cage's angle.
    cage: Vec<[f64; 2]>,
    /// Number of spalls.
    spalls: usize,
    /// The element nearest to each spall, sample by sample.
    drops: Vec<ElementDrop>,
}

impl BearingBlock {
    /// Where the elements are at a sample.
    #[inline(always)]
    pub(crate) fn places(&self, sample: usize) -> ElementPlaces<'_> {
        let first = sample * self.spalls;
        ElementPlaces { cage: self.cage[sample], drops: &self.drops[first..first + self.spalls] }
    }
}

/// The rotation of a bearing's cage and rings.
///
/// The cage turns by FTF times the shaft's angle, without slip, and by a random walk: at each pass of an element its angle gains a normal number
/// of the stated part of the elements' spacing. A walk makes the lines of a defect wider the higher their order is; an error of each pass
/// alone would leave them sharp.
///
/// Source: J. Antoni, R. B. Randall, J. Vib. Acoust. 125 (2003) 282–289.
pub(crate) struct BearingTurning<'a> {
    bearing: &'a RollingBearing,
    elements: usize,
    step_s: f64,
    /// (rev) Of the motor, at the last sample.
    last: Option<f64>,
    /// (-) Angle of the inner and the outer ring, of the cage against the outer ring, and of an element's spin, over that of the motor.
    ratios: [f64; 4],
    /// (rad) Angles of the cage and of an element's spin at the start.
    start_rad: [f64; 2],
    slip: Walk,
    spalls: Vec<TurningSpall>,
}

struct TurningSpall {
    place: DefectPlace,
    /// (rad) Its middle at the start.
    angle_rad: f64,
    /// (m) Radius of what it is on.
    radius_m: f64,
    /// (m) Way of an element past it in a revolution of the motor.
    way_m: f64,
    crossing: Crossing,
}

/// (-) Speed at which an element bounces off an edge over that at which it strikes it: of oiled steel between 0.3 and 0.8.
const RESTITUTION: f64 = 0.5;
/// (samples) Shortest time in which an element strikes: what has a shorter contact is not resolved.
const SHORTEST_STRIKE: f64 = 3.0;

/// A random walk of one step at each pass.
struct Walk {
    draws: Draws,
    step_rad: f64,
    /// Number of the pass that is reached, and its angle and that of the next one.
    pass: u64,
    around_rad: [f64; 2],
}

impl Walk {
    fn new(draws: Draws, step_rad: f64) -> Self {
        let mut this = Self { draws, step_rad, pass: 0, around_rad: [0.0; 2] };
        this.around_rad[1] = this.next_rad(0.0);
        this
    }

    fn next_rad(&mut self, from_rad: f64) -> f64 {
        if self.step_rad > 0.0 { from_rad + self.step_rad * self.draws.normal() } else { 0.0 }
    }

    /// (rad) The walk at a number of passes, which never falls.
    fn at_rad(&mut self, passes: f64) -> f64 {
        while self.step_rad > 0.0 && passes >= (self.pass + 1) as f64 {
            self.pass += 1;
            let last_rad = self.around_rad[1];
            self.around_rad = [last_rad, self.next_rad(last_rad)];
        }
        let [before_rad, after_rad] = self.around_rad;
        before_rad + (after_rad - before_rad) * (passes - self.pass as f64).clamp(0.0, 1.0)
    }
}

impl<'a> BearingTurning<'a> {
    /// A bearing from the start of a simulation on.
    ///
    /// # Arguments
    /// * `bearing` - the bearing
    /// * `ring_ratios` - (-) rotation of its inner ring and of its outer one over that of the motor, seen where its load stands still: of a shaft's
    ///   bearing that of the shaft and 0, of a planet's 0 of the pin and that of the planet
    /// * `seed` - of the scenario
    /// * `number` - of the bearing in it
    /// * `step_s` - (s) from sample to sample
    pub(crate) fn new(
        bearing: &'a RollingBearing,
        [inner, outer]: [f64; 2],
        seed: u64,
        number: usize,
        step_s: f64,
    ) -> Self {
        let geometry = &bearing.parts.geometry;
        let orders = geometry.defect_orders();
        let mut start = Draws::new(seed, Purpose::BearingStart, number as u64);
        let spacing_rad = TAU / f64::from(geometry.elements);
        let contact_mm = geometry.element_mm * geometry.contact_angle_deg.to_radians().cos();
        let [rolling, spin] = [orders.cage, orders.element_spin].map(|order| order * (inner - outer));
        let cage = outer + rolling;
        let spall = |spall: &super::Spall| {
            let (start_rad, radius_mm, turned) = match spall.place {
                DefectPlace::Outer => {
                    (bearing.load_angle_rad(), (geometry.pitch_mm + contact_mm) / 2.0, outer - cage)
                }
                DefectPlace::Inner => {
                    (bearing.load_angle_rad(), (geometry.pitch_mm - contact_mm) / 2.0, inner - cage)
                }
                DefectPlace::Element => (0.0, geometry.element_mm / 2.0, spin),
            };
            TurningSpall {
                place: spall.place,
                angle_rad: start_rad + spall.angle_deg.to_radians(),
                radius_m: radius_mm * 1e-3,
                way_m: TAU * turned * radius_mm * 1e-3,
                crossing: Crossing::new(spall, geometry),
            }
        };
        Self {
            bearing,
            elements: geometry.elements as usize,
            step_s,
            last: None,
            ratios: [inner, outer, rolling, spin],
            start_rad: [start.uniform(PI, PI), start.uniform(PI, PI)],
            slip: Walk::new(
                Draws::new(seed, Purpose::BearingSlip, number as u64),
                bearing.parts.slip * spacing_rad,
            ),
            spalls: bearing.parts.spalls.iter().map(spall).collect(),
        }
    }

    /// Sets a block to the next samples.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) of the motor, at the samples
    /// * `block` - is overwritten
    pub(crate) fn next_block(&mut self, revolutions: &[f64], block: &mut BearingBlock) {
        block.cage.clear();
        block.drops.clear();
        block.spalls = self.spalls.len();
        let [inner_ratio, outer_ratio, cage_ratio, spin_ratio] = self.ratios;
        let spacing_rad = TAU / self.elements as f64;
        for (k, motor) in revolutions.iter().enumerate() {
            // Before the first sample it turned as it does after it.
            let turned = match self.last {
                Some(last) => motor - last,
                None => revolutions.get(k + 1).map_or(0.0, |next| next - motor),
            };
            self.last = Some(*motor);
            let rolled_rad = TAU * cage_ratio * motor;
            let slipped_rad = self.slip.at_rad(rolled_rad.abs() / spacing_rad) * cage_ratio.signum();
            let cage_rad = self.start_rad[0] + TAU * outer_ratio * motor + rolled_rad + slipped_rad;
            let (sin, cos) = cage_rad.sin_cos();
            block.cage.push([cos, sin]);
            for spall in &self.spalls {
                let nearest = |angle_rad: f64| {
                    let from_first = (angle_rad - cage_rad) / spacing_rad;
                    let element = from_first.round();
                    (
                        element.rem_euclid(self.elements as f64) as usize % self.elements,
                        (from_first - element) * spacing_rad,
                    )
                };
                let (element, angle_rad) = match spall.place {
                    DefectPlace::Outer => nearest(spall.angle_rad + TAU * outer_ratio * motor),
                    DefectPlace::Inner => nearest(spall.angle_rad + TAU * inner_ratio * motor),
                    DefectPlace::Element => {
                        // It slips as much as its cage does, and meets a race every half turn.
                        let spun_rad = self.start_rad[1]
                            + spall.angle_rad
                            + (rolled_rad + slipped_rad) * (spin_ratio / cage_ratio);
                        (0, spun_rad - (spun_rad / PI).round() * PI)
                    }
                };
                let from_middle_m = angle_rad * spall.radius_m;
                let pressed_m = || self.bearing.pressed_m(cage_rad + element as f64 * spacing_rad);
                let ways_m = [from_middle_m, spall.way_m * turned];
                let strike_n = spall.strike_n(&self.bearing.parts.contact, pressed_m, ways_m, self.step_s);
                block.drops.push(ElementDrop {
                    element,
                    drop_m: spall.crossing.at_m(from_middle_m),
                    strike_n,
                });
            }
        }
    }
}

impl TurningSpall {
    /// (N) Force of the strikes of the element over the spall: of its mass times the change of its speed, in the time of a contact.
    ///
    /// # Arguments
    /// * `contact` - of the element
    /// * `pressed_m` - (m) by how much it is pressed together beside the spall
    /// * `ways_m` - (m) from the middle of the spall to the element, and by how much that has grown since the last sample
    /// * `step_s` - (s) between both
    fn strike_n(
        &self,
        contact: &ElementContact,
        pressed_m: impl Fn() -> f64,
        [from_middle_m, way_m]: [f64; 2],
        step_s: f64,
    ) -> f64 {
        let half_width_m = self.crossing.half_width_m;
        let entered_m = from_middle_m * way_m.signum() + half_width_m;
        // Elsewhere none strikes, which is most of the time.
        if entered_m <= 0.0 || entered_m >= 4.0 * half_width_m + SHORTEST_STRIKE * way_m.abs() {
            return 0.0;
        }
        let of_strike = |strike: Strike| {
            let speed_m_per_s = way_m.abs() / step_s * strike.bend;
            let samples = (contact.strike_s(speed_m_per_s) / step_s).max(SHORTEST_STRIKE);
            let passed = (entered_m - strike.at_m) / way_m.abs() / samples;
            if !(0.0..1.0).contains(&passed) {
                return 0.0;
            }
            let momentum = (1.0 + RESTITUTION) * contact.mass_kg * speed_m_per_s;
            momentum / (samples * step_s) * (1.0 - (TAU * passed).cos())
        };
        self.crossing.strikes(pressed_m()).into_iter().map(of_strike).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::{BearingDefect, NamedBearing, RollingParts, Spall};

    fn bearing(race: DefectPlace, slip: f64) -> RollingBearing {
        let geometry = NamedBearing::find("6205").unwrap().geometry;
        let spalls = vec![Spall::new(&BearingDefect::new(race, 0.2), &geometry).unwrap()];
        let parts = RollingParts {
            contact: ElementContact::ball(&geometry),
            geometry,
            radial_clearance_m: 5e-6,
            preload_n: 0.0,
            spalls,
            slip,
        };
        RollingBearing::new(parts, [0.0, -100.0])
    }

    /// Numbers of revolutions of the motor at which an element is deepest in a spall, over some revolutions.
    fn hits(mut turning: BearingTurning, revolutions: usize) -> Vec<f64> {
        let per_revolution = 20_000;
        let motor: Vec<f64> =
            (0..revolutions * per_revolution).map(|k| k as f64 / per_revolution as f64).collect();
        let mut block = BearingBlock::default();
        turning.next_block(&motor, &mut block);
        let drop = |k: usize| block.drops[k].drop_m;
        let is_deepest = |&k: &usize| drop(k) > 0.0 && drop(k) > drop(k - 1) && drop(k) >= drop(k + 1);
        (1..motor.len() - 1).filter(is_deepest).map(|k| motor[k]).collect()
    }

    /// BPFO, BPFI and 2 BSF of the revolutions of one ring against the other, whichever turns and which way.
    #[test]
    fn elements_meet_a_spall_at_the_orders_of_the_bearing() {
        for (place, order) in
            [(DefectPlace::Outer, 3.58478), (DefectPlace::Inner, 5.41522), (DefectPlace::Element, 4.71350)]
        {
            // A shaft either way, and a planet that turns about its pin.
            for ratios in [[1.0, 0.0], [-0.4, 0.0], [0.0, -0.6]] {
                let hits = hits(BearingTurning::new(&bearing(place, 0.0), ratios, 7, 0, 1e-5), 20);
                let count = (hits.len() - 1) as f64;
                let found = count / (hits[hits.len() - 1] - hits[0]);
                let ratio = f64::abs(ratios[0] - ratios[1]);
                assert!((found / (order * ratio) - 1.0).abs() < 2e-3, "{place:?} {ratios:?}: {found}");
            }
        }
    }

    /// Of a pass over a spall, whatever the step: the force of the strike has its momentum, though few samples.
    #[test]
    fn strikes_have_the_momentum_of_the_element() {
        let bearing = bearing(DefectPlace::Outer, 0.0);
        let strike = TurningSpall {
            place: DefectPlace::Outer,
            angle_rad: 0.0,
            radius_m: 0.0235,
            way_m: 0.0,
            crossing: Crossing::new(&bearing.parts.spalls[0], &bearing.parts.geometry),
        };
        let towards_rad = bearing.load_angle_rad();
        let expected: f64 = (strike.crossing.strikes(bearing.pressed_m(towards_rad)).iter())
            .map(|strike| 1.5 * bearing.parts.contact.mass_kg * 1.8 * strike.bend)
            .sum();
        for step_s in [4e-5, 1e-5, 2e-6] {
            let way_m = 1.8 * step_s;
            let pressed_m = || bearing.pressed_m(towards_rad);
            let ways_m = |k: i32| [(f64::from(k) + 0.3) * way_m, -way_m];
            let force_n = |k: i32| strike.strike_n(&bearing.parts.contact, pressed_m, ways_m(k), step_s);
            let found: f64 = (-2000..2000).map(|k| force_n(k) * step_s).sum();
            println!("{step_s}: {found:.3e} {expected:.3e}");
            assert!((found / expected - 1.0).abs() < 0.01);
        }
    }

    /// 1 % of a spacing at each pass: the interval of two passes has that standard deviation, and the walk grows with their root.
    #[test]
    fn cage_slips_by_a_walk() {
        let hits = hits(BearingTurning::new(&bearing(DefectPlace::Outer, 0.01), [1.0, 0.0], 7, 0, 1e-5), 400);
        let deviation = |over: usize| {
            let gaps: Vec<f64> = hits.windows(over + 1).map(|of| of[over] - of[0]).collect();
            let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
            (gaps.iter().map(|gap| (gap - mean).powi(2)).sum::<f64>() / gaps.len() as f64).sqrt() * 3.58478
        };
        // A pass lies between two steps of the walk: √(2/3) of a step where it is read between them.
        assert!((0.0075..0.0105).contains(&deviation(1)), "{}", deviation(1));
        assert!((0.08..0.13).contains(&deviation(100)), "{}", deviation(100));
    }
}
