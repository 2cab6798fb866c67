"""Which section of the scenario file each key stands in."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

SECTION_OF_KEY: dict[str, str] = {
    key: section
    for section, keys in {
        "": ("model", "seed"),
        "gears": (
            "module_mm",
            "pinion_teeth",
            "gear_teeth",
            "face_width_mm",
            "pressure_angle_deg",
            "material",
            "tip_relief",
            "crowning_mm",
            "points_per_tooth",
            "foundation",
        ),
        "operation": (
            "pinion_speed_hz",
            "brake_torque_nm",
            "speed_fluctuation_hz",
            "torque_fluctuation_nm",
            "speed_profile_hz",
            "torque_profile_nm",
        ),
        "quality": ("din_grade", "wheels_seed"),
        "rig": (
            "bearing_stiffness_n_per_m",
            "wheel_rotational_stiffness_nm_per_rad",
            "brake_inertia_kgm2",
            "damping_ratio",
            "eccentricity_mm",
            "pinion_shaft",
            "gear_shaft",
            "pinion_inertia",
            "gear_inertia",
        ),
        "solver": (
            "sampling_rate_hz",
            "settle_fraction",
            "settle_tolerance",
            "initial_displacement",
            "initial_velocity",
        ),
    }.items()
    for key in keys
}

KEY_IN_FILE: dict[str, str] = {"wheels_seed": "seed"}
"""Keys that are called otherwise in their section of the scenario file: two sections have a ``seed``."""

OTHER_ARGUMENTS = ("fault", "faults", "pinion_profile_errors_mm", "gear_profile_errors_mm")


FORMER_KEYS: dict[str, str] = {
    "convention": "is called 'model' now, and its value 'corrected' is called 'linear'",
}
"""What has become of keys that a scenario had before."""


def hint(name: str, known: Iterable[str]) -> str:
    """The known name that is meant, to be put behind an error; empty if none is near."""
    near = difflib.get_close_matches(name, known, n=1)
    return f"; did you mean '{near[0]}'?" if near else ""


def check_key(key: str) -> None:
    """Refuse a key that a scenario does not have."""
    if key in FORMER_KEYS:
        raise TypeError(f"'{key}' {FORMER_KEYS[key]}")
    known = [*SECTION_OF_KEY, *OTHER_ARGUMENTS]
    if key not in known:
        raise TypeError(f"a scenario has no key '{key}'{hint(key, known) or '; it has ' + ', '.join(known)}")
