"""Robots behind an HTTP server, as a fleet of Muster."""

import json
from urllib.request import Request, urlopen

from muster.mission.records import record, spec
from muster.mission.value_types import Number, Text
from muster.running.fleet_type import FleetType
from muster_robots.custody_settings import CustodySettings
from muster_robots.goal_fleet import GoalFleet, RobotPose


@record
class HttpSettings(CustodySettings):
    """How the server of the robots is reached."""

    url: str = spec(Text(), "address of the server, such as http://10.0.0.2:8000")
    wait_s: float = spec(Number(minimum=0), "how long the robots of the mission are waited for", default=5.0)


class HttpLink:
    def __init__(self, url):
        self.url = url

    def poses(self):
        return {robot: RobotPose(**said) for robot, said in self.ask("robots").items()}

    def go(self, robot, to):
        x, y, _ = to.position
        self.ask(f"robots/{robot}/goal", {"x": x, "y": y, "heading": to.heading})

    def stop(self, robot):
        self.ask(f"robots/{robot}/stop", {})

    def ask(self, path, data=None):
        body = None if data is None else json.dumps(data).encode()
        with urlopen(Request(f"{self.url}/{path}", body), timeout=0.5) as answer:
            return json.load(answer)


def open_http(mission, settings, halt, again):
    link = HttpLink(settings.url)
    return GoalFleet.ready(mission, link, halt, wait_s=settings.wait_s, custody=settings), lambda: None


HTTP = FleetType(
    name="http-robots",
    open=open_http,
    abilities=("ground", "holds", "returns", "resumes", "battery"),
    settings=HttpSettings,
    claims=lambda settings: [f"the server {settings.url}"],
)
