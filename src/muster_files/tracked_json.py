"""JSON whose objects know which of their members were taken.

A member is marked as read when its value is asked for by its key; copying, iterating and testing for keys mark nothing.
The walk through the whole document after reading is generic: it gives each member to the ledger, taken or not.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

from muster.mission.import_ledger import EMPTY, UNKNOWN, Fate, LedgerBook, passed_over, read_as

_READ = read_as("itself")
_AGAIN = passed_over("stands again later in the same object")


class Tracked(dict[str, Any]):
    """A JSON object.

    Attributes
    ----------
    fates
        of the members that were taken, or said to be passed over.
    doubled
        members that stand again later in the object, and so do not count.
    label
        what the ledger calls the object, in place of its place in the document.
    """

    __slots__ = ("doubled", "fates", "label")

    def __init__(self, pairs: list[tuple[str, Any]]) -> None:
        super().__init__(pairs)
        self.fates: dict[str, Fate] = {}
        self.doubled: Sequence[tuple[str, Any]] = ()
        self.label = ""
        if len(self) < len(pairs):
            last = {key: k for k, (key, _) in enumerate(pairs)}
            self.doubled = [pair for k, pair in enumerate(pairs) if last[pair[0]] != k]

    def __getitem__(self, key: str) -> Any:
        self._take(key)
        return super().__getitem__(key)

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value of a member, and mark the member as read."""
        self._take(key)
        return super().get(key, default)

    def peek(self, key: str) -> Any:
        """Return the value of a member without marking it as read."""
        return super().get(key)

    def _take(self, key: str) -> None:
        if key in self:
            self.fates.setdefault(key, _READ)

    def say(self, fate: Fate, *keys: str) -> None:
        """Say what becomes of members; of all that are there, if none is named."""
        for key in keys or self:
            if key in self:
                self.fates[key] = fate


def parse_tracked(text: str) -> Any:
    """Return the value of a JSON text, its objects tracked.

    Raises
    ------
    json.JSONDecodeError
        if the text is no JSON.
    ValueError
        if it has a number that JSON has not.
    RecursionError
        if it is nested very deep.
    """
    return json.loads(text, parse_constant=_no_number, object_pairs_hook=Tracked)


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number in JSON")


FateOf = Callable[[Tracked, str], Fate | None]
"""Returns the fate of a member where something else than access says it."""


def enter_json(book: LedgerBook, root: Any, fate_of: FateOf = lambda _, __: None) -> None:
    """Give the ledger each member of each object of a document, however deep it is nested.

    What is within a member that is passed over is counted with that member.
    """
    rest: list[tuple[Any, str, str, Fate | None]] = [(root, "", "", None)]
    while rest:
        value, kind, where, inherited = rest.pop()
        within: list[tuple[Any, str, str, Fate | None]] = []
        if isinstance(value, Tracked):
            kind = value.label or kind
            members: list[tuple[str, Any, Fate | None]] = [(key, member, _AGAIN) for key, member in value.doubled]
            members += [(key, member, None) for key, member in value.items()]
            for key, member, again in members:
                own_where = f"{where}.{key}".lstrip(".")
                said = inherited or again or fate_of(value, key)
                within_lost = inherited is not None or (said is not None and said.how != "read" and value.label)
                own_kind = kind if within_lost else f"{kind}.{key}".lstrip(".")
                fate = said or value.fates.get(key) or _untaken(member)
                book.add(own_kind, fate, own_where)
                if isinstance(member, list | Tracked):
                    within.append((member, own_kind, own_where, None if fate.how == "read" else fate))
        else:
            within += [
                (item, kind if inherited else f"{kind}[]", f"{where}[{k}]", inherited)
                for k, item in enumerate(value)
                if _holds_objects(item)
            ]
        rest += reversed(within)


def _holds_objects(item: object) -> bool:
    """Whether a value is an object, or a list in which objects may be; a position is none."""
    return isinstance(item, Tracked) or (
        isinstance(item, list) and any(isinstance(one, list | Tracked) for one in item)
    )


def _untaken(member: object) -> Fate:
    return EMPTY if member is None or member == "" or (isinstance(member, list | dict) and not member) else UNKNOWN
