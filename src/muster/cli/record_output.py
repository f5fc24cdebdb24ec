"""The record of a run: its file, and the page and pictures made of it at the end."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.options.common import grouped

if TYPE_CHECKING:
    from muster.report.record import Recording

_FILE = click.Path(path_type=Path)


drawing_options = grouped(
    click.option("--html", type=_FILE, metavar="FILE", help="Write a page to look at in a browser, offline."),
    click.option("--plot", type=_FILE, metavar="FILE", help="Draw where the robots went (.png, .svg, .pdf)."),
    click.option("--gantt", type=_FILE, metavar="FILE", help="Draw what they did when (.png, .svg, .pdf)."),
)
record_option = click.option(
    "--record", type=_FILE, metavar="FILE", help="Write a record (.mcap), for `muster replay`."
)
save_map_option = click.option(
    "--save-map",
    type=_FILE,
    metavar="FILE",
    help="Write the map that is built with --unknown as ROS has maps (.yaml, the image beside it).",
)


def map_outputs(file: str | Path | None) -> tuple[Path, ...]:
    """Return the files of the map of --save-map; none without one."""
    from muster.running.observed_run import files_of_map

    return () if file is None else files_of_map(Path(file))


@contextmanager
def kept_record(record: Path | None, html: Path | None, plot: Path | None, gantt: Path | None) -> Iterator[Path | None]:
    """The file to write the record to, or None. The page and pictures are made of it at the end."""
    wanted = any((html, plot, gantt))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "record.mcap" if record is None and wanted else record
        yield file
        if file is not None and wanted:
            from muster.report.record import read_record

            draw_record(read_record(file), html, plot, gantt)


def draw_record(recording: Recording, html: Path | None, plot: Path | None, gantt: Path | None) -> None:
    """Write the page, the picture and the time chart that are asked for."""
    if html is not None:
        from muster.report.page import write_page

        write_page(html, recording)
    if plot is not None:
        from muster.report.figures.files import save_figure
        from muster.report.maps.recorded_tracks import plot_flown

        save_figure(plot_flown(recording), plot)
    if gantt is not None:
        from muster.report.figures.files import save_figure
        from muster.report.time_charts.recorded_gantt import plot_flown_gantt

        save_figure(plot_flown_gantt(recording), gantt)
