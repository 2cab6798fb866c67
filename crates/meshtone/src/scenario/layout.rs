//! How the shafts, wheels and meshes stand and turn: what their names refer to, centres, speed ratios, phases.

use std::f64::consts::TAU;

use super::planetary::OfSet;
use super::planetary_layout::SetLayout;
use super::turning::Turning;
use super::{Scenario, ScenarioMesh, ScenarioWheel, Shafts};
use crate::damage::{Fault, FaultFlank};
use crate::error::{ScenarioError, ScenarioWarning};
use crate::machine::{Coupled, Rig};
use crate::wheel::{
    ERROR_POINTS, ErrorTable, Gears, Hand, Mounting, NamedGears, NamedWheel, PathOfContact, ProfileErrors,
    Quality, Wheel, WheelName,
};

/// A ratio of two whole numbers, reduced; its sign is the numerator's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ratio {
    /// Numerator.
    pub numerator: i64,
    /// Denominator, more than 0.
    pub denominator: i64,
}

impl Ratio {
    /// The ratio of something to itself.
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// The product with another ratio; one that would not fit is the largest that does.
    ///
    /// # Arguments
    /// * `numerator`, `denominator` - of the other ratio
    ///
    /// ```
    /// use meshtone::scenario::Ratio;
    ///
    /// assert_eq!(Ratio::ONE.times(-32, 96), Ratio { numerator: -1, denominator: 3 });
    /// ```
    #[must_use]
    pub fn times(self, numerator: i64, denominator: i64) -> Self {
        let [n, d] = [(self.numerator, numerator), (self.denominator, denominator)]
            .map(|(own, other)| i128::from(own) * i128::from(other));
        Self::reduced(n, d)
    }

    /// The largest ratio of which this one and another are whole multiples.
    ///
    /// # Arguments
    /// * `other` - the other one
    ///
    /// ```
    /// use meshtone::scenario::Ratio;
    ///
    /// let [third, fifth] = [3, 5].map(|q| Ratio::ONE.times(1, q));
    /// assert_eq!(third.common_measure(fifth), Ratio { numerator: 1, denominator: 15 });
    /// ```
    #[must_use]
    pub fn common_measure(self, other: Self) -> Self {
        let [(p, q), (r, s)] =
            [self, other].map(|ratio| (i128::from(ratio.numerator), i128::from(ratio.denominator)));
        Self::reduced(greatest_common_divisor(p * s, r * q), q * s)
    }

    /// A whole number.
    pub(super) fn whole(number: i64) -> Self {
        Self { numerator: number, denominator: 1 }
    }

    /// The sum with another ratio; one that would not fit is the largest that does.
    pub(super) fn plus(self, other: Self) -> Self {
        let [(p, q), (r, s)] =
            [self, other].map(|ratio| (i128::from(ratio.numerator), i128::from(ratio.denominator)));
        Self::reduced((p * s).saturating_add(r * q), q * s)
    }

    /// The ratio over another one, which is not 0.
    pub(super) fn over(self, other: Self) -> Self {
        self.times(other.denominator, other.numerator)
    }

    pub(super) fn is_zero(self) -> bool {
        self.numerator == 0
    }

    fn reduced(n: i128, d: i128) -> Self {
        let divisor = greatest_common_divisor(n, d).max(1);
        let sign = if d < 0 { -1 } else { 1 };
        // A train of wheels of 10 000 teeth would need five stages to pass the largest number.
        let fits = |value: i128| i64::try_from(value).unwrap_or(i64::MAX);
        Self { numerator: fits(sign * n / divisor), denominator: fits(d.abs() / divisor) }
    }

    /// Whether it is what it was computed to be, and not the largest that fits in its place.
    pub(super) fn is_exact(self) -> bool {
        self.numerator.unsigned_abs().max(self.denominator.unsigned_abs()) < i64::MAX.unsigned_abs()
    }

    /// As a number.
    pub fn value(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}/{}", self.numerator, self.denominator)
    }
}

