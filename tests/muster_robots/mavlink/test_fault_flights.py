"""Flights with faults that come and go: no drone is armed unmentioned, no task is lost that a live robot could do.

`python -m tests.muster_robots.mavlink.fault_flights` prints what they come to.
"""

import pytest
from tests.muster_robots.mavlink.fault_flights import FAMILIES, flight_of, main


@pytest.mark.long(keep=5)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("family", FAMILIES)
def test_a_flight_with_faults_ends_as_it_may(family, seed):
    flight = flight_of(family, seed)
    assert flight.wrongs == []
    assert flight.done | set(flight.lost) == {task.id for task in flight.fleet_mission.tasks}


def test_the_table_counts_what_is_wrong(monkeypatch, capsys):
    """A fleet that forgets a drone that is armed is noticed."""
    import tests.muster_robots.mavlink.fault_flights as flights

    def forgetful(family, seed):
        flight = flight_of("battery sags for a second", 0)
        drone = next(iter(flight.drones.values()))
        drone.armed, drone.mode = True, drone.kind.hold
        return flight

    monkeypatch.setattr(flights, "FAMILIES", {"forgotten": None})
    monkeypatch.setattr(flights, "flight_of", forgetful)
    assert main(1) == 2
    said = capsys.readouterr()
    assert "r_0 is armed, and said to be: " in said.err
    assert said.out.splitlines()[-1].endswith("| 2 |")
