"""Temporary folders whose names hold the process that they belong to: PREFIX, process id, random text."""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

OF_WORK, OF_RUNS = "muster-work-", "muster-run-"


def sweep(prefix: str) -> None:
    """Remove this user's folders whose process does not exist any more."""
    for left in Path(tempfile.gettempdir()).glob(f"{prefix}*-*"):
        with suppress(ValueError, OSError):
            process = int(left.name.removeprefix(prefix).split("-")[0])
            if not _is_running(process) and left.stat().st_uid == os.getuid():
                shutil.rmtree(left, ignore_errors=True)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
