"""The names of the laws by which simulated robots move. Imported by the command: no third-party parts."""

from __future__ import annotations

from muster.mission.values.keywords import require_one_of

PROFILE, THESIS, TRAJECTORY = LAWS = ("profile", "thesis", "trajectory")


def require_law(law: str) -> None:
    """Raise ParameterError unless there is a law of that name."""
    require_one_of("law", law, LAWS)
