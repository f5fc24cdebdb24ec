"""`python -m tools.docs_site`: builds the site in build/docs/site. A warning is an error."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from sphinx.cmd.build import main as sphinx

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "docs"
PROCESSES = "2"


def build() -> int:
    """Build all of it anew: pages may be as they were while the code that their notebooks run is not."""
    shutil.rmtree(BUILD, ignore_errors=True)
    settings = ["-c", str(Path(__file__).parent), "-d", str(BUILD / "doctrees")]
    strict = ["--fail-on-warning", "--keep-going", "--quiet", "--jobs", PROCESSES]
    code = sphinx(["--builder", "html", *strict, *settings, *sys.argv[1:], str(ROOT), str(BUILD / "site")])
    if code == 0:
        print(f"the site: {BUILD / 'site' / 'index.html'}")
        print(f"what leads out of it, not called: {BUILD / 'site-links.txt'}")
    return code


if __name__ == "__main__":
    sys.exit(build())
