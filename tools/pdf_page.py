"""`python -m tools.pdf_page FILE PICTURE [NUMBER]`: a page of a PDF as PNG, which holds the page's text as its data."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import pypdfium2
from PIL.PngImagePlugin import PngInfo

_SCALE = 1.5  # of 72 dots per inch


def draw(file: Path, picture: Path, number: int) -> None:
    """Draw a page, counted from 1; docs-check compares pictures by their Description: here the words of the page."""
    with pypdfium2.PdfDocument(file) as document:
        page = document[number - 1]
        words = page.get_textpage().get_text_range().split()
        description = PngInfo()
        description.add_text("Description", json.dumps([{"words": words}]))
        page.render(scale=_SCALE).to_pil().save(picture, pnginfo=description, optimize=True)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tools.pdf_page", description="Draw a page of a PDF as PNG.")
    parser.add_argument("file", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("number", type=int, nargs="?", default=1)
    given = parser.parse_args()
    draw(given.file, given.picture, given.number)


if __name__ == "__main__":
    main()
