"""The task that converts files of other programs to missions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import Ledger, summary_lines
from muster.mission.model import Mission
from muster.mission.value_types import shown
from muster.mission.yaml_writer import YAML_SUFFIXES, yaml_text
from muster.planning.loading import load_noted
from muster.planning.mission_readers import converted_suffixes
from muster_control.work.missions import written_files
from muster_files.importing import is_site_file, read_site
from muster_files.sites.readers import READERS

_MISSIONS = (*YAML_SUFFIXES, *converted_suffixes())
_ANSWERS = ("kinds", "height_m", "fov_deg", "width_m")
"""What a user says of a site, as `read_site` has it."""
_OPTIONS = ("robots", "suitability", "salesmen", "depot")


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"name", "files", ...}` -> `{"text", "name", "needs", "notes", "ledger"}`: a mission as YAML and what it names.

    `name` is which of `files` (base64, by name) is the mission: a task-list CSV or a file of a site, perhaps with
    `robots` and `suitability`, which name others of them, and all other files of a site are added; an instance file,
    perhaps with `salesmen` and `depot`, of which TSPLIB needs the first; a `.plan` of QGroundControl, of which all
    `.plan` files are taken together; a mission in YAML, to which the files named by `site` are added. `kinds`,
    `height_m`, `fov_deg` and `width_m` are what a user says of a site, as `read_site` has it. `notes` are what was read
    from files of a site, what was chosen, and what was not read; `ledger` has the fate of every element.
    """
    name, files = arguments["name"], arguments["files"]
    options = {key: arguments[key] for key in _OPTIONS if arguments.get(key) is not None}
    for key in (name, *(options[key] for key in ("robots", "suitability") if key in options)):
        if key not in files or "/" in key:
            raise MissionError([Finding(shown(key), None, "", "no such file", "one of the files that were given")])
    path = Path(name)
    suffixes = (*(f".{name}" for name in READERS), *_MISSIONS)
    if path.suffix.lower() not in suffixes:
        raise MissionError([Finding(shown(name), None, "", "not known", f"a file in {', '.join(suffixes)}")])
    written_files(files)
    site = arguments.get("site", ())
    others = [one for one in site or _others_of_site(name, files) if one not in options.values()]
    if site or others or is_site_file(path):
        beside: dict[str, Any] = {key: options[key] for key in ("robots", "suitability") if key in options}
        beside |= {key: arguments[key] for key in _ANSWERS if arguments.get(key) is not None}
        found = read_site(name, *others, **beside)
        kept = sorted(set(files) - {name, *others, *options.values()}) if site else []
        return _answer(found.mission, kept, (*found.counts, *found.notes, *summary_lines(found.ledger)), found.ledger)
    noted = load_noted(_folder_of_plans(files) if path.suffix.lower() == ".plan" else path, **options)
    needs = sorted(set((noted.mission.travel or {}).values()))
    return _answer(noted.mission, needs, noted.said, noted.ledger)


def _answer(mission: Mission, needs: Sequence[str], notes: Sequence[str], ledger: Ledger) -> dict[str, Any]:
    told = {"needs": needs, "notes": notes, "ledger": ledger.as_dict()}
    return {"text": yaml_text(mission), "name": mission.name, **told}


def _others_of_site(name: str, files: Mapping[str, str]) -> list[str]:
    """The other files of a site, where the mission is one of a site."""
    of_site = [one for one in files if Path(one).suffix.lower().lstrip(".") in READERS]
    return [one for one in of_site if one != name] if name in of_site else []


def _folder_of_plans(files: Mapping[str, str]) -> Path:
    """The one plan that was given; or where they all are."""
    plans = [name for name in files if name.lower().endswith(".plan")]
    return Path(plans[0]) if len(plans) == 1 else Path()
