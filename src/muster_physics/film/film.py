"""A film of a run: oblique from above, faster than real time, with a clock and the latest events."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from muster.mission.errors import ParameterError
from muster.report.figures.styles import ALARM, LEFT_OUT, robot_style
from muster.state import ExecutionEvent
from muster.state.mission_state import DONE
from muster_physics.film.captions import (
    QUIET_INK,
    Picture,
    Rgb,
    caption,
    clock,
    rgb,
    shortened,
    write,
    write_events,
)
from muster_physics.film.files import film_file
from muster_physics.film.footage import Footage
from muster_physics.film.scenery import FilmScene

LONGEST_S = 24.0
"""Of a film whose speed is not said."""
SPEEDS = (1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 100)
_REST_S = 1.5
"""For which the last picture stays."""
_MOST_EVENTS, _SHOWN_S, _FADES_S = 3, 4.0, 0.6
_EDGE = 20


@dataclass(frozen=True)
class FilmSummary:
    """A film that was written: the number of pictures, its length in seconds, and its speed-up."""

    frames: int
    duration_s: float
    speed: float


def write_film(path: str | Path, footage: Footage, *, speed: float | None = None) -> FilmSummary:
    """Draw a film and write it as its file's ending says: .mp4 or .gif.

    If it is interrupted, the file is a whole film all the same, up to then.

    Parameters
    ----------
    speed
        how many times as fast as it was; None: so that it takes at most 24 s.

    Raises
    ------
    InputError
        if the ending is another, or the file cannot be written.
    ParameterError
        if the speed is not above 0, or there was no physics world.
    RenderingError
        if nothing draws here.
    MissingExtraError
        if a GIF is wanted and Pillow is not installed.
    """
    if speed is not None and not 0 < speed < float("inf"):
        raise ParameterError(f"speed: {speed}; expected a finite number above 0")
    kind = film_file(path)
    duration_s = float(footage.times_s[-1])
    chosen = speed_for(duration_s) if speed is None else speed
    count = 0
    with FilmScene(footage, *kind.size) as scene, closing(kind(path)) as file:
        for picture in _pictures(scene, footage, chosen, kind.rate_hz):
            file.add(picture)
            count += 1
    return FilmSummary(count, count / kind.rate_hz, chosen)


def speed_for(duration_s: float) -> float:
    """The least round speed-up at which a run takes at most `LONGEST_S`."""
    least = duration_s / LONGEST_S
    return float(next((speed for speed in SPEEDS if speed >= least), -(-least // 100) * 100))


def _pictures(scene: FilmScene, footage: Footage, speed: float, rate_hz: float) -> Iterator[Picture]:
    end_s, step_s = scene.moments.end_s, speed / rate_hz
    last = -int(-end_s / step_s // 1)  # the first picture at or after the end
    for k in range(last + 1):
        now = min(k * step_s, end_s)
        picture = scene.picture(now)
        _write_upon(picture, scene, footage, now, speed)
        yield picture
    for _ in range(round(_REST_S * rate_hz)):
        yield picture


def _write_upon(picture: Picture, scene: FilmScene, footage: Footage, now: float, speed: float) -> None:
    moments, width = scene.moments, picture.shape[1]
    wide = write(picture, clock(now), (_EDGE, 40), 28, weight=600)
    states = list(moments.mission_state.stages.values())
    facts = f"{states.count(DONE)} of {len(states)} tasks done"
    write(picture, shortened(footage.mission.name, 48), (_EDGE + wide + 16, 28), 17, weight=600)
    write(picture, f"{facts}  ·  {speed:g} x", (_EDGE + wide + 16, 48), 14, color=QUIET_INK)
    latest = [(told, now - told.time_s) for told in moments.told[-40:]]
    shown = [(words, _color(told, scene), _plain(age / speed)) for told, age in latest if (words := caption(told))]
    write_events(picture, [one for one in shown if one[2] > 0][-_MOST_EVENTS:], width - _EDGE, 26)


def _plain(age_s: float) -> float:
    """The opacity of an event's text, by its age in seconds of the film."""
    return min(1.0, max(0.0, (_SHOWN_S - age_s) / _FADES_S))


def _color(told: ExecutionEvent, scene: FilmScene) -> Rgb:
    robots = list(scene.moments.mission_state.robots)
    if told.alarming:
        return rgb(ALARM)
    name = told.data.get("robot")
    return rgb(robot_style(robots.index(name)).color if name in robots else LEFT_OUT)
