"""The dictionaries of a gearbox.

Written by `cargo xtask generate` from the rows of the Rust library: a change belongs there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict

import numpy.typing as npt

from ._keys import EndRelief, FlankRelief, Foundation, Profile, Unbalance, WheelInertia
from ._sensor import SensorPath


class Bow(TypedDict, total=False):
    """The table ``bow`` of an entry ``[[shaft]]`` of a gearbox.

    Attributes
    ----------
    middle_um : float
        (µm) The distance of its middle from the line through its ends, without a load. Allowed: ≥ 0, ≤ 10000.
    angle_deg : float
        (°) Its direction at time 0, before settling, from x towards y. Allowed: −360…360.
    """

    middle_um: float
    angle_deg: float


class GearboxShaft(TypedDict, total=False):
    """An entry ``[[shaft]]`` of a gearbox.

    Attributes
    ----------
    name : str
        The shaft's name. Allowed: no other shaft's.
    length_mm : float
        (mm) The shaft's length, from z = 0 on. Allowed: > 0, ≤ 100000.
    radius_mm : float
        (mm) Its radius, also of the bores of the wheels on it. Allowed: > 0; less than the wheels' root radii.
    segments : sequence of pairs of floats
        (mm) The length and the radius of each piece, from z = 0 on, in place of one radius. Allowed: > 0; lengths add
        up to length_mm.
    bore_radius_mm : float
        (mm) The radius of the shaft's own bore. Allowed: ≥ 0; less than its radius.
    position_mm : sequence of 2 floats
        (mm) X and y of its axis. Allowed: at the mesh's centre distance from the axis of each mating shaft, within 0.01
        mm.
    elements : int
        The number of its beam elements. Allowed: whole number 2…60.
    couples_to : {'nothing', 'motor', 'brake'}
        What it is coupled to: the motor at z = 0, or the brake at the other end.
    coupling_stiffness_nm_per_rad : float
        (N m/rad) The torsional stiffness of that coupling. Allowed: > 0, ≤ 1e15.
    damping_ratio : float
        (-) The damping ratio of the shaft and its coupling. Allowed: ≥ 0, < 1.
    unbalance : Unbalance
        The unbalance of the shaft, midway along it.
    bow : Bow
        The bow of a shaft that is not straight: half a sine over its length.
    """

    name: str
    length_mm: float
    radius_mm: float
    segments: npt.ArrayLike
    bore_radius_mm: float
    position_mm: Sequence[float]
    elements: int
    couples_to: Literal["nothing", "motor", "brake"]
    coupling_stiffness_nm_per_rad: float
    damping_ratio: float
    unbalance: Unbalance
    bow: Bow


class GearboxWheel(TypedDict, total=False):
    """An entry ``[[wheel]]`` of a gearbox.

    Attributes
    ----------
    name : str
        The wheel's name. Allowed: no other wheel's.
    shaft : str
        The name of its shaft.
    at : float
        (-) The position along the shaft, as a fraction of its length from z = 0. Allowed: 0…1; within half a face width
        of its mating wheels.
    teeth : int
        The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is not
        simulated, with a warning.
    face_width_mm : float
        (mm) The face width; a mesh has the narrower one. Allowed: > 0, ≤ 10000; on its shaft, clear of other wheels.
    profile_shift : float
        (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip.
    addendum : float
        (-) The addendum coefficient of the basic rack, in modules. Allowed: 0.3…2; tips not pointed, clear of the
        mating gear's fillets.
    dedendum : float
        (-) The dedendum coefficient of the basic rack, in modules. Allowed: 0.5…2.5; roots clear of the mating gear's
        tips.
    tip_chamfer_mm : float
        (mm) The height of the chamfer or rounding of all tips. Allowed: ≥ 0; the same of both wheels of a mesh.
    active_profile_shortening : float
        (-) The shortening of the path of contact against that between the chamfers, in base pitches, half at either
        end. Allowed: 0…0.5; the same of both wheels of a mesh.
    uniform_flank_reduction_mm : float
        (mm) A constant reduction of the working flank. Allowed: ≥ 0; the same of both wheels of a mesh.
    flank_relief : FlankRelief
        The relief of the flanks near the tips, as a gap in µm. Allowed: the same of both wheels of a mesh.
    material : {'steel', 'copper', 'aluminium', 'brass', 'cast-iron', 'bronze'} or dict
        Its material.
    inertia : WheelInertia
        Its mass and inertias, any of the three.
    unbalance : Unbalance
        Its unbalance.
    eccentricity_mm : float
        (mm) The eccentricity of its seat. Allowed: ≥ 0; less than the module; the same of both wheels of a mesh; of a
        wheel in one mesh.
    din_grade : int
        The grade of DIN 3961 of its deviations, 1 (best) to 12; 0: ideal teeth. Allowed: whole number 0…12.
    iso_class : int
        The class of ISO 1328-1:2013 instead, 1 (best) to 11; 0: none. Allowed: whole number 0…11; not beside din_grade.
    tooth_share : float
        (-) The part of the tolerances of profile slope and form that each tooth has of its own. Allowed: 0…1.
    pitch_share : float
        (-) Its largest single pitch deviation over its tolerance f_p. Allowed: 0…1.
    run_out_share : float
        (-) Its run-out over its tolerance F_r. Allowed: 0…1.
    slope_wobble : float
        (-) The profile slope that varies once a revolution, over the rms deviation of the wheel's profiles. Allowed:
        0…3.
    helix_share : float
        (-) Its largest helix slope deviation, of either sign, over its tolerance f_Hβ. Allowed: 0…1.
    profile_errors_mm : array of float64, shape (100, teeth)
        (mm) Its profile errors, instead of a draw: 100 rows of one number a tooth, in the order of contact in its first
        mesh. Allowed: 100 × teeth, each below the module; not beside errors_file, din_grade, iso_class.
    cumulative_pitch_um : sequence of floats
        (µm) The working flanks' cumulative pitch deviations along the pitch circle, positive where metal is added.
        Allowed: one a tooth, each below the module.
    run_out_um : float
        (µm) The run-out F_r, of which the deviation is F_r/2 sin(θ + φ). Allowed: ≥ 0, ≤ 10000.
    run_out_phase_rad : float
        (rad) Its phase φ.
    helix_slope_um : float
        (µm) The helix slope deviation over the face width, positive where metal is added towards positive z. Allowed:
        −1000…1000.
    """

    name: str
    shaft: str
    at: float
    teeth: int
    face_width_mm: float
    profile_shift: float
    addendum: float
    dedendum: float
    tip_chamfer_mm: float
    active_profile_shortening: float
    uniform_flank_reduction_mm: float
    flank_relief: FlankRelief
    material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float]
    inertia: WheelInertia
    unbalance: Unbalance
    eccentricity_mm: float
    din_grade: int
    iso_class: int
    tooth_share: float
    pitch_share: float
    run_out_share: float
    slope_wobble: float
    helix_share: float
    profile_errors_mm: npt.ArrayLike
    cumulative_pitch_um: Sequence[float]
    run_out_um: float
    run_out_phase_rad: float
    helix_slope_um: float


class GearboxMesh(TypedDict, total=False):
    """An entry ``[[mesh]]`` of a gearbox.

    Attributes
    ----------
    wheels : sequence of two strs
        The names of the driving and of the driven wheel.
    module_mm : float
        (mm) The module of both wheels, of helical ones in the normal section. Allowed: > 0, ≤ 100.
    pressure_angle_deg : float
        (°) The pressure angle at the pitch circle, of helical wheels in the normal section. Allowed: 10…35; no teeth
        pointed below full height.
    helix_angle_deg : float
        (°) The helix angle at the pitch circle; 0: spur wheels. Allowed: 0…45; 0, or at least 0.01; total contact ratio
        at most 12.
    hand : {'right', 'left'}
        The hand of the driving wheel's helix; the driven one's is the other one.
    lead_crowning_um : float
        (µm) The lead crowning of both wheels together: how much farther apart the flanks are at the ends of the face
        than at its middle. Allowed: ≥ 0, ≤ 1000.
    end_relief : EndRelief
        The relief of the flanks towards both ends of the face, as a gap in µm.
    slices : int
        The number of slices of the face where the gap of helical teeth, or of crowned ones, varies along it. Allowed:
        whole number 5…41.
    centre_distance_mm : float
        (mm) The distance between the axes. Allowed: > 0; at least the default; contact ratio at least 1.
    backlash_mm : float
        (mm) The backlash along the line of action. Allowed: ≥ 0; less than 1 module; at least that of a given centre
        distance.
    misalignment_um : float
        (µm) The misalignment of the shafts in the plane of action over the face width, including their slope under the
        nominal load; positive where flanks come closer towards positive z. The tilt by an uneven load is computed.
        Allowed: −1000…1000.
    points_per_tooth : int
        The number of points along a tooth's profile. Allowed: whole number 500…1000000.
    foundation : Foundation
        The coefficients A to F of the four polynomials of the fillet foundation's compliance, by Sainsot, Velex and
        Duverger (2004).
    phase : float
        (base pitches) Where on its path of contact the first pair of teeth is at the start.
    damping_ratio : float
        (-) The damping of teeth in contact, relative to the critical damping of the wheels' rotation on the mean mesh
        stiffness. Allowed: ≥ 0, < 1.
    friction : float
        (-) The coefficient of friction of the flanks; 0 for frictionless ones. Allowed: 0…0.5.
    random_force : float
        (-) The size of the random force across the line of action, modulated by the load; 0 for none. Allowed: 0…10.
    """

    wheels: Sequence[str]
    module_mm: float
    pressure_angle_deg: float
    helix_angle_deg: float
    hand: Literal["right", "left"]
    lead_crowning_um: float
    end_relief: EndRelief
    slices: int
    centre_distance_mm: float
    backlash_mm: float
    misalignment_um: float
    points_per_tooth: int
    foundation: Foundation
    phase: float
    damping_ratio: float
    friction: float
    random_force: float


class BearingDefect(TypedDict, total=False):
    """An entry of ``defect`` of an entry ``[[bearing]]`` of a gearbox.

    Attributes
    ----------
    race : {'outer', 'inner', 'element'}
        The part with the spall: a race, or one of the balls or rollers.
    severity : float
        (-) The width of the spall as a fraction of the diameter of an element. Allowed: > 0, ≤ 1.
    width_mm : float
        (mm) The width of the spall along the path of the elements. Allowed: > 0; at most the diameter of an element,
        and on the inner race the spacing of the elements.
    depth_um : float
        (µm) The depth of the spall; an element drops at most until it touches both edges. Allowed: > 0, ≤ 100000.
    angle_deg : float
        (°) The angle from the static load of the bearing to the middle of the spall, about z; on the inner race at time
        0, before settling. Allowed: −360…360.
    """

    race: Literal["outer", "inner", "element"]
    severity: float
    width_mm: float
    depth_um: float
    angle_deg: float


class Seat(TypedDict, total=False):
    """The table ``seat`` of an entry ``[[bearing]]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The seat's mass. Allowed: > 0, ≤ 1e9.
    inertia_kgm2 : float
        (kg m²) Its moment of inertia about every axis. Allowed: > 0, ≤ 1e9.
    stiffness_n_per_m : float
        (N/m) Its stiffness to the housing or to the ground, in every direction. Allowed: > 0, ≤ 1e15.
    tilt_stiffness_nm_per_rad : float
        (N m/rad) Its rotational stiffness about every axis. Allowed: > 0, ≤ 1e15.
    """

    mass_kg: float
    inertia_kgm2: float
    stiffness_n_per_m: float
    tilt_stiffness_nm_per_rad: float


class GearboxBearing(TypedDict, total=False):
    """An entry ``[[bearing]]`` of a gearbox.

    Attributes
    ----------
    shaft : str
        The name of its shaft.
    at : float
        (-) The position along the shaft, as a fraction of its length from z = 0. Allowed: 0…1.
    kind : {'linear', 'ball', 'roller'}
        The kind of bearing: a linear spring, or balls or cylindrical rollers in Hertzian contact.
    name : str
        The name of a rolling bearing whose geometry is published: 6203, 6205, ER-10K, ER-16K, UER204.
    elements : int
        The number of balls or rollers. Allowed: whole number 3…200.
    element_mm : float
        (mm) The diameter of a ball or roller. Allowed: > 0; room for all elements on the pitch circle.
    pitch_mm : float
        (mm) The pitch diameter, of the circle through the centres of the elements. Allowed: > 0.
    contact_angle_deg : float
        (°) The contact angle of a ball bearing. Allowed: ≥ 0, < 90.
    roller_length_mm : float
        (mm) The length of a roller. Allowed: > 0.
    clearance_um : float
        (µm) The diametral clearance of a rolling bearing; negative for an interference. Allowed: −200…1000.
    preload_n : float
        (N) The axial preload of a ball bearing with a contact angle; it takes up the clearance. Allowed: ≥ 0, ≤
        1000000.
    slip_percent : float
        (%) The random slip of the cage at each pass of an element: its standard deviation, in the spacing of the
        elements. Allowed: 0…2.
    defect : sequence of BearingDefect
        The spalls of a rolling bearing, one by one.
    stiffness_n_per_m : float
        (N/m) The radial stiffness of a linear bearing. Allowed: > 0, ≤ 1e15.
    axial_stiffness_n_per_m : float
        (N/m) The axial stiffness; 0 where the shaft may slide. Allowed: ≥ 0, ≤ 1e15.
    tilt_stiffness_nm_per_rad : float
        (N m/rad) The tilting stiffness of the shaft in the bearing. Allowed: ≥ 0, ≤ 1e15.
    seat : Seat
        The bearing's seat, on the housing or on the ground.
    damping_ratio : float
        (-) The damping ratio of the bearing and its seat. Allowed: ≥ 0, < 1.
    """

    shaft: str
    at: float
    kind: Literal["linear", "ball", "roller"]
    name: str
    elements: int
    element_mm: float
    pitch_mm: float
    contact_angle_deg: float
    roller_length_mm: float
    clearance_um: float
    preload_n: float
    slip_percent: float
    defect: Sequence[BearingDefect]
    stiffness_n_per_m: float
    axial_stiffness_n_per_m: float
    tilt_stiffness_nm_per_rad: float
    seat: Seat
    damping_ratio: float


class Foot(TypedDict, total=False):
    """An entry of ``feet`` of the section ``[housing]`` of a gearbox.

    Attributes
    ----------
    at_mm : sequence of 3 floats
        (mm) Where it is: x, y, z. Allowed: > −100000, < 100000.
    stiffness_n_per_m : float
        (N/m) Its stiffness in every direction. Allowed: > 0, ≤ 1e15.
    """

    at_mm: Sequence[float]
    stiffness_n_per_m: float


class Modes(TypedDict, total=False):
    """The table ``modes`` of the section ``[housing]`` of a gearbox.

    Attributes
    ----------
    per_khz : float
        (1/kHz) How many modes it has in a kHz, up to 9 kHz; 0 for a rigid housing. Allowed: 0…20.
    first_hz : float
        (Hz) The frequency from which on it has modes. Allowed: > 0, ≤ 9000.
    damping_ratio : float
        (-) The damping ratio of its modes. Allowed: ≥ 0, < 1.
    seed : int
        The seed of their frequencies and shapes: which housing it is. Allowed: whole number.
    """

    per_khz: float
    first_hz: float
    damping_ratio: float
    seed: int


class GearboxHousing(TypedDict, total=False):
    """The section ``[housing]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The housing's mass, without the seats. Allowed: > 0, ≤ 1e9.
    inertia_kgm2 : float
        (kg m²) Its moment of inertia about every axis. Allowed: > 0, ≤ 1e9.
    feet : sequence of Foot
        The feet on which it stands, one by one.
    damping_ratio : float
        (-) The damping ratio of the feet. Allowed: ≥ 0, < 1.
    modes : Modes
        The modes in which it vibrates between its feet and the seats.
    """

    mass_kg: float
    inertia_kgm2: float
    feet: Sequence[Foot]
    damping_ratio: float
    modes: Modes


class Ripple(TypedDict, total=False):
    """An entry of ``torque_ripple`` of the section ``[operation]`` of a gearbox.

    Attributes
    ----------
    shaft : str
        The name of the shaft with whose rotation it comes.
    order : float
        (-) The number of its periods per revolution of that shaft. Allowed: > 0, ≤ 10000.
    amplitude : float
        (-) Its amplitude as a part of the torque. Allowed: 0…1.2.
    phase_deg : float
        (°) Its phase at the start.
    """

    shaft: str
    order: float
    amplitude: float
    phase_deg: float


class GearboxOperation(TypedDict, total=False):
    """The section ``[operation]`` of a gearbox.

    Attributes
    ----------
    input_speed_hz : float
        (rev/s) The nominal speed of the motor and of the shaft that is coupled to it; the sampling rate is chosen for
        it. Allowed: > 0, ≤ 100000.
    brake_torque_nm : float
        (N m) The nominal torque of the brake on the shaft that is coupled to it. Allowed: ≥ 0, ≤ 1e9.
    speed_fluctuation_hz : float
        (Hz) The amplitude of the uniform random error of every sample's speed. Allowed: ≥ 0; less than the lowest
        speed.
    torque_fluctuation_nm : float
        (N m) The amplitude of the uniform random error of every sample's torque. Allowed: ≥ 0; less than the lowest
        torque.
    speed_profile_hz : dict of time_s and value
        (s, Hz) The speed against time from the simulation's start, { time_s = […], value = […] }, straight between the
        points, constant outside them; or { file = "….csv" } with the columns time_s and value. Allowed: at least 2
        points, times increasing, values > 0. Ignored by published.
    torque_profile_nm : dict of time_s and value
        (s, N m) The torque against time, likewise. Allowed: likewise, values ≥ 0.
    brake_inertia_kgm2 : float
        (kg m²) The inertia of the brake. Allowed: > 0, ≤ 1e9.
    torque_ripple : sequence of Ripple
        Harmonics of the brake's torque over the rotation θ of a shaft, T (1 + Σ a cos(hθ + ψ)). Allowed: amplitudes add
        up to 1.2 at most.
    """

    input_speed_hz: float
    brake_torque_nm: float
    speed_fluctuation_hz: float
    torque_fluctuation_nm: float
    speed_profile_hz: Profile
    torque_profile_nm: Profile
    brake_inertia_kgm2: float
    torque_ripple: Sequence[Ripple]


class GearboxSensor(TypedDict, total=False):
    """An entry ``[[sensor]]`` of a gearbox.

    Attributes
    ----------
    at : str
        Where it sits: "SHAFT:AT" on the seat of the bearing there, "shaft:SHAFT:AT" on the shaft itself, "housing:[x,
        y, z]" in mm on the housing. Ignored by linear, published.
    name : str
        The sensor's name; its signal is the channel ``NAME_g``. Allowed: a letter, then letters, digits and ``_``; no
        other channel's.
    direction : {'vertical', 'horizontal', 'axial'}
        The direction it measures in.
    resonance_hz : float
        (Hz) The natural frequency of the sensor on its mount. Allowed: > 0, ≤ 10000000.
    resonance_damping_ratio : float
        (-) The damping ratio of that resonance. Allowed: > 0, ≤ 10.
    noise_density_g_per_rthz : float
        (g/√Hz) The density of its white normal noise: the standard deviation over the root of half the sampling rate.
        Allowed: ≥ 0, ≤ 1000.
    noise_seed : int
        The seed of the noise alone. Allowed: whole number.
    range_g : float
        (g) The largest acceleration, of either sign, that it measures. Allowed: > 0, ≤ 1e9.
    bits : int
        The resolution: the range from minus to plus has 2^bits steps. Allowed: whole number 8…32; with range_g.
    path : SensorPath
        The wall and the modes of a housing between its place and the sensor; rigid under linear and published. Ignored
        by linear, published.
    frequency_response : dict of frequency_hz, magnitude and phase_deg
        (Hz, -, °) The measured path to the sensor: magnitude and phase over frequency, straight between the points, the
        phase unwrapped; zero outside them. Or { file = "….csv" } with the columns frequency_hz, magnitude, phase_deg.
        Allowed: at least 2 points, frequencies increasing from 0 on, magnitudes ≥ 0.
    """

    at: str
    name: str
    direction: Literal["vertical", "horizontal", "axial"]
    resonance_hz: float
    resonance_damping_ratio: float
    noise_density_g_per_rthz: float
    noise_seed: int
    range_g: float
    bits: int
    path: SensorPath
    frequency_response: Mapping[str, Any]


class GearboxSolver(TypedDict, total=False):
    """The section ``[solver]`` of a gearbox.

    Attributes
    ----------
    sampling_rate_hz : float
        (S/s) The nominal sampling rate; the actual one is the next with a whole number of samples per revolution of the
        input. Allowed: > 0.
    duration_s : float
        (s) The length of the kept signal; settling comes before it. Allowed: > 0; not beside input_revolutions.
    input_revolutions : float
        (rev) The number of kept revolutions of the input; settling comes before them. Allowed: > 0; not beside
        duration_s, not with a speed profile.
    settle_fraction : float
        (-) The part of the simulated time that is discarded from the start, while the vibration settles. Allowed: ≥ 0,
        < 1.
    settle_tolerance : float
        (-) The fraction of the slowest mode's transient that may remain where the kept signal starts: a steady
        simulation starts in equilibrium and simulates only as much of the discarded part as this needs; 0: all of it,
        as always under published. Allowed: ≥ 0, < 1.
    highest_mode_hz : float
        (Hz) The natural frequency up to which modes are integrated; those above deform statically. Allowed: > 0, ≤ 1e9.
    """

    sampling_rate_hz: float
    duration_s: float
    input_revolutions: float
    settle_fraction: float
    settle_tolerance: float
    highest_mode_hz: float
