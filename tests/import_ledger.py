"""`python -m tests.import_ledger`: whether the ledger of each site, plan and instance of the repository is complete.

For each file the elements that were read, passed over and refused must be as many as another program counts in it. A
file that is refused is refused as a whole.
"""

import sys
import tempfile
from pathlib import Path

from muster.mission.errors import MusterError
from muster.planning.loading import load_noted
from muster_files.importing import read_site
from tests.raw_counts import raw_count

ROOT = Path(__file__).parent.parent
SITES = (".geojson", ".kml", ".kmz", ".wpml", ".gpx", ".gpkg", ".xlsx", ".csv")
INSTANCES = (".tsp", ".atsp", ".vrp")
FOLDERS = (
    "examples",
    "tests/data",
    "tests/mission/broken",
    "src/muster/library/tsplib",
    "src/muster_studies/instances",
)
ROBOTS = "id,lat,lon,kind\nr_0,47.3768,8.5416,air\n"


def files(folders=FOLDERS):
    """All sites, plans and instance files of the repository."""
    for folder in folders:
        kinds = (*SITES, *INSTANCES, ".plan", ".waypoints") + ((".csv",) if folder != "tests/mission/broken" else ())
        for path in sorted((ROOT / folder).rglob("*")):
            if (path.suffix in kinds and "robots" not in path.name) or is_instance(path):
                yield path


def is_instance(path):
    return path.suffix == ".txt" and "instances" in path.parts[-2] and path.stat().st_size > 200


def ledger_of(path, robots):
    """The ledger of a file, with the robots that a site lacks; None, with the reason, where the file is refused."""
    try:
        if path.suffix in SITES:
            return read_with_robots(path, robots), ""
        salesmen = 2 if path.suffix in (".tsp", ".atsp") else None
        return load_noted(path, salesmen=salesmen).ledger, ""
    except MusterError as error:
        return None, str(error).splitlines()[0]


def read_with_robots(path, robots):
    """The ledger of a site with the first robots that go with it: its own, those beside it, or any."""
    beside = [file for name in ("robots.csv", "team.yaml", "fleet.yaml") if (file := path.parent / name).exists()]
    for team in (*beside, robots):
        try:
            return read_site(path, robots=team).ledger
        except MusterError:
            continue
    return read_site(path).ledger


def row_of(path, robots):
    """The counts of one file: by another program, and the three of the ledger."""
    ledger, why = ledger_of(path, robots)
    try:
        raw = raw_count(path)
    except Exception as error:  # a file that no program reads has nothing to count, and must be refused
        return (0, 0, 0, 0, why) if ledger is None else (-1, 0, 0, 0, f"not counted: {error}")
    if ledger is None:
        return raw, 0, 0, raw, why
    of_file = [ledger.count(how, str(path)) for how in ("read", "passed over", "refused")]
    return (raw, *of_file, "")


def say(line):
    sys.stdout.write(f"{line}\n")


def main(folders=FOLDERS):
    """Print the counts of all files; returns 1 if any differ."""
    wrong = count = 0
    with tempfile.TemporaryDirectory() as folder:
        robots = Path(folder) / "robots.csv"
        robots.write_text(ROBOTS, encoding="utf-8")
        say(f"{'counted':>8} {'read':>8} {'passed':>8} {'refused':>8}  file")
        for path in files(folders):
            raw, read, passed, refused, why = row_of(path, robots)
            equal = raw == read + passed + refused
            wrong, count = wrong + (not equal), count + 1
            told = f"  refused: {why.replace(str(ROOT) + '/', '')[:90]}" if why else ""
            mark = "" if equal else "  DIFFERS"
            say(f"{raw:>8} {read:>8} {passed:>8} {refused:>8}  {path.relative_to(ROOT)}{mark}{told}")
    say(f"{count} files, {wrong} differ")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
