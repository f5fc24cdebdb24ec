"""Sets, adds and removes values in a YAML text; all other text stays as it is, character by character.

Every edit is checked: the new text must hold what the old one held, with the change and nothing else. Where that cannot
be had by a small change (a value that other places share by an alias), the edit is refused.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import MissionError, MusterError
from muster.mission.reading.yaml_reader import parse_data
from muster.mission.yaml_writer import flow_text
from muster_control.work.editing.nodes import Node, NodesError, Path, find, read_nodes

_FILE = FilePath("mission")
_INDENT = "  "
_MOST_VALUES = 1_000_000  # that a text may hold to be edited here, aliases written out


class EditError(MusterError):
    """The text cannot be changed so by a small edit; it says what to do instead."""


def data_of(text: str) -> dict[str, Any]:
    """What a text holds, plain; raises MissionError where it is no YAML."""
    return parse_data(text, _FILE, "a mission: schema, robots, tasks")[0]


def set_value(text: str, path: Path, value: object) -> str:
    """Give the value at `path` another one; a key that is not there is added to its mapping.

    Raises
    ------
    MissionError
        if the text is no YAML.
    EditError
        if nothing stands there, or it cannot be changed alone.
    """

    def changed(root: Node) -> str:
        owner = find(root, path[:-1])
        at = owner.place(path[-1])
        return _added(text, owner, str(path[-1]), value) if at is None else _replaced(text, owner, at, value)

    return _checked(text, changed, path, lambda owner, step: _put(owner, step, value))


def set_values(text: str, values: Mapping[Path, object]) -> str:
    """Give values that are there others, all at once; raises as `set_value`."""
    if not values:
        return text

    def changed(root: Node) -> str:
        places = []
        for path, value in values.items():
            owner = find(root, path[:-1])
            at = owner.place(path[-1])
            if at is None:
                raise NodesError("nothing there")
            places.append((owner.values[at].start, owner, at, value))
        new = text
        for _, owner, at, value in sorted(places, key=lambda place: -place[0]):  # from the end: earlier places stay
            new = _replaced(new, owner, at, value)
        return new

    first = next(iter(values))

    def expected(root: Any) -> None:
        for path, value in values.items():
            _put(_walk(root, path[:-1]), path[-1], value)

    return _compared(text, changed, first, expected)


def append(text: str, path: Path, value: object) -> str:
    """Put a value at the end of the list at `path`, which is made where it is missing; raises as `set_value`."""

    def changed(root: Node) -> str:
        owner = find(root, path[:-1])
        at = owner.place(path[-1])
        if at is None:
            return _added(text, owner, str(path[-1]), [value], as_lines=True)
        return _appended(text, owner, at, value)

    def expected(owner: Any, step: str | int) -> None:
        missing = step not in owner if isinstance(owner, dict) else False
        items = [] if missing or owner[step] is None else owner[step]
        _put(owner, step, [*items, value])

    return _checked(text, changed, path, expected)


def remove(text: str, path: Path) -> str:
    """Take out the value at `path`, with its key; raises as `set_value`."""

    def changed(root: Node) -> str:
        owner = find(root, path[:-1])
        at = owner.place(path[-1])
        if at is None:
            raise NodesError("nothing there")
        if len(owner.values) == 1 and not owner.flow and len(path) > 1:
            above = find(root, path[:-2])
            place = above.place(path[-2])
            assert place is not None
            return _replaced(text, above, place, [] if owner.kind == "sequence" else {})
        return _without(text, owner, at)

    def expected(owner: Any, step: str | int) -> None:
        if isinstance(owner, dict):
            del owner[str(step)]
        else:
            del owner[int(step)]

    return _checked(text, changed, path, expected)


def _checked(text: str, changed: Callable[[Node], str], path: Path, expected: Callable[[Any, str | int], None]) -> str:
    """The changed text, if it holds what it should: `expected` changes the owner of what is at `path`."""
    return _compared(text, changed, path, lambda root: expected(_walk(root, path[:-1]), path[-1]))


def _walk(data: Any, path: Path) -> Any:
    for step in path:
        data = data[step]
    return data


def _compared(text: str, changed: Callable[[Node], str], path: Path, expected: Callable[[Any], None]) -> str:
    """The changed text, if it holds what `expected` makes of all that was in it; `path` is what an error names."""
    before = data_of(text)
    if size_of(before) > _MOST_VALUES:
        raise EditError("the mission is too large to be edited here; change it in the text itself")
    wanted = _written_out(before)
    try:
        expected(wanted)
        after = changed(read_nodes(text))
        if _plain(data_of(after)) == _plain(wanted):
            return after
    except (NodesError, KeyError, IndexError, TypeError, MissionError):
        pass
    where = ".".join(str(step) for step in path)
    raise EditError(f"{where}: this place of the text cannot be changed from here; change it in the text itself")


def size_of(data: Any) -> int:
    """How many values data of a text holds, what aliases name written out."""
    return _size(data, {})


def _size(data: Any, known: dict[int, int]) -> int:
    """Each value is looked at once."""
    if id(data) not in known:
        inner = data.values() if isinstance(data, dict) else data if isinstance(data, list) else ()
        known[id(data)] = 1 + sum(_size(value, known) for value in inner)
    return known[id(data)]


def _written_out(data: Any) -> Any:
    """A copy in which nothing is shared."""
    if isinstance(data, dict):
        return {key: _written_out(value) for key, value in data.items()}
    return [_written_out(value) for value in data] if isinstance(data, list) else data


def _put(owner: Any, step: str | int, value: object) -> None:
    owner[step if isinstance(owner, list) else str(step)] = value


def _plain(data: Any) -> Any:
    """Data as it compares: numbers by value, and words that are written as numbers as such."""
    if isinstance(data, dict):
        return {key: _plain(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_plain(value) for value in data]
    return str(data) if type(data) is int else repr(data) if isinstance(data, float) and data % 1 else _whole(data)


def _whole(data: Any) -> Any:
    return str(int(data)) if isinstance(data, float) and abs(data) < 1e15 else data


def _replaced(text: str, owner: Node, at: int, value: object) -> str:
    node = owner.values[at]
    new = flow_text(value)
    if owner.kind == "mapping" and (node.start == node.end or not node.flow):  # nothing, or lines below the key
        colon = _colon(text, owner.keys[at])
        return text[:colon] + " " + new + text[max(node.end, colon) :]
    return text[: node.start] + new + text[node.end :]


def _colon(text: str, key: Node) -> int:
    found = re.compile(r"\s*:").match(text, key.end)
    if not found:
        raise NodesError("a key without a colon")
    return found.end()


def _added(text: str, owner: Node, key: str, value: object, as_lines: bool = False) -> str:
    if owner.kind != "mapping":
        raise NodesError("no mapping")
    entry = f"{flow_text(key)}: {flow_text(value)}"
    if owner.flow:
        at = owner.values[-1].end if owner.values else owner.start + 1
        return text[:at] + (", " if owner.values else "") + entry + text[at:]
    indent = " " * owner.keys[0].column
    if as_lines and isinstance(value, list):
        entry = f"{flow_text(key)}:" + "".join(f"\n{indent}{_INDENT}- {flow_text(item)}" for item in value)
    at = _line_end(text, owner.end)
    return f"{text[:at]}\n{indent}{entry}{text[at:]}"


def _appended(text: str, owner: Node, at: int, value: object) -> str:
    node = owner.values[at]
    new = flow_text(value)
    if not node.values and not owner.flow and node.kind in ("scalar", "sequence"):  # nothing, or []
        if node.kind == "scalar" and node.text.lower() not in ("", "null", "~"):
            raise NodesError("no list")
        colon = _colon(text, owner.keys[at])
        return f"{text[:colon]}\n{' ' * owner.keys[0].column}{_INDENT}- {new}{text[max(node.end, colon) :]}"
    if node.kind != "sequence":
        raise NodesError("no list")
    if node.flow:
        place = node.values[-1].end if node.values else node.start + 1
        return text[:place] + (", " if node.values else "") + new + text[place:]
    place = _line_end(text, node.end)
    return f"{text[:place]}\n{' ' * _column(text, _dash(text, node.values[-1]))}- {new}{text[place:]}"


def _dash(text: str, item: Node) -> int:
    before = text[: item.start].rstrip()
    if not before.endswith("-"):
        raise NodesError("an item without a dash")
    return len(before) - 1


def _without(text: str, owner: Node, at: int) -> str:
    starts = [key.start for key in owner.keys] or [value.start for value in owner.values]
    if owner.flow:
        last = at == len(starts) - 1
        begin = owner.values[at - 1].end if last and at else starts[at]
        return text[:begin] + text[owner.values[at].end if last else starts[at + 1] :]
    begin = _dash(text, owner.values[at]) if owner.kind == "sequence" else starts[at]
    line = begin - _column(text, begin)
    if text[line:begin].strip():  # it stands behind the dash of what it is part of
        following = _dash(text, owner.values[at + 1]) if owner.kind == "sequence" else starts[at + 1]
        return text[:begin] + text[following:]
    end = _line_end(text, max(owner.values[at].end, begin))
    return text[:line] + text[end + 1 :] if end < len(text) else text[: max(line - 1, 0)]


def _column(text: str, at: int) -> int:
    return at - (text.rfind("\n", 0, at) + 1)


def _line_end(text: str, at: int) -> int:
    end = text.find("\n", at)
    return len(text) if end < 0 else end
