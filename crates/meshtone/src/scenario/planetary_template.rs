//! Commented gearboxes with planetary sets.

/// A laboratory set. Its ring has two teeth more than unshifted teeth would fit, so that profile shifts are needed.
pub(super) const LABORATORY: &str = "\
# A planetary set as laboratories have it: a sun of 31 teeth that the motor drives, three planets of 31
# on the carrier that the brake loads, and a fixed ring of 95.
# Assumed, and marked so: everything but the tooth counts. Teeth without profile shift would need a ring of 93;
# these shifts bring both meshes to one centre distance.

seed = 1
material = \"steel\"

# The sun's shaft. A set ties shafts by rotation alone; it is held across its axis by springs of its own.
[[shaft]]
name = \"input\"
length_mm = 120.0  # assumed
radius_mm = 10.0  # assumed
couples_to = \"motor\"

# The carrier's shaft, on the same axis behind the set.
[[shaft]]
name = \"output\"
start_mm = 180.0  # assumed
length_mm = 120.0  # assumed
radius_mm = 15.0  # assumed
couples_to = \"brake\"

[[planetary]]
name = \"p\"
sun = \"input\"
carrier = \"output\"
ring = \"fixed\"
teeth = { sun = 31, planet = 31, ring = 95 }
planets = 3
module_mm = 1.5  # assumed
face_width_mm = 20.0  # assumed
profile_shift = { sun = 0.32, planet = 0.32, ring = -0.0611 }  # assumed
iso_class = 5  # assumed
rim = { thickness_mm = 10.0 }  # assumed

# Stiffnesses of bearings, seats and couplings are at their defaults, which are assumed.
[[bearing]]
shaft = \"input\"
at = 0.0

[[bearing]]
shaft = \"input\"
at = 1.0

[[bearing]]
shaft = \"output\"
at = 0.0

[[bearing]]
shaft = \"output\"
at = 1.0

[operation]
input_speed_hz = 40.0  # assumed
brake_torque_nm = 100.0  # assumed
# The speed wanders slowly, as that of an induction motor does.
speed_wander_percent = 0.03  # assumed

# Faults name a wheel of the set: p.sun, p.planet1, p.ring. A planet works on both flanks; flank says which is damaged.
#
# [[fault]]
# wheel = \"p.planet1\"
# flank = \"sun\"
# kind = \"root-crack\"
# severity = 0.6

# On top of the ring, measured outwards. Planets pass it one after the other.
[[sensor]]
at = \"ring:p:90\"

# Every tooth of a planet has passed the sensor after 31 revolutions of the carrier, 3.2 s.
[solver]
sampling_rate_hz = 100_000.0
duration_s = 4.0
";

/// The gearbox of a wind turbine.
pub(super) const WIND_TURBINE: &str = "\
# The 750 kW gearbox of the NREL Gearbox Reliability Collaborative: a planetary set that the rotor turns by its carrier,
# and two stages of parallel shafts, 81.49 : 1 in all.
# Published: 21/39/99 teeth with three planets, 82/23 and 88/22 teeth, 22 revolutions a minute of the rotor.
# Assumed, and marked so: everything else. The real teeth are helical; these are spur.

seed = 1
material = \"steel\"

# The rotor's shaft is the carrier's.
[[shaft]]
name = \"rotor\"
length_mm = 600.0  # assumed
radius_mm = 200.0  # assumed
couples_to = \"motor\"
coupling_stiffness_nm_per_rad = 1e7  # assumed

# The sun's shaft, with the driving wheel of the second stage.
[[shaft]]
name = \"low\"
start_mm = 900.0  # assumed
length_mm = 700.0  # assumed
radius_mm = 130.0  # assumed

[[shaft]]
name = \"middle\"
start_mm = 900.0  # assumed
length_mm = 700.0  # assumed
# The length and the radius of its pieces.
segments = [[260.0, 125.0], [180.0, 72.0], [260.0, 125.0]]  # assumed