fn greatest_common_divisor(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The part of a revolution of the input of which the revolutions of all shafts are whole multiples.
fn cycle(ratios: &[Ratio]) -> Ratio {
    ratios.iter().copied().fold(Ratio::ONE, Ratio::common_measure)
}

/// How the parts of a machine stand and turn, by their numbers, names resolved. A rig has no bearings here.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Layout {
    /// Number of the shaft of each wheel.
    pub shaft_of_wheel: Vec<usize>,
    /// (mm) Radius of each wheel's bore, that of its shaft there.
    pub bore_radii_mm: Vec<f64>,
    /// Name of each shaft; of a rig those of its wheels.
    pub shaft_names: Vec<String>,
    /// Number of the shaft that the motor is coupled to.
    pub input: usize,
    /// Name of each mesh; none of a rig's, which has only one.
    pub mesh_names: Vec<Option<String>>,
    /// Numbers of the driving and of the driven wheel of each mesh.
    pub wheels_of_mesh: Vec<[usize; 2]>,
    /// Number of the shaft of each bearing.
    pub shaft_of_bearing: Vec<usize>,
    /// The pair of wheels of each mesh, as of a scenario of one pair.
    pub gears: Vec<Gears>,
    /// (m) x and y of each shaft's axis.
    pub positions_m: Vec<[f64; 2]>,
    /// Rotation of each shaft over that of the input: positive about z.
    pub ratios: Vec<Ratio>,
    /// (base pitches) Position of the first pair of each mesh at the start.
    pub phases: Vec<f64>,
    /// Number of the tooth of each mesh's driven wheel in the first pair: not 0 where a ring meets several planets.
    pub first_teeth: Vec<usize>,
    /// The planetary sets.
    pub sets: Vec<SetLayout>,
}

/// (mm) By how much shafts may stand nearer or farther than the centre distance of their mesh.
pub(super) const CENTRE_TOLERANCE_MM: f64 = 0.01;

impl Layout {
    /// Resolves the names of shafts of beams and finds how everything stands and turns.
    ///
    /// # Arguments
    /// * `scenario`, `shafts` - whose keys are each in their range, and its structure
    ///
    /// # Errors
    /// A name that nothing has or that two have, shafts that stand wrong, a train that cannot turn, wheels that do not fit one another.
    pub(super) fn of_shafts(scenario: &Scenario, of: &Shafts) -> Result<Self, ScenarioError> {
        let shafts: Vec<&str> = of.shafts.iter().map(|shaft| shaft.name.as_str()).collect();
        let wheels: Vec<&str> = scenario.wheels.iter().map(|wheel| wheel.name.as_str()).collect();
        let own_wheels = scenario.own_wheels();
        unique("shaft", &shafts)?;
        unique("wheel", &wheels[..own_wheels])?;
        let shaft_of = |list: &str, index: usize, entries: usize, name: &str| {
            find(&shafts, name, "shaft")
                .map_err(|error| error.with_key(entry_key(list, index, entries, "shaft")))
        };
        let shaft_of_wheel: Vec<usize> = (scenario.wheels.iter().take(own_wheels).enumerate())
            .map(|(index, wheel)| shaft_of("wheel", index, own_wheels, &wheel.shaft))
            .collect::<Result<_, _>>()?;
        let shaft_of_bearing: Vec<usize> = (scenario.bearings().iter().enumerate())
            .map(|(index, bearing)| match scenario.axis_of_planet(&bearing.shaft) {
                Some(axis) => Ok(axis),
                None => shaft_of("bearing", index, scenario.bearings().len(), &bearing.shaft),
            })
            .collect::<Result<_, _>>()?;
        let meshes = scenario.own_meshes();
        let wheels_of_mesh: Vec<[usize; 2]> = (scenario.meshes.iter().enumerate())
            .map(|(index, mesh)| {
                let number = |side: usize| {
                    let key = entry_key("mesh", index, meshes, &format!("wheels[{side}]"));
                    let known = if mesh.is_of_set { &wheels[..] } else { &wheels[..own_wheels] };
                    find(known, &mesh.wheels[side], "wheel").map_err(|error| error.with_key(key))
                };
                Ok([number(0)?, number(1)?])
            })
            .collect::<Result<_, ScenarioError>>()?;
        let bore_radius_mm =
            |(wheel, &shaft): (&ScenarioWheel, &usize)| scenario.shafts()[shaft].radius_at_mm(wheel.at);
        let mut this = Self {
            bore_radii_mm: scenario.wheels.iter().zip(&shaft_of_wheel).map(bore_radius_mm).collect(),
            shaft_names: shafts.iter().map(|&name| name.to_owned()).collect(),
            input: 0,
            mesh_names: scenario.meshes.iter().map(|mesh| Some(mesh.name())).collect(),
            gears: Vec::new(),
            positions_m: Vec::new(),
            ratios: Vec::new(),
            phases: Vec::new(),
            first_teeth: vec![0; scenario.meshes.len()],
            sets: Vec::new(),
            shaft_of_wheel,
            wheels_of_mesh,
            shaft_of_bearing,
        };
        for (index, mesh) in scenario.meshes.iter().take(meshes).enumerate() {
            let gears = this.gears_of(scenario, index, mesh)?;
            this.named(&gears, scenario, index).check()?;
            this.gears.push(gears);
        }
        this.check_helices(scenario)?;
        let [motor, brake] = this.ends(scenario)?;
        this.input = motor;
        let Turning { ratios, sun_drives } = this.turn(scenario, [motor, brake])?;
        this.ratios = ratios;
        this.positions_m = this.place(scenario)?;
        this.check_room(scenario)?;
        this.add_sets(scenario, &sun_drives)?;
        this.check_cycle(scenario)?;
        this.phases = this.find_phases(scenario);
        Ok(this)
    }

