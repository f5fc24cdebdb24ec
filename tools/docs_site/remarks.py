"""Takes the markers of the check of documents out of pages, which browsers would get else."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

_REMARKS = re.compile(r"\s*(<!--.*?-->\s*)+", re.DOTALL)


class WithoutRemarks(SphinxTransform):
    """Takes out raw HTML that is nothing but remarks."""

    default_priority = 200

    def apply(self, **_: Any) -> None:
        """What Sphinx calls for each page."""
        for raw in list(self.document.findall(nodes.raw)):
            if _REMARKS.fullmatch(raw.astext()):
                raw.parent.remove(raw)


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.add_transform(WithoutRemarks)
    return {"parallel_read_safe": True}
