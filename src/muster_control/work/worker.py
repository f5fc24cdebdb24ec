"""A worker process: reads requests from standard input, one JSON line each, and answers on standard output.

The pool starts it: `python -m muster_control.work.worker MEMORY_MB PARENT`. It ends with its input, and is killed when
the server ends. Standard output is for answers only; what libraries print goes to standard error.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, BinaryIO

from muster.allocation.stop import Stop
from muster.mission.errors import InputError, MusterError
from muster_control.work.errors import MOST_FINDINGS
from muster_control.work.limits import is_of_memory, limit_memory
from muster_control.work.requests import requests
from muster_control.work.tasks import TASKS, Task

_NICE = 10  # lower priority than the server, which must answer quickly
_SPENT = 0.5  # of the memory; a worker whose peak is higher is not used again
_KILL_WITH_PARENT = 1  # PR_SET_PDEATHSIG of prctl(2)

Send = Callable[[Mapping[str, Any]], None]


def main(arguments: list[str], tasks: Mapping[str, Task] = TASKS) -> None:
    """Do tasks until the input ends."""
    memory_mb, parent = (int(word) for word in arguments)
    _end_with(parent)
    limit_memory(memory_mb)
    os.nice(_NICE)
    send = _sending(_protected_output())
    for line, stop in requests(open(0, "rb", closefd=False)):  # noqa: SIM115 - read until the end of the process
        answer = _answer(json.loads(line), tasks, send, stop)
        spent = _held_most() > _SPENT * memory_mb * 2**20
        send({**answer, "spent": spent})


def _end_with(parent: int) -> None:
    """Let the kernel kill this process when the server ends: the end of the input is seen only after the task."""
    if sys.platform != "linux":
        return
    import ctypes

    ctypes.CDLL(None).prctl(_KILL_WITH_PARENT, signal.SIGKILL)
    if os.getppid() != parent:  # it ended before the call above
        sys.exit()


def _protected_output() -> BinaryIO:
    """The standard output, for answers; everything else that is printed goes to standard error."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return answers


def _sending(answers: BinaryIO) -> Send:
    def send(message: Mapping[str, Any]) -> None:
        answers.write(json.dumps(message, ensure_ascii=False).encode("utf-8", "replace") + b"\n")
        answers.flush()

    return send


def _held_most() -> int:
    """The peak memory of this process, bytes.

    On Linux getrusage would count the memory of the server that started this process.
    """
    if sys.platform == "linux":
        status = Path("/proc/self/status").read_text(encoding="utf-8")
        return 1024 * int(status.split("VmHWM:")[1].split()[0])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # bytes on macOS


def _answer(request: Mapping[str, Any], tasks: Mapping[str, Task], send: Send, stop: Stop) -> dict[str, Any]:
    """Run one task in its own folder; returns the answer."""
    home = Path.cwd()
    try:
        task = tasks[request["task"]]
        run = importlib.import_module(task.module).run
        stops = (stop,) if task.stoppable else ()
        with tempfile.TemporaryDirectory(prefix="task-") as folder:
            os.chdir(folder)
            try:
                return {"done": run(request["arguments"], lambda progress: send({"progress": progress}), *stops)}
            finally:
                os.chdir(home)
    except Exception as error:
        return {"failed": _failure(error)}


def _failure(error: Exception) -> dict[str, Any]:
    """The answer for an error: a line for a person, and all findings of a wrong input."""
    if is_of_memory(error):
        return {"kind": "memory", "error": "", "findings": []}
    if isinstance(error, InputError):
        first, *others = error.findings
        more = f" (and {len(others)} more)" if others else ""
        findings = [finding.as_dict() for finding in error.findings[:MOST_FINDINGS]]
        return {"kind": "input", "error": f"{first}{more}", "findings": findings}
    if isinstance(error, MusterError):
        return {"kind": "input", "error": " ".join(str(error).split()), "findings": []}
    if isinstance(error, RecursionError):
        return {"kind": "input", "error": "nested too deep; expected plain data of a mission or plan", "findings": []}
    traceback.print_exception(error)
    told = traceback.format_exception_only(error)[-1].strip()
    return {"kind": "internal", "error": f"internal error: {told}", "findings": []}


if __name__ == "__main__":
    main(sys.argv[1:])