    /// A pair in a rig: the pinion on the first shaft, and the gear beside it on the second.
    ///
    /// # Arguments
    /// * `scenario`, `rig` - what is simulated, and its structure
    pub(super) fn of_rig(scenario: &Scenario, rig: &Rig) -> Self {
        let gears = scenario.gears();
        let centre_distance_m = Mounting::new(&gears).centre_distance_mm * 1e-3;
        Self {
            shaft_of_wheel: vec![0, 1],
            bore_radii_mm: vec![rig.pinion_shaft.radius_mm, rig.gear_shaft.radius_mm],
            shaft_names: WheelName::BOTH.map(String::from).to_vec(),
            input: 0,
            mesh_names: vec![None],
            wheels_of_mesh: vec![[0, 1]],
            shaft_of_bearing: Vec::new(),
            positions_m: vec![[0.0; 2], [centre_distance_m, 0.0]],
            ratios: vec![
                Ratio::ONE,
                Ratio::ONE.times(-i64::from(gears.pinion_teeth), i64::from(gears.gear_teeth)),
            ],
            phases: vec![scenario.meshes.first().and_then(|mesh| mesh.phase).unwrap_or(0.0)],
            first_teeth: vec![0],
            sets: Vec::new(),
            gears: vec![gears],
        }
    }

    /// The same machine where the brake drives: the second wheel of each mesh pushes the first one, by the other flanks.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is
    pub(crate) fn overrun(&self, scenario: &Scenario) -> Self {
        let mut this = self.clone();
        this.wheels_of_mesh.iter_mut().for_each(|wheels| wheels.reverse());
        this.gears = std::mem::take(&mut this.gears).into_iter().map(Gears::exchanged).collect();
        this.phases = this.find_phases(scenario);
        this
    }

    /// A wheel in several meshes has one helix.
    fn check_helices(&self, scenario: &Scenario) -> Result<(), ScenarioError> {
        // (°) Positive of a right-hand helix.
        let helix = |(mesh, side): (usize, WheelName)| {
            let gears = &self.gears[mesh];
            side.choose(1.0, -1.0) * gears.hand.sign() * gears.helix_angle_deg
        };
        for (wheel, of_file) in scenario.wheels.iter().take(scenario.own_wheels()).enumerate() {
            let mut meshes = self.meshes_of(wheel);
            let Some(first) = meshes.next() else { continue };
            let Some(other) = meshes.find(|mesh| helix(*mesh) != helix(first)) else { continue };
            let of_mesh = &scenario.meshes[other.0];
            let (key, value) = if helix(first).abs() == helix(other).abs() {
                ("hand", if of_mesh.hand == Hand::Right { "\"right\"" } else { "\"left\"" }.to_owned())
            } else {
                ("helix_angle_deg", format!("{:?}", of_mesh.helix_angle_deg))
            };
            let problem = format!(
                "wheel {:?} would have another helix than in mesh {}; hand is that of the driving wheel, and its mate has the opposite one",
                of_file.name,
                scenario.meshes[first.0].name()
            );
            return Err(ScenarioError::new(
                entry_key("mesh", other.0, scenario.meshes.len(), key),
                value,
                problem,
            )
            .with_help(
                "give both meshes the same helix_angle_deg, and the hands by which the wheel has one",
            ));
        }
        Ok(())
    }

