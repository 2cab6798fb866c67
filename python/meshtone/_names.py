"""Names that were meant by those that there are not."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping

__all__ = ["absent", "hint", "near"]


def near(name: str, known: Iterable[str]) -> list[str]:
    """The known names that have one in them, or else resemble it; all are of small letters."""
    names, wanted = list(known), str(name).lower()
    return [each for each in names if wanted in each] or difflib.get_close_matches(wanted, names)


def hint(name: str, known: Iterable[str]) -> str:
    """The known name that is meant, to be put behind an error; empty if none is near."""
    lowered = {each.lower(): each for each in known}
    meant = difflib.get_close_matches(str(name).lower(), lowered, n=1)
    return f"; did you mean '{lowered[meant[0]]}'?" if meant else ""


def absent(owner: object, name: str, elsewhere: Mapping[str, str]) -> AttributeError:
    """The error of an attribute that there is not, with what does the same, by the names that other libraries have for it.

    Parameters
    ----------
    owner : object
        What has no such attribute.
    name : str
        The attribute.
    elsewhere : mapping of str to str
        What to write in place of several names, which are separated by spaces.
    """
    instead = next((f": {call}" for names, call in elsewhere.items() if name in names.split()), "")
    public = [each for each in dir(type(owner)) if not each.startswith("_")]
    return AttributeError(f"{type(owner).__name__} has no attribute '{name}'{instead or hint(name, public)}")
