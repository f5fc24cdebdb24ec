"""Teams as execution has to see them: what robots still lack to do a task together, and tasks that begin together."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from muster.mission.model import Robot, Task, TeamPart

_ROUNDING = 1e-9  # relative; by which abilities may be below what is needed


def lacking(task: Task, robots: Sequence[Robot]) -> str:
    """What robots lack to do a task together, in words; empty if they are enough."""
    if task.needs is not None:
        return ", ".join(_lacking_abilities(task.needs, robots))
    if task.team:
        return _lacking_part(task.team, robots)
    missing = (task.robots_needed or 1) - len(robots)
    return f"{missing} more robot{'s' if missing > 1 else ''}" if missing > 0 else ""


def _lacking_abilities(needs: Mapping[str, float], robots: Sequence[Robot]) -> Iterator[str]:
    for ability, amount in needs.items():
        have = sum((robot.abilities or {}).get(ability, 0.0) for robot in robots)
        if have < amount * (1 - _ROUNDING):
            yield f"{have:g} of {amount:g} {ability}"
    if not robots:
        yield "a robot"


def _lacking_part(parts: Sequence[TeamPart], robots: Sequence[Robot]) -> str:
    """The first part for which no robot is left: a matching by augmenting paths, robot for place."""
    places = [part for part in parts for _ in range(part.count)]
    place_of: dict[str, int] = {}

    def fill(place: int, tried: set[str]) -> bool:
        for robot in robots:
            if robot.id not in tried and _fits(robot, places[place]):
                tried.add(robot.id)
                if robot.id not in place_of or fill(place_of[robot.id], tried):
                    place_of[robot.id] = place
                    return True
        return False

    return next((f"one more {_words(part)}" for k, part in enumerate(places) if not fill(k, set())), "")


def _fits(robot: Robot, part: TeamPart) -> bool:
    right_type = part.type in (None, robot.type)
    return right_type and part.kind in (None, robot.kind) and set(part.requires) <= set(robot.skills)


def _words(part: TeamPart) -> str:
    sort = " ".join(word for word in (part.kind, part.type) if word) or "robot"
    return f"{sort} with {', '.join(part.requires)}" if part.requires else sort


def units_of(tasks: Collection[Task]) -> dict[str, tuple[str, ...]]:
    """For each task all tasks that begin at the same moment, itself included, in the order given."""
    tied: dict[str, set[str]] = {task.id: {task.id} for task in tasks}
    for task in tasks:
        for name in task.starts_with:
            if name in tied and tied[name] is not tied[task.id]:
                joined = tied[task.id] | tied[name]
                tied |= dict.fromkeys(joined, joined)
    place = {task.id: k for k, task in enumerate(tasks)}
    return {name: tuple(sorted(unit, key=place.__getitem__)) for name, unit in tied.items()}
