"""The nodes beside `/muster`, each a process, which are started, watched and ended with it (TCF, Table 5.1)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence

from muster.mission.system.interrupts import ctrl_c_held_back
from muster_robots.ros1.node import SHUT_DOWN, master_answers
from muster_robots.ros1.ros import rospy

DUTIES = ("command_interface", "system_monitor", "mission_planner")
_LOOK_S = 0.2
_MASTER_S = 1.0
_PATIENCE_S = 3.0
_MASTER_GONE_S = 5.0
"""Topics live on without their master: for so long it is waited for, or for another in its place."""
_HANGS_S = 10.0
"""After a fault; a master that hangs would be waited for without end."""


class NodeProcesses:
    """A context: within it the nodes live, and a thread sees whether they and the ROS master do.

    Parameters
    ----------
    command
        what runs one of them: its duty's name is added to it. Ctrl-C does not reach it.
    master
        address of the ROS master.
    asked_to_end
        whether all is to end, for a reason of the program's own.
    on_end
        is called again and again from when all is to end.
    duties
        names of the nodes.
    """

    def __init__(
        self,
        command: Sequence[str],
        master: str,
        *,
        asked_to_end: Callable[[], bool],
        on_end: Callable[[], None],
        duties: Sequence[str] = DUTIES,
    ) -> None:
        self._command, self._master, self._duties = command, master, duties
        self._asked_to_end, self._on_end = asked_to_end, on_end
        self._closed = threading.Event()
        self._watch = threading.Thread(target=self._watch_on, daemon=True)
        self._processes: dict[str, subprocess.Popen[bytes]] = {}
        self._master_gone = False
        self.fault = ""
        """What is wrong, in a line, from when something is."""

    def __enter__(self) -> NodeProcesses:
        environment = os.environ | {"ROS_MASTER_URI": self._master}
        with ctrl_c_held_back():
            for duty in self._duties:
                self._processes[duty] = subprocess.Popen(
                    [*self._command, duty],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.DEVNULL,
                    env=environment,
                )
        self._watch.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._closed.set()
        self._watch.join()
        for process in self._processes.values():
            assert process.stdin is not None
            process.stdin.close()
        until = time.monotonic() + (0.0 if self._master_gone else _PATIENCE_S)  # nobody is there to say goodbye to
        for process in self._processes.values():
            try:
                process.wait(max(0.0, until - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _watch_on(self) -> None:
        answered_s = fault_s = time.monotonic()
        asked_s = answered_s
        while not self._closed.wait(_LOOK_S):
            now = time.monotonic()
            if not self.fault and now - asked_s >= _MASTER_S:
                self._master_gone = not master_answers(self._master)
                answered_s = answered_s if self._master_gone else time.monotonic()
                asked_s = time.monotonic()
            if not self.fault:
                self.fault, fault_s = self._shut_down() or self._dead() or self._left(asked_s - answered_s), now
            elif now - fault_s > _HANGS_S:
                self._give_up()
            if self.fault or self._asked_to_end():
                self._on_end()

    def _left(self, unanswered_s: float) -> str:
        if unanswered_s < _MASTER_GONE_S:
            return ""
        return f"ROS master: {self._master}: no answer for {_MASTER_GONE_S:g} s; expected it to stay"

    def _give_up(self) -> None:
        for process in self._processes.values():
            process.kill()
        sys.stderr.write(self.fault + "\n")
        sys.stderr.flush()
        os._exit(2)

    def _dead(self) -> str:
        for duty, process in self._processes.items():
            code = process.poll()
            if code is not None:
                how = f"exit code {code}" if code >= 0 else signal.Signals(-code).name
                return f"node /{duty}: it has ended ({how}); expected it to stay"
        return ""

    def _shut_down(self) -> str:
        return SHUT_DOWN if rospy.is_shutdown() else ""
