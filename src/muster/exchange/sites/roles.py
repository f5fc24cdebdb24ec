"""What a feature is: a task, a robot, a station, a zone, the boundary, an area to survey, a lane.

Stated, the strongest first, by a flag; by a property (`kind`, or a `type` that is one of these words); by a word in the
feature's name; by a word in the name of its folder, sheet or file. What is closed is never taken for anything else, and
an area that no word decides is not guessed: the user is asked. A line without words is a lane, a point without words a
task.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise
from pathlib import PurePath

from muster.exchange.sites import vocabulary as words
from muster.exchange.sites.cells import visible
from muster.exchange.sites.features import Feature, Layer
from muster.exchange.sites.keys import AT_POINTS, CIRCLE, COVERAGE, IDENTITY, ROLE, ROLES, SKIP, ZONE_RADIUS
from muster.exchange.sites.vocabulary import is_only, meanings
from muster.mission.errors import Finding, ParameterError
from muster.mission.near_matches import did_you_mean

_FITTING = {
    "point": (*AT_POINTS, CIRCLE),
    "line": ("lane", "route", "boundary", "zone", "survey"),
    "area": ("zone", "boundary", "survey", "route"),
}
_SAID = {"point": "a point", "line": "a line", "area": "an area"}
_DRAWN = {"area": "route", "hole": "route"}
"""Kinds in exported plans of what their tasks cover: no zones. Areas with their action are surveyed again."""
_ROLE_OF = {
    words.CLOSED: "zone",
    words.OBSTACLE: "zone",
    words.BOUNDARY: "boundary",
    words.SURVEY: "survey",
    words.TASK: "task",
    words.STATION: "station",
    words.ROBOT: "robot",
    words.AIR: "robot",
    words.GROUND: "robot",
    words.LANE: "lane",
}
_KINDS = (words.AIR, words.GROUND)
_CLASSES = (ROLE.name, *ROLE.names, "type", "category", "class", "restriction", "status", "usage")
"""Headings whose values classify a feature, besides its name."""
_YES = ("yes", "true", "1", "y", "on")
_OPEN_GAP = 0.1
"""A line is drawn around an area if its ends are closer than this share of its length."""
_SUBJECT = re.compile(r"^(task|robot|panel|point|site|zone|area|waypoint|target|asset)[ _-]+")
"""A word before a heading that says of what it is: `Panel name`."""
_TO_WHOM = re.compile(r"forbidden[ _]to\W+(air|ground)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Decision:
    """What a feature is, and why.

    Parameters
    ----------
    role
        of the feature; None where nothing decides it.
    reason
        what decided the role, or why nothing did, in words.
    choices
        the roles that a user may give a feature that is undecided.
    """

    role: str | None
    reason: str
    choices: tuple[str, ...] = ()


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
    _with_areas: dict[int, bool] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(cls, given: Mapping[str, str]) -> Roles:
        """Return the roles that a user gives, by names; raises ParameterError for what is no role."""
        found, kinds = {}, {}
        for name, word in given.items():
            role = stated_role(word)
            if role is None:
                known = (*ROLES, SKIP, *_KINDS)
                hint = did_you_mean(word, known)
                raise ParameterError(f"--as {name}: {word}; expected one of {', '.join(known)}{hint}")
            found[_folded(name)] = role
            if role == "robot" and (kind := words.moves(word)) is not None:
                kinds[_folded(name)] = kind
        return cls(found, kinds)

    def require_used(self, layers: Sequence[Layer]) -> None:
        """Raise ParameterError for a name that no file, layer or feature has."""
        known = {name: name for layer in layers for name in names_of(layer)}
        known |= {name: name for layer in layers for feature in layer.features for name in labels_of(layer, feature)}
        folded = {_folded(name) for name in known}
        for name in self.given:
            if name not in folded:
                raise ParameterError(f"--as: no file, layer or feature {name}{did_you_mean(name, known)}")

    def kind_given(self, layer: Layer, feature: Feature) -> str | None:
        """Return `air` or `ground` where a user says it of the feature, its layer or file."""
        names = (*labels_of(layer, feature), *names_of(layer))
        return next((self.kinds[name] for name in map(_folded, names) if name in self.kinds), None)

    def decide(self, layer: Layer, feature: Feature, default: str | None, findings: list[Finding]) -> Decision:
        """Return what a feature is; `default` is the role of its file, where a user says so."""
        shape = "point" if feature.geometry is None else feature.geometry.shape
        stated, said = self._stated(layer, feature)
        if stated is not None:
            stated = CIRCLE if stated == "zone" and shape == "point" else stated
            if stated in (*_FITTING[shape], SKIP):
                return Decision(stated, said)
            fitting = ", ".join(role for role in _FITTING[shape] if role not in ("route", CIRCLE))
            findings.append(feature.finding(said, stated, f"one of {fitting} for {_SAID[shape]}"))
            return Decision(SKIP, said)
        if default is not None and default in _FITTING[shape]:
            return Decision(default, "--robots")
        return _of_point(layer, feature) if shape == "point" else _of_shape(layer, feature, shape)

    def _has_areas(self, layer: Layer) -> bool:
        """Return whether a layer has areas or lines, which a word for areas means rather than points beside them."""
        if id(layer) not in self._with_areas:
            shapes = (feature.geometry.shape for feature in layer.features if feature.geometry is not None)
            self._with_areas[id(layer)] = any(shape != "point" for shape in shapes)
        return self._with_areas[id(layer)]

    def _stated(self, layer: Layer, feature: Feature) -> tuple[str | None, str]:
        """Return the role that a flag or a property states, and which of them."""
        point = feature.geometry is None or feature.geometry.shape == "point"
        labels = labels_of(layer, feature)
        for name in (*labels, *names_of(layer)):
            role = self.given.get(_folded(name))
            if role is None or (not point and _folded(name) in self.kinds):
                continue
            own = name in labels
            if own or role in AT_POINTS or role == SKIP or not point or not self._has_areas(layer):
                return role, f"--as {name}"
        for heading, value in feature.values.items():
            if isinstance(value, str) and heading.casefold() in (ROLE.name, *ROLE.names, "type"):
                role = "survey" if is_of_plan(feature, "area") else stated_role(value) or _DRAWN.get(value)
                exact = value.casefold() in AT_POINTS or role == "zone"
                if role is not None and not (heading.casefold() == "type" and point and not exact):
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
    roles = {role for meaning, role in _ROLE_OF.items() if meaning in said}
    if roles == {"robot"} or (len(roles) == 1 and roles <= {"boundary", "survey", "zone"}):
        return next(iter(roles))
    return next(iter(roles)) if len(roles) == 1 and is_only(word, *said) else None


def role_word(value: object) -> bool:
    """Return whether a value is the name of a role."""
    return isinstance(value, str) and stated_role(value) is not None


def names_role(layer: Layer) -> bool:
    """Return whether the name of a layer says what its features are."""
    return any(meaning in meanings(layer.name) for meaning in _ROLE_OF)


def is_of_plan(feature: Feature, kind: str) -> bool:
    """Return whether a feature is, in an exported plan, an area that is covered, or a hole of such an area."""
    values = feature.values
    said = values.get("action") == COVERAGE if kind == "area" else isinstance(values.get("of"), str)
    return said and values.get(ROLE.name) == kind


def forbidden_by_name(layer: Layer, feature: Feature) -> list[str]:
    """Return the kinds of robots to which the name of a closed area says that it is forbidden; empty: to all."""
    return [match[1].casefold() for name in labels_of(layer, feature) if (match := _TO_WHOM.search(name))]


def _of_point(layer: Layer, feature: Feature) -> Decision:
    """Return what a point is: a task, unless a word says other; never a task where a word says that it is closed."""
    around = [(f"the {what} {name}", meanings(name)) for what, name in _around(layer)]
    for where, said in around:
        of_robots = any(meaning in said for meaning in (words.ROBOT, *_KINDS))
        if of_robots and words.CLOSED not in said and words.HOME not in said:
            others = [meaning for meaning in (words.TASK, words.STATION, words.SURVEY) if meaning in said]
            if others:
                return Decision(None, f"{where} says robot and {others[0]}", AT_POINTS)
            word = next(said[meaning] for meaning in (words.ROBOT, *_KINDS) if meaning in said)
            return Decision("robot", _by_word(word, where))
    closed = _closed(layer, feature)
    if closed is not None:
        return Decision(CIRCLE, closed)
    for where, said in around:
        if words.CLOSED in said:
            return Decision(CIRCLE, _by_word(said[words.CLOSED], where))
        if words.STATION in said and words.TASK not in said:
            return Decision("station", _by_word(said[words.STATION], where))
        if words.TASK in said:
            return Decision("task", _by_word(said[words.TASK], where))
        if words.FENCE in said or words.BOUNDARY in said:
            word = said.get(words.FENCE) or said[words.BOUNDARY]
            return Decision(None, f"{where} says {word}, and this is a point", ("task", SKIP))
    return _of_point_by_itself(layer, feature)


def _of_point_by_itself(layer: Layer, feature: Feature) -> Decision:
    labels = labels_of(layer, feature)
    if (name := next((name for name in labels if words.HOME in meanings(name) or _is_home(name)), None)) is not None:
        return Decision(SKIP, f"a place where robots start or land; --as {quoted(name)}=task makes it a task")
    if _has_kind(feature):
        return Decision("robot", f"{BY} how it moves")
    if (heading := _radius_heading(feature)) is not None:
        areas = [
            word
            for name in labels
            for meaning in (words.BOUNDARY, words.SURVEY)
            if (word := meanings(name).get(meaning))
        ]
        told = f"{areas[0]} says an area to be drawn" if areas else "a round closed area, or a task"
        return Decision(None, f"{heading} beside a point: {told}", (SKIP, "task") if areas else ("zone", "task"))
    if any(is_only(name, words.ROBOT, *_KINDS) for name in labels):
        return Decision(None, "a name of robots", ("robot", "task"))
    return Decision("task", POINT)


def _of_shape(layer: Layer, feature: Feature, shape: str) -> Decision:
    """Return what a line or area is; areas that nothing decides, or words of which one says closed, are undecided."""
    closed = _closed(layer, feature)
    if closed is not None:
        return Decision("zone", closed)
    levels = [*(("name", name) for name in labels_of(layer, feature)), *_around(layer)]
    found: Decision | None = None
    for what, name in levels:
        here = _of_words(feature, shape, what, name)
        if here is None:
            continue
        if found is not None:
            closes = here.role == "zone" and words.CLOSED in meanings(name) and found.role != "zone"
            others = set(meanings(name)) & {words.BOUNDARY, words.SURVEY}
            if closes and not others:
                told = f"{found.role} {found.reason}, but closed {here.reason}"
                return Decision(None, told, _choices(shape))
            continue
        if here.role is None:
            return here
        found = here
    if found is not None:
        return found
    if shape == "line":
        return Decision("lane", LINE)
    return Decision(None, "no word says what it is", _choices(shape))


def _of_words(feature: Feature, shape: str, what: str, name: str) -> Decision | None:
    """Return what the words of one name say of a line or area; None where they say nothing."""
    said = meanings(name)
    where = "the name" if what == "name" else f"the {what} {name}"
    if words.CLOSED in said:
        return Decision("zone", _by_word(said[words.CLOSED], where))
    roles = {_ROLE_OF[meaning]: word for meaning, word in said.items() if meaning in _ROLE_OF}
    roles = {role: word for role, word in roles.items() if role in _FITTING[shape]}
    if shape == "line" and not _is_around_area(feature):
        roles.pop("survey", None)
    if words.FENCE in said and len(roles) != 1:
        told = f"{where} says {said[words.FENCE]}, and not whether robots stay inside or outside"
        return Decision(None, told, _choices(shape))
    if len(roles) > 1:
        return Decision(None, f"{where} says {' and '.join(roles.values())}", _choices(shape))
    if roles:
        ((role, word),) = roles.items()
        return Decision(role, _by_word(word, where))
    return None


BY = "by"
"""Begins reasons that words give."""
POINT, LINE = "as points are where no word says other", "as lines are where no word says other"
"""Reasons where no word decides."""


def _by_word(word: str, where: str) -> str:
    return f"{BY} the word {word} in {where}"


def _choices(shape: str) -> tuple[str, ...]:
    return ("zone", "boundary", "survey", *(("lane",) if shape == "line" else ()), SKIP)


def _closed(layer: Layer, feature: Feature) -> str | None:
    """Return what of a feature itself says that it is closed, its name or a property; None where nothing does."""
    for name in labels_of(layer, feature):
        if (word := meanings(name).get(words.CLOSED)) is not None:
            return _by_word(word, "the name")
    point = feature.geometry is None or feature.geometry.shape == "point"
    for heading, value in feature.values.items():
        folded = heading.strip().casefold()
        if folded in _CLASSES and isinstance(value, str) and (word := meanings(value).get(words.CLOSED)) is not None:
            return _by_word(word, heading)
        if folded.replace(" ", "_") in ("forbidden_to", "closed_to"):
            return f"{BY} {heading}"
        is_yes = value is True or value == 1 or (isinstance(value, str) and value.strip().casefold() in _YES)
        if is_yes and words.CLOSED in meanings(heading):
            return f"{BY} {heading}"
        if folded in ("building", "building:part", "barrier") and not point and str(value).casefold() != "no":
            return f"{BY} {heading}"
    return None


def _is_around_area(feature: Feature) -> bool:
    """Return whether the ends of a line are so close that it is drawn around an area."""
    if feature.geometry is None:
        return False
    line = [place[:2] for piece in feature.geometry.pieces for place in piece[0]]
    length = sum(math.dist(a, b) for a, b in pairwise(line))
    return len(line) > 3 and math.dist(line[0], line[-1]) < _OPEN_GAP * length


def _is_home(name: str) -> bool:
    """Return whether a name is that of the place where robots start and land."""
    return words.plain(name).strip() in ("home", "base", "launch", "start")


def _has_kind(feature: Feature) -> bool:
    kinds = [value for heading, value in feature.values.items() if heading.strip().casefold() in ("moves", "domain")]
    return any(isinstance(value, str) and words.moves(value) is not None for value in kinds)


def _radius_heading(feature: Feature) -> str | None:
    """Return the heading of a feature under which a radius stands, if there is one."""
    return next((heading for heading in feature.values if _is_radius(heading)), None)


@lru_cache(maxsize=1024)
def _is_radius(heading: str) -> bool:
    known = (ZONE_RADIUS.name.replace("_", ""), *ZONE_RADIUS.names)
    return re.sub(r"\W*[(\[].*|[\W_]", "", heading.casefold()) in known


def _around(layer: Layer) -> Iterable[tuple[str, str]]:
    """Return the names of the layer and the file, each with what it is the name of."""
    return [pair for pair in (("layer", layer.name), ("file", PurePath(layer.file).stem)) if pair[1]]


def names_of(layer: Layer) -> list[str]:
    """Return the names by which a layer may be called."""
    return _names_in(layer.name, layer.file)


@lru_cache(maxsize=64)
def _names_in(name: str, file: str) -> list[str]:
    """The names by which a layer may be called; asked for each of its features."""
    path = PurePath(file)
    return [told for told in (name, path.stem, path.name) if told]


def labels_of(layer: Layer, feature: Feature) -> list[str]:
    """Return the name and the id of a feature, each in one line, as far as it has them."""
    values = (feature.values.get(heading) for heading in _label_headings(layer.headings))
    return [" ".join(visible(value).split()) for value in values if isinstance(value, str)]


@lru_cache(maxsize=64)
def _label_headings(headings: tuple[str, ...]) -> tuple[str, ...]:
    """Return the headings of names and ids among others; asked for each feature of a layer."""
    known = {name for key in IDENTITY for name in (key.name, *key.names)}
    by_name = [heading for heading in headings if _bare(heading) in known]
    return tuple(sorted(by_name, key=lambda heading: _bare(heading) != "name"))


def _bare(heading: str) -> str:
    """Return a heading as the names of keys are: without the word that says of what it is, and marks."""
    return re.sub(r"[\W_]", "", _SUBJECT.sub("", heading.casefold()))


def _folded(name: str) -> str:
    return " ".join(visible(name).casefold().split())


def quoted(name: str) -> str:
    """Return a name as it stands on a command line."""
    return f'"{name}"' if " " in name else name
