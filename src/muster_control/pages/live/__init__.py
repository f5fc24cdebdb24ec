"""The view *Live*: the runs under way, and one run with its controls."""

from muster_control.pages.live import views

__all__ = ["views"]
