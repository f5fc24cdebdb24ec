"""Every exception that Muster raises on purpose.

    MusterError
    ├── InputError            something that came from outside is wrong; carries all findings
    │   ├── MissionError      a mission, from a file or built in Python
    │   └── PlanError         a plan file
    ├── NotSupportedError     the mission is right, but asks for what this version cannot do
    ├── IncompletePlanError   a plan that leaves tasks out is not carried out where all are asked for
    │   └── CutShortError     a plan that planning did not finish is not carried out unless that is accepted
    ├── ParameterError        a parameter of an algorithm or function is out of its range
    ├── PluginError           a package that extends Muster cannot be used
    ├── TransformError        the tree of frames cannot say where a frame is
    │   ├── UnknownFrameError, DisconnectedFramesError
    │   ├── ExtrapolationError   not at that time
    │   └── FrameTreeError       what was to be added would be no tree
    ├── NetworkError          the network cannot be used as asked: a port in use, a host that nobody knows
    ├── RenderingError        nothing here can draw pictures of the physics world
    ├── PlatformError         what is asked for works on other systems
    └── MissingExtraError     an optional part of the installation is absent

Outcomes that are to be expected (nobody can do a task, no admissible plan) are values, not exceptions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass


class MusterError(Exception):
    """Base of all exceptions that Muster raises on purpose."""


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with an input, and where.

    `line` counts from 1 and is None where there are no lines (a mission built in Python).
    """

    file: str
    line: int | None
    field: str
    value: str
    expected: str

    @property
    def place(self) -> str:
        return self.file if self.line is None else f"{self.file}:{self.line}"

    def __str__(self) -> str:
        subject = f"{self.field}: " if self.field else ""
        text = f"{self.place}: {subject}{self.value}; expected {self.expected}"
        return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)

    def as_dict(self) -> dict[str, str | int | None]:
        return asdict(self)


class InputError(MusterError):
    """An input is wrong. `findings` holds everything that was found, in the order of the file."""

    def __init__(self, findings: Sequence[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(str(finding) for finding in self.findings))


class MissionError(InputError):
    """A mission is wrong."""


class PlanError(InputError):
    """A plan file is wrong."""


class NotSupportedError(InputError):
    """The mission is right, but asks for what this version of Muster cannot do."""


class IncompletePlanError(MusterError):
    """A plan that leaves tasks out is not carried out where all are asked for."""


class CutShortError(IncompletePlanError):
    """A plan was cut short by its time limit, and is not carried out unless that is accepted."""


class ParameterError(MusterError, ValueError):
    """A parameter of an algorithm or function is out of its range."""


class PluginError(MusterError):
    """A package that extends Muster cannot be used; the message names the package and what is wrong with it."""


class TransformError(MusterError):
    """The tree of frames does not connect two frames, or refuses a transform."""


class UnknownFrameError(TransformError):
    """No frame has this name."""


class DisconnectedFramesError(TransformError):
    """No chain of parents joins two frames."""


class ExtrapolationError(TransformError):
    """A transform is not known at the time asked for; the message names the interval in which it is."""


class FrameTreeError(TransformError):
    """A transform would make a cycle or a second parent, or change what is static."""


class NetworkError(MusterError):
    """The network cannot be used as asked; the message names the address, and what to do."""


class RenderingError(MusterError):
    """Nothing here can draw pictures of the physics world; the message says what to install."""


class PlatformError(MusterError):
    """What is asked for does not work on this operating system; the message says on which it does."""


class MissingExtraError(MusterError, ImportError):
    """An optional part of the installation is absent; the message says what to install."""

    def __init__(self, extra: str, purpose: str, how: str = "") -> None:
        super().__init__(f"{purpose} needs an optional part: " + (how or f"pip install 'muster-robotics[{extra}]'"))
