//! How the wheels of planetary sets stand and turn.

use std::f64::consts::TAU;

use super::layout::{Layout, Ratio, entry_key, unique};
use super::planetary::{FIXED, Member, PlanetarySet};
use super::turning::member_ratios;
use super::{Scenario, WheelName};
use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::machine::Bearing;
use crate::operation::least_common_multiple;
use crate::wheel::{Gears, Hand, Mounting, Wheel};

/// How a planetary set stands and turns. Its wheels turn about axes that the carrier holds: their ratios in [`Layout::ratios`] are against the carrier.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SetLayout {
    /// Number of its sun among the wheels; the planets follow, and then the ring.
    pub first_wheel: usize,
    /// Number of the mesh of the sun with the first planet; those with the others follow, and then those of all planets with the ring.
    pub first_mesh: usize,
    /// (rad) Where each planet stands on the carrier at the start, from x towards y.
    pub angles_rad: Vec<f64>,
    /// Rotation of sun, carrier and ring over that of the input; 0 of a fixed one.
    pub ratios: [Ratio; 3],
    /// Whether the sun drives its planets, seen from the carrier; otherwise they drive it, and the ring drives them.
    pub sun_drives: bool,
    /// (mm) Distance of the planets' axes from that of the set.
    pub centre_distance_mm: f64,
}

impl SetLayout {
    /// Rotation of the sun against the carrier over that of the input.
    pub fn sun_against_carrier(&self) -> Ratio {
        let [sun, carrier, _] = self.ratios;
        sun.plus(carrier.times(-1, 1))
    }

    /// Number of planets.
    pub fn planets(&self) -> usize {
        self.angles_rad.len()
    }

    /// The sense in which the sun turns against the carrier, and the meshes of each planet.
    fn meshes(&self) -> impl Iterator<Item = (f64, [usize; 2])> {
        let (first, planets) = (self.first_mesh, self.planets());
        // The first planet is where the others count from.
        let turned = |angle: &f64| angle - self.angles_rad[0];
        self.angles_rad
            .iter()
            .map(turned)
            .enumerate()
            .map(move |(planet, angle)| (angle, [first + planet, first + planets + planet]))
    }

    /// (base pitches) Positions of the first pairs of all its meshes at the start.
    ///
    /// A tooth of the sun is at a planet at the angle ψ `z_s ψ/2π` pitches later than at the first one, in the sense in which the sun turns, and
    /// a tooth of the ring, which turns the other way, `z_r ψ/2π` earlier. A planet passes its tooth from the sun to the ring as any wheel between two
    /// others does: half a revolution and a tooth thickness lie between. Where the planets drive the sun everything goes the other way.
    ///
    /// # Arguments
    /// * `layout` - with the gears of its meshes
    /// * `phases` - of all meshes
    pub(super) fn phases(&self, layout: &Layout, phases: &mut [Option<f64>]) {
        let sense = self.sun_against_carrier().value().signum();
        for (angle, [of_sun, of_ring]) in self.meshes() {
            let gears = &layout.gears[of_ring];
            let [sun_teeth, planet_teeth] = [self.sun_teeth(layout), gears.pinion_teeth].map(f64::from);
            let planet_at_sun = if self.sun_drives { WheelName::Gear } else { WheelName::Pinion };
            let thickness = layout.thickness([(of_sun, planet_at_sun), (of_ring, WheelName::Pinion)]);
            let passed = thickness - planet_teeth / 2.0;
            let passed = if self.sun_drives { passed } else { -passed };
            let at_sun = -sense * sun_teeth * angle / TAU;
            let at_ring = at_sun + passed + layout.pitch_point(of_ring) - layout.pitch_point(of_sun);
            for (mesh, phase) in [(of_sun, at_sun), (of_ring, at_ring)] {
                // After so many pairs the same two teeth meet again: positions start from 0 on.
                let Gears { pinion_teeth, gear_teeth, .. } = layout.gears[mesh];
                phases[mesh] =
                    Some(phase.rem_euclid(f64::from(least_common_multiple(pinion_teeth, gear_teeth))));
            }
        }
    }

    /// Numbers of the ring's teeth in the first pair of its mesh with each planet: it turns past them by `(z_s + z_r) ψ/2π` teeth.
    fn first_ring_teeth(&self, layout: &Layout) -> Vec<(usize, usize)> {
        let sense = self.sun_against_carrier().value().signum();
        let of_planet = |(angle, [_, of_ring]): (f64, [usize; 2])| {
            let ring_teeth = layout.gears[of_ring].gear_teeth;
            let turned = sense * f64::from(self.sun_teeth(layout) + ring_teeth) * angle / TAU;
            (of_ring, turned.round().rem_euclid(f64::from(ring_teeth)) as usize)
        };
        self.meshes().map(of_planet).collect()
    }

