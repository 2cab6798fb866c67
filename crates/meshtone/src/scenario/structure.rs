//! How the machine around the wheels is made, and what depends on it.

use super::to_toml::Plain;
use super::{Layout, MemoryLimit, PlanetarySet, Scenario, ScenarioError, ScenarioWheel};
use crate::damage::Fault;
use crate::machine::{Bearing, Coupled, GearboxShaft, Housing, Rig, RigParts};
use crate::operation::{TimeGrid, samples_per_pitch, samples_per_pitch_of_published};
use crate::random::{Draws, Purpose};
use crate::sensor::{Sensor, SensorDirection, SensorPlace};
use crate::wheel::{Gears, NamedGears, WheelName};

/// How the machine around the wheels is made.
#[derive(Debug, Clone, PartialEq)]
pub enum Structure {
    /// A pinion and a gear on condensed shafts, in supports that move.
    Rig(Rig),
    /// Any number of shafts of beams in bearings.
    Shafts(Shafts),
}

/// Shafts of beams in bearings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shafts {
    /// The shafts.
    pub shafts: Vec<GearboxShaft>,
    /// The bearings.
    pub bearings: Vec<Bearing>,
    /// The housing; none where the bearings' seats stand on the ground.
    pub housing: Option<Housing>,
    /// The planetary sets.
    pub planetary: Vec<PlanetarySet>,
}

/// What a structure is called, and where its keys stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Words {
    /// Key of the nominal speed.
    pub speed_key: &'static str,
    /// What the motor drives: `the pinion`, `the input`.
    pub driven: &'static str,
    /// What it is, one and several: a pair of wheels, gearboxes.
    pub nouns: [&'static str; 2],
    /// Key of the seed of the wheels' deviations.
    pub wheels_seed_key: &'static str,
    /// What is said of a motion that grows.
    pub against_growth: &'static str,
}

impl Scenario {
    /// The rig that the wheels run in; none of shafts of beams.
    pub fn rig(&self) -> Option<&Rig> {
        match &self.structure {
            Structure::Rig(rig) => Some(rig),
            Structure::Shafts(_) => None,
        }
    }

    /// The rig, to be changed.
    pub fn rig_mut(&mut self) -> Option<&mut Rig> {
        match &mut self.structure {
            Structure::Rig(rig) => Some(rig),
            Structure::Shafts(_) => None,
        }
    }

    /// The shafts of beams; none of a rig, whose shafts are condensed.
    pub fn shafts(&self) -> &[GearboxShaft] {
        self.structure.shafts().map_or(&[], |of| &of.shafts)
    }

    /// The bearings of shafts of beams; none of a rig, in whose shafts they are condensed.
    pub fn bearings(&self) -> &[Bearing] {
        self.structure.shafts().map_or(&[], |of| &of.bearings)
    }

    /// The housing of shafts of beams, if they have one.
    pub fn housing(&self) -> Option<&Housing> {
        self.structure.shafts()?.housing.as_ref()
    }

    /// The housing of shafts of beams, to be changed, if they have one.
    pub fn housing_mut(&mut self) -> Option<&mut Housing> {
        self.structure.shafts_mut()?.housing.as_mut()
    }

    /// The bearings of shafts of beams, to be changed.
    pub fn bearings_mut(&mut self) -> &mut [Bearing] {
        self.structure.shafts_mut().map_or(&mut [], |of| &mut of.bearings)
    }

    /// The scenario, where it is of one pair in a rig.
    ///
    /// # Errors
    /// Shafts of beams.
    pub fn expect_pair(&self) -> Result<&Self, ScenarioError> {
        if self.rig().is_some() { Ok(self) } else { Err(refused_as_pair()) }
    }

    /// Number of the shaft that the motor turns: of a rig that of the pinion.
    pub fn input_shaft(&self) -> usize {
        self.shafts().iter().position(|shaft| shaft.couples_to == Coupled::Motor).unwrap_or(0)
    }

    /// The parts of the rig; none of shafts of beams.
    ///
    /// # Arguments
    /// * `gears` - of its mesh
    pub(crate) fn rig_parts<'a>(&'a self, gears: &'a Gears) -> Option<RigParts<'a>> {
        let [pinion, gear] = &self.wheels[..] else { return None };
        Some(RigParts {
            gears,
            rig: self.rig()?,
            inertias: [&pinion.inertia, &gear.inertia],
            unbalances: [&pinion.unbalance, &gear.unbalance],
            brake_inertia_kgm2: self.operation.brake_inertia_kgm2,
            overruns: self.operation.overruns(),
        })
    }

