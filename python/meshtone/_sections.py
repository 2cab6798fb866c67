"""Names that a scenario has or does not have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ._keys import SECTION_OF_KEY
from ._names import hint

OTHER_ARGUMENTS = ("fault", "faults", "sensors", "pinion_profile_errors_mm", "gear_profile_errors_mm")


def with_whole_numbers(entries: Mapping[str, Any], types: Mapping[str, str]) -> dict[str, Any]:
    """The same entries, with whole numbers where a key is one and computing made a float of it; others are left to be refused.

    Parameters
    ----------
    entries : mapping
        Numbers, lists and so on, by their keys.
    types : mapping of str to str
        What each key is, as the classes' annotations have it.
    """
    return {key: _as_whole(entry) if types.get(key, "").startswith("int") else entry for key, entry in entries.items()}


def _as_whole(entry: Any) -> Any:
    if isinstance(entry, list):
        return [_as_whole(each) for each in entry]
    return int(entry) if isinstance(entry, float) and entry.is_integer() else entry


_SPEED_RPM = ("rpm", "speed_rpm", "shaft_rpm", "pinion_rpm", "pinion_speed_rpm")
"""What is tried for ``pinion_speed_hz``."""


def check_key(key: str, value: object = None) -> None:
    """Refuse a key that a scenario does not have.

    Parameters
    ----------
    key : str
        The key.
    value : object, optional
        Its value, which the error repeats in the right unit.
    """
    if key in _SPEED_RPM:
        written = f"{value / 60:.12g}" if isinstance(value, (int, float)) else "…"
        raise TypeError(f"a scenario has no key '{key}': speeds are revolutions per second, pinion_speed_hz={written}")
    known = [*SECTION_OF_KEY, *OTHER_ARGUMENTS]
    if key not in known:
        raise TypeError(f"a scenario has no key '{key}'{hint(key, known) or '; it has ' + ', '.join(known)}")
