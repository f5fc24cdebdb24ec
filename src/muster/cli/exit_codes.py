"""How a command ends: the table of all endings, and the one function that computes an exit code from them.

The table of docs/commands.md is made from `Ending`; a test compares them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import click

from muster.cli import exits


class Ending(Enum):
    """One thing that is true of a command when it ends. Several may hold: the first member in this order decides.

    Attributes
    ----------
    code : int
        The exit code of the command.
    ended : str
        How the command ended, for the documents.
    verbs : str
        The verbs that can end so.
    words : str
        A part of what the command prints then; empty where nothing is printed for it.
    status : str
        What the API of mission control answers, or how it stores the run.
    """

    STILL_MOVING = (
        exits.STILL_MOVING,
        "a real robot still flies or drives, is armed, or did or was when it was last heard",
        "`fly`, `ros`, `ros2`, `run`",
        "; at (",
        "entry `final_states` of the run",
    )
    INTERNAL_ERROR = (exits.INTERNAL_ERROR, "an error of Muster itself", "all", "internal error:", "500; run `failed`")
    INTERRUPTED = (exits.INTERRUPTED, "interrupted: Ctrl-C, SIGTERM, SIGHUP", "all", "interrupted", "run `cancelled`")
    BROKEN_PIPE = (exits.BROKEN_PIPE, "the reader of standard output went away", "all", "", "")
    REFUSED = (
        exits.BAD_INPUT,
        "refused: wrong input or usage, missing extra, robots that another run commands, mission whose time is over",
        "all",
        "; expected",
        "400, 409, 422, 501",
    )
    TASKS_LOST = (
        exits.TASKS_LOST,
        "no real robot moves or is armed; tasks were lost, or a robot has crashed",
        "`fly`, `ros`, `ros2`, `run`",
        "lost",
        "run `ended`, `tasks_lost` in its report",
    )
    CUT_SHORT = (
        exits.INCOMPLETE,
        "the time limit cut the plan short, and `--accept-partial` was not given",
        "`solve`, `simulate`, `export`, `fly`, `ros`, `ros2`, `run`",
        "cut short",
        "plan with `cut_short`; 409 to a run of it",
    )
    IMPOSSIBLE = (
        exits.INCOMPLETE,
        "tasks can never be done",
        "`check`",
        "can never be done",
        "`impossible` in the answer",
    )
    LEFT_OUT = (
        exits.INCOMPLETE,
        "the plan leaves tasks out, or the simulation lost tasks, and `--require-complete` was given",
        "`solve`, `auction`, `simulate`, `check`",
        "",
        "`unassigned` in the plan, `tasks_lost` in the report",
    )
    NO_PLAN = (exits.INCOMPLETE, "no run of the comparison has a plan", "`compare`", "", "job `failed`")
    REJECTED = (
        exits.REJECTED,
        "the plan is not admissible; a check of the installation failed",
        "`verify`, `doctor`, `auction`",
        "",
        "`valid` in the answer is false",
    )
    DONE = (exits.DONE, "done", "all", "", "200, 201, 202; job `done`; run `ended`")

    def __init__(self, code: int, ended: str, verbs: str, words: str, status: str) -> None:
        self.code, self.ended, self.verbs, self.words, self.status = code, ended, verbs, words, status


@dataclass
class Invocation:
    """One call of the command.

    Attributes
    ----------
    began_s : float or None
        Time of `SystemClock` at which the call began; None where it began with the verb.
    endings : list of Ending
        What a verb has noted for the exit code, see `note_ending`.
    """

    began_s: float | None = None
    endings: list[Ending] = field(default_factory=list)


def this_invocation() -> Invocation:
    """Return the call that is under way; a new one where the verb was not called by `muster.cli.main.run`."""
    context = click.get_current_context(silent=True)
    return (context and context.find_object(Invocation)) or Invocation()


def exit_code(*endings: Ending) -> int:
    """Return the exit code of a command for which all of `endings` hold; 0 if there are none."""
    return min((*endings, Ending.DONE), key=_PRECEDENCE.__getitem__).code


def gravest(*codes: int) -> int:
    """Return the exit code that decides among those of several parts of a command."""
    by_code = {ending.code: ending for ending in Ending}
    return exit_code(*(by_code[code] for code in codes))


def exit_code_if(*conditions: tuple[Ending, object]) -> int:
    """Return the exit code for the endings whose condition is true."""
    return exit_code(*(ending for ending, holds in conditions if holds))


def note_ending(ending: Ending) -> None:
    """Record what holds of this command however it ends, also where an exception leaves the verb.

    That a robot is still armed decides the exit code also where the file of the report cannot be written.
    """
    this_invocation().endings.append(ending)


_PRECEDENCE = {ending: k for k, ending in enumerate(Ending)}
