"""Arguments and options that verbs share."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from muster.mission.errors import Finding, ParameterError
from muster.mission.ignorable_rules import IGNORABLE, ignored_rules
from muster.mission.model import OBJECTIVES, Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import read_plan
from muster.mission.value_types import FLAGS

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from muster.planning.mission_readers import Noted
    from muster.verification import Verdict


class Finite(click.FloatRange):
    """A number between two limits. NaN is refused, which `FloatRange` accepts."""

    def __init__(self, least: float, most: float) -> None:
        super().__init__(min=least, max=most)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        number: float = super().convert(value, param, ctx)
        if number != number:
            self.fail(f"{number} is not in the range {self._describe_range()}.", param, ctx)
        return number


Verb = TypeVar("Verb", bound=Callable[..., Any])
_FILE = click.Path(path_type=Path)


def grouped(*options: Callable[[Any], Any]) -> Callable[[Verb], Verb]:
    """Return what adds options to a verb, in the order in which its help lists them."""

    def add(verb: Verb) -> Verb:
        decorated: Any = verb
        for option in reversed(options):
            decorated = option(decorated)
        return cast("Verb", decorated)

    return add


def _ignored(_: click.Context, __: click.Parameter, value: str | None) -> tuple[str, ...]:
    return ignored_rules([name.strip() for name in (value or "").split(",") if name.strip()])


column_option = click.option(
    "--column",
    "columns",
    multiple=True,
    metavar="KEY=HEADING",
    help="What a heading of a table means, where its name does not say so: lat=Breite.",
)
format_option = click.option(
    "--format",
    "form",
    type=click.Choice(["table", "json"]),
    default="table",
    show_default=True,
    help="What is printed: for people, or for programs.",
)
quiet_option = grouped(
    click.option("-q", "--quiet", is_flag=True, help="No progress or messages on standard error, errors aside."),
    click.option("-v", "--verbose", is_flag=True, help="Print more messages on standard error."),
)
ignore_option = click.option(
    "--ignore",
    callback=_ignored,
    metavar="RULES",
    help=f"Rules that do not hold, separated by commas: {', '.join(IGNORABLE)}.",
)
objective_option = click.option(
    "--objective", metavar=f"[{'|'.join(OBJECTIVES)}]", help="Instead of the mission's own."
)
require_complete_option = click.option(
    "--require-complete", is_flag=True, help="Exit with 3 if a task is left out or impossible."
)
accept_partial_option = click.option(
    "--accept-partial",
    is_flag=True,
    help="Accept a plan that the time limit cut short; else it is not carried out, and the exit code is 3.",
)


@dataclass(frozen=True, kw_only=True)
class MissionFile:
    """The argument MISSION, a file or the name of a shipped mission, with the flags that some formats need."""

    name: str
    robots: Path | None
    suitability: Path | None
    salesmen: int | None
    depot: str | None
    columns: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[str | Path | None, ...]:
        """The files that are read; None for those not given."""
        return self.name, self.robots, self.suitability

    def load(self, *, verbose: bool = False) -> Mission:
        """Read the mission, print what was chosen; with -v the file and the numbers of robots and tasks."""
        return self.load_noted(verbose=verbose).mission

    def load_noted(self, *, verbose: bool = False) -> Noted:
        """Read and print as `load` does, and keep what the reader says."""
        from muster.planning.loading import load_noted

        if self.depot is not None and self.salesmen is None:
            raise ParameterError("--depot given; expected it together with --salesmen")
        flags = {name: getattr(self, name) for name in ("robots", "suitability", "salesmen")}
        found = load_noted(self.name, **flags, depot=self.depot, columns=pairs_of("--column", self.columns) or None)
        loaded = found.mission
        for note in () if click.get_current_context().params.get("quiet") else found.said:
            click.echo(note, err=True)
        if verbose:
            amount = f"{len(loaded.robots)} robots, {len(loaded.tasks)} tasks"
            click.echo(f"read {loaded.source.file}: mission {loaded.name}, {amount}", err=True)
        return found


MISSION_FLAGS = ("robots", "suitability", "salesmen", "depot", "columns")


def mission_argument(verb: Verb) -> Verb:
    """The argument MISSION and its flags, as a `MissionFile`."""
    return _with_mission(verb, required=True)


def optional_mission_argument(verb: Verb) -> Verb:
    """The optional argument MISSION and its flags, as a `MissionFile` or None."""
    return _with_mission(verb, required=False)


def _complete_mission(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Return the names of shipped missions, and files, as a shell completes them."""
    from click.shell_completion import CompletionItem

    from muster.library import missions

    named = [m for m in missions() if m.name.startswith(incomplete)] if "/" not in incomplete else []
    return [CompletionItem(incomplete, type="file"), *(CompletionItem(m.name, help=m.description) for m in named)]


