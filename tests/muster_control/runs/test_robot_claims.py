"""Two runs never command the same real robots."""

import asyncio
import subprocess
import sys

import pytest
from tests.muster_control.runs.store import ADA, planned, settings_of

import muster
from muster.mission.errors import MusterError, ParameterError, PluginError
from muster.mission.records import Settings, record, spec
from muster.mission.value_types import Text
from muster.running.claim_locks import robots_claimed
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import FleetType, NoSettings
from muster.running.robot_claims import claims_as_far_as_known, claims_of
from muster_control.contract import ConflictError
from muster_control.services.runs import Runs

HERE, THERE = {"r_0": "udp:127.0.0.1:14550", "r_1": "udpout:10.0.0.2:14550"}, {"r_0": "udp:0.0.0.0:14550#2"}


def over(*endpoints):
    return "mavlink", {"endpoints": {f"r_{k}": endpoint for k, endpoint in enumerate(endpoints)}}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (over("udp:0.0.0.0:14550"), over("serial:/dev/ttyUSB0", "udpin:127.0.0.1:14550#2")),
        (over("udpout:drone:14550#1"), over("udpout:Drone:14550")),
        (over("serial:/dev/ttyUSB0:57600"), over("serial:/dev/../dev/ttyUSB0")),
        (("ros1", {}), ("ros1", {"master": "http://other:11311", "namespace": "/"})),
        (("ros2", {"namespace": "team"}), ("ros2", {"namespace": "/team/", "domain": 0})),
    ],
)
def test_the_same_robots_are_known_by_other_words(monkeypatch, one, other):
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert claims_of(*one) & claims_of(*other)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (over("udp:0.0.0.0:14550"), over("udp:0.0.0.0:14560")),
        (over("udpout:10.0.0.1:14550"), over("udpout:10.0.0.2:14550")),
        (("ros1", {"namespace": "a"}), ("ros1", {"namespace": "b"})),
        (("ros2", {}), ("ros2", {"domain": 7})),
        (("ros1", {}), ("ros2", {})),
        (("kinematic", {}), ("kinematic", {})),
    ],
)
def test_others_are_others(monkeypatch, one, other):
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert not claims_of(*one) & claims_of(*other)


@pytest.mark.long
def test_a_second_run_of_the_same_robots_is_refused_however_soon_it_is_asked_for(store):
    plan = planned(store, muster.load("6T-2R"))

    async def story():
        runs = Runs(store, settings_of(store, bridges=("mavlink", "ros1")))
        both = (runs.start(ADA, plan, "mavlink", settings={"endpoints": ends, "arm": True}) for ends in (HERE, THERE))
        run, at_once = await asyncio.gather(*both, return_exceptions=True)
        assert isinstance(at_once, ConflictError)
        words = f"run {run.id} commands robots on UDP port 14550; expected others, or that it is over"
        with pytest.raises(ConflictError, match=words):
            await runs.start(ADA, plan, "mavlink", settings={"endpoints": THERE, "arm": True})
        others = await runs.start(ADA, plan, "ros1", settings={"namespace": "team"})
        await runs.close()
        assert [one.id for one in store.runs.list()] == [others.id, run.id]

    asyncio.run(story())


@pytest.mark.long
def test_of_two_runs_that_a_server_left_the_later_one_has_the_robots(store):
    plan = store.plans.get(planned(store, muster.load("6T-2R")))
    left = (plan.mission, plan.mission_version, plan.id, "mavlink")
    first, later = (store.runs.add(*left, {"endpoints": ends, "arm": True}, 1.0, "ada").id for ends in (HERE, THERE))

    async def story():
        runs = Runs(store, settings_of(store, bridges=("mavlink",)))
        await runs.start_up()
        assert runs.under_way == 1
        with pytest.raises(ConflictError, match=f"run {later} commands robots on UDP port 14550"):
            await runs.start(ADA, plan.id, "mavlink", settings={"endpoints": HERE, "arm": True})
        await runs.close()

    asyncio.run(story())
    found = store.runs.get(first)
    assert (found.state, found.remark) == ("failed", f"run {later}, which began later, commands its robots")


