"""Files of KML: plain (.kml), in an archive (.kmz), and in the layout of DJI's flights (.wpml, .kmz with `wpmz/`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from muster_files.sites.features import Layer, refused
from muster_files.sites.file_sizes import MOST_VALUES, open_archive, read_bytes, require_few, unpacked
from muster_files.sites.kml_reader import kml_layers
from muster_files.sites.wpml_reader import is_wpml, wpml_layers
from muster_files.sites.xml_elements import parse_xml

_WHAT = "KML"
_KMZ = "KMZ: a ZIP archive with a .kml in it"
_FIRST = ("waylines.wpml", "doc.kml")
"""The names that are looked for before any other `.kml`; the template beside way lines says the same less exactly."""


def read_kml_layers(path: Path) -> Sequence[Layer]:
    """The folders of a KML or WPML file; raises MissionError with the line at which it is none."""
    return _layers(read_bytes(path), str(path))


def read_kmz_layers(path: Path) -> Sequence[Layer]:
    """The folders of the first KML file in an archive; raises MissionError where there is none."""
    with open_archive(path, _KMZ) as archive:
        members = archive.namelist()
        names = [name for first in _FIRST for name in members if name.lower().rpartition("/")[2] == first]
        names += [name for name in members if name.lower().endswith(".kml")]
        if not names:
            raise refused(str(path), None, "", "no .kml in it", _KMZ)
        others = [name for name in members if name != names[0]]
        return _layers(unpacked(archive, names[0], path, _KMZ), str(path), others)


def _layers(data: bytes, file: str, others: Sequence[str] = ()) -> list[Layer]:
    require_few(data.count(b","), "values", file, most=MOST_VALUES)
    root = parse_xml(data, file, "kml", _WHAT)
    return wpml_layers(root, file, others) if is_wpml(root) else kml_layers(root, file, others)
