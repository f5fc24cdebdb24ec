"""A process that dies at a chosen operation: what it has not synced is lost, and it says nothing more to robots."""

from muster.running.journal_file import JournalFile


class Killed(BaseException):
    """The process is no more."""


class Reaper:
    """Kills at the operation `at`; None: never. Operations are lines and syncs of the journal, orders and steps."""

    def __init__(self, draw, at=None, *, power_cut=False):
        self.draw, self.left, self.power_cut = draw, at, power_cut
        self.dead, self.operations = False, 0

    def step(self, on_death=lambda: None):
        """One operation: it may be the last, in the middle of which `on_death` is called."""
        if self.dead:
            raise Killed
        self.operations += 1
        if self.left is not None:
            self.left -= 1
            if self.left < 0:
                self.dead = True
                on_death()
                raise Killed


class MortalFile(JournalFile):
    """A journal whose process dies. After a power cut a part of what was not synced is lost."""

    def __init__(self, reaper, path, header, whole_bytes=0):
        self._reaper = reaper
        super().__init__(path, header, whole_bytes)
        self._synced = path.stat().st_size

    def append(self, line):
        before = self.path.stat().st_size

        def torn():
            super(MortalFile, self).append(line)
            self._cut(self._reaper.draw.randint(before, self.path.stat().st_size))

        self._reaper.step(torn)
        super().append(line)

    def sync(self):
        self._reaper.step(lambda: self._cut(self.path.stat().st_size))
        super().sync()
        self._synced = self.path.stat().st_size

    def close(self):
        if not self._reaper.dead:
            super().close()

    def remove(self):
        raise AssertionError("the journal can be written")

    def _cut(self, size):
        """What the disk has: all that was written, or after a power cut some of what was not synced."""
        least = max(self._synced, 1) if self._reaper.power_cut else size
        with self.path.open("r+b") as file:
            file.truncate(self._reaper.draw.randint(min(least, size), size))


class MortalPort:
    def __init__(self, port, reaper):
        self._port, self._reaper = port, reaper

    @property
    def robot(self):
        return self._port.robot

    def telemetry(self):
        return self._port.telemetry()

    def send(self, waypoints):
        self._reaper.step()
        order = self._port.send(waypoints)
        self._reaper.step()
        return order

    def cancel(self):
        self._reaper.step()
        return self._port.cancel()


class MortalFleet:
    """A fleet of a process that dies; afterwards it reaches nobody any more."""

    def __init__(self, fleet, reaper):
        self.fleet, self._reaper = fleet, reaper

    def __getattr__(self, name):
        return getattr(self.fleet, name)

    @property
    def ports(self):
        return {name: MortalPort(port, self._reaper) for name, port in self.fleet.ports.items()}

    def advance(self, until_s):
        self._reaper.step()
        return self.fleet.advance(until_s)

    def stop(self):
        if not self._reaper.dead:
            self.fleet.stop()
