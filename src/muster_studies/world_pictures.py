"""Views of the physics world, in place of screenshots of Gazebo."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING, Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.perception.optional_parts import require_physics
from muster.report.figures.canvas import new_figure
from muster.report.figures.styles import TEXT
from muster.running.simulation import Simulation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PIXELS = 960, 540
_WIDTH_IN, _HEIGHT_IN = 8.0, 4.9


def world_figure(mission: Mission, plan: Plan, title: str, ignored: tuple[str, ...] = (), at_s: float = 0.5) -> Figure:
    """Draw the physics world obliquely from above, so many seconds after the mission has begun.

    Raises
    ------
    MissingExtraError
        if matplotlib or the extra `physics` is not installed.
    RenderingError
        if nothing draws here.
    """
    require_physics("views of the physics world", "mujoco", "cv2")
    from muster_physics.film import Footage
    from muster_physics.film.scenery import FilmScene

    footage = Footage(mission)
    how: dict[str, Any] = {
        "world": "physics",
        "avoidance": "orca",
        "recorder": footage,
        "on_world": footage.on_world,
        "ignore": ignored,
    }
    with closing(Simulation(mission, plan, **how)) as simulation:
        while simulation.time_s < at_s and not simulation.done:  # each call ends with an event
            simulation.advance(at_s)
        with FilmScene(footage, *_PIXELS) as scene:
            picture = scene.picture(float(footage.times_s[-1])).copy()
    figure = new_figure(_WIDTH_IN, _HEIGHT_IN)
    ax = figure.subplots()
    ax.imshow(picture)
    ax.set_axis_off()
    ax.set_title(title, fontsize=11, fontweight="bold", color=TEXT, loc="left")
    return figure
