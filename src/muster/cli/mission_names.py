"""Names of missions and files, as a shell completes them."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem


def missions(_: click.Context, __: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Names of shipped missions, and files."""
    from muster.library import missions as shipped

    named = [m for m in shipped() if m.name.startswith(incomplete)] if "/" not in incomplete else []
    return [CompletionItem(incomplete, type="file"), *(CompletionItem(m.name, help=m.description) for m in named)]
