"""Times on sheets: of the clock where the mission says when it starts, else since the start."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from muster.mission.values.time_types import clock_text, moment_after


@dataclass(frozen=True)
class Times:
    """How times are told; `starts_at` is the mission's, a date and time by ISO 8601."""

    starts_at: str | None

    def text(self, seconds: float) -> str:
        """`08:01:45`, of later days `+1 08:01:45`; without a start the time since then, `0:01:45`."""
        return elapsed(seconds) if self.starts_at is None else clock_text(seconds, self.starts_at)

    @property
    def words(self) -> str:
        """What the times are, for a heading."""
        if self.starts_at is None:
            return "Times: hours, minutes, seconds since the start."
        start = datetime.fromisoformat(self.starts_at)
        zone = start.strftime("%z")
        told = f"{start:%Y-%m-%d %H:%M:%S}" + (f" (UTC{zone[:3]}:{zone[3:5]})" if zone else "")
        return f"Times: of the clock; the mission starts {told}."

    def moment(self, seconds: float) -> datetime | None:
        """The date and time so long after the start; None without a start, and after the year 9999."""
        if self.starts_at is None:
            return None
        try:
            return moment_after(seconds, self.starts_at)
        except OverflowError:
            return None


def elapsed(seconds: float) -> str:
    """`1:02:03`: hours, minutes, seconds."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"
