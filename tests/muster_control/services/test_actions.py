"""What users do is written down before it is done."""

import asyncio
from contextlib import closing, nullcontext

import pytest

from muster_control.contract import ConflictError, ForbiddenError, StoreError, User
from muster_control.services.actions import Actions
from muster_control.store import Store

ANN = User("ann", "command")
BO = User("bo", "watch")


@pytest.fixture
def store(tmp_path):
    with closing(Store.open(f"sqlite:///{tmp_path}/muster.db")) as store:
        yield store


async def do(actions, error=None):
    async with actions.of(ANN, "run.pause", {"n": 1}) as action:
        [under_way] = await actions.list(limit=1)
        assert (under_way, under_way.outcome) == (action, "")
        if error is not None:
            raise error


def test_what_comes_of_it(store):
    async def story():
        actions = Actions(store)
        await do(actions)
        for error in (ConflictError("it is over\nreally"), ZeroDivisionError("x"), ConflictError("y" * 600)):
            with pytest.raises(type(error)):
                await do(actions, error)
        added = await actions.add(ANN, "login", {})
        store.actions.settle(added.id, "done", 1.5)
        found = await actions.list(limit=5)
        assert [a.outcome for a in found] == ["done", "y" * 500, "broken off: ZeroDivisionError", "it is over", "done"]
        assert [a.id for a in await actions.list(before=found[1].id)] == [a.id for a in found[2:]]

    asyncio.run(story())


@pytest.mark.parametrize("error", [None, ConflictError("it is over"), ZeroDivisionError("x")])
def test_what_came_of_it_is_told_also_where_it_cannot_be_written(store, monkeypatch, caplog, error):
    def refuse(*_):
        raise StoreError("the disk is full")

    monkeypatch.setattr(store.actions, "settle", refuse)
    with nullcontext() if error is None else pytest.raises(type(error), match=str(error)):
        asyncio.run(do(Actions(store), error))
    assert [action.outcome for action in store.actions.list()] == [""]
    assert "its outcome is not written down" in caplog.text


def test_whoever_goes_away_leaves_a_line(store):
    async def story():
        actions = Actions(store)

        async def forever():
            async with actions.of(ANN, "mission.save", {}):
                await asyncio.sleep(3600)

        task = asyncio.create_task(forever())
        while not await actions.list():
            await asyncio.sleep(0.01)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        assert [a.outcome for a in await actions.list()] == ["broken off: CancelledError"]

    asyncio.run(story())


def test_who_may_only_watch_is_told_of(store):
    told = []
    actions = Actions(store, lambda *what: told.append(what))

    async def story():
        with pytest.raises(ForbiddenError):
            async with actions.of(BO, "mission.save", {}):
                raise AssertionError("it is done")
        await do(actions)

    asyncio.run(story())
    assert told == [(BO, "mission.save", "bo may only watch; expected the role command")]
    assert [action.verb for action in store.actions.list()] == ["run.pause"]
