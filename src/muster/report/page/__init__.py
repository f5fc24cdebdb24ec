"""Pages that show a record in a browser."""

from muster.report.page.page import page_text, write_page

__all__ = ["page_text", "write_page"]
