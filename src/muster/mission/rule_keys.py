"""What bears keys of rules that packages bring, beside its own: robots, tasks, and the rules of a mission."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self, TypeVar

from muster.mission.declared_rules import Bearer, keys_beside
from muster.mission.errors import PluginError
from muster.mission.records import Checked, checks_of, key_of, part_of, read_further, specified
from muster.mission.value_types import Fault, Key, shown
from muster.mission.values.keywords import require_known

K = TypeVar("K", bound=Checked)
_BEARERS: dict[type[Any], Bearer] = {}


@dataclass(frozen=True, kw_only=True)
class RuleKeys(Checked):
    """Base of classes that bear keys of rules. In files these stand beside the others, in Python they are `extra`."""

    extra: Mapping[str, Any] = field(
        default_factory=dict, hash=False, metadata={"doc": "by key what it says by rules of other packages"}
    )

    def __init_subclass__(cls, bearer: Bearer | None = None) -> None:
        if bearer is not None:
            _BEARERS[cls] = bearer

    def __post_init__(self) -> None:
        if self.extra:  # few have any
            known, faults = self.further_keys({}), list[Fault]()
            expected = f"a key of a rule: {', '.join(known) or 'no package that brings one is installed'}"
            faults += [Fault((key,), shown(value), expected) for key, value in self.extra.items() if key not in known]
            object.__setattr__(self, "extra", read_further(type(self), self.extra, (), faults))
            if faults:
                raise self.refusal(faults)
        super().__post_init__()

    def changed(self, **values: Any) -> Self:
        """Return a copy in which some fields but `extra` have other values.

        It equals that of `dataclasses.replace` and takes a fraction of the time: fields that stay were checked before.
        """
        require_known(values, [name for name in self.__dataclass_fields__ if name != "extra"], self.called())
        copy = object.__new__(type(self))
        kept = (name for name in self.__dataclass_fields__ if name in self.__dict__)  # nothing that was derived
        copy.__dict__.update({name: self.__dict__[name] for name in kept}, **values)
        copy._check(check for check in checks_of(type(self)) if check.name in values)
        return copy

    def value(self, key: str) -> Any:
        """The value of a key, its own or one of a rule; None where nothing is said."""
        return self.extra[key] if key in self.extra else getattr(self, key, None)

    def states(self, key: str) -> bool:
        """Whether a key, its own or one of a rule, has another value than its default."""
        own = self.__dataclass_fields__.get(key)
        return key in self.extra if own is None else getattr(self, key) not in (own.default, {})

    def keys_of(self, rule: type[K]) -> K:
        """What it says by the keys of a rule: an instance of the class that the rule declares, with its defaults."""
        return part_of(rule, self.extra)

    @classmethod
    def beside(cls) -> tuple[type[Checked], ...]:
        return keys_beside(next(_BEARERS[of] for of in cls.__mro__ if of in _BEARERS))

    @classmethod
    def further_keys(cls, data: Mapping[Any, Any]) -> Mapping[str, Key]:
        if cls not in _FURTHER:  # looked up for each record that is read
            _FURTHER[cls] = _further(cls)
        return _FURTHER[cls]


_FURTHER: dict[type[Any], Mapping[str, Key]] = {}


def _further(cls: type[RuleKeys]) -> Mapping[str, Key]:
    """The keys of rules.

    Raises
    ------
    PluginError
        if one stands twice, or is a key already.
    """
    taken, found = set(map(key_of, specified(cls))), dict[str, Key]()
    for part in cls.beside():
        for f in specified(part):
            if key_of(f) in taken:
                raise PluginError(
                    f"rule with keys {part.__name__}: {key_of(f)}; expected a key that {cls.__name__} has not"
                )
            taken.add(key_of(f))
            found[key_of(f)] = Key(f.metadata["kind"], f.metadata["doc"])
    return found
