"""Teeth that part, in a machine assembled by ROSS and integrated by SciPy.

ROSS 2.3.0 knows neither backlash nor teeth that part: its mesh adds a stiffness, constant or over the angle, to the matrix of the
machine. So the machine is its own, shafts, bearings, supports, wheels and the direction of the mesh, and the gap is closed here, by an
eighth-order Runge-Kutta method with an error of 1e-8 in each step. Of Meshtone there is only the stiffness of a pair over its path.

Writes what the tests compare Meshtone with, and prints the comparison:

    pip install ross-rotordynamics==2.3.0 "plotly<6" meshtone
    python python/validation/ross_backlash.py python/tests/references

Takes some minutes.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import ross as rs
import scipy
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.linalg import eigh
from scipy.optimize import brentq

import meshtone as mt

Array = npt.NDArray[np.float64]

# The pair, in SI units.
MODULE, PINION_TEETH, GEAR_TEETH, FACE_WIDTH, PRESSURE_ANGLE = 3e-3, 17, 38, 15e-3, math.radians(20)
YOUNGS_MODULUS, POISSON_RATIO, DENSITY = 210e9, 0.3, 7840.0
# The machine.
SPEED_HZ = 40.0
SHAFT_RADIUS, BEARING_SPAN, PINION_SHAFT, GEAR_SHAFT = 10e-3, 130e-3, 200e-3, 600e-3
BEARING_STIFFNESS, BRAKE_INERTIA = 1.9e8, 4.5e-3
SUPPORT_MASS, SUPPORT_STIFFNESS, SUPPORT_COUPLING = 1.6, 1.6e8, 5e8
DAMPING_RATIO, MESH_DAMPING_RATIO = 0.025, 0.15

DURATION_S = 0.05
REACH = 0.6
"""Base pitches before and after its path in which a pair may touch with a tip corner."""
STORED = 500
"""Instants of each signal that are kept for the tests."""
WINDOW_S = (15e-3, 16.6e-3)
"""A part in which the mesh force is kept every 4 µs, to be looked at."""

SCENARIO = """\
model = "contact"

[gears]
foundation = {{ rotation = "tooth" }}
module_mm = 3.0
pinion_teeth = 17
gear_teeth = 38
face_width_mm = 15.0
tip_chamfer_mm = 0.0
active_profile_shortening = 0.0
backlash_mm = {backlash_mm}

[operation]
pinion_speed_hz = 40.0
brake_torque_nm = {torque_nm}
{profiles}
[rig]
eccentricity_mm = {eccentricity_mm}
bearing_stiffness_n_per_m = 1.9e8
brake_inertia_kgm2 = 4.5e-3
mesh_damping_ratio = 0.15
pinion_shaft = {{ length_mm = 200.0, radius_mm = 10.0, bearing_span_mm = 130.0, wheel_at = 0.5, damping_ratio = 0.025 }}
gear_shaft = {{ length_mm = 600.0, radius_mm = 10.0, bearing_span_mm = 130.0, wheel_at = 0.5, damping_ratio = 0.025 }}
support = {{ mass_kg = 1.6, stiffness_n_per_m = 1.6e8, coupling_n_per_m = 5e8, damping_ratio = 0.025 }}

[[sensor]]
at = "support"
path = {{ plate_hz = 0.0 }}

