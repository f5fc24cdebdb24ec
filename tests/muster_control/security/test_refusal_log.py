"""Logins and refusals in the audit log, and what of it is on its way there when the server ends."""

import asyncio

from muster_control.contract import User
from muster_control.security.refusal_log import Audit


def _settled(keep, monkeypatch):
    monkeypatch.setattr("muster_control.security.refusal_log._SETTLES_S", 0.1)

    async def story():
        audit = Audit(lambda: keep)
        audit.logged_in(User("ann", "command", "127.0.0.1"))
        await asyncio.wait_for(audit.settle(), 20)

    asyncio.run(story())


def test_what_the_database_takes_is_waited_for(monkeypatch):
    kept = []

    async def keep(who, verb, data):
        await asyncio.sleep(0)
        kept.append((who.name, verb))

    _settled(keep, monkeypatch)
    assert kept == [("ann", "login")]


def test_a_database_that_does_not_answer_keeps_no_server_from_ending(monkeypatch):
    async def keep(*_):
        await asyncio.Event().wait()

    _settled(keep, monkeypatch)


def test_an_entry_tells_how_many_refusals_were_left_out_before_it():
    now_s, kept = 0.0, []

    async def keep(who, verb, data):
        kept.append((who.address, data))

    async def story():
        nonlocal now_s
        audit = Audit(lambda: keep, clock=lambda: now_s)
        for address in ("10.0.0.1", "10.0.0.1", "10.0.0.1", "10.0.0.2"):
            audit.forbade(User("wall", "watch", address), "run.pause", "no")
        now_s = 10.0
        audit.forbade(User("wall", "watch", "10.0.0.1"), "run.pause", "no")
        await audit.settle()

    asyncio.run(story())
    said = {"why": "no", "command": "run.pause"}
    assert kept == [("10.0.0.1", said), ("10.0.0.2", said | {"left_out": 2}), ("10.0.0.1", said)]
