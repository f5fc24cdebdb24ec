"""Flights in DJI's layout of KML (WPML 1.0, `waylines.wpml` or `template.kml`) as layers: way points with their hovers.

Heights are over the take-off, over the ground, or absolute, as the file says. A hover is the task's duration. Speeds
stand in a note, since robots say how fast they are.

Source: DJI Cloud API, "WPML".
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from muster.mission.import_ledger import Fate, Source, passed_over
from muster.mission.reading.csv_files import number
from muster_files.sites.features import HEIGHT, Feature, Geometry, Layer, layer_of, refused
from muster_files.sites.kml_reader import Placemark
from muster_files.sites.xml_elements import Element, XmlDocument

_RELATIVE = "relativeToStartPoint"
_MODES = {_RELATIVE: True, "aboveGroundLevel": True, "WGS84": False, "EGM96": False}
"""Whether heights of a mode are over the start or the ground, and not absolute."""
_CAMERA = passed_over("is for a camera or a gimbal: Muster has actions for that")
_SPEED = passed_over("is a speed: robots say how fast they are (speed_mps)", noted=True)
_FLIGHT = passed_over("is how DJI's autopilot flies: Muster plans ways, turns and ends anew")
_REASONS: dict[str, Fate] = {
    **dict.fromkeys(("autoFlightSpeed", "waypointSpeed", "globalTransitionalSpeed"), _SPEED),
    **dict.fromkeys(("useGlobalSpeed", "maxSpeed"), _SPEED),
    **dict.fromkeys(("payloadParam", "payloadInfo", "waypointGimbalHeadingParam", "waypointGimbalPitchAngle"), _CAMERA),
    **dict.fromkeys(("missionConfig", "waypointHeadingParam", "waypointTurnParam", "globalWaypointTurnMode"), _FLIGHT),
    **dict.fromkeys(("globalWaypointHeadingParam", "useStraightLine", "globalUseStraightLine", "distance"), _FLIGHT),
    **dict.fromkeys(("templateType", "templateId", "waylineId", "duration", "createTime", "updateTime"), _FLIGHT),
    "startActionGroup": passed_over("is done before the first way point"),
    **dict.fromkeys(("useGlobalHeadingParam", "useGlobalTurnParam", "gimbalPitchMode", "isRisky"), _FLIGHT),
}
_CAMERA_ACTIONS = (
    *("takePhoto", "startRecord", "stopRecord", "focus", "zoom", "customDirName", "gimbalRotate", "gimbalEvenlyRotate"),
    *("orientedShoot", "panoShot", "accurateShoot", "recordPointCloud", "setFocusType", "targetDetection"),
    "rotateYaw",
)
_SPEEDS = ("autoFlightSpeed", "waypointSpeed")


def is_wpml(root: Element) -> bool:
    """Whether a KML file is a flight in DJI's layout."""
    return any(element.name in ("missionConfig", "executeHeight") for element in root.within())


def wpml_layers(root: Element, file: str, others: Sequence[str]) -> list[Layer]:
    """The folders of a flight, one layer each.

    Raises
    ------
    MissionError
        for heights of a mode that is not known, a way point without a height, and actions that move the drone.
    """
    document = XmlDocument(root.take(), others)
    for element in root.within():
        if element.name in _REASONS:
            element.take(_REASONS[element.name])
    notes = []
    told = {number(e.text.strip()) for e in root.within() if e.name in _SPEEDS}
    speeds = [f"{speed:g}" for speed in sorted(value for value in told if isinstance(value, float))]
    if speeds:
        notes.append(f"its drone flies at {' and '.join(speeds)} m/s: robots say how fast they are (speed_mps)")
    folders: dict[str, list[Feature]] = {}
    modes: dict[int, bool] = {}
    for folder, name, mark in _marks(root):
        if id(folder) not in modes:
            modes[id(folder)] = _is_over_start(folder, file, notes)
        feature = _WayPoint(mark, folder, name, file).feature(over_ground=modes[id(folder)])
        folders.setdefault(name, []).append(feature)
    layers = [layer_of(file, name, features, document) for name, features in folders.items()]
    first = Layer(file, "", (), (), notes=tuple(dict.fromkeys(notes)), document=document)
    return [*layers, first]


