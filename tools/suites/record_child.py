"""Run at the start of each Python process of a recorded test; writes the imported modules when the process ends."""

import atexit
import json
import os
import sys
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[2]


def _write():
    test = os.environ.get("PYTEST_CURRENT_TEST", "")
    files = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    inside = sorted(
        {Path(file).relative_to(_ROOT).as_posix() for file in files if file and file.startswith(f"{_ROOT}/src/")}
    )
    if test and inside:
        path = _ROOT / "build" / "executed" / f"child-{os.getpid()}.json"
        unfinished = path.with_suffix(".part")  # the process may be killed while it writes
        unfinished.write_text(json.dumps({"test": test, "sources": inside}), encoding="utf-8")
        unfinished.rename(path)


atexit.register(_write)
