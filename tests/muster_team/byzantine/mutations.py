"""Messages as a faulty program would send them: one value is another than it should be, and the codec reads it."""

import msgpack

from muster_team.network.codec import PROTOCOL, Codec
from muster_team.network.plain_values import MalformedError

LARGEST = 2**63 - 1
_FLOATS = (0.0, -1.0, 1e300, float("inf"), float("-inf"))
_TEXTS = ("zz", "", "x1", "y" * 300)


def mutated(message, codec, random):
    """The message with one value changed; None where the codec does not read what came of it."""
    plain = msgpack.unpackb(codec.encode(message)[1:], raw=False)
    _mutate(plain, random)
    try:
        return codec.decode(bytes((PROTOCOL,)) + msgpack.packb(plain))
    except MalformedError:
        return None


def _mutate(plain, random):
    *path, last = random.choice([path for path in _paths(plain) if path])
    for k in path:
        plain = plain[k]
    value = plain[last]
    if type(value) is list:
        _shorten_or_repeat(value, random)
    elif type(value) is bool:
        plain[last] = not value
    elif type(value) is int:
        plain[last] = random.choice((value + 1, max(0, value - 1), 0, LARGEST, 2**31, "zz", random.randrange(20)))
    elif type(value) is float:
        plain[last] = random.choice((*_FLOATS, value * 1.0000001))
    elif type(value) is bytes:
        plain[last] = random.choice((b"", value[::-1], bytes(len(value)), b"{}", b"[" * 5000, value[:-1]))
    elif type(value) is str:
        plain[last] = random.choice(_TEXTS)


def _shorten_or_repeat(values, random):
    if values and random.random() < 0.5:
        values.pop(random.randrange(len(values)))
    elif values:
        values.append(random.choice(values))


def _paths(plain, path=()):
    yield path
    for k, value in enumerate(plain if isinstance(plain, list) else ()):
        yield from _paths(value, (*path, k))


def codec_of(problem):
    return Codec([robot.id for robot in problem.robots], [task.id for task in problem.tasks])
