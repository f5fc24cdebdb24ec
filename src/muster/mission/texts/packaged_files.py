"""Files that ship beside modules: texts, and data in YAML."""

from __future__ import annotations

from importlib.resources import files
from typing import Any


def packaged_text(package: str, name: str) -> str:
    """Return the text of a file that ships in a package."""
    return (files(package) / name).read_text(encoding="utf-8")


def packaged_data(package: str, name: str) -> Any:
    """Return the data of a YAML file that ships in a package."""
    import yaml

    return yaml.load(packaged_text(package, name), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # noqa: S506  # safe too
