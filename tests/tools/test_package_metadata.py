"""README and links on a package index: absolute where the project has an address, and the build takes them there."""

import email
import re
import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from package_metadata import long_description, urls  # noqa: E402

README = (ROOT / "README.md").read_text(encoding="utf-8")
ADDRESS = "https://example.org/team/muster"
FILES = f"{ADDRESS}/blob/main"


def test_every_link_and_picture_is_absolute_with_an_address():
    text = long_description(README, f"{ADDRESS}/")
    targets = re.findall(r"\]\(([^)]+)\)", text)
    assert len(targets) > 10
    assert all(target.startswith(f"{FILES}/") for target in targets)
    assert f"![A plan for six robots and 31 tasks]({FILES}/docs/images/plan.png?raw=true)" in text


def test_links_that_lead_elsewhere_stay():
    text = "[a](https://b.org) [c](#d) ![e](f.png)"
    assert long_description(text, ADDRESS) == f"[a](https://b.org) [c](#d) ![e]({FILES}/f.png?raw=true)"


def test_without_an_address_only_markers_go():
    assert long_description("<!-- docs-check: long -->\n[a](b)\n", "") == "[a](b)\n"
    assert urls("") == {}


def test_links_lead_to_what_the_repository_has():
    links = urls(f"{ADDRESS}/")
    assert (links["Homepage"], links["Issues"]) == (ADDRESS, f"{ADDRESS}/issues")
    files = [link.removeprefix(f"{FILES}/") for link in links.values() if link.startswith(FILES)]
    assert len(files) == 2
    assert all((ROOT / file).is_file() for file in files)


@pytest.mark.parametrize("address", ["", ADDRESS])
def test_the_build_takes_them(tmp_path, monkeypatch, address):
    build = pytest.importorskip("scikit_build_core.build")
    described = email.message_from_string(_metadata(build, _sources(tmp_path / "clone", address), monkeypatch))
    assert described["Description-Content-Type"] == "text/markdown"
    assert described.get_payload().strip() == long_description(README, address).strip()
    links = dict(link.split(", ") for link in described.get_all("Project-URL", []))
    assert links == urls(address)


def _sources(folder: Path, address: str) -> Path:
    """What the metadata are made of, with an address in place of that of this project."""
    (folder / "tools").mkdir(parents=True)
    for name in ("README.md", "LICENSE", "CMakeLists.txt", "tools/package_metadata.py"):
        shutil.copy(ROOT / name, folder / name)
    settings, changed = re.subn(
        r'(?m)^address = "[^"]*"', f'address = "{address}"', (ROOT / "pyproject.toml").read_text()
    )
    assert changed == 1
    (folder / "pyproject.toml").write_text(settings)
    return folder


def _metadata(build, folder: Path, monkeypatch) -> str:
    monkeypatch.chdir(folder)
    made = build.prepare_metadata_for_build_wheel(str(folder), {"build-dir": str(folder / "build")})
    return (folder / made / "METADATA").read_text(encoding="utf-8")
