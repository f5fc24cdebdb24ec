"""Flights with faults that come and go: no drone is armed unmentioned, no task is lost that a live robot could do.

`python -m tests.muster_robots.mavlink.fault_flights` prints what they come to.
"""

from pathlib import Path

import pytest
from tests.muster_robots.mavlink.fault_flights import FAMILIES, flight_of, main, row_of

PAGE = Path(__file__).parents[3] / "docs" / "fault-flights.md"


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("family", FAMILIES)
def test_a_flight_with_faults_ends_as_it_may(family, seed):
    flight = flight_of(family, seed)
    assert flight.wrongs == []
    assert flight.done | set(flight.lost) == {task.id for task in flight.fleet_mission.tasks}


@pytest.mark.long
@pytest.mark.parametrize("family", FAMILIES)
def test_the_page_shows_what_flights_come_to(family):
    row = row_of(family, [flight_of(family, seed) for seed in range(3)])
    assert f"| {' | '.join(map(str, row))} |" in PAGE.read_text(encoding="utf-8")


@pytest.mark.long
def test_the_table_counts_what_is_wrong(monkeypatch, capsys):
    """A fleet that forgets a drone that is armed is noticed."""
    import tests.muster_robots.mavlink.fault_flights as flights

    def forgetful(family, seed):
        flight = flight_of(family, seed)
        drone = next(iter(flight.drones.values()))
        drone.armed, drone.mode = True, drone.kind.hold
        return flight

    family = "battery sags for a second"
    monkeypatch.setattr(flights, "FAMILIES", {family: FAMILIES[family]})
    monkeypatch.setattr(flights, "flight_of", forgetful)
    wrong = main(1)
    assert wrong > 0
    said = capsys.readouterr()
    assert "r_0 is armed, and said to be: " in said.err
    assert said.out.splitlines()[-1].endswith(f"| {wrong} |")
