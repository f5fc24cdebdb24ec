"""Gusts have the deviations, the spectra and the scale lengths of MIL-F-8785C."""

import math

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.simulation import Wind
from muster_physics.wind import Gusts, WindField, turbulence

FOOT = 0.3048


@pytest.mark.parametrize(("height_m", "feet"), [(6.096, 20.0), (1.5, 10.0), (152.4, 500.0)])
def test_turbulence_is_that_of_low_altitude(height_m, feet):
    (deviations,), (lengths,) = turbulence(np.array([height_m]), 15.0)
    share = 0.177 + 0.000823 * feet
    assert deviations == pytest.approx([1.5 / share**0.4, 1.5 / share**0.4, 1.5])
    assert lengths / FOOT == pytest.approx([feet / share**1.2, feet / share**1.2, feet])


@pytest.mark.long
def test_gusts_have_the_deviations_and_correlations_of_the_model():
    """Autocorrelation after t = s T: exp(-s) along, exp(-s) (1 - s / 2) across and upright."""
    gusts, step = Gusts((1,)), 0.5
    deviations, lengths = np.array([2.0, 2.0, 1.0]), np.full(3, 10.0)
    found = np.array([gusts.step(10.0, deviations, lengths, step) for _ in range(12_000)])
    assert found.std(axis=0) == pytest.approx(deviations, rel=0.1)
    unit = found / deviations
    for steps in (1, 2, 4):
        s = step * steps
        along, *others = (unit[:-steps] * unit[steps:]).mean(axis=0)
        assert along == pytest.approx(math.exp(-s), abs=0.08)
        assert others == pytest.approx([math.exp(-s) * (1 - s / 2)] * 2, abs=0.08)


def test_steps_are_exact_whatever_their_length():
    deviations, lengths = np.ones(3), np.full(3, 10.0)
    for step in (0.01, 5.0):
        gusts = Gusts((2,))
        found = np.array([gusts.step(10.0, deviations, lengths, step) for _ in range(4_000)])
        assert found.std(axis=0) == pytest.approx([1, 1, 1], rel=0.5 if step < 1 else 0.06)


def test_air_is_the_wind_and_gusts_by_the_seed():
    still = np.zeros((2, 3))
    steady = WindField(Wind(velocity_mps=(3, 4, 0)), 1).step(np.full(2, 10.0), still, 0.1)
    assert (steady == [[3.0, 4.0, 0.0]] * 2).all()

    def blown(seed):
        field = WindField(Wind(velocity_mps=(3, 4, 0), gusts_mps=7.7), seed)
        return np.array([field.step(np.full(2, 10.0), still, 0.1) for _ in range(20)])

    assert (blown(1) == blown(1)).all()
    assert (blown(1) != blown(2)).all()
    assert (blown(1)[:, 0] != blown(1)[:, 1]).all()


@pytest.mark.parametrize(
    "wrong", [{"velocity_mps": (1.0,)}, {"velocity_mps": (math.nan, 0.0, 0.0)}, {"gusts_mps": -1.0}]
)
def test_wrong_winds_are_refused(wrong):
    with pytest.raises(ParameterError, match="expected"):
        Wind(**wrong)
