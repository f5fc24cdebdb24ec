"""What is typed into the cells of a form, as the text of a mission holds it."""

import pytest

from muster.mission.errors import ParameterError
from muster.server.pages.plan.form import number_of


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
