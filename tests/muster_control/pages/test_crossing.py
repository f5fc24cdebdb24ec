"""Changes that an editor tells, and texts that cross on their way."""

from hypothesis import given
from hypothesis import strategies as st

from muster_control.pages.editing.text_view import applied, merged

TEXTS = st.text(st.sampled_from("ab\n\U0001f916"), max_size=12)


def units(text):
    return len(text.encode("utf-16-le")) // 2


@given(TEXTS, TEXTS, TEXTS, TEXTS)
def test_a_change_set_is_applied_by_the_lengths_of_a_browser(before, old, new, after):
    sections = [units(before), -1, units(old), units(new), units(after), -1]
    assert applied(before + old + after, sections, [[], new.split("\n")]) == before + new + after


def test_a_change_of_another_text_is_not_applied():
    assert applied("robots: []", [9, -1, 0, 1], [[], ["x"]]) is None
    assert applied("robots: []", [11, -1, 0, 1], [[], ["x"]]) is None


@given(TEXTS, TEXTS, TEXTS, TEXTS)
def test_changes_of_two_places_are_both_kept(first, second, one, two):
    before = f"{first}|=|{second}"
    assert merged(before, f"{first}{one}|=|{second}", f"{first}|=|{second}{two}") == f"{first}{one}|=|{second}{two}"
    assert merged(before, f"{first}|=|{second}{two}", f"{first}{one}|=|{second}") == f"{first}{one}|=|{second}{two}"


@given(TEXTS, TEXTS)
def test_a_change_of_one_side_is_kept(before, after):
    assert merged(before, after, before) == merged(before, before, after) == after


def test_changes_of_the_same_place_are_not_put_together():
    assert merged("speed: 1", "speed: 22", "speed: 33") is None
