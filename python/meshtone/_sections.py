"""Names that a scenario has, had, or does not have."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from ._keys import SECTION_OF_KEY

OTHER_ARGUMENTS = ("fault", "faults", "sensors", "pinion_profile_errors_mm", "gear_profile_errors_mm")

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
