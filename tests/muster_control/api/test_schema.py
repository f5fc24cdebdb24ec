"""What the description says holds, whatever is sent: schemathesis makes requests from it, and judges every answer.

`MUSTER_SCHEMA_EXAMPLES` is how many requests of each kind a route gets, 3 where it is not set.
"""

import os

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, settings
from schemathesis.config import (
    ChecksConfig,
    GenerationConfig,
    PositiveDataAcceptanceConfig,
    ProjectConfig,
    ProjectsConfig,
    SchemathesisConfig,
)
from tests.cli.yard import MISSION
from tests.muster_control.serving import plan_of, served

from muster_control.api import api

EXAMPLES = int(os.environ.get("MUSTER_SCHEMA_EXAMPLES", "3"))
REFUSALS = ["400", "404", "409", "413", "422", "428", "429"]
"""What an answer to a request of the right form may be: it need not be a mission, nor of a plan that is there."""
CHECKS = ChecksConfig(positive_data_acceptance=PositiveDataAcceptanceConfig(expected_statuses=["2xx", *REFUSALS]))
GENERATION = GenerationConfig(deterministic=True, max_examples=EXAMPLES, database="none")
PROJECT = ProjectConfig(checks=CHECKS, generation=GENERATION)
DESCRIPTION = api(lambda: pytest.fail("a description needs no services")).openapi()

SCHEMA = schemathesis.openapi.from_dict(
    DESCRIPTION, config=SchemathesisConfig(seed=1, projects=ProjectsConfig(default=PROJECT))
)
LABELS = [f"{method.upper()} {path}" for path, item in DESCRIPTION["paths"].items() for method in sorted(item)]
_under_test = set()
"""The label of the operation whose test runs."""


@pytest.fixture
def description(label):
    """The description. Cases of one operation are made when its test runs: making all at collection takes seconds."""
    _under_test.add(label)
    yield SCHEMA
    _under_test.remove(label)


@pytest.fixture(scope="module")
def busy(tmp_path_factory):
    """A server with a mission, a plan and a run, each of which is number 1."""
    import httpx

    with served(tmp_path_factory.mktemp("schema"), job_s=0.5, runs=3) as url:
        with httpx.Client(base_url=f"{url}/api/v1", timeout=60) as http:
            mission = http.post("/missions", json={"text": MISSION}).json()["id"]
            assert plan_of(http, mission) == 1
            assert http.post("/runs", json={"plan": 1, "speed": None}).json()["id"] == 1
            assert http.post("/missions/31T-6R50/plans", json={"iterations": 1}).status_code == 202
        yield f"{url}/api/v1"


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("label", LABELS)
@schemathesis.pytest.from_fixture("description").include(lambda it: it.operation.label in _under_test).parametrize()
@settings(
    max_examples=EXAMPLES,
    phases=(Phase.explicit, Phase.generate),
    suppress_health_check=list(HealthCheck),
    derandomize=True,
    deadline=None,
    database=None,
)
def test_answers_are_as_described(case, busy, label):
    assert case.operation.label == label
    case.call_and_validate(base_url=busy, timeout=60)
