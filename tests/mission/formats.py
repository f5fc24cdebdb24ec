"""Files that the tests of the formats share."""

from pathlib import Path

from muster.library import mission_names, mission_path

FILE = Path("mission.yaml")
BROKEN = Path(__file__).parent / "broken"
SHIPPED = [name for name in mission_names() if mission_path(name).suffix == ".yaml"]