    /// How the shafts, wheels and meshes stand and turn.
    ///
    /// # Errors
    /// A name that nothing has or that two have, shafts that stand wrong, a train that cannot turn, wheels that do not fit one another.
    pub fn layout(&self) -> Result<Layout, ScenarioError> {
        match &self.structure {
            Structure::Rig(rig) => Ok(Layout::of_rig(self, rig)),
            Structure::Shafts(shafts) => Layout::of_shafts(self, shafts),
        }
    }

    /// Division of time: sampling, length, what is discarded.
    pub fn time_grid(&self) -> TimeGrid {
        let (rate_hz, speed_hz) = (self.solver.sampling_rate_hz, self.operation.pinion_speed_hz);
        match (&self.structure, &self.wheels[..]) {
            (Structure::Rig(_), [pinion, gear, ..]) => {
                let teeth = [pinion.teeth, gear.teeth];
                let samples_per_pitch = if self.model.has_meshes() {
                    samples_per_pitch(rate_hz, pinion.teeth, speed_hz)
                } else {
                    samples_per_pitch_of_published(rate_hz, teeth, speed_hz)
                };
                TimeGrid::new(teeth, &self.operation, &self.solver, samples_per_pitch)
            }
            _ => TimeGrid::of_input(&self.operation, &self.solver),
        }
    }

    /// Most memory that is allowed, and all values: see [`Self::validate`].
    pub(super) fn check_structure(
        &self,
        limit: MemoryLimit,
    ) -> Result<Vec<super::ScenarioWarning>, ScenarioError> {
        match &self.structure {
            Structure::Rig(rig) => self.check_rig(rig, limit),
            Structure::Shafts(shafts) => self.check_shafts(shafts, limit),
        }
    }

