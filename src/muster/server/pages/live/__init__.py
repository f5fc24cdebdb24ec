"""Live: the runs under way, and one of them as it is carried out, with all that may be commanded."""

from muster.server.pages.live import views

__all__ = ["views"]
