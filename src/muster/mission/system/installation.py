"""What is installed of Muster: its version, how its core was built, its extras and what each needs."""

from __future__ import annotations

import json
import platform
import re
from dataclasses import dataclass
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution, version

DISTRIBUTION = "muster-robotics"
_CORE_BUILD = "core_build.json"  # beside the metadata of the installed package; the build puts it there
_NAME = re.compile(r"[A-Za-z0-9._-]+")
_EXTRA = re.compile(r"extra == ['\"]([^'\"]+)['\"]")


@dataclass(frozen=True, kw_only=True)
class CoreBuild:
    """How the core was built. `stable_abi` is the oldest Python that can load it; empty: that which built it alone."""

    compiler: str
    build_type: str
    system: str
    processor: str
    python: str
    stable_abi: str
    nanobind: str
    sanitized: bool

    def __str__(self) -> str:
        loads = f"Python {self.stable_abi} and later" if self.stable_abi else f"Python {self.python}"
        sanitized = ", with sanitizers" if self.sanitized else ""
        return f"{self.compiler}, {self.build_type}, {self.system} {self.processor}, for {loads}{sanitized}"


@dataclass(frozen=True)
class Part:
    """A package that an extra needs: its name, and its version; None where it is not installed."""

    name: str
    version: str | None


def installed_version() -> str:
    """The version of Muster."""
    return version(DISTRIBUTION)


def core_build() -> CoreBuild | None:
    """How the core was built; None for an installation that does not say, made before 0.1.0 was released."""
    text = distribution(DISTRIBUTION).read_text(_CORE_BUILD)
    if not text:
        return None
    facts = json.loads(text)
    facts["sanitized"] = facts["sanitized"] == "ON"
    return CoreBuild(**{name: facts[name] for name in CoreBuild.__dataclass_fields__})


def version_line() -> str:
    """One line: the version, how the core was built, and the Python that runs it."""
    return f"muster {installed_version()} (core: {core_build() or 'not recorded'}; Python {platform.python_version()})"


def extras() -> dict[str, tuple[Part, ...]]:
    """What each extra needs, other extras included, in the order of the package's metadata."""
    package = distribution(DISTRIBUTION)
    names = package.metadata.get_all("Provides-Extra", [])
    return {name: tuple(Part(need, _version(need)) for need in _needs(package, name)) for name in names}


def core_parts() -> tuple[Part, ...]:
    """What Muster needs without any extra."""
    requires = distribution(DISTRIBUTION).requires or []
    return tuple(Part(name, _version(name)) for name in (_named(r)[0] for r in requires if "extra ==" not in r))


def _needs(package: Distribution, extra: str) -> list[str]:
    needs: dict[str, None] = {}  # a set in order
    for requirement in package.requires or []:
        of = _EXTRA.search(requirement)
        if of is None or of[1] != extra:
            continue
        name, inner = _named(requirement)
        needs |= dict.fromkeys([n for one in inner for n in _needs(package, one)] if inner else [name])
    return list(needs)


def _named(requirement: str) -> tuple[str, list[str]]:
    """The package that a requirement names, and which of Muster's own extras it asks for."""
    found = _NAME.match(requirement)
    assert found is not None, requirement
    inner = re.match(r"\s*\[([^\]]*)\]", requirement[found.end() :])
    own = found[0] == DISTRIBUTION and inner is not None
    return found[0], [name.strip() for name in inner[1].split(",")] if own and inner is not None else []


@cache
def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
