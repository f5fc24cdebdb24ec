"""Robots as their processes run them, in a simulated network: node, codec, seal and keys, and bytes on the way."""

from dataclasses import replace
from hashlib import blake2b
from hmac import compare_digest

from tests.muster_team.byzantine.trial import secret

from muster.mission.system.clock import VirtualClock
from muster_team.knowledge.effects import Outgoing
from muster_team.knowledge.signatures import Signatures, statement_bytes
from muster_team.network.encryption import Seal
from muster_team.network.peer_sessions import PeerSessions
from muster_team.network.robot_keys import PROOF_BYTES
from muster_team.processes.node import Node

KEY, CONTEXT = bytes(range(32)), b"a mission"


class HashKeys(Signatures):
    """Keys of robots by keyed hashes, which take a tenth of the time of Ed25519. Tests know the keys of all."""

    has_keys = True
    team = b"a team"

    def __init__(self, robot, robots):
        self._robot, self._robots = robot, robots

    def sign(self, statement, context=b""):
        return replace(statement, proof=self.proof_of(statement_bytes(statement, context)))

    def holds(self, statement, context=b""):
        return self.proves(statement.robot, statement.proof, statement_bytes(statement, context))

    def proof_of(self, data):
        return _hash(self._robot, data)

    def proves(self, robot, proof, data):
        return robot in self._robots and compare_digest(_hash(robot, data), proof)


def _hash(robot, data):
    return blake2b(data, key=secret(robot), digest_size=PROOF_BYTES).digest()


class SealedRobot:
    """A robot for `MemoryNetwork` whose messages are sealed bytes. Else it is its negotiator."""

    def __init__(self, negotiator, codec):
        self.clock, self.wire = VirtualClock(), _Wire()
        self.seal = Seal(KEY, CONTEXT, negotiator.robot, negotiator.incarnation)
        self.node = Node(negotiator, self.wire, codec, self.seal, self.clock)

    @property
    def negotiator(self):
        return self.node.negotiator

    def __getattr__(self, name):
        return getattr(self.node.negotiator, name)

    def start(self, now):
        self.clock.advance(now - self.clock.now())
        self.node.start()
        return self.wire.take()

    def handle(self, data, now):
        return self.step(now, data)

    def tick(self, now):
        return self.step(now)

    def step(self, now, *coming):
        """Let these bytes arrive, and time go by; what is to be sent."""
        self.clock.advance(max(0.0, now - self.clock.now()))
        self.wire.coming += coming
        self.node.step(0.0)
        return self.wire.take()

    def sealed(self, proof, data):
        """A message as this robot's process seals it, whatever it is."""
        return PeerSessions(self.seal).close(proof + data)


class _Wire:
    """A transport whose two ends the test has."""

    room, lost_here, bytes_sent = 60_000, 0, 0

    def __init__(self):
        self.coming, self._going = [], []

    def send(self, data, to=None):
        self._going.append(Outgoing(data, to))

    def receive(self, wait_s):
        came, self.coming = self.coming, []
        return came

    def take(self):
        going, self._going = self._going, []
        return going

    def close(self):
        pass
