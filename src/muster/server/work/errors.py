"""Why a piece of work gave nothing: each a line for a person."""

from __future__ import annotations

from collections.abc import Sequence

from muster.mission.errors import Finding, MusterError

MOST_FINDINGS = 1000
"""Of one input; more would not be read, and take long to be passed on."""


class WorkError(MusterError):
    """A piece of work gave nothing; of an input that is wrong `findings` holds all that was found."""

    def __init__(self, message: str, findings: Sequence[Finding] = ()) -> None:
        self.findings = tuple(findings)
        super().__init__(message)


class OutOfMemory(WorkError):  # noqa: N818 - reads better where it is caught
    """It needed more memory than a worker may have."""


class TimedOut(WorkError):  # noqa: N818 - reads better where it is caught
    """It took longer than it may; its worker was killed."""


class WorkerDied(WorkError):  # noqa: N818 - reads better where it is caught
    """Its worker ended under it."""
