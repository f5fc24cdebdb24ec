"""The limits of custody as settings: the same of every fleet. Imported by the command: no heavy module is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.mission.records import Settings, record, spec
from muster.mission.value_types import Number, Whole
from muster_robots.custody import CustodyLimits

if TYPE_CHECKING:
    from muster.execution.robots.monitor import Limits


@record
class CustodySettings(Settings):
    """How long robots may be silent, in trouble or in other hands; a plug-in's settings may be made from these."""

    link_lost_s: float = spec(
        Number(above=0.0),
        "time without any message after which a robot is silent; shorter gaps change nothing",
        default=5.0,
    )
    settled_s: float = spec(
        Number(above=0.0), "how long a robot that was silent, or in other hands, must do what is wanted", default=1.0
    )
    released_s: float = spec(Number(above=0.0), "the same after a person has driven or flown the robot", default=5.0)
    again_s: float = spec(
        Number(above=0.0), "time after which a robot is told again that does not do what is wanted", default=2.0
    )
    silences: int = spec(
        Whole(), "silences and unanswered commands within two minutes after which a robot is out for good", default=5
    )
    absent_s: float = spec(
        Number(minimum=0.0),
        "how long tasks that nobody else does wait for a robot that is silent, or that somebody else has",
        default=60.0,
    )

    @property
    def custody_limits(self) -> CustodyLimits:
        """The limits of the custody of each robot."""
        return CustodyLimits(
            silent_after_s=self.link_lost_s,
            settled_s=self.settled_s,
            released_s=self.released_s,
            troubles=self.silences,
            again_s=self.again_s,
        )

    @property
    def limits(self) -> Limits:
        """The limits of the mission; see `muster.execution.fleet.limits_of`."""
        from muster.execution.robots.monitor import Limits

        return Limits(silent_after_s=self.link_lost_s, absent_for_s=self.absent_s)
