"""The README on a package index: absolute links where the project has an address, and the build takes it from there."""

import email
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from long_description import long_description  # noqa: E402

README = (ROOT / "README.md").read_text(encoding="utf-8")
ADDRESS = "https://example.org/muster/blob/main"


def test_every_link_and_picture_is_absolute_with_an_address():
    text = long_description(README, f"{ADDRESS}/")
    targets = re.findall(r"\]\(([^)]+)\)", text)
    assert len(targets) > 10
    assert all(target.startswith(f"{ADDRESS}/") for target in targets)
    assert f"![A plan for six robots and 31 tasks]({ADDRESS}/docs/images/plan.png?raw=true)" in text


def test_links_that_lead_elsewhere_stay():
    text = "[a](https://b.org) [c](#d) ![e](f.png)"
    assert long_description(text, ADDRESS) == f"[a](https://b.org) [c](#d) ![e]({ADDRESS}/f.png?raw=true)"


def test_without_an_address_only_markers_go():
    assert long_description("<!-- docs-check: long -->\n[a](b)\n", "") == "[a](b)\n"


def test_the_build_takes_it(tmp_path, monkeypatch):
    build = pytest.importorskip("scikit_build_core.build")
    monkeypatch.chdir(ROOT)
    info = tmp_path / build.prepare_metadata_for_build_wheel(str(tmp_path), {"build-dir": str(tmp_path / "build")})
    described = email.message_from_string((info / "METADATA").read_text(encoding="utf-8"))
    assert described["Description-Content-Type"] == "text/markdown"
    assert described.get_payload().strip() == long_description(README, "").strip()
