"""A fleet whose clock begins with the mission: bridges begin theirs when they connect, and robots are waited for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from muster.bridges.fleet import Fleet
from muster.mission.model import Event
from muster.motion.port import RobotPort, Telemetry, TranslatedPort


class FleetWithMissionClock:
    """A `Fleet` that is another's from now on; what robots said before is of times below its beginning.

    Parameters
    ----------
    begin_s
        the time that it is now.
    """

    def __init__(self, fleet: Fleet, begin_s: float = 0.0) -> None:
        self._fleet, self._off_s = fleet, fleet.time_s - begin_s
        self._paused_s: float | None = None
        self.ports: Mapping[str, RobotPort] = _Ports(fleet, lambda: self._off_s)

    @property
    def time_s(self) -> float:
        return self._fleet.time_s - self._off_s if self._paused_s is None else self._paused_s

    def pause(self) -> None:
        """The clock stands still until `resume`."""
        self._paused_s = self.time_s

    def resume(self) -> None:
        """The clock goes on."""
        if self._paused_s is not None:
            self._off_s, self._paused_s = self._fleet.time_s - self._paused_s, None

    def advance(self, until_s: float) -> Sequence[Event]:
        """See `Fleet`; in a pause, receive telemetry for as long as the step would have taken."""
        return self._fleet.advance(self._fleet.time_s + until_s - self.time_s)

    def stop(self) -> None:
        self._fleet.stop()

    def close(self) -> None:
        self._fleet.close()


class _Ports(Mapping[str, RobotPort]):
    """Those that are discovered later are in it as soon as they are."""

    def __init__(self, fleet: Fleet, off_s: Callable[[], float]) -> None:
        self._fleet, self._off_s = fleet, off_s

    def __getitem__(self, robot: str) -> RobotPort:
        return TranslatedPort(self._fleet.ports[robot], self._since_it_began)

    def __iter__(self) -> Iterator[str]:
        return iter(self._fleet.ports)

    def __len__(self) -> int:
        return len(self._fleet.ports)

    def _since_it_began(self, said: Telemetry) -> Telemetry:
        return replace(said, time_s=said.time_s - self._off_s())
