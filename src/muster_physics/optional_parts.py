"""What the physics world needs of the installation: MuJoCo, and for pictures a library that draws without a screen."""

from __future__ import annotations

import ctypes
import os
import sys

from muster.mission.errors import ParameterError

BACKENDS = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}
"""How MuJoCo may draw without a screen, and the library of each; the first is the faster."""
_KNOWN = (
    *("", *BACKENDS, "glfw", "glx", "wgl", "cgl"),
    *("on", "true", "1", "enable", "enabled", "off", "false", "0", "disable", "disabled"),
)
"""What MuJoCo itself takes for `MUJOCO_GL`, on one system or another."""


def choose_backend() -> str | None:
    """Choose how MuJoCo renders, unless `MUJOCO_GL` says it; None where neither library is installed.

    MuJoCo reads `MUJOCO_GL` when it is imported: after that the choice is made.

    Raises
    ------
    ParameterError
        if `MUJOCO_GL` names one whose library is not there: MuJoCo could not be imported.
    """
    said = os.environ.get("MUJOCO_GL", "").lower().strip()
    if said not in _KNOWN:
        raise ParameterError(f"MUJOCO_GL: {said}; expected it unset, or one of {', '.join(filter(None, _KNOWN))}")
    if said in BACKENDS and not _is_there(BACKENDS[said]):
        raise ParameterError(
            f"MUJOCO_GL: {said}, but there is no {BACKENDS[said]}; expected it unset, or this installed"
        )
    if said or "mujoco" in sys.modules or not sys.platform.startswith("linux"):
        return said
    for backend, library in BACKENDS.items():
        if _is_there(library):
            os.environ["MUJOCO_GL"] = backend
            return backend
    return None


def _is_there(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
