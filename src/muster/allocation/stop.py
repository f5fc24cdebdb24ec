"""The stopping rule of an algorithm, and the history of its best plans."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.system.clock import Clock, SystemClock

DEFAULT_TIME_LIMIT_S = 5.0
_OVERTIME, _OVERTIME_S = 0.05, 0.1  # share of a time limit, and seconds, in which what was found is put together
PATIENCE = 10.0
"""How many times the limit a first plan may take: a part of one is worth less than the time."""


def usual_time_limit(anytime: bool, time_limit: float | None, iterations: int | None) -> float | None:
    """The time limit of a run: as given; the default for an anytime allocator that nothing else stops."""
    return DEFAULT_TIME_LIMIT_S if anytime and time_limit is None and iterations is None else time_limit


def patience_s(time_limit: float | None) -> float | None:
    """The seconds that a first plan may take under a time limit."""
    return None if time_limit is None else max(PATIENCE * time_limit, time_limit + _OVERTIME_S)


@dataclass(frozen=True)
class Progress:
    """How far an algorithm is.

    Parameters
    ----------
    elapsed_s, iterations
        seconds and iterations done.
    weight, objective
        of the best plan so far.
    share
        of all work that is done, 0 to 1; None where that is not known.
    bound
        of the objective, where one was asked for and the best plan does all tasks.
    history
        (seconds, objective) of each improvement; it goes on growing.
    """

    elapsed_s: float
    iterations: int
    weight: float
    objective: float
    share: float | None = None
    bound: float | None = None
    history: Sequence[tuple[float, float]] = ()


class Stop:
    """The budget of an algorithm: ends it after a number of iterations, a time, or when it is interrupted.

    It keeps the history, and notes what was cut short (`cut_short`).

    Parameters
    ----------
    iterations, time_limit
        at most so many iterations, and seconds; None: no limit of this kind.
    clock
        what time is measured with.
    on_progress
        called when the best plan improves, and every now and then between.
    whole
        of which this is a part: it ends with it.
    first_plan_s
        seconds that a first plan may take; None: `PATIENCE` times the limit.
    began_s
        by the clock, when the time began that the limit and `elapsed_s` are of; None: now.
    """

    _REPORT_EVERY_S = 0.1

    def __init__(
        self,
        *,
        iterations: int | None = None,
        time_limit: float | None = None,
        clock: Clock | None = None,
        on_progress: Callable[[Progress], None] | None = None,
        whole: Stop | None = None,
        first_plan_s: float | None = None,
        began_s: float | None = None,
    ) -> None:
        if iterations is not None and not (isinstance(iterations, int) and iterations >= 0):
            raise ParameterError(f"iterations: {iterations}; expected a whole number of at least 0")
        if time_limit is not None and not (isinstance(time_limit, int | float) and time_limit >= 0):
            raise ParameterError(f"time_limit: {time_limit}; expected seconds, at least 0")
        self._iterations = iterations
        self._time_limit = time_limit
        self._first_plan_s = patience_s(time_limit) if first_plan_s is None else first_plan_s
        self._makes_first_plan = False
        self._clock = clock or SystemClock()
        self._on_progress = on_progress
        self._begin = self._clock.now() if began_s is None else began_s
        self._reported = self._begin
        self._interrupted = self._hurried = False
        self.cut_short = False
        self._whole = whole
        self.iterations_done = 0
        self.best: tuple[float, float] | None = None
        self.history: list[tuple[float, float]] = []

    @property
    def elapsed_s(self) -> float:
        return self._clock.now() - self._begin

    @property
    def interrupted(self) -> bool:
        return self._interrupted or (self._whole is not None and self._whole.interrupted)

    @property
    def hurried(self) -> bool:
        """Whether it was interrupted once more: reasons for tasks left out are then not worth waiting for."""
        return self._hurried or (self._whole is not None and self._whole.hurried)

    def interrupt(self) -> None:
        """End the algorithm at the next chance; it returns the best it has. A second time: leave out the reasons."""
        self._hurried = self._interrupted
        self._interrupted = True

    def cut(self) -> None:
        """Note that an algorithm ended before it had looked at all tasks."""
        self.cut_short = True
        if self._whole is not None:
            self._whole.cut()

    @property
    def overdue(self) -> bool:
        """Whether nothing more is worth waiting for: it was interrupted twice, or the time limit has passed by far."""
        limit = self._time_limit
        return self.hurried or (limit is not None and self.elapsed_s > limit * (1 + _OVERTIME) + _OVERTIME_S)

    @contextmanager
    def first_plan(self) -> Iterator[None]:
        """While the context is open, be due only when a first plan has taken too long, or on an interruption."""
        before, self._makes_first_plan = self._makes_first_plan, True
        try:
            yield
        finally:
            self._makes_first_plan = before

    def due(self) -> bool:
        """Whether time is up or the algorithm was interrupted."""
        now = self._clock.now()
        if self._on_progress is not None and now - self._reported > self._REPORT_EVERY_S:
            self._report(now)
        limit_s = self._first_plan_s if self._makes_first_plan else self._time_limit
        return self.interrupted or (limit_s is not None and now - self._begin >= limit_s)

    def iterations(self) -> Iterator[int]:
        """Count iterations until it is time to stop."""
        while (self._iterations is None or self.iterations_done < self._iterations) and not self.due():
            self.iterations_done += 1
            yield self.iterations_done

    def part(
        self,
        *,
        time_limit: float | None,
        iterations: int | None,
        on_progress: Callable[[Progress], None] | None = None,
    ) -> Stop:
        """A stop for one piece of the work, which ends with the whole."""
        return Stop(
            iterations=iterations, time_limit=time_limit, clock=self._clock, on_progress=on_progress, whole=self
        )

    @property
    def is_a_time_alone(self) -> bool:
        """Whether nothing but a time on the system's clock ends it: then all processors may be used until then."""
        return self._time_limit is not None and self._iterations is None and isinstance(self._clock, SystemClock)

    @property
    def time_left_s(self) -> float | None:
        """Seconds until the time limit, at least 0; None where there is none."""
        return None if self._time_limit is None else max(0.0, self._time_limit - self.elapsed_s)

    @property
    def iterations_left(self) -> int | None:
        """Iterations until the limit; None where there is none."""
        return None if self._iterations is None else self._iterations - self.iterations_done

    def batches(self, size: int) -> Iterator[int]:
        """Count iterations in batches of at most this size until it is time to stop; yields how many each has."""
        while not self.due():
            left = size if self._iterations is None else min(size, self._iterations - self.iterations_done)
            if left <= 0:
                return
            self.iterations_done += left
            yield left

    @property
    def share(self) -> float:
        """How much of its iterations or time an algorithm has had, 0 to 1; 0 where neither is limited."""
        of_iterations = self.iterations_done / self._iterations if self._iterations else 0.0
        return min(1.0, max(of_iterations, self.share_of_time))

    @property
    def share_of_time(self) -> float:
        """How much of its time an algorithm has had, from 0; 0 where time is not limited."""
        return self.elapsed_s / self._time_limit if self._time_limit else 0.0

    def improved(self, weight: float, objective: float) -> None:
        """Note the figures of a plan, if it is the best so far."""
        if self.best is not None and (-weight, objective) >= (-self.best[0], self.best[1]):
            return
        now = self._clock.now()
        self.best = weight, objective
        self.history.append((now - self._begin, objective))
        if self._on_progress is not None:
            self._report(now)

    def _report(self, now: float) -> None:
        self._reported = now
        if self._on_progress is not None and self.best is not None:
            reached = Progress(
                now - self._begin, self.iterations_done, *self.best, share=self.share or None, history=self.history
            )
            self._on_progress(reached)
