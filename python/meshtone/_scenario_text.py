"""What a pair and a gearbox have in common: the text of a scenario file."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar

from . import _core

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["ScenarioText"]


class ScenarioText:
    """Reads and writes scenario files of one form."""

    __slots__ = ()

    _is_pair: ClassVar[bool]
    """Whether it is the form of one pair."""
    _native: _core.Scenario

    def _set(self, native: Any) -> None:
        raise NotImplementedError

    @classmethod
    def _wrap(cls, native: Any) -> Self:
        scenario = cls.__new__(cls)
        scenario._set(native)
        return scenario

    @classmethod
    def from_toml(cls, text: str) -> Self:
        """From the text of a scenario file.

        Parameters
        ----------
        text : str
            As ``meshtone init`` prints one.

        Raises
        ------
        ValueError
            Text that is not TOML, an unknown key, a value that is not allowed: with the line.

        Examples
        --------
        >>> from meshtone import Gearbox, Scenario, gearbox_template, template
        >>> Scenario.from_toml(template("missing-tooth")).fault
        MissingTooth(wheel='gear', tooth=1, severity=None)
        >>> Gearbox.from_toml(gearbox_template("phm2009-spur"))
        <Gearbox of 3 shafts and meshes z1-z2, z3-z4>
        """
        if "\n" not in text and text.endswith(".toml"):
            raise ValueError(f"'{text}' is the name of a file, not its text: {cls.__name__}.from_file reads it")
        return cls._wrap(_core.Scenario.from_toml(text, cls._is_pair))

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Self:
        """From a scenario file, and the files that it names.

        Parameters
        ----------
        path : str or path
            The file.

        Raises
        ------
        FileNotFoundError
            There is no such file.
        ValueError
            As :meth:`from_toml`.
        """
        return cls._wrap(_core.Scenario.from_file(path, cls._is_pair))

    def to_toml(self) -> str:
        """The text of a scenario file, with every key.

        Returns
        -------
        str
            What :meth:`from_toml` reads back exactly.
        """
        return self._native.to_toml()