[solver]
sampling_rate_hz = {rate}
settle_fraction = 0.0
settle_tolerance = 0.0
"""


@dataclass(frozen=True)
class Case:
    """What differs from one comparison to the next."""

    backlash_mm: float
    eccentricity_mm: float
    torque_nm: float
    """At the start, and throughout where it does not swing."""
    swing_nm: float = 0.0
    """Amplitude of a triangle of 100 Hz about it."""

    def torque(self, time_s: float) -> float:
        """(N m) Torque of the brake."""
        return self.torque_nm + self.swing_nm * float(np.interp((time_s % 0.01) / 0.01, [0, 0.25, 0.75, 1], [0, 1, -1, 0]))

    def scenario(self, rate: float) -> str:
        """The same for Meshtone."""
        profiles = ""
        if self.swing_nm:
            corners = [0.0, *(0.0025 + 0.005 * n for n in range(40))]
            values = [self.torque(corner) for corner in corners]
            profiles = (
                f"torque_profile_nm = {{ time_s = {[round(corner, 6) for corner in corners]}, value = {values} }}\n"
                "speed_profile_hz = { time_s = [0.0, 0.2], value = [40.0, 40.0] }\n"
            )
        return SCENARIO.format(
            backlash_mm=self.backlash_mm,
            eccentricity_mm=self.eccentricity_mm,
            torque_nm=self.torque_nm,
            profiles=profiles,
            rate=rate,
        )


CASES = {
    "closed": Case(backlash_mm=0.1, eccentricity_mm=0.0, torque_nm=100.0),
    "apart": Case(backlash_mm=1.0, eccentricity_mm=0.05, torque_nm=0.3),
    "both flanks": Case(backlash_mm=0.005, eccentricity_mm=0.05, torque_nm=1.0),
    "swinging load": Case(backlash_mm=0.005, eccentricity_mm=0.0, torque_nm=2.0, swing_nm=2.0),
}


@dataclass(frozen=True)
class Machine:
    """The modes of the machine without the mesh, of unit modal mass."""

    angular_frequency: Array
    along_mesh: Array
    """Movement along the line of action; positive presses the drive flanks together."""
    brake: Array
    """Rotation of the brake, in the direction of its torque."""
    vertical: Array
    """Vertical movement of the two supports, their mean."""
    closed_hz: Callable[[float], Array]
    """(Hz) Natural frequencies with a closed mesh of a stiffness."""


def rotor(teeth: int, shaft: float, brake: bool, supported: bool) -> rs.Rotor:
    """A wheel midway between two bearings on a shaft without mass that goes on to motor or brake, in a support or on the base."""
    radius = MODULE * teeth / 2
    mass = DENSITY * math.pi * radius**2 * FACE_WIDTH
    # Meshtone's shafts have no mass and bend as Bernoulli's beam does; ROSS asks for a density.
    material = rs.Material(name="massless", rho=1e-9, E=YOUNGS_MODULUS, Poisson=POISSON_RATIO)
    lengths = [BEARING_SPAN / 2, BEARING_SPAN / 2, shaft - BEARING_SPAN / 2]
    beams = [
        rs.ShaftElement(
            L=length, idl=0, odl=2 * SHAFT_RADIUS, material=material, shear_effects=False, rotary_inertia=False, gyroscopic=False
        )
        for length in lengths
    ]
    disks = [
        rs.GearElement(
            n=1,
            m=mass,
            Id=mass * (3 * radius**2 + FACE_WIDTH**2) / 12,
            Ip=mass * radius**2 / 2,
            n_teeth=teeth,
            pitch_diameter=2 * radius,
            pr_angle=PRESSURE_ANGLE,
        )
    ]
    if brake:
        disks.append(rs.DiskElement(n=3, m=1e-9, Id=1e-12, Ip=BRAKE_INERTIA))
    half = {"kxx": BEARING_STIFFNESS / 2, "kzz": BEARING_STIFFNESS / 2, "cxx": 0}
    if not supported:
        return rs.Rotor(beams, disks, [rs.BearingElement(n=node, **half) for node in (0, 2)])
    bearings = [rs.BearingElement(n=node, n_link=4, **half) for node in (0, 2)]
    base = rs.BearingElement(n=4, kxx=SUPPORT_STIFFNESS, kzz=SUPPORT_STIFFNESS, cxx=0)
    return rs.Rotor(beams, disks, [*bearings, base], [rs.PointMass(n=4, m=SUPPORT_MASS)])


def mesh_direction() -> tuple[Array, Array]:
    """Direction of the mesh in the six coordinates of the pinion and of the gear, from ROSS's coupling matrix of stiffness one.

    ROSS counts the driven wheel's rotation against the driving one's.
    """
    # With supports, two rotors of ROSS do not go into one: it counts six coordinates at a node where a support has three.
    pair = rs.MultiRotor(
        rotor(PINION_TEETH, PINION_SHAFT, False, False),
        rotor(GEAR_TEETH, GEAR_SHAFT, True, False),
        coupled_nodes=(1, 1),
        gear_mesh_stiffness=1.0,
        orientation_angle=math.pi,
    )
    values, vectors = np.linalg.eigh(pair.coupling_matrix())
    direction = vectors[:, -1] * math.sqrt(values[-1])
    # Drive flanks meet where the gear moves up.
    direction *= np.sign(direction[7])
    return direction[:6], direction[6:]


def machine() -> Machine:
    """Both rotors of ROSS, with the supports' coupling between them."""
    rotors = [rotor(PINION_TEETH, PINION_SHAFT, False, True), rotor(GEAR_TEETH, GEAR_SHAFT, True, True)]
    size = rotors[0].ndof
    stiffness, mass, line = np.zeros((2 * size, 2 * size)), np.zeros((2 * size, 2 * size)), np.zeros(2 * size)
    for n, (own, direction) in enumerate(zip(rotors, mesh_direction())):
        block = slice(n * size, (n + 1) * size)
        stiffness[block, block], mass[block, block] = own.K(0), own.M(0)
        line[n * size + 6 : n * size + 12] = direction
    for axis in (0, 1):
        both = [size - 3 + axis, 2 * size - 3 + axis]
        stiffness[np.ix_(both, both)] += SUPPORT_COUPLING * np.array([[1, -1], [-1, 1]])
    # Of each rotor: x, y, both tilts and rotation of the wheel, x and y of the support; then the brake's rotation. Nothing moves along
    # the shafts.
    own_kept = [6, 7, 9, 10, 11, size - 3, size - 2]
    brake = size + 6 * 3 + 5
    kept = [*own_kept, *(size + n for n in own_kept), brake]
    # The motor turns steadily; displacements count from that rotation.
    motor = 6 * 3 + 5
    massless = [n for n in range(2 * size) if n not in kept and n != motor]
    to_massless = stiffness[np.ix_(kept, massless)]
    reduced = stiffness[np.ix_(kept, kept)] - to_massless @ np.linalg.solve(stiffness[np.ix_(massless, massless)], to_massless.T)
    masses = np.diag(np.diag(mass[np.ix_(kept, kept)]))
    line = line[kept]

    def closed_hz(mesh_stiffness: float) -> Array:
        squares = eigh(reduced + mesh_stiffness * np.outer(line, line), masses, eigvals_only=True)
        return np.asarray(np.sqrt(squares) / (2 * math.pi))

    squares, shapes = eigh(reduced, masses)
    # Nothing holds the driven train but the mesh.
    squares[0] = 0
    supports = shapes[kept.index(size - 2)], shapes[kept.index(2 * size - 2)]
    return Machine(
        angular_frequency=np.sqrt(squares),
        along_mesh=shapes.T @ line,
        brake=np.sign(line[kept.index(size + 11)]) * shapes[-1],
        vertical=(supports[0] + supports[1]) / 2,
        closed_hz=closed_hz,
    )


