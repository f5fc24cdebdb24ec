"""The view *Missions*: those of this server and those that ship; search, make, duplicate, delete."""

from muster_control.pages.missions.view import view

__all__ = ["view"]
