"""The origin of a site's map frame, and its entries as far as they are near it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import Finding
from muster.mission.value_types import shown
from muster_files.sites.entries import Entry
from muster_files.sites.far_places import MAY_BE_FAR, degrees_of, without_far
from muster_files.sites.features import Coordinate
from muster_files.sites.frame import FARTHEST_M, Frame


@dataclass
class SiteOrigin:
    """The frame of a site; None where nothing is in degrees.

    Parameters
    ----------
    entries
        those of the site, without what is far away and not needed there.
    chosen
        the origin as mission files have it, where the mission has none yet.
    """

    frame: Frame | None
    entries: list[Entry]
    chosen: dict[str, Any] | None = None
    findings: list[Finding] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def choose_origin(
    entries: Sequence[Entry], base: Mapping[str, Any], stated: Sequence[float] | None, *, flat: bool
) -> SiteOrigin:
    """Return the origin of the mission that is there, the one that a user states, or the middle of the site."""
    found = SiteOrigin(None, list(entries))
    given = base.get("origin_wgs84")
    is_middle = False
    if given is not None:
        if stated is not None:
            told = "none beside origin_wgs84 of the mission that is there"
            found.findings.append(Finding("--origin", None, "", shown(list(stated)), told))
        found.frame = Frame(given["lat_deg"], given["lon_deg"], given.get("alt_m", 0.0))
    elif stated is not None:
        found.frame = Frame(stated[0], stated[1], stated[2] if len(stated) > 2 else 0.0)
    else:
        is_middle = _choose_middle(found, has_base=bool(base), flat=flat)
    if found.frame is None:
        return found
    if given is None:
        found.chosen = {"lat_deg": found.frame.lat, "lon_deg": found.frame.lon, "alt_m": found.frame.alt}
    found.entries = without_far(entries, found.frame, found.findings, found.notes)
    _refuse_far(found, is_middle=is_middle)
    return found


def _choose_middle(found: SiteOrigin, *, has_base: bool, flat: bool) -> bool:
    """Choose the middle of all places, as far as there are any in degrees and none in metres beside them."""
    in_degrees = [entry for entry in found.entries if any(True for _ in degrees_of(entry))]
    in_metres = next((entry for entry in found.entries if entry.metres is not None), None)
    if not in_degrees:
        return False
    if in_metres is not None or has_base:
        expected = "--origin LAT,LON, the place of [0, 0] on Earth, as others are in metres"
        where = "" if in_metres is None else f" ({in_metres.feature.file})"
        found.findings.append(in_degrees[0].feature.finding("", "a place in degrees", expected + where))
        return False
    altitudes = [e.height for e in found.entries if e.height is not None and not e.over_ground and not flat]
    frame = Frame.around(list(_places(in_degrees)), altitudes)
    needed = [entry for entry in in_degrees if entry.role not in MAY_BE_FAR]
    if needed and any(map(frame.is_far, _places(in_degrees))):
        frame = Frame.around(list(_places(needed)), altitudes)
    found.frame = frame
    found.notes.append(
        f"origin_wgs84 chosen: lat_deg {frame.lat}, lon_deg {frame.lon}, alt_m {frame.alt}; --origin says another"
    )
    return True


def _places(entries: Iterable[Entry]) -> Iterable[Coordinate]:
    return (place for entry in entries for place in degrees_of(entry))


def _refuse_far(found: SiteOrigin, *, is_middle: bool) -> None:
    """Refuse places that cannot be meant: the first that is far from a given origin, or that far from most others.

    An origin in the middle is far from all places, where one of them is wrong.
    """
    frame = found.frame
    assert frame is not None
    needed = [entry for entry in found.entries if entry.role not in MAY_BE_FAR]
    far = next(((entry, place) for entry in needed for place in degrees_of(entry) if frame.is_far(place)), None)
    if far is None or found.findings:
        return
    limit = f"{FARTHEST_M / 1000:g} km"
    if not is_middle:
        told = f"within {limit} of the origin, not {frame.distance(far[1]) / 1000:,.0f}"
    else:
        places = [(entry, place) for entry in needed for place in degrees_of(entry)]
        most = Frame.amid([place for _, place in places])
        far = max(places, key=lambda one: most.distance(one[1]))
        origin = f"the origin, which is chosen in the middle of all places: latitude {frame.lat}, longitude {frame.lon}"
        told = f"within {limit} of {origin}; this place is {most.distance(far[1]) / 1000:,.0f} km from most others"
    entry, place = far
    value = f"latitude {place[1]:g}, longitude {place[0]:g}"
    found.findings.append(entry.feature.finding("", value, f"{told}; are latitude and longitude swapped, or 0?"))
