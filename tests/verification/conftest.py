"""Maps are judged only where the extra that reads them is installed."""

from importlib.util import find_spec

if not all(find_spec(name) for name in ("PIL", "scipy", "shapely")):
    collect_ignore = ["test_map_travel.py", "test_map_paths.py"]