    /// The shaft of the motor, and the one of the brake.
    fn ends(&self, scenario: &Scenario) -> Result<[usize; 2], ScenarioError> {
        let end = |coupled: Coupled, name: &str| {
            let ends: Vec<usize> = (0..scenario.shafts().len())
                .filter(|&n| scenario.shafts()[n].couples_to == coupled)
                .collect();
            match ends[..] {
                [end] => Ok(end),
                [] => Err(ScenarioError::new(
                    "shaft.couples_to",
                    "",
                    format!("no shaft couples to the {name}; one must"),
                )
                .with_help(format!("write couples_to = \"{name}\" in one [[shaft]]"))),
                [_, second, ..] => {
                    let key = entry_key("shaft", second, scenario.shafts().len(), "couples_to");
                    let problem = format!("is the second shaft that couples to the {name}; one must");
                    Err(ScenarioError::new(key, format!("\"{name}\""), problem)
                        .with_help("remove couples_to from all shafts but one"))
                }
            }
        };
        Ok([end(Coupled::Motor, "motor")?, end(Coupled::Brake, "brake")?])
    }

    /// All teeth meet again after a number of revolutions that can be counted.
    fn check_cycle(&self, scenario: &Scenario) -> Result<(), ScenarioError> {
        if cycle(&self.ratios).is_exact() {
            return Ok(());
        }
        let problem =
            "is one of a train whose teeth all meet again only after more revolutions than are counted";
        let (key, value) = match scenario.own_meshes() {
            0 => (entry_key("planetary", 0, scenario.planetary().len(), "teeth"), String::new()),
            meshes => (entry_key("mesh", 0, meshes, "wheels"), format!("{:?}", scenario.meshes[0].wheels)),
        };
        Err(ScenarioError::new(key, value, problem)
            .with_help("choose fewer stages, or tooth counts with common factors"))
    }

    /// (m) Where the shafts stand: as given, or beside the shaft that they mesh with.
    fn place(&self, scenario: &Scenario) -> Result<Vec<[f64; 2]>, ScenarioError> {
        let mut places: Vec<Option<[f64; 2]>> =
            scenario.shafts().iter().map(|shaft| shaft.position_mm).collect();
        if places.iter().all(Option::is_none) {
            let motor = scenario.shafts().iter().position(|shaft| shaft.couples_to == Coupled::Motor);
            places[motor.unwrap_or(0)] = Some([0.0; 2]);
        }
        let distances_mm: Vec<f64> =
            self.gears.iter().map(|gears| Mounting::new(gears).centre_distance_mm).collect();
        let shafts_of = |mesh: usize| self.wheels_of_mesh[mesh].map(|wheel| self.shaft_of_wheel[wheel]);
        let known_on_one_side = |mesh: usize, places: &[Option<[f64; 2]>]| {
            let [driving, driven] = shafts_of(mesh);
            places[driving].is_some() != places[driven].is_some()
        };
        let axes = scenario.shafts_on_one_axis();
        loop {
            // The members of a planetary set turn about one axis.
            for of_set in &axes {
                let known = of_set.iter().find_map(|&shaft| places[shaft]);
                of_set.iter().for_each(|&shaft| places[shaft] = places[shaft].or(known));
            }
            let next = (0..distances_mm.len()).find(|&mesh| known_on_one_side(mesh, &places));
            let Some(mesh) = next else { break };
            let [driving, driven] = shafts_of(mesh);
            if let Some([x, y]) = places[driving] {
                places[driven] = Some([x + distances_mm[mesh], y]);
            } else if let Some([x, y]) = places[driven] {
                places[driving] = Some([x - distances_mm[mesh], y]);
            }
        }
        let places: Vec<[f64; 2]> = places.into_iter().map(Option::unwrap_or_default).collect();
        for of_set in &axes {
            let first = places[of_set[0]];
            let apart = |&&shaft: &&usize| {
                (places[shaft][0] - first[0]).hypot(places[shaft][1] - first[1]) > CENTRE_TOLERANCE_MM
            };
            if let Some(&shaft) = of_set.iter().find(apart) {
                let key = entry_key("shaft", shaft, scenario.shafts().len(), "position_mm");
                let [x, y] = places[shaft];
                let problem = format!(
                    "is not on the axis of shaft {:?}, with which it is in a planetary set",
                    scenario.shafts()[of_set[0]].name
                );
                return Err(ScenarioError::new(key, format!("[{x:?}, {y:?}]"), problem)
                    .with_help("give both the same position_mm, or leave it out"));
            }
        }
        for (mesh, &distance_mm) in distances_mm.iter().enumerate() {
            let [driving, driven] = shafts_of(mesh);
            let [a, b] = [places[driving], places[driven]];
            let apart_mm = (a[0] - b[0]).hypot(a[1] - b[1]);
            if (apart_mm - distance_mm).abs() > CENTRE_TOLERANCE_MM {
                let shaft = if scenario.shafts()[driven].position_mm.is_some() { driven } else { driving };
                let key = entry_key("shaft", shaft, scenario.shafts().len(), "position_mm");
                let [x, y] = places[shaft];
                let mesh = scenario.meshes[mesh].name();
                let problem = format!(
                    "is {apart_mm:.4} mm from the axis of its mating shaft, but the wheels of mesh {mesh} \
                     mesh at {distance_mm:.4} mm; must be the same within {CENTRE_TOLERANCE_MM} mm"
                );
                return Err(ScenarioError::new(key, format!("[{x:?}, {y:?}]"), problem).with_help(
                    "move the shaft, or give the mesh that centre_distance_mm or its wheels profile shifts",
                ));
            }
        }
        Ok(places.into_iter().map(|place| place.map(|mm| mm * 1e-3)).collect())
    }

