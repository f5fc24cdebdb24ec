"""The study: its tables, its legend, how its runs are made, and its pictures."""

from __future__ import annotations

from muster_studies.descriptions import description
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rvo.pictures import FIGURES
from muster_studies.rvo.results import LEGEND, Circle, Found, Published
from muster_studies.rvo.runs import Job

_TABLES: tuple[Reproduction[Job, Found], ...] = (Published("A.17"), Published("A.22"), Circle())

RVO = Repetition(
    **description("rvo", LEGEND),
    reproductions=_TABLES,
    perform=one_by_one(lambda job: Found.of(job.perform())),
    figures=FIGURES,
)
"""Reciprocal velocity obstacles, and what came after them; Figures A.4 to A.9 and A.15 to A.17."""
