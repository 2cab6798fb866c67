//! Pits on a flank: which part of the face they take at each height, and how much of the flank.

use super::FlankPit;
use super::damaged_tooth::HealthyTooth;
use crate::wheel::FlankPoint;

/// All pits of a flank, of one damage or of several.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankPits {
    /// The pits.
    pub pits: Vec<FlankPit>,
    /// (mm) Length of the flank up to each point of the profile, from the root side's end of its contact part.
    pub along_mm: Vec<f64>,
    /// (mm) The sound flank's height at the profile's points.
    pub y_mm: Vec<f64>,
    /// (-) Cosine of the angle between the flank's normal and the normal of the tooth's centre line, at the profile's points.
    pub normal_cos: Vec<f64>,
    /// (mm) Face width.
    pub face_width_mm: f64,
}

/// Steps in which a pitted area is added up along the flank.
const STEPS: usize = 4000;

impl FlankPits {
    /// A flank without any.
    pub(super) fn none(healthy: &HealthyTooth) -> Self {
        let (profile, flank) = (healthy.profile(), healthy.flank());
        let mut length = 0.0;
        let mut along_mm = vec![0.0];
        for i in 1..profile.len() {
            length += (profile.x_mm[i] - profile.x_mm[i - 1]).hypot(profile.y_mm[i] - profile.y_mm[i - 1]);
            along_mm.push(length);
        }
        let start = along_mm[healthy.first_contact().min(along_mm.len() - 1)];
        along_mm.iter_mut().for_each(|along| *along -= start);
        let normal_cos = |i: usize| flank.at_curvature(flank.curvature_mm(i)).load_cos;
        Self {
            pits: Vec::new(),
            along_mm,
            y_mm: profile.y_mm.clone(),
            normal_cos: (0..profile.len()).map(normal_cos).collect(),
            face_width_mm: healthy.wheel().face_width_mm,
        }
    }

    /// (mm) Parts of the face that are gone at a point of the flank, from the face's middle: apart and rising.
    pub(crate) fn gone_at(&self, point: &FlankPoint) -> Vec<[f64; 2]> {
        self.gone(point.of(&self.along_mm))
    }

    /// (mm) Parts of the face that are gone at a length along the flank: the pits' chords united.
    fn gone(&self, along_mm: f64) -> Vec<[f64; 2]> {
        let half = self.face_width_mm / 2.0;
        united(self.pits.iter().filter_map(|pit| pit.chord_mm(along_mm)).collect(), half)
    }

    /// (mm) Height that the deepest pit takes from the section at a profile point.
    pub(super) fn lost_mm(&self, index: usize) -> f64 {
        self.columns(index).into_iter().map(|(_, lost_mm)| lost_mm).fold(0.0, f64::max)
    }

    /// (mm) Columns of the face that are hollow at a profile point, from the face's middle: where each begins and ends, and the
    /// height that the section loses there. They do not overlap.
    pub(super) fn columns(&self, index: usize) -> Vec<([f64; 2], f64)> {
        let half = self.face_width_mm / 2.0;
        let chord = |pit: &FlankPit| {
            let [from, to] = pit.chord_mm(self.along_mm[index])?.map(|z| z.clamp(-half, half));
            (to > from).then_some(([from, to], pit.depth_mm / self.normal_cos[index]))
        };
        let chords: Vec<([f64; 2], f64)> = self.pits.iter().filter_map(chord).collect();
        let mut edges: Vec<f64> = chords.iter().flat_map(|(chord, _)| *chord).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        let column = |edges: &[f64]| {
            let middle = (edges[0] + edges[1]) / 2.0;
            let over = chords.iter().filter(|(chord, _)| (chord[0]..chord[1]).contains(&middle));
            let depth_mm = over.map(|(_, depth)| *depth).fold(0.0, f64::max);
            (depth_mm > 0.0).then_some(([edges[0], edges[1]], depth_mm))
        };
        edges.windows(2).filter_map(column).collect()
    }

    /// (mm) Length of the flank's contact part.
    pub(super) fn length_mm(&self) -> f64 {
        self.along_mm.last().copied().unwrap_or(0.0)
    }

    /// (%) Part of the flank's contact part, over the whole face, that some pits take together.
    pub(super) fn area_percent(&self) -> f64 {
        let step = self.length_mm() / STEPS as f64;
        let area: f64 = (0..STEPS).map(|k| self.gone_width_mm((k as f64 + 0.5) * step) * step).sum();
        100.0 * area / (self.length_mm() * self.face_width_mm)
    }