    /// The two wheels of a mesh as a pair.
    fn gears_of(
        &self,
        scenario: &Scenario,
        index: usize,
        mesh: &ScenarioMesh,
    ) -> Result<Gears, ScenarioError> {
        let numbers = self.wheels_of_mesh[index];
        let [pinion, gear] = numbers.map(|number| &scenario.wheels[number]);
        let meshes = scenario.meshes.len();
        let refuse = |problem: String, help: &str| {
            let key = entry_key("mesh", index, meshes, "wheels");
            Err(ScenarioError::new(key, format!("{:?}", mesh.wheels), problem).with_help(help))
        };
        let shafts = numbers.map(|wheel| self.shaft_of_wheel[wheel]);
        if shafts[0] == shafts[1] {
            return refuse(
                format!("both wheels sit on shaft {:?}; must be two shafts", pinion.shaft),
                "name wheels of two shafts",
            );
        }
        let mut gears = mesh.gears(pinion, gear, scenario.material);
        let apart_mm = numbers.map(|wheel| self.z_mm(scenario, wheel));
        let apart_mm = (apart_mm[0] - apart_mm[1]).abs();
        if apart_mm > gears.face_width_mm / 2.0 {
            let problem = format!(
                "the wheels' middle planes are {apart_mm:.3} mm apart; must be at most half the narrower face, {:.3} mm",
                gears.face_width_mm / 2.0
            );
            return refuse(problem, "change at of one of the wheels");
        }
        let [from_mm, until_mm] = self.common_face_mm(scenario, numbers[0], numbers[1]);
        gears.face_width_mm = until_mm - from_mm;
        Ok(gears)
    }

    /// (mm) From a wheel's middle plane both ends of what its face has in common with that of another one.
    ///
    /// # Arguments
    /// * `wheel`, `other` - their numbers
    fn common_face_mm(&self, scenario: &Scenario, wheel: usize, other: usize) -> [f64; 2] {
        let apart_mm = self.z_mm(scenario, other) - self.z_mm(scenario, wheel);
        let [half_mm, other_mm] = [wheel, other].map(|wheel| scenario.wheels[wheel].face_width_mm / 2.0);
        [(-half_mm).max(apart_mm - other_mm), half_mm.min(apart_mm + other_mm)]
    }

