"""The figures that the documents print, and those that no study draws, with the reason."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

_DIAGRAM = "a diagram that explains a definition or a method; it has no data"
_ELSEWHERE = "taken from other publications, or a diagram of them"
_PHOTOGRAPH = "a photograph of the laboratory or of hardware"
_SOFTWARE = "a diagram of software or of ROS topics, or a screenshot of a program"


def _chapter(chapter: str, first: int, last: int) -> tuple[str, ...]:
    return tuple(f"{chapter}.{k}" for k in range(first, last + 1))


PRINTED: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "tcf-thesis": (
            *_chapter("2", 1, 6),
            *_chapter("3", 1, 23),
            *_chapter("4", 1, 14),
            *_chapter("5", 1, 7),
            *_chapter("6", 1, 15),
            *_chapter("A", 1, 17),
        ),
        "auction-thesis": (*_chapter("2", 1, 5), *_chapter("4", 1, 4), *_chapter("5", 1, 23)),
        "market-paper": tuple(map(str, range(1, 9))),
    }
)
"""The numbers of the figures of each document, by its key in docs/references.md."""


@dataclass(frozen=True)
class NotDrawn:
    """Figures of a document that no study draws, what they show, and why they are not drawn."""

    source: str
    numbers: tuple[str, ...]
    shows: str
    reason: str


NOT_DRAWN = (
    NotDrawn("tcf-thesis", _chapter("2", 1, 6), "methods of the literature", _ELSEWHERE),
    NotDrawn("tcf-thesis", _chapter("3", 1, 5), "patrols, coefficients and steps of the algorithms", _DIAGRAM),
    NotDrawn("tcf-thesis", _chapter("4", 1, 10), "frames, kinematics, observation tasks and a tag", _DIAGRAM),
    NotDrawn("tcf-thesis", _chapter("4", 12, 14), "transformations, a tag's diagonal and clusters", _DIAGRAM),
    NotDrawn("tcf-thesis", ("5.1", "5.3", "5.6", "5.7"), "the architecture, its topics and a program", _SOFTWARE),
    NotDrawn("tcf-thesis", ("5.2", "5.4", "5.5"), "the motion capture room, robots and their markers", _PHOTOGRAPH),
    NotDrawn("tcf-thesis", ("6.15",), "a rigid body that is not aligned with its robot", _DIAGRAM),
    NotDrawn("tcf-thesis", ("A.2", "A.3"), "the loop of motion planning, and a velocity obstacle", _DIAGRAM),
    NotDrawn("auction-thesis", _chapter("2", 1, 5), "messages, programs and poses of ROS", _SOFTWARE),
    NotDrawn("auction-thesis", _chapter("4", 1, 4), "frames, a tree of transforms and the RotorS simulator", _SOFTWARE),
    NotDrawn("market-paper", ("1", "2", "3"), "the formulation, a scenario and its database model", _DIAGRAM),
)