    fn sun_teeth(&self, layout: &Layout) -> u32 {
        let Gears { pinion_teeth, gear_teeth, .. } = layout.gears[self.first_mesh];
        if self.sun_drives { pinion_teeth } else { gear_teeth }
    }
}

impl Member {
    /// The name of its key.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Planet(_) => "planet",
            Self::Ring => "ring",
        }
    }
}

/// (rev/s) Speed of a carrier above which the forces of the turning frame, which are left out, move natural frequencies by more than 1 %.
const FAST_CARRIER_HZ: f64 = 10.0;

impl Layout {
    /// Adds the wheels and meshes of the planetary sets.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is
    /// * `sun_drives` - of each set
    ///
    /// # Errors
    /// Teeth that do not fit one another or the planets' places, planets that run into one another.
    pub(super) fn add_sets(&mut self, scenario: &Scenario, sun_drives: &[bool]) -> Result<(), ScenarioError> {
        let sets = scenario.planetary();
        unique("planetary", &sets.iter().map(|set| set.name.as_str()).collect::<Vec<_>>())?;
        let shaft_ratios = self.ratios.clone();
        for (number, (set, &sun_drives)) in sets.iter().zip(sun_drives).enumerate() {
            let ratios = member_ratios(scenario, set, &shaft_ratios);
            self.add_set(scenario, set, ratios, sun_drives)
                .map_err(|error| error.in_entry("planetary", number, sets.len()))?;
        }
        Ok(())
    }

    /// Adds one set: its axes, and the pairs of wheels of its meshes, with the wheel that drives first.
    fn add_set(
        &mut self,
        scenario: &Scenario,
        set: &PlanetarySet,
        ratios: [Ratio; 3],
        sun_drives: bool,
    ) -> Result<(), ScenarioError> {
        let angles_rad = set.planet_angles_rad();
        let mut of_set = SetLayout {
            first_wheel: self.shaft_of_wheel.len(),
            first_mesh: self.gears.len(),
            centre_distance_mm: 0.0,
            angles_rad,
            ratios,
            sun_drives,
        };
        let planets = of_set.planets();
        for mesh in of_set.first_mesh..of_set.first_mesh + 2 * planets {
            let stated = &scenario.meshes[mesh];
            let [first, second] = self.wheels_of_mesh[mesh].map(|wheel| &scenario.wheels[wheel]);
            let mut gears = stated.gears(first, second, scenario.material);
            if stated.is_internal {
                gears.ring_drives = !sun_drives;
            } else if !sun_drives {
                gears = gears.exchanged();
                gears.hand = Hand::Right;
                self.wheels_of_mesh[mesh].reverse();
            }
            self.gears.push(gears);
        }
        let [of_sun, of_ring] = [of_set.first_mesh, of_set.first_mesh + planets]
            .map(|mesh| Mounting::new(&self.gears[mesh]).centre_distance_mm);
        if (of_sun - of_ring).abs() > super::layout::CENTRE_TOLERANCE_MM {
            let problem = format!(
                "the planets would stand {of_sun:.4} mm from the axis by the sun's teeth and {of_ring:.4} mm by the ring's; must be the same within \
                 {} mm, as with z_r = z_s + 2 z_p without profile shifts",
                super::layout::CENTRE_TOLERANCE_MM
            );
            return Err(ScenarioError::new("planetary.teeth", "", problem)
                .with_help("change a tooth count, or give profile_shift of sun, planet and ring"));
        }
        of_set.centre_distance_mm = of_sun;
        // A planet has one tip in both its meshes, which the sun's may have set off.
        let tip_alteration = self.gears[of_set.first_mesh].tip_alteration();
        for mesh in of_set.first_mesh..of_set.first_mesh + 2 * planets {
            if self.gears[mesh].internal {
                self.gears[mesh].pinion_addendum += tip_alteration;
                if of_sun != of_ring {
                    self.gears[mesh].centre_distance_mm = Some(of_sun);
                }
            }
            self.named(&self.gears[mesh], scenario, mesh).check()?;
        }
        self.check_planets(set, &of_set)?;
        let shaft = set.shafts().into_iter().flatten().find_map(|name| scenario.shaft_number(name));
        let axis_m = shaft.map_or_else(Default::default, |shaft| self.positions_m[shaft]);
        let sun = of_set.sun_against_carrier();
        let [of_sun, of_planet, of_ring] = [set.teeth.sun, set.teeth.planet, set.teeth.ring].map(i64::from);
        let arm_m = of_set.centre_distance_mm * 1e-3;
        for wheel in scenario.wheels.iter().skip(of_set.first_wheel).take(planets + 2) {
            let (ratio, [x, y], bore_mm) = match wheel.of_set.map(|of| of.member) {
                Some(Member::Planet(planet)) => {
                    let (sin, cos) = of_set.angles_rad[planet].sin_cos();
                    let place = [arm_m * cos, arm_m * sin];
                    (sun.times(-of_sun, of_planet), place, set.module_mm * of_planet as f64 * BORE)
                }
                Some(Member::Ring) => {
                    let root_mm =
                        set.module_mm * (of_ring as f64 / 2.0 + wheel.dedendum + wheel.profile_shift);
                    (sun.times(-of_sun, of_ring), [0.0; 2], root_mm + set.rim_thickness_mm())
                }
                _ => (sun, [0.0; 2], set.module_mm * of_sun as f64 * BORE),
            };
            self.shaft_of_wheel.push(self.ratios.len());
            self.ratios.push(ratio);
            self.shaft_names.push(wheel.name.clone());
            self.positions_m.push([axis_m[0] + x, axis_m[1] + y]);
            self.bore_radii_mm.push(bore_mm);
        }
        for (mesh, tooth) in of_set.first_ring_teeth(self) {
            self.first_teeth[mesh] = tooth;
        }
        self.sets.push(of_set);
        Ok(())
    }

