"""How the time limit of a request is shared out: to a quick bound, the algorithm, a proof, and judging the plan."""

from __future__ import annotations

import time
from dataclasses import dataclass

from muster.allocation.stop import Stop, patience_s

_JUDGED_S = 4e-5  # a task, to put the plan together, judge and write it
_IN_CACHE = 30_000  # tasks; more outgrow the caches of processors, and each takes twice as long
_LEAST_SHARE = 0.1  # of the time limit, which each part has at least
_BOUND_SHARE = 0.2  # of what is left, for a quick bound
_SEARCHED_SHARE = 0.5  # of what is left, where an exact proof follows


_SLOWEST = 4.0  # by which a busy machine is reckoned with at most


class Pace:
    """How much longer work takes than the processor is at it, as other processes have it in between.

    Measured from when this is made.
    """

    def __init__(self) -> None:
        self._began_s, self._worked_s = time.monotonic(), time.process_time()

    @property
    def slowness(self) -> float:
        """Seconds for a second of the processor, at least 1."""
        took_s, worked_s = time.monotonic() - self._began_s, time.process_time() - self._worked_s
        return min(_SLOWEST, max(1.0, took_s / worked_s)) if worked_s > 0 else 1.0


@dataclass(frozen=True)
class Budget:
    """The seconds that each part of the work has; None where there is no limit.

    Parameters
    ----------
    limit_s
        of all the work, from when `whole` began.
    whole
        ends all the work when it is interrupted; its clock counts.
    tasks
        of the mission.
    slowness
        how much longer judging takes than on a machine that does nothing else.
    proof_follows
        whether an exact proof comes after the algorithm, within the same limit.
    """

    limit_s: float | None
    whole: Stop
    tasks: int
    slowness: float = 1.0
    proof_follows: bool = False

    @property
    def bound_s(self) -> float | None:
        """For a quick bound before the algorithm."""
        return self._share(_BOUND_SHARE)

    @property
    def algorithm_s(self) -> float | None:
        """For the algorithm."""
        return self._share(_SEARCHED_SHARE if self.proof_follows else 1.0)

    @property
    def first_plan_s(self) -> float | None:
        """For the first plan of the algorithm, which is worth waiting for."""
        return patience_s(self.limit_s)

    @property
    def proof_s(self) -> float | None:
        """For an exact proof after the algorithm."""
        return self._share(1.0) if self.proof_follows else None

    def _share(self, share: float) -> float | None:
        """A share of what is left beside judging."""
        if self.limit_s is None:
            return None
        left_s = self.limit_s - self.whole.elapsed_s - self.slowness * _judged_s(self.tasks)
        return max(share * left_s, _LEAST_SHARE * self.limit_s)


def _judged_s(tasks: int) -> float:
    """Processor seconds, on a machine that does nothing else, for judging a plan."""
    return _JUDGED_S * tasks * (1 if tasks <= _IN_CACHE else 2)
