"""Undo goes back over every step, redo forth again, and what is done after an undo ends what was undone."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from muster_control.pages.editing.history import History


@given(texts=st.lists(st.text(max_size=3), max_size=30))
def test_undo_and_redo_walk_over_all_texts(texts: list[str]) -> None:
    history, kept = History("begin"), ["begin"]
    for text in texts:
        history.change(text)
        if text != kept[-1]:
            kept.append(text)
    assert [history.text, *(history.undo() for _ in kept[1:])] == kept[::-1]
    assert not history.can_undo
    assert [history.text, *(history.redo() for _ in kept[1:])] == kept
    assert not history.can_redo


@given(steps=st.lists(st.one_of(st.text(max_size=2), st.sampled_from([-1, 1]))))
def test_it_is_as_a_list_with_a_place(steps: list[str | int]) -> None:
    history, texts, at = History(""), [""], 0
    for step in steps:
        if isinstance(step, int):
            at = min(max(at + step, 0), len(texts) - 1)
            assert (history.undo() if step < 0 else history.redo()) == texts[at]
        elif step != texts[at]:
            texts[at + 1 :] = [step]
            at += 1
            history.change(step)
        assert (history.text, history.can_undo, history.can_redo) == (texts[at], at > 0, at < len(texts) - 1)


def test_letters_typed_in_a_row_are_one_step() -> None:
    history = History("")
    for k, text in enumerate(("a", "ab", "abc")):
        history.change(text, "typed", now=0.2 * k)
    history.change("abcd", "typed", now=9.0)
    assert [history.undo(), history.undo()] == ["abc", ""]


def test_what_is_kept_is_bounded() -> None:
    history = History("x" * 3_000_000)
    for k in range(50):
        history.change(str(k) + "x" * 3_000_000)
    steps = 0
    while history.can_undo:
        history.undo()
        steps += 1
    assert 1 <= steps < 10
