"""States of a negotiator as plain values: a canonical form that tells states apart, and a stored form to go on from."""

import io
import pickle

from muster_team.auctions.epoch import opening_of
from muster_team.knowledge.epoch_base import Base
from muster_team.knowledge.messages import Claim, Declaration, Fact, RoundBids, Sold, Stage

NO_STATE = frozenset(
    {
        "rules",  # the same for all states of a robot
        "valuer",  # follows from the last base and what was sold on it
        "timeouts",
        "signatures",
        "counts",  # what was sent and refused is counted, and never read
        "notices",  # are told, and never acted on
        "remembered",  # is read at the start alone
        "_before",
        "say",
        "_deeds_at",  # caches of what follows from the facts
        "_deeds_found",
        "_looked_at",
        "past",  # is told in views
        "together",
    }
)
"""Attributes that do not decide what a negotiator does next."""

_WORDS = {Claim, Declaration, Fact, RoundBids, Sold, Stage}
_PLAIN = (str, bytes, bool, int, float, type(None))


def canonical(value):
    """The value as nested tuples: equal for equal states, whatever the order of sets and dictionaries.

    The core reads its dictionaries by key, or in an order that it states itself; so their order is no part of a state.
    """
    if isinstance(value, _PLAIN):
        return value
    if isinstance(value, Base):
        return value.digest, tuple(value.routes.items())
    if getattr(type(value), "__slots__", None):  # a frozen word of the protocol
        return value
    if isinstance(value, dict):
        return tuple(sorted(((canonical(k), canonical(v)) for k, v in value.items()), key=lambda item: repr(item[0])))
    if isinstance(value, set | frozenset):
        return tuple(sorted(map(canonical, value), key=repr))
    if isinstance(value, list | tuple):
        return tuple(map(canonical, value))
    return (type(value).__name__, *((k, canonical(v)) for k, v in vars(value).items() if k not in NO_STATE))


def state_of(node):
    """The canonical form of a negotiator. Of the epochs that it has left the last one with a base counts."""
    last = node.latest
    past = None if last is None or last is node.epoch else (last.base.digest, tuple(last.sales))
    attributes = ((k, canonical(v)) for k, v in vars(node).items() if k not in NO_STATE and k != "latest")
    return (*attributes, past, last is node.epoch)


class Store:
    """The stored forms of the negotiators of one robot.

    Parameters
    ----------
    make
        makes a negotiator of the robot, which brings what all of its states have in common.
    """

    def __init__(self, make):
        self._make, self._shared = make, {}
        self._valuers = {}  # those at hand, by what they have seen
        self._words, self._numbers = [], {}  # what robots have said, which many states contain

    def fresh(self, **how):
        """A negotiator that has not started."""
        node = self._make(**how)
        self._shared = {"timeouts": node.timeouts, "signatures": node.signatures, "rules": node.rules}
        return node

    def stored(self, node):
        """The negotiator as bytes; its valuer is kept for whoever needs one that has seen the same."""
        node.past.clear()
        node.notices.clear()
        node.remembered = None
        file = io.BytesIO()
        names = {id(value): name for name, value in self._shared.items()} | {id(node.valuer): "valuer"}
        _Pickler(file, names, self._number).dump(node)
        self._valuers[_seen(node)] = node.valuer
        return file.getvalue()

    def loaded(self, stored):
        """The negotiator of these bytes, with a valuer of its own."""
        node = _Unpickler(io.BytesIO(stored), self._shared, self._words).load()
        valuer = self._valuers.pop(_seen(node), None) or self._valuer_of(node)
        node.valuer = valuer
        node.epoch.valuer = valuer
        if node.latest is not None:
            node.latest.valuer = valuer
        return node

    def _number(self, word):
        if word not in self._numbers:
            self._numbers[word] = len(self._words)
            self._words.append(word)
        return self._numbers[word]

    def _valuer_of(self, node):
        valuer = self._make(incarnation=1).valuer
        if node.latest is not None:
            valuer.begin(opening_of(node.latest.base))
            for sold in node.latest.sales:
                valuer.award(sold)
        return valuer


def _seen(node):
    """What the valuer of a negotiator has seen: the last base, and what was sold on it."""
    last = node.latest
    return None if last is None else (last.base.digest, tuple(last.base.routes.items()), tuple(last.sales))


class _Pickler(pickle.Pickler):
    def __init__(self, file, names, number_of):
        super().__init__(file, 5)
        self._names, self._number_of = names, number_of

    def persistent_id(self, value):
        return self._number_of(value) if type(value) in _WORDS else self._names.get(id(value))


class _Unpickler(pickle.Unpickler):
    def __init__(self, file, shared, words):
        super().__init__(file)
        self._shared, self._words = shared, words

    def persistent_load(self, name):
        return self._words[name] if type(name) is int else self._shared.get(name)