[[shaft]]
name = \"high\"
start_mm = 900.0  # assumed
length_mm = 280.0  # assumed
radius_mm = 45.0  # assumed
couples_to = \"brake\"
coupling_stiffness_nm_per_rad = 1e5  # assumed

[[planetary]]
name = \"p\"
sun = \"low\"
carrier = \"rotor\"
ring = \"fixed\"
teeth = { sun = 21, planet = 39, ring = 99 }
planets = 3
module_mm = 10.0  # assumed
face_width_mm = 230.0  # assumed
iso_class = 5  # assumed
pin = { stiffness_n_per_m = 2e9 }  # assumed
rim = { thickness_mm = 60.0, support_n_per_m = 1e10, rotation_support_n_per_m = 1e10 }  # assumed
sun_support_n_per_m = 1e7  # assumed: the sun floats
carrier_support_n_per_m = 2e9  # assumed
coupling_stiffness_nm_per_rad = 2e7  # assumed

[[wheel]]
name = \"z1\"
shaft = \"low\"
at = 0.5  # assumed
teeth = 82
face_width_mm = 170.0  # assumed
iso_class = 5  # assumed

[[wheel]]
name = \"z2\"
shaft = \"middle\"
at = 0.5  # assumed
teeth = 23
face_width_mm = 170.0  # assumed
iso_class = 5  # assumed

[[wheel]]
name = \"z3\"
shaft = \"middle\"
at = 0.2  # assumed
teeth = 88
face_width_mm = 120.0  # assumed
iso_class = 5  # assumed

[[wheel]]
name = \"z4\"
shaft = \"high\"
at = 0.5  # assumed
teeth = 22
face_width_mm = 120.0  # assumed
iso_class = 5  # assumed

[[mesh]]
wheels = [\"z1\", \"z2\"]
module_mm = 8.0  # assumed

[[mesh]]
wheels = [\"z3\", \"z4\"]
module_mm = 5.0  # assumed

# Stiffnesses are assumed.
BEARINGS
[housing]
mass_kg = 3000.0  # assumed
feet = [{ at_mm = [-500.0, -500.0, 900.0], stiffness_n_per_m = 5e8 }, { at_mm = [1500.0, -500.0, 900.0], stiffness_n_per_m = 5e8 }, { at_mm = [-500.0, -500.0, 1600.0], stiffness_n_per_m = 5e8 }, { at_mm = [1500.0, -500.0, 1600.0], stiffness_n_per_m = 5e8 }]  # assumed

[operation]
input_speed_hz = 0.368
brake_torque_nm = 4000.0  # assumed: full load
brake_inertia_kgm2 = 20.0  # assumed
speed_wander_percent = 0.03  # assumed

# Faults name a wheel: p.sun, p.planet1, p.ring, z1.
#
# [[fault]]
# wheel = \"p.sun\"
# kind = \"tooth-breakage\"
# severity = 0.8

# On top of the ring, and on the seat of the high-speed shaft.
[[sensor]]
at = \"ring:p:90\"

[[sensor]]
at = \"high:1\"

[solver]
sampling_rate_hz = 80_000.0
duration_s = 4.0
";

/// The bearings of both ends of the wind turbine's shafts.
pub(super) fn wind_turbine() -> String {
    let bearing = |shaft: &str, at: &str| {
        format!(
            "[[bearing]]\nshaft = \"{shaft}\"\nat = {at}\nstiffness_n_per_m = 6e9\ntilt_stiffness_nm_per_rad = 1e6\n\
             seat = {{ mass_kg = 50.0, inertia_kgm2 = 0.5, stiffness_n_per_m = 2e10 }}\n\n"
        )
    };
    let bearings: String = ["rotor", "low", "middle", "high"]
        .iter()
        .flat_map(|shaft| ["0.0", "1.0"].map(|at| bearing(shaft, at)))
        .collect();
    WIND_TURBINE.replace("BEARINGS\n", &bearings)
}
