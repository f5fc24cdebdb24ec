"""A bus in one process, in simulated time: what participants write, all readers of the topic get."""

from muster.mission.system.clock import VirtualClock

STEP_S = 0.1


class Reader:
    def __init__(self):
        self.heard = []

    def take(self):
        taken, self.heard = self.heard, []
        return taken


class Writer:
    def __init__(self, bus, topic):
        self._bus, self._topic = bus, topic

    @property
    def listeners(self):
        return len(self._bus.readers.get(self._topic, ()))

    def write(self, message):
        for reader in self._bus.readers.get(self._topic, ()):
            reader.heard = [*reader.heard[-20:], message]


class Participant:
    """A middleware on the bus; that of Muster lets time pass when it waits."""

    def __init__(self, bus, *, moves):
        self._bus, self._moves, self._own = bus, moves, []

    def reader(self, topic, _):
        reader = Reader()
        self._own.append((topic, reader))
        self._bus.readers.setdefault(topic, []).append(reader)
        return reader

    def others(self, topic, _):
        return None

    def writer(self, topic, _):
        return Writer(self._bus, topic)

    def topics(self):
        return []

    def wait(self, seconds):
        if self._moves:
            self._bus.go_on(seconds)

    def close(self):
        for topic, reader in self._own:
            self._bus.readers[topic].remove(reader)


class Bus:
    """The bus, and the simulated robots on it, which move as time passes."""

    def __init__(self):
        self.clock, self.readers, self.robots = VirtualClock(), {}, []

    def participant(self, *, moves=False):
        return Participant(self, moves=moves)

    def go_on(self, seconds):
        """Let at least one step pass."""
        for _ in range(max(1, round(seconds / STEP_S))):
            self.clock.advance(STEP_S)
            for robot in self.robots:
                robot.step(self.clock.now(), STEP_S)
