"""What a feature is: a task, a robot, a station, a zone, the boundary, an area to survey, a lane.

Told, the strongest first, by a flag; by a property (`kind`, or a `type` that is one of these words); for lines and
areas by a word in the feature's name; by a word in the name of its folder, sheet or file; by its shape: a point is a
task, an area a zone, a line a lane.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import PurePath

from muster.exchange.sites.features import Feature, Layer
from muster.exchange.sites.keys import AT_POINTS, COVERAGE, ROLE, ROLES
from muster.mission.errors import Finding, ParameterError
from muster.mission.near_matches import did_you_mean

_WORDS: Mapping[str, str] = {
    "task": "tasks job jobs waypoint waypoints poi pois goal goals target targets",
    "robot": "robots drone drones rover rovers vehicle vehicles fleet uav uavs ugv ugvs",
    "station": "stations dock docks charger chargers",
    "zone": "zones fence fences nofly noflyzone noflyzones nfz obstacle obstacles keepout exclusion restricted "
    "wall walls building buildings",
    "boundary": "boundaries perimeter arena border outline inclusion",
    "survey": "surveys coverage",
    "lane": "lanes road roads path paths way ways corridor corridors aisle aisles track tracks",
    "route": "routes",
}
_ROLE_OF = {word: role for role, words in _WORDS.items() for word in (role, *words.split())}
_FITTING = {
    "point": AT_POINTS,
    "line": ("lane", "route", "boundary", "zone", "survey"),
    "area": ("zone", "boundary", "survey", "route"),
}
_BY_SHAPE = {"point": "task", "line": "lane", "area": "zone"}
_SAID = {"point": "a point", "line": "a line", "area": "an area"}
_DRAWN = {"area": "route", "hole": "route"}
"""Kinds in exported plans of what their tasks cover: no zones. Areas with their action are surveyed again."""
_NO_FLY = re.compile(r"(?<![^\W_])(?:no[-_ ]?fly|nfz(?![^\W_]))")
_TOKEN = re.compile(r"[^\W\d_]+")


@dataclass(frozen=True)
class Roles:
    """The roles of features, in view of what a user says of them.

    Parameters
    ----------
    given
        roles by the names of files, layers or features, folded.
    """

    given: Mapping[str, str]

    @classmethod
    def of(cls, given: Mapping[str, str]) -> Roles:
        """The roles that a user gives, by names; raises ParameterError for what is no role."""
        found = {}
        for name, word in given.items():
            role = _ROLE_OF.get(_compact(word))
            if role is None:
                hint = did_you_mean(word, ROLES)
                raise ParameterError(f"--as {name}: {word}; expected one of {', '.join(ROLES[:-1])}{hint}")
            found[name.casefold()] = role
        return cls(found)

    def require_used(self, layers: Sequence[Layer]) -> None:
        """Raise ParameterError for a name that no file, layer or feature has."""
        known = {name: name for layer in layers for name in _names_of(layer)}
        known |= {name: name for layer in layers for feature in layer.features if (name := _name(feature))}
        folded = {name.casefold() for name in known}
        for name in self.given:
            if name not in folded:
                raise ParameterError(f"--as: no file, layer or feature {name}{did_you_mean(name, known)}")

    def role(self, layer: Layer, feature: Feature, default: str | None, findings: list[Finding]) -> str:
        """The role of a feature; `default` is that of its file, where a user says so."""
        shape = "point" if feature.geometry is None else feature.geometry.shape
        told, said = self._stated(layer, feature)
        if told is not None:
            if told in _FITTING[shape]:
                return told
            fitting = ", ".join(role for role in _FITTING[shape] if role != "route")
            expected = f"one of {fitting} for {_SAID[shape]}"
            findings.append(feature.finding(said, told, expected))
            return _BY_SHAPE[shape]
        names = ([] if shape == "point" else [_name(feature)]) + _names_of(layer)
        found = [default] if default else [role for name in names for role in _roles_in(name)]
        return next((role for role in found if role in _FITTING[shape]), _BY_SHAPE[shape])

    def _stated(self, layer: Layer, feature: Feature) -> tuple[str | None, str]:
        """The role that a flag or a property states, and which of them."""
        for name in (_name(feature), *_names_of(layer)):
            if name and (role := self.given.get(name.casefold())) is not None:
                return role, f"--as {name}"
        for heading, value in feature.values.items():
            if isinstance(value, str) and heading.casefold() in (ROLE.name, *ROLE.names, "type"):
                word = _compact(value)
                role = "survey" if is_of_plan(feature, "area") else _ROLE_OF.get(word) or _DRAWN.get(word)
                point = feature.geometry is None or feature.geometry.shape == "point"
                if role is not None and not (
                    heading.casefold() == "type" and point and value.casefold() not in AT_POINTS
                ):
                    return role, heading
        return None, ""


def names_role(layer: Layer) -> bool:
    """Whether the name of a layer says what its features are."""
    return bool(_roles_in(layer.name))


def role_word(value: object) -> bool:
    """Whether a value is the name of a role."""
    return isinstance(value, str) and _compact(value) in _ROLE_OF


def is_of_plan(feature: Feature, kind: str) -> bool:
    """Whether a feature is, in an exported plan, an area that is covered, or a hole of such an area."""
    values = feature.values
    said = values.get("action") == COVERAGE if kind == "area" else isinstance(values.get("of"), str)
    return said and values.get(ROLE.name) == kind


def is_no_fly(layer: Layer, feature: Feature) -> bool:
    """Whether the kind or name of a zone, or that of its layer or file, says that it is closed to robots in the air."""
    kinds = [
        value
        for heading, value in feature.values.items()
        if isinstance(value, str) and heading.casefold() in (ROLE.name, *ROLE.names, "type", "name", "title")
    ]
    return any(_NO_FLY.search(told.casefold()) for told in (*kinds, *_names_of(layer)))


def _compact(word: str) -> str:
    return re.sub("[-_ ]", "", word.casefold())


def _roles_in(name: str) -> list[str]:
    """The roles whose words stand in a name; that a line is the route of a plan only its properties say."""
    folded = _NO_FLY.sub("nofly", name.casefold()).replace("keep-out", "keepout")
    found = [_ROLE_OF[word] for word in _TOKEN.findall(folded) if word in _ROLE_OF]
    return [role for role in found if role != "route"]


def _names_of(layer: Layer) -> list[str]:
    return _names_in(layer.name, layer.file)


@lru_cache(maxsize=64)
def _names_in(name: str, file: str) -> list[str]:
    """The names by which a layer may be called; asked for each of its features."""
    path = PurePath(file)
    return [told for told in (name, path.stem, path.name) if told]


def _name(feature: Feature) -> str:
    found = next((value for heading, value in feature.values.items() if heading.casefold() in ("name", "title")), "")
    return found.strip() if isinstance(found, str) else ""