    /// The scenario file, defaults explicitly. It needs no other file.
    ///
    /// A valid scenario is read back exactly by [`Scenario::from_toml`]. A seed above `i64::MAX` is
    /// read back by it too, but not by other TOML readers.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario, gearbox_template};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// let text = scenario.to_toml();
    /// assert!(text.starts_with("model = \"contact\"\nseed = 1\n"));
    /// assert_eq!(Scenario::from_toml(&text)?, scenario);
    ///
    /// let gearbox = Scenario::from_toml(&gearbox_template(None))?;
    /// assert_eq!(gearbox.meshes[0].name(), "z1-z2");
    /// assert_eq!(Scenario::from_toml(&gearbox.to_toml())?, gearbox);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        match &self.structure {
            Structure::Rig(_) => self.in_sections(&Plain),
            Structure::Shafts(shafts) => self.in_long_sections(shafts, &Plain),
        }
    }

    /// What messages call the structure's keys.
    pub fn words(&self) -> Words {
        match &self.structure {
            Structure::Rig(_) => Words {
                speed_key: "operation.pinion_speed_hz",
                driven: "the pinion",
                nouns: ["pair of wheels", "pairs of wheels"],
                wheels_seed_key: "quality.seed",
                against_growth: "raise the damping ratios of [rig], use more teeth, or change operation.pinion_speed_hz",
            },
            Structure::Shafts(_) => Words {
                speed_key: "operation.input_speed_hz",
                driven: "the input",
                nouns: ["gearbox", "gearboxes"],
                wheels_seed_key: "wheels_seed",
                against_growth: "raise bearing.damping_ratio or mesh.damping_ratio, use more teeth, or change operation.input_speed_hz",
            },
        }
    }

    /// Seed of the deviations of a wheel: the two of a rig have one seed, each of others has its own, whatever meshes it is in.
    ///
    /// # Arguments
    /// * `wheel` - number of the wheel
    pub(crate) fn seed_of_wheel(&self, wheel: usize) -> u64 {
        let seed = self.wheels_seed.unwrap_or(self.seed);
        match self.structure {
            Structure::Rig(_) => seed,
            Structure::Shafts(_) => Draws::new(seed, Purpose::GearboxWheel, wheel as u64).bits(),
        }
    }

    /// A key of how well a wheel is made: `quality.din_grade`, `wheel[0].din_grade`.
    ///
    /// # Arguments
    /// * `wheel` - number of the wheel
    /// * `key` - without its section
    pub fn key_of_quality(&self, wheel: usize, key: &str) -> String {
        match self.structure {
            Structure::Rig(_) => format!("quality.{key}"),
            Structure::Shafts(_) => super::layout::entry_key("wheel", wheel, self.wheels.len(), key),
        }
    }

    /// What a shaft is coupled to.
    ///
    /// # Arguments
    /// * `name` - its name; of a rig that of its wheel
    pub fn coupled(&self, name: &str) -> Coupled {
        match &self.structure {
            Structure::Rig(_) if name == WheelName::Pinion.name() => Coupled::Motor,
            Structure::Rig(_) => Coupled::Brake,
            Structure::Shafts(of) => {
                let shaft = of.shafts.iter().find(|shaft| shaft.name == name);
                shaft.map_or(Coupled::Nothing, |shaft| shaft.couples_to)
            }
        }
    }

    /// A shaft in words: `the gear's shaft`, `shaft output`.
    ///
    /// # Arguments
    /// * `name` - its name
    pub fn shaft_in_words(&self, name: &str) -> String {
        match self.structure {
            Structure::Rig(_) => format!("the {name}'s shaft"),
            Structure::Shafts(_) => format!("shaft {name}"),
        }
    }

    /// A wheel in words: `the gear`, `z1`.
    ///
    /// # Arguments
    /// * `name` - its name
    pub fn wheel_in_words(&self, name: &str) -> String {
        match self.structure {
            Structure::Rig(_) => format!("the {name}"),
            Structure::Shafts(_) => name.to_owned(),
        }
    }

    /// Makes a shaft thicker by a factor, all of it.
    ///
    /// # Arguments
    /// * `shaft` - its number
    /// * `times` - (-) by how much
    ///
    /// # Returns
    /// The key of its radius.
    pub(crate) fn scale_shaft_radius(&mut self, shaft: usize, times: f64) -> String {
        match &mut self.structure {
            Structure::Rig(rig) => {
                let (of, name) = match shaft {
                    0 => (&mut rig.pinion_shaft, "pinion"),
                    _ => (&mut rig.gear_shaft, "gear"),
                };
                of.radius_mm *= times;
                format!("rig.{name}_shaft.radius_mm")
            }
            Structure::Shafts(of) => {
                let count = of.shafts.len();
                let of = &mut of.shafts[shaft];
                of.radius_mm = of.radius_mm.map(|radius_mm| radius_mm * times);
                of.segments.iter_mut().for_each(|[_, radius_mm]| *radius_mm *= times);
                let key = if of.segments.is_empty() { "radius_mm" } else { "segments" };
                super::layout::entry_key("shaft", shaft, count, key)
            }
        }
    }

    /// Sensors at the places where one may sit whose place is not known: the supports of a rig, the bearings' seats of shafts of beams.
    pub fn sensor_places(&self) -> Vec<Sensor> {
        let at_support = |at| Sensor { at, ..Sensor::default() };
        match &self.structure {
            Structure::Rig(_) => {
                [SensorPlace::GearSupport, SensorPlace::PinionSupport].map(at_support).to_vec()
            }
            Structure::Shafts(of) => of.bearings.iter().map(|of| Sensor::at_place(&of.seat_name())).collect(),
        }
    }

    /// The geometry of the first mesh's wheels. That of every mesh is in [`Layout::gears`].
    pub fn gears(&self) -> Gears {
        let wheel = |name: &String| self.wheels.iter().find(|wheel| wheel.name == *name);
        let of_mesh = |mesh: &super::ScenarioMesh| {
            let [pinion, gear] = &mesh.wheels;
            Some(mesh.gears(wheel(pinion)?, wheel(gear)?, self.material))
        };
        // Only a scenario that is not valid has none.
        self.meshes.first().and_then(of_mesh).unwrap_or_else(|| Gears::new(f64::NAN, 0, 0, f64::NAN))
    }

    /// The wheels of a mesh with what messages call them.
    ///
    /// # Arguments
    /// * `layout` - of this scenario
    /// * `mesh` - number of the mesh
    pub(crate) fn named_gears<'a>(&'a self, layout: &'a Layout, mesh: usize) -> NamedGears<'a> {
        match layout.mesh_names[mesh] {
            None => NamedGears::of_pair(&layout.gears[mesh]),
            Some(_) => layout.named_gears(self, mesh),
        }
    }

    /// The sensors: the listed ones, or among shafts of beams without any a radial one on top of every fixed ring and a vertical one on every
    /// bearing's seat.
    pub fn all_sensors(&self) -> Vec<Sensor> {
        if !self.sensors.is_empty() {
            return self.sensors.clone();
        }
        let rings = self.planetary().iter().filter(|set| set.shafts()[2].is_none());
        let on_rings = rings.map(|set| Sensor {
            direction: SensorDirection::Radial,
            ..Sensor::at_place(&format!("ring:{}:90", set.name))
        });
        let on_seats = self.bearings_of_shafts().map(|bearing| Sensor::at_place(&bearing.seat_name()));
        on_rings.chain(on_seats).collect()
    }

    /// Whether all deviations of some wheel are none.
    pub fn has_ideal_wheels(&self) -> bool {
        let is_ideal = |wheel: &ScenarioWheel| {
            wheel.din_grade == 0 && wheel.iso_class == 0 && wheel.profile_errors_mm.is_none()
        };
        self.wheels.iter().any(is_ideal)
    }

    /// The channel of the first of [`Self::all_sensors`].
    pub fn leading_channel(&self) -> String {
        self.all_sensors().first().map(Sensor::channel).unwrap_or_default()
    }

    /// States the natural frequency up to which modes of shafts of beams are stepped, which otherwise follows the rate.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) the rate at which it stays
    pub(crate) fn keep_highest_mode(&mut self, sampling_rate_hz: f64) {
        self.solver.highest_mode_hz = Some(self.solver.highest_mode_hz(sampling_rate_hz));
    }

    /// Puts the sensor of a channel before the others, since a recording is compared with the first one.
    ///
    /// # Arguments
    /// * `channel` - name of the channel, with its unit or without
    ///
    /// Returns whether another sensor is the first one now. A channel that no listed sensor has changes nothing.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario, Sensor};
    ///
    /// let named = ["foot", "cover", "flange"].map(|name| {
    ///     let mut sensor = Sensor::default();
    ///     sensor.name = Some(name.to_owned());
    ///     sensor
    /// });
    /// let mut scenario = Scenario::new(GearPair::example()).with_sensors(named.to_vec());
    /// assert!(scenario.lead_with_sensor("cover_g") && !scenario.lead_with_sensor("cover") && !scenario.lead_with_sensor("wall"));
    /// let names: Vec<String> = scenario.sensors.iter().map(|sensor| sensor.name()).collect();
    /// assert_eq!(names, ["cover", "foot", "flange"]);
    /// ```
    pub fn lead_with_sensor(&mut self, channel: &str) -> bool {
        let is = |name: String| channel == name || channel.strip_suffix("_g") == Some(&name);
        let Some(at) = self.sensors.iter().position(|sensor| is(sensor.name())) else { return false };
        self.sensors[..=at].rotate_right(1);
        at > 0
    }

    /// Names of the wheels, in their order: of a pair `pinion` and `gear`.
    pub fn wheel_names(&self) -> Vec<&str> {
        self.wheels.iter().map(|wheel| wheel.name.as_str()).collect()
    }

    /// The faults, each with the number of its wheel.
    pub fn placed_faults(&self) -> Vec<(usize, &Fault)> {
        let number = |fault: &Fault| self.wheels.iter().position(|of| of.name == fault.wheel);
        self.faults.iter().filter_map(|fault| Some((number(fault)?, fault))).collect()
    }
}

impl Structure {
    pub(crate) fn shafts(&self) -> Option<&Shafts> {
        match self {
            Self::Rig(_) => None,
            Self::Shafts(shafts) => Some(shafts),
        }
    }

    /// The shafts of beams, to be changed; none of a rig.
    pub fn shafts_mut(&mut self) -> Option<&mut Shafts> {
        match self {
            Self::Rig(_) => None,
            Self::Shafts(shafts) => Some(shafts),
        }
    }
}

/// The error of shafts of beams where one pair in a rig is expected.
pub(super) fn refused_as_pair() -> ScenarioError {
    let problem = "is of a gearbox, and one pair of gears, [gears], is expected here";
    ScenarioError::new("mesh", "", problem)
        .with_help("give a scenario with [gears]; the models published and linear, and `meshtone wheels`, accept one pair only")
}