    /// (m) How far from the middle plane of each wheel of a mesh the middle of what their faces have in common is, along z.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is, of shafts of beams
    /// * `mesh` - number of the mesh
    pub(crate) fn offsets_of_face_m(&self, scenario: &Scenario, mesh: usize) -> [f64; 2] {
        let [driving, driven] = self.wheels_of_mesh[mesh];
        [(driving, driven), (driven, driving)].map(|(wheel, other)| {
            let [from_mm, until_mm] = self.common_face_mm(scenario, wheel, other);
            (from_mm + until_mm) / 2.0 * 1e-3
        })
    }

    /// Number of the shafts that have speeds of their own; the axes of planetary sets come after them.
    pub fn own_shafts(&self) -> usize {
        self.shaft_names.len() - self.sets.iter().map(|set| set.planets() + 2).sum::<usize>()
    }

    /// (mm) z of a wheel's middle plane. A planetary set is where the ends of its shafts meet.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is, of shafts of beams
    /// * `wheel` - its number
    pub fn z_mm(&self, scenario: &Scenario, wheel: usize) -> f64 {
        if let Some(OfSet { set, .. }) = scenario.wheels[wheel].of_set {
            return scenario.z_of_set_mm(&scenario.planetary()[set]);
        }
        scenario.shafts()[self.shaft_of_wheel[wheel]].z_mm(scenario.wheels[wheel].at)
    }

    /// What is doubtful about the teeth of each mesh.
    pub(super) fn warnings_of_teeth(&self, scenario: &Scenario) -> Vec<ScenarioWarning> {
        let mut warnings: Vec<ScenarioWarning> =
            (0..self.gears.len()).flat_map(|mesh| self.named_gears(scenario, mesh).warnings()).collect();
        // A wheel in two meshes has the same teeth in both.
        warnings.sort_by(|a, b| a.key.cmp(&b.key));
        warnings.dedup_by(|a, b| a.key == b.key && a.kind == b.kind);
        warnings
    }

    /// A mesh's pair of wheels with their names.
    pub(crate) fn named_gears<'a>(&'a self, scenario: &'a Scenario, mesh: usize) -> NamedGears<'a> {
        self.named(&self.gears[mesh], scenario, mesh)
    }

    pub(super) fn named<'a>(&self, gears: &'a Gears, scenario: &'a Scenario, mesh: usize) -> NamedGears<'a> {
        let mut section_of_mesh = section("mesh", mesh, scenario.own_meshes());
        let wheels = self.wheels_of_mesh[mesh].map(|wheel| {
            let ScenarioWheel { name, of_set, .. } = &scenario.wheels[wheel];
            let Some(OfSet { set, member }) = of_set else {
                return NamedWheel { name, section: format!("wheel[{wheel}]"), member: None };
            };
            section_of_mesh = section("planetary", *set, scenario.planetary().len());
            NamedWheel { name, section: section_of_mesh.clone(), member: Some(member.name()) }
        });
        NamedGears::of_mesh(gears, section_of_mesh, wheels)
    }

    /// (-) Rotation of a mesh's driving wheel over that of the input; negative where it turns against the input.
    ///
    /// # Arguments
    /// * `mesh` - number of the mesh
    pub fn driving_ratio(&self, mesh: usize) -> f64 {
        self.ratios[self.shaft_of_wheel[self.wheels_of_mesh[mesh][0]]].value()
    }

    /// (-) Pairs of teeth that enter a mesh while the input turns once.
    ///
    /// # Arguments
    /// * `mesh` - number of the mesh
    pub fn pitches_per_revolution(&self, mesh: usize) -> f64 {
        f64::from(self.gears[mesh].pinion_teeth) * self.driving_ratio(mesh).abs()
    }

    /// The first mesh that a wheel is in, and on which side.
    pub fn mesh_of(&self, wheel: usize) -> Option<(usize, WheelName)> {
        self.meshes_of(wheel).next()
    }

    /// All meshes that a wheel is in, and on which side.
    pub fn meshes_of(&self, wheel: usize) -> impl Iterator<Item = (usize, WheelName)> {
        let sides = self.wheels_of_mesh.iter().enumerate();
        sides.filter_map(move |(mesh, wheels)| {
            let side = wheels.iter().position(|&of| of == wheel)?;
            Some((mesh, WheelName::BOTH[side]))
        })
    }

