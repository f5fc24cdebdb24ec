"""Faults planted into the protocol: a campaign that is worth anything finds them."""

import inspect
import sys
from importlib import import_module
from types import CodeType, FunctionType, ModuleType


def plant(monkeypatch, name, right, wrong):
    """Let the functions of a module (by its path in `muster_team`) do what they did if this line of it were another."""
    module = import_module(f"muster_team.{name}")
    source = inspect.getsource(module)
    assert source.count(right) == 1, right
    mutant = ModuleType(module.__name__)
    with monkeypatch.context() as there:
        there.setitem(sys.modules, module.__name__, mutant)  # where its dataclasses look for their types
        exec(compile(source.replace(right, wrong), module.__file__, "exec"), mutant.__dict__)
    twins = list(zip(_functions(module, module.__file__), _functions(mutant, module.__file__), strict=True))
    changed = [(one, twin.__code__) for one, twin in twins if _said(one.__code__) != _said(twin.__code__)]
    assert changed, wrong
    for function, code in changed:
        monkeypatch.setattr(function, "__code__", code)


def _functions(module, file):
    """All that the module has written itself, in order."""
    for thing in list(vars(module).values()):
        if getattr(thing, "__module__", None) == module.__name__:
            for one in vars(thing).values() if inspect.isclass(thing) else (thing,):
                function = getattr(one, "fget", None) or getattr(one, "__func__", one)
                if isinstance(function, FunctionType) and function.__code__.co_filename == file:
                    yield function


def _said(code):
    """What a function does, wherever it stands."""
    return code.co_code, code.co_names, [_said(c) if isinstance(c, CodeType) else c for c in code.co_consts]
