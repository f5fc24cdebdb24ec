"""What stations add to the energy of robots, how long that takes, and how levels fall with usage."""

import math

import pytest

from muster.mission.model import Battery, Robot, Station
from muster.model.energy import Energy, EnergyLevel, Refill

CHARGES = Station(id="dock", position=(0, 0), services=("charge", "unload"), charge_per_s=2.0, partial=False)
SWAPS = Station(id="rack", position=(0, 0), services=("swap",), swap_s=30.0)
UNLOADS = Station(id="depot", position=(0, 0), services=("unload",))


def test_the_energy_of_a_robot_is_in_the_unit_of_usage():
    battery = Battery(capacity=50, at_start=0.8, reserve=0.1)
    assert Energy.of(Robot(id="r", position=(0, 0), battery=battery)) == Energy(capacity=50, at_start=40, least=5)
    assert Energy.of(Robot(id="r", position=(0, 0))) is None


def test_a_station_adds_at_a_rate_or_all_at_once():
    rate, whole = Refill.of(CHARGES), Refill.of(SWAPS)
    assert (rate, whole, Refill.of(UNLOADS)) == (Refill(2.0, 0.0, False), Refill(None, 30.0, False), None)
    assert (rate.seconds(10.0), whole.seconds(10.0)) == (5.0, 30.0)
    assert [rate.added(3.0, ends=ends) for ends in (False, True)] == [6.0, 6.0]
    assert [whole.added(3.0, ends=ends) for ends in (False, True)] == [0.0, math.inf]


def test_a_level_falls_with_usage_since_the_last_time_and_stays_within_its_bounds():
    level = EnergyLevel(20.0, 10.0)
    assert (level.spend(7.0), level.level) == (0.0, 10.0)  # what was used before is not known
    assert (level.spend(9.0, drain=1.5), level.level) == (2.0, 7.0)
    level.add(4.0)
    assert level.share == pytest.approx(11 / 20)
    level.spend(99.0)
    assert level.level == 0.0
    level.add(math.inf)
    assert level.share == 1.0
