"""Objects for other processes: by the name of their module where that can be imported, else by value."""

from __future__ import annotations

import io
import pickle
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from types import FunctionType
from typing import Any

from muster.mission.errors import MissingExtraError, ParameterError


def packed(what: Any) -> bytes:
    """An object in bytes, for `pickle.loads` in another process.

    What is defined in a notebook or script goes by value.

    Raises
    ------
    MissingExtraError
        if that needs cloudpickle, which is not installed.
    ParameterError
        if it cannot be sent at all.
    """
    data = io.BytesIO()
    pickler = _Pickler(data, pickle.HIGHEST_PROTOCOL)
    by_name = True
    try:
        pickler.dump(what)
    except Exception:  # a local function, a lambda, a class made by a function
        by_name = False
    local = sorted(module for module in pickler.modules if not _importable(module))
    return data.getvalue() if by_name and not local else _by_value(what, local)


class _Pickler(pickle.Pickler):
    """Notes the modules of functions and classes."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.modules: set[str] = set()

    def reducer_override(self, obj: Any) -> Any:
        if isinstance(obj, type | FunctionType) and obj.__module__:
            self.modules.add(obj.__module__)
        return NotImplemented


def _by_value(what: Any, modules: Sequence[str]) -> bytes:
    try:
        import cloudpickle
    except ImportError:
        how = "pip install 'muster-robotics[compare]'; or jobs=1, in this process"
        raise MissingExtraError("compare", "an allocator of a notebook or script in several processes", how) from None
    here = [sys.modules[name] for name in modules if name != "__main__" and name in sys.modules]
    for module in here:
        cloudpickle.register_pickle_by_value(module)
    try:
        return bytes(cloudpickle.dumps(what))
    except Exception as error:  # whatever an object of somebody else does
        said = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise ParameterError(f"allocators: {said}; expected what another process can be sent, or jobs=1") from None
    finally:
        for module in here:
            cloudpickle.unregister_pickle_by_value(module)


def _importable(module: str) -> bool:
    """Whether another process can import a module of that name."""
    if module == "__main__":
        return False
    try:
        return find_spec(module) is not None
    except (ImportError, ValueError):  # a module without a specification was made by a program
        return False
