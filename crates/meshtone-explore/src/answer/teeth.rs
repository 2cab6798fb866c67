//! The teeth of both wheels in their plane, and where they touch.

use meshtone::damage::{DamagedTooth, ToothPart};
use meshtone::wheel::{ToothProfile, Wheel, WheelName};
use meshtone::{MeshedPair, Stages};
use serde_json::{Value, json};

use crate::packet::Packet;

/// Most points of a flank that is drawn.
const MOST_POINTS: usize = 96;

/// The teeth of both wheels, as they stand where pair 0 enters contact.
///
/// The pinion's centre is the origin, the gear's lies on the x axis. The pinion turns counter-clockwise by a pitch while the gear turns
/// clockwise by one; a tooth's own plane has x along its centre line from the wheel's centre and y towards the working flank, which is
/// counter-clockwise of the centre line on both wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct TeethInPlane {
    /// (mm) Distance of the centres.
    pub centre_distance_mm: f64,
    /// (mm) Where a pair touches first.
    pub path_start_mm: [f64; 2],
    /// (mm) How far a pair's contact moves in a pitch.
    pub path_per_pitch_mm: [f64; 2],
    /// (pitches) How long it is in contact.
    pub contact_ratio: f64,
    /// (pitches) From where to where a pair is in contact anywhere on its face, since its middle could enter contact.
    pub contact_span_pitches: [f64; 2],
    /// Pinion and gear.
    pub wheels: [WheelInPlane; 2],
}

/// A wheel in its plane.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelInPlane {
    /// The wheel.
    pub wheel: Wheel,
    /// (rad) Direction of its tooth 1's centre line, counter-clockwise from the x axis.
    pub first_tooth_rad: f64,
    /// (mm) The sound flank, from root to tip: along the centre line and across.
    pub flank_mm: [Vec<f64>; 2],
    /// The damaged teeth, those that are alike together.
    pub damaged: Vec<DamagedInPlane>,
}

/// Damaged teeth in their plane.
#[derive(Debug, Clone, PartialEq)]
pub struct DamagedInPlane {
    /// Their numbers, from 1.
    pub numbers: Vec<usize>,
    /// (mm) Across the tooth: the flank where it is cut furthest back, at the sound flank's points.
    pub flank_y_mm: Vec<f64>,
    /// (mm) Along the centre line: where the tooth ends.
    pub end_x_mm: f64,
    /// (mm) Along the centre line: where a chip begins that leaves a part of the face.
    pub chip_x_mm: Option<f64>,
    /// (mm) The crack's start and tip.
    pub crack_mm: Option<[[f64; 2]; 2]>,
}

impl TeethInPlane {
    /// The teeth of a simulation.
    ///
    /// # Arguments
    /// * `stages` - what is simulated
    pub fn new(stages: &Stages) -> Self {
        let MeshedPair { teeth, damaged, .. } = &stages.pairs[0];
        let path = &teeth.path;
        let angle_rad = teeth.pinion.working_pressure_angle_rad;
        let centre_distance_mm = teeth.pinion.working_pitch_radius_mm + teeth.gear.working_pitch_radius_mm;
        let along = [angle_rad.sin(), angle_rad.cos()];
        // From where the line of action touches the pinion's base circle.
        let foot_mm = [angle_rad.cos(), -angle_rad.sin()].map(|part| part * teeth.pinion.base_radius_mm);
        let curvature_mm = path.curvature_mm(WheelName::Pinion, 0.0);
        let path_start_mm = [0, 1].map(|axis| foot_mm[axis] + curvature_mm * along[axis]);
        let wheel = |name: WheelName| {
            let centre_x_mm = if name == WheelName::Pinion { 0.0 } else { centre_distance_mm };
            let (x_mm, y_mm) = (path_start_mm[0] - centre_x_mm, path_start_mm[1]);
            let wheel = *teeth.wheel(name);
            let half_rad = wheel.half_thickness_angle_at_rad(x_mm.hypot(y_mm));
            let profile = teeth.profile(name);
            let points = drawn_points(profile.len());
            let damaged = damaged.iter().filter(|tooth| tooth.wheel == name);
            let place = |point_mm: [f64; 2]| teeth.transverse_point_mm(name, point_mm);
            let mut in_plane = WheelInPlane {
                wheel,
                first_tooth_rad: y_mm.atan2(x_mm) - half_rad,
                flank_mm: [&profile.x_mm, &profile.y_mm].map(|values| at(values, &points)),
                damaged: damaged.map(|tooth| DamagedInPlane::new(tooth, profile, &points)).collect(),
            };
            in_plane.place(&place);
            in_plane
        };
        Self {
            centre_distance_mm,
            path_start_mm,
            path_per_pitch_mm: along.map(|part| part * path.base_pitch_mm),
            contact_ratio: path.contact_ratio,
            contact_span_pitches: teeth.contact_span_pitches(),
            wheels: WheelName::BOTH.map(wheel),
        }
    }

    /// As JSON, with its arrays in a packet.
    pub fn json(&self, packet: &mut Packet) -> Value {
        json!({
            "centre_distance_mm": self.centre_distance_mm,
            "path_start_mm": self.path_start_mm,
            "path_per_pitch_mm": self.path_per_pitch_mm,
            "contact_ratio": self.contact_ratio,
            "contact_span_pitches": self.contact_span_pitches,
            "wheels": self.wheels.each_ref().map(|wheel| wheel.json(packet)),
        })
    }
}

