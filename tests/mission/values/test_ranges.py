"""Checks of the ranges of numbers."""

import math

import pytest

import muster
from muster.mission.values import ranges


@pytest.mark.parametrize(
    ("check", "good", "bad", "expected"),
    [
        (ranges.require_positive, [0.1, math.inf], [0, -1, math.nan], "a number above 0"),
        (ranges.require_finite_positive, [0.1, 5], [0, -1, math.inf, math.nan], "a finite number above 0"),
        (ranges.require_finite_not_negative, [0, 5.5], [-0.1, math.inf, math.nan], "a finite number of at least 0"),
        (lambda **x: ranges.require_within(0, 1, **x), [0, 0.5, 1], [-0.1, 1.1, math.nan], "a number from 0 to 1"),
        (
            lambda **x: ranges.require_counts(1, **x),
            [1, 7],
            [0, 1.5, math.inf, math.nan],
            "a whole number of at least 1",
        ),
    ],
)
def test_a_number_out_of_range_is_named_with_the_range(check, good, bad, expected):
    check(none=None, **{f"n{k}": number for k, number in enumerate(good)})
    for number in bad:
        with pytest.raises(muster.ParameterError) as caught:
            check(good=good[0], radius_m=number)
        assert str(caught.value) == f"radius_m: {number}; expected {expected}"
