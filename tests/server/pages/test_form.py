"""What is typed into the cells of a form, as the text of a mission holds it."""

import pytest

from muster.mission.errors import ParameterError
from muster.server.pages.plan.cell_texts import number_of, text_of, value_of


@pytest.mark.parametrize(
    ("typed", "number"), [("1000", 1000), ("1.5", 1.5), ("0,5", 0.5), ("-0,125", -0.125), ("2.0", 2), ("1e3", 1000)]
)
def test_numbers(typed, number):
    found = number_of(typed, "x")
    assert (found, type(found)) == (number, type(number))


@pytest.mark.parametrize("typed", ["fast", "1,000", "-12,345", "1_000", "nan", "inf", "1e400", "1,000.5", "1.2.3"])
def test_what_is_no_number_or_may_be_two(typed):
    with pytest.raises(ParameterError, match=rf"^x: '{typed}'; expected a number, as 1000 or 1\.5$"):
        number_of(typed, "x")


@pytest.mark.parametrize(
    ("kind", "typed", "value"),
    [
        ("words", "30, 31 32", ["30", "31", "32"]),
        ("lagged", "30 31(5..60)", ["30", {"task": "31", "after_s": 5, "within_s": 60}]),
        ("lagged", "32(..9)", [{"task": "32", "within_s": 9}]),
        ("lagged", "a(2.5 ..)", [{"task": "a", "after_s": 2.5}]),
        ("spans", "600 to 1200", [600, 1200]),
        ("spans", "600 to 1200; 2000 to", [[600, 1200], [2000, None]]),
        ("clock spans", "10:00 to 14:00", ["10:00", "14:00"]),
        ("clock spans", "to 14:00", [None, "14:00"]),
        ("amounts", "lift_kg 20, water_l 1,5", {"lift_kg": 20, "water_l": 1.5}),
        (
            "parts",
            "2 type=rover; 1 kind=air requires=camera+gripper",
            [{"count": 2, "type": "rover"}, {"count": 1, "kind": "air", "requires": ["camera", "gripper"]}],
        ),
        ("parts", "kind=air", [{"kind": "air"}]),
        ("choice", "true", True),
        ("text", "  ", None),
    ],
)
def test_cells_of_every_kind(kind, typed, value):
    assert value_of(typed, "x", kind) == value
    assert value_of(text_of(value, kind), "x", kind) in (value, [{"count": 1, "kind": "air"}])


@pytest.mark.parametrize(
    ("kind", "typed", "expected"),
    [
        ("spans", "600-1200", "'600-1200'; expected spans, as 600 to 1200; 2000 to"),
        ("spans", "noon to 1200", "'noon'; expected a number"),
        ("amounts", "lift_kg", "'lift_kg'; expected a name and an amount"),
        ("parts", "two rovers", "'two'; expected parts, as 2 type=rover"),
        ("lagged", "a(soon..)", "'soon'; expected a number"),
    ],
)
def test_what_cannot_be_read_says_what_was_expected(kind, typed, expected):
    with pytest.raises(ParameterError) as error:
        value_of(typed, "task a: window_s", kind)
    assert str(error.value).startswith("task a: window_s: ")
    assert expected in str(error.value)


def test_values_of_another_form_are_shown_as_they_are():
    assert text_of(["10:00"], "spans") == "10:00"
    assert text_of("soon", "spans") == "soon"
    assert text_of([1, [2]], "lagged") == "1 [2]"
