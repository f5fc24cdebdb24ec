"""What docs/house.md says of packages and rooms is what the code and the import contracts say."""

import re

from tools.house import PACKAGES, PAGE, ROOMS, ROOT, written

TEXT = PAGE.read_text(encoding="utf-8")


def test_the_map_is_drawn_from_the_code():
    assert written() == TEXT, "run `make house`"


def test_the_pictures_are_the_import_contracts():
    pictures = re.findall(r"```text\n(.*?)```", TEXT, flags=re.DOTALL)
    assert [picture.splitlines() for picture in pictures] == [PACKAGES, ROOMS]


def test_every_package_has_a_page_and_a_suite():
    packages = {path.name for path in (ROOT / "src").iterdir() if (path / "__init__.py").is_file()} - {"muster"}
    assert set(re.findall(r"^\| `(muster_\w+)` \|", TEXT, flags=re.MULTILINE)) == packages
    for package in packages:
        page = ROOT / "docs" / f"package-{package.removeprefix('muster_')}.md"
        assert f"`tests/{package}`" in page.read_text(encoding="utf-8")
        assert any((ROOT / "tests" / package).rglob("test_*.py"))


def test_every_place_that_it_names_is_there():
    for name in re.findall(r"`(muster(?:_\w+)?/[\w/.]+)`", TEXT):
        assert (ROOT / "src" / name).exists(), name
    for page in (ROOT / "docs").glob("package-*.md"):
        package = "muster_" + page.stem.removeprefix("package-")
        blueprint = page.read_text(encoding="utf-8").split("## Blueprint")[1].split("## Where")[0]
        for name in set(re.findall(r"`([a-z]\w*)`", blueprint)) - {"muster"}:
            assert any(found.stem == name for found in (ROOT / "src" / package).rglob("*")), name
