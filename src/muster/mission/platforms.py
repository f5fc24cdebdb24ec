"""What works on POSIX systems alone, and is refused elsewhere in one line."""

from __future__ import annotations

import sys

from muster.mission.errors import PlatformError


def require_posix(purpose: str) -> None:
    """Refuse what needs processes, signals and file locks as POSIX has them.

    Raises
    ------
    PlatformError
        on Windows; it names `purpose`.
    """
    if sys.platform == "win32":
        raise PlatformError(f"{purpose} does not work on {sys.platform}; expected Linux, macOS, or WSL on Windows")
