"""What `muster replay` does with recordings of ROS: shows their poses, writes records as such, compares with them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options import Finite, Verb
from muster.cli.tables import number, print_table
from muster.mission.errors import ParameterError
from muster.mission.texts.counting import counted

if TYPE_CHECKING:
    from muster.report.record import Recording
    from muster_robots.recordings import PoseTrack


_FILE = click.Path(path_type=Path)
_OPTIONS = (
    click.option("--ros2", type=_FILE, metavar="FILE", help="Write it as messages of ROS 2 (.mcap)."),
    click.option("--ros1", type=_FILE, metavar="FILE", help="Write it as a bag of ROS 1 (.bag)."),
    click.option("--reference", type=_FILE, metavar="RECORDING", help="Say how far robots were from what this has."),
    click.option(
        "--topic",
        "topics",
        multiple=True,
        metavar="ROBOT=TOPIC",
        help="Topic of a robot's poses in the reference.  [default: /ROBOT/odom, or pose]",
    ),
    click.option(
        "--begins", type=Finite(-1e11, 1e11), metavar="S", help="When the mission began, on the clock of ROS."
    ),
)


def add_options(verb: Verb) -> Verb:
    """--ros2, --ros1, --reference, --topic, --begins."""
    for option in reversed(_OPTIONS):
        verb = option(verb)
    return verb


def outputs(given: Mapping[str, Any]) -> tuple[Path | None, ...]:
    """See `OtherRecordings`."""
    return given["ros2"], given["ros1"]


def inputs(given: Mapping[str, Any]) -> tuple[Path | None, ...]:
    """See `OtherRecordings`."""
    return (given["reference"],)


def require_consistent(record: Path, given: Mapping[str, Any]) -> None:
    """Refuse, before anything is written, options that exclude each other.

    Raises
    ------
    ParameterError
        if options exclude each other, or a file has another suffix than its format.
    """
    if is_recording(record):
        for option in ("html", "gantt", "ros2", "ros1", "reference"):
            if given[option] is not None:
                raise ParameterError(f"--{option}: {record} is a recording of poses; expected a record of muster")
    for option, suffix in (("ros2", ".mcap"), ("ros1", ".bag")):
        file = given[option]
        if file is not None and file.suffix != suffix:
            raise ParameterError(f"--{option}: {file}; expected a file that ends in {suffix}")
    if given["topics"] and given["reference"] is None:
        raise ParameterError("--topic given; expected it together with --reference")
    if given["begins"] is not None and all(given[option] is None for option in ("reference", "ros2", "ros1")):
        raise ParameterError("--begins given; expected it together with --reference, --ros2 or --ros1")


def is_recording(file: Path) -> bool:
    """See `OtherRecordings`."""
    from muster_robots.recordings import is_recording as is_of_ros

    return is_of_ros(file)


def show(file: Path, plot: Path | None, form: str, *, quiet: bool) -> int:
    """Print and draw the tracks in a recording of others."""
    tracks = _tracks(file, quiet=quiet)
    if plot is not None:
        from muster.report.files import save_figure
        from muster_robots.recordings.picture import plot_tracks

        save_figure(plot_tracks(file.name, list(tracks.values())), plot)
    rows = [_row(track) for track in tracks.values()]
    if form == "json":
        from muster.mission.plan import json_text

        click.echo(json_text({"recording": str(file), "tracks": rows}), nl=False)
        return DONE
    columns = ("topic", "type", "frame", "poses", "begins [s]", "lasts [s]", "travelled [m]")
    cells = [
        (
            *(row["topic"], row["type"], row["frame"], str(row["poses"])),
            *(f"{row['begins_s']:.3f}", number(row["lasts_s"]), number(row["travelled_m"])),
        )
        for row in rows
    ]
    print_table(columns, cells, title=f"{file}: {counted(len(rows), 'track')}", right=columns[3:])
    return DONE


def _tracks(file: Path, *, quiet: bool) -> Mapping[str, PoseTrack]:
    from muster_robots.recordings import read_poses

    recording = read_poses(file)
    if not recording.complete and not quiet:
        click.echo(f"warning: {file}: breaks off; what is whole counts", err=True)
    return recording.tracks


def _row(track: PoseTrack) -> dict[str, Any]:
    from muster.motion.metrics import path_length, travel_time

    return {
        "topic": track.topic,
        "type": track.kind,
        "frame": track.frame,
        "poses": len(track.times_s),
        "begins_s": float(track.times_s[0]),
        "lasts_s": travel_time(track.times_s),
        "travelled_m": path_length(track.positions),
    }


def answer(recording: Recording, given: Mapping[str, Any], *, quiet: bool) -> Mapping[str, Any]:
    """Write a record as files of ROS, and compare robots with a reference; see `OtherRecordings`."""
    _write_for_ros(recording, given, quiet=quiet)
    return {} if given["reference"] is None else {"reference": _errors_against(recording, given, quiet=quiet)}


def _write_for_ros(recording: Recording, given: Mapping[str, Any], *, quiet: bool) -> None:
    from muster_robots.recordings import write_ros1, write_ros2

    for file, write in ((given["ros2"], write_ros2), (given["ros1"], write_ros1)):
        if file is not None:
            counts = write(file, recording, begins_s=given["begins"] or 0.0)
            if not quiet:
                topics, messages = counted(len(counts), "topic"), counted(sum(counts.values()), "message")
                click.echo(f"wrote {file}: {topics}, {messages}", err=True)


def _errors_against(recording: Recording, given: Mapping[str, Any], *, quiet: bool) -> Mapping[str, Any]:
    """Distances of robots from a recording: its file, its clock, and a row for each robot."""
    from muster_robots.recordings import Reference, deviations

    tracks = _tracks(given["reference"], quiet=quiet)
    reference = Reference.of(recording, tracks, _topics(given["topics"]), given["begins"])
    rows = [
        {
            "robot": off.robot,
            "topic": off.topic,
            "samples": off.samples,
            "error_m": off.error.total,
            "mean_m": off.error.mean,
            "most_m": off.error.most,
            "risk_per_m": off.risk,
            "travelled_m": off.travelled_m,
            "reference_m": off.reference_m,
        }
        for off in deviations(recording, reference)
    ]
    return {"file": str(given["reference"]), "begins_s": reference.begins_s, "robots": rows}


def _topics(texts: tuple[str, ...]) -> dict[str, str]:
    topics: dict[str, str] = {}
    for text in texts:
        robot, equals, topic = text.partition("=")
        if not equals or not robot or not topic or robot in topics:
            raise ParameterError(f"--topic: {text}; expected ROBOT=TOPIC, each robot at most once")
        topics[robot] = topic
    return topics


def print_answer(answer: Mapping[str, Any]) -> None:
    """See `OtherRecordings`."""
    if "reference" in answer:
        _print_errors(answer["reference"])


def _print_errors(off: Mapping[str, Any]) -> None:
    columns = ("robot", "topic", "samples", "(7) [m]", "mean [m]", "most [m]", "(8) [1/m]", "way [m]")
    rows = [
        (
            *(row["robot"], row["topic"], str(row["samples"])),
            *(number(row[key]) for key in ("error_m", "mean_m", "most_m", "risk_per_m", "travelled_m")),
            number(row["reference_m"]),
        )
        for row in off["robots"]
    ]
    title = f"{off['file']}: the mission's clock begins at {off['begins_s']:.3f} s of it"
    print_table((*columns, "reference [m]"), rows, title=title, right=(*columns[2:], "reference [m]"))
