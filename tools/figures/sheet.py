"""A contact sheet: small pictures side by side, each with its number."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

_COLUMNS, _WIDTH, _LABEL, _GAP = 3, 480, 16, 8
"""Pictures in a row, and pixels: the width of each, the height of its number, and what is free around it."""
_COLOURS = 256
"""So few that a sheet stays small."""


def write_sheet(path: Path, pictures: Sequence[tuple[str, Path]]) -> None:
    """Write the pictures, each with the text above it, as one PNG without a time in it."""
    from PIL import Image, ImageDraw

    small = [(text, _thumbnail(file)) for text, file in pictures]
    rows = [small[k : k + _COLUMNS] for k in range(0, len(small), _COLUMNS)]
    heights = [max(image.height for _, image in row) + _LABEL + _GAP for row in rows]
    sheet = Image.new("RGB", (min(_COLUMNS, len(small)) * (_WIDTH + _GAP), sum(heights)), "white")
    draw, top = ImageDraw.Draw(sheet), 0
    for row, height in zip(rows, heights, strict=True):
        for column, (text, image) in enumerate(row):
            left = column * (_WIDTH + _GAP)
            draw.text((left, top), text, fill=(90, 90, 90))
            sheet.paste(image, (left, top + _LABEL))
        top += height
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.quantize(_COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(path, optimize=True)


def _thumbnail(file: Path) -> Picture:
    from PIL import Image

    with Image.open(file) as image:
        small = image.convert("RGB")
    small.thumbnail((_WIDTH, 2 * _WIDTH), Image.Resampling.LANCZOS)
    return small