def open_acme(mission, settings, halt, again):
    raise AssertionError("no fleet is opened in the process of the server")


@record
class SiteSettings(Settings):
    """Where the robots of Acme are."""

    site: str = spec(Text(), "the site", default="a")


@pytest.fixture
def fleets():
    """Makes fleets of another package known."""
    names = []

    def add(name, claims=None, settings=SiteSettings):
        fleet = FleetType(name=name, open=open_acme, abilities=("ground",), settings=settings, claims=claims)
        FLEETS.add(name, fleet)
        names.append(name)

    yield add
    for name in names:
        FLEETS.remove(name)


def sites(settings):
    return [f"site {settings.site}"]


def no_texts(settings):
    return [settings.site, 7]


def test_a_fleet_of_another_package_is_claimed_as_a_whole_unless_it_says_what_a_run_claims(fleets):
    fleets("acme")
    fleets("sites", sites)
    assert claims_of("acme", {}) == claims_of("acme", {"site": "a"}) == {"fleet acme"}
    assert claims_of("sites", {"site": "a"}) == {"site a"}
    assert not claims_of("sites", {"site": "a"}) & claims_of("sites", {"site": "b"})


def test_a_declaration_that_is_wrong_is_one_line(fleets):
    fleets("sites", sites, NoSettings)
    fleets("numbers", no_texts)
    with pytest.raises(PluginError, match=r"^fleet sites: its claims: AttributeError: .*'site'$"):
        claims_of("sites", {})
    with pytest.raises(PluginError, match=r"^fleet numbers: its claims: .*; expected texts$"):
        claims_of("numbers", {"site": "a"})
    assert claims_as_far_as_known("sites", {}) == {"fleet sites"}
    assert claims_as_far_as_known("gone", {}) == {"fleet gone"}


@pytest.mark.long
@pytest.mark.parametrize("declares", [False, True])
def test_two_runs_never_command_the_robots_of_another_packages_fleet(store, fleets, declares):
    fleets("acme", sites if declares else None)
    plan = planned(store, muster.load("6T-2R"))

    async def story():
        runs = Runs(store, settings_of(store, bridges=("acme",)))
        both = (runs.start(ADA, plan, "acme", settings={"site": "a"}) for _ in range(2))
        run, at_once = await asyncio.gather(*both, return_exceptions=True)
        assert isinstance(at_once, ConflictError)
        what = "site a" if declares else "fleet acme"
        with pytest.raises(
            ConflictError, match=f"run {run.id} commands robots on {what}; expected others, or that it is over"
        ):
            await runs.start(ADA, plan, "acme", settings={"site": "a"})
        if declares:
            await runs.start(ADA, plan, "acme", settings={"site": "b"})
        else:
            with pytest.raises(ConflictError, match="fleet acme"):
                await runs.start(ADA, plan, "acme", settings={"site": "b"})
        await runs.close()

    asyncio.run(story())


HOLDS = """
import sys
from muster.running.claim_locks import robots_claimed
with robots_claimed(sys.argv[1:]):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_processes_of_one_machine_do_not_claim_the_same_robots(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    command = [sys.executable, "-c", HOLDS, "UDP port 14550", "fleet acme"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "held\n"
        with robots_claimed({"UDP port 14560"}):
            pass
        words = "^fleet acme: another run on this machine commands its robots; expected others, or that it is over$"
        with pytest.raises(ParameterError, match=words), robots_claimed({"fleet acme", "UDP port 14560"}):
            raise AssertionError("claimed twice")
        other.stdin.close()
        other.wait()
    with robots_claimed({"fleet acme"}):
        pass


def test_a_file_of_claims_that_cannot_be_written_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "muster").write_text("no folder")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    with (
        pytest.raises(MusterError, match=r"robots\.lock: .*; expected a file that can be written"),
        robots_claimed({"x"}),
    ):
        raise AssertionError("nothing is claimed")
