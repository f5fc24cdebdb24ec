"""What `muster doctor` finds: extras that work or do not, and the limits of a control group."""

import importlib.util

import pytest

from muster.cli.verbs import extras_health as doctor
from muster.cli.verbs import system_facts
from muster.mission.system.installation import Part, extras


@pytest.mark.long
def test_packages_that_fail_or_crash_are_told_each_by_itself(tmp_path, monkeypatch):
    (tmp_path / "fails_here.py").write_text("raise ValueError('no such device')")
    (tmp_path / "crashes_here.py").write_text("import os; os.abort()")
    (tmp_path / "works_here.py").write_text("print('loaded')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert doctor.import_faults(["fails_here", "crashes_here", "works_here"]) == {
        "fails_here": "ValueError: no such device",
        "crashes_here": "crashes when imported (exit code -6)",
    }


@pytest.mark.parametrize(
    ("versions", "faults", "state"),
    [
        ((None, None), {}, "absent"),
        (("1", None), {}, "incomplete"),
        (("1", "2"), {}, "works"),
        (("1", None), {"a": "ImportError: libx"}, "broken"),
    ],
)
def test_the_state_of_an_extra(versions, faults, state):
    parts = tuple(Part(name, version) for name, version in zip("ab", versions, strict=True))
    assert doctor.ExtraHealth(name="x", parts=parts, faults=faults).state == state


@pytest.mark.parametrize(
    ("package", "module"),
    [
        ("click", "click"),
        ("numpy", "numpy"),
        ("pyyaml", "yaml"),
        ("muster.core", "muster.core"),
        ("no-such", "no-such"),
    ],
)
def test_the_module_of_a_package(package, module):
    assert doctor.module_of(package) == module


def test_every_package_that_is_installed_has_a_module():
    there = [part.name for parts in extras().values() for part in parts if part.version is not None]
    assert [name for name in there if importlib.util.find_spec(doctor.module_of(name)) is None] == []


@pytest.mark.parametrize(
    ("files", "limit"),
    [
        ({}, None),
        ({"proc/self/cgroup": "0::/a/b\n", "sys/fs/cgroup/a/b/cpu.max": "max 100000\n"}, None),
        ({"proc/self/cgroup": "0::/a/b\n", "sys/fs/cgroup/a/b/cpu.max": "150000 100000\n"}, 1.5),
        (
            {
                "proc/self/cgroup": "0::/a/b\n",
                "sys/fs/cgroup/a/b/cpu.max": "150000 100000\n",
                "sys/fs/cgroup/a/cpu.max": "50000 100000\n",
            },
            0.5,
        ),
        ({"sys/fs/cgroup/cpu.max": "200000 100000\n"}, 2.0),
        ({"sys/fs/cgroup/cpu/cpu.cfs_quota_us": "-1\n", "sys/fs/cgroup/cpu/cpu.cfs_period_us": "100000\n"}, None),
        ({"sys/fs/cgroup/cpu/cpu.cfs_quota_us": "25000\n", "sys/fs/cgroup/cpu/cpu.cfs_period_us": "100000\n"}, 0.25),
    ],
)
def test_processors_that_a_control_group_allows(tmp_path, files, limit):
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    assert system_facts.group_limit(tmp_path) == limit
