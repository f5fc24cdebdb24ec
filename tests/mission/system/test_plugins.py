"""Implementations by name: what ships and what packages register; packages that cannot be used are named."""

import logging
import subprocess
import sys

import pytest

from muster.allocation.registry import ALLOCATORS
from muster.mission.errors import ParameterError, PluginError
from muster.mission.system import plugins
from muster.mission.system.plugins import Registry


def package(folder, name, entries, code=""):
    """An installed package with entry points of the group `muster.things`."""
    info = folder / f"{name.replace('-', '_')}-1.0.dist-info"
    info.mkdir(parents=True, exist_ok=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[muster.things]\n" + "".join(f"{entry}\n" for entry in entries))
    (folder / f"{name.replace('-', '_')}.py").write_text(code)


def forget():
    """Let what is installed be read again."""
    for known in (plugins._declared, plugins._installed, plugins._own):
        known.cache_clear()


@pytest.fixture
def things(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(plugins, "DISTRIBUTION", "muster-own")

    def registry(**shipped):
        package(tmp_path, "muster-own", [f"{name} = {place}" for name, place in shipped.items()])
        forget()
        return Registry("thing", "muster.things", checked)

    yield registry
    forget()
    for name in ("muster_one", "muster_two"):
        sys.modules.pop(name, None)


def checked(name, found):
    if not isinstance(found, str):
        raise ParameterError(f"is a {type(found).__name__}; expected a text")
    return found


def test_nothing_is_imported_before_it_is_looked_up(tmp_path, things):
    package(tmp_path, "muster-one", ["mine = muster_one:THING"], "THING = 'of one'")
    registry = things(path="os:sep")
    assert list(registry) == ["path", "mine"]
    assert registry.shipped == ("path",)
    assert "muster_one" not in sys.modules
    assert registry["mine"] == "of one"
    assert registry["path"] == "/"


def test_a_package_that_cannot_be_loaded_is_named_in_one_line(tmp_path, things, caplog):
    package(tmp_path, "muster-one", ["mine = muster_one:THING"], "import no_such_module")
    registry = things(path="os:sep")
    with pytest.raises(PluginError) as refusal:
        registry.named("mine")
    line = "thing mine of the package muster-one 1.0: cannot be loaded: ModuleNotFoundError: No module named"
    assert str(refusal.value) == f"{line} 'no_such_module'"
    with caplog.at_level(logging.WARNING, "muster"):
        assert registry.usable() == {"path": "/"}
    assert line in caplog.text


def test_what_is_no_implementation_is_refused_by_name(tmp_path, things):
    package(tmp_path, "muster-one", ["mine = muster_one:THING"], "THING = 3")
    with pytest.raises(PluginError) as refusal:
        things()["mine"]
    assert str(refusal.value) == "thing mine of the package muster-one 1.0: is a int; expected a text"


def test_a_name_that_two_packages_register_is_refused_and_the_others_are_not(tmp_path, things):
    package(tmp_path, "muster-one", ["mine = muster_one:THING", "path = muster_one:THING"], "THING = '1'")
    package(tmp_path, "muster-two", ["mine = muster_two:THING", "other = muster_two:THING"], "THING = '2'")
    registry = things(path="os:sep")
    with pytest.raises(PluginError, match=r"thing mine: registered by muster-(one|two) 1.0 and muster-(one|two) 1.0"):
        registry["mine"]
    with pytest.raises(PluginError, match=r"thing path: registered by muster-own 1.0 and muster-one 1.0"):
        registry["path"]
    assert registry["other"] == "2"


def test_an_unknown_name_has_its_near_match(things):
    with pytest.raises(ParameterError, match="thing: pahts; expected path; did you mean 'path'"):
        things(path="os:sep").named("pahts")
    with pytest.raises(KeyError):
        things()["path"]


def test_what_is_added_in_this_process_is_known_once(things):
    registry = things(path="os:sep")
    registry.add("mine", "of mine")
    assert registry.named("mine") == "of mine"
    with pytest.raises(ParameterError, match="a name that no thing has yet"):
        registry.add("mine", "again")
    with pytest.raises(ParameterError, match="expected a text"):
        registry.add("number", 3)
    assert "number" not in registry


def test_importing_the_registry_imports_no_allocator():
    code = "import sys, muster.allocation.registry; print([m for m in sys.modules if m.endswith('.consensus_bundle')])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
    assert list(ALLOCATORS.shipped) == list(ALLOCATORS)
