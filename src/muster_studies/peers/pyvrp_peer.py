"""PyVRP: iterated local search. It minimises the total; other objectives need a sweep over caps."""

from __future__ import annotations

import warnings
from collections.abc import Hashable
from typing import Any

import numpy as np

from muster.mission.values.arrays import Integers
from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.processor_time import ProcessorStop
from muster_studies.peers.sweep import OBJECTIVES, Routed, answered

_LOADS = 10**8
"""All loads together, about: what is too much must weigh as much as a prize, and a penalty per unit has a limit."""
_FORBIDDEN = 10
"""A leg to a task that a robot may not do takes so many times a prize; profiles are how PyVRP restricts vehicles."""


class PyVRP:
    """PyVRP with its own defaults."""

    name = "PyVRP"
    distribution = "pyvrp"
    settings = "iterated local search, its defaults; with max the runs of a sweep go on from the best plan"
    random = True
    by_wall_clock = False

    def cannot(self, instance: Instance) -> str | None:
        if instance.has_prerequisites:
            return "no prerequisites"
        if instance.unusual_rule:
            return f"no {instance.unusual_rule}"
        if any(len(windows) > 1 for windows in instance.windows):
            return "no task with several windows"
        return None if instance.objective in OBJECTIVES else f"no {instance.objective}"

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        return answered(instance, lambda: _Model(instance, seed).run, seconds)


