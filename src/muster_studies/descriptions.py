"""What each study is, in words, and the captions of its figures: the content of `descriptions.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import TypedDict

import msgspec

from muster_studies.figures import Draw, StudyFigure


class Description(TypedDict):
    """The words of a study, as `Repetition` takes them."""

    name: str
    summary: str
    document: str
    legend: tuple[str, ...]


class _Caption(msgspec.Struct, forbid_unknown_fields=True):
    source: str
    shows: str
    tables: tuple[str, ...]
    differs: str = ""


class Comparison(msgspec.Struct, forbid_unknown_fields=True):
    """The texts of a study as a verb of `muster bench`: what `--quick` does, its tables if several, and the help."""

    quick: str
    help: str
    tables: str | None = None


class _Study(msgspec.Struct, forbid_unknown_fields=True):
    summary: str
    document: str
    legend: tuple[str, ...] = ()
    figures: dict[str, _Caption] = {}
    comparison: Comparison | None = None


def description(study: str, legend: tuple[str, ...] = ()) -> Description:
    """Return the words of a study, by its name; `legend` follows the lines that the file has."""
    words = _studies()[study]
    lines = (*words.legend, *legend)
    return {"name": study, "summary": words.summary, "document": words.document, "legend": lines}


def captioned(study: str, drawings: Mapping[str, Draw]) -> tuple[StudyFigure, ...]:
    """Return the figures of a study in the order of their captions.

    Parameters
    ----------
    study : str
        Name of the study.
    drawings : Mapping[str, Draw]
        By number of a figure the function that draws it.

    Raises
    ------
    ValueError
        If a figure has no caption, or a caption no figure.
    """
    captions = _studies()[study].figures
    if captions.keys() != drawings.keys():
        raise ValueError(f"{study}: figures {sorted(drawings)}; expected those with captions, {sorted(captions)}")
    return tuple(
        StudyFigure(number=number, draw=drawings[number], **msgspec.structs.asdict(caption))
        for number, caption in captions.items()
    )


def comparisons() -> dict[str, Comparison]:
    """Return the texts of the studies that `muster bench` has too, by name."""
    return {name: words.comparison for name, words in _studies().items() if words.comparison is not None}


@cache
def _studies() -> dict[str, _Study]:
    text = (files("muster_studies") / "descriptions.yaml").read_bytes()
    return msgspec.yaml.decode(text, type=dict[str, _Study])
