"""The names of the laws by which simulated robots move. Imported by the command: no third-party parts."""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean

PROFILE, THESIS, TRAJECTORY = LAWS = ("profile", "thesis", "trajectory")


def require_law(law: str) -> None:
    """Raise ParameterError unless there is a law of that name."""
    if law not in LAWS:
        raise ParameterError(f"law: {law}; expected {', '.join(LAWS)}{did_you_mean(law, LAWS)}")
