"""What docs/mission-control-api.md says is so."""

import json
import re
import shlex
from pathlib import Path
from urllib.request import Request, urlopen

import pytest
from tests.muster_control.serving import served

from muster.cli.main import run
from muster_control.api import api

TEXT = (Path(__file__).parents[2] / "docs" / "mission-control-api.md").read_text(encoding="utf-8")
DESCRIBED = "http://127.0.0.1:8117"


def block(language, k=0):
    return re.findall(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)[k]


@pytest.fixture(scope="module")
def url(tmp_path_factory):
    with served(tmp_path_factory.mktemp("server")) as url:
        yield url


def test_the_routes_are_those_of_the_description():
    paths = api(lambda: pytest.fail("a description needs no desk")).openapi()["paths"]
    there = {f"{method.upper()} {path}" for path, methods in paths.items() for method in methods}
    assert set(re.findall(r"^\| `([A-Z]+ /[^`]*)` \|", TEXT, flags=re.MULTILINE)) == there


@pytest.mark.long
def test_the_python_example_runs(url, capsys):
    exec(compile(block("python").replace(DESCRIBED, url), "mission-control-api.md", "exec"), {})
    *_, entry, took = capsys.readouterr().out.splitlines()
    assert "report" in entry
    assert float(took) > 0


def test_the_command_runs(url, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["init", "mission.yaml", "-q"]) == 0
    _, *arguments = shlex.split(block("sh").replace(DESCRIBED, url).replace("--time-limit 10", "--iterations 5"))
    assert run(arguments) == 0
    assert "objective" in capsys.readouterr().out


@pytest.mark.long
def test_the_curl_example_is_answered(url):
    _, _, address, _, header, _, body = shlex.split(block("sh", 1).replace(DESCRIBED, url))
    name, _, value = header.partition(": ")
    with urlopen(Request(address, body.encode(), {name: value})) as answer:
        assert (answer.status, json.load(answer)["kind"]) == (202, "plan")
