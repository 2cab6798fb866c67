//! Which teeth meet, and which pairs are alike.

use crate::damage::DamagedTooth;
use crate::error::ScenarioError;
use crate::operation::{greatest_common_divisor, least_common_multiple};
use crate::wheel::WheelName;

/// The sequence of tooth pairs: pair n meets the pinion's tooth `n mod z_p` and the gear's tooth `n mod z_g`, and enters contact
/// n pitches after the start of the simulation.
///
/// Pairs are of one *class* where both teeth are alike; most are of the class of two sound teeth, which is the first.
#[derive(Debug, Clone, PartialEq)]
pub struct PairSequence {
    pinion_teeth: usize,
    gear_teeth: usize,
    /// Which damaged tooth each tooth is, 0 for a sound one.
    pinion_damage: Vec<usize>,
    gear_damage: Vec<usize>,
    /// Class of each combination of damages, by the pinion's and then the gear's.
    class_of_damages: Vec<usize>,
    gear_kinds: usize,
    classes: Vec<PairKind>,
}

/// What is common to the pairs of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PairKind {
    /// Which damaged tooth the pinion's is; none for a sound one.
    pub pinion: Option<usize>,
    /// Which damaged tooth the gear's is.
    pub gear: Option<usize>,
    /// How many pairs of this class meet until the same two teeth meet again.
    pub pairs_per_cycle: usize,
}

impl PairKind {
    /// Whether both teeth are sound.
    pub(crate) fn is_sound(&self) -> bool {
        self.pinion.is_none() && self.gear.is_none()
    }
}

impl PairSequence {
    /// The sequence of two wheels.
    ///
    /// Every pair has the damages of its two teeth, and pairs of equal damages make a class. How many pairs of a class there are in a cycle
    /// is counted by residues instead of going through the cycle, which has as many pairs as the product of the tooth counts. Classes
    /// without a pair are left out, so that nothing is computed for them.
    ///
    /// # Arguments
    /// * `pinion_teeth`, `gear_teeth` - tooth counts
    /// * `damaged` - the damaged teeth, each named once; those that are alike may be named together and make one class
    ///
    /// # Errors
    /// A wheel without teeth, a damaged tooth beyond its wheel's last one.
    ///
    /// ```
    /// use meshtone::mesh::PairSequence;
    ///
    /// let sequence = PairSequence::new(17, 38, &[])?;
    /// assert_eq!((sequence.teeth(40), sequence.cycle()), ((6, 2), 17 * 38));
    /// assert_eq!(PairSequence::new(0, 38, &[]).unwrap_err().key, "gears.pinion_teeth");
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn new(pinion_teeth: u32, gear_teeth: u32, damaged: &[DamagedTooth]) -> Result<Self, ScenarioError> {
        check_teeth([pinion_teeth, gear_teeth], damaged)?;
        let of_wheel = |wheel: WheelName, teeth: u32| {
            let mut damages = vec![0; teeth as usize];
            for (index, tooth) in damaged.iter().enumerate().filter(|(_, tooth)| tooth.wheel == wheel) {
                tooth.teeth.iter().for_each(|&tooth| damages[tooth] = index + 1);
            }
            damages
        };
        let pinion_damage = of_wheel(WheelName::Pinion, pinion_teeth);
        let gear_damage = of_wheel(WheelName::Gear, gear_teeth);
        let kinds = damaged.len() + 1;
        // Two teeth meet once a cycle if their indices are congruent modulo the greatest common divisor, else never.
        let divisor = greatest_common_divisor(pinion_teeth, gear_teeth) as usize;
        let mut pairs = vec![0; kinds * kinds];
        let count = |damages: &[usize], residue: usize| {
            let mut counts = vec![0; kinds];
            damages.iter().skip(residue).step_by(divisor).for_each(|&damage| counts[damage] += 1);
            counts
        };
        for residue in 0..divisor {
            let (of_pinion, of_gear) = (count(&pinion_damage, residue), count(&gear_damage, residue));
            for (p, pinions) in of_pinion.iter().enumerate() {
                for (g, gears) in of_gear.iter().enumerate() {
                    pairs[p * kinds + g] += pinions * gears;
                }
            }
        }
        let mut classes = Vec::new();
        let mut class_of_damages = vec![0; kinds * kinds];
        for (place, &pairs_per_cycle) in pairs.iter().enumerate() {
            // Sound pairs have a class even where every tooth of a wheel is damaged.
            if pairs_per_cycle > 0 || place == 0 {
                class_of_damages[place] = classes.len();
                let (pinion, gear) = ((place / kinds).checked_sub(1), (place % kinds).checked_sub(1));
                classes.push(PairKind { pinion, gear, pairs_per_cycle });
            }
        }
        Ok(Self {
            pinion_teeth: pinion_teeth as usize,
            gear_teeth: gear_teeth as usize,
            pinion_damage,
            gear_damage,
            class_of_damages,
            gear_kinds: kinds,
            classes,
        })
    }

