"""Text in a film: the mission's name and clock, the latest events, names of robots and tasks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from muster.motion.grid import Floats
from muster.state import ExecutionEvent
from muster.state.reasons import is_no_loss
from muster.state.words import DETAIL

Picture = npt.NDArray[np.uint8]
Rgb = tuple[int, int, int]

INK: Rgb = (34, 34, 34)
QUIET_INK: Rgb = (95, 99, 105)
_NOT_TOLD = (
    *("sets_out", "arrives", "starts", "robot_at_end", "mission_ended"),
    *("goes_to_station", "arrives_at_station", "service_begins"),
    *("waits_in_traffic", "goes_on", "robot_stands_aside", "robot_goes_round", "robot_makes_room"),
)
_LONGEST = 64


def caption(told: ExecutionEvent) -> str | None:
    """An event in a few words, such as `r_0 has done task 7`; None for events that are visible in the film."""
    if told.kind in _NOT_TOLD or told.mark == DETAIL or is_no_loss(told.data.get("reason")):
        return None
    if told.kind == "replanned":
        moved, dropped = len(told.data.get("moved", ())), len(told.data.get("dropped", ()))
        given_up = f", {dropped} given up" if dropped else ""
        return f"planned anew: {moved or 'no'} task{'' if moved == 1 else 's'} moved{given_up}"
    return shortened(told.line)


def shortened(text: str, longest: int = _LONGEST) -> str:
    """Cut text that would reach beyond the picture."""
    return text if len(text) <= longest else text[: longest - 1] + "…"


def clock(seconds: float) -> str:
    """Minutes and seconds, such as `2:05`; hours where there are any."""
    whole = int(seconds + 1e-6)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"


def write(
    picture: Picture,
    text: str,
    place: tuple[float, float],
    size: int,
    *,
    color: Rgb = INK,
    weight: int = 400,
    align: float = 0.0,
    halo: bool = False,
) -> int:
    """Write into a picture; returns how wide the text is, in pixels.

    Parameters
    ----------
    place
        of the text's lower edge in pixels, and of its left one or, with `align` 0.5 or 1, of its middle or right one.
    halo
        in white around it, which parts it from what is behind.
    """
    wide = text_width(text, size, weight)
    x, y = round(place[0] - align * wide), round(place[1])
    if halo:
        for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            cv2.putText(picture, text, (x + dx, y + dy), (250, 250, 250), _font(), size, weight)
    cv2.putText(picture, text, (x, y), color, _font(), size, weight)
    return wide


def text_width(text: str, size: int, weight: int) -> int:
    """In pixels."""
    box = cv2.getTextSize((4000, 200), text, (0, 100), _font(), size, weight)
    return int(box[2])


def write_names(picture: Picture, names: Iterable[tuple[str, Rgb]], places: Floats, size: int, weight: int) -> None:
    """Write names beneath places (n, 2) of the picture; places of absent robots are NaN."""
    for (name, color), (x, y) in zip(names, places, strict=True):
        if np.isfinite((x, y)).all():
            write(picture, shortened(name, 24), (x, y), size, color=color, weight=weight, align=0.5, halo=True)


def write_events(picture: Picture, events: Sequence[tuple[str, Rgb, float]], right: int, top: int) -> None:
    """Write the latest events, the newest topmost; each with a dot in its colour and how plain it is, 0 to 1."""
    for k, (text, color, plain) in enumerate(reversed(events)):
        y = top + 18 * k
        before = picture[y - 16 : y + 8].copy()
        wide = write(picture, text, (right - 14, y), 14, align=1.0, halo=True)
        cv2.circle(picture, (right - 4, y - 5), 4, color, -1, cv2.LINE_AA)
        if plain < 1 and wide:
            now = picture[y - 16 : y + 8]
            np.copyto(now, cv2.addWeighted(now, plain, before, 1 - plain, 0.0))


def rgb(color: str) -> Rgb:
    """The colour of "#rrggbb"."""
    red, green, blue = (int(color[k : k + 2], 16) for k in (1, 3, 5))
    return red, green, blue


@cache
def _font() -> Any:
    """OpenCV's own sans-serif, with most scripts."""
    return cv2.FontFace("sans")
