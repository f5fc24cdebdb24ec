"""Axes on a figure of their own that a notebook shows as a picture: their figure is not known to pyplot."""

from __future__ import annotations

from io import BytesIO
from typing import Any

from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D


class _Picture:
    figure: Any

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.figure.savefig(picture, format="png")
        return picture.getvalue()


class PictureAxes(_Picture, Axes):
    """Axes in the plane."""


class PictureAxes3D(_Picture, Axes3D):  # type: ignore[misc]
    """Axes in space."""
