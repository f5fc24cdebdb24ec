"""The interface of formats of exported plans: their options, the resulting files, and the registry of formats."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypedDict

from muster.mission.errors import ParameterError
from muster.mission.system.plugins import Registry, declaring, function_expected, require_words
from muster.mission.value_types import shown

FIRMWARES = ("px4", "ardupilot")
RANGES = {"altitude": (0.0, 1e5), "altitude_step": (0.0, 1e4), "clearance": (0.0, 1e5), "tolerance": (0.0, 1e3)}
"""Least and greatest metres of the options that are lengths; `altitudes` are as `altitude`."""

ALTITUDE_MISSING = "--altitude missing"
"""Begins the error of a format for drones in the plane to which no height was given."""


@dataclass(frozen=True)
class Files:
    """Contents by the names of their files, texts or bytes, and messages for the user."""

    contents: Mapping[str, str | bytes]
    messages: tuple[str, ...] = ()

    @property
    def texts(self) -> dict[str, str]:
        """Those files that are texts."""
        return {name: content for name, content in self.contents.items() if isinstance(content, str)}

    @property
    def encoded(self) -> dict[str, bytes]:
        """All files as they are written: texts in UTF-8."""
        return {
            name: content.encode("utf-8") if isinstance(content, str) else content
            for name, content in self.contents.items()
        }


@dataclass(frozen=True)
class ExportOptions:
    """The options of formats; each format declares which of them it takes.

    Parameters
    ----------
    altitude
        least height above the start, metres, at which drones fly; `qgc` needs one for drones of a mission in the plane.
    altitude_step
        metres; each drone, in mission order, flies so much higher than the one before it, the first at `altitude`, or
        without that at this height.
    altitudes
        metres by robot, for drones that do not fly at the height that the two above give them.
    clearance
        metres; a warning where bodies come nearer to each other.
    tolerance
        metres; around corners of a map way points are joined, no farther than this from the way; 0 keeps all.
    firmware
        `px4` or `ardupilot`.
    per_robot
        a file for each robot that has stops, not one for all.

    Raises
    ------
    ParameterError
        for a value that is none.
    """

    altitude: float | None = None
    altitude_step: float = 0.0
    altitudes: Mapping[str, float] = field(default_factory=dict)
    clearance: float = 0.0
    tolerance: float = 0.1
    firmware: str = "px4"
    per_robot: bool = False

    def __post_init__(self) -> None:
        for name, limits in RANGES.items():
            if name != "altitude" or self.altitude is not None:
                _require_metres(name, getattr(self, name), limits)
        if not isinstance(self.altitudes, Mapping):
            raise ParameterError(f"altitudes: {shown(self.altitudes)}; expected metres by robot")
        for robot, metres in self.altitudes.items():
            _require_metres(f"altitudes: {robot}", metres, RANGES["altitude"])
        if self.firmware not in FIRMWARES:
            raise ParameterError(f"firmware: {shown(self.firmware)}; expected {' or '.join(FIRMWARES)}")
        if not isinstance(self.per_robot, bool):
            raise ParameterError(f"per_robot: {shown(self.per_robot)}; expected true or false")

    @property
    def separates(self) -> bool:
        """Whether it is asked at which heights drones fly, or how near robots come to each other."""
        return self.altitude is not None or bool(self.altitude_step or self.altitudes or self.clearance)

    def given(self) -> dict[str, Any]:
        """Those that are not the default, by name."""
        default = ExportOptions()
        return {f.name: value for f in fields(self) if (value := getattr(self, f.name)) != getattr(default, f.name)}


def _require_metres(name: str, value: object, limits: tuple[float, float]) -> None:
    low, high = limits
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise ParameterError(f"{name}: {shown(value)}; expected metres, from {low:g} to {high:g}")


def altitudes_in(texts: Iterable[str]) -> dict[str, float]:
    """Altitudes by robot, from texts such as `r_0=30,r_1=40`.

    Raises
    ------
    ParameterError
        for a text that is none, and for a robot that is named twice.
    """
    found: dict[str, float] = {}
    for text in texts:
        name = ""
        for piece in text.split(","):
            before, equals, metres = piece.rpartition("=")
            name += before if equals else f"{piece},"  # an id may hold a comma
            if equals and name in found:
                raise ParameterError(f"altitudes: {name} twice; expected one height for each robot")
            if equals:
                found[name], name = _metres_in(metres, text), ""
        if name:
            raise ParameterError(f"altitudes: {shown(text)}; expected ROBOT=METRES, as r_0=30,r_1=40")
    return found


def _metres_in(metres: str, text: str) -> float:
    try:
        return float(metres)
    except ValueError:
        raise ParameterError(f"altitudes: {shown(text)}; expected metres after =, not {shown(metres)}") from None


class ExportKeywords(TypedDict, total=False):
    """The options of `ExportOptions`, for type checkers."""

    altitude: float | None
    altitude_step: float
    altitudes: Mapping[str, float]
    clearance: float
    tolerance: float
    firmware: str
    per_robot: bool


HEIGHTS = ("altitude", "altitude_step", "altitudes", "clearance")
"""The options of heights and distances, which formats with places of drones have."""

Exporter = Callable[..., "str | bytes | Files"]
"""Writes an admissible plan, from mission and verdict, as the text or the bytes of one file, or as several files.

One that declares options gets these too, as `ExportOptions`, and the plan, if there is one.
"""

FORMATS: Registry[Exporter] = Registry(
    "format",
    "muster.formats",
    function_expected("a function of a mission and a verdict"),
)
"""By name, those of installed packages included."""


def declares(*, options: Collection[str] = (), folder: bool = False) -> Callable[[Exporter], Exporter]:
    """Declare which options a format has, and where its files go.

    Parameters
    ----------
    options : collection of str
        Names of fields of `ExportOptions`: the function is called with mission, verdict, options and plan.
    folder : bool
        Whether the files go into a folder, even a single one.
    """
    require_words("options", options, ExportKeywords.__annotations__)
    return declaring(options=tuple(options), folder=folder)


def options_of(form: str) -> tuple[str, ...]:
    """Return the names of the options that a format declares.

    Raises
    ------
    ParameterError, PluginError
        if there is no such format, or its package cannot be loaded.
    """
    return tuple(getattr(FORMATS.named(form), "options", ()))


def makes_folder(form: str, options: ExportOptions) -> bool:
    """Return whether the files of a format go into a folder.

    Raises
    ------
    ParameterError, PluginError
        as `options_of`.
    """
    return options.per_robot or bool(getattr(FORMATS.named(form), "folder", False))
