"""The messages of a team as one of its robots hears them, and what it makes of them: mutated, and sealed as its own."""

from collections import defaultdict, deque

import msgpack
from tests.muster_team.byzantine.mutations import mutated_bytes
from tests.muster_team.byzantine.trial import LIAR, signed
from tests.muster_team.mutated.sealed_robots import CONTEXT, KEY

from muster_team.network.codec import PROTOCOL
from muster_team.network.encryption import Seal
from muster_team.network.peer_sessions import PeerSessions
from muster_team.network.plain_values import MalformedError
from muster_team.network.robot_keys import PROOF_BYTES

_RECENT, _OWN, _ARCHIVE = 8, 6, 400  # messages with a field, of the liar, and of all
_STATED = {4, 5, 6, 11, 15}  # the fields of declarations, bids, sales, facts and evidence, which are taken more often


class Mouth:
    """Hears all messages of a team, and says mutated ones with a valid seal and the proofs of one robot."""

    def __init__(self, codec, keys, robots, random):
        self._codec, self._keys, self._random = codec, keys, random
        self._me = robots.index(LIAR)
        self._ear = Seal(KEY, CONTEXT, "ear", 0)
        self.sessions = PeerSessions(Seal(KEY, CONTEXT, LIAR, 1))
        self._recent = defaultdict(lambda: deque(maxlen=_RECENT))
        self._own = deque(maxlen=_OWN)
        self._archive = deque(maxlen=_ARCHIVE)
        self._number = 0

    def hear(self, sealed):
        """Remember a message that is on its way."""
        opened = self._ear.open_from(sealed)
        if opened is None or opened[1][:1] != b"\0":  # a greeting
            return
        said = opened[1][1:]
        data = said[PROOF_BYTES:]
        plain = msgpack.unpackb(data[1:])
        self._archive.append(said)
        for number in plain[4::2]:
            self._recent[number].append(said)
        if plain[0] == self._me:
            self._own.append(said)

    def word(self, incarnation=1):
        """A sealed message: mutated, or as it was, from now or long ago, in the liar's name or another's.

        `incarnation`: that of the liar which the listener knows; an earlier one it would not listen to.
        """
        draw = self._random.random
        said = self._random.choice(self._source())
        if draw() < 0.03:
            return self.sessions.close(said)  # played back, in another order
        data = said[PROOF_BYTES:]
        if draw() < 0.9:
            data = self._as_own(data, incarnation)
        data = mutated_bytes(data, self._random, 1 if draw() < 0.8 else self._random.randint(2, 4))
        if draw() < 0.8:
            data = self._with_proofs(data)
        return self.sessions.close(self._keys.proof_of(data) + data)

    def _source(self):
        draw = self._random.random()
        if draw < 0.3 and self._own:
            return self._own
        if draw > 0.9:
            return self._archive
        stated = [number for number in self._recent if number in _STATED or draw > 0.8]
        return self._recent[self._random.choice(stated)]

    def meet(self, robot, now):
        """Prove the liar's session to a process that has just begun."""
        for greeting in robot.step(now, self.sessions.close(self._archive[-1])):
            self.sessions.open(greeting.message)
        robot.step(now, *self.sessions.greetings(now, 60_000))

    def _as_own(self, data, incarnation):
        """A message as the liar would pass it on."""
        plain = msgpack.unpackb(data[1:])
        self._number += 1
        plain[:3] = [self._me, incarnation, 10_000 + self._number]
        return bytes((PROTOCOL,)) + msgpack.packb(plain)

    def _with_proofs(self, data):
        """The message with proofs of what the liar states in it, if it is one."""
        try:
            return self._codec.encode(signed(self._codec.decode(data), self._keys))
        except MalformedError:
            return data