    /// (base pitches) Where the first pair of each mesh is: as given, or as the teeth of a wheel in two meshes make it.
    ///
    /// A tooth of such a wheel goes from the direction ψ_A of one mate to ψ_B of the other, `(ψ_B − ψ_A) z/2π` pitches in its sense of
    /// rotation. From the position at which it passes one pitch point that makes its position at the other. Where it is driven
    /// in one mesh and drives in the other, its flanks there are opposite ones, a tooth thickness apart.
    fn find_phases(&self, scenario: &Scenario) -> Vec<f64> {
        let mut phases: Vec<Option<f64>> = scenario.meshes.iter().map(|mesh| mesh.phase).collect();
        for mesh in 0..scenario.own_meshes() {
            if phases[mesh].is_some() {
                continue;
            }
            let before = (0..mesh).find_map(|other| {
                let shared = self.wheels_of_mesh[other]
                    .iter()
                    .find(|wheel| self.wheels_of_mesh[mesh].contains(wheel))?;
                Some((other, *shared))
            });
            let shifted = before
                .and_then(|(other, wheel)| Some(phases[other]? + self.shift_of_phase(wheel, other, mesh)));
            phases[mesh] = Some(shifted.unwrap_or(0.0));
        }
        self.sets.iter().for_each(|set| set.phases(self, &mut phases));
        phases.into_iter().map(Option::unwrap_or_default).collect()
    }

    /// (base pitches) How much further a pair of the same tooth of a wheel is in one mesh than in another.
    fn shift_of_phase(&self, wheel: usize, from: usize, to: usize) -> f64 {
        let shaft = self.shaft_of_wheel[wheel];
        let side = |mesh: usize| WheelName::BOTH[usize::from(self.wheels_of_mesh[mesh][1] == wheel)];
        let direction = |mesh: usize| {
            let mate = self.wheels_of_mesh[mesh][side(mesh).mate() as usize];
            let [a, b] = [self.positions_m[shaft], self.positions_m[self.shaft_of_wheel[mate]]];
            (b[1] - a[1]).atan2(b[0] - a[0])
        };
        let teeth = f64::from(self.gears[to].teeth(side(to)));
        let sense = self.ratios[shaft].value().signum();
        let travelled = (sense * (direction(to) - direction(from))).rem_euclid(TAU) / TAU * teeth;
        let thickness =
            if side(from) == side(to) { 0.0 } else { self.thickness([(from, side(from)), (to, side(to))]) };
        self.pitch_point(to) - self.pitch_point(from) - travelled + thickness
    }

    /// (base pitches) From where one flank of a tooth of a wheel passes the pitch point of one mesh to where the other flank passes that of
    /// another one: half the tooth's angle on the circle that rolls in either.
    pub(super) fn thickness(&self, meshes: [(usize, WheelName); 2]) -> f64 {
        let half = |(mesh, side): (usize, WheelName)| {
            let wheel = Wheel::new(&self.gears[mesh], side, 0.0);
            wheel.half_thickness_angle_at_rad(wheel.working_pitch_radius_mm) * f64::from(wheel.teeth) / TAU
        };
        meshes.map(half).iter().sum()
    }

    /// (base pitches) Position of the pitch point on the path of contact.
    pub(super) fn pitch_point(&self, mesh: usize) -> f64 {
        let gears = &self.gears[mesh];
        let [pinion, gear] = WheelName::BOTH.map(|side| Wheel::new(gears, side, 0.0));
        let path = PathOfContact::new(&pinion, &gear);
        let at = path.position(WheelName::Gear, gear.curvature_mm(gear.working_pitch_radius_mm));
        if gears.ring_drives { path.from_end(at) } else { at }
    }

    /// Revolutions of the input after which all shafts stand again as at the start.
    pub(super) fn cycle_of_shafts(&self) -> i64 {
        cycle(&self.ratios[..self.own_shafts()]).denominator
    }

    /// Revolutions of the input after which all teeth and shafts stand again as at the start.
    pub fn cycle_revolutions(&self) -> i64 {
        cycle(&self.ratios).denominator
    }