def _marks(root: Element) -> Iterator[tuple[Element, str, Element]]:
    """All way points, with the folder in which each is, and its name."""
    for folder in root.within():
        if folder.name in ("kml", "Document", "Folder"):
            name = " ".join(folder.take().told("name").split())
            yield from ((folder, name, mark) for mark in folder.all("Placemark"))


def _is_over_start(folder: Element, file: str, notes: list[str]) -> bool:
    """Whether heights of a folder are over the take-off or the ground."""
    found = folder.first("executeHeightMode") or folder.first("waylineCoordinateSysParam", "heightMode")
    if found is None:
        notes.append(f"it does not say what its heights are over: {_RELATIVE} is taken")
        return True
    mode = found.text.strip()
    if mode not in _MODES:
        raise refused(file, found.line, found.name, mode or "missing", " or ".join(_MODES))
    if mode == "EGM96":
        notes.append("heights over sea level (EGM96) are taken as those of KML are, without the geoid")
    return _MODES[mode]


class _WayPoint:
    """Reads one way point."""

    def __init__(self, mark: Element, folder: Element, name: str, file: str) -> None:
        self._mark, self._folder, self._file = mark, folder, file
        self._name = name
        self._source = mark.whole = Source()

    def feature(self, *, over_ground: bool) -> Feature:
        point = self._mark.first("Point")
        if point is None:
            raise refused(
                self._file, self._mark.line, "Placemark", "no <Point>", "a way point; draw areas as plain KML"
            )
        place = Placemark(self._mark, self._name, self._file).point(point)
        index = self._mark.told("index")
        where = ", ".join(part for part in (self._name, f"way point {index}" if index else "") if part)
        values: dict[str, object] = {}
        if hover := self._hover(where):
            values["duration_s"] = hover
        geometry = Geometry("point", ((((*place[:2], self._height(where)),),),), over_ground)
        self._source.needs_height = True
        return Feature(values, self._file, self._mark.line, where, geometry, self._source)

    def _height(self, where: str) -> float:
        """The height of a way point: its own, or that of all."""
        own = next((e for n in ("executeHeight", "height", "ellipsoidHeight") if (e := self._mark.first(n))), None)
        uses_global = self._mark.told("useGlobalHeight") == "1"
        found = self._folder.first("globalHeight") if own is None or uses_global else own
        if found is None:
            raise refused(self._file, self._mark.line, _at(where, "executeHeight"), "missing", "metres")
        number = self._number(found, where)
        if found is own:
            found.value = self._source, HEIGHT
        return number

    def _number(self, element: Element, where: str, *, least: float = -1e5) -> float:
        try:
            number = float(element.text)
        except ValueError:
            number = float("nan")
        if not least <= number <= 1e5:
            at = _at(where, element.name)
            raise refused(self._file, element.line, at, element.text.strip() or "missing", "a number")
        return number

    def _hover(self, where: str) -> float:
        """The seconds that the drone hovers; actions that move it are refused."""
        seconds = 0.0
        for group in self._mark.all("actionGroup"):
            trigger = group.told("actionTrigger", "actionTriggerType")
            one_point = group.told("actionGroupStartIndex") == group.told("actionGroupEndIndex")
            for action in group.all("action"):
                func = action.told("actionActuatorFunc")
                if func in _CAMERA_ACTIONS:
                    action.fate = _CAMERA
                elif func != "hover":
                    expected = "hover, or an action of cameras and gimbals"
                    raise refused(
                        self._file, action.line, _at(where, "actionActuatorFunc"), func or "missing", expected
                    )
                elif trigger not in ("", "reachPoint") or not one_point:
                    told = trigger if one_point else "hover at several way points"
                    raise refused(
                        self._file,
                        action.line,
                        _at(where, "hover"),
                        told,
                        "a hover at one way point, when it is reached",
                    )
                else:
                    seconds += self._hover_time(action, where)
        return seconds

    def _hover_time(self, action: Element, where: str) -> float:
        time = action.first("actionActuatorFuncParam", "hoverTime")
        if time is None:
            raise refused(self._file, action.line, _at(where, "hoverTime"), "missing", "seconds")
        time.value = self._source, "duration_s"
        return self._number(time, where, least=0.0)


def _at(where: str, field: str) -> str:
    return f"{where}, {field}" if where else field
