"""A draft is checked when nobody has typed for a moment, and saved on the version that it came from."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import Any

import pytest

from muster.mission.errors import NetworkError
from muster_control.contract import ConflictError, MissionVersion, User
from muster_control.pages.editing.draft import Draft

WHO = User("anna", "command")
FIRST = MissionVersion(mission="yard", version=1, text="name: a\n", author="anna", at=None)


class Missions:
    """As the services', with one mission."""

    def __init__(self) -> None:
        self.newest = FIRST
        self.checked: list[str] = []

    async def check(self, text: str, files: object) -> dict[str, Any]:
        self.checked.append(text)
        await asyncio.sleep(0.01)
        return {"errors": [], "impossible": [], "cut_off": [], "mission": {"name": text}, "floor": None}

    async def edit(self, text: str, change: str, *arguments: str) -> str:
        await asyncio.sleep(0)
        if change == "fail":
            raise ValueError(text)
        return text.replace(*arguments) if change == "replace" else text + arguments[0]

    async def save(self, who: User, mission: str, text: str, base: int, files: object = None, note: str = "") -> Any:
        await asyncio.sleep(0)
        if base != self.newest.version:
            raise ConflictError("another one was saved")
        self.newest = replace(self.newest, version=base + 1, text=text, author=who.name)
        return self.newest


def test_a_text_is_checked_once_it_is_quiet() -> None:
    missions = Missions()
    draft = Draft(missions, FIRST)
    asyncio.run(draft.tick())
    assert missions.checked == ["name: a\n"]
    draft.typed("name: b\n")
    asyncio.run(draft.tick())
    assert len(missions.checked) == 1  # somebody types
    asyncio.run(draft.edit("replace", "b", "c"))
    asyncio.run(draft.tick())
    assert missions.checked[1:] == ["name: c\n"]
    assert draft.checked.mission == {"name": "name: c\n"}
    asyncio.run(draft.tick())
    assert len(missions.checked) == 2


def test_a_text_whose_check_failed_is_checked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    missions = Missions()
    draft, check = Draft(missions, FIRST), missions.check

    async def fails(*arguments: Any) -> Any:
        raise NetworkError("the worker died; expected it to be asked again")

    monkeypatch.setattr(missions, "check", fails)
    with pytest.raises(NetworkError):
        asyncio.run(draft.tick())
    monkeypatch.setattr(missions, "check", check)
    monkeypatch.setattr("muster_control.pages.editing.draft._QUIET_S", -1.0)
    asyncio.run(draft.tick())
    assert missions.checked == ["name: a\n"]


def test_a_check_is_of_the_text_as_it_is_until_the_next_edit_is_asked_for() -> None:
    async def story() -> list[bool]:
        draft, seen = Draft(Missions(), FIRST), []
        draft.on_check.append(lambda: seen.append(draft.is_checked))
        await draft.tick()
        edit = asyncio.create_task(draft.edit("append", "# one\n"))
        await asyncio.sleep(0)
        assert not draft.is_checked
        await edit
        check = asyncio.create_task(draft.tick())  # of the text with one
        await asyncio.sleep(0)
        await draft.edit("append", "# two\n")
        await check
        await draft.tick()
        return seen

    assert asyncio.run(story()) == [True, False, True]


def test_saving_knows_of_others_and_loses_nothing() -> None:
    missions = Missions()
    mine, theirs = Draft(missions, FIRST), Draft(missions, FIRST)
    asyncio.run(theirs.edit("append", "# theirs\n"))
    asyncio.run(theirs.save(WHO))
    asyncio.run(mine.edit("append", "# mine\n"))
    with pytest.raises(ConflictError):
        asyncio.run(mine.save(WHO))
    assert not mine.is_saved
    mine.load(missions.newest, mine.text)
    asyncio.run(mine.save(WHO))
    assert (missions.newest.version, missions.newest.text) == (3, "name: a\n# mine\n")
    assert mine.is_saved
    asyncio.run(mine.undo())
    assert mine.text == "name: a\n"
    assert not mine.is_saved


def test_who_saves_twice_at_once_saves_once_and_is_not_in_their_own_way() -> None:
    async def story() -> list[bool]:
        missions = Missions()
        draft = Draft(missions, FIRST)
        draft.typed("name: b\n")
        saved = await asyncio.gather(draft.save(WHO), draft.save(WHO))
        assert (missions.newest.version, draft.base) == (2, missions.newest)
        return saved

    assert asyncio.run(story()) == [True, False]


def test_edits_asked_for_before_are_waited_for() -> None:
    async def story() -> str:
        draft = Draft(Missions(), FIRST)
        edit = asyncio.create_task(draft.edit("append", "# later\n"))
        await asyncio.sleep(0)
        assert draft.is_saved
        await draft.settled()
        assert edit.done()
        return draft.text

    assert asyncio.run(story()).endswith("# later\n")


def test_undo_right_after_an_edit_takes_back_that_edit_and_keeps_it_for_redo() -> None:
    async def story() -> None:
        draft = Draft(Missions(), FIRST)
        draft.typed("name: b\n")
        edit = asyncio.create_task(draft.edit("append", "# later\n"))
        await asyncio.sleep(0)
        assert draft.is_editing
        await draft.undo()
        assert edit.done()
        assert (draft.text, draft.can_redo) == ("name: b\n", True)
        await draft.redo()
        assert draft.text == "name: b\n# later\n"

    asyncio.run(story())


def test_a_draft_says_when_an_edit_begins_and_ends_and_can_be_undone_meanwhile() -> None:
    draft, seen = Draft(Missions(), FIRST), []
    draft.on_wait.append(lambda: seen.append((draft.is_editing, draft.can_undo)))
    with pytest.raises(ValueError, match="name"):
        asyncio.run(draft.edit("fail"))
    assert seen == [(True, True), (False, False)]


def test_an_edit_that_fails_changes_nothing() -> None:
    draft, kinds = Draft(Missions(), FIRST), []
    draft.on_change.append(kinds.append)
    with pytest.raises(ValueError, match="name"):
        asyncio.run(draft.edit("fail"))
    assert (draft.text, draft.can_undo, kinds) == ("name: a\n", False, [])


def test_edits_come_one_after_the_other_and_on_top_of_what_is_typed_meanwhile() -> None:
    draft = Draft(Missions(), FIRST)

    async def edited() -> None:
        under_way = [asyncio.create_task(draft.edit("append", word)) for word in ("b", "c")]
        await asyncio.sleep(0)
        draft.typed("typed ")
        await asyncio.gather(*under_way)

    asyncio.run(edited())
    assert draft.text == "typed bc"
