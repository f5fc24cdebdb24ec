"""`muster doctor`: its exit code, and what it tells programs."""

import json

import pytest

from muster.cli.verbs import extras_health as doctor


def test_the_verb_tells_faults_by_its_exit_code(muster, monkeypatch):
    monkeypatch.setattr(doctor, "import_faults", lambda names: {})
    code, out, _ = muster("doctor", "--format", "json")
    said = json.loads(out)
    assert (code, said["works"], said["server"]) == (0, True, None)
    assert said["extras"]["plot"]["packages"].keys() == {"matplotlib"}
    monkeypatch.setattr(doctor, "import_faults", lambda names: {"matplotlib": "ImportError: libpng"})
    code, out, _ = muster("doctor", "--format", "json")
    said = json.loads(out)
    assert (code, said["works"], said["extras"]["plot"]["state"]) == (1, False, "broken")


def test_a_server_that_does_not_answer_is_a_fault(muster, monkeypatch):
    pytest.importorskip("httpx")
    monkeypatch.setattr(doctor, "import_faults", lambda names: {})
    code, out, _ = muster("doctor", "--server", "http://127.0.0.1:9", "--format", "json")
    answer = json.loads(out)["server"]
    assert (code, answer["version"]) == (1, None)
    assert "http://127.0.0.1:9" in answer["fault"]
