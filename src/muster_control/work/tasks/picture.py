"""The task that draws a plan."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster.report import plot_gantt, plot_routes, save_figure
from muster.verification import verify
from muster_control.work.missions import mission_of, plan_of

_KINDS, _FORMATS = ("routes", "gantt"), ("png", "svg", "pdf")


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan", "ignore", "objective", "what", "format"}` -> `{"data": base64}`.

    what: routes, gantt; format: png, svg, pdf.
    """
    what, form = arguments["what"], arguments["format"]
    for name, value, known in (("what", what, _KINDS), ("format", form, _FORMATS)):
        if value not in known:
            raise ParameterError(f"{name}: {shown(value)}; expected {' or '.join(known)}")
    mission, plan = mission_of(arguments["mission"]), plan_of(arguments["plan"])
    verdict = verify(mission, plan, arguments.get("ignore", ()), arguments.get("objective"))
    axes = plot_routes(mission, plan, verdict) if what == "routes" else plot_gantt(mission, verdict)
    file = Path(f"picture.{form}")
    save_figure(axes, file)
    return {"data": base64.b64encode(file.read_bytes()).decode("ascii")}