    /// (mm) The least that is left of the face at any length along the flank's contact part.
    pub(super) fn least_left_mm(&self) -> f64 {
        let step = self.length_mm() / STEPS as f64;
        let left = |k: usize| self.face_width_mm - self.gone_width_mm(k as f64 * step);
        (0..=STEPS).map(left).fold(f64::INFINITY, f64::min)
    }

    /// (mm) Width of the face that is gone at a length along the flank.
    fn gone_width_mm(&self, along_mm: f64) -> f64 {
        self.gone(along_mm).iter().map(|[from, to]| to - from).sum()
    }
}

impl FlankPit {
    /// (mm) Where along the face the pit begins and ends at a length along the flank; none where it is not.
    pub(super) fn chord_mm(&self, along_mm: f64) -> Option<[f64; 2]> {
        let off = (along_mm - self.along_mm) / self.radius_mm;
        let half = self.face_radius_mm * (1.0 - off * off).max(0.0).sqrt();
        (half > 0.0).then_some([self.z_mm - half, self.z_mm + half])
    }
}

/// Intervals as those of their union, within ± `half`, rising.
pub(crate) fn united(mut intervals: Vec<[f64; 2]>, half: f64) -> Vec<[f64; 2]> {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut union: Vec<[f64; 2]> = Vec::with_capacity(intervals.len());
    for [from, to] in intervals {
        let (from, to) = (from.max(-half), to.min(half));
        match union.last_mut() {
            _ if from >= to => {}
            Some(last) if from <= last[1] => last[1] = last[1].max(to),
            _ => union.push([from, to]),
        }
    }
    union
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flank(pits: Vec<FlankPit>) -> FlankPits {
        FlankPits {
            pits,
            along_mm: vec![0.0, 8.0],
            y_mm: vec![3.0, 1.0],
            normal_cos: vec![1.0; 2],
            face_width_mm: 20.0,
        }
    }

    fn pit(along_mm: f64, z_mm: f64, radius_mm: f64) -> FlankPit {
        FlankPit { at: 0.0, along_mm, z_mm, radius_mm, face_radius_mm: radius_mm, depth_mm: 0.1 }
    }

    #[test]
    fn the_area_is_that_of_the_circles() {
        let area = |pits| flank(pits).area_percent() * 1.6;
        let circle = std::f64::consts::PI;
        assert!((area(vec![pit(4.0, 0.0, 1.0)]) / circle - 1.0).abs() < 1e-4);
        // Two apart, the same twice, and two that overlap by the lens of circles whose centres are a radius apart.
        assert!((area(vec![pit(4.0, 0.0, 1.0), pit(4.0, 5.0, 1.0)]) / (2.0 * circle) - 1.0).abs() < 1e-4);
        assert!((area(vec![pit(4.0, 0.0, 1.0), pit(4.0, 0.0, 1.0)]) / circle - 1.0).abs() < 1e-4);
        let lens = 2.0 * circle / 3.0 - 3f64.sqrt() / 2.0;
        let two = area(vec![pit(4.0, 0.0, 1.0), pit(4.0, 1.0, 1.0)]);
        assert!((two / (2.0 * circle - lens) - 1.0).abs() < 1e-4, "{two}");
        // Half beyond the face's end.
        assert!((area(vec![pit(4.0, 10.0, 1.0)]) / (circle / 2.0) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn chords_are_united_and_the_deeper_pit_counts() {
        let deep = FlankPit { depth_mm: 0.3, ..pit(4.0, 1.0, 1.0) };
        let both = FlankPits { along_mm: vec![4.0], ..flank(vec![pit(4.0, 0.0, 1.0), deep]) };
        assert_eq!(both.gone(4.0), [[-1.0, 2.0]]);
        assert_eq!(both.columns(0), [([-1.0, 0.0], 0.1), ([0.0, 1.0], 0.3), ([1.0, 2.0], 0.3)]);
        assert_eq!(both.gone(5.5), Vec::<[f64; 2]>::new());
        assert_eq!(united(vec![[3.0, 9.0], [-9.0, -2.0], [4.0, 5.0]], 7.0), [[-7.0, -2.0], [3.0, 7.0]]);
    }
}
