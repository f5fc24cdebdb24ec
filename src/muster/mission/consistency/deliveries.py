"""What is carried in a mission: amounts of the same commodities, and deliveries of what another task takes on board."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from muster.mission.goods import Amount, by_commodity, shown_amounts
from muster.mission.mission_data import MissionData
from muster.mission.mission_parts import all_robots, all_work, new_tasks, unknown_id, work_that
from muster.mission.tasks import Task, Work
from muster.mission.value_types import Fault, Path, shown


def goods_faults(mission: MissionData) -> Iterator[Fault]:
    """What is wrong with loads and deliveries."""
    work, robots = list(work_that(_carries, mission)), all_robots(mission)
    if not work:
        return
    yield from _wrong_deliveries(mission)
    amounts: list[tuple[Path, Amount | None]] = [((*path, "load"), task.load) for path, task in work]
    for path, robot in robots:
        amounts += [((*path, "load_capacity"), robot.load_capacity), ((*path, "load_at_start"), robot.load_at_start)]
    yield from _mixed(amounts)


def _carries(work: Work) -> bool:
    return work.load is not None or work.delivers is not None


def _mixed(amounts: Sequence[tuple[Path, Amount | None]]) -> Iterator[Fault]:
    """Amounts of named commodities beside amounts of the only one; the fewer of the two are the wrong ones."""
    given = [(path, amount) for path, amount in amounts if amount is not None and amount != 0.0]
    named = [each for each in given if isinstance(each[1], Mapping)]
    plain = [each for each in given if not isinstance(each[1], Mapping)]
    if named and plain:
        fewer = plain if len(plain) <= len(named) else named
        expected = "a mapping from commodities" if fewer is plain else "a number"
        for path, amount in fewer:
            yield Fault(path, shown(amount), f"{expected}, as the other amounts are")


def _wrong_deliveries(mission: MissionData) -> Iterator[Fault]:
    with_new = {task.id: task for task in (*mission.tasks, *(task for _, task in new_tasks(mission)))}
    own = {task.id for task in mission.tasks}
    taken: dict[str, str] = {}
    for path, task in all_work(mission):
        name, at = task.delivers, (*path, "delivers")
        if name is None:
            continue
        known = own if path[0] == "tasks" else with_new.keys()
        if path[0] == "found":
            yield Fault(at, shown(name), "nothing here: what a task takes on board is delivered once")
        elif name == getattr(task, "id", None):
            continue  # a cycle
        elif name not in known:
            yield unknown_id(at, name, sorted(known), "task")
        elif name in taken:
            yield Fault(at, shown(name), f"a task that no other delivers: {taken[name]} does")
        else:
            yield from _wrong_pickup(at, with_new[name])
        taken.setdefault(name, getattr(task, "id", ""))


def _wrong_pickup(at: Path, pickup: Task) -> Iterator[Fault]:
    loads = by_commodity(pickup.load)
    if pickup.delivers is not None:
        yield Fault(at, shown(pickup.id), "a task that delivers nothing itself")
    elif not loads or min(loads.values()) < 0:
        value = f"{pickup.id}, load {shown_amounts(loads)}"
        yield Fault(at, value, "a task with a load above 0, which is what is delivered")