    /// The classes; the first is that of two sound teeth.
    pub fn classes(&self) -> &[PairKind] {
        &self.classes
    }

    /// Indices of the pinion's and of the gear's tooth in pair `pair`; pairs before the start count down from −1.
    ///
    /// # Arguments
    /// * `pair` - its number
    pub fn teeth(&self, pair: i64) -> (usize, usize) {
        let tooth = |teeth: usize| pair.rem_euclid(teeth as i64) as usize;
        (tooth(self.pinion_teeth), tooth(self.gear_teeth))
    }

    /// Class of pair `pair`.
    ///
    /// # Arguments
    /// * `pair` - its number
    pub fn class(&self, pair: i64) -> usize {
        let (pinion, gear) = self.teeth(pair);
        self.class_of_damages[self.pinion_damage[pinion] * self.gear_kinds + self.gear_damage[gear]]
    }

    /// Number of pairs until the same two teeth meet again: the least common multiple of the tooth counts.
    pub fn cycle(&self) -> usize {
        least_common_multiple(self.pinion_teeth as u32, self.gear_teeth as u32) as usize
    }

    /// Tooth count of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - which
    pub fn teeth_of(&self, wheel: WheelName) -> usize {
        match wheel {
            WheelName::Pinion => self.pinion_teeth,
            WheelName::Gear => self.gear_teeth,
        }
    }

    /// Number of gear teeth: of pairs in a gear revolution.
    pub fn gear_teeth(&self) -> usize {
        self.gear_teeth
    }
}

/// Both wheels have teeth, and among them the damaged ones.
fn check_teeth([pinion_teeth, gear_teeth]: [u32; 2], damaged: &[DamagedTooth]) -> Result<(), ScenarioError> {
    for (key, teeth) in [("gears.pinion_teeth", pinion_teeth), ("gears.gear_teeth", gear_teeth)] {
        if teeth == 0 {
            return Err(ScenarioError::new(key, teeth, "must be at least 1"));
        }
    }
    let beyond = |of: &DamagedTooth| {
        let teeth = match of.wheel {
            WheelName::Pinion => pinion_teeth,
            WheelName::Gear => gear_teeth,
        };
        of.teeth.iter().copied().find(|&tooth| tooth >= teeth as usize).map(|tooth| (of.wheel, tooth))
    };
    match damaged.iter().find_map(beyond) {
        None => Ok(()),
        Some((wheel, tooth)) => {
            let problem = format!("is beyond the last tooth of the {}", wheel.name());
            Err(ScenarioError::new("fault.tooth", tooth + 1, problem))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_is_met_as_often_as_counted() {
        use crate::damage::damaged_teeth;

        use crate::scenario::{Fault, Gears, MissingTooth};
        use crate::wheel::{WheelName, teeth};

        for (z_p, z_g) in [(17, 38), (20, 45), (25, 30), (12, 36)] {
            let healthy = teeth(&Gears::new(3.0, z_p, z_g, 15.0), [10.0; 2]);
            let missing = |wheel, tooth: u32| Fault::new(wheel, tooth, MissingTooth);
            let faults =
                [missing(WheelName::Pinion, 1), missing(WheelName::Gear, 1), missing(WheelName::Gear, 6)];
            let damaged = damaged_teeth(&faults, &healthy, 1).unwrap();
            let sequence = PairSequence::new(z_p, z_g, &damaged).unwrap();
            let mut counts = vec![0; sequence.classes().len()];
            for pair in 0..sequence.cycle() {
                counts[sequence.class(pair as i64)] += 1;
            }
            let stated: Vec<usize> = sequence.classes().iter().map(|kind| kind.pairs_per_cycle).collect();
            assert_eq!(counts, stated, "{z_p}/{z_g}");
            let error = PairSequence::new(z_p, 5, &damaged).unwrap_err();
            assert_eq!(error.to_string(), "fault.tooth = 6: is beyond the last tooth of the gear");
        }
    }
}