def radii(teeth: int) -> tuple[float, float]:
    """(m) Base and tip radius."""
    pitch = MODULE * teeth / 2
    return pitch * math.cos(PRESSURE_ANGLE), pitch + MODULE


PINION_BASE, PINION_TIP = radii(PINION_TEETH)
GEAR_BASE, GEAR_TIP = radii(GEAR_TEETH)
LINE = (PINION_BASE + GEAR_BASE) * math.tan(PRESSURE_ANGLE)
BASE_PITCH = math.pi * MODULE * math.cos(PRESSURE_ANGLE)
CONTACT_RATIO = (math.sqrt(PINION_TIP**2 - PINION_BASE**2) + math.sqrt(GEAR_TIP**2 - GEAR_BASE**2) - LINE) / BASE_PITCH


def corner_separation(outside: Array, own_base: float, own_tip: float, mate_base: float) -> Array:
    """(m) How far a tip corner is from the mate's flank, by the arc on the base circles by which it is outside the path."""
    outside = np.maximum(outside, 0)
    own = math.sqrt(own_tip**2 - own_base**2)
    sine, cosine = np.sin(outside / own_base), np.cos(outside / own_base)
    x = LINE - own * cosine - own_base * sine
    y = own_base + own * sine - own_base * cosine + mate_base
    tangent = np.sqrt(np.maximum(x**2 + y**2 - mate_base**2, 0))
    turned = np.arctan2(y, x) + np.arctan2(tangent, mate_base) - math.pi / 2
    return np.asarray(tangent - mate_base * turned - (LINE - own) + outside)


