"""The view *Records*: runs that are over, and one record with its replay, comparison and commands."""

from muster_control.pages.records import views

__all__ = ["views"]
