"""What a robot will do after what it does now, as far as that is known."""

from __future__ import annotations

from typing import NamedTuple

from muster.motion.port import Place


class Visit(NamedTuple):
    """A place, and seconds for which a robot stays there."""

    at: Place
    hold_s: float


class Outlook(NamedTuple):
    """Where a robot will go after where it has been sent.

    `stays`: whether it stays for good at the last of all; `gone`: whether it is not to be sent anywhere now, as it has
    failed or is not heard; `removed`: whether it was taken away, and is nowhere.
    """

    visits: tuple[Visit, ...] = ()
    stays: bool = False
    gone: bool = False
    removed: bool = False
