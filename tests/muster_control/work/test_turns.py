"""Turns: nobody's work keeps that of others waiting, whatever comes in whichever order."""

import asyncio
from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_control.contract import BusyError
from muster_control.work.turns import Turns


class Yard:
    """Pieces of work that last until they are ended."""

    def __init__(self, turns):
        self.turns = turns
        self.begun = []
        self.ends = {}
        self.tasks = {}

    def ask(self, user, piece):
        self.ends[piece] = asyncio.Event()
        self.tasks[piece] = asyncio.create_task(self._work(user, piece))

    async def _work(self, user, piece):
        async with self.turns.turn(user):
            self.begun.append(piece)
            await self.ends[piece].wait()

    async def end(self, piece):
        self.ends[piece].set()
        await self.tasks[piece]
        await settle()


async def settle():
    """Until nothing happens any more without somebody."""
    for _ in range(5):
        await asyncio.sleep(0)


def in_yard(story, *places, **limits):
    async def whole():
        return await story(Yard(Turns(*places, **limits)))

    return asyncio.run(whole())


def test_the_reserve_is_for_others():
    async def story(yard):
        for k in range(6):
            yard.ask("wall", f"w{k}")
        await settle()
        assert yard.begun == ["w0", "w1"]  # one place stays free
        yard.ask("anna", "a0")
        await settle()
        assert yard.begun == ["w0", "w1", "a0"]
        assert (yard.turns.taken, yard.turns.waiting) == (3, 4)

    in_yard(story, 3, 2)


def test_users_take_turns():
    async def story(yard):
        for piece in ("w0", "w1", "w2", "a0", "a1", "b0"):
            yard.ask({"w": "wall", "a": "anna", "b": "bob"}[piece[0]], piece)
        await settle()
        for _ in list(yard.ends):
            await yard.end(yard.begun[-1])
        return yard.begun

    assert in_yard(story, 1, 1) == ["w0", "a0", "b0", "w1", "a1", "w2"]


def test_who_comes_later_waits_for_one_piece_of_another_at_most():
    async def story(yard):
        for k in range(5):
            yard.ask("wall", f"w{k}")
        await settle()
        await yard.end("w0")
        yard.ask("anna", "a0")
        await settle()
        await yard.end("w1")
        return yard.begun

    assert in_yard(story, 1, 1) == ["w0", "w1", "a0"]


def test_users_who_come_again_and_again_keep_nobody_waiting():
    """Ada and Bob each ask anew as soon as the piece before is done: both are as new each time."""

    async def story(yard):
        for piece in ("w0", "w1", "w2"):
            yard.ask("wall", piece)
        await settle()
        for k in range(3):
            yard.ask("ada", f"a{k}")
            await settle()
            await yard.end(yard.begun[-1])
            yard.ask("bob", f"b{k}")
            await settle()
            await yard.end(yard.begun[-1])
        begun = list(yard.begun)
        for task in yard.tasks.values():
            task.cancel()
        return begun

    assert in_yard(story, 1, 1) == ["w0", "a0", "w1", "b0", "a1", "w2", "b1"]


def test_what_is_cancelled_while_it_waits_or_in_the_moment_of_its_turn_keeps_no_place():
    async def story(yard):
        for piece in ("w0", "w1", "w2"):
            yard.ask("wall", piece)
        await settle()
        yard.tasks["w1"].cancel()
        await settle()
        yard.ends["w0"].set()
        await asyncio.sleep(0)  # w0 ends: w2 has its turn, and has not begun
        yard.tasks["w2"].cancel()
        await settle()
        assert yard.begun == ["w0"]
        assert (yard.turns.taken, yard.turns.waiting) == (0, 0)
        yard.ask("wall", "w3")
        await settle()
        assert yard.begun == ["w0", "w3"]

    in_yard(story, 1, 1)


def test_only_so_much_waits_in_all_and_of_one():
    async def story(yard):
        for k in range(3):
            yard.ask("wall", f"w{k}")
        await settle()
        with pytest.raises(BusyError, match=r"^2 requests of wall wait, the most that may; expected [^\n]*$"):
            async with yard.turns.turn("wall"):
                pass
        yard.ask("anna", "a0")
        await settle()
        with pytest.raises(BusyError, match=r"^3 requests wait, the most that may; expected [^\n]*$"):
            async with yard.turns.turn("bob"):
                pass

    in_yard(story, 1, 1, waiting=3, waiting_of_one=2)


@given(
    st.lists(st.tuples(st.sampled_from("abc"), st.sampled_from(["ask", "end", "cancel"])), max_size=40),
    st.integers(1, 3),
    st.integers(1, 3),
)
def test_places_are_never_idle_while_somebody_may_have_one(events, places, most_of_one):
    async def story(yard):
        for number, (user, what) in enumerate(events):
            open_pieces = [piece for piece, task in yard.tasks.items() if not task.done()]
            if what == "ask":
                yard.ask(user, f"{user}{number}")
            elif open_pieces and what == "end":
                under_way = [piece for piece in yard.begun if not yard.tasks[piece].done()]
                await yard.end(under_way[0])
            elif open_pieces:
                yard.tasks[open_pieces[-1]].cancel()
            await settle()
            left = [piece for piece, task in yard.tasks.items() if not task.done()]
            held = Counter(piece[0] for piece in left if piece in yard.begun)
            waiting = {piece[0] for piece in left if piece not in yard.begun}
            assert yard.turns.taken == held.total() <= places
            assert all(count <= most_of_one for count in held.values())
            assert not any(held[user] < most_of_one for user in waiting) or yard.turns.taken == places
        for task in yard.tasks.values():
            task.cancel()
        await settle()
        assert (yard.turns.taken, yard.turns.waiting) == (0, 0)
        assert not yard.turns._queues
        assert not yard.turns._last_turn

    in_yard(story, places, min(most_of_one, places))
