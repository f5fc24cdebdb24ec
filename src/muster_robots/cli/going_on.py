"""--resume and --recover of the verbs for real robots: which journal a run keeps, and which it goes on with."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.live_output import print_event
from muster.cli.options.common import Verb
from muster.mission.errors import InputError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster_robots.cli.last_lines import LastLines, show_final_states

if TYPE_CHECKING:
    from muster.execution.final_state import FinalState
    from muster.execution.fleet import Fleet
    from muster.running.journal import Journal
    from muster.running.journal_file import ReadJournal
    from muster_robots.cli.run_options import RealRunOptions


def resume_option(verb: Verb) -> Verb:
    """--resume."""
    return click.option(
        "--resume",
        is_flag=False,
        flag_value="",
        default=None,
        metavar="[JOURNAL]",
        help="Go on with a run that did not end, from where robots are now.  [default JOURNAL: that of these robots]",
    )(verb)


@dataclass(frozen=True)
class GoingOn:
    """How a call relates to a run before it.

    Attributes
    ----------
    mission : Mission
        As its file has it.
    path : Path
        The journal of the run.
    fleet, claims
        Whose journal it is.
    resumes, recovers : bool
        What was asked for.
    before : ReadJournal or None
        The journal of the run that is resumed, or after which robots are brought home.
    interrupted : ReadJournal or None
        The journal of a run of these robots that did not end, where neither was asked for.
    """

    mission: Mission
    path: Path
    fleet: str
    claims: Collection[str]
    resumes: bool
    recovers: bool
    before: ReadJournal | None = None
    interrupted: ReadJournal | None = None

    @property
    def again(self) -> bool:
        """Whether the mission is under way already, so that robots may be anywhere."""
        return self.resumes or self.recovers

    def judged(self, states: Sequence[FinalState]) -> list[FinalState]:
        """The states of robots, where those count as moving that the run before has sent off and nobody hears."""
        sent = set() if self.before is None else self.before.sent
        lost = "not heard since the stop: it may be armed, or move"
        return [
            replace(one, state=lost, moving=True) if one.position is None and one.robot in sent else one
            for one in states
        ]

    def require_nobody_left(self, states: Sequence[FinalState]) -> None:
        """Raise `ParameterError` if a run that did not end has left robots armed, moving, or away from their starts."""
        from muster.running.journal import left_behind

        if self.interrupted is None or not (left := left_behind(self.interrupted, self.mission, states)):
            return
        run = f"the run of {self.interrupted.header.name} did not end ({self.interrupted.progress})"
        helps = "--resume, which goes on with it, or --recover, which brings everyone home"
        left_so = "; ".join(left)
        raise ParameterError(
            f"{self.path}: {run}, and has left {left_so}; expected {helps} (or no such file, to begin anew)"
        )


def going_on(options: RealRunOptions, mission: Mission, more_claims: Collection[str] = ()) -> GoingOn:
    """Return how a call relates to a run before it, before robots are looked for.

    Parameters
    ----------
    options : RealRunOptions
        What was asked for.
    mission : Mission
        As its file has it.
    more_claims : collection of str
        What tells these robots from others, beside what the fleet claims.

    Raises
    ------
    MusterError
        if options do not go together, or the journal is that of another mission or fleet, or of a run that has ended.
    """
    from muster.running.journal import interrupted_run
    from muster.running.journal_file import journal_place, read_journal
    from muster.running.robot_claims import claims_of_request

    resumes = options.resume is not None
    if resumes and options.request.recover:
        raise ParameterError("--recover given with --resume; expected one of them")
    if (resumes or options.request.recover) and options.plan is not None:
        raise ParameterError(f"--plan given with --{'resume' if resumes else 'recover'}; expected no plan")
    fleet = options.request.world
    claims = {*claims_of_request(options.request), *more_claims}
    place = journal_place(fleet, claims)
    found = GoingOn(mission, place, fleet, claims, resumes, options.request.recover)
    if options.request.recover:
        return replace(found, before=_of_same(place, mission))
    if options.resume is None:
        return replace(found, interrupted=interrupted_run(place))
    before = read_journal(_named(options.resume, place))
    before.require_of(mission, fleet, claims)
    before.require_under_way()
    _require_other_record(options.record, before)
    return replace(found, path=before.path, before=before)


def as_wanted(options: RealRunOptions, how: GoingOn) -> RealRunOptions:
    """Return the options with what robots were to do at the end, where the run before had come to that."""
    settings, before = options.request.settings, how.before
    if before is None or not how.resumes or not before.at_end or getattr(settings, "at_end", None) != "hold":
        return options
    return replace(options, request=replace(options.request, settings=replace(settings, at_end=before.at_end)))


def _named(asked: str, place: Path) -> Path:
    """The journal that --resume names; where it names the record of the last run, that run's journal."""
    from muster.running.journal_file import read_journal

    if not asked:
        return place
    if place.exists() and read_journal(place).header.record == str(Path(asked).absolute()):
        return place
    return Path(asked)


