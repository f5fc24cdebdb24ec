"""What words decide of a feature: of a point, a line, or an area.

What is closed is never taken for anything else, and an area that no word decides, or two decide differently, is left
undecided. A line without words is a lane, a point without words a task.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from pathlib import PurePath

from muster_files.sites import vocabulary as words
from muster_files.sites.features import Feature, Layer
from muster_files.sites.key_words import TYPES
from muster_files.sites.keys import AT_POINTS, CIRCLE, ROLE, SKIP, ZONE_RADIUS
from muster_files.sites.labels import labels_of, names_of, quoted, robots_heading
from muster_files.sites.vocabulary import is_only, meanings

FITTING = {
    "point": (*AT_POINTS, CIRCLE),
    "line": ("lane", "route", "boundary", "zone", "survey"),
    "area": ("zone", "boundary", "survey", "route"),
}
ROLE_OF = {
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
KINDS = (words.AIR, words.GROUND)
_CLASSES = (ROLE.name, *ROLE.names, "type", "restriction", "symbol", *TYPES)
"""Headings whose values classify a feature, besides its name."""
_CLASSES_OF_AREAS = (*_CLASSES, "category", "class", "status", "usage")
"""Of points, such as orders, a status may be that they are closed, too."""
_LAYERS = ("layer", "folder", "group")
"""Headings under which programs write in which layer of a drawing a feature was."""
_NO_ROBOTS = (words.TASK, words.STATION, words.SURVEY, words.BOUNDARY)
"""What in the name of a layer or file makes a word for robots beside it say nothing of its points."""
_YES = ("yes", "true", "1", "y", "on")
_OPEN_GAP = 0.1
"""A line is drawn around an area if its ends are closer than this share of its length."""
BY = "by"
"""Begins reasons that words give."""
POINT, LINE = "as points are where no word says other", "as lines are where no word says other"
"""Reasons where no word decides."""


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


class Surroundings:
    """The features of a layer as one of them is seen beside the others.

    Parameters
    ----------
    layer
        the layer.
    """

    def __init__(self, layer: Layer) -> None:
        self.layer = layer

    @cached_property
    def has_areas(self) -> bool:
        """Whether the layer has areas or lines."""
        shapes = (feature.geometry.shape for feature in self.layer.features if feature.geometry is not None)
        return any(shape != "point" for shape in shapes)

    @cached_property
    def has_bounds(self) -> bool:
        """Whether an area of the layer says by itself that it is closed, or the boundary."""
        areas = [f for f in self.layer.features if f.geometry is not None and f.geometry.shape == "area"]
        return any(
            _closed(self.layer, area) is not None
            or any(words.BOUNDARY in meanings(name) for name in labels_of(self.layer, area))
            for area in areas
        )


def _of_team(
    surroundings: Surroundings, feature: Feature, around: Sequence[tuple[str, Mapping[str, str]]]
) -> Decision | None:
    """Return whether names around a point, or the heading of its name, say that it is a robot; None if they do not."""
    for where, said in around:
        if where.startswith("the folder"):
            continue  # a mission for drones has places to visit in it
        of_robots = any(meaning in said for meaning in (words.ROBOT, *KINDS))
        if of_robots and words.CLOSED not in said and words.HOME not in said:
            word = next(said[meaning] for meaning in (words.ROBOT, *KINDS) if meaning in said)
            others = [said[meaning] for meaning in _NO_ROBOTS if meaning in said]
            if others or surroundings.has_areas:
                other = others[0] if others else "has areas or lines beside points"
                return Decision(None, f"{where} says {word}, and {other}", ("robot", "task", SKIP))
            return Decision("robot", _by_word(word, where))
    if feature.geometry is None and (heading := robots_heading(surroundings.layer.headings)) is not None:
        return Decision("robot", f"{BY} the heading {heading}")
    return None


def of_point(surroundings: Surroundings, feature: Feature) -> Decision:
    """Return what a point is: a task, unless a word says other; never a task where a word says that it is closed."""
    layer = surroundings.layer
    around = [(f"the {what} {name}", meanings(name)) for what, name in _around(layer, feature)]
    robot = _of_team(surroundings, feature, around)
    if robot is not None:
        return robot
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
        if words.HOME in said:
            return Decision(SKIP, _started(names_of(layer)[0]))
        if words.FENCE in said or words.BOUNDARY in said:
            word = said.get(words.FENCE) or said[words.BOUNDARY]
            return Decision(None, f"{where} says {word}, and this is a point", ("task", SKIP))
    return _of_point_by_itself(layer, feature)


def _of_point_by_itself(layer: Layer, feature: Feature) -> Decision:
    labels = labels_of(layer, feature)
    if (name := next((name for name in labels if words.HOME in meanings(name) or _is_home(name)), None)) is not None:
        return Decision(SKIP, _started(name))
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
    if any(is_only(name, words.ROBOT, *KINDS) for name in labels):
        return Decision(None, "a name of robots", ("robot", "task"))
    return Decision("task", POINT)


def _started(name: str) -> str:
    return f"a place where robots start or land; --as {quoted(f'{name}=task')} makes it a task"


def of_shape(surroundings: Surroundings, feature: Feature, shape: str) -> Decision:
    """Return what a line or area is; areas that nothing decides, or words of which one says closed, are undecided."""
    layer = surroundings.layer
    closed = _closed(layer, feature)
    if closed is not None:
        return Decision("zone", closed)
    levels = [*(("name", name) for name in labels_of(layer, feature)), *_around(layer, feature)]
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
        if here.role == "survey" and what in ("folder", "file") and surroundings.has_bounds:
            told = f"survey {here.reason}, whose other areas are none to survey"
            return Decision(None, told, _choices(shape))
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
    roles = {ROLE_OF[meaning]: word for meaning, word in said.items() if meaning in ROLE_OF}
    roles = {role: word for role, word in roles.items() if role in FITTING[shape]}
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
    classes = _CLASSES if point else _CLASSES_OF_AREAS
    for heading, value in feature.values.items():
        folded = heading.strip().casefold()
        if folded in classes and isinstance(value, str) and (word := meanings(value).get(words.CLOSED)) is not None:
            return _by_word(word, heading)
        if folded.replace(" ", "_") in ("forbidden_to", "closed_to"):
            return f"{BY} {heading}"
        is_yes = value is True or value == 1 or (isinstance(value, str) and value.strip().casefold() in _YES)
        word = meanings(heading).get(words.CLOSED)
        if is_yes and word is not None and not (point and word == "closed"):
            return f"{BY} {heading}"
        if folded in ("building", "building:part", "barrier") and not point and str(value).casefold() != "no":
            return f"{BY} {heading}"
    return None


def is_open_line(feature: Feature) -> bool:
    """Return whether a feature is a line that is not drawn around an area."""
    return feature.geometry is not None and feature.geometry.shape == "line" and not _is_around_area(feature)


def is_wall(reason: str) -> bool:
    """Return whether what makes a feature a zone says that something stands there, and not that an area is closed."""
    return reason.startswith(BY) and words.CLOSED not in meanings(reason)


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


def _around(layer: Layer, feature: Feature) -> Iterable[tuple[str, str]]:
    """Return the names of what a feature is in, from the innermost to the file, each with what it is the name of."""
    values = {heading.strip().casefold(): value for heading, value in feature.values.items()}
    own = [("layer", value) for key in _LAYERS if isinstance(value := values.get(key), str)]
    around = [("folder", name) for name in layer.around]
    return [pair for pair in (*own, ("layer", layer.name), *around, ("file", PurePath(layer.file).stem)) if pair[1]]
