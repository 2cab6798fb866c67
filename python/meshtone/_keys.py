"""The keys of a scenario.

Written by `cargo xtask generate` from the rows of the Rust library: a change belongs there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, NoReturn, TypedDict, Union

import numpy as np
import numpy.typing as npt

from ._sensor import Sensor, SensorPath
from .faults import Fault

Profile = Mapping[str, Union[Sequence[float], npt.NDArray[np.float64]]]
"""``time_s`` and ``value``: speed or torque against time."""


class EndRelief(TypedDict, total=False):
    """The table ``end_relief`` of a scenario.

    Attributes
    ----------
    length_mm : float
        (mm) The length from each end of the face. Allowed: > 0; at most half the face width.
    amount_um : float
        (µm) How much farther apart the flanks of both wheels are at the ends of the face. Allowed: ≥ 0, ≤ 1000.
    """

    length_mm: float
    amount_um: float


class FlankRelief(TypedDict, total=False):
    """One of the tables ``flank_relief``, ``pinion_flank_relief``, ``gear_flank_relief`` of a scenario.

    Attributes
    ----------
    shape : {'parabolic', 'linear'}
        A parabola that leaves the flank smoothly, or a straight line.
    length_mm : float
        (mm) The length from the tip along the tooth's centre line. Allowed: > 0; less than 2 modules.
    amount_um : float
        (µm) The depth of the relief at the tip, along the flank's normal; usually 10 to 40. Allowed: ≥ 0, ≤ 1000.
    """

    shape: Literal["parabolic", "linear"]
    length_mm: float
    amount_um: float


class Foundation(TypedDict, total=False):
    """The table ``foundation`` of a scenario.

    Attributes
    ----------
    L : sequence of 6 floats
        A to F of L, the factor of u².
    M : sequence of 6 floats
        A to F of M, the factor of u.
    P : sequence of 6 floats
        A to F of P, the constant term.
    Q : sequence of 6 floats
        A to F of Q, the factor of tan²α.
    rotation : {'machine', 'tooth'}
        Where the rotation of the wheel's whole body is, which P has too: "machine" takes it out of P and makes it a
        torsional spring between bore and wheel, "tooth" leaves it in each pair of teeth.
    """

    L: Sequence[float]
    M: Sequence[float]
    P: Sequence[float]
    Q: Sequence[float]
    rotation: Literal["machine", "tooth"]


class Shaft(TypedDict, total=False):
    """One of the tables ``pinion_shaft``, ``gear_shaft`` of a scenario.

    Attributes
    ----------
    length_mm : float
        (mm) The length from the wheel to motor or brake. Allowed: > 0, ≤ 1000000.
    radius_mm : float
        (mm) The radius, also of the wheel's bore. Allowed: > 0; less than the wheel's root radius.
    bearing_span_mm : float
        (mm) The distance between the shaft's two bearings. Allowed: > 0, ≤ 100000.
    wheel_at : float
        (-) The position of the wheel between them. Allowed: > 0, < 1.
    bearing_stiffness_n_per_m : float
        (N/m) The stiffness of both bearings together. Allowed: > 0, ≤ 1e15.
    damping_ratio : float
        (-) The damping ratio of the shaft and its bearings. Allowed: ≥ 0, < 1.
    """

    length_mm: float
    radius_mm: float
    bearing_span_mm: float
    wheel_at: float
    bearing_stiffness_n_per_m: float
    damping_ratio: float


class WheelInertia(TypedDict, total=False):
    """One of the tables ``pinion_inertia``, ``gear_inertia`` of a scenario.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass. Allowed: > 0, ≤ 1e9.
    polar_inertia_kgm2 : float
        (kg m²) The moment of inertia about the shaft. Allowed: > 0, ≤ 1e9.
    transverse_inertia_kgm2 : float
        (kg m²) The moment of inertia about a diameter. Allowed: > 0, ≤ 1e9.
    """

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


class Unbalance(TypedDict, total=False):
    """One of the tables ``pinion_unbalance``, ``gear_unbalance`` of a scenario.

    Attributes
    ----------
    g_mm : float
        (g mm) The mass times its distance from the axis. Allowed: ≥ 0, ≤ 10000000.
    angle_deg : float
        (°) Its direction at time 0, before settling, from x towards y. Allowed: −360…360.
    """

    g_mm: float
    angle_deg: float


class Support(TypedDict, total=False):
    """The table ``support`` of a scenario.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass of each support; 1.6 by default where a stiffness is given. Allowed: > 0, ≤ 1e9.
    base_hz : float
        (Hz) The natural frequency of the bare supports, moving in phase. Allowed: > 0, ≤ 1000000.
    differential_hz : float
        (Hz) The natural frequency of the bare supports, moving out of phase. Allowed: > 0, ≤ 1000000; more than
        base_hz.
    stiffness_n_per_m : float
        (N/m) Instead of the frequencies, the stiffness between each support and the base. Allowed: > 0, ≤ 1e15.
    coupling_n_per_m : float
        (N/m) Instead of the frequencies, the stiffness between the two supports. Allowed: ≥ 0, ≤ 1e15.
    damping_ratio : float
        (-) The damping ratio of the supports on their stiffnesses. Allowed: ≥ 0, < 1.
    """

    mass_kg: float
    base_hz: float
    differential_hz: float
    stiffness_n_per_m: float
    coupling_n_per_m: float
    damping_ratio: float


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
        (mm) The shaft's length. Allowed: > 0, ≤ 100000.
    start_mm : float
        (mm) Z of its beginning: shafts of one axis stand behind one another. Allowed: > −100000, < 100000.
    radius_mm : float
        (mm) Its radius, also of the bores of the wheels on it. Allowed: > 0; less than the wheels' root radii.
    segments : sequence of pairs of floats
        (mm) The length and the radius of each piece, from its beginning on, in place of one radius. Allowed: > 0;
        lengths add up to length_mm.
    bore_radius_mm : float
        (mm) The radius of the shaft's own bore. Allowed: ≥ 0; less than its radius.
    position_mm : sequence of 2 floats
        (mm) X and y of its axis. Allowed: at the mesh's centre distance from the axis of each mating shaft, within 0.01
        mm.
    elements : int
        The number of its beam elements. Allowed: whole number 2…60.
    couples_to : {'nothing', 'motor', 'brake'}
        What it is coupled to: the motor at its beginning, or the brake at the other end.
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
    start_mm: float
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
        (-) The position along the shaft, as a fraction of its length from its beginning. Allowed: 0…1; within half a
        face width of its mating wheels.
    teeth : int
        The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is not
        simulated, with a warning.
    face_width_mm : float
        (mm) The face width; a mesh has what both faces have in common. Allowed: > 0, ≤ 10000; on its shaft, clear of
        other wheels.
    profile_shift : float
        (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip.
    addendum : float
        (-) The addendum coefficient of the basic rack, in modules. Allowed: 0.3…2; tips not pointed, clear of the
        mating gear's fillets.
    dedendum : float
        (-) The dedendum coefficient of the basic rack, in modules. Allowed: 0.5…2.5; roots clear of the mating gear's
        tips.
    tip_chamfer_mm : float
        (mm) The height of the chamfer or rounding of all tips. Allowed: ≥ 0; less than 1 module.
    active_profile_shortening : float
        (-) The shortening of the path of contact against that between the chamfers, in base pitches, half of it at the
        tips of either wheel. Allowed: 0…0.5.
    uniform_flank_reduction_mm : float
        (mm) A constant reduction of the working flank. Allowed: ≥ 0; less than π/4 modules, half the tooth's thickness.
    flank_relief : FlankRelief
        The relief of the flanks near the tips, as a gap in µm.
    material : {'steel', 'copper', 'aluminium', 'brass', 'cast-iron', 'bronze'} or dict
        Its material.
    inertia : WheelInertia
        Its mass and inertias, any of the three.
    unbalance : Unbalance
        Its unbalance.
    eccentricity_mm : float
        (mm) The eccentricity of its seat. Allowed: ≥ 0; less than the module; of a wheel in one mesh.
    din_grade : int
        The grade of DIN 3961 of the deviations, 1 (best) to 12; 0: ideal teeth. Allowed: whole number 0…12.
    iso_class : int
        The class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none. Allowed: whole
        number 0…11; not beside din_grade.
    tooth_share : float
        (-) The part of the tolerances of profile slope and form that each tooth has of its own; the rest is common to a
        wheel's teeth. Allowed: 0…1.
    pitch_share : float
        (-) A wheel's largest single pitch deviation over its tolerance f_p. Allowed: 0…1.
    run_out_share : float
        (-) A wheel's run-out over its tolerance F_r. Allowed: 0…1.
    slope_wobble : float
        (-) The profile slope that varies once a revolution, over the rms deviation of the wheel's profiles. Allowed:
        0…3.
    helix_share : float
        (-) A wheel's largest helix slope deviation, of either sign, over its tolerance f_Hβ. Allowed: 0…1.
    helix_wobble_um : float
        (µm) The amplitude of a helix slope over its face width that turns with it, as of a wheel that wobbles. Allowed:
        0…1000.
    profile_errors_mm : array of float64, shape (100, teeth)
        (mm) Its profile errors, instead of a draw: 100 rows of one number a tooth, in the order of contact in its first
        mesh. Allowed: 100 × teeth, each below the module; not beside errors_file, din_grade, iso_class.
    cumulative_pitch_um : sequence of floats
        (µm) The working flanks' cumulative pitch deviations along the pitch circle, positive where metal is added.
        Allowed: one a tooth, each below the module.
    run_out_um : float
        (µm) The run-out F_r, of which the deviation is F_r/2 sin(θ + φ). Allowed: ≥ 0, ≤ 10000.
    run_out_phase_rad : float
        (rad) Its phase φ; θ counts from where the wheel's first tooth enters contact.
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
    helix_wobble_um: float
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


class Teeth(TypedDict, total=False):
    """The table ``teeth`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    sun : int
        The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is not
        simulated, with a warning.
    planet : int
        The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is not
        simulated, with a warning.
    ring : int
        The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is not
        simulated, with a warning.
    """

    sun: int
    planet: int
    ring: int


class ProfileShift(TypedDict, total=False):
    """The table ``profile_shift`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    sun : float
        (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip.
    planet : float
        (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip.
    ring : float
        (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip.
    """

    sun: float
    planet: float
    ring: float


class Pin(TypedDict, total=False):
    """The table ``pin`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    stiffness_n_per_m : float
        (N/m) The stiffness of each pin with the planet's bearing. Allowed: > 0, ≤ 1e15.
    error_um : sequence of floats
        (µm) How far each pin stands ahead of its place, positive as the carrier turns about positive z. Allowed:
        −1000…1000; one a planet.
    """

    stiffness_n_per_m: float
    error_um: Sequence[float]


class Rim(TypedDict, total=False):
    """The table ``rim`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    thickness_mm : float
        (mm) The rim's thickness below the root circle. Allowed: > 0, ≤ 10000.
    support_n_per_m : float
        (N/m) The stiffness that holds the ring across its axis. Allowed: > 0, ≤ 1e15.
    rotation_support_n_per_m : float
        (N/m) The stiffness against its rotation, along its base circle. Allowed: > 0, ≤ 1e15.
    waves : int
        The largest number of waves around the rim with which it bends. Allowed: whole number 2…20.
    """

    thickness_mm: float
    support_n_per_m: float
    rotation_support_n_per_m: float
    waves: int


class SunInertia(TypedDict, total=False):
    """The table ``sun_inertia`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass. Allowed: > 0, ≤ 1e9.
    polar_inertia_kgm2 : float
        (kg m²) The moment of inertia about the shaft. Allowed: > 0, ≤ 1e9.
    transverse_inertia_kgm2 : float
        (kg m²) The moment of inertia about a diameter. Allowed: > 0, ≤ 1e9.
    """

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


class PlanetInertia(TypedDict, total=False):
    """The table ``planet_inertia`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass. Allowed: > 0, ≤ 1e9.
    polar_inertia_kgm2 : float
        (kg m²) The moment of inertia about the shaft. Allowed: > 0, ≤ 1e9.
    transverse_inertia_kgm2 : float
        (kg m²) The moment of inertia about a diameter. Allowed: > 0, ≤ 1e9.
    """

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


class RingInertia(TypedDict, total=False):
    """The table ``ring_inertia`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass. Allowed: > 0, ≤ 1e9.
    polar_inertia_kgm2 : float
        (kg m²) The moment of inertia about the shaft. Allowed: > 0, ≤ 1e9.
    transverse_inertia_kgm2 : float
        (kg m²) The moment of inertia about a diameter. Allowed: > 0, ≤ 1e9.
    """

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


class CarrierInertia(TypedDict, total=False):
    """The table ``carrier_inertia`` of an entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    mass_kg : float
        (kg) The mass. Allowed: > 0, ≤ 1e9.
    polar_inertia_kgm2 : float
        (kg m²) The moment of inertia about the shaft. Allowed: > 0, ≤ 1e9.
    transverse_inertia_kgm2 : float
        (kg m²) The moment of inertia about a diameter. Allowed: > 0, ≤ 1e9.
    """

    mass_kg: float
    polar_inertia_kgm2: float
    transverse_inertia_kgm2: float


class GearboxPlanetary(TypedDict, total=False):
    """An entry ``[[planetary]]`` of a gearbox.

    Attributes
    ----------
    name : str
        The set's name; its wheels are called NAME.sun, NAME.planet1, NAME.ring. Allowed: no other set's.
    sun : str
        The name of the sun's shaft, or "fixed".
    carrier : str
        The name of the carrier's shaft, or "fixed".
    ring : str
        The name of the ring's shaft, or "fixed". Allowed: one member at most is fixed.
    teeth : Teeth
        The tooth counts of sun, planets and ring. Allowed: teeth that fit one another at one centre distance.
    planets : int
        The number of planets, equally spaced, the first along x. Allowed: whole number 1…8; teeth that fit; room beside
        one another.
    planet_angles_deg : sequence of floats
        (°) Where the planets stand instead, from x towards y. Allowed: −360…360; one a planet; teeth that fit.
    module_mm : float
        (mm) The module of both wheels, of helical ones in the normal section. Allowed: > 0, ≤ 100.
    pressure_angle_deg : float
        (°) The pressure angle at the pitch circle, of helical wheels in the normal section. Allowed: 10…35; no teeth
        pointed below full height.
    face_width_mm : float
        (mm) The face width of all wheels. Allowed: > 0, ≤ 10000.
    profile_shift : ProfileShift
        (-) The profile shift coefficients of sun, planets and ring.
    tip_chamfer_mm : float
        (mm) The height of the chamfer or rounding of all tips. Allowed: ≥ 0; less than 1 module.
    active_profile_shortening : float
        (-) The shortening of the path of contact against that between the chamfers, in base pitches, half of it at the
        tips of either wheel. Allowed: 0…0.5.
    flank_relief : FlankRelief
        The relief of the flanks near all tips, as a gap in µm.
    backlash_mm : float
        (mm) The backlash along the line of action. Allowed: ≥ 0; less than 1 module; at least that of a given centre
        distance.
    foundation : Foundation
        The coefficients A to F of the four polynomials of the fillet foundation's compliance, by Sainsot, Velex and
        Duverger (2004).
    din_grade : int
        The grade of DIN 3961 of the deviations of all wheels, 1 (best) to 12; 0: ideal teeth. Allowed: whole number
        0…12.
    iso_class : int
        The class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none. Allowed: whole
        number 0…11; not beside din_grade.
    damping_ratio : float
        (-) The damping of teeth in contact, relative to the critical damping of the wheels' rotation on the mean mesh
        stiffness. Allowed: ≥ 0, < 1.
    friction : float
        (-) The coefficient of friction of the flanks; 0 for frictionless ones. Allowed: 0…0.5.
    random_force : float
        (-) The size of the random force across the line of action of every mesh; 0 for none. Allowed: 0…10.
    pin : Pin
        The pins that hold the planets.
    rim : Rim
        The rim of the ring and its support.
    sun_support_n_per_m : float
        (N/m) The stiffness that holds the sun across its axis; a floating sun has 1e3. Allowed: > 0, ≤ 1e15.
    carrier_support_n_per_m : float
        (N/m) The stiffness that holds the carrier across its axis. Allowed: > 0, ≤ 1e15.
    carrier_eccentricity_um : float
        (µm) The eccentricity of the circle of the pins, towards the first planet. Allowed: 0…1000.
    coupling_stiffness_nm_per_rad : float
        (N m/rad) The torsional stiffness between a member and its shaft, or the ground where sun or carrier is fixed.
        Allowed: > 0, ≤ 1e15.
    support_damping_ratio : float
        (-) The damping ratio of pins, supports, rim and couplings. Allowed: ≥ 0, < 1.
    sun_inertia : SunInertia
        The sun's mass and inertia.
    planet_inertia : PlanetInertia
        The mass and inertia of each planet.
    ring_inertia : RingInertia
        The ring's mass and inertia.
    carrier_inertia : CarrierInertia
        The carrier's mass and inertia without planets.
    """

    name: str
    sun: str
    carrier: str
    ring: str
    teeth: Teeth
    planets: int
    planet_angles_deg: Sequence[float]
    module_mm: float
    pressure_angle_deg: float
    face_width_mm: float
    profile_shift: ProfileShift
    tip_chamfer_mm: float
    active_profile_shortening: float
    flank_relief: FlankRelief
    backlash_mm: float
    foundation: Foundation
    din_grade: int
    iso_class: int
    damping_ratio: float
    friction: float
    random_force: float
    pin: Pin
    rim: Rim
    sun_support_n_per_m: float
    carrier_support_n_per_m: float
    carrier_eccentricity_um: float
    coupling_stiffness_nm_per_rad: float
    support_damping_ratio: float
    sun_inertia: SunInertia
    planet_inertia: PlanetInertia
    ring_inertia: RingInertia
    carrier_inertia: CarrierInertia


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
    vertical_stiffness_n_per_m : float
        (N/m) Its stiffness along y, where it differs. Allowed: > 0, ≤ 1e15.
    tilt_stiffness_nm_per_rad : float
        (N m/rad) Its rotational stiffness about every axis. Allowed: > 0, ≤ 1e15.
    """

    mass_kg: float
    inertia_kgm2: float
    stiffness_n_per_m: float
    vertical_stiffness_n_per_m: float
    tilt_stiffness_nm_per_rad: float


class GearboxBearing(TypedDict, total=False):
    """An entry ``[[bearing]]`` of a gearbox.

    Attributes
    ----------
    shaft : str
        The name of its shaft.
    at : float
        (-) The position along the shaft, as a fraction of its length from its beginning. Allowed: 0…1.
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
    vertical_stiffness_n_per_m : float
        (N/m) The radial stiffness of a linear bearing along y, where it differs from that along x. Allowed: > 0, ≤
        1e15.
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
    vertical_stiffness_n_per_m: float
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
    vertical_stiffness_n_per_m : float
        (N/m) Its stiffness along y, where it differs. Allowed: > 0, ≤ 1e15.
    """

    at_mm: Sequence[float]
    stiffness_n_per_m: float
    vertical_stiffness_n_per_m: float


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
        (N m) The nominal torque of the brake on the shaft that is coupled to it, negative where it drives. Allowed:
        −1e9…1e9.
    speed_fluctuation_hz : float
        (Hz) The amplitude of the uniform random error of every sample's speed. Allowed: ≥ 0; less than the lowest
        speed.
    speed_wander_percent : float
        (%) The standard deviation of a slow random wander of the speed, below about 8 Hz; a recorded machine has 0.03
        %. Allowed: 0…10.
    torque_fluctuation_nm : float
        (N m) The amplitude of the uniform random error of every sample's torque. Allowed: ≥ 0; less than the lowest
        torque.
    speed_profile_hz : dict of time_s and value
        (s, Hz) The speed against time from the start of the kept signal, which ends with it, { time_s = […], value =
        […] }, straight between the points, constant outside them; or { file = "….csv" } with the columns time_s and
        value. Allowed: at least 2 points, times increasing, values > 0. Ignored by published.
    torque_profile_nm : dict of time_s and value
        (s, N m) The torque against time, likewise. Allowed: likewise, values of one sign.
    torque_ripple : sequence of Ripple
        Harmonics of the brake's torque over the rotation θ of a shaft, T (1 + Σ a cos(hθ + ψ)). Allowed: amplitudes add
        up to 1.2 at most. Ignored by published.
    brake_inertia_kgm2 : float
        (kg m²) The inertia of the brake. Allowed: > 0, ≤ 1e9.
    """

    input_speed_hz: float
    brake_torque_nm: float
    speed_fluctuation_hz: float
    speed_wander_percent: float
    torque_fluctuation_nm: float
    speed_profile_hz: Profile
    torque_profile_nm: Profile
    torque_ripple: Sequence[Ripple]
    brake_inertia_kgm2: float


class GearboxSensor(TypedDict, total=False):
    """An entry ``[[sensor]]`` of a gearbox.

    Attributes
    ----------
    at : str
        Where it sits: "SHAFT:AT" on the seat of the bearing there, "shaft:SHAFT:AT" on the shaft itself, "housing:[x,
        y, z]" in mm on the housing, "ring:SET:DEGREES" on the ring of a planetary set, with ":far" behind it away from
        the rim. Ignored by linear, published.
    name : str
        The sensor's name; its signal is the channel ``NAME_g``. Allowed: a letter, then letters, digits and ``_``; no
        other channel's.
    direction : {'radial', 'tangential', 'vertical', 'horizontal', 'axial'}
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
    direction: Literal["radial", "tangential", "vertical", "horizontal", "axial"]
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


SECTION_OF_KEY: dict[str, str] = {
    "module_mm": "gears",
    "pinion_teeth": "gears",
    "gear_teeth": "gears",
    "face_width_mm": "gears",
    "brake_torque_nm": "operation",
    "model": "",
    "seed": "",
    "pressure_angle_deg": "gears",
    "helix_angle_deg": "gears",
    "hand": "gears",
    "lead_crowning_um": "gears",
    "end_relief": "gears",
    "slices": "gears",
    "pinion_profile_shift": "gears",
    "gear_profile_shift": "gears",
    "pinion_addendum": "gears",
    "gear_addendum": "gears",
    "pinion_dedendum": "gears",
    "gear_dedendum": "gears",
    "centre_distance_mm": "gears",
    "material": "gears",
    "pinion_material": "gears",
    "gear_material": "gears",
    "flank_relief": "gears",
    "pinion_flank_relief": "gears",
    "gear_flank_relief": "gears",
    "tip_chamfer_mm": "gears",
    "pinion_tip_chamfer_mm": "gears",
    "gear_tip_chamfer_mm": "gears",
    "active_profile_shortening": "gears",
    "backlash_mm": "gears",
    "uniform_flank_reduction_mm": "gears",
    "points_per_tooth": "gears",
    "foundation": "gears",
    "pinion_speed_hz": "operation",
    "speed_fluctuation_hz": "operation",
    "speed_wander_percent": "operation",
    "torque_fluctuation_nm": "operation",
    "speed_profile_hz": "operation",
    "torque_profile_nm": "operation",
    "torque_ripple": "operation",
    "din_grade": "quality",
    "wheels_seed": "quality",
    "iso_class": "quality",
    "tooth_share": "quality",
    "pitch_share": "quality",
    "run_out_share": "quality",
    "helix_share": "quality",
    "pinion_cumulative_pitch_um": "quality",
    "pinion_run_out_um": "quality",
    "pinion_run_out_phase_rad": "quality",
    "pinion_helix_slope_um": "quality",
    "gear_cumulative_pitch_um": "quality",
    "gear_run_out_um": "quality",
    "gear_run_out_phase_rad": "quality",
    "gear_helix_slope_um": "quality",
    "bearing_stiffness_n_per_m": "rig",
    "wheel_rotational_stiffness_nm_per_rad": "rig",
    "brake_inertia_kgm2": "rig",
    "damping_ratio": "rig",
    "eccentricity_mm": "rig",
    "misalignment_um": "rig",
    "pinion_shaft": "rig",
    "gear_shaft": "rig",
    "pinion_inertia": "rig",
    "gear_inertia": "rig",
    "pinion_unbalance": "rig",
    "gear_unbalance": "rig",
    "support": "rig",
    "mesh_damping_ratio": "rig",
    "sampling_rate_hz": "solver",
    "duration_s": "solver",
    "pinion_revolutions": "solver",
    "settle_fraction": "solver",
    "settle_tolerance": "solver",
    "initial_displacement": "solver",
    "initial_velocity": "solver",
}
"""Which section of the scenario file each key stands in."""

KEY_IN_FILE: dict[str, str] = {"wheels_seed": "seed"}
"""Keys that are called otherwise in their section."""

REQUIRED_KEYS = (
    "module_mm",
    "pinion_teeth",
    "gear_teeth",
    "face_width_mm",
    "brake_torque_nm",
)
"""Keys without a default."""


class ScenarioChanges(TypedDict, total=False):
    """What ``Scenario.copy`` changes."""

    fault: Any
    faults: Any
    sensors: Any
    shafts: Any
    wheels: Any
    meshes: Any
    bearings: Any
    operation: Any
    housing: Any
    solver: Any
    module_mm: Any
    pinion_teeth: Any
    gear_teeth: Any
    face_width_mm: Any
    brake_torque_nm: Any
    model: Any
    seed: Any
    pressure_angle_deg: Any
    helix_angle_deg: Any
    hand: Any
    lead_crowning_um: Any
    end_relief: Any
    slices: Any
    pinion_profile_shift: Any
    gear_profile_shift: Any
    pinion_addendum: Any
    gear_addendum: Any
    pinion_dedendum: Any
    gear_dedendum: Any
    centre_distance_mm: Any
    material: Any
    pinion_material: Any
    gear_material: Any
    flank_relief: Any
    pinion_flank_relief: Any
    gear_flank_relief: Any
    tip_chamfer_mm: Any
    pinion_tip_chamfer_mm: Any
    gear_tip_chamfer_mm: Any
    active_profile_shortening: Any
    backlash_mm: Any
    uniform_flank_reduction_mm: Any
    points_per_tooth: Any
    foundation: Any
    pinion_speed_hz: Any
    speed_fluctuation_hz: Any
    speed_wander_percent: Any
    torque_fluctuation_nm: Any
    speed_profile_hz: Any
    torque_profile_nm: Any
    torque_ripple: Any
    din_grade: Any
    wheels_seed: Any
    iso_class: Any
    tooth_share: Any
    pitch_share: Any
    run_out_share: Any
    helix_share: Any
    pinion_profile_errors_mm: Any
    gear_profile_errors_mm: Any
    pinion_cumulative_pitch_um: Any
    pinion_run_out_um: Any
    pinion_run_out_phase_rad: Any
    pinion_helix_slope_um: Any
    gear_cumulative_pitch_um: Any
    gear_run_out_um: Any
    gear_run_out_phase_rad: Any
    gear_helix_slope_um: Any
    bearing_stiffness_n_per_m: Any
    wheel_rotational_stiffness_nm_per_rad: Any
    brake_inertia_kgm2: Any
    damping_ratio: Any
    eccentricity_mm: Any
    misalignment_um: Any
    pinion_shaft: Any
    gear_shaft: Any
    pinion_inertia: Any
    gear_inertia: Any
    pinion_unbalance: Any
    gear_unbalance: Any
    support: Any
    mesh_damping_ratio: Any
    sampling_rate_hz: Any
    duration_s: Any
    pinion_revolutions: Any
    settle_fraction: Any
    settle_tolerance: Any
    initial_displacement: Any
    initial_velocity: Any


class ScenarioKeys:
    """The arguments and attributes of a scenario."""

    __slots__ = ()

    module_mm: float
    pinion_teeth: int
    gear_teeth: int
    face_width_mm: float
    brake_torque_nm: float
    model: Literal["contact", "linear", "published"]
    seed: int
    pressure_angle_deg: float
    helix_angle_deg: float
    hand: Literal["right", "left"]
    lead_crowning_um: float
    end_relief: EndRelief
    slices: int
    pinion_profile_shift: float
    gear_profile_shift: float
    pinion_addendum: float
    gear_addendum: float
    pinion_dedendum: float
    gear_dedendum: float
    centre_distance_mm: float | None
    material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float]
    pinion_material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float] | None
    gear_material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float] | None
    flank_relief: FlankRelief | None
    pinion_flank_relief: FlankRelief | None
    gear_flank_relief: FlankRelief | None
    tip_chamfer_mm: float | None
    pinion_tip_chamfer_mm: float | None
    gear_tip_chamfer_mm: float | None
    active_profile_shortening: float
    backlash_mm: float | None
    uniform_flank_reduction_mm: float
    points_per_tooth: int
    foundation: Foundation
    pinion_speed_hz: float
    speed_fluctuation_hz: float
    speed_wander_percent: float
    torque_fluctuation_nm: float
    speed_profile_hz: dict[str, list[float]] | None
    torque_profile_nm: dict[str, list[float]] | None
    torque_ripple: Sequence[Ripple] | None
    din_grade: int
    wheels_seed: int | None
    iso_class: int
    tooth_share: float
    pitch_share: float
    run_out_share: float
    helix_share: float
    pinion_cumulative_pitch_um: list[float] | None
    pinion_run_out_um: float | None
    pinion_run_out_phase_rad: float | None
    pinion_helix_slope_um: float | None
    gear_cumulative_pitch_um: list[float] | None
    gear_run_out_um: float | None
    gear_run_out_phase_rad: float | None
    gear_helix_slope_um: float | None
    bearing_stiffness_n_per_m: float
    wheel_rotational_stiffness_nm_per_rad: float
    brake_inertia_kgm2: float
    damping_ratio: float | list[float]
    eccentricity_mm: float
    misalignment_um: float
    pinion_shaft: Shaft
    gear_shaft: Shaft
    pinion_inertia: WheelInertia | None
    gear_inertia: WheelInertia | None
    pinion_unbalance: Unbalance | None
    gear_unbalance: Unbalance | None
    support: Support
    mesh_damping_ratio: float
    sampling_rate_hz: float
    duration_s: float | None
    pinion_revolutions: float | None
    settle_fraction: float
    settle_tolerance: float
    initial_displacement: list[float] | None
    initial_velocity: list[float] | None

    def __init__(
        self,
        *,
        module_mm: float,
        pinion_teeth: int,
        gear_teeth: int,
        face_width_mm: float,
        brake_torque_nm: float,
        fault: Fault | None = None,
        faults: Sequence[Fault] | None = None,
        sensors: Sequence[Sensor] | None = None,
        model: Literal["contact", "linear", "published"] | None = None,
        seed: int | None = None,
        pressure_angle_deg: float | None = None,
        helix_angle_deg: float | None = None,
        hand: Literal["right", "left"] | None = None,
        lead_crowning_um: float | None = None,
        end_relief: EndRelief | None = None,
        slices: int | None = None,
        pinion_profile_shift: float | None = None,
        gear_profile_shift: float | None = None,
        pinion_addendum: float | None = None,
        gear_addendum: float | None = None,
        pinion_dedendum: float | None = None,
        gear_dedendum: float | None = None,
        centre_distance_mm: float | None = None,
        material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float] | None = None,
        pinion_material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float] | None = None,
        gear_material: Literal["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"] | Mapping[str, float] | None = None,
        flank_relief: FlankRelief | None = None,
        pinion_flank_relief: FlankRelief | None = None,
        gear_flank_relief: FlankRelief | None = None,
        tip_chamfer_mm: float | None = None,
        pinion_tip_chamfer_mm: float | None = None,
        gear_tip_chamfer_mm: float | None = None,
        active_profile_shortening: float | None = None,
        backlash_mm: float | None = None,
        uniform_flank_reduction_mm: float | None = None,
        points_per_tooth: int | None = None,
        foundation: Foundation | None = None,
        pinion_speed_hz: float | None = None,
        speed_fluctuation_hz: float | None = None,
        speed_wander_percent: float | None = None,
        torque_fluctuation_nm: float | None = None,
        speed_profile_hz: Profile | None = None,
        torque_profile_nm: Profile | None = None,
        torque_ripple: Sequence[Ripple] | None = None,
        din_grade: int | None = None,
        wheels_seed: int | None = None,
        iso_class: int | None = None,
        tooth_share: float | None = None,
        pitch_share: float | None = None,
        run_out_share: float | None = None,
        helix_share: float | None = None,
        pinion_profile_errors_mm: npt.ArrayLike | None = None,
        gear_profile_errors_mm: npt.ArrayLike | None = None,
        pinion_cumulative_pitch_um: Sequence[float] | None = None,
        pinion_run_out_um: float | None = None,
        pinion_run_out_phase_rad: float | None = None,
        pinion_helix_slope_um: float | None = None,
        gear_cumulative_pitch_um: Sequence[float] | None = None,
        gear_run_out_um: float | None = None,
        gear_run_out_phase_rad: float | None = None,
        gear_helix_slope_um: float | None = None,
        bearing_stiffness_n_per_m: float | None = None,
        wheel_rotational_stiffness_nm_per_rad: float | None = None,
        brake_inertia_kgm2: float | None = None,
        damping_ratio: float | Sequence[float] | None = None,
        eccentricity_mm: float | None = None,
        misalignment_um: float | None = None,
        pinion_shaft: Shaft | None = None,
        gear_shaft: Shaft | None = None,
        pinion_inertia: WheelInertia | None = None,
        gear_inertia: WheelInertia | None = None,
        pinion_unbalance: Unbalance | None = None,
        gear_unbalance: Unbalance | None = None,
        support: Support | None = None,
        mesh_damping_ratio: float | None = None,
        sampling_rate_hz: float | None = None,
        duration_s: float | None = None,
        pinion_revolutions: float | None = None,
        settle_fraction: float | None = None,
        settle_tolerance: float | None = None,
        initial_displacement: Sequence[float] | None = None,
        initial_velocity: Sequence[float] | None = None,
        **unknown: NoReturn,
    ) -> None:
        """A scenario; ``None`` is the default of a key.

        Parameters
        ----------
        module_mm : float
            (mm) The module of both wheels, of helical ones in the normal section. Allowed: > 0, ≤ 100.
        pinion_teeth, gear_teeth : int
            The tooth count. Allowed: whole number 6…10000; contact ratio at least 1; undercut (fewer than 17 at 20°) is
            not simulated, with a warning.
        face_width_mm : float
            (mm) The face width of both wheels. Allowed: > 0, ≤ 10000.
        brake_torque_nm : float
            (N m) The nominal torque of the brake on the gear's shaft, negative where it drives. Allowed: −1e9…1e9.
        fault : a fault, optional
            The damage, if there is but one; a healthy pair by default.
        faults : sequence of faults, optional
            All damage, instead of ``fault``: any number of faults, on any teeth of either wheel.
        sensors : sequence of Sensor, optional
            Sensors on the rig, whose signals come first; none by default.
        model : {'contact', 'linear', 'published'}, optional
            The model: teeth that touch and separate, a linear mesh that is always closed, or the published code with
            its known errors. Default: "contact".
        seed : int, optional
            The seed of every random draw: profile errors, fluctuations, roughness of a destroyed flank, sensors' noise.
            Allowed: whole number. Default: 1.
        pressure_angle_deg : float, optional
            (°) The pressure angle at the pitch circle, of helical wheels in the normal section. Allowed: 10…35; no
            teeth pointed below full height. Default: 20.0.
        helix_angle_deg : float, optional
            (°) The helix angle at the pitch circle; 0: spur wheels. Allowed: 0…45; 0, or at least 0.01; total contact
            ratio at most 12. Default: 0.0.
        hand : {'right', 'left'}, optional
            The hand of the pinion's helix; the gear's is the other one. Default: "right". Ignored by published.
        lead_crowning_um : float, optional
            (µm) The lead crowning of both wheels together: how much farther apart the flanks are at the ends of the
            face than at its middle. Allowed: ≥ 0, ≤ 1000. Default: 0.0. Ignored by linear, published.
        end_relief : EndRelief, optional
            The relief of the flanks towards both ends of the face, as a gap in µm. Default: { length_mm = 1.0,
            amount_um = 0.0 }. Ignored by linear, published.
        slices : int, optional
            The number of slices of the face where the gap of helical teeth, or of crowned ones, varies along it.
            Allowed: whole number 5…41. Default: 21. Ignored by published.
        pinion_profile_shift, gear_profile_shift : float, optional
            (-) The profile shift coefficient x, in modules. Allowed: −2…2; no undercut, no pointed tip. Default: 0.0.
        pinion_addendum, gear_addendum : float, optional
            (-) The addendum coefficient of the basic rack, in modules. Allowed: 0.3…2; tips not pointed, clear of the
            mating gear's fillets. Default: 1.0.
        pinion_dedendum, gear_dedendum : float, optional
            (-) The dedendum coefficient of the basic rack, in modules. Allowed: 0.5…2.5; roots clear of the mating
            gear's tips. Default: 1.25.
        centre_distance_mm : float, optional
            (mm) The distance between the axes. Allowed: > 0; at least the default; contact ratio at least 1. Default:
            that without backlash.
        material : {'steel', 'copper', 'aluminium', 'brass', 'cast-iron', 'bronze'} or dict, optional
            The material of wheels and shafts. Default: "steel".
        pinion_material, gear_material : {'steel', 'copper', 'aluminium', 'brass', 'cast-iron', 'bronze'} or dict, optional
            The material of this wheel alone, its body and teeth. Default: gears.material. Ignored by published.
        flank_relief : FlankRelief, optional
            The relief of the flanks near the tips, as a gap in µm. Default: { shape = "parabolic", length_mm = 1.0,
            amount_um = 0.0 }. Ignored by published.
        pinion_flank_relief, gear_flank_relief : FlankRelief, optional
            The value of this wheel alone, where they differ. Default: that of both wheels. Ignored by published.
        tip_chamfer_mm : float, optional
            (mm) The height of the chamfer or rounding of all tips. Allowed: ≥ 0; less than 1 module. Default: 0.23
            modules. Ignored by published.
        pinion_tip_chamfer_mm, gear_tip_chamfer_mm : float, optional
            (mm) The value of this wheel alone, where they differ. Allowed: ≥ 0; less than 1 module. Default: that of
            both wheels. Ignored by published.
        active_profile_shortening : float, optional
            (-) The shortening of the path of contact against that between the chamfers, in base pitches, half of it at
            the tips of either wheel. Allowed: 0…0.5. Default: 0.1. Ignored by linear, published.
        backlash_mm : float, optional
            (mm) The backlash along the line of action. Allowed: ≥ 0; less than 1 module; at least that of a given
            centre distance. Default: ⅔ (0.06 + 0.0005 a + 0.03 m), a the centre distance, plus the backlash of a given
            one. Ignored by linear, published.
        uniform_flank_reduction_mm : float, optional
            (mm) A constant reduction of the working flank. Allowed: ≥ 0; less than π/4 modules, half the tooth's
            thickness. Default: 0.0.
        points_per_tooth : int, optional
            The number of points along a tooth's profile. Allowed: whole number 500…1000000. Default: 10000.
        foundation : Foundation, optional
            The coefficients A to F of the four polynomials of the fillet foundation's compliance, by Sainsot, Velex and
            Duverger (2004). Ignored by published.
        pinion_speed_hz : float, optional
            (rev/s) The nominal speed of the motor and the pinion; the sampling rate is chosen for it. Allowed: > 0, ≤
            100000. Required, unless ``speed_profile_hz`` is given.
        speed_fluctuation_hz : float, optional
            (Hz) The amplitude of the uniform random error of every sample's speed. Allowed: ≥ 0; less than the lowest
            speed. Default: 0.0.
        speed_wander_percent : float, optional
            (%) The standard deviation of a slow random wander of the speed, below about 8 Hz; a recorded machine has
            0.03 %. Allowed: 0…10. Default: 0.0.
        torque_fluctuation_nm : float, optional
            (N m) The amplitude of the uniform random error of every sample's torque. Allowed: ≥ 0; less than the lowest
            torque. Default: 0.0.
        speed_profile_hz : dict of time_s and value, optional
            (s, Hz) The speed against time from the start of the kept signal, which ends with it, { time_s = […], value
            = […] }, straight between the points, constant outside them; or { file = "….csv" } with the columns time_s
            and value. Allowed: at least 2 points, times increasing, values > 0. Default: none. Ignored by published.
        torque_profile_nm : dict of time_s and value, optional
            (s, N m) The torque against time, likewise. Allowed: likewise, values of one sign. Default: none.
        torque_ripple : sequence of Ripple, optional
            Harmonics of the brake's torque over the rotation θ of a shaft, T (1 + Σ a cos(hθ + ψ)). Allowed: amplitudes
            add up to 1.2 at most. Default: none. Ignored by published.
        din_grade : int, optional
            The grade of DIN 3961 of the deviations, 1 (best) to 12; 0: ideal teeth. Allowed: whole number 0…12.
            Default: 0.
        wheels_seed : int, optional
            The seed of the wheels alone, for several scenarios of the same wheels. Allowed: whole number. Default: the
            scenario's ``seed``.
        iso_class : int, optional
            The class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none. Allowed:
            whole number 0…11. Default: 0. Ignored by published.
        tooth_share : float, optional
            (-) The part of the tolerances of profile slope and form that each tooth has of its own; the rest is common
            to a wheel's teeth. Allowed: 0…1. Default: 0.5. Ignored by published.
        pitch_share : float, optional
            (-) A wheel's largest single pitch deviation over its tolerance f_p. Allowed: 0…1. Default: 0.25. Ignored by
            published.
        run_out_share : float, optional
            (-) A wheel's run-out over its tolerance F_r. Allowed: 0…1. Default: 0.3. Ignored by published.
        helix_share : float, optional
            (-) A wheel's largest helix slope deviation, of either sign, over its tolerance f_Hβ. Allowed: 0…1. Default:
            0.0. Ignored by linear, published.
        pinion_profile_errors_mm, gear_profile_errors_mm : array of float64, shape (100, teeth), optional
            (mm) The profile errors, instead of a draw: 100 rows of one number a tooth. Allowed: 100 × teeth, each below
            the module. Default: none.
        pinion_cumulative_pitch_um, gear_cumulative_pitch_um : sequence of floats, optional
            (µm) The working flanks' cumulative pitch deviations along the pitch circle, positive where metal is added;
            they are added to given profile errors. Allowed: one a tooth, each below the module. Default: drawn, or none
            beside given profile errors.
        pinion_run_out_um, gear_run_out_um : float, optional
            (µm) The run-out F_r, of which the deviation is F_r/2 sin(θ + φ). Allowed: ≥ 0, ≤ 10000. Default: drawn, or
            none beside given profile errors or pitches, which contain it. Ignored by published.
        pinion_run_out_phase_rad, gear_run_out_phase_rad : float, optional
            (rad) Its phase φ; θ counts from where the wheel's first tooth enters contact. Default: drawn, or 0 beside
            given profile errors. Ignored by published.
        pinion_helix_slope_um, gear_helix_slope_um : float, optional
            (µm) The helix slope deviation over the face width, positive where metal is added towards positive z.
            Allowed: −1000…1000. Default: drawn, or none beside given profile errors. Ignored by linear, published.
        bearing_stiffness_n_per_m : float, optional
            (N/m) The stiffness of each wheel's bearings in x, y and z. Allowed: > 0, ≤ 1e15. Default: 1.9e8. Ignored by
            published.
        wheel_rotational_stiffness_nm_per_rad : float, optional
            (N m/rad) The tilting stiffness of each wheel, about x and about y. Allowed: > 0, ≤ 1e15. Default: 1e8.
            Ignored by contact. Accepted by published only; linear refuses it.
        brake_inertia_kgm2 : float, optional
            (kg m²) The inertia of the brake. Allowed: > 0, ≤ 1e9. Default: 0.0045.
        damping_ratio : float or sequence of 13 floats, optional
            (-) The modal damping ratio: one for all modes, or 13 by rising frequency. Allowed: ≥ 0, < 1. Default: 0.05.
            Ignored by contact. Several values are accepted by published only; linear refuses them.
        eccentricity_mm : float, optional
            (mm) The eccentricity of both wheels. Allowed: ≥ 0; less than the module. Default: 0.0. Ignored by
            published.
        misalignment_um : float, optional
            (µm) The misalignment of the shafts in the plane of action over the face width, including their slope under
            the nominal load; positive where flanks come closer towards positive z. The tilt by an uneven load is
            computed. Allowed: −1000…1000. Default: 0.0. Ignored by linear, published.
        pinion_shaft : Shaft, optional
            The shaft to motor (pinion) or brake (gear). Default: { length_mm = 200.0, radius_mm = 10.0, bearing_span_mm
            = 130.0, wheel_at = 0.5, damping_ratio = 0.025 }.
        gear_shaft : Shaft, optional
            The shaft to motor (pinion) or brake (gear). Default: { length_mm = 600.0, radius_mm = 10.0, bearing_span_mm
            = 130.0, wheel_at = 0.5, damping_ratio = 0.025 }.
        pinion_inertia, gear_inertia : WheelInertia, optional
            The wheel's mass and inertias, any of the three. Default: those of a solid disc of pitch radius.
        pinion_unbalance, gear_unbalance : Unbalance, optional
            The unbalance of the wheel and its shaft. Default: none. Ignored by published.
        support : Support, optional
            The supports of the shafts' bearings. Default: { mass_kg = 2.3, base_hz = 450.0, differential_hz = 2900.0,
            damping_ratio = 0.025 }. Ignored by linear, published.
        mesh_damping_ratio : float, optional
            (-) The damping of teeth in contact, relative to the critical damping of the wheels' rotation on the mean
            mesh stiffness. Allowed: ≥ 0, < 1. Default: 0.15. Ignored by published.
        sampling_rate_hz : float, optional
            (S/s) The nominal sampling rate; the actual one is the next at which a whole number of samples passes from
            one pair of teeth to the next. Allowed: > 0. Default: 1e5.
        duration_s : float, optional
            (s) The length of the kept signal; settling comes before it. Allowed: > 0; not beside pinion_revolutions.
            Default: see pinion_revolutions.
        pinion_revolutions : float, optional
            (-) The same as a number of revolutions of the pinion; settling comes before them. Allowed: > 0; not beside
            duration_s, not with a speed profile. Default: 2 z_g revolutions less settling, or as long as a profile.
        settle_fraction : float, optional
            (-) The part of the simulated time that is discarded from the start, while the vibration settles. Allowed: ≥
            0, < 1. Default: 0.5.
        settle_tolerance : float, optional
            (-) The fraction of the slowest mode's transient that may remain where the kept signal starts: a steady
            simulation starts in equilibrium and simulates only as much of the discarded part as this needs; 0: all of
            it, as always under published. Allowed: ≥ 0, < 1. Default: 1e-6.
        initial_displacement : sequence of 13 floats, optional
            (m, rad) The displacement at the start: x, y of the gear, x, y of the pinion, rotation of gear, pinion and
            brake, z of gear and pinion, tilt φ of both, tilt ψ of both. Default: the loaded mesh's equilibrium; zeros
            under published. Ignored by contact. Accepted by published only; linear refuses it.
        initial_velocity : sequence of 13 floats, optional
            (m/s, rad/s) The velocity of the same at the start. Default: rigid rotation at the nominal speed.

        Raises
        ------
        ValueError
            A value that is not allowed: the text names the key, the value and what is allowed.
        TypeError
            A key that a scenario does not have.
        """
        arguments = dict(locals())
        del arguments["self"], arguments["unknown"]
        self._from_keys(arguments, unknown)

    def _from_keys(self, arguments: dict[str, Any], unknown: dict[str, Any]) -> None:
        raise NotImplementedError