impl WheelInPlane {
    /// Moves all points from the section in which the teeth are computed to the one that is drawn.
    fn place(&mut self, place: &dyn Fn([f64; 2]) -> [f64; 2]) {
        let along = |x_mm: f64| place([x_mm, 0.0])[0];
        let [x_mm, y_mm] = &mut self.flank_mm;
        x_mm.iter_mut().zip(y_mm).for_each(|(x, y)| [*x, *y] = place([*x, *y]));
        for tooth in &mut self.damaged {
            tooth.flank_y_mm.iter_mut().for_each(|y| *y = place([0.0, *y])[1]);
            tooth.end_x_mm = along(tooth.end_x_mm);
            tooth.chip_x_mm = tooth.chip_x_mm.map(along);
            tooth.crack_mm = tooth.crack_mm.map(|ends| ends.map(place));
        }
    }

    fn json(&self, packet: &mut Packet) -> Value {
        let [x_mm, y_mm] = self.flank_mm.each_ref().map(|values| packet.array(values.iter().copied()));
        let damaged: Vec<Value> = self.damaged.iter().map(|tooth| tooth.json(packet)).collect();
        let wheel = &self.wheel;
        json!({
            "teeth": wheel.teeth,
            "tip_radius_mm": wheel.tip_radius_mm,
            "root_radius_mm": wheel.root_radius_mm,
            "base_radius_mm": wheel.base_radius_mm,
            "pitch_radius_mm": wheel.working_pitch_radius_mm,
            "bore_radius_mm": wheel.bore_radius_mm,
            "first_tooth_rad": self.first_tooth_rad,
            "flank_x_mm": x_mm,
            "flank_y_mm": y_mm,
            "damaged": damaged,
        })
    }
}

impl DamagedInPlane {
    fn new(tooth: &DamagedTooth, profile: &ToothProfile, points: &[usize]) -> Self {
        let last = profile.len() - 1;
        let x_mm = |index: usize| profile.x_mm[index.min(last)];
        let chip =
            tooth.descriptions.iter().find(|damage| damage.part == ToothPart::Tip && damage.is_partial);
        let crack_mm = tooth.crack.map(|crack| {
            let (tip_x_mm, tip_y_mm) = crack.tip_mm();
            [[crack.start_x_mm, crack.start_y_mm], [tip_x_mm, tip_y_mm]]
        });
        Self {
            numbers: tooth.teeth.iter().map(|index| index + 1).collect(),
            flank_y_mm: at(&tooth.outline_y_mm(), points),
            end_x_mm: x_mm(tooth.gone_from_index),
            chip_x_mm: chip.map(|chip| x_mm(chip.range[0])),
            crack_mm,
        }
    }

    fn json(&self, packet: &mut Packet) -> Value {
        json!({
            "numbers": self.numbers,
            "flank_y_mm": packet.array(self.flank_y_mm.iter().copied()),
            "end_x_mm": self.end_x_mm,
            "chip_x_mm": self.chip_x_mm,
            "crack_mm": self.crack_mm,
        })
    }
}

/// Indices of the points that are drawn, the first and the last among them.
fn drawn_points(points: usize) -> Vec<usize> {
    let (last, drawn) = (points.saturating_sub(1), points.clamp(2, MOST_POINTS));
    (0..drawn).map(|k| k * last / (drawn - 1)).collect()
}

fn at(values: &[f64], points: &[usize]) -> Vec<f64> {
    points.iter().map(|&index| values[index]).collect()
}

#[cfg(test)]
mod tests {
    use meshtone::scenario::Scenario;

    use super::*;
    use crate::presets;

    /// The flanks of both wheels touch where the path says, at its start as at the pitch point.
    #[test]
    fn flanks_touch_on_the_path() {
        for name in ["healthy", "profile_shift", "tooth_destruction"] {
            let preset = presets().into_iter().find(|preset| preset.name == name).unwrap();
            let mut scenario = Scenario::from_toml(preset.toml).unwrap();
            scenario.faults.clear();
            let plane = TeethInPlane::new(&meshtone::stages(&scenario).unwrap());
            for position in [0.0, 0.4, 0.9, plane.contact_ratio] {
                let touch =
                    [0, 1].map(|axis| plane.path_start_mm[axis] + position * plane.path_per_pitch_mm[axis]);
                for (sign, centre_x_mm, wheel) in
                    [(1.0, 0.0, &plane.wheels[0]), (-1.0, plane.centre_distance_mm, &plane.wheels[1])]
                {
                    let turned = sign * position * std::f64::consts::TAU / f64::from(wheel.wheel.teeth);
                    let (x, y) = (touch[0] - centre_x_mm, touch[1]);
                    let half_rad = wheel.wheel.half_thickness_angle_at_rad(x.hypot(y));
                    let off = y.atan2(x) - (wheel.first_tooth_rad + turned + half_rad);
                    let off = off - (off / std::f64::consts::TAU).round() * std::f64::consts::TAU;
                    assert!(off.abs() < 1e-9, "{name}, at {position} of the path: {off} rad");
                }
            }
        }
    }

    #[test]
    fn few_points_are_drawn_and_the_ends_among_them() {
        assert_eq!(drawn_points(3), [0, 1, 2]);
        let many = drawn_points(1000);
        assert_eq!((many[0], many[many.len() - 1], many.len()), (0, 999, MOST_POINTS));
    }
}
