"""`muster check --server`: tasks that can never be done, found there, told here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from muster.cli.check import checked, refused
from muster.cli.options import MissionFile
from muster.cli.remote.uploads import parcel
from muster.mission.errors import Finding, MissionError
from muster.planning.explaining import Possible

if TYPE_CHECKING:
    from muster.client import Client


def run(
    control: Client,
    *,
    mission: MissionFile,
    ignore: tuple[str, ...],
    form: str,
    require_complete: bool,
    time_limit: float,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission, and tell what is wrong with it."""
    try:
        loaded = mission.load(verbose=verbose)
        found = control.missions.check(*parcel(loaded), ignore=ignore, time_limit=time_limit)
        if found["errors"]:
            raise MissionError([Finding(**error) for error in found["errors"]])
    except MissionError as error:
        return refused(form, error)
    return checked(form, loaded, Possible.from_dict(found), require_complete=require_complete)
