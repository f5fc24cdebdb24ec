"""Records: runs that are over, and one of them: its replay, what was planned beside what was flown, who did what."""

from muster.server.pages.records import views

__all__ = ["views"]
