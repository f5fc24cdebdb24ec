"""The task that lists allocators."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any

from muster.allocation.registry import ALLOCATORS
from muster.planning.options import DEFAULT_ALLOCATOR


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{}` -> `{"allocators": [...]}`: name, summary, whether anytime, whether the default, parameters by default."""
    return {
        "allocators": [
            {
                "name": allocator.name,
                "summary": allocator.summary,
                "anytime": allocator.anytime,
                "default": allocator.name == DEFAULT_ALLOCATOR,
                "parameters": {f.name: f.default for f in fields(allocator.parameters)},
            }
            for allocator in ALLOCATORS.usable().values()
        ]
    }