def _require_other_record(record: Path | None, before: ReadJournal) -> None:
    if record is not None and record.exists() and before.header.record == str(record.absolute()):
        expected = "another file: it has where robots were before the stop"
        raise ParameterError(f"--record {record}: the record of the run that is resumed; expected {expected}")


def _of_same(place: Path, mission: Mission) -> ReadJournal | None:
    """The journal of robots, if there is one of the mission that can be read."""
    from muster.running.journal_file import read_journal

    try:
        found = read_journal(place) if place.exists() else None
    except InputError as error:
        click.echo(f"warning: {error}; starts are those of the mission", err=True)
        return None
    return found if found is not None and found.is_of(mission) else None


@contextmanager
def kept_journal(how: GoingOn, plan: Plan, options: RealRunOptions) -> Iterator[Journal]:
    """The journal of the run, which is begun, or goes on; it is named before robots are sent anywhere."""
    from muster.running.journal import Journal
    from muster.running.journal_file import Header

    def say(line: str) -> None:
        click.echo(line, err=True)

    if how.before is None or not how.resumes:
        header = Header.of(how.mission, plan, how.fleet, how.claims, options.record)
        journal = Journal.begun(how.path, how.mission, header, plan.ignored, say)
        told = "by it --resume goes on with the run if it is interrupted"
    else:
        journal = Journal.resumed(how.before, how.mission, say)
        wanted = "".join(f"; {robot} was to {what}" for robot, what in how.before.wanted.items())
        told = f"goes on with the run of {how.before.header.name}, {how.before.progress}{wanted}"
    if not options.quiet:
        say(f"journal: {how.path}: {told}")
    try:
        yield journal
    finally:
        journal.close()


@contextmanager
def left_robots_told(how: GoingOn) -> Iterator[None]:
    """Context manager that says, where robots are refused, which of them are armed or move, and what helps."""
    from muster.execution.final_state import RobotsLeftError

    try:
        yield
    except RobotsLeftError as error:
        states = error.states
        LastLines(lambda: states).tell()
        how.require_nobody_left(states)
        raise


def recovered(
    how: GoingOn, fleet: Fleet, options: RealRunOptions, halt: threading.Event, at_end: Callable[[], None]
) -> int:
    """Bring all robots home, say where each is then, and return the exit code.

    Parameters
    ----------
    at_end : callable
        Called when robots are at their starts whose fleet does not bring them home and down itself.
    """
    from muster.execution.final_state import final_states_of
    from muster.running.bring_home import bring_home
    from muster.running.journal import Journal

    journal = None if how.before is None else Journal.resumed(how.before, how.mission)
    try:
        with LastLines(lambda: how.judged(final_states_of(fleet, how.mission)), begun=True):
            on_event = None if options.quiet else print_event
            ending = getattr(options.request.settings, "at_end", "hold")
            lost = bring_home(how.mission, fleet, halt, at_end=ending, journal=journal, on_event=on_event)
            if not hasattr(fleet, "recover"):
                at_end()
        states = how.judged(final_states_of(fleet, how.mission))
        if journal is not None:
            journal.end(states)
    finally:
        if journal is not None:
            journal.close()
    if options.form == "json":
        rows = [{"robot": one.robot, "state": str(one), "moving": one.moving} for one in states]
        click.echo(json_text({"robots": rows, "not_home": lost}), nl=False)
    for robot, why in lost.items():
        click.echo(f"{robot}: not home: {why}", err=True)
    if halt.is_set():
        click.echo("interrupted; robots were told to stay where they are", err=True)
    unheard = [one.robot for one in states if one.position is None]
    show_final_states(states, asks=True)
    return exit_code_if(
        (Ending.STILL_MOVING, any(one.moving for one in states)),
        (Ending.INTERRUPTED, halt.is_set()),
        (Ending.TASKS_LOST, lost or unheard),
    )
