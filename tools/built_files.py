"""Compares the files of a wheel or an sdist with the sources of the packages in git, both ways."""

import subprocess
import tarfile
import zipfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[1]
_COMPILED = (".cpp", ".hpp")
_MADE = ("muster/core/_core.", "muster/documents/")
"""What is in the wheel only: the core, and the documents that `muster docs` shows."""


def sources() -> set[str]:
    """Return the files below `src` that git tracks, without `src/`."""
    listed = subprocess.run(["git", "ls-files", "src"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return {name.removeprefix("src/") for name in listed.splitlines() if (ROOT / name).exists()}


def wrong_in_wheel(wheel: Path, expected: Iterable[str]) -> list[str]:
    """Return what a wheel lacks of the sources, and what its packages have besides, a line each."""
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name and ".data/" not in name}
    wanted = {name for name in expected if not name.endswith(_COMPILED)}
    lacks = [f"lacks {name}" for name in sorted(wanted - names)]
    return lacks + [f"has {name}" for name in sorted(names - wanted) if not name.startswith(_MADE)]


def wrong_in_sdist(sdist: Path, expected: Iterable[str]) -> list[str]:
    """Return what an sdist lacks of the sources, and what it has besides below `src`, a line each."""
    with tarfile.open(sdist) as archive:
        below = [member.name.partition("/")[2] for member in archive.getmembers() if member.isfile()]
    names = {name.removeprefix("src/") for name in below if name.startswith("src/")}
    wanted = set(expected)
    return [f"lacks {name}" for name in sorted(wanted - names)] + [f"has {name}" for name in sorted(names - wanted)]
