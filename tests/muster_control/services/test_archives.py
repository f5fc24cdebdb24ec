"""Several files become one, and nobody waits for that."""

import asyncio
import base64
import io
import threading
import zipfile

from muster_control.services import archives
from muster_control.services.archives import archive_of


def in_base64(*names):
    return {name: base64.b64encode(name.encode()).decode() for name in names}


def test_one_file_stays_as_it_is_and_several_become_a_zip():
    assert asyncio.run(archive_of(in_base64("a.plan"), "x")) == (b"a.plan", "a.plan")
    content, name = asyncio.run(archive_of(in_base64("a.plan", "b.plan"), "plan-1-qgc"))
    assert name == "plan-1-qgc.zip"
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert {file: archive.read(file) for file in archive.namelist()} == {"a.plan": b"a.plan", "b.plan": b"b.plan"}


def test_others_are_served_while_files_are_packed(monkeypatch):
    served = threading.Event()

    def slow(data):
        assert served.wait(30)
        return base64.b64decode(data)

    monkeypatch.setattr(archives, "b64decode", slow)

    async def story():
        packing = asyncio.create_task(archive_of(in_base64("a", "b"), "x"))
        await asyncio.sleep(0)
        served.set()
        return await packing

    assert asyncio.run(story())[1] == "x.zip"
