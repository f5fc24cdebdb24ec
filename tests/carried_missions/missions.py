"""Random small missions with loads, transports, batteries and stations."""

from dataclasses import replace
from random import Random

from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task

OBJECTIVES = ("total", "max", "total+max", "average", "makespan", "lateness")
SERVICES = (("charge",), ("charge",), ("swap",), ("unload",), ("charge", "unload"), ("swap", "unload"))
MOST_TASKS = 5


def carried_mission(seed):
    """A mission in which no robot waits for another, so that routes can be looked at one by one."""
    return _Maker(seed).mission()


class _Maker:
    def __init__(self, seed):
        self.random = random = Random(f"goods and energy {seed}")
        self.whole = random.random() < 0.4
        self.goods = ("sand", "water") if random.random() < 0.25 else ("",)
        self.objective = random.choice(OBJECTIVES)
        self.with_times = random.random() < 0.4
        self.carries = random.random() < 0.8
        self.with_batteries = random.random() < 0.8 or not self.carries

    def mission(self):
        random = self.random
        robots = [self._robot(k) for k in range(random.choice((1, 1, 2, 2, 3)))]
        tasks = [self._task(k) for k in range(random.randint(2, MOST_TASKS))]
        tasks = self._paired(tasks) if self.carries else tasks
        rules = Rules(
            objective=self.objective,
            usage=random.choice(("distance", "distance", "time")),
            return_to_start=random.random() < 0.5,
            makespan_includes_return=random.random() < 0.3,
            timing="constant",
        )
        tasks = self._in_order(tasks)
        random.shuffle(tasks)
        stations = [self._station(k) for k in range(random.choice((0, 1, 1, 2, 2, 3)))]
        return Mission(name="carried", rules=rules, robots=tuple(robots), tasks=tuple(tasks), stations=tuple(stations))

    def _number(self, low, high):
        return self.random.randint(low, high) if self.whole else self.random.uniform(low, high)

    def _place(self):
        return (float(self._number(-8, 8)), 0.0 if self.whole else float(self._number(-8, 8)))

    def _amount(self, low, high):
        values = {name: self.random.randint(low, high) for name in self.goods}
        return values if self.goods != ("",) else values[""]

    def _robot(self, k):
        random = self.random
        battery = Battery(
            capacity=self._number(14, 45), at_start=random.choice((1, 1, 0.5)), reserve=random.choice((0, 0, 0.25))
        )
        begins = random.choice((0, 0, 3))
        return Robot(
            id=f"r_{k}",
            position=self._place(),
            load_capacity=self._amount(2, 6) if self.carries and random.random() < 0.9 else None,
            load_at_start=self._amount(0, 2) if self.carries and random.random() < 0.3 else None,
            battery=battery if self.with_batteries and random.random() < 0.9 else None,
            speed_mps=random.choice((1, 1, 2)),
            efficiency=random.choice((1, 1, 0.5)),
            work_capacity=self._number(25, 60) if random.random() < 0.2 else None,
            available_from_s=begins,
            available_until_s=begins + self._number(20, 80) if self._has_shift() else None,
            end_position=self._place() if random.random() < 0.1 else None,
        )

    def _has_shift(self):
        return self.with_times and self.objective != "makespan" and self.random.random() < 0.3

    def _task(self, k):
        random = self.random
        task = Task(
            id=f"t_{k}",
            position=self._place(),
            actuation_cost=random.choice((0, 0, 2)),
            duration_s=random.choice((None, None, 0, 3)),
            priority=random.choice((1, 1, 1, 2.5)),
            load=self._amount(-2, 3) if self.carries and random.random() < 0.6 else None,
            due_s=self._number(5, 40) if random.random() < 0.6 else None,
        )
        if self.with_times and random.random() < 0.5:
            task = replace(task, window_s=self._windows())
        if self.with_times and random.random() < 0.3:
            task = replace(task, deadline_s=self._number(15, 80))
        return task

    def _windows(self):
        begin, windows = self._number(0, 30), []
        for _ in range(self.random.choice((1, 1, 2, 3))):
            end = begin + self._number(1, 15)
            windows.append((float(begin), float(end)))
            begin = end + self._number(3, 20)
        return tuple(windows)

    def _paired(self, tasks):
        """Now and then a task delivers what another takes on board."""
        for k in range(0, len(tasks) - 1, 2):
            if self.random.random() < 0.5:
                tasks[k] = replace(tasks[k], load=self._amount(1, 3))
                load = tasks[k + 1].load if self.random.random() < 0.2 else None
                tasks[k + 1] = replace(tasks[k + 1], delivers=tasks[k].id, load=load)
        return tasks

    def _in_order(self, tasks):
        """Now and then prerequisites, where times do not count, so that nobody waits for them."""
        if self.with_times or self.objective in ("makespan", "lateness"):
            return tasks
        for k in range(1, len(tasks)):
            if self.random.random() < 0.1:
                tasks[k] = replace(tasks[k], prerequisites=(tasks[self.random.randrange(k)].id,))
        return tasks

    def _station(self, k):
        """Of objective `lateness` no station charges in part: how long is then a question of its own."""
        random = self.random
        services = random.choice(SERVICES)
        return Station(
            id=f"s_{k}",
            position=self._place(),
            services=services,
            slots=9,
            charge_per_s=random.choice((0.5, 1, 4)) if "charge" in services else None,
            swap_s=random.choice((0, 4)),
            partial=random.random() < 0.7 and self.objective != "lateness",
        )
