"""What a robot's process does beside the auction, with a body and a starter of the test's own."""

from types import SimpleNamespace

from muster import Mission, Robot, Task
from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster.simulation import KinematicWorld
from muster_team.negotiators.participation import negotiator_of
from muster_team.runs.pipe_messages import BodyState, SteerCommand
from muster_team.runs.robot_process import RobotWorker


def test_what_a_robot_begins_is_kept_before_its_body_begins():
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)),),
        tasks=(Task(id="t", position=(1, 0), duration_s=2.0, across_partition="at-most-once"),),
    )
    problem, world = Problem.compile(mission).ready(), KinematicWorld(mission)
    negotiator, kept, begun = negotiator_of(problem, Parameters(), "a", incarnation=1), [], []

    def send(word):
        if isinstance(word, SteerCommand):
            world.ports["a"].send(word.waypoints)
            begun.append([{claim.task for claim in memory.claims if claim.begun} for memory in kept[-1:]])

    node = SimpleNamespace(negotiator=negotiator, keep=lambda: kept.append(negotiator.memory))
    setup, pipe = SimpleNamespace(speed=1.0, ground=None), SimpleNamespace(send=send)
    worker = RobotWorker(SimpleNamespace(robot="a", problem=problem, setup=setup, pipe=pipe), node)
    negotiator.start(0.0)
    while world.time_s < 60 and "t" not in {fact.task for fact in negotiator.facts if fact.done}:
        world.advance(round(world.time_s + 0.1, 9))
        worker.receive([BodyState(world.time_s, world.ports["a"].telemetry(), 0, 0.0)])
        negotiator.tick(world.time_s)
        worker.step()
    assert begun == [[set()], [{"t"}]]
