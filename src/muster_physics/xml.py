"""Elements of MuJoCo's XML (MJCF), with numbers as text."""

from __future__ import annotations

from xml.etree import ElementTree as ET


def add(parent: ET.Element, tag: str, **values: object) -> ET.Element:
    """Add an element; a tuple is its numbers."""
    return ET.SubElement(parent, tag, {name: _text(value) for name, value in values.items()})


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return " ".join(repr(float(number)) for number in value)
    return str(value)
