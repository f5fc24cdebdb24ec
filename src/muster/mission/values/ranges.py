"""Checks of numbers that parameters take. Each raises a `ParameterError` with the name, the value and the range.

Numbers are passed by their names; None passes every check.
"""

from __future__ import annotations

import math

from muster.mission.errors import ParameterError


def require_positive(**numbers: float | None) -> None:
    """Raise `ParameterError` unless all numbers are above 0; infinity is."""
    for name, number in numbers.items():
        if number is not None and not number > 0:
            raise ParameterError(f"{name}: {number}; expected a number above 0")


def require_finite_positive(**numbers: float | None) -> None:
    """Raise `ParameterError` unless all numbers are above 0 and finite."""
    for name, number in numbers.items():
        if number is not None and not 0 < number < math.inf:
            raise ParameterError(f"{name}: {number}; expected a finite number above 0")


def require_finite_not_negative(**numbers: float | None) -> None:
    """Raise `ParameterError` unless all numbers are finite and at least 0."""
    for name, number in numbers.items():
        if number is not None and not 0 <= number < math.inf:
            raise ParameterError(f"{name}: {number}; expected a finite number of at least 0")


def require_within(least: float, most: float, **numbers: float | None) -> None:
    """Raise `ParameterError` unless all numbers are from `least` to `most`."""
    for name, number in numbers.items():
        if number is not None and not least <= number <= most:
            raise ParameterError(f"{name}: {number:g}; expected a number from {least:g} to {most:g}")


def require_counts(least: int, **numbers: float | None) -> None:
    """Raise `ParameterError` unless all numbers are whole and at least `least`."""
    for name, number in numbers.items():
        if number is not None and not (number >= least and number % 1 == 0):
            raise ParameterError(f"{name}: {number}; expected a whole number of at least {least}")
