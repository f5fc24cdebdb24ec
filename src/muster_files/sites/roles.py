"""What a feature is: a task, a robot, a station, a zone, the boundary, an area to survey, a lane.

Stated, the strongest first, by a flag; by a property (`kind`, or a `type` that is one of these words); by a word in the
feature's name; by a word in the name of its folder, sheet or file (`decisions.py`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.mission.errors import Finding, ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster_files.sites import vocabulary as words
from muster_files.sites.decisions import FITTING, KINDS, ROLE_OF, Decision, Surroundings, of_point, of_shape
from muster_files.sites.features import Feature, Layer
from muster_files.sites.keys import AT_POINTS, CIRCLE, COVERAGE, ROLE, ROLES, SKIP
from muster_files.sites.labels import folded, labels_of, names_of
from muster_files.sites.vocabulary import is_only, meanings

_SAID = {"point": "a point", "line": "a line", "area": "an area"}
_DRAWN = {"area": "route", "hole": "route"}
"""Kinds in exported plans of what their tasks cover: no zones. Areas with their action are surveyed again."""
_TO_WHOM = re.compile(r"forbidden[ _]to\W+(air|ground)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Roles:
    """The roles of features, in view of what a user says of them.

    Parameters
    ----------
    given
        roles by the names of files, layers or features, folded.
    kinds
        `air` or `ground` by such names, where a user says how robots move.
    """

    given: Mapping[str, str]
    kinds: Mapping[str, str]
    _surroundings: dict[int, Surroundings] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(cls, given: Mapping[str, str]) -> Roles:
        """Return the roles that a user gives, by names; raises ParameterError for what is no role."""
        found, kinds = {}, {}
        for name, word in given.items():
            role = SKIP if word.strip().casefold() in ("ignore", "nothing", "none") else stated_role(word)
            if role is None:
                known = (*ROLES, SKIP, *KINDS)
                hint = did_you_mean(word, known)
                raise ParameterError(f"--as {name}: {word}; expected one of {', '.join(known)}{hint}")
            found[folded(name)] = role
            if role == "robot" and (kind := words.moves(word)) is not None:
                kinds[folded(name)] = kind
        return cls(found, kinds)

    def require_used(self, layers: Sequence[Layer]) -> None:
        """Raise ParameterError for a name that no file, layer or feature has."""
        known = {name: name for layer in layers for name in names_of(layer)}
        known |= {name: name for layer in layers for feature in layer.features for name in labels_of(layer, feature)}
        spelt = {folded(name) for name in known}
        for name in self.given:
            if name not in spelt:
                raise ParameterError(f"--as: no file, layer or feature {name}{did_you_mean(name, known)}")

    def kind_given(self, layer: Layer, feature: Feature) -> str | None:
        """Return `air` or `ground` where a user says it of the feature, its layer or file."""
        names = (*labels_of(layer, feature), *names_of(layer))
        return next((self.kinds[name] for name in map(folded, names) if name in self.kinds), None)

    def decide(self, layer: Layer, feature: Feature, default: str | None, findings: list[Finding]) -> Decision:
        """Return what a feature is; `default` is the role of its file, where a user says so."""
        shape = "point" if feature.geometry is None else feature.geometry.shape
        stated, said = self._stated(layer, feature)
        if stated is not None:
            stated = CIRCLE if stated == "zone" and shape == "point" else stated
            if stated in (*FITTING[shape], SKIP):
                return Decision(stated, said)
            fitting = ", ".join(role for role in FITTING[shape] if role not in ("route", CIRCLE))
            findings.append(feature.finding(said, stated, f"one of {fitting} for {_SAID[shape]}"))
            return Decision(SKIP, said)
        if default is not None and default in FITTING[shape]:
            return Decision(default, "--robots")
        around = self._around(layer)
        return of_point(around, feature) if shape == "point" else of_shape(around, feature, shape)

    def _around(self, layer: Layer) -> Surroundings:
        """Return the surroundings of features of a layer; all layers live as long as the roles are asked for."""
        if id(layer) not in self._surroundings:
            self._surroundings[id(layer)] = Surroundings(layer)
        return self._surroundings[id(layer)]

    def _stated(self, layer: Layer, feature: Feature) -> tuple[str | None, str]:
        """Return the role that a flag or a property states, and which of them."""
        point = feature.geometry is None or feature.geometry.shape == "point"
        labels = labels_of(layer, feature)
        for name in (*labels, *names_of(layer)):
            role = self.given.get(folded(name))
            if role is None or (not point and folded(name) in self.kinds):
                continue
            own = name in labels
            if own or role in AT_POINTS or role == SKIP or not point or not self._around(layer).has_areas:
                return role, f"--as {name}"
        for heading, value in feature.values.items():
            if isinstance(value, str) and heading.casefold() in (ROLE.name, *ROLE.names, "type"):
                role = "survey" if is_of_plan(feature, "area") else stated_role(value) or _DRAWN.get(value)
                exact = value.casefold() in AT_POINTS or heading.casefold() != "type"
                if role is not None and (not point or _is_of_point(role, value, exact=exact)):
                    return role, heading
        return None, ""


def stated_role(word: str) -> str | None:
    """Return the role that a word means which stands for a kind of features; None where it means none, or several."""
    compact = re.sub("[-_ ]", "", word.casefold()).removesuffix("s")
    if compact in (*ROLES, SKIP):
        return compact
    said = meanings(word)
    if words.CLOSED in said:
        return "zone"
    roles = {role for meaning, role in ROLE_OF.items() if meaning in said}
    if roles == {"robot"} or (len(roles) == 1 and roles <= {"boundary", "survey", "zone"}):
        return next(iter(roles))
    return next(iter(roles)) if len(roles) == 1 and is_only(word, *said) else None


def _is_of_point(role: str, word: str, *, exact: bool) -> bool:
    """Return whether a point with such a kind or type has the role; a building may be a place to visit, too."""
    if role == "zone":
        return words.CLOSED in meanings(word) or words.plain(word).strip() in ("zone", "zones")
    return exact


def role_word(value: object) -> bool:
    """Return whether a value is the name of a role."""
    return isinstance(value, str) and stated_role(value) is not None


def names_role(layer: Layer) -> bool:
    """Return whether the name of a layer says what its features are."""
    return any(meaning in meanings(layer.name) for meaning in ROLE_OF)


def is_of_plan(feature: Feature, kind: str) -> bool:
    """Return whether a feature is, in an exported plan, an area that is covered, or a hole of such an area."""
    values = feature.values
    said = values.get("action") == COVERAGE if kind == "area" else isinstance(values.get("of"), str)
    return said and values.get(ROLE.name) == kind


def forbidden_by_name(layer: Layer, feature: Feature) -> list[str]:
    """Return the kinds of robots to which the name of a closed area says that it is forbidden; empty: to all."""
    return [match[1].casefold() for name in labels_of(layer, feature) if (match := _TO_WHOM.search(name))]
