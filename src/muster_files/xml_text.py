"""XML as text: built by the standard library, with characters that XML 1.0 cannot hold replaced."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Any
from xml.etree import ElementTree as Tree

_NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What is no Char of XML 1.0, section 2.2."""


def add(parent: Tree.Element, tag: str, text: object = None, **attributes: Any) -> Tree.Element:
    """Add a last child with this text."""
    child = Tree.SubElement(parent, tag, {name: str(value) for name, value in attributes.items()})
    if text is not None:
        child.text = _NOT_XML.sub("\ufffd", decimal(text) if isinstance(text, float) else str(text))
    return child


def decimal(number: float) -> str:
    """A number as `xsd:decimal`, which has no exponent; to nine places."""
    return f"{number:.9f}".rstrip("0").rstrip(".")


def time_text(moment: datetime) -> str:
    """A moment in UTC as `xsd:dateTime`."""
    return moment.strftime("%Y-%m-%dT%H:%M:%S.") + f"{moment.microsecond // 1000:03d}Z"


def text_of(root: Tree.Element) -> str:
    """The document, indented, with its declaration."""
    Tree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + Tree.tostring(root, encoding="unicode") + "\n"
