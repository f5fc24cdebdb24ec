"""What is on its way to the audit log when the server ends."""

import asyncio

from muster.exchange.mission_control import User
from muster.server.security.refusal_log import Audit


def _settled(keep, monkeypatch):
    monkeypatch.setattr("muster.server.security.refusal_log._SETTLES_S", 0.1)

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
