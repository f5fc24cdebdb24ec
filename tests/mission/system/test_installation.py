"""What an installation says of itself."""

import json
from importlib.metadata import version

import pytest

from muster.mission.system import installation


class Package:
    """A package's metadata as they are read."""

    def __init__(self, requires=(), extras=(), core=None):
        self.requires, self._extras, self._core = list(requires), list(extras), core
        self.metadata = self

    def get_all(self, name, _default):
        assert name == "Provides-Extra"
        return self._extras

    def read_text(self, name):
        return self._core if name == "core_build.json" else None


@pytest.fixture
def installed(monkeypatch):
    def install(**facts):
        monkeypatch.setattr(installation, "distribution", lambda name: Package(**facts))

    return install


FACTS = {
    "version": "0.1.0", "compiler": "GNU 12.2.0", "build_type": "Release", "system": "Linux", "processor": "aarch64",
    "python": "3.12.1", "stable_abi": "3.12", "nanobind": "3.1.0", "sanitized": "OFF",
}  # fmt: skip


def test_how_the_core_was_built(installed):
    installed(core=json.dumps(FACTS))
    assert str(installation.core_build()) == "GNU 12.2.0, Release, Linux aarch64, for Python 3.12 and later"


def test_a_core_for_one_python_with_sanitizers(installed):
    installed(core=json.dumps(FACTS | {"stable_abi": "", "sanitized": "ON"}))
    assert str(installation.core_build()) == "GNU 12.2.0, Release, Linux aarch64, for Python 3.12.1, with sanitizers"


def test_an_installation_that_does_not_say(installed):
    installed()
    assert installation.core_build() is None
    assert "core: not recorded" in installation.version_line()


def test_extras_with_those_they_ask_for(installed):
    needs = [
        "numpy>=1.26",
        'pillow>=10.3; extra == "map"',
        'no-such-package-here>=1; extra == "web"',
        'psycopg[binary]>=3.2; extra == "web"',
        'muster-robotics[map,plot]; extra == "web"',
        'pillow; extra == "plot"',
    ]
    installed(requires=needs, extras=["map", "web", "plot", "ros1"])
    found = installation.extras()
    assert list(found) == ["map", "web", "plot", "ros1"]
    assert [part.name for part in found["web"]] == ["no-such-package-here", "psycopg", "pillow"]
    assert found["web"][0].version is None
    assert found["ros1"] == ()
    assert installation.core_parts() == (installation.Part("numpy", version("numpy")),)
