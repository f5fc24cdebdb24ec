"""What is built has all sources of all packages: the sdist is built here, the wheel by `make test-alone`."""

import zipfile
from pathlib import Path

import pytest
from tools.built_files import ROOT, sources, wrong_in_sdist, wrong_in_wheel
from tools.suites import alone

PACKAGES = {path.parent.name for path in (ROOT / "src").glob("*/__init__.py")}


@pytest.mark.long
def test_the_sdist_has_the_sources_of_all_packages(tmp_path, monkeypatch):
    build = pytest.importorskip("scikit_build_core.build")
    monkeypatch.chdir(ROOT)
    assert wrong_in_sdist(tmp_path / build.build_sdist(str(tmp_path)), sources()) == []


def test_every_package_says_that_it_is_typed():
    assert {Path(name).parent.name for name in sources() if name.endswith("/py.typed")} == PACKAGES


def test_what_a_wheel_lacks_or_has_too_much_is_found(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.whl", "w") as archive:
        for name in ("muster/a.py", "muster/old.py", "muster/core/_core.so", "m.dist-info/RECORD"):
            archive.writestr(name, "")
    expected = ["muster/a.py", "muster/page.css", "muster/core/plans/search.cpp"]
    assert wrong_in_wheel(tmp_path / "a.whl", expected) == ["lacks muster/page.css", "has muster/old.py"]


def test_every_package_besides_muster_has_its_extras():
    assert set(alone.EXTRAS) == PACKAGES - {"muster"}


def test_the_page_has_the_extras_of_each_package():
    text = (ROOT / "docs" / "tests.md").read_text(encoding="utf-8")
    for package, extras in alone.EXTRAS.items():
        assert f"| `{package}` | {', '.join(f'`{extra}`' for extra in extras)} |" in text