    /// Planets stand where teeth fit, and clear of one another.
    fn check_planets(&self, set: &PlanetarySet, of_set: &SetLayout) -> Result<(), ScenarioError> {
        let count = of_set.planets();
        let lists = [
            ("planet_angles_deg", set.planet_angles_deg.len(), set.planets as usize),
            ("pin.error_um", set.pin.error_um.len(), count),
        ];
        if let Some((key, given, planets)) = lists.into_iter().find(|of| of.1 != 0 && of.1 != of.2) {
            let problem = format!("has {given} entries; must have one for each of the {planets} planets");
            return Err(ScenarioError::new(format!("planetary.{key}"), "", problem)
                .with_help("add or remove entries, or change planets"));
        }
        let key = if set.planet_angles_deg.is_empty() {
            "planetary.planets"
        } else {
            "planetary.planet_angles_deg"
        };
        let teeth = f64::from(set.teeth.sun + set.teeth.ring);
        for (planet, angle) in of_set.angles_rad.iter().enumerate() {
            let places = teeth * (angle - of_set.angles_rad[0]) / TAU;
            if (places - places.round()).abs() > FITS {
                let fits_deg = of_set.angles_rad[0].to_degrees() + 360.0 * places.round() / teeth;
                let problem = format!(
                    "planet {} would stand at {:.4}°, where its teeth do not fit between sun and ring: (z_s + z_r) ψ/360° is {places:.4}, and must \
                     be whole",
                    planet + 1,
                    angle.to_degrees()
                );
                return Err(ScenarioError::new(key, "", problem)
                    .with_help(format!("{fits_deg:.6}° is the nearest place that fits; give planet_angles_deg, or other tooth counts")));
            }
        }
        // Only the planet's own teeth count, which are the same in both meshes.
        let tip_mm = Wheel::new(&self.gears[of_set.first_mesh + count], WheelName::Pinion, 0.0).tip_radius_mm;
        for (planet, angle) in of_set.angles_rad.iter().enumerate() {
            for (other, before) in of_set.angles_rad[..planet].iter().enumerate() {
                let apart_mm = 2.0 * of_set.centre_distance_mm * ((angle - before) / 2.0).sin().abs();
                if apart_mm <= 2.0 * tip_mm {
                    let problem = format!(
                        "planets {} and {} run into one another: their axes are {apart_mm:.3} mm apart, and their tip diameter is {:.3} mm",
                        other + 1,
                        planet + 1,
                        2.0 * tip_mm
                    );
                    return Err(ScenarioError::new(key, "", problem)
                        .with_help("use fewer planets, or place them farther apart"));
                }
            }
        }
        Ok(())
    }

    /// Number of the set and of the planet whose axis this is.
    ///
    /// # Arguments
    /// * `axis` - its number among the shafts
    pub fn planet_on_axis(&self, axis: usize) -> Option<[usize; 2]> {
        let first_axis = |set: &SetLayout| self.shaft_of_wheel[set.first_wheel + 1];
        let has = |set: &&SetLayout| (first_axis(set)..first_axis(set) + set.planets()).contains(&axis);
        let number = self.sets.iter().position(|set| has(&set))?;
        Some([number, axis - first_axis(&self.sets[number])])
    }