    /// The faults of a mesh's wheels as of a pair, each with its number in the scenario.
    ///
    /// # Arguments
    /// * `faults` - all of the scenario, each with the number of its wheel
    /// * `mesh` - number of the mesh
    pub fn faults_of_mesh(&self, faults: &[(usize, &Fault)], mesh: usize) -> Vec<(usize, Fault)> {
        let of_mesh = |(number, &(wheel, fault)): (usize, &(usize, &Fault))| {
            let side = WheelName::BOTH[self.wheels_of_mesh[mesh].iter().position(|of| *of == wheel)?];
            let is_elsewhere = match fault.flank {
                Some(FaultFlank::Sun) => self.gears[mesh].internal,
                Some(FaultFlank::Ring) => !self.gears[mesh].internal,
                Some(FaultFlank::Both) | None => false,
            };
            if is_elsewhere {
                return None;
            }
            let first_tooth = if side == WheelName::Gear { self.first_teeth[mesh] } else { 0 };
            let tooth = fault.tooth.counted_from(first_tooth, self.gears[mesh].teeth(side));
            Some((number, Fault { wheel: side.into(), tooth, ..fault.clone() }))
        };
        faults.iter().enumerate().filter_map(of_mesh).collect()
    }

    /// The quality of a mesh's wheels as of a pair, with the shares of the wheel that is drawn.
    ///
    /// # Arguments
    /// * `scenario` - whose layout this is
    /// * `mesh` - number of the mesh
    /// * `drawn` - the wheel whose deviations are drawn with it
    pub fn quality_of_mesh(&self, scenario: &Scenario, mesh: usize, drawn: WheelName) -> Quality {
        let [pinion, gear] = self.wheels_of_mesh[mesh].map(|wheel| &scenario.wheels[wheel]);
        let of = drawn.choose(pinion, gear);
        // The flanks on the other side of a wheel that is driven in its first mesh and drives in another are others.
        let works =
            self.mesh_of(self.wheels_of_mesh[mesh][drawn as usize]).is_some_and(|(_, side)| side == drawn);
        let of_side = |side: WheelName| match &of.profile_errors_mm {
            Some(errors) if side == drawn => errors.clone(),
            _ => ErrorTable::filled(ERROR_POINTS, self.gears[mesh].teeth(side) as usize, 0.0),
        };
        let given = of.profile_errors_mm.is_some() && works;
        Quality {
            profile_errors: given.then(|| ProfileErrors {
                pinion_profile_errors_mm: of_side(WheelName::Pinion),
                gear_profile_errors_mm: of_side(WheelName::Gear),
            }),
            din_grade: of.din_grade,
            iso_class: of.iso_class,
            tooth_share: of.tooth_share,
            pitch_share: of.pitch_share,
            run_out_share: of.run_out_share,
            slope_wobble: of.slope_wobble,
            helix_share: of.helix_share,
            pinion_deviations: pinion.deviations.clone(),
            gear_deviations: gear.deviations.clone(),
            ..Quality::default()
        }
    }
}

/// The section of an entry of a list: without a number where there is one entry only.
pub(super) fn section(list: &str, index: usize, entries: usize) -> String {
    if entries > 1 { format!("{list}[{index}]") } else { list.to_owned() }
}

/// The key of an entry of a list.
pub(crate) fn entry_key(list: &str, index: usize, entries: usize, key: &str) -> String {
    format!("{}.{key}", section(list, index, entries))
}

pub(super) fn unique(list: &str, names: &[&str]) -> Result<(), ScenarioError> {
    for (index, name) in names.iter().enumerate() {
        let key = entry_key(list, index, names.len(), "name");
        let valid =
            !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !valid {
            let problem = "must be letters without accents, digits and `_`";
            return Err(ScenarioError::new(key, format!("{name:?}"), problem));
        }
        if let Some(other) = names[..index].iter().position(|other| other == name) {
            let problem = format!("is the name of {list}[{other}] already; each must have its own");
            let error = ScenarioError::new(key, format!("{name:?}"), problem);
            return Err(error.with_help("give it another name"));
        }
    }
    Ok(())
}

/// The number of a name in a list.
pub(super) fn find(names: &[&str], name: &str, what: &str) -> Result<usize, ScenarioError> {
    names.iter().position(|other| *other == name).ok_or_else(|| {
        let known: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let problem = format!("is no {what}'s name; there are {}", known.join(", "));
        ScenarioError::new(what, format!("{name:?}"), problem)
    })
}