def _with_mission(verb: Verb, *, required: bool) -> Verb:
    @wraps(verb)
    def with_mission(*, mission: str | None, **given: Any) -> Any:
        flags = {name: given.pop(name) for name in MISSION_FLAGS}
        if mission is None:
            require_none_without_mission(**{name: value or None for name, value in flags.items()})
            return verb(mission=None, **given)
        return verb(mission=MissionFile(name=mission, **flags), **given)

    options = grouped(
        click.argument("mission", required=required, shell_complete=_complete_mission),
        click.option("--robots", type=_FILE, metavar="FILE", help="Robots of a task list or a site."),
        click.option("--suitability", type=_FILE, metavar="CSV", help="Suitability of a task list or a site."),
        click.option(
            "--salesmen",
            type=click.IntRange(min=1),
            metavar="M",
            help="Robots of an instance file (TSPLIB, VRPLIB, ...).",
        ),
        click.option("--depot", metavar="NODE", help="Start and end of a TSPLIB mission.  [default: 1]"),
        column_option,
    )
    return cast("Verb", options(with_mission))


def pairs_of(option: str, given: Sequence[str]) -> dict[str, str]:
    """The values of NAME=VALUE by name.

    Raises
    ------
    ParameterError
        if one is not of this form, or stands twice.
    """
    found: dict[str, str] = {}
    for pair in given:
        name, _, value = (part.strip() for part in pair.partition("="))
        if not name or not value:
            raise ParameterError(f"{option}: {pair}; expected NAME=VALUE")
        if name in found:
            raise ParameterError(f"{option}: {name} given twice; expected it once")
        found[name] = value
    return found


def require_none_without_mission(**of_mission: object) -> None:
    """Refuse options of a mission without a mission."""
    for name, value in of_mission.items():
        if value is not None:
            raise ParameterError(f"--{name} given without a MISSION; expected both")


def load_plan(file: Path, mission: Mission, ignore: tuple[str, ...] = (), *, quiet: bool, verbose: bool) -> Plan:
    """Read a plan file and print what `say_of_plan` prints."""
    plan = read_plan(file, mission)
    say_of_plan(plan, file, mission, ignore, quiet=quiet, verbose=verbose)
    return plan


def say_of_plan(
    plan: Plan, file: Path, mission: Mission, ignore: tuple[str, ...] = (), *, quiet: bool, verbose: bool
) -> None:
    """Print with -v which plan was read; without -q warnings about what it says of itself.

    Rules that the plan was made without hold here unless they are to `ignore`.
    """
    if verbose:
        amount = f"{len(plan.routes)} routes, {sum(len(route.tasks) for route in plan.routes)} tasks"
        click.echo(f"read {file}: plan, {amount}", err=True)
    if plan.cut_short and not quiet:
        click.echo(f"warning: {file}: {plan.cut_short_line}", err=True)
    held = [rule for rule in plan.ignored if rule not in ignore]
    if held and not quiet:
        expected = f"--ignore {','.join((*ignore, *held))}, or these rules hold"
        click.echo(f"warning: {Finding(str(file), None, 'ignored', ', '.join(held), expected)}", err=True)


def require_admissible(mission: Mission, plan: Plan, file: Path, ignore: tuple[str, ...] = ()) -> Verdict:
    """What the judge says; a plan that breaks a rule is not handed on to robots, those to `ignore` aside.

    Raises
    ------
    PlanError
        if it does.
    """
    from muster.verification.required import require_admissible as required

    return required(mission, plan, str(file), ignore)


def settings_of(settings: tuple[str, ...], options: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by name: those of `--set NAME=VALUE`, and those with options of their own (None: not given).

    Raises
    ------
    ParameterError
        if one is given twice, or a setting is not NAME=VALUE.
    """
    given = {name: value for name, value in options.items() if value is not None}
    values: dict[str, Any] = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        if name.strip() in values:
            raise ParameterError(f"--set: {name.strip()} given twice; expected it once")
        if name.strip() in given:
            raise ParameterError(f"--set: {name.strip()} given twice; expected it once, as --{name.strip()}")
        if not equals or not name.strip() or not text.strip():
            raise ParameterError(f"--set: {setting}; expected NAME=VALUE")
        try:
            values[name.strip()] = int(text) if text.strip().lstrip("+-").isdigit() else float(text)
        except ValueError:
            values[name.strip()] = FLAGS.get(text.strip().lower(), text.strip())
    return given | values
