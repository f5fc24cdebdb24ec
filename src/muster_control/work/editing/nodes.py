"""Positions of all values in a YAML text: a tree of spans, built from PyYAML's events.

Only structure is read here; aliases are not followed, so a text costs no more than its length.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

_DEEPEST = 20  # as in missions
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

Path = tuple[str | int, ...]


class NodesError(ValueError):
    """The text has no such structure."""


@dataclass
class Node:
    """A value: `text[start:end]`; `column` is where it begins in its line.

    Parameters
    ----------
    kind
        `scalar`, `sequence`, `mapping` or `alias`.
    flow
        whether it stands in brackets or braces.
    keys, values
        of a mapping both; of a sequence the values alone.
    """

    kind: str
    start: int
    end: int
    column: int
    text: str = ""
    flow: bool = True
    keys: list[Node] = field(default_factory=list)
    values: list[Node] = field(default_factory=list)

    def child(self, step: str | int) -> Node:
        """The value at a key or a place; raises NodesError where there is none."""
        at = self.place(step)
        if at is None:
            raise NodesError(f"nothing at {step}")
        return self.values[at]

    def place(self, step: str | int) -> int | None:
        """Where among the values a key or a place is, or None."""
        if self.kind == "mapping":
            return next((k for k, key in enumerate(self.keys) if key.text == str(step)), None)
        return step if isinstance(step, int) and self.kind == "sequence" and step < len(self.values) else None


def read_nodes(text: str) -> Node:
    """The tree of a text; raises NodesError where it is no single document of YAML."""
    events = yaml.parse(text, Loader=_Loader)
    try:
        next(events)
        if isinstance(next(events), yaml.StreamEndEvent):
            raise NodesError("an empty text")
        return _node(next(events), events, text, 0)
    except yaml.YAMLError as error:
        raise NodesError(str(error)) from None


def find(root: Node, path: Path) -> Node:
    """The node at a path; raises NodesError where there is none."""
    for step in path:
        root = root.child(step)
    return root


def _node(event: Any, events: Iterator[Any], text: str, depth: int) -> Node:
    start, end, column = event.start_mark.index, event.end_mark.index, event.start_mark.column
    if depth > _DEEPEST:
        raise NodesError("nested too deep")
    if isinstance(event, yaml.AliasEvent):
        return Node("alias", start, end, column)
    if isinstance(event, yaml.ScalarEvent):
        while end > start and text[end - 1] in "\r\n":  # a block scalar goes on to the next line
            end -= 1
        return Node("scalar", start, end, column, event.value)
    flow = bool(event.flow_style)
    if isinstance(event, yaml.SequenceStartEvent):
        node = Node("sequence", start, end, column, flow=flow)
        while not isinstance(event := next(events), yaml.SequenceEndEvent):
            node.values.append(_node(event, events, text, depth + 1))
    else:
        node = Node("mapping", start, end, column, flow=flow)
        while not isinstance(event := next(events), yaml.MappingEndEvent):
            node.keys.append(_node(event, events, text, depth + 1))
            node.values.append(_node(next(events), events, text, depth + 1))
    node.end = event.end_mark.index if flow else max([node.start, *(value.end for value in node.values)])
    return node
