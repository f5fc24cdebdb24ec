"""The runner process of a run, `python -m muster_control.runs.runner.main MEMORY_MB`, connected to the server by pipes.

The first line is the run: `run`, `mission` (`name`, `text`, `files` in base64), `plan`, `world`, `settings`, `speed`,
`lock`, `journal`, `at`, and of a run that goes on `checkpoint`, the entries of the `log` after it up to `seq`,
`bodies`, `until_s`, `tracked_s`, `paused`, `cancelled`. The other lines are users' actions: `id`, `verb`, `data`,
`who`. When the pipe ends the server is gone: the runner stops real robots and ends. The memory limit is for simulated
worlds only.
"""

from __future__ import annotations

import base64
import os
import shutil
import signal
import sys
import threading
from collections.abc import Mapping
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_from
from muster.mission.yaml_writer import plain
from muster.running.begun import Begun
from muster.running.claim_locks import robots_claimed
from muster.running.robot_claims import claims_as_far_as_known
from muster.running.worlds import WORLDS
from muster.state import MissionState
from muster.state.recovery import recovered_from
from muster_control.runs.log.checkpoints import unpacked_state
from muster_control.runs.runner.local_journal import LocalJournal
from muster_control.runs.runner.lock import alone
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.pipe import Inbox, Outbox
from muster_control.runs.runner.run_loop import RunLoop
from muster_control.work.limits import is_of_memory, limit_memory
from muster_control.work.missions import mission_of
from muster_control.work.temporary_folders import OF_RUNS

if TYPE_CHECKING:
    from muster_control.runs.runner.real_run import RealRun
    from muster_control.runs.runner.simulated_run import SimulatedRun

_ENDS_WITHIN_S = 30.0
"""Seconds within which another run of the same robots, which is over, tells them to stand and ends."""
STRETCH_S, REAL_STRETCH_S = 5.0, 1.0
"""Seconds of mission time a stretch of tracks: of real robots a crash loses what is not yet kept."""


def main(arguments: list[str]) -> int:
    (memory_mb,) = (int(word) for word in arguments)
    with TemporaryDirectory(prefix=f"{OF_RUNS}{os.getpid()}-", ignore_cleanup_errors=True) as folder:
        return _obey(folder, memory_mb)


def _obey(folder: str, memory_mb: int) -> int:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server handles Ctrl-C
    lines, said = os.fdopen(os.dup(0), encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # prints of libraries must not mix with messages
    ended, real = threading.Event(), threading.Event()
    inbox, outbox = Inbox(lines, lambda: _end(ended, real, folder)), Outbox(said)
    begin = inbox.take(None)
    if begin is None:
        return 0
    if begin["world"] not in WORLDS:
        real.set()
        signal.signal(signal.SIGTERM, lambda *_: ended.set())
    else:
        limit_memory(memory_mb)
    try:
        _carry_out(begin, folder, inbox, outbox, ended)
    except MusterError as error:
        left = "; ".join(str(one) for one in getattr(error, "states", ()) if one.moving)
        told = f"; still flying, driving or armed: {left}; expected a run with recover" if left else ""
        outbox.send({"type": "failed", "reason": f"{str(error).splitlines()[0]}{told}"})
    except (MemoryError, OSError) as error:
        if real.is_set() or not is_of_memory(error):
            raise
        reason = f"it needs more than {memory_mb} MB of memory; expected more (--memory)"
        outbox.send({"type": "failed", "reason": reason})
    outbox.close()
    return 0


def _end(ended: threading.Event, real: threading.Event, folder: str) -> None:
    """End, as the server is gone: a simulated run goes on later; real robots are stopped first."""
    ended.set()
    if not real.is_set():
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(0)


def _carry_out(begin: Mapping[str, Any], folder: str, inbox: Inbox, outbox: Outbox, ended: threading.Event) -> None:
    real = begin["world"] not in WORLDS
    with ExitStack() as stack:
        if real:
            stack.enter_context(alone(Path(begin["lock"]), begin["run"]))
            stack.enter_context(robots_claimed(_claims_here(begin["world"], begin["settings"]), _ENDS_WITHIN_S))
        os.chdir(folder)
        mission = mission_of(begin["mission"])
        outbox.send({"type": "mission", "mission": _shown(mission)})
        outbox.send({"type": "resuming", "share": 0.4})
        plan = plan_from(begin["plan"], "the plan")
        local = None
        if real:
            local = stack.enter_context(closing(LocalJournal(outbox, begin, mission, plan)))
            begin = local.begin
            local.send_again()
        out = local or outbox
        state = _known(begin, mission, plan)
        recorder = LogRecorder(
            mission,
            out,
            state,
            seq=begin["seq"],
            tracked_s=begin["tracked_s"],
            stretch_s=REAL_STRETCH_S if real else STRETCH_S,
        )
        outbox.send({"type": "resuming", "share": 0.6})
        with closing(_world_run(begin, mission, plan, recorder, ended, local)) as world_run:
            if real:
                outbox.send({"type": "mission", "mission": _shown(replace(mission, starts_at=world_run.starts_at))})
            how = {key: begin[key] for key in ("speed", "paused", "cancelled")}
            outbox.send({"type": "going"})
            RunLoop(
                world_run,
                recorder,
                inbox,
                out,
                starts_at=world_run.starts_at,
                ended=ended.is_set,
                checkpoint=begin["seq"] - len(begin["log"]),
                obeyed=() if local is None else local.obeyed,
                **how,
            ).run()


def _known(begin: Mapping[str, Any], mission: Mission, plan: Plan) -> MissionState:
    """What is known of the mission so far."""
    checkpoint = None if begin["checkpoint"] is None else unpacked_state(base64.b64decode(begin["checkpoint"]))
    return recovered_from(mission, plan, begin["log"], checkpoint)


def _claims_here(world: str, settings: Mapping[str, Any]) -> frozenset[str]:
    """What the run claims on this machine; on ROS 1 the master ends the first of two nodes /muster."""
    return frozenset() if world == "ros1" else claims_as_far_as_known(world, settings)


def _world_run(
    begin: Mapping[str, Any],
    mission: Mission,
    plan: Plan,
    recorder: LogRecorder,
    ended: threading.Event,
    local: LocalJournal | None = None,
) -> SimulatedRun | RealRun:
    """The run in its world: from its beginning, or by what the recorder's state knows of it."""
    from muster_control.runs.run_settings import request_of

    request, state = request_of(begin["world"], begin["settings"], plan), recorder.state if begin["seq"] else None
    if begin["world"] in WORLDS:
        from muster_control.runs.runner.simulated_run import SimulatedRun

        begun = None if state is None else Begun.of(state, begin["bodies"], begin["until_s"], begin["world"])
        return SimulatedRun(mission, plan, request, recorder=recorder, begun=begun)
    from muster.running.fleet_registry import fleet_ready
    from muster_control.runs.runner.real_run import RealRun, RecoveryRun

    again = state is not None or request.recover
    fleet, at_end = fleet_ready(request.world, mission, request.settings, ended, again=again)
    made = RecoveryRun if request.recover else RealRun
    try:
        before_order = None if local is None else local.before_order
        how: dict[str, Any] = {"request": request, "state": state, "before_order": before_order}
        return made(mission, plan, fleet, recorder, at_end=at_end, halt=ended, **how)
    except BaseException:
        fleet.close()
        raise


def _shown(mission: Mission) -> dict[str, Any]:
    """The mission as plain data, without what pages do not need."""
    data: dict[str, Any] = plain(mission)
    return {key: value for key, value in data.items() if key != "travel"} | {"dimensions": mission.dimensions}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
