"""What robots carry fits on board, and what is delivered is delivered by the robot that took it on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from muster.mission.goods import by_commodity, shown_amounts
from muster.mission.model import Robot, Task
from muster.verification.case import Case
from muster.verification.loads import Hold, is_above, net_load
from muster.verification.measure import MeasuredRoute, Step
from muster.verification.verdict import Violation


class Load:
    """After every stop each load is between 0 and the robot's capacity; one robot takes on and delivers."""

    kind = "load"
    ignorable = True

    def violations(self, case: Case, route: MeasuredRoute) -> Iterator[Violation]:
        place = {step.task.id: k for k, step in enumerate(route.steps)}
        for step in route.steps:
            for detail in _wrong_pair(case, place, step.task):
                yield Violation(self.kind, route.robot.id, step.task.id, detail)
        wrong: set[str] = set()
        for task, where, load, most in _loads(case, route):
            unfit = {name: value for name, value in load.items() if not _fits(route.robot, name, value, most)}
            new = {name: value for name, value in unfit.items() if name not in wrong}  # said once for each run of stops
            wrong = set(unfit)
            if new:
                detail = f"{shown_amounts(new)} on board {where}; expected 0 to {_capacity(route.robot, new)}"
                yield Violation(self.kind, route.robot.id, task, detail)

    def prevents(self, case: Case, route: MeasuredRoute, task: Task) -> bool | None:
        """Whether the robot could never do it: what changes on board is more than it can carry, or another took it on.

        Undecided where that depends on what else is on board.
        """
        partner = task.delivers or case.deliverer.get(task.id)
        pair = [task] if partner is None else [task, case.task[partner]]
        if not any(one.load is not None for one in pair):
            return False
        if partner in case.members and route.robot not in case.members[partner]:
            return True
        moved = [net_load(one, case.task) for one in pair]
        moved += [by_commodity(one.load) for one in pair if one.id in case.deliverer]
        too_much = (not _fits(route.robot, name, abs(value), {}) for load in moved for name, value in load.items())
        return True if any(too_much) else None


def _wrong_pair(case: Case, place: Mapping[str, int], task: Task) -> Iterator[str]:
    """What is wrong with the other task of a pair; `place` holds the places of tasks in the route."""
    deliverer = case.deliverer.get(task.id)
    if deliverer is not None and deliverer not in case.done:
        yield f"takes on board what {deliverer} delivers, which is not in the plan"
    if task.delivers is None:
        return
    if task.delivers not in case.done:
        yield f"delivers what {task.delivers} takes on board, which is not in the plan"
    elif task.delivers not in place:
        robot = case.members[task.delivers][0].id
        yield f"delivers what {task.delivers} takes on board, which {robot} does; expected the same robot"
    elif place[task.delivers] > place[task.id]:
        yield f"comes before {task.delivers}, which takes on board what it delivers"


def _loads(
    case: Case, route: MeasuredRoute
) -> Iterator[tuple[str | None, str, Mapping[str, float], Mapping[str, float]]]:
    """What is on board at the start and after each stop: the task, where that is, the load, and the most up to then."""
    hold = Hold(route, case.task, case.deliverer)
    yield None, "at its start", by_commodity(route.robot.load_at_start), hold.most
    for stop, load in zip(route.stops, hold.along_route(), strict=True):
        if isinstance(stop, Step):
            yield stop.task.id, "after it", load, hold.most
        else:
            yield None, f"after {stop.station.id}", load, hold.most


def _room(robot: Robot, name: str) -> float | None:
    return None if robot.load_capacity is None else by_commodity(robot.load_capacity).get(name, 0.0)


def _fits(robot: Robot, name: str, load: float, most: Mapping[str, float]) -> bool:
    """Whether a robot can carry so much of a commodity."""
    room, scale = _room(robot, name), most.get(name, 0.0)
    return not is_above(-load, 0.0, scale) and (room is None or not is_above(load, room, 0.0))


def _capacity(robot: Robot, names: Mapping[str, float]) -> str:
    if robot.load_capacity is None:
        return "any amount"
    return shown_amounts({name: _room(robot, name) or 0.0 for name in names})
