"""The task that exports a plan to other programs."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from pathlib import PurePath
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.planning.export_formats import FORMATS, ExportOptions, altitudes_in, makes_folder, options_of
from muster.planning.exporting import exported
from muster.verification.required import require_admissible
from muster_control.work.missions import mission_of, plan_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan", "ignore", "to", "options"}` -> `{"files": {name: base64}, "messages"}`.

    `to` is one of FORMATS, or `json`: the plan's own file. `options` are those of the format in `ExportOptions`;
    `altitudes` may be texts, as `altitudes_in` reads them.
    """
    form, options = arguments["to"], arguments.get("options") or {}
    if form not in (*FORMATS, "json"):
        raise ParameterError(
            f"to: {shown(form)}; expected {', '.join((*FORMATS, 'json'))}{did_you_mean(form, FORMATS)}"
        )
    chosen = _options(form, options)
    mission, plan = mission_of(arguments["mission"]), plan_of(arguments["plan"])
    if form == "json":
        return _answer({f"{_stem(mission.name)}.json": plan.text().encode("utf-8")})
    verdict = require_admissible(mission, plan, "plan", arguments.get("ignore", ()))
    files = exported(mission, verdict, form, chosen, plan)
    if makes_folder(form, chosen):
        return _answer(files.encoded, files.messages)
    stem = _stem(mission.name)
    alone = {f"plan.{form}": f"{stem}.{form}", f"{form}.pdf": f"{stem}-{form}.pdf"}  # they bear the mission's name
    return _answer({alone.get(name, name): data for name, data in files.encoded.items()}, files.messages)


def _answer(contents: Mapping[str, bytes], messages: tuple[str, ...] = ()) -> dict[str, Any]:
    files = {name: base64.b64encode(content).decode("ascii") for name, content in contents.items()}
    return {"files": files, "messages": list(messages)}


def _options(form: str, options: Mapping[str, Any]) -> ExportOptions:
    """The options, checked as the command checks them."""
    known = options_of(form) if form in FORMATS else ()
    if options and not known:
        raise ParameterError(f"options: {shown(options)}; expected none with {form}")
    for name in options:
        if name not in known:
            raise ParameterError(f"options: {shown(name)}; expected {', '.join(known)}{did_you_mean(name, known)}")
    given = {name: value for name, value in options.items() if value is not None}
    if isinstance(given.get("altitudes"), list | tuple):
        given["altitudes"] = altitudes_in(given["altitudes"])
    return ExportOptions(**given)


def _stem(name: str) -> str:
    """A mission's name, where files can be called so."""
    plain = "".join(c if c.isalnum() or c in "_-." else "_" for c in PurePath(name).name)
    return plain.lstrip(".")[:100] or "plan"