@dataclass(frozen=True)
class Mesh:
    """Stiffness and separation of a pair over its position, and what all pairs have in common."""

    stiffness: Array
    separation: Array
    slope: Array
    """(m per base pitch) Of the separation."""
    mean_stiffness: float
    damping_time: float

    STEPS = 40_000

    @classmethod
    def of(cls, pair_stiffness: CubicSpline) -> Mesh:
        """From the stiffness over a pair's path."""
        position = np.linspace(-REACH, CONTACT_RATIO + REACH, cls.STEPS + 1)
        before = corner_separation(-position * BASE_PITCH, GEAR_BASE, GEAR_TIP, PINION_BASE)
        after = corner_separation((position - CONTACT_RATIO) * BASE_PITCH, PINION_BASE, PINION_TIP, GEAR_BASE)
        mean = float(pair_stiffness.integrate(0, CONTACT_RATIO))
        inertia = [DENSITY * math.pi * (MODULE * teeth / 2) ** 4 * FACE_WIDTH / 2 for teeth in (PINION_TEETH, GEAR_TEETH)]
        mesh_mass = 1 / (PINION_BASE**2 / inertia[0] + GEAR_BASE**2 / inertia[1])
        return cls(
            stiffness=pair_stiffness(np.clip(position, 0, CONTACT_RATIO)),
            separation=before + after,
            slope=np.gradient(before + after, position),
            mean_stiffness=mean,
            damping_time=2 * MESH_DAMPING_RATIO * math.sqrt(mesh_mass / mean),
        )

    def force(self, case: Case, time_s: float, deflection: float, velocity: float) -> float:
        """(N) Force of drive and coast flanks."""
        turn = 2 * math.pi * SPEED_HZ
        gear_turn = turn * PINION_TEETH / GEAR_TEETH
        phase, gear_phase = turn * time_s + PRESSURE_ANGLE, gear_turn * time_s + PRESSURE_ANGLE
        eccentricity = 1e-3 * case.eccentricity_mm
        deviation = eccentricity * (math.sin(gear_phase) - math.sin(phase))
        deviation_rate = eccentricity * (gear_turn * math.cos(gear_phase) - turn * math.cos(phase))
        pressed = deflection + self.damping_time * velocity
        back = -1e-3 * case.backlash_mm - pressed
        force = -self.mean_stiffness * back if back > 0 else 0.0
        pitches_hz = SPEED_HZ * PINION_TEETH
        latest = math.floor(pitches_hz * time_s + REACH)
        for pair in (latest, latest - 1, latest - 2):
            at = (pitches_hz * time_s - pair + REACH) / (CONTACT_RATIO + 2 * REACH) * self.STEPS
            n = int(at)
            if not 0 <= n < self.STEPS:
                continue
            part = at - n
            separation = self.separation[n] + part * (self.separation[n + 1] - self.separation[n])
            slope = self.slope[n] + part * (self.slope[n + 1] - self.slope[n])
            offset = deviation - separation + self.damping_time * (deviation_rate - pitches_hz * slope)
            if pressed + offset > 0:
                force += (self.stiffness[n] + part * (self.stiffness[n + 1] - self.stiffness[n])) * (pressed + offset)
        return float(force)


@dataclass(frozen=True)
class Motion:
    """The signals that are compared."""

    time_s: Array
    mesh_force_n: Array
    vertical_g: Array

    def figures(self) -> dict[str, float]:
        """Figures of the whole motion."""
        return {
            "mean_force_n": float(self.mesh_force_n.mean()),
            "force_fluctuation_n": float(self.mesh_force_n.std()),
            "largest_force_n": float(np.abs(self.mesh_force_n).max()),
            "acceleration_rms_g": float(np.sqrt(np.mean(self.vertical_g**2))),
            "apart_fraction": float(np.mean(self.mesh_force_n == 0)),
            "back_flank_fraction": float(np.mean(self.mesh_force_n < 0)),
        }

    def difference(self, other: Motion) -> tuple[float, float]:
        """Rms of the difference of both signals over the fluctuation of the own ones."""
        force = np.interp(self.time_s, other.time_s, other.mesh_force_n) - self.mesh_force_n
        acceleration = np.interp(self.time_s, other.time_s, other.vertical_g) - self.vertical_g
        return float(np.std(force) / np.std(self.mesh_force_n)), float(np.std(acceleration) / np.std(self.vertical_g))


def integrate(machine: Machine, mesh: Mesh, case: Case, tolerance: float) -> Motion:
    """The motion from rest relative to the rigid rotation, deformed as under the load at the start."""
    squares = machine.angular_frequency**2
    damping = 2 * DAMPING_RATIO * machine.angular_frequency
    line, brake, size = machine.along_mesh, machine.brake, squares.size
    static_n = case.torque_nm / GEAR_BASE
    elastic = squares > 0
    start = np.zeros(2 * size)
    start[:size][elastic] = (brake * case.torque_nm - line * static_n)[elastic] / squares[elastic]
    touching = brentq(lambda deflection: mesh.force(case, 0, deflection, 0) - static_n, -1e-4, 1e-3, xtol=1e-17)
    start[0] = (touching - line @ start[:size]) / line[0]

    def slope(time_s: float, state: Array) -> Array:
        force = mesh.force(case, time_s, float(line @ state[:size]), float(line @ state[size:]))
        acceleration = brake * case.torque(time_s) - line * force - damping * state[size:] - squares * state[:size]
        return np.concatenate([state[size:], acceleration])

    time_s = np.linspace(0, DURATION_S, 50_001)
    solved = solve_ivp(
        slope, (0, DURATION_S), start, method="DOP853", t_eval=time_s, rtol=tolerance, atol=1e-5 * tolerance, max_step=5e-6
    )
    states = solved.y.T
    return Motion(
        time_s=time_s,
        mesh_force_n=np.array([mesh.force(case, t, float(line @ s[:size]), float(line @ s[size:])) for t, s in zip(time_s, states)]),
        vertical_g=np.array([machine.vertical @ slope(t, s)[size:] / 9.81 for t, s in zip(time_s, states)]),
    )


