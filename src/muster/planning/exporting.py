"""A plan as files of other programs."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import plan_of
from muster.mission.texts.text_files import write_bytes
from muster.mission.values.keywords import require_known
from muster.planning.export_formats import (
    FORMATS,
    ExportKeywords,
    ExportOptions,
    Files,
    makes_folder,
    options_of,
)
from muster.planning.request import require_mission

if TYPE_CHECKING:
    from muster.verification import Verdict


def export(
    mission: Mission,
    plan: Plan | Mapping[str, Any],
    to: str,
    path: str | Path | None = None,
    *,
    ignore: str | Collection[str] = (),
    **options: Unpack[ExportKeywords],
) -> Files:
    """Write an admissible plan for another program.

    Parameters
    ----------
    plan
        a plan; or a mapping, as for `verify`.
    to
        qgc, geojson, gpx, kml, csv, sol, sheets, overview, xlsx, ics, or a format of an installed package.
    path
        where it is written: a file, or a folder for qgc, with `per_robot` and for several files; None: nowhere.
    ignore
        rules that do not hold.
    options
        those of the format, as in `ExportOptions`: altitudes, clearance, per_robot, and more of qgc.

    Returns
    -------
    The texts and bytes by the names of their files, and messages to read before anything flies.

    Raises
    ------
    PlanError
        if the plan is not admissible, or a mapping is no plan.
    MissionError
        if the format needs a place on Earth, or times of day, and the mission has none.
    ParameterError
        if the plan is none, there is no such format, or an option is wrong.
    """
    from muster.verification.required import require_admissible

    require_mission(mission)
    require_known(options, options_of(to), f"to {to}")
    chosen, given = ExportOptions(**options), plan_of(plan)
    verdict = require_admissible(mission, given, "<plan>", ignore)
    files = exported(mission, verdict, to, chosen, given)
    if path is not None:
        _write(files, Path(path), is_folder=makes_folder(to, chosen) or len(files.contents) > 1)
    return files


def exported(mission: Mission, verdict: Verdict, form: str, options: ExportOptions, plan: Plan | None = None) -> Files:
    """Return an admissible plan as files of a format.

    Parameters
    ----------
    mission : Mission
    verdict : Verdict
        The judge's verdict on the plan.
    form : str
        The name of the format.
    options : ExportOptions
        For formats that declare options.
    plan : Plan, optional
        The judged plan. Without it the files do not say who made it and why tasks are left out.

    Raises
    ------
    MissionError
        if the format needs a place on Earth, or times of day, and the mission has none.
    ParameterError
        if there is no such format, drones have no height to fly at, or an altitude is for no drone.
    """
    write = FORMATS.named(form)
    made = write(mission, verdict, options, plan) if options_of(form) else write(mission, verdict)
    files = made if isinstance(made, Files) else Files({f"plan.{form}": made})
    cut_short = () if plan is None or not plan.cut_short else (plan.cut_short_line,)
    return replace(files, messages=(*cut_short, *files.messages)) if cut_short else files


def _write(files: Files, path: Path, *, is_folder: bool) -> None:
    if is_folder:
        path.mkdir(parents=True, exist_ok=True)
    for name, content in files.encoded.items():
        write_bytes(path / name if is_folder else path, content)
