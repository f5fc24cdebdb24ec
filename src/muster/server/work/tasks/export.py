"""The task that exports a plan to other programs."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import PurePath
from typing import Any

from muster.exchange.export_request import FORMATS, QgcOptions
from muster.exchange.files import exported
from muster.mission.errors import ParameterError
from muster.mission.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.server.work.missions import mission_of, plan_of
from muster.verification.required import require_admissible


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan", "ignore", "to", "options"}` -> `{"files": {name: base64}, "messages"}`.

    `to` is one of FORMATS, or `json`: the plan's own file. `options` are those of `QgcOptions`, for qgc.
    """
    form, options = arguments["to"], arguments.get("options") or {}
    if form not in (*FORMATS, "json"):
        raise ParameterError(
            f"to: {shown(form)}; expected {', '.join((*FORMATS, 'json'))}{did_you_mean(form, FORMATS)}"
        )
    qgc = _qgc_options(options) if form == "qgc" else None
    if options and qgc is None:
        raise ParameterError(f"options: {shown(options)}; expected none with {form}")
    mission, plan = mission_of(arguments["mission"]), plan_of(arguments["plan"])
    if form == "json":
        return _answer({f"{_stem(mission.name)}.json": plan.text()})
    verdict = require_admissible(mission, plan, "plan", arguments.get("ignore", ()))
    files = exported(mission, verdict, form, qgc or QgcOptions())
    alone = f"plan.{form}"  # one file bears the mission's name
    stem = _stem(mission.name)
    texts = {f"{stem}.{form}" if name == alone else name: text for name, text in files.texts.items()}
    return _answer(texts, files.messages)


def _answer(texts: Mapping[str, str], messages: tuple[str, ...] = ()) -> dict[str, Any]:
    files = {name: base64.b64encode(text.encode("utf-8")).decode("ascii") for name, text in texts.items()}
    return {"files": files, "messages": list(messages)}


_RANGES = {"altitude": (0.0, 1e5), "clearance": (0.0, 1e5), "tolerance": (0.0, 1e3)}
_FIRMWARES = ("px4", "ardupilot")


def _qgc_options(options: Mapping[str, Any]) -> QgcOptions:
    """The options, checked as the command checks them."""
    known = [f.name for f in fields(QgcOptions)]
    for name, value in options.items():
        if name not in known:
            raise ParameterError(f"options: {shown(name)}; expected {', '.join(known)}{did_you_mean(name, known)}")
        if name == "firmware" and value not in _FIRMWARES:
            raise ParameterError(f"firmware: {shown(value)}; expected {' or '.join(_FIRMWARES)}")
        if name in _RANGES and value is not None:
            low, high = _RANGES[name]
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise ParameterError(f"{name}: {shown(value)}; expected metres, from {low:g} to {high:g}")
    return QgcOptions(**{name: value for name, value in options.items() if value is not None})


def _stem(name: str) -> str:
    """A mission's name, where files can be called so."""
    plain = "".join(c if c.isalnum() or c in "_-." else "_" for c in PurePath(name).name)
    return plain.lstrip(".")[:100] or "plan"