class _Model:
    """The mission as PyVRP's data; robots that are alike are one type of vehicle."""

    def __init__(self, instance: Instance, seed: int) -> None:
        try:
            import pyvrp
        except ImportError:
            raise missing("PyVRP") from None
        self._pyvrp: Any = pyvrp
        self.instance, self._seed = instance, seed
        profiles = [self._profile(i) for i in range(instance.robot_count)]
        self._profile_of = {profile: k for k, profile in enumerate(dict.fromkeys(profiles))}
        self._types: dict[Hashable, list[int]] = {}
        for i, profile in enumerate(profiles):
            shift = instance.available_from[i], instance.available_until[i]
            limits = instance.capacity[i], instance.goods.room[i]
            key = profile, instance.starts[i], instance.ends[i], limits, shift
            self._types.setdefault(key, []).append(i)
        self._data = self._make_data()
        self._best: tuple[int, list[Any]] | None = None  # the value, and the routes as PyVRP has them

    def _profile(self, robot: int) -> tuple[int, int, bytes]:
        """What a robot's tables depend on."""
        instance = self.instance
        return instance.usage.kinds[robot], instance.seconds.kinds[robot], instance.allowed[robot].tobytes()

    def _make_data(self) -> Any:
        instance, pyvrp = self.instance, self._pyvrp
        required = instance.complete or not instance.optional
        prize = 0 if required else instance.prize
        tables = [self._table(kind, row) for kind, _, row in self._profile_of]
        nodes = range(instance.node_count + 1)
        return pyvrp.ProblemData(
            locations=[pyvrp.Location(0, 0) for _ in nodes],
            clients=[
                pyvrp.Client(
                    location=j,
                    pickup=self._amount(j),
                    prize=prize * instance.weights[j],
                    required=required,
                    **self._window(j, "tw"),
                )
                for j in instance.goods.alone
            ],
            shipments=[self._shipment(*transport, prize, required) for transport in instance.goods.transports],
            depots=[pyvrp.Depot(location=node) for node in nodes[len(instance.tasks) :]],
            vehicle_types=self._vehicle_types(None),
            distance_matrices=tables,
            duration_matrices=[self._durations(kind) for _, kind, _ in self._profile_of],
        )

    def _shipment(self, pickup: int, delivery: int, prize: int, required: bool) -> Any:
        return self._pyvrp.Shipment(
            pickup_location=pickup,
            delivery_location=delivery,
            amount=self._amount(pickup),
            prize=prize * (self.instance.weights[pickup] + self.instance.weights[delivery]),
            required=required,
            **self._window(pickup, "pickup_tw"),
            **self._window(delivery, "delivery_tw"),
        )

    def _amount(self, task: int) -> list[int]:
        """What a task takes on board; nothing where no robot has a limit."""
        goods = self.instance.goods
        return [self._load_scale * goods.loads[task]] if goods.limited else []

    @property
    def _load_scale(self) -> int:
        return max(1, _LOADS // max(1, self.instance.goods.total))

    def _window(self, task: int, prefix: str) -> dict[str, int]:
        """When a task may begin, as a client or a shipment has it."""
        return {
            f"{prefix}_{name}": limit
            for window in self.instance.windows[task]
            for name, limit in zip(("early", "late"), window, strict=True)
            if limit is not None
        }

    def _durations(self, kind: int) -> Integers:
        """The work at the place left, and travel; nothing where no time matters."""
        seconds = self.instance.seconds.departing(kind)
        return seconds if self.instance.timed else np.zeros_like(seconds)

    def _table(self, kind: int, row: bytes) -> Integers:
        table = self.instance.usage.arriving(kind)
        forbidden = np.flatnonzero(~np.frombuffer(row, dtype=np.bool_))
        table[:, forbidden] = _FORBIDDEN * self.instance.usage.bound * max(self.instance.weights)
        np.fill_diagonal(table, 0)
        return table

    def _vehicle_types(self, cap: int | None) -> list[Any]:
        instance = self.instance
        found = []
        for robots in self._types.values():
            i = robots[0]
            most = [limit for limit in (cap, instance.capacity[i]) if limit is not None]
            found.append(
                self._pyvrp.VehicleType(
                    num_available=len(robots),
                    start_depot=instance.starts[i] - len(instance.tasks),
                    end_depot=instance.ends_or_anywhere[i] - len(instance.tasks),
                    profile=self._profile_of[self._profile(i)],
                    capacity=[self._load_scale * instance.goods.room_or_all(i)] if instance.goods.limited else [],
                    **({"max_distance": min(most)} if most else {}),
                    **(self._shift(i) if instance.timed else {}),
                )
            )
        return found

    def _shift(self, robot: int) -> dict[str, int]:
        """When a robot leaves at the earliest, and is back at the latest."""
        until = self.instance.available_until[robot]
        shift = {"tw_early": self.instance.available_from[robot]}
        return shift if until is None else {**shift, "tw_late": until}

    def run(self, cap: int | None, seconds: float) -> Routed | None:
        """One run under a cap."""
        data = self._data if cap is None else self._data.replace(vehicle_types=self._vehicle_types(cap))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that a cap is hard to keep, which is what a sweep wants to know
            result = self._pyvrp.solve(
                data,
                ProcessorStop(seconds),
                seed=self._seed,
                collect_stats=False,
                display=False,
                initial_solution=self._known(data),
            )
        if not result.best.is_feasible():
            return None
        routed = self._routed(result.best)
        value = routed.value(self.instance.objective)
        if self._best is None or value < self._best[0]:
            self._best = value, result.best.routes()
        return routed

    def _known(self, data: Any) -> Any:
        """The best plan so far, which may be above the cap of the data; None where the start had better be random.

        For `max` it is a good start, as caps become tighter and tighter; for total+max it is too close to one cap.
        """
        if self._best is None or self.instance.objective != "max":
            return None
        routes = [
            self._pyvrp.Route(data, [step for step in route if not step.is_depot()], route.vehicle_type())
            for route in self._best[1]
        ]
        return self._pyvrp.Solution(data, routes)

    def _routed(self, solution: Any) -> Routed:
        """The routes, those of one type of vehicle given to its robots one after the other."""
        left = [list(robots) for robots in self._types.values()]
        routes: list[list[int]] = [[] for _ in range(self.instance.robot_count)]
        lengths = [0] * self.instance.robot_count
        for route in solution.routes():
            robot = left[route.vehicle_type()].pop(0)
            routes[robot] = [self._task(step) for step in route if not step.is_depot()]
            lengths[robot] = route.distance()
        return Routed(routes, lengths)

    def _task(self, step: Any) -> int:
        """The task of a step of a route."""
        goods = self.instance.goods
        if step.is_client():
            return goods.alone[int(step.idx)]
        pickup, delivery = goods.transports[int(step.idx)]
        return pickup if step.is_pickup() else delivery
