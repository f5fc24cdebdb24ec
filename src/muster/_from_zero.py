"""A fleet whose clock begins with the mission: bridges begin theirs when they connect, and robots are waited for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from muster.bridges.fleet import Fleet
from muster.mission.model import Event
from muster.motion.port import RetoldPort, RobotPort, Telemetry


class FromZero:
    """A `Fleet` that is another's from now on; what robots said before is of times below 0."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet, self._began_s = fleet, fleet.time_s
        self.ports: Mapping[str, RobotPort] = _Ports(fleet, self._began_s)

    @property
    def time_s(self) -> float:
        return self._fleet.time_s - self._began_s

    def advance(self, until_s: float) -> Sequence[Event]:
        return self._fleet.advance(until_s + self._began_s)

    def stop(self) -> None:
        self._fleet.stop()

    def close(self) -> None:
        self._fleet.close()


class _Ports(Mapping[str, RobotPort]):
    """Those that are discovered later are in it as soon as they are."""

    def __init__(self, fleet: Fleet, began_s: float) -> None:
        self._fleet, self._began_s = fleet, began_s

    def __getitem__(self, robot: str) -> RobotPort:
        return RetoldPort(self._fleet.ports[robot], self._since_it_began)

    def __iter__(self) -> Iterator[str]:
        return iter(self._fleet.ports)

    def __len__(self) -> int:
        return len(self._fleet.ports)

    def _since_it_began(self, said: Telemetry) -> Telemetry:
        return replace(said, time_s=said.time_s - self._began_s)