def simulated(case: Case, rate: float) -> Motion:
    """Meshtone's motion."""
    simulation = mt.simulate(mt.Scenario.from_toml(case.scenario(rate)))
    count = int(DURATION_S * simulation.sampling_rate_hz) + 2
    return Motion(simulation.time_s[:count], simulation.mesh_force_n[:count], simulation.sensors["support_vertical"][:count])


def main() -> None:
    """Compares, prints, writes."""
    simulation = mt.simulate(mt.Scenario.from_toml(CASES["closed"].scenario(1e5)))
    stiffness = 1e3 * simulation.pair_stiffness_healthy_n_per_mm
    # Points of the path from its start on; the last one is short of its end.
    fine_points_per_pitch = simulation.fields["pair_stiffness_len"] / CONTACT_RATIO
    every = math.ceil(simulation.fields["pair_stiffness_len"] / stiffness.size)
    own, mesh = machine(), Mesh.of(CubicSpline(np.arange(stiffness.size) * every / fine_points_per_pitch, stiffness))
    frequencies = own.closed_hz(mesh.mean_stiffness)
    open_hz = own.angular_frequency[1:] / (2 * math.pi)
    nearest = [float(np.abs(simulation.natural_frequencies_hz / f - 1).min()) for f in frequencies]
    print(f"natural frequencies with a closed mesh: {frequencies.round(2).tolist()} Hz, Meshtone's within {max(nearest):.1e}")
    stored: dict[str, Any] = {}
    for name, case in CASES.items():
        reference = integrate(own, mesh, case, 1e-8)
        finer = reference.difference(integrate(own, mesh, case, 1e-10))
        print(f"{name}: {reference.figures()}\n  tolerance 1e-8 and 1e-10: force {finer[0]:.1e}, acceleration {finer[1]:.1e}")
        for rate in (1e5, 4e5, 1.6e6, 6.4e6):
            motion = simulated(case, rate)
            force, acceleration = reference.difference(motion)
            actual = 1 / (motion.time_s[1] - motion.time_s[0])
            within = motion.time_s <= DURATION_S
            figures = Motion(motion.time_s[within], motion.mesh_force_n[within], motion.vertical_g[within]).figures()
            print(f"  {actual:.0f} S/s: force {force:.2e}, acceleration {acceleration:.2e}\n    {figures}")
        kept = slice(None, None, reference.time_s.size // STORED)
        window = [int(np.searchsorted(reference.time_s, end - 1e-9)) for end in WINDOW_S]
        stored[name] = {
            "scenario": case.scenario(1.6e6),
            "figures": reference.figures(),
            "time_s": [float(f"{value:.9g}") for value in reference.time_s[kept]],
            "mesh_force_n": [float(f"{value:.6g}") for value in reference.mesh_force_n[kept]],
            "vertical_g": [float(f"{value:.6g}") for value in reference.vertical_g[kept]],
            "window_s": WINDOW_S,
            "window_mesh_force_n": [float(f"{value:.6g}") for value in reference.mesh_force_n[window[0] : window[1] + 1 : 4]],
        }
    provenance = (
        f"python/validation/ross_backlash.py: matrices of ROSS {rs.__version__}, SciPy {scipy.__version__} DOP853 at a relative "
        f"tolerance of 1e-8; pair stiffness over the path of Meshtone {mt.__version__}"
    )
    lines = [f'"provenance": {json.dumps(provenance)}', f'"natural_frequencies_without_mesh_hz": {open_hz.tolist()}']
    for name, case_stored in stored.items():
        fields = ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in case_stored.items())
        lines.append(f"{json.dumps(name)}: {{\n{fields}\n}}")
    Path(*sys.argv[1:2], "ross_backlash.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
