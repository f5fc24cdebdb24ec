"""Run the command as if only Muster's core and some extras were installed: `python partial_install.py EXTRAS CALL...`.

EXTRAS is a list such as `physics,plot`, or empty; each CALL is a JSON list of arguments, or a JSON text: statements of
Python that make smaller what follows. Calls run in this process, one after the other; the result is one line of JSON
for each list: exit code, standard output and standard error. Of modules that
no distribution owns only those of the standard library are seen, so ROS 1, which the system installs, is absent.
"""

import json
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from importlib.metadata import PackageNotFoundError, distribution, packages_distributions
from io import StringIO

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

OWN = "muster-robotics"


def closure(name: str, extras: Sequence[str]) -> set[str]:
    """The distributions that installing this one with these extras installs, by their normalised names."""
    found: set[tuple[str, str]] = set()
    waiting = [(name, extra) for extra in ("", *extras)]
    while waiting:
        name, extra = waiting.pop()
        try:
            requirements = distribution(name).requires or []
        except PackageNotFoundError:
            continue
        for requirement in map(Requirement, requirements):
            if requirement.marker is None or requirement.marker.evaluate({"extra": extra}):
                named = [(canonicalize_name(requirement.name), more) for more in ("", *requirement.extras)]
                waiting += [pair for pair in named if pair not in found]
                found.update(named)
    return {name for name, _ in found} | {OWN}


class OnlyInstalled:
    """The finder of modules that sees the standard library and these distributions alone."""

    def __init__(self, allowed: set[str]) -> None:
        self._allowed, self._finders = allowed, list(sys.meta_path)
        self._owners = packages_distributions()

    def _sees(self, module: str) -> bool:
        top = module.partition(".")[0]
        if owners := self._owners.get(top):
            return any(canonicalize_name(owner) in self._allowed for owner in owners)
        return top in sys.stdlib_module_names or top.startswith(("_", "muster"))

    def find_spec(self, name, path=None, target=None):
        if not self._sees(name):
            return None
        specs = (finder.find_spec(name, path, target) for finder in self._finders if hasattr(finder, "find_spec"))
        return next((spec for spec in specs if spec is not None), None)

    def find_distributions(self, context):
        for finder in self._finders:
            for found in getattr(finder, "find_distributions", lambda _: ())(context):
                if canonicalize_name(found.name) in self._allowed:
                    yield found


def main(extras: str, *calls: str) -> None:
    finder = OnlyInstalled(closure(OWN, extras.split(",") if extras else ()))
    for module in [name for name in sys.modules if not finder._sees(name)]:
        del sys.modules[module]
    sys.meta_path[:] = [finder]
    from muster.cli.main import run

    for call in map(json.loads, calls):
        if isinstance(call, str):
            exec(call, {})
            continue
        out, err = StringIO(), StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = run(call)
        sys.stdout.write(json.dumps([code, out.getvalue(), err.getvalue()]) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
