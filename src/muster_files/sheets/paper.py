"""Pages of PDF: A4 landscape, with tables whose headings are repeated on every page, pictures and page numbers.

fpdf2 sets the text: it breaks tables over pages, and writes characters that a font lacks in another one. The fonts are
those of pictures: what ships with matplotlib, then installed ones of the scripts that are needed. No time of writing
stands in the file, so that the same plan gives the same bytes.
"""

from __future__ import annotations

import logging
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from io import BytesIO
from typing import TYPE_CHECKING

from muster.mission.errors import MissingExtraError
from muster.report.figures.canvas import require_matplotlib
from muster.report.figures.fonts import Names, fonts_for

try:
    from fpdf import FPDF
    from fpdf.enums import TableBordersLayout, WrapMode
    from fpdf.fonts import FontFace
except ImportError:
    raise MissingExtraError("sheets", "a PDF to print") from None

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARGIN_MM = 12.0
LINE_MM = 3.7
_EPOCH = datetime(2000, 1, 1, tzinfo=UTC)
_DPI = 200
_PADDING_MM, _SPARE_MM = 1.1, 0.5  # at either side of a cell's text, and within
_BOLD = 1.2  # at most so many times as wide as text that is not
_MOST_COLUMNS_OF_TEXT = 160  # in one cell: no row is higher than a page
_GREY, _PALE = (107, 107, 107), (238, 238, 238)
_FONT = "names"


@dataclass(frozen=True)
class Column:
    """A column of a table: its heading, and whether it is set to the right."""

    heading: str
    right: bool = False


