"""Edits change what they say, and nothing else: neither other values nor comments nor the layout of other lines."""

from __future__ import annotations

import copy
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from muster.library import shipped as library
from muster_control.work.editing.edits import EditError, append, data_of, remove, set_value

COMMENTED = """\
# A mission
schema: muster/1   # the format
name: "31T"
robots:
  # the first team
  - {id: r_0, position: [5, -8], type: beta,
     radius_m: 0.3}   # inflated
  - id: r_1
    position:   # where
      - 1.50
      - 2
    skills: [a, b]

tasks:
- {id: 0, position: [-4.711, 5.841]}   # by the wall
# the last one
- {id: 1, position: [1, 1], prerequisites: [0]}
"""


def test_a_moved_robot_changes_its_own_numbers_alone() -> None:
    after = set_value(COMMENTED, ("robots", 0, "position"), [6.25, -8])
    assert after == COMMENTED.replace("[5, -8]", "[6.25, -8]")


def test_a_place_in_lines_becomes_one_line() -> None:
    after = set_value(COMMENTED, ("robots", 1, "position"), [3, 4])
    assert "    position: [3, 4]\n    skills: [a, b]" in after
    assert data_of(after)["robots"][1]["position"] == [3, 4]


def test_a_key_is_added_where_it_belongs() -> None:
    flow = set_value(COMMENTED, ("robots", 0, "speed_mps"), 2)
    assert "radius_m: 0.3, speed_mps: 2}   # inflated" in flow
    block = set_value(COMMENTED, ("robots", 1, "speed_mps"), 0.5)
    assert "    skills: [a, b]\n    speed_mps: 0.5\n" in block


def test_a_task_is_appended_as_the_others_stand() -> None:
    after = append(COMMENTED, ("tasks",), {"id": "2", "position": [0, 0.5]})
    assert after == COMMENTED + "- {id: 2, position: [0, 0.5]}\n"


@pytest.mark.parametrize("text", ["a: 1\ntasks:\n", "a: 1\ntasks: []\n", "a: 1\n", "tasks: null  # none yet\na: 1"])
def test_the_first_task_makes_the_list(text: str) -> None:
    after = append(text, ("tasks",), {"id": "2", "position": [0, 0.5]})
    assert data_of(after) == {"a": 1, "tasks": [{"id": 2, "position": [0, 0.5]}]}


def test_a_removed_task_leaves_the_comments_of_the_others() -> None:
    after = remove(COMMENTED, ("tasks", 1))
    assert after == COMMENTED.replace("- {id: 1, position: [1, 1], prerequisites: [0]}\n", "")


def test_what_others_share_is_not_changed_behind_their_backs() -> None:
    text = "robots:\n  - {id: a, position: &p [1, 2]}\n  - {id: b, position: *p}\n"
    with pytest.raises(EditError, match="change it in the text itself"):
        set_value(text, ("robots", 0, "position"), [3, 4])
    with pytest.raises(EditError):
        set_value(text, ("robots", 0, "position", 0), 9)
    assert data_of(set_value(text, ("robots", 1, "position"), [3, 4]))["robots"][0]["position"] == [1, 2]


def test_a_bomb_is_edited_without_blowing_it_up() -> None:
    rows = ["a0: &a0 [x, x]"] + [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 9)]
    text = "\n".join([*rows, "name: n"])
    with pytest.raises(EditError, match="large"):
        set_value(text, ("name",), "m")


SHIPPED = [name for name in library.mission_names() if str(library.mission_path(name)).endswith(".yaml")]


@pytest.mark.long(keep=12)
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_missions_are_edited_in_place(name: str) -> None:
    path = library.mission_path(name)
    assert path is not None
    text = path.read_text(encoding="utf-8")
    data = data_of(text)
    placed = [k for k, task in enumerate(data["tasks"]) if "position" in task]  # an area may be without
    for k in placed[::15]:
        after = set_value(text, ("tasks", k, "position"), [9.5] * len(data["tasks"][k]["position"]))
        changed = [(a, b) for a, b in zip(text.splitlines(), after.splitlines(), strict=True) if a != b]
        assert len(changed) == 1


WORDS = st.text("abc01 _:#-{}[],'\"&*é\U0001f916", min_size=1, max_size=6)
VALUES = st.recursive(
    st.one_of(st.integers(-99, 99), st.floats(-1e3, 1e3).map(lambda x: round(x, 3)), WORDS, st.booleans(), st.none()),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(WORDS, inner, max_size=3)),
    max_leaves=8,
)
ITEMS = st.dictionaries(st.sampled_from(["id", "type", "position", "skills", "priority"]), VALUES, min_size=1)
MISSIONS = st.fixed_dictionaries(
    {"name": WORDS, "robots": st.lists(ITEMS, max_size=4), "tasks": st.lists(ITEMS, max_size=4)}
)


@st.composite
def texts(draw: st.DrawFn) -> str:
    """Missions in any layout, with comments at the ends of some lines and between them."""
    style = draw(st.sampled_from([None, False, True]))
    text = str(yaml.safe_dump(draw(MISSIONS), default_flow_style=style, sort_keys=False, allow_unicode=True, width=60))
    if draw(st.booleans()) and style is not True:
        text = "".join(f"{line}\n# note {k}\n" if line.startswith(("name", "-", "robots", "tasks")) else f"{line}\n"
                       for k, line in enumerate(text.splitlines()))  # fmt: skip
    return text


@pytest.mark.long
@given(text=texts(), value=VALUES, data=st.data())
def test_an_edit_is_exact_or_refused(text: str, value: Any, data: st.DataObject) -> None:
    before = data_of(text) if _is_mission(text) else None
    if before is None:
        return
    team = data.draw(st.sampled_from(["robots", "tasks"]))
    items = before[team] or []
    kind = data.draw(st.sampled_from(["set", "append", "remove"] if items else ["append"]))
    wanted = copy.deepcopy(before)
    if kind == "append":
        after, wanted[team] = append(text, (team,), {"id": value}), [*items, {"id": value}]
    else:
        k = data.draw(st.integers(0, len(items) - 1))
        key = data.draw(st.sampled_from(["id", "type", "new"]))
        if kind == "set":
            after = set_value(text, (team, k, key), value)
            wanted[team][k][key] = value
        else:
            after = remove(text, (team, k))
            del wanted[team][k]
    assert _same(data_of(after)) == _same(wanted)
    if kind != "remove":
        notes = [line for line in text.splitlines() if line.startswith("# note")]
        assert [line for line in after.splitlines() if line.startswith("# note")] == notes


def _is_mission(text: str) -> bool:
    return isinstance(yaml.safe_load(text), dict)


def _same(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _same(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_same(value) for value in data]
    if isinstance(data, (int, float)) and not isinstance(data, bool):
        return float(data)
    return float(data) if isinstance(data, str) and data.isdecimal() and data.isascii() else data
