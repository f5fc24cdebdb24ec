"""What depends on the operating system: what is refused outside POSIX, and how many processors there are."""

from __future__ import annotations

import os
import sys
from pathlib import Path

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


def usable_processors() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def data_folder() -> Path:
    """The user's data folder of Muster (XDG base directories)."""
    home = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local" / "share")
    return Path(home) / "muster"