    /// Whether a wheel is a ring with internal teeth.
    ///
    /// # Arguments
    /// * `wheel` - its number
    pub fn is_ring(&self, wheel: usize) -> bool {
        self.sets.iter().any(|set| wheel == set.first_wheel + set.planets() + 1)
    }

    /// What is doubtful about the planetary sets.
    pub(super) fn warnings_of_sets(&self, scenario: &Scenario, fastest_hz: f64) -> Vec<ScenarioWarning> {
        let sets = self.sets.iter().enumerate().filter_map(|(number, of)| {
            let carrier_hz = of.ratios[1].value().abs() * fastest_hz;
            (carrier_hz > FAST_CARRIER_HZ).then(|| {
                let key = entry_key("planetary", number, scenario.planetary().len(), "carrier");
                let message = format!(
                    "the carrier turns at {carrier_hz:.1} rev/s; the Coriolis and centripetal forces of its frame, which are left out, move natural \
                     frequencies by more than 1 % above {FAST_CARRIER_HZ} rev/s"
                );
                ScenarioWarning::new(WarningKind::TurningFrame, key, message)
            })
        });
        sets.collect()
    }
}

/// (-) Radius of the bores of sun and planets as a part of their pitch diameter.
const BORE: f64 = 0.25;

/// (-) Part of a tooth by which a planet's place may miss one where teeth fit: angles are rounded on drawings.
const FITS: f64 = 1e-3;

impl Scenario {
    /// Numbers of the shafts that turn about one axis, of each planetary set.
    pub(super) fn shafts_on_one_axis(&self) -> Vec<Vec<usize>> {
        let number = |name: &str| self.shaft_number(name);
        let of_set = |set: &PlanetarySet| set.shafts().into_iter().flatten().filter_map(number).collect();
        self.planetary().iter().map(of_set).collect()
    }

    /// Planetary sets carry a torque one way only.
    pub(super) fn check_sets(&self) -> Result<(), ScenarioError> {
        for (index, set) in self.planetary().iter().enumerate() {
            if set.din_grade != 0 && set.iso_class != 0 {
                let key = entry_key("planetary", index, self.planetary().len(), "iso_class");
                let problem = "given beside din_grade; deviations have only one source";
                return Err(
                    ScenarioError::new(key, set.iso_class, problem).with_help("remove one of the two")
                );
            }
            if set.name == FIXED {
                let key = entry_key("planetary", index, self.planetary().len(), "name");
                return Err(ScenarioError::new(key, format!("{FIXED:?}"), "says that a member stands still"));
            }
        }
        let of_planets = |bearing: &Bearing| self.axis_of_planet(&bearing.shaft);
        for (index, bearing) in self.bearings().iter().enumerate() {
            let Some(axis) = of_planets(bearing) else { continue };
            let refused = |key: &str, value: &str, problem: &str, help: &str| {
                let key = entry_key("bearing", index, self.bearings().len(), key);
                Err(ScenarioError::new(key, format!("{value:?}"), problem).with_help(help))
            };
            if bearing.element().is_none() {
                let problem = "a planet's bearing without balls or rollers is its pin's stiffness";
                return refused(
                    "kind",
                    "linear",
                    problem,
                    "set planetary.pin.stiffness_n_per_m, or another kind",
                );
            }
            let usual = Bearing::new(&bearing.shaft, bearing.at);
            let without_effect = [
                ("seat", bearing.seat != usual.seat),
                ("damping_ratio", bearing.damping_ratio != usual.damping_ratio),
                ("axial_stiffness_n_per_m", bearing.axial_stiffness_n_per_m.is_some()),
                (
                    "tilt_stiffness_nm_per_rad",
                    bearing.tilt_stiffness_nm_per_rad != usual.tilt_stiffness_nm_per_rad,
                ),
            ];
            if let Some((key, _)) = without_effect.into_iter().find(|(_, is_given)| *is_given) {
                let problem = "has no effect on the bearing of a planet, which sits on its pin";
                let help = "remove it; planetary.support_damping_ratio is the damping of pins";
                return refused(key, &bearing.shaft, problem, help);
            }
            if self.bearings()[..index].iter().any(|before| of_planets(before) == Some(axis)) {
                let problem = "is a planet that has a bearing already; rows of elements count as one";
                return refused("shaft", &bearing.shaft, problem, "remove one of the two");
            }
        }
        if !self.planetary().is_empty() && self.operation.overruns() {
            let problem = "must not be negative with planetary sets";
            return Err(ScenarioError::new(
                "operation.brake_torque_nm",
                self.operation.brake_torque_nm,
                problem,
            )
            .with_help("let the motor drive: couple it to the other end of the train"));
        }
        Ok(())
    }
}
