"""What workers and runners inherit: no secrets, and nothing is left of them in the folder of temporary files."""

import asyncio
import tempfile
from pathlib import Path

import pytest

from muster_control.runs.runner_process import RunnerProcess
from muster_control.work.environment import without_secrets
from muster_control.work.temporary_folders import OF_RUNS, sweep


def test_secrets_stay_with_the_server():
    kept = {
        "PATH": "/bin",
        "ROS_DOMAIN_ID": "7",
        "ROS_SECURITY_KEYSTORE": "/k",
        "HOME": "/h",
        "AMENT_PREFIX_PATH": "/o",
    }
    secret = (
        "PGPASSWORD",
        "PGPASSFILE",
        "MUSTER_TOKEN",
        "MUSTER_DB",
        "AWS_SECRET_ACCESS_KEY",
        "DATABASE_URL",
        "db_pass",
    )
    assert without_secrets(kept | dict.fromkeys(secret, "x")) == kept


@pytest.mark.long
def test_runners_leave_no_folder_and_know_no_secret(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setenv("MUSTER_TOKEN", "muster_secret")

    async def story(end):
        child = await RunnerProcess.start("run 1", 2048)
        while not list(tmp_path.glob(f"{OF_RUNS}*")):  # Python tries the folder by a file of its own before
            await asyncio.sleep(0.02)
        assert b"muster_secret" not in Path(f"/proc/{child.pid}/environ").read_bytes()
        end(child)
        assert [text async for text in child.messages()] == []

    asyncio.run(story(RunnerProcess.dismiss))
    assert not list(tmp_path.iterdir())
    asyncio.run(story(RunnerProcess.kill))
    (tmp_path / f"{OF_RUNS}1-mine").mkdir()  # of a process that lives
    assert len(list(tmp_path.iterdir())) == 2
    sweep(OF_RUNS)
    assert [left.name for left in tmp_path.iterdir()] == [f"{OF_RUNS}1-mine"]
