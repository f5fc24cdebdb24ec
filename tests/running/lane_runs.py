"""Missions on given lanes, carried out in planned traffic."""

from tests.disturbances.traffic.verdicts import Poses

from muster import Simulation, load, solve


def carried_out(text, tmp_path, most_s, world="kinematic"):
    """The report of a mission and the poses of its robots; all its tasks are done within so many seconds."""
    path = tmp_path / "lanes.yaml"
    path.write_text(text)
    mission, poses = load(path), Poses()
    simulation = Simulation(mission, solve(mission, "greedy"), traffic="reserve", world=world, recorder=poses)
    while not simulation.done:
        simulation.advance(simulation.time_s + 5.0)
        assert simulation.time_s < most_s
    report = simulation.result()
    assert (len(report.tasks_done), report.contacts) == (len(mission.tasks), 0)
    return report, poses
