"""No function has more than twelve parameters: beyond that they are the fields of a request or a record."""

import ast
from pathlib import Path

import muster

MOST = 12
MORE = {
    "muster/execution/executor.py:__init__": "the parts of a run that is assembled in two places, each by its name",
    "muster/simulation/world_base.py:__init__": "what makers of worlds are called with, each by its name",
    "muster/planning/solve.py:solve": "users pass the options of planning beside any parameter of the allocator",
}
"""Functions that have more, and why."""
SOURCES = Path(muster.__file__).parents[1]


def functions():
    """The functions of all sources, with their files."""
    for file in sorted(SOURCES.glob("muster*/**/*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield file.relative_to(SOURCES).as_posix(), node


def is_verb(node):
    """Whether the parameters of a function are the options of the command."""
    return any(ast.unparse(decorator).startswith("click.command(") for decorator in node.decorator_list)


def parameters(node):
    every = node.args
    named = [each.arg for each in (*every.posonlyargs, *every.args, *every.kwonlyargs)]
    return len([name for name in named if name not in ("self", "cls")]) + bool(every.vararg) + bool(every.kwarg)


def test_no_function_has_more_than_twelve_parameters():
    found = {f"{file}:{node.name}" for file, node in functions() if parameters(node) > MOST and not is_verb(node)}
    assert found == MORE.keys()
