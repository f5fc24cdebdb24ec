"""Errors of work, each one line for a person."""

from __future__ import annotations

from collections.abc import Sequence

from muster.mission.errors import Finding, MusterError

MOST_FINDINGS = 1000
"""Of one input."""


class WorkError(MusterError):
    """A task failed; `findings` holds all errors of a wrong input."""

    def __init__(self, message: str, findings: Sequence[Finding] = ()) -> None:
        self.findings = tuple(findings)
        super().__init__(message)


class OutOfMemory(WorkError):  # noqa: N818 - reads better where it is caught
    """The task needed more memory than a worker may have."""


class TimedOut(WorkError):  # noqa: N818 - reads better where it is caught
    """The task took too long, and its worker was killed."""


class WorkerDied(WorkError):  # noqa: N818 - reads better where it is caught
    """The worker ended during the task."""
