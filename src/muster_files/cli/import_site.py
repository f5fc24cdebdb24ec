"""`muster import`: files of a site as a mission."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import click

from muster.cli.exits import DONE
from muster.cli.options.common import Finite, column_option, pairs_of, quiet_option
from muster.cli.outputs import require_writable
from muster.mission.errors import ParameterError
from muster.mission.import_ledger import Ledger

_MOST_ROWS = 40
_WIDEST = 48


@click.command(name="import")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="The mission, as YAML.")
@click.option("--robots", type=click.Path(path_type=Path), metavar="FILE", help="Robots: a table or map, or a mission.")
@click.option("--suitability", type=click.Path(path_type=Path), metavar="CSV", help="Scores of robot types for tasks.")
@column_option
@click.option(
    "--as",
    "kinds",
    multiple=True,
    metavar="NAME=KIND",
    help="What a file, layer or feature is: task, robot (air, ground), station, zone, boundary, survey, lane, skip.",
)
@click.option("--height-m", type=Finite(0.1, 1e4), metavar="M", help="Height from which areas are surveyed.")
@click.option("--fov-deg", type=Finite(1, 179), metavar="DEG", help="Width of the picture of surveys' cameras.")
@click.option("--width-m", type=Finite(0.01, 1e4), metavar="M", help="Width of the tool of surveys, without a camera.")
@click.option("--origin", metavar="LAT,LON", help="Place of the map frame's origin.  [default: the middle of all]")
@click.option("--starts-at", metavar="TIME", help="When the mission begins, for clock times: 2027-03-01T08:00.")
@click.option("--name", metavar="NAME", help="Name of the mission.  [default: that of the first file]")
@click.option("--flat", is_flag=True, help="Leave heights out.")
@click.option(
    "--format",
    "form",
    type=click.Choice(("text", "json")),
    default="text",
    help="What is said of the files: lines, or, beside -o, JSON with the ledger of all their elements.",
)
@quiet_option
def command(  # noqa: PLR0913  the options of a verb
    files: tuple[str, ...],
    output: Path | None,
    robots: Path | None,
    suitability: Path | None,
    columns: tuple[str, ...],
    kinds: tuple[str, ...],
    origin: str | None,
    starts_at: str | None,
    name: str | None,
    flat: bool,
    form: str,
    height_m: float | None,
    fov_deg: float | None,
    width_m: float | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Make a mission of the files of a site: tables, maps, tracks.

    FILEs are CSV, XLSX, GeoJSON, KML, KMZ, GPX and GeoPackage; one may be a mission, to which the others are added.
    Names, a property kind, or --as say what features are. Without that points become tasks and lines lanes; areas
    that nothing decides are an error, which names the option that decides. Without -o the mission goes to standard
    output. What of the files is not read stands in a table at the end.
    """
    from muster.mission.plan import json_text
    from muster.mission.texts.text_files import write_text
    from muster.mission.yaml_writer import with_files_from, yaml_text
    from muster_files.importing import read_site

    if form == "json" and output is None:
        raise ParameterError("--format json: -o missing; expected a file for the mission beside it")
    require_writable(None, (output,), (*files, robots, suitability), ())
    found = read_site(
        *files,
        robots=robots,
        suitability=suitability,
        columns=pairs_of("--column", columns),
        kinds=pairs_of("--as", kinds),
        origin=None if origin is None else _origin(origin),
        starts_at=starts_at,
        name=name,
        flat=flat,
        height_m=height_m,
        fov_deg=fov_deg,
        width_m=width_m,
    )
    _say((*found.counts, *found.notes, *_ledger_lines(found.ledger)), quiet=quiet or form == "json")
    if form == "json":
        told = {"counts": found.counts, "notes": found.notes, "ledger": found.ledger.as_dict()}
        click.echo(json_text(told), nl=False)
    folder = Path() if output is None else output.parent
    text = yaml_text(with_files_from(found.mission, folder))
    if output is None:
        click.echo(text, nl=False)
    else:
        write_text(output, text)
    if output is not None and not quiet:
        click.echo(f"next: muster check {output}; muster solve {output}", err=True)
    if verbose:
        mission = found.mission
        click.echo(f"mission {mission.name}: {len(mission.robots)} robots, {len(mission.tasks)} tasks", err=True)
    return DONE


def _say(lines: Iterable[str], *, quiet: bool) -> None:
    for line in () if quiet else lines:
        click.echo(line, err=True)


def _origin(told: str) -> tuple[float, ...]:
    """The numbers of LAT,LON or LAT,LON,ALT."""
    from muster_files.sites.cells import CellError, lat_lon

    try:
        return lat_lon(told)
    except CellError as error:
        raise ParameterError(f"--origin: {told}; expected {error.args[0]}") from None


def _ledger_lines(ledger: Ledger) -> Iterator[str]:
    """Yield what was not read, as a table for people by file, kind and reason; nothing where all that counts was."""
    rows = [row for row in ledger.not_read if not row.minor]
    if not rows:
        return
    width = min(_WIDEST, max(len(row.told) for row in rows))
    yield "not read:"
    for file in dict.fromkeys(row.file for row in rows):
        mine = [row for row in rows if row.file == file]
        read, lost = ledger.count("read", file), ledger.count("passed over", file)
        yield f"  {file}: {read:,} elements read, {lost:,} passed over"
        for row in mine[:_MOST_ROWS]:
            yield f"    {row.count:>6,}  {row.told:<{width}}  {row.how}: it {row.said}"
        if len(mine) > _MOST_ROWS:
            yield f"    and {len(mine) - _MOST_ROWS} more kinds; --format json names all"
