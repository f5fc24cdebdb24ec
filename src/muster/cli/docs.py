"""`muster docs`: the documents, in the terminal or in the browser, without a network."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options import format_option, quiet_option
from muster.mission.errors import MusterError, ParameterError

if TYPE_CHECKING:
    from muster.library.documents import Entry

_PICTURE = re.compile(r"!\[([^]]*)\]\([^)]*\)")
_LINK = re.compile(r"\[([^]]+)\]\((?!https?:)([^)\s]*)\)")
_STYLES = {"markdown.code": "cyan", "markdown.code_block": "cyan", "markdown.link": "none"}
_WIDEST = 120  # columns of text; more are hard to read


@click.command()
@click.argument("page", required=False)
@click.option("--find", "words", metavar="WORDS", help="List the lines of all pages that hold all of these words.")
@click.option("--open", "opens", is_flag=True, help="Open the page, or the front page, in the browser.")
@format_option
@quiet_option
def command(page: str | None, words: str | None, opens: bool, form: str, quiet: bool, verbose: bool) -> None:
    """Read the documents: list them, or show a PAGE.

    In a terminal a page is laid out, and shown by the pager (PAGER); into a
    file or a pipe it is written as Markdown. Nothing needs a network.
    """
    if words is not None and (page is not None or opens):
        raise ParameterError("--find: with a PAGE or --open; expected it alone")
    if words is not None and not words.strip():
        raise ParameterError("--find: no words; expected some to look for")
    entries = _entries()
    if words is not None:
        _print_found(words, form)
        return
    entry = None if page is None else _entry_of(page, entries)
    if opens:
        _open(entry)
    elif entry is None:
        _print_list(entries, form)
    else:
        _show(entry, form)
    if verbose:
        from muster.library.documents import documents_root

        click.echo(f"documents: {documents_root()}", err=True)


def _entries() -> Sequence[Entry]:
    from muster.library.documents import documents

    entries = documents()
    if not entries:
        raise MusterError(
            "documents: not in this installation; expected a package that was built with them, or a clone"
        )
    return entries


def _entry_of(page: str, entries: Sequence[Entry]) -> Entry:
    """The page of a name, which may be that of its file."""
    from muster.mission.texts.near_matches import did_you_mean

    names = {entry.name.casefold(): entry for entry in entries}
    wanted = Path(page).name.removesuffix(".md").removesuffix(".html").casefold()
    if wanted not in names:
        hint = did_you_mean(wanted, [entry.name for entry in entries])
        raise ParameterError(f"PAGE: no page {page}; expected one of `muster docs`{hint}")
    return names[wanted]


def _print_list(entries: Sequence[Entry], form: str) -> None:
    from muster.cli.tables import print_table

    if form == "json":
        _print_json([_as_dict(entry) for entry in entries])
        return
    for kind, pages in groupby(entries, key=lambda entry: entry.kind):
        print_table(("page", "when you want to"), [(entry.name, _plain(entry.purpose)) for entry in pages], title=kind)


def _print_found(words: str, form: str) -> None:
    from muster.cli.tables import print_table
    from muster.library.documents import find_in_documents

    found = list(find_in_documents(words))
    if form == "json":
        _print_json([{"name": at.entry.name, "section": at.section, "line": at.line} for at in found])
    elif found:
        rows = [(at.entry.name, _plain(at.section), _plain(at.line)) for at in found]
        print_table(("page", "section", "line"), rows)
    else:
        click.echo(f"no page has {words}", err=True)


def _show(entry: Entry, form: str) -> None:
    from muster.library.documents import document_text, readable_text

    text = readable_text(document_text(entry))
    if form == "json":
        _print_json({**_as_dict(entry), "text": text})
    elif sys.stdout.isatty():
        click.echo_via_pager(laid_out(text, min(shutil.get_terminal_size().columns, _WIDEST)))
    else:
        click.echo(text, nl=False)


def laid_out(text: str, width: int) -> str:
    """A page as a terminal shows it, of so many columns, with its escape sequences.

    Pictures are named. Links to other pages become their words, with the name by which `muster docs` shows the page.
    """
    from rich.console import Console
    from rich.markdown import Markdown
    from rich.theme import Theme

    out = Console(width=width, force_terminal=True, theme=Theme(_STYLES), highlight=False)
    with out.capture() as captured:
        out.print(Markdown(_LINK.sub(_words, _PICTURE.sub(r"*[picture: \1]*", text)), code_theme="ansi_dark"))
    return captured.get()


def _words(link: re.Match[str]) -> str:
    """The words of a link, and the name of the page that it leads to, where the words do not say so."""
    words, target = link.groups()
    name = Path(target.partition("#")[0]).name.removesuffix(".md")
    said = not name or words.strip("`").removesuffix(".md").endswith(name)
    return words if said else f"{words} ({name})"


def _plain(words: str) -> str:
    """Words without the marks of Markdown."""
    return _LINK.sub(_words, _PICTURE.sub(r"\1", words)).replace("`", "").replace("**", "")


def _open(entry: Entry | None) -> None:
    """Open a page in the browser, and print its address, which can be opened by hand where there is no browser."""
    import webbrowser

    from muster.library.documents import site_page

    path = site_page(entry)
    if path is None:
        name = "PAGE" if entry is None else entry.name
        raise MusterError(
            f"--open: no site in this installation (`make docs` builds it in a clone); read `muster docs {name}`"
        )
    click.echo(path.as_uri())
    webbrowser.open(path.as_uri())


def _as_dict(entry: Entry) -> dict[str, Any]:
    from muster.library.documents import site_page

    page = site_page(entry)
    return {"name": entry.name, **asdict(entry), "site": None if page is None else str(page)}


def _print_json(data: object) -> None:
    import json

    click.echo(json.dumps(data, indent=1, ensure_ascii=False))
