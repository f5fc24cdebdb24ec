"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.thesis_6.action_paths import ActionPaths
from muster_studies.thesis_6.disturbed import CapacityReserve, UsageUnderNoise
from muster_studies.thesis_6.flights import Flight, FlightResult, fly
from muster_studies.thesis_6.laws import ByLaw
from muster_studies.thesis_6.misaligned import MisalignedMarkers
from muster_studies.thesis_6.physics import BesidePhysics
from muster_studies.thesis_6.pictures import FIGURES
from muster_studies.thesis_6.routes import RobotUsages
from muster_studies.thesis_6.totals import SystemTotals

_TABLES: tuple[Reproduction[Flight, FlightResult], ...] = (
    RobotUsages("6.2"),
    SystemTotals("6.3", "6.2"),
    RobotUsages("6.6"),
    SystemTotals("6.7", "6.6"),
    RobotUsages("6.8"),
    RobotUsages("6.9"),
    SystemTotals("6.10", "6.8"),
    SystemTotals("6.11", "6.9"),
    ActionPaths(),
    BesidePhysics(),
    ByLaw(),
    UsageUnderNoise(),
    MisalignedMarkers(),
    CapacityReserve(),
)

THESIS_6 = Repetition(
    **description("thesis-6"),
    reproductions=_TABLES,
    perform=one_by_one(fly),
    figures=FIGURES,
)
"""What plans cost when robots carry them out: calculated, in Gazebo, in truth, and here."""