class Paper(FPDF):
    """A document whose pages have a heading and a number.

    Parameters
    ----------
    title
        of the document.
    names
        of the mission's robots, tasks and stations.
    texts
        all that will be written in it: fonts for their characters are looked for.

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """

    def __init__(self, title: str, names: Names, texts: Iterable[str]) -> None:
        super().__init__(orientation="landscape", unit="mm", format="A4")
        require_matplotlib()
        self._names, characters = names, {*title}.union(*texts)
        families, self._lacking = fonts_for(characters)
        self._add_fonts(families)
        self.heading, self.page_of_heading = "", 0
        self.set_creation_date(_EPOCH)
        self.set_title(self.drawable(title))
        self.set_creator("Muster")
        self.set_margin(MARGIN_MM)
        self.set_auto_page_break(auto=True, margin=MARGIN_MM + 4)
        self.set_text_shaping(any(map(_is_shaped, characters)))
        self.set_font(_FONT, size=8)

    def _add_fonts(self, families: Sequence[str]) -> None:
        from matplotlib import rcParams
        from matplotlib.font_manager import FontProperties, findfont

        for name, family in [(_FONT, rcParams["font.family"]), *((f"{_FONT}{k}", f) for k, f in enumerate(families))]:
            for style, weight in (("", "normal"), ("B", "bold")):
                self.add_font(name, style, findfont(FontProperties(family=family, weight=weight)))
        self.set_fallback_fonts([f"{_FONT}{k}" for k in range(len(families))], exact_match=False)

    def drawable(self, text: str) -> str:
        """A text in one line, with numbers for ids and question marks for characters that no font has."""
        return "".join("?" if c in self._lacking else c for c in " ".join(self._names.words(text).split()))

    def _in_cell(self, text: str) -> str:
        """A text for a cell; a long one is cut."""
        line, width = self.drawable(text), 0
        for k, c in enumerate(line):
            width += 2 if unicodedata.east_asian_width(c) in "WF" else 1
            if width > _MOST_COLUMNS_OF_TEXT:
                return f"{line[:k]}…"
        return line

    def header(self) -> None:
        """On all pages of a heading but the first: the heading, and the number of the page under it."""
        self.page_of_heading += 1
        if self.page_of_heading > 1:
            self.set_font(_FONT, "B", 9)
            self.cell(
                0, 5, self.drawable(f"{self.heading}, page {self.page_of_heading}"), new_x="LMARGIN", new_y="NEXT"
            )
            self.ln(1)
            self.set_font(_FONT, size=8)

    def footer(self) -> None:
        self.set_y(-MARGIN_MM - 1)
        self.set_font(_FONT, size=7)
        self.set_text_color(*_GREY)
        self.cell(self.epw - 30, 4, self.drawable(str(self.title)))
        self.cell(30, 4, f"{self.page_no()} / {{nb}}", align="R")
        self.set_text_color(0)

    def begin(self, heading: str) -> None:
        """A new page under a heading, which later pages repeat."""
        self.heading, self.page_of_heading = heading, 0
        self.add_page()
        self.start_section(self.drawable(heading))

    def write_title(self, title: str, words: str, width: float | None = None) -> None:
        """A title, and words under it."""
        self.set_font(_FONT, "B", 16)
        self.multi_cell(width or self.epw, 7.5, self.drawable(title), new_x="LMARGIN", new_y="NEXT", align="L")
        self.write_line(words, width=width)

    def write_line(self, words: str, *, bold: bool = False, width: float | None = None) -> None:
        """A paragraph."""
        self.set_font(_FONT, "B" if bold else "", 9 if bold else 8)
        self.multi_cell(width or self.epw, 4.2, self.drawable(words), new_x="LMARGIN", new_y="NEXT", align="L")
        self.set_font(_FONT, size=8)

    def write_facts(self, facts: Sequence[tuple[str, str]], width: float) -> None:
        """Names and what they are, in two columns."""
        self.set_font(_FONT, size=8)
        with self.table(
            col_widths=(28, width - 28),
            width=width,
            align="LEFT",
            text_align="LEFT",
            borders_layout=TableBordersLayout.NONE,
            line_height=4.2,
            first_row_as_headings=False,
        ) as table:
            for name, what in facts:
                row = table.row()
                row.cell(self.drawable(name), style=FontFace(color=_GREY))
                row.cell(self._in_cell(what))

    def write_table(self, columns: Sequence[Column], rows: Iterable[Sequence[str]]) -> None:
        """A table over the whole width, its headings on every page."""
        self.set_font(_FONT, size=7)
        self.set_draw_color(*_PALE)
        texts = [[self._in_cell(cell) for cell in row] for row in rows]
        with self.table(
            col_widths=tuple(self._widths(columns, texts)),
            text_align=tuple("RIGHT" if column.right else "LEFT" for column in columns),
            borders_layout=TableBordersLayout.HORIZONTAL_LINES,
            headings_style=FontFace(emphasis="BOLD", fill_color=_PALE),
            line_height=LINE_MM,
            v_align="TOP",
            padding=(0.5, _PADDING_MM),
            wrapmode=WrapMode.WORD,
        ) as table:
            table.row([column.heading for column in columns])
            for row in texts:
                table.row(row)
        self.set_draw_color(0)

    def _widths(self, columns: Sequence[Column], texts: Sequence[Sequence[str]]) -> list[float]:
        """Widths of columns, millimetres: each as its longest text needs it, as far as there is room for all."""
        needed = [
            max(
                *(_BOLD * self.get_string_width(word) for word in column.heading.split()),
                *(self.get_string_width(row[k]) for row in texts),
            )
            for k, column in enumerate(columns)
        ]
        return fitted([width + 2 * _PADDING_MM + _SPARE_MM for width in needed], self.epw)

    def put_picture(self, figure: Figure, x: float, y: float, width: float) -> None:
        """A figure at a place on the page, millimetres; it leaves the cursor where it is."""
        picture = BytesIO()
        figure.savefig(picture, format="png", dpi=_DPI, metadata={"Software": None})
        picture.seek(0)
        self.image(picture, x=x, y=y, w=width)

    def written(self) -> bytes:
        """The bytes of the whole document."""
        subsetting = logging.getLogger("fontTools.subset")
        level = subsetting.level
        subsetting.setLevel(logging.ERROR)  # it tells of tables that PDF does not need
        try:
            return bytes(self.output())
        finally:
            subsetting.setLevel(level)


def fitted(needed: Sequence[float], total: float) -> list[float]:
    """Widths that make up a total: what is needed, and more, in proportion; else the widest no wider than one limit."""
    if sum(needed) <= total:
        return [width * total / sum(needed) for width in needed]
    limit, narrow = 0.0, 0.0
    for k, width in enumerate(sorted(needed)):
        limit = (total - narrow) / (len(needed) - k)
        if width > limit:
            break
        narrow += width
    return [min(width, limit) for width in needed]


def _is_shaped(c: str) -> bool:
    """Whether the letters of a script are joined, stacked or written from the right, which takes a shaping engine."""
    return unicodedata.bidirectional(c) in ("R", "AL") or unicodedata.category(c) in ("Mn", "Mc")
