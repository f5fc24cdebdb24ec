"""Messages as a faulty program would send them: some values are others than they should be, or nothing is in its place.

A message is changed as the plain values that travel (`codec`), and so is the JSON of orders and statements within it.
"""

import json
from contextlib import suppress

import msgpack

from muster_team.network.codec import PROTOCOL, Codec
from muster_team.network.plain_values import MalformedError

LARGEST = 2**63 - 1
_NUMBERS = (0, -1, 1, 2**31, LARGEST, 2**64 - 1, -(2**63), 1.5)
_FLOATS = (0.0, -0.0, -1.0, 1e300, 5e-324, float("inf"), float("-inf"), float("nan"))
_TEXTS = ("zz", "", "x1", "y" * 300, "r_0", "0", "\x00", "\ud800")
_BYTES = (b"", b"{}", b"[" * 5000, b"\xff\xfe", b"null", b"1" * 30)
_DEEPEST = 8  # lists in lists of a message
_OTHERS = (None, True, 3, -7, 0.5, "zz", b"", [], [[]], {}, [[[[[0]]]]])


def mutated(message, codec, random):
    """The message with one value changed; None where the codec does not read what came of it."""
    try:
        return codec.decode(mutated_bytes(codec.encode(message), random))
    except MalformedError:
        return None


def mutated_bytes(data, random, times=1):
    """The bytes of a message with some values changed; seldom bytes are cut off or changed, whatever they mean."""
    if random.random() < 0.04:
        return _damaged(data, random)
    plain = msgpack.unpackb(data[1:], raw=False)
    try:
        for _ in range(times):
            _mutate(plain, random)
        return bytes((PROTOCOL,)) + msgpack.packb(plain)
    except (ValueError, OverflowError, RecursionError):  # deeper, or larger, than can be written
        return _damaged(data, random)


def _damaged(data, random):
    """The bytes without their end, or with one byte changed."""
    at = random.randrange(1, len(data))
    return data[:at] if random.random() < 0.5 else data[:at] + random.randbytes(1) + data[at + 1 :]


def _mutate(plain, random):
    """Change something in nested lists: a value, the order of two, what is in a list, or the form of all."""
    draw = random.random()
    if draw > 0.5 and plain:
        _mutate_a_little(plain, random)
    elif draw < 0.04 or not plain:
        plain += [random.choice((random.randrange(40), 99, -1, "zz")), random.choice(_OTHERS)]  # of a newer version
    elif draw < 0.1:
        _swap(plain, _way(plain, random), _way(plain, random))
    else:
        _mutate_at(plain, _way(plain, random), random)


def _mutate_a_little(plain, random):
    """Change a value to one that a robot might mean, of the same type."""
    path = _way(plain, random)
    at, last = _inside(plain, path)
    for _ in range(_DEEPEST):  # a list may be within itself, after swaps
        if type(at[last]) is list and at[last]:
            at, last = at[last], random.randrange(len(at[last]))
    value = at[last]
    if type(value) is int:
        at[last] = random.choice((value + 1, max(0, value - 1), random.randrange(5), random.randrange(20)))
    elif type(value) is float:
        at[last] = random.choice((0.0, -1.0, value + 1.0, value * 1.0000001))
    else:
        _mutate_at(plain, path, random)


def _mutate_at(plain, path, random):
    at, last = _inside(plain, path)
    value = at[last]
    draw = random.random()
    if draw < 0.04:
        at[last] = random.choice(_OTHERS)
    elif draw < 0.06:
        at[last] = [value] if random.random() < 0.7 else _deep(value)
    elif type(value) is list:
        _change_list(value, random)
    elif type(value) is bytes:
        at[last] = _json_mutated(value, random) or random.choice((*_BYTES, value[::-1], bytes(len(value)), value[:-1]))
    else:
        at[last] = _other(value, random)


def _other(value, random):
    """Another value of the same type, mostly."""
    if type(value) is bool:
        return not value
    if type(value) is int:
        near = value + 1, max(0, value - 1), random.randrange(20), random.randrange(20)
        return random.choice((*near, *near, *_NUMBERS, "zz", "x1", "nope"))
    if type(value) is float:
        return random.choice((*_FLOATS, value * 1.0000001, -value, int(value) if abs(value) < 2**60 else 0))
    return random.choice((*_TEXTS, value[::-1], value[:1])) if type(value) is str else random.choice(_OTHERS)


def _change_list(values, random):
    kind = random.randrange(5)
    if not values:
        values.append(random.choice(_OTHERS))
    elif kind == 0:
        values.pop(random.randrange(len(values)))
    elif kind == 1:
        values.insert(random.randrange(len(values)), random.choice(values))
    elif kind == 2:
        random.shuffle(values)
    elif kind == 3:
        del values[random.randrange(len(values)) :]
    else:
        values *= 2 if len(values) < 100 else 1


def _swap(plain, first, second):
    """Swap two values; of one and a list that it is in, nothing."""
    if first[: len(second)] == second or second[: len(first)] == first:
        return
    (a, i), (b, j) = _inside(plain, first), _inside(plain, second)
    a[i], b[j] = b[j], a[i]


def _deep(value):
    for _ in range(400):
        value = [value]
    return value


def _json_mutated(content, random):
    """The JSON in these bytes with one value changed, a key more or a key less; None: it holds none."""
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        return None
    holder = [data]
    at, last = _inside(holder, _path(holder, random))
    value = at[last]
    if type(value) is dict and random.random() < 0.5:
        value[random.choice(("id", "noise_limit", "", *value))] = random.choice((None, *_TEXTS, -1, 1e308, {}, []))
    elif random.random() < 0.15 and at is not holder:
        with suppress(KeyError, IndexError):
            at.pop(last)
    elif type(value) is list:
        _change_list(value, random)
    else:
        at[last] = _other(value, random)
    return json.dumps(holder[0], default=str, separators=(",", ":")).encode("utf-8", "replace")


def _inside(plain, path):
    """The list or dictionary in which a path ends, and where in it."""
    *path, last = path
    for k in path:
        plain = plain[k]
    return plain, last


def _way(plain, random):
    """A way into a message, mostly to what is stated in it: every second value after its sender and progress."""
    stated = [k for k in range(5, len(plain), 2) if type(plain[k]) is list and plain[k]]
    if not stated or random.random() < 0.15:
        return _path(plain, random)
    first = random.choice(stated)
    return [first, *_path(plain[first], random)]


def _path(plain, random):
    """A way down to some value, seldom to a list or dictionary of values; the first step leads into `plain` itself."""
    path = []
    while isinstance(plain, list | dict) and plain and (not path or random.random() < 0.85):
        path.append(random.choice(list(plain)) if isinstance(plain, dict) else random.randrange(len(plain)))
        plain = plain[path[-1]]
    return path


def codec_of(problem):
    return Codec([robot.id for robot in problem.robots], [task.id for task in problem.tasks])
