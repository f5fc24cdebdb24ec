"""The interface of generators: a family of random missions, with the parameters that its missions share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from typing import Any

from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Mission
from muster.mission.source import IN_PYTHON
from muster.mission.value_types import shown
from muster.mission.values.keywords import require_known

LARGEST_SEED = 2**64 - 1
MOST_TASKS = 1_000_000
MOST_ROBOTS = 100_000


@dataclass(frozen=True, kw_only=True)
class Generator:
    """A family of random missions.

    Parameters
    ----------
    name
        how it is asked for.
    summary
        one line of what its missions are.
    source
        where it comes from: a publication, or what in Muster uses it.
    parameters
        a frozen, keyword-only dataclass with a default for each field, which checks itself when it is made: a class of
        `muster.mission.records`, whose fields say what they mean, or any other. Those that are whole numbers, numbers,
        words or truth values, by their default, are options of `muster generate`.
    make
        the mission for parameters and a seed. It draws random numbers from the seed alone, and rounds what it computes
        by functions whose last digit differs between machines.
    """

    name: str
    summary: str
    source: str
    parameters: type[Any]
    make: Callable[[Any, int], Mission]

    def __post_init__(self) -> None:
        if not is_dataclass(self.parameters):
            raise ParameterError(f"parameters: {shown(self.parameters)}; expected a dataclass")
        for f in fields(self.parameters):
            if f.default is MISSING and f.default_factory is MISSING:
                raise ParameterError(f"parameter {f.name}: no default; expected one for each")

    def with_values(self, values: Mapping[str, Any]) -> Any:
        """The parameters, with the values given by name.

        Raises
        ------
        ParameterError
            for a name that the family does not have, or a value out of range.
        """
        require_known(values, [f.name for f in fields(self.parameters)], self.name)
        try:
            return self.parameters(**values)
        except MissionError as error:
            wrong = "; ".join(f"{one.field}: {one.value}, expected {one.expected}" for one in error.findings)
            raise ParameterError(f"{self.name}: {wrong}") from None

    def mission(self, seed: int = 0, **values: Any) -> Mission:
        """The mission of a seed; its name says the family, how many tasks and robots it has, and the seed.

        Raises
        ------
        ParameterError
            as `with_values` does; for a seed that is no whole number from 0 to 2**64 - 1.
        """
        require_seed(seed)
        made = self.make(self.with_values(values), seed)
        name = f"{self.name}-{len(made.tasks)}T-{len(made.robots)}R-{seed}"
        return replace(made, name=name, source=IN_PYTHON)


def require_seed(seed: object) -> None:
    """Refuse what is no seed.

    Raises
    ------
    ParameterError
    """
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed <= LARGEST_SEED:
        raise ParameterError(f"seed: {shown(seed)}; expected a whole number from 0 to 2**64 - 1")
